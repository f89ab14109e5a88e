//! What can be wrong with a key or a value, in one line each.

use super::schema::{ADHESION, FORMAT, Key, RADIUS_OVER_CURVATURE};
use crate::ritz::Grading;
use crate::units::ValueError;
use thiserror::Error;

/// A key or a value that a preset cannot have. Foreign text in it has already been made safe to show.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum Invalid {
    /// No row of the table has this key.
    #[error("unknown key {key}{}", of_unknown(.meant.as_deref()))]
    UnknownKey {
        /// The key as written.
        key: String,
        /// The most similar known key.
        meant: Option<Key>,
    },
    /// A short name of more than one key.
    #[error("{name} is short for several: {keys}")]
    Several {
        /// The name as written.
        name: String,
        /// The keys.
        keys: String,
    },
    /// A group that cannot be set.
    #[error("unknown key {key}; of the groups, {known} can be set")]
    UnknownGroup {
        /// The key as written.
        key: String,
        /// The groups that can be set.
        known: String,
    },
    /// The text is not valid TOML.
    #[error("{what}")]
    Syntax {
        /// The parser's words.
        what: String,
    },
    /// A `--set` argument without `=`.
    #[error("an assignment is KEY=VALUE, as in gap.amplitude=0.002")]
    Assignment,
    /// A `--set` argument without anything before `=`.
    #[error("nothing stands before the =; an assignment is KEY=VALUE, as in gap.amplitude=0.002")]
    NoKey,
    /// The name of a table used for a value.
    #[error("{table} is a table, not {found}; set one of its keys, such as {example}")]
    NotTable {
        /// The table.
        table: Key,
        /// What was found.
        found: String,
        /// A key in it.
        example: Key,
    },
    /// A value of another type.
    #[error("{key} must be {allowed}, not {found}")]
    Type {
        /// The key.
        key: Key,
        /// What was found.
        found: String,
        /// The values it takes.
        allowed: String,
    },
    /// A value of the right type that is out of range.
    #[error("{key} = {value} is out of range: it must be {allowed}")]
    Range {
        /// The key.
        key: Key,
        /// The value.
        value: String,
        /// The values it takes.
        allowed: String,
    },
    /// A word that is not one of the choices.
    #[error("{key} = \"{value}\" is not known: it must be {allowed}{}", hint(.meant.as_ref()))]
    Choice {
        /// The key.
        key: Key,
        /// The word.
        value: String,
        /// The choices.
        allowed: String,
        /// The most similar choice.
        meant: Option<Key>,
    },
    /// Text with characters that a screen must not show.
    #[error("{key} = \"{value}\" holds control or invisible characters")]
    Unprintable {
        /// The key.
        key: Key,
        /// The text.
        value: String,
    },
    /// A file of another format.
    #[error("format = {found} is not known: this version reads format {FORMAT}")]
    Format {
        /// The format that the file states.
        found: i64,
    },
    /// A required key is missing.
    #[error("{key} is missing: it must be {allowed}")]
    Missing {
        /// The key.
        key: Key,
        /// The values it takes.
        allowed: String,
    },
    /// A parameter of a newly chosen formula that has not been given a value.
    #[error("the formula needs a value for {key}, as in {key}=1{}", of_unset(.key, .meant.as_ref()))]
    Unset {
        /// The key.
        key: Key,
        /// The most similar parameter of the previous formula.
        meant: Option<Key>,
    },
    /// A required table is missing.
    #[error("the table [{table}] is missing: it needs {keys}")]
    MissingTable {
        /// The table.
        table: Key,
        /// Its required keys.
        keys: String,
    },
    /// A key that does not belong to the word chosen.
    #[error("{key} belongs to {belongs}, and the {what} is {chosen}")]
    OtherChoice {
        /// The key.
        key: Key,
        /// The choice it belongs to, such as `gap.shape = cone`.
        belongs: String,
        /// What was chosen, in one word, such as `gap`.
        what: &'static str,
        /// The word chosen in this preset, with an article if it has one.
        chosen: String,
    },
    /// A unit to show numbers in, in a preset without units.
    #[error(
        "{key} belongs to SI, and the unit system is reduced: numbers shown in units need units = \"SI\""
    )]
    NoUnits {
        /// The key.
        key: Key,
    },
    /// More than one start, or more than one turn.
    #[error("{second} and {first} both set {does}: give exactly one")]
    Rivals {
        /// One of them.
        first: Key,
        /// Another.
        second: Key,
        /// What they say, such as `where the path starts`.
        does: &'static str,
    },
    /// A range without adhesion, or without a known length.
    #[error("material.adhesion = \"{word}\" needs {needs}")]
    Rangeless {
        /// Its word.
        word: &'static str,
        /// What it needs, in words.
        needs: &'static str,
    },
    /// A path that would end at or beyond its start.
    #[error("{key} = {end} is not below path.start_contact_radius = {start}")]
    EndBeyondStart {
        /// `path.end_contact_radius`.
        key: Key,
        /// The contact radius at the end, as it is shown.
        end: String,
        /// The contact radius at the start, as it is shown.
        start: String,
    },
    /// A number of rings that their grading does not allow.
    #[error(
        "{key} = {rings} is out of range: with basis.grading = \"{word}\" it must be from {lo} to {hi}",
        word = grading.name(), lo = grading.ring_range().start(), hi = grading.ring_range().end()
    )]
    Rings {
        /// `basis.rings`.
        key: Key,
        /// The number.
        rings: usize,
        /// The grading.
        grading: Grading,
    },
    /// A value whose units it cannot have.
    #[error("{key}: {cause}")]
    Units {
        /// The key.
        key: Key,
        /// Why.
        cause: ValueError,
    },
    /// A gap that cannot be made, or a measured curve that cannot be read.
    #[error("{key}: {cause}")]
    Made {
        /// The key.
        key: Key,
        /// Why, in words.
        cause: String,
    },
    /// A parameter that the formula does not use.
    #[error("the formula has no parameter for {key}{}", hint(.meant.as_ref()))]
    Unused {
        /// The key.
        key: Key,
        /// The most similar parameter without a value.
        meant: Option<Key>,
    },
    /// A contact radius where the gap is not known.
    #[error("{key} = {value} is out of range: it must be less than {largest}, up to which the gap is known")]
    Beyond {
        /// The key.
        key: Key,
        /// The contact radius, as shown.
        value: String,
        /// The largest known radius, as shown.
        largest: String,
    },
    /// A contact radius far beyond the radius of curvature.
    #[error(
        "{key} = {value} is out of range: it must be at most {RADIUS_OVER_CURVATURE} x the radius of \
         curvature {radius}"
    )]
    Wide {
        /// The key.
        key: Key,
        /// The contact radius, as shown.
        value: String,
        /// The radius of curvature, as shown.
        radius: String,
    },
}

