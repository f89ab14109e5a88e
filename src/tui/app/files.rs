//! Requests for names and paths: saving, exporting, copying.

use super::state::App;
use crate::explorer::export::{ExportKind, Page, Picture, file_for};
use crate::explorer::model::Level;
use crate::explorer::{Command, Effect, Id};
use crate::plot::picture::picture;
use crate::store::Source;
use crate::tui::copy;
use crate::tui::overlay::{Choice, Dialog, Excerpt, Item, Prompt, Purpose};

impl App {
    pub(super) fn ask_name(&mut self) -> Vec<Effect> {
        let suggestion = match &self.model.source {
            Source::User { name, .. } => name.clone(),
            Source::Shipped(shipped) => format!("my-{}", shipped.name),
            Source::File(_) | Source::Piped { .. } => String::new(),
        };
        let prompt = |with_data| {
            let note = "lower-case letters, digits, - and _";
            Prompt::new("Save the preset as", note, suggestion.clone(), Purpose::Name { with_data })
        };
        if self.has_data() {
            let item = |text: &str, with_data| Item::new(text, Choice::Prompt(Box::new(prompt(with_data))));
            let items = vec![
                item("the preset       the data stay where they are", false),
                item("save with data   the data are copied beside the preset", true),
            ];
            self.choose("Save", items, 0);
        } else {
            self.overlay = Some(Dialog::Prompt(prompt(false)));
        }
        Vec::new()
    }

    pub(super) fn ask_export(&mut self) -> Vec<Effect> {
        let items = ExportKind::ALL.map(|what| {
            let file = file_for(&self.model.source, what.name(), what.endings()[0]);
            let title = format!("Export the {} to", what.name());
            let note = format!("a file ending in .{}", what.endings().join(" or ."));
            let prompt = Prompt::new(title, &note, file, Purpose::File(what));
            let text = format!("{:<7} {}", what.name(), what.meaning());
            Item::new(text, Choice::Prompt(Box::new(prompt)))
        });
        let item = |what: Picture, page| {
            let endings = what.endings();
            let title = format!("Export the {} to", what.name());
            let note = format!("a file ending in .{}", endings.join(" or ."));
            let named = if let Picture::Figure(_) = what { self.model.view.name() } else { what.name() };
            let file = file_for(&self.model.source, named, endings[0]);
            let prompt = Prompt::new(title, &note, file, Purpose::Page(page));
            Item::new(format!("{:<7} {}", what.name(), what.meaning()), Choice::Prompt(Box::new(prompt)))
        };
        let screen = item(Picture::Screen, Page::Screen(copy::text(self, Excerpt::Screen)));
        let figure = picture(&self.model, self.model.view).ok();
        let figure = figure.map(|svg| item(Picture::Figure(None), Page::Figure(svg)));
        self.choose("Export", items.into_iter().chain([screen]).chain(figure).collect(), 0);
        Vec::new()
    }

    /// Draws what is seen, for its export.
    pub(super) fn draw_page(&mut self, what: Picture, path: String, replace: bool) -> Option<Command> {
        let page = match what {
            Picture::Screen => Ok(Page::Screen(copy::text(self, Excerpt::Screen))),
            Picture::Figure(view) => picture(&self.model, view.unwrap_or(self.model.view)).map(Page::Figure),
        };
        match page {
            Ok(page) => Some(Command::ExportPage { page, path, replace }),
            Err(why) => {
                self.model.message = Some((Level::Error, format!("not exported: {why}")));
                None
            }
        }
    }

    pub(super) fn ask_copy(&mut self) -> Vec<Effect> {
        let items = Excerpt::ALL.map(|content| {
            Item::new(format!("{:<7} {}", content.name(), content.meaning()), Choice::Copy(content))
        });
        self.choose("Copy", items.to_vec(), 0);
        Vec::new()
    }

    /// Puts text on the clipboard, if it is not too long.
    pub(super) fn copy(&mut self, content: Excerpt) {
        let text = copy::text(self, content);
        let (level, told) = if text.len() > copy::LONGEST {
            let export = Id::Export.named();
            let told =
                format!("{} bytes are more than terminals take: {export} exports to a file", text.len());
            (Level::Error, told)
        } else {
            let told = format!(
                "{} of {} bytes sent to the terminal's clipboard; if none arrive, {} exports to a file",
                content.name(),
                text.len(),
                Id::Export.named()
            );
            self.clipboard = Some(text);
            (Level::Info, told)
        };
        self.model.message = Some((level, told));
    }
}
