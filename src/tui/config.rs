//! The user's settings: `pulloff/config.toml` below the XDG configuration folder. It is read and never written.
//!
//! ```toml
//! [keys]
//! next-event = "n"
//! step = ["Space", "F2"]
//!
//! [look]
//! theme = "light"
//! ```
//!
//! The names are those of the [command table](crate::explorer::table::ROWS); a command that is not named keeps its
//! keys. A table of settings is a row of `TABLES` with its own reader.

use super::look::LookWish;
use crate::explorer::Id;
use crate::explorer::table::ROWS;
use crate::store::file::{FileError, read_text};
use clap::builder::PossibleValue;
use clap::{Arg, Args, FromArgMatches};
use etcetera::BaseStrategy;
use pulloff_engine::text::{closest, listed, quote, show_path};
use std::io;
use std::path::{Path, PathBuf};
use thiserror::Error;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// The largest size of the file, in bytes.
pub const LARGEST: u64 = 1 << 16;
/// The largest number of keys for one command.
pub const MOST_KEYS: usize = 8;

/// The user's settings.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Config {
    /// The file, safe to show; empty where there is none.
    pub name: String,
    /// Keys of commands, in the order of the file.
    pub keys: Vec<Binding>,
    pub look: LookWish,
}

/// The keys of one command.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Binding {
    pub id: Id,
    /// Its keys as written; an empty list removes its keys.
    pub keys: Vec<String>,
    /// The line, from 1.
    pub line: usize,
}

/// What is wrong with a line.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ConfigMistake {
    /// The line, from 1.
    pub line: usize,
    /// What is wrong, safe to show.
    pub what: String,
}

/// Why there are no settings. Names and paths in the error are safe to show.
#[derive(Debug, Error)]
pub enum ConfigError {
    #[error(transparent)]
    File(#[from] FileError),
    /// Some lines are wrong, at least one.
    #[error("{}", listed(.mistakes.iter().map(|ConfigMistake { line, what }| format!("{name}:{line}: {what}"))))]
    Mistakes { name: String, mistakes: Vec<ConfigMistake> },
}

/// The largest number of names in a message.
const FEW: usize = 8;

/// Reads a table into the settings.
type TableReader = fn(&mut Config, &DeTable<'_>, &mut ConfigSheet<'_>);

/// The tables of the file.
const TABLES: [(&str, TableReader); 2] = [("keys", keys), ("look", look)];

/// The user's settings file, which need not exist; `None` where there is no home.
pub fn path() -> Option<PathBuf> {
    let folder = etcetera::base_strategy::Xdg::new().ok()?.config_dir();
    Some(folder.join("pulloff/config.toml"))
}

/// The settings of a file.
pub fn load(path: &Path) -> Result<Config, ConfigError> {
    let (text, _) = read_text(path, LARGEST)?;
    read(&show_path(path), &text)
}

/// The same, where a missing file gives no settings.
pub fn load_if_there(path: &Path) -> Result<Config, ConfigError> {
    match load(path) {
        Err(ConfigError::File(FileError::Io { cause, .. }))
            if matches!(cause.kind(), io::ErrorKind::NotFound | io::ErrorKind::NotADirectory) =>
        {
            Ok(Config::default())
        }
        result => result,
    }
}

/// The settings in a text, which messages call `name`.
pub fn read(name: &str, text: &str) -> Result<Config, ConfigError> {
    let mut config = Config { name: name.to_owned(), ..Config::default() };
    let mut sheet = ConfigSheet { text, mistakes: Vec::new() };
    match DeTable::parse(text) {
        Err(error) => {
            let at = error.span().map_or(0, |span| span.start);
            sheet.wrong(at, error.message().lines().next().unwrap_or_default().to_owned());
        }
        Ok(document) => {
            for (table, value) in document.get_ref() {
                let known = TABLES.iter().find(|(known, _)| *known == &**table.get_ref());
                match (known, value.get_ref()) {
                    (Some((_, reader)), DeValue::Table(rows)) => reader(&mut config, rows, &mut sheet),
                    (Some((known, _)), _) => {
                        sheet.wrong(table.span().start, format!("{known} is a table: [{known}]"));
                    }
                    (None, _) => {
                        let known = TABLES.map(|(known, _)| known);
                        sheet.unknown(table.span().start, "table", table.get_ref(), &known);
                    }
                }
            }
        }
    }
    if sheet.mistakes.is_empty() {
        return Ok(config);
    }
    sheet.mistakes.sort_by_key(|mistake| mistake.line);
    Err(ConfigError::Mistakes { name: config.name, mistakes: sheet.mistakes })
}

/// The text, and its mistakes so far.
struct ConfigSheet<'a> {
    text: &'a str,
    mistakes: Vec<ConfigMistake>,
}

