//! The mouse, the clipboard, and the deletion of presets.

use super::{PLAIN, Screen};
use crate::explorer::studies::StudyData;
use crate::explorer::{ScreenPanel, View, Window};
use crate::store::{Overwrite, Store};
use crate::tui::copy::text;
use crate::tui::overlay::Excerpt;
use crossterm::event::{KeyCode, KeyModifiers, MouseButton, MouseEvent, MouseEventKind};
use pulloff_engine::progress::Unwatched;
use ratatui::layout::{Position, Rect};
use std::sync::Arc;

const SIZE: Rect = Rect { x: 0, y: 0, width: 120, height: 40 };

fn screen(preset: &str) -> Screen {
    let mut screen = Screen::new(preset);
    let effects = screen.app.make_room(SIZE, 2);
    screen.settle(effects);
    screen.app.mouse = true;
    screen
}

/// The position of `text` on the screen.
fn place(screen: &Screen, text: &str) -> Position {
    let drawn = screen.text(SIZE.width, SIZE.height);
    let found = drawn.lines().enumerate().find_map(|(y, line)| Some((line.find(text)?, y, line)));
    let (at, y, line) = found.unwrap_or_else(|| unreachable!("no {text} in {drawn}"));
    Position::new(u16::try_from(line[..at].chars().count()).unwrap(), u16::try_from(y).unwrap())
}

fn mouse(screen: &mut Screen, kind: MouseEventKind, at: Position) {
    let event = MouseEvent { kind, column: at.x, row: at.y, modifiers: KeyModifiers::NONE };
    let effects = screen.app.mouse(event);
    screen.settle(effects);
}

fn click(screen: &mut Screen, at: Position) {
    mouse(screen, MouseEventKind::Down(MouseButton::Left), at);
}

#[test]
fn a_click_selects_and_once_more_goes_there() {
    let mut screen = screen("wavy-sphere");
    let at = place(&screen, " γ     ");
    click(&mut screen, at);
    assert_eq!(screen.app.model.selected_knob().unwrap().0.key, "material.work_of_adhesion");
    let at = place(&screen, "Here, step");
    click(&mut screen, at);
    assert_eq!(screen.app.model.panel, ScreenPanel::Here);
    let at = place(&screen, "2 snap");
    click(&mut screen, at);
    assert_eq!((screen.app.model.panel, screen.app.model.event), (ScreenPanel::Log, 1));
    assert_eq!(screen.app.model.history.current().unwrap().step, 0);
    click(&mut screen, at);
    let event = &screen.app.model.path_events()[1];
    let node = screen.app.model.history.current().unwrap();
    let s = node.state.in_units(node.setting.units()).contact_radius;
    assert!((s - event.before.as_ref().unwrap().contact_radius).abs() < 1e-6 * s, "{s}");
    // In a list as well.
    screen.keys("o");
    let at = place(&screen, "fig-3-jkr");
    click(&mut screen, at);
    assert!(screen.text(120, 40).contains("> fig-3-jkr"));
    click(&mut screen, at);
    assert!(screen.app.overlay.is_none());
    assert_eq!(screen.app.model.source.shown(), "fig-3-jkr");
}

