//! What a line begun could go on with.

use super::offers::{Files, Typing};
use crate::explorer::model::Model;
use crate::explorer::table::{ROWS, called};

/// A line gone on with.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Completion {
    /// The line, with as much more as all offers have in common.
    pub line: String,
    pub offers: Vec<String>,
}

/// Completes the last word of `line`.
pub fn complete(line: &str, model: &Model, files: Files<'_>) -> Completion {
    let start = line.rfind([' ', '\t']).map_or(0, |at| at + 1);
    let (before, word) = line.split_at(start);
    let words: Vec<&str> = before.split_whitespace().collect();
    // Inside quotes anything may be meant.
    let is_quoted = line.matches('"').count() % 2 == 1;
    let all = if is_quoted { Vec::new() } else { candidates(model, &words, word, files) };
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

/// The words that can follow `words`, whatever `word` begins with.
fn candidates(model: &Model, words: &[&str], word: &str, files: Files<'_>) -> Vec<String> {
    let Some((name, words)) = words.split_first() else {
        return ROWS.iter().map(|row| row.name.to_owned()).collect();
    };
    let Some(row) = called(name) else { return Vec::new() };
    let offers = (row.takes.offers)(&Typing { model, words, word, files });
    // Behind a word that is all there is nothing more.
    let goes_on = words.is_empty() || row.takes.goes_on;
    offers.into_iter().filter(|_| goes_on).map(|offer| offer.word).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::store::{Loaded, Source, read, shipped};

    fn completed(line: &str) -> (String, usize) {
        let text = shipped::find("wavy-sphere").unwrap();
        let preset = read("t", text.text).unwrap();
        let loaded = Loaded { source: Source::Shipped(text), preset, text: String::new(), fingerprint: None };
        let mut model = Model::new(loaded);
        model.preset_names = ["lab-3", "lab-4"].map(str::to_owned).to_vec();
        let files = |folder: &str| match folder {
            "" => ["mine.csv", "more.txt", "curves/", "a b.csv"].map(str::to_owned).to_vec(),
            "curves/" => vec!["curves/first.csv".to_owned()],
            _ => Vec::new(),
        };
        let Completion { line, offers } = complete(line, &model, &files);
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
            ("zzz", "zzz", 0),
            ("set title=\"a ", "set title=\"a ", 0),
        ] {
            assert_eq!(completed(line), (expected.to_owned(), offers), "{line}");
        }
    }
}
