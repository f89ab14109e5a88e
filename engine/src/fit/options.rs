//! What is asked of a fit, what can be free, and why there is no fit.

use super::problem::{ADHESION, MODULUS, Target};
use super::track::{LARGEST_MAUGIS, maugis};
use crate::measured::Asked;
use crate::measured::{Abscissa, BranchError};
use crate::preset::called::key_called;
use crate::preset::data::{BASELINE, OFFSET, TILT};
use crate::preset::invalid::{Invalid, of_unknown};
use crate::preset::schema::{CHOOSERS, Kind, LIQUID_KEYS, RANGE_KEYS, Row, STIFFNESS};
use crate::preset::{Preset, Value, edge};
use crate::progress::Stopped;
use crate::text::{closest_key, greek, quote};
use crate::units::number::short;
use thiserror::Error;

/// What is asked of a fit.
#[derive(Debug, Clone, PartialEq)]
#[expect(clippy::struct_excessive_bools, reason = "each is a switch of its own")]
pub struct Options {
    /// The free keys, dotted or by their labels.
    pub free: Vec<String>,
    /// Whether outliers count linearly, or squared like all others.
    pub robust: bool,
    /// What is used of the points.
    pub asked: Asked,
    /// Whether `path.rate` is that of this file, and not of the preset.
    pub is_rate_said: bool,
    /// Whether starts other than the preset's are tried.
    pub scan: bool,
    /// Whether profile intervals are computed.
    pub profile: bool,
    /// How many fits of the bootstrap, and their seed.
    pub bootstrap: Option<(usize, u64)>,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            free: Vec::new(),
            robust: true,
            asked: Asked::default(),
            is_rate_said: false,
            scan: true,
            profile: false,
            bootstrap: None,
        }
    }
}

impl Options {
    /// The same without profiles and bootstrap, also where a bootstrap would be run unasked: for a fit of which only the
    /// verdict is wanted.
    pub(super) fn without_intervals(&self) -> Self {
        Self { profile: false, bootstrap: Some((0, 0)), ..self.clone() }
    }
}

/// Why there is no fit.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum FitError {
    /// Nothing is free.
    #[error(
        "nothing is free: name the keys to fit, as in --free material.effective_modulus,material.work_of_adhesion, or in data.free"
    )]
    NothingFree,
    /// A key that is not known, or cannot be fitted.
    #[error("free key {key}: {why}")]
    Key {
        /// What was given, safe to show.
        key: String,
        /// Why not.
        why: String,
    },
    /// A value given with an error in a way that is not possible.
    #[error("uncertain value \"{given}\": {why}")]
    Uncertain {
        /// What was given, safe to show.
        given: String,
        /// Why not.
        why: String,
    },
    /// An edge with a speed, but a device without one.
    #[error(
        "{0} is fitted to a retraction at a constant rate: set path.rate, or give times with the position of \
         the device, {1}"
    )]
    NoRate(String, &'static str),
    /// A rate that the times contradict.
    #[error(
        "the rate is given as {given}, but the times of the file give {found}: leave out --rate, or correct the times"
    )]
    Rate {
        /// The one given.
        given: String,
        /// That of the times, with its error.
        found: String,
    },
    /// The points give no branches.
    #[error(transparent)]
    Branches(#[from] BranchError),
    /// The preset has no measured curve.
    #[error("the preset has no measured curve: name a file, or set data.file")]
    NoData,
    /// Its file gives no points, in words.
    #[error("{0}")]
    Data(String),
    /// Fewer points than parameters ask for.
    #[error(
        "{points} points in contact are too few for {parameters} free keys: at least {needed} are needed"
    )]
    Few {
        /// How many there are.
        points: usize,
        /// How many parameters.
        parameters: usize,
        /// How many are wanted.
        needed: usize,
    },
    /// Loading with rings of contact; in words, when they begin.
    #[error(
        "loading on this gap forms rings of contact, which are not fitted: {0}. Use the retraction, without {key}",
        key = edge::CLOSING_ADHESION
    )]
    Loading(String),
    /// Two directions of the columns that fit alike.
    #[error(
        "the points do not show which way their columns run: {one} and {other} fit them equally well. Set \
         --signs or data.signs"
    )]
    Direction {
        /// The signs of one, as `--signs` writes them.
        one: String,
        /// Those of the other.
        other: String,
    },
    /// No start gives a curve that comes near to the points.
    #[error(
        "no values near those of the preset give a curve that reaches the points: check the unit of x and of the force, and \
         the values that are held"
    )]
    NoStart,
    /// Of adhesion with a range so small, which is given as `λ_M`, no path is followed.
    #[error(
        "the range of the adhesion is too small to be followed: lambda_M = {0} at the values of the preset, and at most {1} is possible. \
         Give a lower material.cohesive_strength, or set material.adhesion = \"short-range\""
    )]
    SmallRange(String, f64),
    /// The fit was no longer wanted.
    #[error(transparent)]
    Stopped(#[from] Stopped),
}