#[test]
fn a_click_on_the_curve_takes_the_walker_there_and_so_does_the_cross_hair() {
    let mut screen = screen("wavy-sphere");
    screen.app.theme = PLAIN;
    // The number of the last contact is beside the curve.
    let drawn = screen.draw(SIZE.width, SIZE.height);
    let marks = screen.app.theme.styles().mark.fg.unwrap();
    let is_it = |at: &Position| drawn[*at].symbol() == "6" && drawn[*at].fg == marks;
    let at = SIZE.positions().find(is_it).unwrap_or_else(|| unreachable!("no 6 on the screen"));
    click(&mut screen, at);
    let at_pull_off = screen.app.model.history.current().unwrap().state.contact_radius;
    let limits = screen.app.model.curve.clone().unwrap();
    let last = limits.report.as_ref().unwrap().events.last().unwrap().before.as_ref().unwrap().contact_radius;
    let units = *limits.setting.units();
    assert!((at_pull_off * units.length - last).abs() < 0.1 * last, "{at_pull_off} {last}");
    assert_eq!(screen.app.model.panel, ScreenPanel::Charts);
    // Far from the curve, nothing moves.
    let (before, title) = (at_pull_off, place(&screen, "P/Pc over"));
    click(&mut screen, Position::new(title.x + 12, title.y + 4));
    let now = screen.app.model.history.current().unwrap().state.contact_radius;
    assert!(now.total_cmp(&before).is_eq());
    assert!(screen.app.model.status().1.contains("no state of the curve"));
    // By keys: the cross-hair, and Enter.
    screen.keys("i\r");
    let now = screen.app.model.history.current().unwrap().state.contact_radius;
    assert!(!now.total_cmp(&before).is_eq());
}

#[test]
fn places_and_words_of_the_footer_can_be_clicked() {
    let mut screen = screen("wavy-sphere");
    let at = place(&screen, "inside");
    click(&mut screen, at);
    assert_eq!(screen.app.model.view, View::Gap);
    let at = place(&screen, "curve");
    click(&mut screen, at);
    assert_eq!(screen.app.model.view, View::ForceApproach);
    let at = place(&screen, "n next event");
    click(&mut screen, Position::new(at.x + 4, at.y));
    assert!(screen.app.model.can_jump());
    // A list and a prompt have their words too, and a click between two words does nothing.
    let at = place(&screen, "? keys");
    click(&mut screen, Position::new(at.x - 1, at.y));
    assert!(screen.app.overlay.is_none());
    click(&mut screen, at);
    assert!(screen.app.overlay.is_some());
    screen.keys("\x1bo");
    let at = place(&screen, "Esc back");
    click(&mut screen, at);
    assert!(screen.app.overlay.is_none());
    screen.keys("g");
    let at = place(&screen, "m map");
    click(&mut screen, at);
    assert_eq!(screen.app.model.view, View::Study);
}

#[test]
fn the_wheel_turns_zooms_and_scrolls() {
    let mut screen = screen("wavy-sphere");
    let at = place(&screen, " γ     ");
    let before = screen.app.model.preset.material.work_of_adhesion;
    mouse(&mut screen, MouseEventKind::ScrollUp, at);
    let now = screen.app.model.preset.material.work_of_adhesion;
    assert!(now > before && now < 1.02 * before, "{now}");
    mouse(&mut screen, MouseEventKind::ScrollDown, at);
    let events = place(&screen, "2 snap");
    mouse(&mut screen, MouseEventKind::ScrollDown, events);
    assert_eq!((screen.app.model.panel, screen.app.model.event), (ScreenPanel::Log, 1));
    for _ in 0..50 {
        mouse(&mut screen, MouseEventKind::ScrollDown, events);
    }
    assert_eq!(screen.app.model.event, 5);
    // The chart zooms about the pointer: the point under it stays.
    let title = place(&screen, "P/Pc over δ");
    let at = Position::new(title.x + 30, title.y + 3);
    mouse(&mut screen, MouseEventKind::ScrollUp, at);
    let window = screen.app.model.window(View::ForceApproach);
    assert!((window.magnification() - 2.0).abs() < 1e-9, "{window:?}");
    assert!(window.x[0] > 0.0 && window.x[1] < 1.0 && window.y[0] > 0.3, "{window:?}");
    mouse(&mut screen, MouseEventKind::ScrollDown, at);
    assert!((screen.app.model.window(View::ForceApproach).magnification() - 1.0).abs() < 1e-9);
    // In the help it scrolls.
    screen.keys("?");
    let first = screen.text(120, 40);
    mouse(&mut screen, MouseEventKind::ScrollDown, Position::new(20, 20));
    assert_ne!(screen.text(120, 40), first);
}

