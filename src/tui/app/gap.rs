//! Questions about the gap: its shape from pictures, its formula tried while it is typed, the file of its profile.

use super::state::App;
use crate::explorer::data::Folder;
use crate::explorer::{Command, Effect, update};
use crate::figure::Figure;
use crate::figure::shape::undeformed;
use crate::store::shipped::{CURVES, DATA};
use crate::tui::overlay::{Choice, Item, Prompt, Purpose};
use pulloff_engine::preset::measured::SHIPPED_DATA;
use pulloff_engine::preset::schema::NONE;
use pulloff_engine::preset::{Key, Value, data};
use pulloff_engine::text::show_path;

/// What each shape is, in a few words.
pub(super) const SHAPES: [(&str, &str); 9] = [
    ("sphere", "paraboloid r²/(2R)"),
    ("wavy-sphere", "paraboloid with one wave"),
    ("exact-sphere", "R - √(R² - r²), up to R"),
    ("cone", "c r"),
    ("power-law", "c r^n"),
    ("harmonics", "paraboloid with any waves"),
    ("random-waves", "waves drawn from a power law"),
    ("formula", "an expression you write"),
    ("profile", "measured rows in a file"),
];

impl App {
    /// Asks for the formula once that is the shape.
    pub(super) fn ask_formula_of_shape(&mut self) {
        const KEY: &str = "gap.formula";
        if self.model.preset.gap.name() == "formula" {
            self.ask_formula(KEY.into(), self.model.preset.get(KEY));
        }
    }

    pub(super) fn ask_formula(&mut self, key: Key, value: Option<Value>) -> Vec<Effect> {
        let text = value.map_or_else(String::new, |value| value.to_string());
        let note = "r, pi, e, parameters; + - * / ^; functions like sqrt(), exp(), cos(), min(,)";
        self.prompt("h(r) as a formula: the curve follows", note, text, Purpose::Formula(key))
    }

    /// Asks for a file for this key.
    pub(super) fn browse(&mut self, key: Key) -> Vec<Effect> {
        self.run(Command::Browse { key, folder: None })
    }

    /// The files of a folder, and the ways out of it.
    pub(super) fn choose_file(&mut self, key: &Key, folder: &Folder) {
        let is_curve = *key == data::FILE;
        let go = |text: String, path| {
            let command = Command::Browse { key: key.clone(), folder: Some(path) };
            Item::new(text, Choice::Command(command))
        };
        let up = folder.path.parent().map(|parent| go("../".to_owned(), parent.to_owned()));
        let below = folder.folders.iter().map(|name| go(format!("{name}/"), folder.path.join(name)));
        let files =
            folder.files.iter().map(|name| Item::new(name.clone(), Choice::set(key, folder.name_of(name))));
        let shipped = if is_curve { CURVES } else { DATA }.iter().map(|data| {
            let name = format!("{SHIPPED_DATA}{}", data.name);
            Item::new(name.clone(), Choice::set(key, name))
        });
        let (title, asks, note) = if is_curve {
            (
                "Measured curves in",
                "Read a measured curve",
                "a file with the force over the approach, the position or s",
            )
        } else {
            ("Profiles in", "Read a profile", "a file with the columns r and h")
        };
        let prompt = Prompt::new(asks, note, String::new(), Purpose::Value(key.clone()));
        let path = Item::new("a path ...", Choice::Prompt(Box::new(prompt)));
        let selected =
            usize::from(up.is_some()) + if folder.files.is_empty() { 0 } else { folder.folders.len() };
        let has_curve = is_curve && self.model.preset.data.source.is_some();
        let none = has_curve.then(|| Item::new("none: remove the curve", Choice::set(key, NONE)));
        let items = up.into_iter().chain(below).chain(files).chain(shipped).chain([path]).chain(none);
        self.choose(&format!("{title} {}", show_path(&folder.path)), items.collect(), selected);
    }

    /// Whether the preset has a file of its own, which can be saved with it.
    pub(super) fn has_data(&self) -> bool {
        let preset = &self.model.preset;
        let names = ["gap.file", data::FILE].into_iter().filter_map(|key| preset.get(key));
        names.map(|name| name.to_string()).any(|name| !name.starts_with(SHIPPED_DATA))
    }

    /// What choosing a line would make of the gap, if the choice is a shape.
    pub(super) fn picture(&self, action: &Choice) -> Option<Figure> {
        match action {
            Choice::Command(Command::Set { key, text }) if key == "gap.shape" => {
                let mut preset = self.model.preset.clone();
                preset.set(key, text.as_str().into()).ok()?;
                Some(undeformed(&preset))
            }
            _ => None,
        }
    }

    /// Tries a formula whose text has changed; an invalid one leaves the curve as it is.
    pub(super) fn check(&mut self, prompt: &mut Prompt) -> Vec<Effect> {
        prompt.error = None;
        prompt.fault = None;
        let Purpose::Formula(key) = &prompt.purpose else { return Vec::new() };
        if let Some(fault) = prompt.formula_error() {
            prompt.refuse(&fault);
            return Vec::new();
        }
        let command = Command::Try { key: key.clone(), text: prompt.input.value().to_owned() };
        let effects = update(&mut self.model, command);
        let refusal = self.model.message.take_if(|(level, _)| level.is_bad());
        prompt.error = refusal.map(|(_, reason)| reason);
        effects
    }

    /// A prompt left without an answer: what was tried for it is taken back.
    pub(super) fn close(&mut self, prompt: &Prompt) -> Vec<Effect> {
        match prompt.purpose {
            Purpose::Formula(_) => self.run(Command::TakeBack),
            _ => Vec::new(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use pulloff_engine::preset::parameter;
    use pulloff_engine::preset::schema::Kind;

    #[test]
    fn every_shape_has_its_words() {
        let row = parameter("gap.shape").unwrap();
        let Kind::Choice(words) = row.kind else { panic!("{:?}", row.kind) };
        assert_eq!(words, SHAPES.map(|(word, _)| word));
    }
}
