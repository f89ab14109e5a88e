//! Requests for names and paths: saving, exporting, copying.

use super::state::App;
use crate::explorer::export::{Export, Page, file_for};
use crate::explorer::model::Level;
use crate::explorer::{Effect, Id};
use crate::store::Source;
use crate::tui::copy::{self, drawn};
use crate::tui::overlay::{Choice, Dialog, Excerpt, Item, Prompt, Purpose};

impl App {
    pub(super) fn ask_name(&mut self) -> Vec<Effect> {
        let suggestion = match &self.model.source {
            Source::User { name, .. } => name.clone(),
            Source::Shipped(shipped) => format!("my-{}", shipped.name),
            Source::File(_) | Source::Piped { .. } => String::new(),
        };
        let prompt = |with_data| {
            let note = "lower-case letters, digits, - and _; walk and pins stay in the session";
            Prompt::new("Save the preset as", note, suggestion.clone(), Purpose::Name { with_data })
        };
        if self.has_data() {
            let item = |text: &str, with_data| Item::new(text, Choice::Prompt(Box::new(prompt(with_data))));
            let items = vec![
                item("the preset       the data stay where they are", false),
                item("save with data   the data are copied beside the preset", true),
            ];
            self.choose("Save", items, 0)
        } else {
            self.lay(Dialog::Prompt(prompt(false)))
        }
    }

    pub(super) fn ask_export(&mut self) -> Vec<Effect> {
        // What is seen stays as it is now, whatever becomes of the screen while the name is typed.
        let mut all: Vec<Export> =
            Export::ALL.into_iter().filter_map(|what| drawn(self, what).ok()).collect();
        // A figure, which not every view has, takes the place of no other.
        all.sort_by_key(|what| matches!(what, Export::Page(Page::Figure(_))));
        let items = all.into_iter().map(|what| {
            let (name, endings) = (what.name(), what.endings());
            let is_figure = matches!(what, Export::Page(Page::Figure(_)));
            let named = if is_figure { self.model.view.name() } else { name };
            let file = file_for(&self.model.source, named, endings[0]);
            let note = format!("a file ending in .{}", endings.join(" or ."));
            let text = format!("{name:<7} {}", what.meaning());
            let prompt = Prompt::new(format!("Export the {name} to"), &note, file, Purpose::File(what));
            Item::new(text, Choice::Prompt(Box::new(prompt)))
        });
        self.choose("Export", items.collect(), 0)
    }

    pub(super) fn ask_copy(&mut self) -> Vec<Effect> {
        let items = Excerpt::ALL.map(|content| {
            let [name, meaning] = content.words();
            Item::new(format!("{name:<7} {meaning}"), Choice::Copy(content))
        });
        self.choose("Copy", items.to_vec(), 0)
    }

    /// Puts text on the clipboard, if it is not too long.
    pub(super) fn copy(&mut self, content: Excerpt) -> Vec<Effect> {
        let (text, export) = (copy::text(self, content), Id::Export.named());
        let bytes = text.len();
        if bytes > copy::LONGEST {
            let told = format!("{bytes} bytes are more than terminals take: {export} exports to a file");
            return self.say(Level::Error, told);
        }
        self.clipboard = Some(text);
        let name = content.words()[0];
        let told = format!("{name} of {bytes} bytes sent to the terminal's clipboard");
        self.say(Level::Info, format!("{told}; if none arrive, {export} exports to a file"))
    }
}