#[test]
fn the_mouse_does_nothing_unasked_or_outside_and_answers_no_question() {
    let mut screen = screen("wavy-sphere");
    let places = [(0, 0), (u16::MAX, u16::MAX), (u16::MAX, 0), (120, 39), (119, 40), (119, 39), (0, 39)];
    let kinds =
        [MouseEventKind::Down(MouseButton::Left), MouseEventKind::ScrollUp, MouseEventKind::ScrollDown];
    let before = screen.text(120, 40);
    for kind in kinds {
        for (x, y) in places {
            mouse(&mut screen, kind, Position::new(x, y));
        }
    }
    assert_eq!(screen.text(120, 40), before);
    // Every cell of a small screen and of a question.
    screen.keys("}q");
    assert!(screen.app.overlay.is_some());
    for y in 0..40 {
        for x in 0..120 {
            click(&mut screen, Position::new(x, y));
        }
    }
    assert!(screen.app.overlay.is_some() && !screen.app.model.quit);
    screen.keys("\x1bm");
    assert!(!screen.app.mouse && screen.app.model.status().1.contains("left to the terminal"));
    let at = place(&screen, " γ     ");
    let selected = screen.app.model.parameter;
    click(&mut screen, at);
    assert_eq!(screen.app.model.parameter, selected);
    screen.keys("m");
    assert!(screen.app.mouse);
    let whole = screen.app.model.window(View::ForceApproach);
    assert_eq!(whole, Window::WHOLE);
}

#[test]
fn what_is_copied_is_text_that_steers_nothing() {
    let mut screen = screen("wavy-sphere");
    screen.keys("n");
    let state = text(&screen.app, Excerpt::State);
    assert!(state.starts_with("wavy-sphere\nδ\t0.03571") && state.contains("\nP/Pc\t-0.756"), "{state}");
    assert!(state.contains("\nδ held\tlimit point\nP held\tunstable\n"), "{state}");
    let events = text(&screen.app, Excerpt::Events);
    assert_eq!(events.lines().count(), 7);
    let columns = events.lines().next().unwrap().split('\t').count();
    assert!(events.lines().all(|line| line.split('\t').count() == columns), "{events}");
    let whole = text(&screen.app, Excerpt::Screen);
    assert_eq!(whole, screen.text(120, 40));
    let chart = text(&screen.app, Excerpt::Chart);
    assert!(chart.starts_with("┬P/Pc over δ") && chart.trim_end().ends_with('│'), "{chart}");
    // Through the list: what was chosen is sent.
    screen.keys("Yj\r");
    assert_eq!(screen.app.clipboard.take().unwrap(), events);
    assert!(screen.app.model.status().1.starts_with("events of "), "{}", screen.app.model.status().1);
    screen.keys("Yjjj\r");
    let copied = screen.app.clipboard.take().unwrap();
    assert!(copied.contains("Problem") && !copied.contains("Copy:"), "{copied}");
    // A title from somebody else.
    let title =
        crate::explorer::Command::Set { key: "title".into(), text: "a\u{1b}]52;c;eA==\u{7}b".to_owned() };
    let effects = crate::explorer::update(&mut screen.app.model, title);
    screen.settle(effects);
    for content in Excerpt::ALL {
        let copied = text(&screen.app, content);
        assert!(!copied.chars().any(|c| c.is_control() && c != '\n' && c != '\t'), "{copied:?}");
    }
    // Too long for a terminal: nothing is sent, and a message says so.
    screen.app.screen = Rect::new(0, 0, 400, 300);
    screen.keys("Yjjj\r");
    assert!(screen.app.clipboard.is_none());
    assert!(screen.app.model.status().1.contains("more than terminals take"));
}

