//! Every theme and every marker: nothing is lost without colour, without braille, or without Unicode.

use super::Screen;
use crate::explorer::{View, Window};
use crate::figure::{Bounds, Role, Sign, Subject};
use crate::tui::marks::{glyph, letter, look};
use crate::tui::theme::{Charts, Palette, Theme};
use crate::tui::view::{charts, places};
use ratatui::layout::Rect;
use ratatui::style::Color;
use std::collections::{HashMap, HashSet};

const PALETTES: [Palette; 6] =
    [Palette::Any, Palette::Dark, Palette::Light, Palette::Mono, Palette::FewDark, Palette::FewLight];

fn themes() -> Vec<Theme> {
    let looks =
        [(Charts::Braille, false), (Charts::Block, false), (Charts::Ascii, false), (Charts::Ascii, true)];
    let of = |palette| looks.map(|(charts, ascii)| Theme::new(palette, charts, ascii));
    PALETTES.into_iter().flat_map(of).collect()
}

/// A walk with a jump, two pins, all theory, and the line of the device.
fn full(preset: &str) -> Screen {
    let mut screen = Screen::new(preset);
    screen.keys("nxnp}py\rj\rj\rj\r\x1b");
    screen
}

/// The cells of a plot that a line of a figure passes through, from its points alone.
fn passed(points: &[(f64, f64)], bounds: &Bounds, plot: Rect) -> HashSet<(u16, u16)> {
    let cells = |(x, y): (f64, f64)| {
        let share = |value: f64, [lo, hi]: [f64; 2]| (value - lo) / (hi - lo);
        (share(x, bounds.x) * f64::from(plot.width), (1.0 - share(y, bounds.y)) * f64::from(plot.height))
    };
    let mut passed = HashSet::new();
    for pair in points.windows(2) {
        let [from, to] = [cells(pair[0]), cells(pair[1])];
        let steps = (20.0 * (to.0 - from.0).abs().max((to.1 - from.1).abs())).ceil();
        if !steps.is_finite() {
            continue;
        }
        let mut step = 0.0;
        while step <= steps {
            let share = step / steps.max(1.0);
            step += 1.0;
            let at = [from.0 + share * (to.0 - from.0), from.1 + share * (to.1 - from.1)];
            if at[0] >= 0.0 && at[1] >= 0.0 && at[0] < f64::from(plot.width) && at[1] < f64::from(plot.height)
            {
                // Below the sides of the plot.
                #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
                passed.insert((plot.x + at[0] as u16, plot.y + at[1] as u16));
            }
        }
    }
    passed
}

#[test]
fn the_curve_a_pin_and_theory_are_all_seen() {
    let mut screen = Screen::new("wavy-sphere");
    screen.keys("p:set gap.amplitude=0.006\r");
    let (model, size) = (&screen.app.model, Rect::new(0, 0, 120, 41));
    let subject = Subject::of(model).unwrap();
    let figure = subject.figure(View::ForceApproach);
    let (_, area) = places(&screen.app, size).unwrap().charts[0];
    let chart = charts::chart(&figure, View::ForceApproach, &Window::WHOLE, screen.app.theme);
    let plot = chart.plot(area).unwrap();
    let is_curve = |role: Role| matches!(role, Role::Stable | Role::Unstable);
    let lines = |wanted: &dyn Fn(Role) -> bool| -> HashSet<(u16, u16)> {
        let lines = figure.lines.iter().filter(|line| wanted(line.role));
        lines.flat_map(|line| passed(&line.points, &chart.bounds, plot)).collect()
    };
    let all = [
        (look(Role::Stable, screen.app.theme), lines(&is_curve)),
        (look(Role::Pin(1), screen.app.theme), lines(&|role| role == Role::Pin(1))),
        (look(Role::Smooth, screen.app.theme), lines(&|role| role == Role::Smooth)),
    ];
    // The states walked are drawn over the curves, and so are the marks.
    let over = lines(&|role| role == Role::Walk);
    let buffer = screen.draw(120, 41);
    let is_dots =
        |at: &(u16, u16)| buffer[*at].symbol().chars().all(|c| ('\u{2800}'..='\u{28ff}').contains(&c));
    let is_marked = |at: &(u16, u16)| over.contains(at) || !(is_dots(at) || buffer[*at].symbol() == " ");
    let shows = |at: &(u16, u16)| buffer[*at].fg;
    for (own, (stroke, cells)) in all.iter().enumerate() {
        let others =
            || all.iter().enumerate().filter(|(other, _)| *other != own).map(|(_, (_, cells))| cells);
        let alone: Vec<_> =
            cells.iter().filter(|at| !is_marked(at) && !others().any(|other| other.contains(at))).collect();
        let seen = alone.iter().filter(|at| Some(shows(at)) == stroke.style.fg).count();
        assert!(5 * seen >= 4 * alone.len(), "{own}: {seen} of {}", alone.len());
        let all_seen = cells.iter().filter(|at| Some(shows(at)) == stroke.style.fg).count();
        assert!(5 * all_seen >= cells.len(), "{own}: {all_seen} of {}", cells.len());
    }
    let [curve, pin, smooth] = all.each_ref().map(|(_, cells)| cells);
    let shared: Vec<_> =
        curve.intersection(pin).filter(|at| !smooth.contains(at) && !is_marked(at)).collect();
    for (stroke, _) in &all[..2] {
        let seen = shared.iter().filter(|at| Some(shows(at)) == stroke.style.fg).count() as f64;
        let share = seen / shared.len() as f64;
        assert!(shared.len() > 50 && (0.4..=0.6).contains(&share), "{seen} of {}", shared.len());
    }
}