impl FitError {
    /// Why no start leads to a curve that reaches the points of `preset`.
    pub(super) fn no_start(preset: &Preset) -> Self {
        match maugis(preset).filter(|maugis| *maugis > LARGEST_MAUGIS) {
            Some(maugis) => Self::SmallRange(short(maugis, 3), LARGEST_MAUGIS),
            None => Self::NoStart,
        }
    }
}

/// What a name after `--free` stands for.
///
/// # Errors
/// [`FitError::Key`].
pub fn target(preset: &Preset, abscissa: Abscissa, name: &str) -> Result<Target, FitError> {
    let refused = |why: String| FitError::Key { key: quote(name), why };
    match name {
        OFFSET | "offset" if abscissa == Abscissa::Radius => {
            return Err(refused(format!(
                "a contact radius has no offset; leave {OFFSET} out of the free keys"
            )));
        }
        OFFSET | "offset" => return Ok(Target::Offset),
        BASELINE | "baseline" => return Ok(Target::Baseline),
        TILT | "tilt" => return Ok(Target::Tilt),
        _ => {}
    }
    let key = key_called(preset, name).map_err(|invalid| {
        if let Invalid::Several { keys, .. } = invalid {
            return refused(format!("is short for several: {keys}"));
        }
        let rows: Vec<Row> = preset.rows().collect();
        let applies = |row: &&Row| row.fits(CHOOSERS[0], preset.gap.name());
        let known = rows.iter().filter(applies).map(|row| (&*row.key, &*row.label));
        refused(format!("is not a key of this preset{}", of_unknown(closest_key(name, known))))
    })?;
    let unfit = || {
        let why = "is not a positive number of the bodies, gap, adhesion or spring; only those can be fitted";
        refused(why.to_owned())
    };
    let row = preset.row(&key).ok_or_else(unfit)?;
    if LIQUID_KEYS.iter().any(|of_liquid| row.key == *of_liquid) {
        let why = "is held: of a liquid bridge no values are fitted. With material.adhesion = \"dugdale\" a fit finds the strength and \
                   the range of such an adhesion";
        return Err(refused(why.to_owned()));
    }
    if row.key == STIFFNESS && preset.is_of_deflection() {
        let why = "is held: the points have the deflection of the spring, and the force, E* and gamma are all in proportion to its k. \
                   They are off by the same share as k is";
        return Err(refused(why.to_owned()));
    }
    let others =
        [MODULUS, ADHESION, edge::CLOSING_ADHESION, STIFFNESS, edge::REFERENCE_SPEED, edge::EXPONENT];
    let fits = row.key.starts_with("gap.") || others.iter().chain(&RANGE_KEYS).any(|key| row.key == *key);
    // That of a formula may have any sign: a fit keeps the one of its first guess, which is positive.
    let is_positive = match row.kind {
        _ if row.key.starts_with("gap.parameters.") => true,
        Kind::Positive | Kind::NonNegative => true,
        Kind::Between { min, .. } => min > 0.0,
        _ => false,
    };
    if !fits || !is_positive {
        return Err(unfit());
    }
    // What a closing edge gains starts from what an opening one costs.
    let given = if row.key == edge::CLOSING_ADHESION { preset.get(ADHESION) } else { None };
    match preset.get(&row.key).or(given) {
        Some(Value::Number(value)) if value > 0.0 => Ok(Target::Key(row.key.to_string())),
        Some(Value::Number(value)) if value < 0.0 => {
            Err(refused("starts below 0: only positive values can be fitted".to_owned()))
        }
        Some(_) => Err(refused("starts at 0, which has no logarithm: set it to a first guess".to_owned())),
        None => Err(refused(format!(
            "has no value in this preset to start from: set {} to a first guess",
            row.key
        ))),
    }
}

/// A key as it appears in a sentence: E*, γ, R.
pub fn letter(preset: &Preset, key: &str) -> String {
    match key {
        OFFSET => "δ₀".to_owned(),
        BASELINE => "P₀".to_owned(),
        TILT => "tilt".to_owned(),
        key => preset.row(key).map_or_else(|| key.to_owned(), |row| greek(&row.label)),
    }
}
