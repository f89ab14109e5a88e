//! What a line begun could go on with.

use super::lexer::quoted;
use super::parse::{PICTURES, RUN_TO};
use super::print::overlay_name;
use crate::explorer::command::ROWS;
use crate::explorer::export::{ExportKind, Picture};
use crate::explorer::maps::CURVES;
use crate::explorer::view::{Home, Overlay, View};
use crate::store::shipped::{self, SHIPPED};
use pulloff_engine::preset::Preset;
use pulloff_engine::preset::groups::GROUPS;
use pulloff_engine::preset::measured::SHIPPED_DATA;
use pulloff_engine::preset::schema::{AUTO, Kind, NONE};
use pulloff_engine::stability::COMPLIANCE;
use pulloff_engine::sweep::{QUANTITIES, Quantity};

/// A line gone on with.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Completion {
    /// The line, with as much more as all offers have in common.
    pub line: String,
    pub offers: Vec<String>,
}

/// The names of what is in a folder, which is named with its last `/`, as a line names them; folders end with `/`.
pub type Files<'a> = &'a dyn Fn(&str) -> Vec<String>;

/// Completes the last word of `line`; `presets` are the known names, or none for those shipped.
pub fn complete(line: &str, preset: &Preset, presets: &[String], files: Files<'_>) -> Completion {
    let start = line.rfind([' ', '\t']).map_or(0, |at| at + 1);
    let (before, word) = line.split_at(start);
    let words: Vec<&str> = before.split_whitespace().collect();
    // Inside quotes anything may be meant.
    let is_quoted = line.matches('"').count() % 2 == 1;
    let all = if is_quoted { Vec::new() } else { candidates(&words, word, (preset, presets, files)) };
    let offers: Vec<String> = all.into_iter().filter(|offer| offer.starts_with(word)).collect();
    let end = match &*offers {
        [] => word.to_owned(),
        [one] if one.ends_with(['=', '/']) => one.clone(),
        [one] => format!("{one} "),
        [first, rest @ ..] => {
            let same = |a: &str, b: &str| a.chars().zip(b.chars()).take_while(|(a, b)| a == b).count();
            let shared = rest.iter().map(|other| same(first, other)).min().unwrap_or(0);
            first.chars().take(shared).collect()
        }
    };
    Completion { line: format!("{before}{end}"), offers }
}

fn owned<'a>(words: impl IntoIterator<Item = &'a str>) -> Vec<String> {
    words.into_iter().map(str::to_owned).collect()
}