#[test]
fn the_screen_is_exported_as_text() {
    let mut screen = screen("wavy-sphere");
    let wanted = screen.text(120, 40);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.txt");
    let typed = |screen: &mut Screen, path: &str| {
        screen.keys("ejjjjjj\r");
        for _ in 0..60 {
            screen.press(KeyCode::Backspace);
        }
        screen.keys(path).keys("\r");
    };
    typed(&mut screen, path.to_str().unwrap());
    assert_eq!(std::fs::read_to_string(&path).unwrap(), wanted);
    // An existing file is not replaced without a question; and only under a name that says what it is.
    screen.keys("n");
    typed(&mut screen, path.to_str().unwrap());
    assert_eq!(std::fs::read_to_string(&path).unwrap(), wanted);
    assert!(screen.text(120, 40).contains("Replace it? y does"));
    screen.keys("y");
    assert!(std::fs::read_to_string(&path).unwrap().contains("Event 1 of 6"));
    typed(&mut screen, folder.path().join("a.csv").to_str().unwrap());
    assert!(screen.text(120, 40).contains("must end in .txt"));
}

#[test]
fn the_first_view_is_exported_as_a_figure_with_its_zoom() {
    let mut screen = screen("wavy-sphere");
    let folder = tempfile::tempdir().unwrap();
    let figure = |screen: &mut Screen, name: &str| {
        screen.keys("ejjjjjjj\r");
        assert!(
            screen.text(120, 40).contains("wavy-sphere-force-approach.svg"),
            "{name}: {}",
            screen.text(120, 40)
        );
        for _ in 0..60 {
            screen.press(KeyCode::Backspace);
        }
        let path = folder.path().join(name);
        screen.keys(path.to_str().unwrap()).keys("\r");
        std::fs::read(path).unwrap_or_default()
    };
    let drawn = figure(&mut screen, "a.svg");
    let whole = String::from_utf8_lossy(&drawn);
    assert!(whole.starts_with("<svg ") && whole.contains("P/P<tspan") && whole.contains("JKR 1971"));
    screen.keys("++");
    assert_ne!(figure(&mut screen, "b.svg"), drawn);
    // The extension chooses the format; one that this build lacks is refused by name, and the prompt stays.
    for (name, begins, is_there) in
        [("PNG", &b"\x89PNG"[..], cfg!(feature = "png")), ("PDF", b"%PDF-", cfg!(feature = "pdf"))]
    {
        let drawn = figure(&mut screen, &format!("b.{}", name.to_lowercase()));
        assert_eq!(drawn.starts_with(begins), is_there, "{name}");
        if !is_there {
            assert!(screen.text(120, 40).contains(&format!("this build cannot write {name}")));
            screen.press(KeyCode::Esc);
        }
    }
    assert!(figure(&mut screen, "b.gif").is_empty());
    assert!(screen.text(120, 40).contains("ends in .svg"));
}

#[test]
fn a_preset_of_ones_own_is_deleted_after_a_question_and_no_other() {
    let mut screen = screen("wavy-sphere");
    let store = Store::at(screen.folder.path(), &[]);
    let (_, _) = store.save("mine", &screen.app.model.preset, None, Overwrite::Never).unwrap();
    screen.keys("oD");
    assert!(
        screen.text(120, 40).contains("Open a preset: Enter accepts, Esc goes back"),
        "a shipped one stays"
    );
    for _ in 0..crate::store::shipped::SHIPPED.len() {
        screen.keys("j");
    }
    assert!(screen.text(120, 40).contains("Enter accepts, D deletes"));
    screen.keys("D");
    let asked = screen.text(120, 40);
    assert!(asked.contains("for good?") && asked.contains("mine.toml"), "{asked}");
    screen.keys("\x1b");
    assert!(store.own("mine").is_ok());
    screen.keys("o");
    for _ in 0..crate::store::shipped::SHIPPED.len() {
        screen.keys("j");
    }
    screen.press(KeyCode::Delete);
    screen.keys("y");
    assert!(store.own("mine").is_err());
    let left = screen.text(120, 40);
    assert!(left.contains("Open a preset") && left.contains("deleted "), "{left}");
    assert!(!left.contains("  mine "), "{left}");
}

