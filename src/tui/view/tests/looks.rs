//! Every theme and every marker: nothing is lost without colour, without braille, without Unicode.

use super::Screen;
use crate::explorer::View;
use crate::figure::{Role, Subject};
use crate::tui::theme::{Charts, Palette, Theme};
use crate::tui::view::marks::{letter, look};
use ratatui::style::Color;
use std::collections::HashMap;

const PALETTES: [Palette; 3] = [Palette::Dark, Palette::Light, Palette::Mono];

fn themes() -> Vec<Theme> {
    let looks =
        [(Charts::Braille, false), (Charts::Block, false), (Charts::Ascii, false), (Charts::Ascii, true)];
    let of = |palette| looks.map(|(charts, ascii)| Theme::new(palette, charts, ascii));
    PALETTES.into_iter().flat_map(of).collect()
}

/// A walk with a jump, two pins, all the theory, the device's line.
fn full(preset: &str) -> Screen {
    let mut screen = Screen::new(preset);
    screen.keys("nxnp}pKy\rj\rj\r\x1b");
    screen
}

#[test]
fn every_theme_draws_every_view_and_mono_has_no_colour() {
    let mut screen = full("wavy-sphere");
    for theme in themes() {
        screen.app.theme = theme;
        for _ in View::ALL {
            for (width, height) in [(80, 24), (200, 60)] {
                let buffer = screen.draw(width, height);
                for cell in buffer.content() {
                    let colours = [cell.fg, cell.bg];
                    if theme.palette == Palette::Mono {
                        assert_eq!(colours, [Color::Reset; 2], "{theme:?} {}", cell.symbol());
                    }
                    // Only those with a name: others need more than sixteen colours.
                    assert!(!colours.iter().any(|c| matches!(c, Color::Rgb(..) | Color::Indexed(_))));
                    assert!(!theme.ascii || cell.symbol().is_ascii(), "{theme:?} {}", cell.symbol());
                    let is_braille = cell.symbol().chars().any(|c| ('\u{2800}'..='\u{28ff}').contains(&c));
                    assert!(!is_braille || theme.charts == Charts::Braille, "{theme:?}");
                }
                let drawn = buffer.content().iter().filter(|cell| cell.symbol() != " ").count();
                assert!(drawn > 500, "{theme:?}");
            }
            screen.keys("t");
        }
    }
}

#[test]
fn in_every_figure_each_line_has_a_glyph_of_its_own() {
    for preset in ["wavy-sphere", "fig-3-jkr", "fig-1-hertz"] {
        let screen = full(preset);
        let subject = Subject::of(&screen.app.model).unwrap();
        for theme in themes() {
            for view in View::ALL {
                let figure = subject.figure(view);
                let mut of: HashMap<&str, Role> = HashMap::new();
                for line in figure.lines.iter().filter(|line| !line.name.is_empty()) {
                    let glyph = look(line.role, theme.styles()).0.glyph(theme);
                    assert_eq!(*of.entry(glyph).or_insert(line.role), line.role, "{glyph} in {view:?}");
                }
                for mark in &figure.marks {
                    assert!(!of.contains_key(letter(mark.sign)), "{:?} in {view:?}", mark.sign);
                }
            }
        }
    }
}

#[test]
fn roles_that_can_meet_in_one_chart_look_different_without_colour() {
    use Role::{
        Barrier, Contact, Device, Envelope, Exact, Inadmissible, Jump, Pin, Smooth, Stable, Unstable, Walk,
    };
    let roles = [
        Smooth,
        Envelope,
        Pin(1),
        Pin(2),
        Pin(3),
        Pin(4),
        Pin(5),
        Pin(6),
        Exact,
        Unstable,
        Stable,
        Inadmissible,
        Contact,
        Barrier,
        Device,
        Walk,
        Jump,
    ];
    for theme in themes() {
        let mut glyphs: Vec<_> = roles.map(|role| look(role, theme.styles()).0.glyph(theme)).to_vec();
        glyphs.sort_unstable();
        glyphs.dedup();
        assert_eq!(glyphs.len(), roles.len(), "{theme:?}");
        // What the canvas draws differs as well, but for lines that a letter tells apart.
        let drawn = |role| {
            let stroke = look(role, theme.styles()).0;
            (format!("{:?}", stroke.marker(theme)), format!("{stroke:?}"))
        };
        for (i, a) in roles.iter().enumerate() {
            assert!(roles[i + 1..].iter().all(|b| drawn(*a) != drawn(*b)), "{a:?}");
        }
    }
}

#[test]
fn every_screen_is_ascii_in_an_ascii_terminal() {
    let plain = Theme::new(Palette::Mono, Charts::Braille, true);
    let presets: Vec<&str> = crate::store::shipped::SHIPPED.iter().map(|shipped| shipped.name).collect();
    for preset in presets {
        let mut screen = Screen::new(preset);
        screen.app.theme = plain;
        // Walks take long: one is enough.
        let walk: &[&str] = if preset == "wavy-sphere" { &["n", "x", "c", "i"] } else { &[] };
        let all = ["", "?", "\x1bP\x1be\x1b\r", "\x1ba", "\t\r\x1b", "v"];
        for keys in all.iter().chain(walk) {
            screen.keys(keys);
            for (width, height) in [(80, 24), (200, 60)] {
                let text = screen.text(width, height);
                let stray: String = text.chars().filter(|c| !c.is_ascii()).collect();
                assert!(stray.is_empty(), "{preset} {keys}: {stray} in {text}");
            }
        }
    }
}

#[test]
fn without_colour_selection_errors_and_keys_are_seen() {
    use ratatui::style::Modifier;
    let mut screen = Screen::new("wavy-sphere");
    screen.app.theme = Theme::new(Palette::Mono, Charts::Braille, false);
    screen.keys("n");
    let buffer = screen.draw(80, 24);
    let text = screen.text(80, 24);
    assert!(text.contains("━ stable, ┈ unstable"), "{text}");
    assert!(super::find(&buffer, "Problem").modifier.contains(Modifier::REVERSED));
    assert!(!super::find(&buffer, "Walker").modifier.contains(Modifier::REVERSED));
    assert!(super::find(&buffer, "LIMIT").modifier.contains(Modifier::UNDERLINED));
    assert!(super::find(&buffer, "Space step").modifier.contains(Modifier::UNDERLINED));
}