/// The words that can follow `words`, whatever `word` begins with.
fn candidates(
    words: &[&str],
    word: &str,
    (preset, presets, files): (&Preset, &[String], Files<'_>),
) -> Vec<String> {
    match words {
        [] => owned(ROWS.iter().map(|row| row.name).chain([RUN_TO.0])),
        ["open"] if presets.is_empty() => owned(SHIPPED.iter().map(|shipped| shipped.name)),
        ["open"] => presets.iter().filter_map(|name| quoted(name)).collect(),
        ["set" | "open", ..] => assignments(word, preset),
        ["control"] => owned(["displacement", "force", "stiffness="]),
        ["go"] => owned(Home::ALL.map(Home::name)),
        ["view"] => owned(View::ALL.map(View::name)),
        ["study"] => QUANTITIES.iter().flat_map(Quantity::columns).map(|column| column.name()).collect(),
        ["overlays"] => owned(Overlay::ALL.map(overlay_name)),
        ["data"] => owned(shipped::CURVES.iter().map(|shipped| shipped.name))
            .into_iter()
            .map(|name| format!("{SHIPPED_DATA}{name}"))
            .chain([NONE.to_owned()])
            // A name with a blank is typed in quotes.
            .chain(
                files(&word[..word.rfind('/').map_or(0, |at| at + 1)])
                    .into_iter()
                    .filter(|name| !name.contains(' ')),
            )
            .collect(),
        ["pins"] => owned(["all"]),
        ["map"] => axes(preset),
        ["map", _] => axes(preset).into_iter().chain(owned(CURVES.map(|(name, _)| name))).collect(),
        ["export"] => {
            owned(ExportKind::ALL.map(ExportKind::name).into_iter().chain(PICTURES.map(Picture::name)))
        }
        ["export", "figure", _] => owned(View::ALL.map(View::name).into_iter().chain(["replace"])),
        ["export", _, _] | ["save"] => owned(["replace"]),
        ["save-as", _, ..] => owned(["with-data", "replace"]),
        [name] if *name == RUN_TO.0 => owned(RUN_TO.1),
        _ => Vec::new(),
    }
}

/// What can stand on an axis of a map.
fn axes(preset: &Preset) -> Vec<String> {
    let rows = preset.rows().filter(|row| row.kind.is_number() && preset.get(&row.key).is_some());
    let groups = GROUPS.iter().map(|row| row.key.to_string());
    rows.map(|row| row.key.to_string()).chain(groups).chain(owned([COMPLIANCE])).collect()
}

/// The keys of `preset`, or the words that the key begun takes.
fn assignments(word: &str, preset: &Preset) -> Vec<String> {
    let Some((key, _)) = word.split_once('=') else {
        let rows = preset.rows().filter(|row| row.key != "format").map(|row| row.key.clone());
        let all = rows.chain(GROUPS.iter().map(|row| row.key.clone()));
        // Those that have or could have a value here.
        return all.map(|key| format!("{key}=")).collect();
    };
    let values: Vec<&str> = match preset.row(key).map(|row| row.kind) {
        Some(Kind::Choice(words)) => words.to_vec(),
        Some(Kind::Smoothing) => vec![AUTO, NONE],
        Some(Kind::Control) => vec!["displacement", "force", "stiffness="],
        _ => Vec::new(),
    };
    values.into_iter().map(|value| format!("{key}={value}")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::store::{read, shipped};

    fn completed(line: &str) -> (String, usize) {
        let preset = read("t", shipped::find("wavy-sphere").unwrap().text).unwrap();
        let files = |folder: &str| match folder {
            "" => ["mine.csv", "more.txt", "curves/", "a b.csv"].map(str::to_owned).to_vec(),
            "curves/" => vec!["curves/first.csv".to_owned()],
            _ => Vec::new(),
        };
        let presets = ["lab-3".to_owned(), "lab-4".to_owned()];
        let Completion { line, offers } = complete(line, &preset, &presets, &files);
        (line, offers.len())
    }

    #[test]
    fn commands_keys_values_presets_and_documents_are_completed() {
        for (line, expected, offers) in [
            ("ste", "step", 2),
            ("step-", "step-length ", 1),
            ("set gap.am", "set gap.amplitude=", 1),
            ("set gap.amplitude=1 path.contr", "set gap.amplitude=1 path.control", 2),
            ("set gap.shape=po", "set gap.shape=power-law ", 1),
            ("open l", "open lab-", 2),
            ("open lab-3 basis.k", "open lab-3 basis.kind=", 1),
            ("map gap.am", "map gap.amplitude ", 1),
            ("map gap.amplitude fo", "map gap.amplitude force ", 1),
            ("export scr", "export scr", 2),
            ("export figure x.svg con", "export figure x.svg contact", 2),
            ("export curve x.csv r", "export curve x.csv replace ", 1),
            ("control f", "control force ", 1),
            ("data m", "data m", 2),
            ("data mi", "data mine.csv ", 1),
            ("data cu", "data curves/", 1),
            ("data curves/", "data curves/first.csv ", 1),
            ("data a", "data a", 0),
            ("run-to in", "run-to instability ", 1),
            ("zzz", "zzz", 0),
            ("set title=\"a ", "set title=\"a ", 0),
        ] {
            assert_eq!(completed(line), (expected.to_owned(), offers), "{line}");
        }
    }
}