#[test]
fn the_states_walked_are_a_table_that_scrolls_and_leads_back() {
    let mut screen = Screen::new("wavy-sphere");
    screen.keys(":view\r");
    let text = screen.text(80, 24);
    assert!(text.contains("walk            - nothing walked yet: n runs"), "{text}");
    // What was walked, with its losses and the changes on the way.
    screen.keys("\x1bnx>nx  :view walk\r");
    let text = screen.text(100, 70);
    for said in ["jumps 2", "limit", "A 0.0026", " @"] {
        assert!(text.contains(said), "{said}: {text}");
    }
    assert!(text.contains("P/Pc"), "{text}");
    let path = screen.app.model.history.path().len();
    // To Charts, to the first line, two further on, and there; then back.
    screen.keys("\t\t\t");
    for _ in 0..20 {
        screen.press(KeyCode::PageUp);
    }
    assert_eq!(screen.app.model.walk_line, Some(0));
    screen.keys("jj\r");
    assert_eq!(screen.app.model.history.path().len(), 3);
    let text = screen.text(100, 30);
    assert!(text.contains("walk: 3 states, jumps 0; Enter goes there"), "{text}");
    screen.keys("u");
    assert_eq!(screen.app.model.history.path().len(), path);
    // Forces at different adhesions are not divided by one of their scales.
    screen.keys(":set gamma=0.005\rn");
    let text = screen.text(100, 70);
    assert!(text.contains("  P lost ") && text.contains("γ 0.005"), "{text}");
    // Where there is no room for all columns, some are left out, and no number is cut.
    assert!(text.contains("snap         0.03572 -0.00618 1.217e-4 "), "{text}");
    let narrow = screen.text(80, 30);
    let names = narrow.lines().find(|line| line.contains(" step ")).unwrap().split('│').nth(1).unwrap();
    assert!(names.trim_end().ends_with(" P"), "{narrow}");
    assert!(narrow.contains("jumps 2┬") || narrow.contains("jumps 2─"), "{narrow}");
    // A table has neither a cross-hair nor a zoom.
    screen.keys("i+");
    assert!(screen.app.model.cross.is_none() && screen.app.model.window(View::Walk).is_whole());
}

#[test]
fn what_rounding_leaves_of_zero_is_zero_in_the_table_of_states() {
    let mut screen = Screen::new("wavy-sphere");
    screen.keys(":set path.begin=apart\r");
    screen.press(KeyCode::Home);
    screen.keys("nnnn:view walk\r");
    let approaches: Vec<f64> =
        screen.app.model.history.path().iter().map(|(_, n)| n.state.approach).collect();
    let text = screen.text(100, 70);
    assert!(!text.contains("e-1") && !text.contains("-0.000"), "{approaches:?} {text}");
    assert!(text.contains(" 0 "), "{approaches:?} {text}");
}

#[test]
fn differences_tell_curves_apart_that_are_closer_than_a_dot() {
    let mut screen = Screen::new("wavy-sphere");
    screen.app.model.overlays.smooth = false;
    screen.keys(":view\r");
    let text = screen.text(80, 24);
    assert!(text.contains("differences     - nothing to compare with: p pins"), "{text}");
    screen.keys("\x1bp:set gap.amplitude=0.0025000001\r:view differences\r");
    let text = screen.text(200, 40);
    assert!(text.contains("ΔP/Pc over s/λ") && text.contains("at @, equal s: D "), "{text}");
}

