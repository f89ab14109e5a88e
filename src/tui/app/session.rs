//! Resumed sessions.

use super::state::App;
use crate::explorer::session::Snapshot;
use crate::explorer::{Effect, Id};
use crate::tui::overlay::{Dialog, ResumeOffer};
use crate::tui::theme::Theme;
use crossterm::event::{KeyCode, KeyEvent};

impl App {
    /// Resumes a session.
    pub fn resumed(snapshot: Snapshot, theme: Theme) -> (Self, Vec<Effect>) {
        let (model, effects) = snapshot.resume(None);
        (Self::on(model, theme), effects)
    }

    /// Offers to resume a session.
    pub fn offer(&mut self, what: &str, snapshot: Snapshot) {
        let question = format!("{what} Enter resumes it, Esc starts afresh.");
        self.overlay = Some(Dialog::Offer(ResumeOffer { question, snapshot: Box::new(snapshot) }));
    }

    /// Whether a session is on offer and not yet answered.
    pub fn is_offering(&self) -> bool {
        matches!(self.overlay, Some(Dialog::Offer(_)))
    }

    pub(super) fn offer_key(&mut self, offer: ResumeOffer, key: KeyEvent) -> Vec<Effect> {
        match key.code {
            KeyCode::Enter => {
                let (model, effects) = offer.snapshot.resume(Some(&self.model));
                self.model = model;
                effects
            }
            KeyCode::Esc => Vec::new(),
            _ if self.keymap.command(key) == Some(Id::Quit) => self.command_key(key),
            // A key pressed while the screen comes up must not answer it.
            _ => self.lay(Dialog::Offer(offer)),
        }
    }
}