fn hint(key: Option<&Key>) -> String {
    key.map_or_else(String::new, |key| format!("; did you mean {key}?"))
}

/// What an unknown key may have been meant as, or where all keys are listed.
pub(crate) fn of_unknown(meant: Option<&str>) -> String {
    meant
        .map_or_else(|| "; pulloff presets keys lists all".to_owned(), |key| format!("; did you mean {key}?"))
}

/// What a parameter without a value may have been meant as.
fn of_unset(key: &Key, meant: Option<&Key>) -> String {
    if meant.is_none() && key.ends_with(".x") { "; the radius is r".to_owned() } else { hint(meant) }
}

impl Invalid {
    /// The known key this is about, if there is one.
    pub fn key(&self) -> Option<&str> {
        match self {
            Self::Type { key, .. }
            | Self::Range { key, .. }
            | Self::Choice { key, .. }
            | Self::Unprintable { key, .. }
            | Self::Missing { key, .. }
            | Self::OtherChoice { key, .. }
            | Self::NoUnits { key }
            | Self::Rivals { second: key, .. }
            | Self::EndBeyondStart { key, .. }
            | Self::Rings { key, .. }
            | Self::Units { key, .. }
            | Self::Made { key, .. }
            | Self::Unset { key, .. }
            | Self::Unused { key, .. }
            | Self::Beyond { key, .. }
            | Self::Wide { key, .. } => Some(key),
            Self::Rangeless { .. } => Some(ADHESION),
            Self::Format { .. } => Some("format"),
            Self::UnknownKey { .. }
            | Self::Several { .. }
            | Self::UnknownGroup { .. }
            | Self::Syntax { .. }
            | Self::Assignment
            | Self::NoKey
            | Self::NotTable { .. }
            | Self::MissingTable { .. } => None,
        }
    }
}