#[test]
fn a_cross_hair_beside_a_line_reads_the_line() {
    let mut screen = Screen::new("wavy-sphere");
    screen.keys("p:set gap.amplitude=0.003\r:view differences\ri");
    let reading = |screen: &Screen| {
        let text = screen.text(120, 40);
        let said =
            text.split("ΔP/Pc ").find(|part| part.contains(" on ")).unwrap_or_else(|| panic!("{text}"));
        let (value, line) = said.split_once(" on ").unwrap();
        assert!(
            line.starts_with("D A 0.0025, at equal ") || line.starts_with("JKR 1971, at equal "),
            "{line}"
        );
        value.parse::<f64>().unwrap()
    };
    let first = reading(&screen);
    screen.press(KeyCode::Left);
    screen.press(KeyCode::Left);
    let second = reading(&screen);
    assert!((first - second).abs() > 1e-3, "{first} {second}");
}

#[test]
fn a_study_without_any_value_says_why() {
    let mut screen = Screen::new("wavy-sphere");
    screen.keys(":study peak_force\r");
    let text = screen.text(120, 40);
    assert!(text.contains("no value anywhere: no pull: edge.exponent"), "{text}");
    screen.keys(":control force\r:study cycle_loss\r");
    let text = screen.text(120, 40);
    assert!(text.contains("no value anywhere: it is empty under a"), "{text}");
}

#[test]
fn what_was_held_is_said_after_several_values_and_with_a_spring() {
    let mut screen = Screen::new("lens");
    screen.keys(":set material.work_of_adhesion=40mJ/m^2\r");
    let text = screen.text(120, 40);
    assert!(text.contains("Solved again with the spring's far end held"), "{text}");
    let mut screen = Screen::new("wavy-sphere");
    // The second shape has no state of the displacement held, the third has that of the second.
    screen.keys(
        "nn:set gap.shape=formula\r:set gap.formula=r^2/(2*R)+b*exp(-((r-0.15)/0.04)^2)\r:set b=0.002\r",
    );
    let text = screen.text(120, 40);
    assert!(text.contains("Solved again at the displacement held, stable"), "{text}");
}

#[test]
fn a_study_is_looked_at_read_taken_over_and_exported() {
    let mut screen = Screen::new("wavy-sphere");
    // The amplitude is selected: its largest pull is two keys away.
    screen.keys("gm");
    let text = screen.text(100, 30);
    for said in ["largest pull (P/Pc) over A", "now"] {
        assert!(text.contains(said), "{said}: {text}");
    }
    // The cross-hair reads a computed value, and Enter sets it.
    screen.keys("illll");
    let text = screen.text(120, 30);
    assert!(text.contains("A 0.00") && text.contains(": largest pull -1."), "{text}");
    assert!(text.contains(" Pc "), "{text}");
    let before = screen.app.model.preset.get("gap.amplitude");
    screen.keys("\r");
    let after = screen.app.model.preset.get("gap.amplitude");
    assert_ne!(before, after);
    // The same study, with the mark moved.
    let study = screen.app.model.results.share::<StudyData>().unwrap();
    assert!(study.wish.values.contains(&after.clone().unwrap()));
    screen.keys("u");
    assert_eq!(screen.app.model.preset.get("gap.amplitude"), before);
    assert!(Arc::ptr_eq(&screen.app.model.results.share::<StudyData>().unwrap(), &study));
    // As values, and as a sweep that computes them again.
    let (csv, toml) = (screen.folder.path().join("a.csv"), screen.folder.path().join("a.toml"));
    screen.keys(&format!(":export study {}\r", csv.display()));
    screen.keys(&format!(":export study {}\r", toml.display()));
    let csv = std::fs::read_to_string(csv).unwrap();
    let rows: Vec<&str> = csv.lines().collect();
    assert_eq!((rows[0], rows.len()), ("gap.amplitude,largest_pull,error", 102));
    let store = Store::at(screen.folder.path(), &[]);
    let load = |name: &str, over: &[&str]| {
        let source = store.resolve(name).map_err(|error| error.to_string())?;
        Ok(store.load(&source, over).map_err(|error| error.to_string())?.preset)
    };
    let spec = std::fs::read_to_string(toml).unwrap();
    let spec = pulloff_engine::sweep::Spec::read(&load, "a.toml", &spec).unwrap();
    assert_eq!(spec.rows, 101);
    for row in [0, 17, 50, 100] {
        let cells = spec.measure(row, &Unwatched).unwrap().cells;
        let found = cells[0].map(|cell| cell.to_string()).unwrap_or_default();
        let at = usize::try_from(row).unwrap();
        let Some(pulloff_engine::preset::Value::Number(x)) = spec.values(row).pop() else { panic!("{row}") };
        let told: Vec<&str> = rows[at + 1].split(',').collect();
        assert_eq!(told[0].parse(), Ok(x));
        assert_eq!(told[1].parse::<f64>().ok(), found.parse::<f64>().ok(), "{}", rows[at + 1]);
    }
}

