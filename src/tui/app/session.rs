//! Sessions that go on, and the branches of the walk.

use super::state::App;
use crate::explorer::branches::branches;
use crate::explorer::session::Snapshot;
use crate::explorer::{Command, Effect, pins};
use crate::tui::overlay::{Action, Item, Offer, Overlay as Over};
use crate::tui::theme::Theme;
use crossterm::event::{KeyCode, KeyEvent};
use pulloff_engine::report::number::{significant, with_unit};
use pulloff_engine::units::Quantity;

impl App {
    /// Goes on with a session.
    pub fn resumed(snapshot: Snapshot, theme: Theme) -> (Self, Vec<Effect>) {
        let (model, effects) = snapshot.resume(None);
        (Self::on(model, theme), effects)
    }

    /// Offers a session.
    pub fn offer(&mut self, what: &str, snapshot: Snapshot) {
        let question = format!("{what} Enter goes on with it, Esc begins anew.");
        self.overlay = Some(Over::Offer(Offer { question, snapshot: Box::new(snapshot) }));
    }

    /// Whether a session is offered and no answer given yet.
    pub fn is_offering(&self) -> bool {
        matches!(self.overlay, Some(Over::Offer(_)))
    }

    pub(super) fn offer_key(&mut self, offer: Offer, key: KeyEvent) -> Vec<Effect> {
        match key.code {
            KeyCode::Enter | KeyCode::Char('y') => {
                let (model, effects) = offer.snapshot.resume(Some(&self.model));
                self.model = model;
                effects
            }
            KeyCode::Esc | KeyCode::Char('n' | 'N') => Vec::new(),
            // Whoever types on does not want it, and means the key; n says no.
            _ => self.command_key(key),
        }
    }

    /// The branches of the walk: how many steps, where each ended, and in which values it differs from those of now.
    pub(super) fn ask_branch(&mut self) -> Vec<Effect> {
        let numbering = self.model.history.numbering();
        let (mut items, mut here) = (Vec::new(), 0);
        for branch in branches(&self.model.history) {
            let Some(node) = branch.last() else { continue };
            if branch.is_here {
                here = items.len();
            }
            let state = node.state.in_units(node.setting.units());
            let units = &node.setting.preset.units;
            let value = |quantity, x| with_unit(units, quantity, x, self.theme.ascii, |x| significant(x, 4));
            let place = if node.is_apart() {
                "the bodies are apart".to_owned()
            } else {
                format!(
                    "δ {} P {} s {}",
                    value(Quantity::Length, state.approach),
                    value(Quantity::Force, state.force),
                    value(Quantity::Length, state.contact_radius)
                )
            };
            let differs = pins::name(&node.setting.preset, &self.model.preset);
            let mark = if branch.is_here { "here" } else { "" };
            let text = format!("{mark:<4} step {:<5} {place}  {differs}", node.step);
            let action = Action::Command(Command::GoTo { node: branch.end, numbering });
            items.push(Item::new(self.theme.symbols(&text), action));
        }
        self.choose("Branches of the walk", items, here);
        Vec::new()
    }
}
