//! Every theme and every marker: nothing is lost without colour, without braille, without Unicode.

use super::Screen;
use crate::explorer::View;
use crate::figure::{Role, Subject};
use crate::tui::marks::{glyph, letter, look};
use crate::tui::theme::{Charts, Palette, Theme};
use ratatui::style::Color;
use std::collections::HashMap;

const PALETTES: [Palette; 5] =
    [Palette::Dark, Palette::Light, Palette::Mono, Palette::FewDark, Palette::FewLight];

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
                    // Where colours are few only those with a name.
                    assert!(!colours.iter().any(|c| matches!(c, Color::Rgb(..))));
                    let is_one_of_many = colours.iter().any(|c| matches!(c, Color::Indexed(_)));
                    assert!(!theme.has_few_colours() || !is_one_of_many, "{theme:?}");
                    // Bright black is the background of some themes.
                    assert!(!colours.contains(&Color::DarkGray), "{theme:?}");
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
fn in_every_figure_each_line_has_a_look_of_its_own() {
    for preset in ["wavy-sphere", "fig-3-jkr", "fig-1-hertz"] {
        let screen = full(preset);
        let subject = Subject::of(&screen.app.model).unwrap();
        for theme in themes() {
            for view in View::ALL {
                let figure = subject.figure(view);
                let mut of: HashMap<String, Role> = HashMap::new();
                for line in figure.lines.iter().filter(|line| !line.name.is_empty()) {
                    let color = look(line.role, theme).style.fg;
                    let told = format!("{} {color:?}", glyph(line.role, theme));
                    let known = *of.entry(told.clone()).or_insert(line.role);
                    assert_eq!(known, line.role, "{told} in {view:?} {theme:?}");
                }
                for mark in &figure.marks {
                    let letter = letter(mark.sign, theme);
                    let is_digit = letter.chars().all(|c| c.is_ascii_digit());
                    let is_line = of.keys().any(|told| told.starts_with(&format!("{letter} ")));
                    assert!(
                        is_digit || letter == "o" || letter == "." || !is_line,
                        "{:?} in {view:?}",
                        mark.sign
                    );
                }
            }
        }
    }
}

#[test]
fn compared_curves_look_different_without_colour() {
    use Role::{Envelope, Exact, Pin, Smooth, Stable, Unstable};
    let roles = [Stable, Unstable, Smooth, Envelope, Exact, Pin(1), Pin(2), Pin(3), Pin(4), Pin(5), Pin(6)];
    for theme in themes().into_iter().filter(|theme| theme.has_few_colours()) {
        let told = |role| (glyph(role, theme), look(role, theme).letter, look(role, theme).is_broken);
        for (i, a) in roles.iter().enumerate() {
            assert!(roles[i + 1..].iter().all(|b| told(*a) != told(*b)), "{a:?} {theme:?}");
        }
    }
    // Pattern is stability in every theme.
    for theme in themes() {
        assert!(look(Unstable, theme).is_broken && !look(Stable, theme).is_broken);
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
    assert!(text.contains("━ stable  ╌ unstable"), "{text}");
    assert!(super::find(&buffer, "Problem").modifier.contains(Modifier::REVERSED));
    assert!(!super::find(&buffer, "Walker").modifier.contains(Modifier::REVERSED));
    assert!(super::find(&buffer, "LIMIT").modifier.contains(Modifier::UNDERLINED));
    assert!(super::find(&buffer, "Space step").modifier.contains(Modifier::UNDERLINED));
}