#[test]
fn what_cannot_be_studied_says_why_at_the_view_and_at_the_value() {
    let mut screen = Screen::new("wavy-sphere");
    // Far out of range, nothing starts: the reason is shown at the cross-hair.
    screen.keys(":set path.start_approach=0.01\r").keys(":study snaps\r");
    let name = |screen: &Screen| screen.app.model.selected_knob().unwrap().0.key.to_string();
    assert_eq!(name(&screen), "gap.amplitude");
    let text = screen.text(100, 30);
    assert!(text.contains("snaps over A"), "{text}");
    // A word has no range.
    while name(&screen) != "gap.shape" {
        screen.press(KeyCode::Up);
    }
    let text = screen.text(100, 30);
    assert!(text.contains("is not a number: nothing to vary"), "{text}");
    screen.keys(":view\r");
    let text = screen.text(100, 40);
    assert!(text.contains("study           - gap is not a number"), "{text}");
}

#[test]
fn a_study_is_zoomed_about_the_value_of_the_preset_and_may_have_its_own_range() {
    let mut screen = Screen::new("wavy-sphere");
    screen.keys(":study largest_pull gamma=0.003..0.005\r").text(120, 40);
    let study = screen.app.model.results.share::<StudyData>().unwrap();
    assert_eq!(study.wish.values[0], 0.003.into());
    let inside = |place: (f64, f64)| [place.0, place.1].iter().all(|share| (0.0..=1.0).contains(share));
    let before = screen.app.place_here();
    assert!(inside(before) && (before.1 - 0.5).abs() > 1e-3, "{before:?}");
    screen.keys("+++").text(120, 40);
    let after = screen.app.place_here();
    assert!((after.0 - before.0).abs() + (after.1 - before.1).abs() < 1e-9, "{before:?} {after:?}");
}

#[test]
fn a_study_over_decades_has_powers_of_ten_along_its_axis() {
    let mut screen = Screen::new("wavy-sphere");
    screen.keys(":set edge.reference_speed=1 edge.exponent=0.5 path.rate=0.01\r");
    screen.keys(":study peak_force rate\r");
    let text = screen.text(100, 30);
    assert!(
        text.contains("0.0001          0.01            1    rate") && text.contains("quasi-static"),
        "{text}"
    );
    // The cross-hair is at the value, whatever is drawn along the axis; so is where Enter goes.
    screen.keys("i");
    assert!(screen.text(100, 30).contains("rate 0.01"), "{}", screen.text(100, 30));
    for _ in 0..6 {
        screen.press(KeyCode::Right);
    }
    screen.press(KeyCode::Enter);
    let rate = screen.app.model.preset.get("path.rate").unwrap().as_number().unwrap();
    assert!(rate > 0.02 && rate < 1.0, "{rate}");
}

