//! How each line and sign of a figure is drawn: its stroke, letter and colour.

use crate::figure::{Role, Sign};
use crate::tui::raster::{Meets, RasterStroke, STABLE, UNSTABLE};
use crate::tui::theme::{Charts, Palette, Theme};
use ratatui::style::Style;

/// The digits of the pinned curves, by number.
const DIGITS: [char; 6] = ['1', '2', '3', '4', '5', '6'];

/// Numbers of snaps; from ten on, a single sign stands for many.
const COUNTS: [&str; 11] = ["0", "1", "2", "3", "4", "5", "6", "7", "8", "9", "*"];

/// The stroke of a line. Solid is stable, broken is not; the colour says which curve it is.
pub fn look(role: Role, theme: Theme) -> RasterStroke {
    use Meets::{Beneath, Shares, Tints};
    let styles = theme.styles();
    let of = |style: Style, meets, is_broken, symbol| RasterStroke {
        style,
        meets,
        is_broken,
        symbol,
        letter: None,
    };
    let stroke = match role {
        Role::Zero => of(styles.dim, Beneath, false, ','),
        Role::Undeformed | Role::Starts => of(styles.smooth, Beneath, true, ','),
        Role::Smooth => of(styles.smooth, Shares, false, 's'),
        Role::Branch => of(styles.smooth, Beneath, true, 'b'),
        Role::Envelope => of(styles.envelope, Shares, false, 'k'),
        Role::Exact => of(styles.exact, Shares, false, 'e'),
        Role::Pin(number) => {
            let at = number.saturating_sub(1) % DIGITS.len();
            of(styles.pins[at], Shares, false, DIGITS[at])
        }
        Role::Unstable => of(styles.curve, Shares, true, UNSTABLE),
        Role::Stable | Role::Body | Role::Edges | Role::Law | Role::Cusps => {
            of(styles.curve, Shares, false, STABLE)
        }
        Role::Loading => of(styles.exact, Beneath, false, 'l'),
        Role::Unloading => of(styles.loops, Beneath, false, 'u'),
        Role::Inadmissible => of(styles.warning, Tints, false, '!'),
        Role::Contact => of(styles.walk, Shares, false, 'c'),
        Role::Pull => of(styles.pull, Tints, false, 'p'),
        Role::Walk | Role::Chosen => of(styles.walk, Tints, false, 'w'),
        Role::Zone => of(styles.jump, Tints, false, 'z'),
        Role::Barrier | Role::Level => of(styles.aid, Beneath, true, '='),
        Role::Device => of(styles.aid, Beneath, true, ':'),
        Role::Jump => of(styles.jump, Beneath, true, 'j'),
        Role::Landings => of(styles.exact, Shares, true, 'n'),
        Role::Unchanged | Role::Twin => of(styles.smooth, Beneath, true, '.'),
    };
    // Where colours are few, a letter along the curve identifies it.
    let is_lettered = matches!(
        role,
        Role::Smooth
            | Role::Exact
            | Role::Envelope
            | Role::Pin(_)
            | Role::Branch
            | Role::Loading
            | Role::Unloading
            | Role::Inadmissible
            | Role::Pull
    );
    let letter =
        (is_lettered && (theme.has_few_colours() || theme.charts == Charts::Ascii)).then_some(stroke.symbol);
    RasterStroke { letter, ..stroke }
}

/// How a legend shows a line; together with its style, or even without colour, no two that meet are the same.
pub fn glyph(role: Role, theme: Theme) -> String {
    let stroke = look(role, theme);
    let is_pin = matches!(role, Role::Pin(_));
    if stroke.letter.is_some() || is_pin || theme.charts == Charts::Ascii {
        return stroke.symbol.to_string();
    }
    let tells = matches!(
        role,
        Role::Contact
            | Role::Zone
            | Role::Jump
            | Role::Walk
            | Role::Chosen
            | Role::Barrier
            | Role::Device
            | Role::Level
            | Role::Starts
    );
    if tells && theme.palette == Palette::Mono {
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
        Sign::Event(number @ 1..=9) | Sign::LastContact(number @ 1..=9) => number.to_string(),
        Sign::Event(_) => "v".to_owned(),
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