impl ConfigSheet<'_> {
    /// The line of a byte, from 1.
    fn line(&self, at: usize) -> usize {
        1 + self.text.bytes().take(at).filter(|byte| *byte == b'\n').count()
    }

    fn wrong(&mut self, at: usize, what: String) {
        self.mistakes.push(ConfigMistake { line: self.line(at), what });
    }

    fn unknown(&mut self, at: usize, what: &str, word: &str, known: &[&str]) {
        let meant = closest(word, known.iter().copied());
        let hint = match meant {
            Some(meant) => format!("; did you mean {meant}?"),
            None if known.len() <= FEW => format!("; expected {}", known.join(", ")),
            None => String::new(),
        };
        self.wrong(at, format!("no {what} is called \"{}\"{hint}", quote(word)));
    }
}

/// `[keys]`: a command's name, and a key or a list of keys.
fn keys(config: &mut Config, table: &DeTable<'_>, sheet: &mut ConfigSheet<'_>) {
    for (name, value) in table {
        let at = name.span().start;
        let Some(row) = ROWS.iter().find(|row| row.name == &**name.get_ref()) else {
            let names: Vec<&str> = ROWS.iter().map(|row| row.name).collect();
            sheet.unknown(at, "command", name.get_ref(), &names);
            continue;
        };
        let text = |value: &Spanned<DeValue<'_>>| match value.get_ref() {
            DeValue::String(text) => Some(text.to_string()),
            _ => None,
        };
        let keys: Option<Vec<String>> = match value.get_ref() {
            DeValue::Array(all) if all.len() <= MOST_KEYS => all.iter().map(text).collect(),
            _ => text(value).map(|key| vec![key]),
        };
        match keys {
            Some(keys) => config.keys.push(Binding { id: row.id, keys, line: sheet.line(at) }),
            None => sheet.wrong(
                at,
                format!("{} takes a key in quotes, or a list of at most {MOST_KEYS} such keys", row.name),
            ),
        }
    }
}