#[test]
fn the_cross_hair_on_a_map_counts_the_snaps() {
    let mut screen = Screen::new("wavy-sphere");
    screen.keys(":map\r:map\r");
    screen.keys("i");
    let text = screen.text(100, 40);
    let path = screen.app.model.path().unwrap();
    let snaps = path.events.iter().filter(|event| event.kind == "snap").count();
    assert!(text.contains(&format!("{snaps} snaps; + A 0.0025")), "{text}");
    // At a line of the map either count may hold, and beyond its border none is known.
    let mut said = String::new();
    for _ in 0..40 {
        screen.press(KeyCode::Up);
        said.push_str(&screen.text(100, 40));
    }
    assert!(said.lines().any(|line| line.contains(" to ") && line.contains(" snaps; + A ")), "{said}");
    assert!(said.contains("outside the map; + A"), "{said}");
    for said in ["swallowtail", "number of snaps unchanged", "line of landings"] {
        assert!(text.contains(said), "{said}: {text}");
    }
}

/// So that what is changed from there on is only what the arrows change.
#[test]
fn the_cross_hair_begins_at_the_present_values() {
    let mut screen = Screen::new("wavy-sphere");
    screen.keys(":map A=0..0.005 gap.wavelength=0.02..0.1\ri");
    let bounds = crate::figure::Subject::of(&screen.app.model).unwrap().figure(View::Map).bounds;
    let (a, wavelength) = bounds.at(screen.app.model.cross.unwrap());
    assert!((a - 0.0025).abs() < 1e-12 && (wavelength - 0.05).abs() < 1e-12, "{a} {wavelength}");
    screen.press(KeyCode::Enter);
    let key = "gap.wavelength";
    assert!((screen.app.model.preset.get(key).unwrap().as_number().unwrap() - 0.05).abs() < 1e-9);
}

#[test]
fn the_axes_of_a_map_take_ranges() {
    let mut screen = Screen::new("wavy-sphere");
    screen.keys(":map A=log:1e-4..5e-3 gamma=0.001..0.008\r");
    let crate::figure::Subject { map: Some(Ok(report)), .. } =
        crate::figure::Subject::of(&screen.app.model).unwrap()
    else {
        panic!("{}", screen.text(120, 40))
    };
    assert!(report.x.logarithmic && !report.y.logarithmic);
    assert_eq!([report.x.from, report.x.to, report.y.to], [Some(1e-4), Some(5e-3), Some(8e-3)]);
    let text = screen.text(120, 40);
    assert!(text.contains("0.0001                 0.001"), "{text}");
    for (axis, why) in [("A=log:0..1", "a logarithmic axis must begin above zero"), ("A=1", "KEY=FROM..TO")] {
        screen.keys(&format!("\x1b:map {axis}\r"));
        let text = screen.text(300, 60);
        assert!(text.contains(why), "{axis}: {text}");
    }
}

#[test]
fn a_loop_says_what_it_loses_in_the_dead_band() {
    let mut screen = Screen::new("fig-3-jkr");
    screen.keys(":set basis.kind=exact gamma_a=0.002 begin=apart\r");
    let report = screen.app.model.cycle().unwrap().report().unwrap().clone();
    let band = report.totals.dead_band.unwrap().dissipated;
    let shown = pulloff_engine::report::number::loss(band);
    for size in [(80, 24), (120, 40), (200, 60)] {
        let text = screen.text(size.0, size.1);
        assert!(text.contains(&format!("+ dead band {shown}")), "{shown} {text}");
        assert!(
            size.0 < 120 || text.contains(" in jumps ") && text.contains(&format!(" dead band {shown}")),
            "{text}"
        );
    }
}

#[test]
fn a_walk_from_apart_is_on_the_path_whatever_the_basis() {
    let mut screen = Screen::new("fig-9-si");
    screen.keys(":set begin=apart\r");
    let touch = screen.app.model.path_events()[0].after.clone().unwrap();
    let node = screen.app.model.history.current().unwrap();
    let state = node.state.in_units(node.setting.units());
    assert!((state.contact_radius / touch.contact_radius - 1.0).abs() < 1e-6, "{state:?} {touch:?}");
    let text = screen.keys("n").text(120, 40);
    assert!(!text.contains("Off the path"), "{text}");
    assert!(
        screen.app.model.curve.as_ref().unwrap().base.notes.iter().any(|note| note.contains("exact states"))
    );
}
