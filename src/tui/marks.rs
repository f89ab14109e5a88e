//! How each line and sign of a figure is drawn: its stroke, letter and colour.

use crate::explorer::pins;
use crate::figure::{Role, Sign};
use crate::tui::raster::{Meets, RasterStroke, STABLE, UNSTABLE};
use crate::tui::theme::{Charts, Palette, Theme};
use ratatui::style::Style;

/// Numbers of snaps; from ten on, a single sign stands for many.
const COUNTS: [&str; 11] = ["0", "1", "2", "3", "4", "5", "6", "7", "8", "9", "*"];

/// Where the letter of a line identifies it, apart from charts of characters.
#[derive(PartialEq)]
enum Lettered {
    /// Along the line and in the legend, where colours are few.
    Along,
    /// In the legend, where there is no colour at all.
    Legend,
    Never,
}

/// A line's stroke without its letter, where the letter is, and its rank in the legend, the most important first.
fn row(role: Role, theme: Theme) -> (RasterStroke, Lettered, u8) {
    use Lettered::{Along, Legend, Never};
    use Meets::{Beneath, Shares, Tints};
    let styles = theme.styles();
    let (style, meets, is_broken, symbol, lettered, rank) = match role {
        Role::Zero => (styles.dim, Beneath, false, ',', Never, 9),
        Role::Undeformed => (styles.smooth, Beneath, true, ',', Never, 9),
        Role::Starts => (styles.smooth, Beneath, true, ',', Legend, 9),
        Role::Smooth => (styles.smooth, Shares, false, 's', Along, 6),
        Role::Branch => (styles.smooth, Beneath, true, 'b', Along, 9),
        Role::Envelope => (styles.envelope, Shares, false, 'k', Along, 6),
        Role::Exact => (styles.exact, Shares, false, 'e', Along, 6),
        // Requested by the person, and often with numbers.
        Role::Pin(number) => {
            let at = number.saturating_sub(1) % styles.pins.len();
            let symbol = pins::letter(number).chars().next().unwrap_or('p');
            (styles.pins[at], Shares, false, symbol, Along, 2)
        }
        Role::Unstable => (styles.curve, Shares, true, UNSTABLE, Never, 1),
        Role::Stable | Role::Body | Role::Edges | Role::Law | Role::Cusps => {
            (styles.curve, Shares, false, STABLE, Never, 0)
        }
        Role::Loading => (styles.exact, Beneath, false, 'l', Along, 8),
        Role::Unloading => (styles.loops, Beneath, false, 'u', Along, 8),
        Role::Inadmissible => (styles.warning, Tints, false, '!', Along, 3),
        Role::Contact => (styles.walk, Shares, false, 'c', Legend, 8),
        Role::Pull => (styles.pull, Tints, false, 'p', Along, 3),
        Role::Walk | Role::Chosen => (styles.walk, Tints, false, 'w', Legend, 3),
        Role::Zone => (styles.jump, Tints, false, 'z', Legend, 3),
        Role::Barrier => (styles.aid, Beneath, true, '=', Legend, 8),
        Role::Level => (styles.aid, Beneath, true, '=', Legend, 3),
        // Unnamed beside measured points, it would be taken for a curve that misses them.
        Role::Device => (styles.aid, Beneath, true, ':', Legend, 2),
        Role::Jump => (styles.jump, Beneath, true, 'j', Legend, 9),
        Role::Landings => (styles.exact, Shares, true, 'n', Never, 1),
        Role::Unchanged | Role::Twin => (styles.smooth, Beneath, true, '.', Never, 9),
    };
    (RasterStroke { style, meets, is_broken, symbol, letter: None }, lettered, rank)
}

/// The stroke of a line. Solid is stable, broken is not; the colour says which curve it is.
pub fn look(role: Role, theme: Theme) -> RasterStroke {
    let (stroke, lettered, _) = row(role, theme);
    let is_told = lettered == Lettered::Along && (theme.has_few_colours() || theme.charts == Charts::Ascii);
    RasterStroke { letter: is_told.then_some(stroke.symbol), ..stroke }
}

/// The rank of a line in the legend, the most important first.
pub fn rank(role: Role, theme: Theme) -> u8 {
    row(role, theme).2
}

/// How a legend shows a line; together with its style, or even without colour, no two that meet are the same.
pub fn glyph(role: Role, theme: Theme) -> String {
    let (stroke, lettered, _) = row(role, theme);
    let is_told = match lettered {
        Lettered::Along => theme.has_few_colours() || matches!(role, Role::Pin(_)),
        Lettered::Legend => theme.palette == Palette::Mono,
        Lettered::Never => false,
    };
    if is_told || theme.charts == Charts::Ascii {
        return stroke.symbol.to_string();
    }
    let of = |solid: &str, broken: &str| if stroke.is_broken { broken } else { solid }.to_owned();
    if theme.charts == Charts::Block { of("▄▄", "▄ ▄") } else { of("━", "╌") }
}

/// The letter of a sign; `\u{b7}` is a mark that is not an event.
pub fn letter(sign: Sign, theme: Theme) -> String {
    let one = |unicode: &str, ascii: &str| theme.glyph(unicode, ascii).to_owned();
    match sign {
        Sign::OtherLimit(_) | Sign::Limit => one("·", "."),
        Sign::Event(number @ 1..=9) | Sign::Passing(number @ 1..=9) | Sign::LastContact(number @ 1..=9) => {
            number.to_string()
        }
        Sign::Event(_) | Sign::Passing(_) => "v".to_owned(),
        Sign::LastContact(_) => one("×", "X"),
        Sign::Landing => one("○", "O"),
        Sign::Touch => "t".to_owned(),
        Sign::Turn => "T".to_owned(),
        Sign::Crest => "^".to_owned(),
        Sign::Edge => "|".to_owned(),
        Sign::Minimum => "m".to_owned(),
        Sign::Maximum => "M".to_owned(),
        Sign::LargestPull => "A".to_owned(),
        Sign::Farthest | Sign::Barrier => "B".to_owned(),
        Sign::Stray | Sign::Walker => "@".to_owned(),
        Sign::Value => "o".to_owned(),
        Sign::Letter(letter) => letter.to_string(),
        Sign::Cusp => "C".to_owned(),
        Sign::Swallowtail => "S".to_owned(),
        Sign::Preset => "+".to_owned(),
        Sign::OfCrest(crest) => format!("c{crest}"),
        Sign::Snaps(n) => COUNTS[n.min(COUNTS.len() - 1)].to_owned(),
        Sign::Measured { loading: true, apart: false } => ",".to_owned(),
        Sign::Measured { loading: false, apart: false } => ".".to_owned(),
        Sign::Measured { loading: true, apart: true } => "`".to_owned(),
        Sign::Measured { loading: false, apart: true } => "'".to_owned(),
    }
}

/// The style of a sign.
pub fn style(sign: Sign, theme: Theme) -> Style {
    let styles = theme.styles();
    match sign {
        Sign::OtherLimit(_) | Sign::Limit => styles.dim,
        Sign::Landing => styles.landing,
        Sign::Crest | Sign::Edge | Sign::Snaps(_) | Sign::Measured { .. } => styles.smooth,
        Sign::Stray => styles.stray,
        Sign::Walker | Sign::Preset => styles.walker,
        _ => styles.mark,
    }
}
