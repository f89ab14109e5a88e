//! What the screen shows and holds: the model, what lies over it, how it is drawn.

use super::typed::Typed;
use crate::explorer::{Effect, Model, open};
use crate::store::Loaded;
use crate::tui::keymap::Keymap;
use crate::tui::overlay::Dialog;
use crate::tui::theme::Theme;
use ratatui::layout::Rect;

/// The explorer as a person sees it.
#[derive(Debug)]
pub struct App {
    pub model: Model,
    pub overlay: Option<Dialog>,
    /// Whether the next key says which place to go to.
    pub going: bool,
    pub theme: Theme,
    pub keymap: Keymap,
    pub typed: Typed,
    /// Whether the mouse is taken from the terminal.
    pub mouse: bool,
    /// Whether the selected panel fills the whole screen.
    pub enlarged: bool,
    pub clipboard: Option<String>,
    /// The screen as last drawn.
    pub screen: Rect,
    /// The first value shown in Problem as last drawn.
    pub first_value: usize,
    /// The message about a background job that takes long enough to be shown.
    pub late: Option<String>,
    /// How many presses before the last key belong to the same hold of that key.
    pub held: usize,
}

impl App {
    /// Opens a preset.
    pub fn new(loaded: Loaded, theme: Theme) -> (Self, Vec<Effect>) {
        let (model, effects) = open(loaded);
        (Self::on(model, theme), effects)
    }

    /// Puts a session on a screen.
    pub fn on(model: Model, theme: Theme) -> Self {
        Self {
            model,
            overlay: None,
            going: false,
            theme,
            keymap: Keymap::default(),
            typed: Typed::default(),
            mouse: false,
            enlarged: false,
            clipboard: None,
            screen: Rect::ZERO,
            first_value: 0,
            late: None,
            held: 0,
        }
    }
}
