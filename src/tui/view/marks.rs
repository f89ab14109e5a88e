//! How each line and sign of a figure is drawn: its stroke, letter and colour.

use crate::figure::{Role, Sign};
use crate::tui::stroke::Stroke;
use crate::tui::theme::Styles;
use pulloff_engine::problem::Control;
use ratatui::style::Style;

/// The digits of the pinned curves, by number.
const DIGITS: [&str; 6] = ["1", "2", "3", "4", "5", "6"];

/// Numbers of snaps; from ten on there is a sign for many.
const COUNTS: [&str; 11] = ["0", "1", "2", "3", "4", "5", "6", "7", "8", "9", "*"];

/// The stroke and the style of a line.
pub fn look(role: Role, styles: &Styles) -> (Stroke, Style) {
    match role {
        Role::Zero | Role::Undeformed | Role::Smooth => (Stroke::Sparse, styles.smooth),
        Role::Branch => (Stroke::Lettered("b"), styles.smooth),
        Role::Envelope => (Stroke::LongDashed, styles.exact),
        Role::Exact => (Stroke::Dashed, styles.exact),
        Role::Pin(number) => {
            let at = number.saturating_sub(1) % DIGITS.len();
            (Stroke::Lettered(DIGITS[at]), styles.pins[at])
        }
        Role::Unstable => (Stroke::Dotted, styles.unstable),
        Role::Loading => (Stroke::Marked("l"), styles.exact),
        Role::Unloading => (Stroke::Marked("u"), styles.stable),
        Role::Stable | Role::Body | Role::Edges => (Stroke::Solid, styles.stable),
        Role::Inadmissible => (Stroke::Repeated("!"), styles.aid),
        Role::Contact => (Stroke::Marked("c"), styles.walk),
        Role::Walk => (Stroke::Marked("w"), styles.walk),
        Role::Barrier => (Stroke::DashDotted, styles.aid),
        Role::Device => (Stroke::ShortDashed, styles.aid),
        Role::Jump => (Stroke::Marked("j"), styles.jump),
        Role::Unchanged | Role::Twin => (Stroke::Dotted, styles.smooth),
        Role::Starts => (Stroke::Sparse, styles.smooth),
        Role::Landings => (Stroke::Dashed, styles.unstable),
        Role::Cusps | Role::Law => (Stroke::Solid, styles.stable),
        Role::Level => (Stroke::LongDashed, styles.aid),
    }
}

/// The letter of a sign.
pub fn letter(sign: Sign) -> &'static str {
    match sign {
        Sign::OtherLimit(Control::Force) => "p",
        Sign::OtherLimit(_) => "d",
        Sign::Limit => "v",
        Sign::PullOff => "X",
        Sign::Landing => "L",
        Sign::Touch => "t",
        Sign::Turn => "T",
        Sign::Crest => "^",
        Sign::Edge => "|",
        Sign::Minimum => "m",
        Sign::Maximum => "M",
        Sign::Barrier => "B",
        Sign::Stray | Sign::Walker => "@",
        Sign::Cusp => "C",
        Sign::Swallowtail => "S",
        Sign::Preset => "+",
        Sign::Snaps(n) => COUNTS[n.min(COUNTS.len() - 1)],
        Sign::Value => "o",
        Sign::Measured { loading: true } => ",",
        Sign::Measured { loading: false } => ".",
    }
}