/// `[look]`: each row is a flag of the explorer, and takes the words that the flag takes; `true` and `false` are written
/// without quotes.
fn look(config: &mut Config, table: &DeTable<'_>, sheet: &mut ConfigSheet<'_>) {
    let flags = LookWish::augment_args(clap::Command::new("look").no_binary_name(true));
    let mut said = Vec::new();
    for (name, value) in table {
        let (at, row) = (name.span().start, &**name.get_ref());
        let Some(flag) = flags.get_arguments().find(|flag| flag.get_long() == Some(row)) else {
            let names: Vec<&str> = flags.get_arguments().filter_map(Arg::get_long).collect();
            sheet.unknown(at, "part of [look]", row, &names);
            continue;
        };
        let word = match value.get_ref() {
            DeValue::String(text) => Some(text.to_string()),
            DeValue::Boolean(yes) => Some(yes.to_string()),
            _ => None,
        };
        let words = flag.get_possible_values();
        let words: Vec<&str> = words.iter().map(PossibleValue::get_name).collect();
        match word.filter(|word| words.contains(&&**word)) {
            Some(word) => said.push(format!("--{row}={word}")),
            None => sheet.wrong(at, format!("{row} must be one of {}", words.join(", "))),
        }
    }
    // Flags with words of theirs cannot fail.
    let look = flags.try_get_matches_from(said).and_then(|said| LookWish::from_arg_matches(&said));
    config.look = look.unwrap_or_default();
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tui::theme::{Charts, Palette};

    fn error(text: &str) -> String {
        read("config.toml", text).unwrap_err().to_string()
    }

    #[test]
    fn keys_are_read_with_their_lines() {
        let config =
            read("c", "# mine\n[keys]\nstep = [\"Space\", \"F2\"]\njump = []\nundo = \"z\"\n").unwrap();
        let mut bindings = config.keys;
        bindings.sort_by_key(|binding| binding.line);
        let binding = |id, keys: &[&str], line| Binding {
            id,
            keys: keys.iter().map(ToString::to_string).collect(),
            line,
        };
        let expected =
            [binding(Id::Step, &["Space", "F2"], 3), binding(Id::Jump, &[], 4), binding(Id::Undo, &["z"], 5)];
        assert_eq!(bindings, expected);
        assert_eq!(read("c", "").unwrap().keys, []);
    }

    #[test]
    fn what_is_wrong_is_said_with_its_line_and_the_nearest_name() {
        for (text, expected) in [
            ("[keys]\nstepp = \"x\"", "config.toml:2: no command is called \"stepp\"; did you mean step?"),
            ("[look]\ntheme = \"drak\"", "config.toml:2: theme must be one of any, dark, light, mono"),
            ("[look]\ncharts = 3", "config.toml:2: charts must be one of braille, block, ascii"),
            ("[look]\nmouse = \"on\"", "config.toml:2: mouse must be one of true, false"),
            (
                "[look]\nqqqqqq = 3",
                "config.toml:2: no part of [look] is called \"qqqqqq\"; expected theme, charts, ascii, mouse",
            ),
            (
                "[look]\nthemes = 3",
                "config.toml:2: no part of [look] is called \"themes\"; did you mean theme?",
            ),
            ("[kys]", "config.toml:1: no table is called \"kys\"; did you mean keys?"),
            ("theme = \"light\"", "config.toml:1: no table is called \"theme\"; expected keys, look"),
            ("\nkeys = 3", "config.toml:2: keys is a table: [keys]"),
            ("[keys]\nstep = 3", "config.toml:2: step takes a key in quotes"),
            ("[keys]\nstep = [\"a\", 3]", "config.toml:2: step takes a key in quotes"),
            ("[keys]\nstep = \"x\nundo = 3", "config.toml:2: "),
            ("[keys]\na = 1\nb = 2\nc = 3", "\nconfig.toml:4: "),
            ("[keys]\nstep = \"a\"\nstep = \"b\"", "config.toml:3: duplicate key"),
        ] {
            assert!(error(text).contains(expected), "{text}: {}", error(text));
        }
        let many = format!("[keys]\nstep = [{}]", "\"x\",".repeat(MOST_KEYS + 1));
        assert!(error(&many).contains("at most 8"));
    }

    #[test]
    fn a_look_takes_every_word_of_its_flags() {
        let look = |text: &str| read("c", &format!("[look]\n{text}")).unwrap().look;
        let wanted = LookWish {
            theme: Some(Palette::Mono),
            charts: Some(Charts::Block),
            ascii: None,
            mouse: Some(true),
        };
        assert_eq!(look("theme = \"mono\"\ncharts = \"block\"\nmouse = true"), wanted);
        let flags = LookWish::augment_args(clap::Command::new("look"));
        let mut words = 0;
        for flag in flags.get_arguments() {
            for word in flag.get_possible_values() {
                let (row, word) = (flag.get_long().unwrap(), word.get_name());
                assert_ne!(look(&format!("{row} = \"{word}\"")), LookWish::default(), "{row} = {word}");
                words += 1;
            }
        }
        assert_eq!(words, 11);
    }

    #[test]
    fn a_file_that_is_not_there_has_no_settings_and_one_that_is_none_is_an_error() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("config.toml");
        assert_eq!(load_if_there(&path).unwrap(), Config::default());
        assert!(load(&path).unwrap_err().to_string().contains("cannot read"));
        std::fs::create_dir(&path).unwrap();
        assert!(load_if_there(&path).unwrap_err().to_string().contains("is a folder"));
        let large = folder.path().join("large.toml");
        std::fs::write(&large, " ".repeat(1 + usize::try_from(LARGEST).unwrap())).unwrap();
        assert!(load(&large).unwrap_err().to_string().contains("65537 bytes"));
    }
}