#[test]
fn every_theme_draws_every_view_and_mono_has_no_colour() {
    let mut screen = full("wavy-sphere");
    for view in View::ALL {
        screen.keys(&format!(":view {}\r", view.name()));
        for theme in themes() {
            screen.app.theme = theme;
            for (width, height) in [(80, 24), (200, 60)] {
                let buffer = screen.draw(width, height);
                for cell in buffer.content() {
                    let colours = [cell.fg, cell.bg];
                    if theme.palette == Palette::Mono {
                        assert_eq!(colours, [Color::Reset; 2], "{theme:?} {}", cell.symbol());
                    }
                    // Where colours are few, only those with a name.
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
fn no_legend_is_cut() {
    for preset in ["wavy-sphere", "fig-9-si", "lens"] {
        let mut screen = Screen::new(preset);
        for keys in ["", "nx", "p}n"] {
            screen.keys(keys);
            for view in View::ALL {
                screen.keys(&format!(":view {}\r", view.name()));
                for (width, height) in [(80, 24), (120, 40)] {
                    let text = screen.text(width, height);
                    assert!(!text.contains(" …"), "{preset} {width}x{height} {text}");
                }
            }
        }
    }
    // Where rows are many, everything is named, in two rows that both charts of a pair keep.
    let mut screen = Screen::new("wavy-sphere");
    let text = screen.keys("nx").text(120, 40);
    for said in ["━ stable", "walked", "1-9 event", "A largest pull", "B farthest", "JKR 1971", "@ here"] {
        assert!(text.contains(said), "{said} {text}");
    }
}

#[test]
fn a_pin_is_called_like_no_mark_and_the_same_everywhere() {
    let marks = (1..=9).map(Sign::Event).chain([
        Sign::LastContact(12),
        Sign::Landing,
        Sign::Touch,
        Sign::Turn,
        Sign::Minimum,
        Sign::Maximum,
        Sign::LargestPull,
        Sign::Farthest,
        Sign::Cusp,
        Sign::Swallowtail,
        Sign::Snaps(3),
    ]);
    let marks: Vec<Sign> = marks.collect();
    for theme in themes() {
        for pin in (1..=6).map(|number| glyph(Role::Pin(number), theme)) {
            assert!(marks.iter().all(|sign| letter(*sign, theme) != pin), "{pin} {theme:?}");
        }
    }
    let mut screen = Screen::new("wavy-sphere");
    screen.app.theme = Theme::new(Palette::Mono, Charts::Ascii, true);
    screen.keys("p}n");
    assert!(screen.text(120, 40).contains("pin D change"), "{}", screen.text(120, 40));
    screen.keys("\x1b");
    let (chart, list) = (screen.text(120, 40), screen.keys("P").text(120, 40));
    assert!(chart.contains("D A 0.0025") && list.contains("D   A 0.0025"), "{chart} {list}");
}

#[test]
fn every_screen_is_ascii_in_an_ascii_terminal() {
    let plain = Theme::new(Palette::Mono, Charts::Braille, true);
    let presets: Vec<&str> = crate::store::shipped::SHIPPED.iter().map(|shipped| shipped.name).collect();
    for preset in presets {
        let mut screen = Screen::new(preset);
        screen.app.theme = plain;
        // Walks take long, so one is enough.
        let walk: &[&str] = if preset == "wavy-sphere" { &["n", "x", "c", "i"] } else { &[] };
        let all = ["", "?", "\x1bP\x1be\x1b\r", "\x1ba", "\t\r\x1b"];
        for keys in all.iter().chain(walk) {
            screen.keys(keys);
            for (width, height) in [(80, 24), (200, 60)] {
                let text = screen.text(width, height);
                let stray: String = text.chars().filter(|c| !c.is_ascii()).collect();
                assert!(stray.is_empty(), "{preset} {keys}: {stray} in {text}");
            }
        }
    }
    // Walls that panels share leave their titles.
    let mut screen = Screen::new("wavy-sphere");
    let titles = |screen: &Screen, size: (u16, u16)| {
        let text = screen.text(size.0, size.1).replace(['δ', 'λ'], "?");
        ["P/Pc over", "Here, step 0", "Result", "Log"].map(|title| text.matches(title).count())
    };
    let sizes = [(80, 24), (100, 30), (120, 40), (200, 60)];
    let unicode = sizes.map(|size| titles(&screen, size));
    screen.app.theme = plain;
    assert_eq!(sizes.map(|size| titles(&screen, size)), unicode);
    assert!(unicode[2].iter().all(|count| *count > 0), "{unicode:?}");
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
    assert!(!super::find(&buffer, "Log").modifier.contains(Modifier::REVERSED));
    assert!(super::find(&buffer, "LIMIT").modifier.contains(Modifier::UNDERLINED));
    assert!(super::find(&buffer, "Space step").modifier.contains(Modifier::UNDERLINED));
}
