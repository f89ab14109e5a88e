//! Whole screens: at every size, as text, and the styles that carry meaning.

use crate::explorer::{Command, Id, Inline, ScreenPanel, View, update};
use crate::store::Store;
use crate::tui::app::App;
use crate::tui::theme::{Charts, Palette, Theme};
use crossterm::event::{KeyCode, KeyEvent};
use pulloff_engine::case::critical_force;
use pulloff_engine::report::number::{loss, significant};
use ratatui::Terminal;
use ratatui::backend::TestBackend;
use ratatui::buffer::Buffer;
use ratatui::style::Modifier;

mod input;
mod jobs;
mod keys;
mod line;
mod looks;
mod pins;
mod rate;
mod reach;

/// Dark, and in ASCII.
const PLAIN: Theme = Theme { palette: Palette::Dark, charts: Charts::Ascii, ascii: true };

/// The explorer with its effects run inline.
struct Screen {
    app: App,
    driver: Inline,
    folder: tempfile::TempDir,
}

impl Screen {
    fn empty(preset: &str) -> (Self, Vec<crate::explorer::Effect>) {
        let folder = tempfile::tempdir().unwrap();
        let store = Store::at(folder.path(), &[]);
        let loaded = store.load(&store.resolve(preset).unwrap(), &[] as &[&str]).unwrap();
        let (app, effects) = App::new(loaded, Theme::default());
        (Self { app, driver: Inline::new(store), folder }, effects)
    }

    fn new(preset: &str) -> Self {
        let (mut screen, effects) = Self::empty(preset);
        screen.settle(effects);
        screen
    }

    fn settle(&mut self, mut effects: Vec<crate::explorer::Effect>) {
        while !effects.is_empty() {
            let replies: Vec<_> = effects.into_iter().filter_map(|e| self.driver.run(e)).collect();
            effects = replies.into_iter().flat_map(|reply| self.app.reply(reply)).collect();
        }
    }

    fn press(&mut self, code: KeyCode) {
        let effects = self.app.key(KeyEvent::from(code));
        self.settle(effects);
    }

    /// Types a string of plain keys; `\r` is Enter, `\t` Tab, `\x1b` Escape.
    fn keys(&mut self, keys: &str) -> &mut Self {
        for c in keys.chars() {
            self.press(match c {
                '\r' => KeyCode::Enter,
                '\t' => KeyCode::Tab,
                '\x1b' => KeyCode::Esc,
                c => KeyCode::Char(c),
            });
        }
        self
    }

    fn draw(&self, width: u16, height: u16) -> Buffer {
        let mut terminal = Terminal::new(TestBackend::new(width, height)).unwrap();
        terminal
            .draw(|frame| {
                super::draw(frame, &self.app);
            })
            .unwrap();
        terminal.backend().buffer().clone()
    }

    fn text(&self, width: u16, height: u16) -> String {
        let buffer = self.draw(width, height);
        let row = |y| (0..width).map(|x| buffer[(x, y)].symbol()).collect::<String>();
        (0..height).map(|y| row(y).trim_end().to_owned() + "\n").collect()
    }
}

fn is_braille(symbol: &str) -> bool {
    symbol.chars().any(|c| ('\u{2801}'..='\u{28ff}').contains(&c))
}

/// The first cell of `text` on the screen.
fn find<'a>(buffer: &'a Buffer, text: &str) -> &'a ratatui::buffer::Cell {
    let area = buffer.area;
    for y in 0..area.height {
        let cells: Vec<&str> = (0..area.width).map(|x| buffer[(x, y)].symbol()).collect();
        for x in 0..cells.len() {
            if cells[x..].concat().starts_with(text) {
                return &buffer[(u16::try_from(x).unwrap(), y)];
            }
        }
    }
    unreachable!("{text} is not on the screen: {buffer:?}")
}

#[test]
fn every_state_is_drawn_at_every_size() {
    let (waiting, _) = Screen::empty("wavy-sphere");
    let mut screens = vec![waiting];
    for (preset, keys) in [
        ("wavy-sphere", ""),
        ("wavy-sphere", "n"),
        ("wavy-sphere", "nx n"),
        ("wavy-sphere", "nxnxnxnxnxnx"),
        ("wavy-sphere", "cca?"),
        ("wavy-sphere", "\r-1\r"),
        ("wavy-sphere", "o"),
        ("wavy-sphere", "e\r"),
        ("wavy-sphere", "}q"),
        ("wavy-sphere", "nxnxnxkkk\r\u{8}\u{8}0\r"),
        ("fig-1-hertz", "5 a"),
        ("fig-3-jkr", "y\r\x1b \t\t\tn"),
    ] {
        let mut screen = Screen::new(preset);
        screen.keys(keys);
        screens.push(screen);
    }
    for screen in &screens {
        for (width, height) in
            [(0, 0), (1, 1), (2, 2), (40, 10), (41, 11), (60, 18), (80, 24), (100, 30), (200, 60)]
        {
            screen.draw(width, height);
        }
    }
    for width in 0..130 {
        for height in [0, 1, 3, 9, 10, 12, 17, 18, 25, 31] {
            screens[2].draw(width, height);
        }
    }
}

#[test]
fn whole_screens_as_text() {
    let mut screen = Screen::new("wavy-sphere");
    insta::assert_snapshot!("start_80x24", screen.text(80, 24));
    insta::assert_snapshot!("pull_80x24", rate::pulled().text(80, 24));
    screen.keys("n");
    insta::assert_snapshot!("limit_point_80x24", screen.text(80, 24));
    screen.keys("x");
    insta::assert_snapshot!("landing_120x40", screen.text(120, 40));
    screen.keys("?");
    insta::assert_snapshot!("help_of_keys_100x45", screen.text(100, 45));
    screen.keys("\t");
    insta::assert_snapshot!("help_100x45", screen.text(100, 45));
    screen.keys("\x1b:figure");
    insta::assert_snapshot!("found_80x24", screen.text(80, 24));
    screen.keys("\x1bta\r-1\r");
    insta::assert_snapshot!("refused_value_80x24", screen.text(80, 24));
}

/// The sizes designed for, with one curve pinned and one limit point passed.
#[test]
fn screens_of_every_layout_as_text() {
    let mut screen = Screen::new("wavy-sphere");
    screen.keys("p}nxn");
    for (width, height) in [(80, 24), (100, 30), (120, 40), (160, 45), (200, 60), (300, 20)] {
        for _ in 0..2 {
            // The views that fit are computed first.
            let mut views = 0;
            let mut terminal = Terminal::new(TestBackend::new(width, height)).unwrap();
            terminal.draw(|frame| views = super::draw(frame, &screen.app)).unwrap();
            let effects = screen.app.make_room(ratatui::layout::Rect::new(0, 0, width, height), views);
            screen.settle(effects);
        }
        insta::assert_snapshot!(format!("layout_{width}x{height}"), screen.text(width, height));
    }
}

/// Whether a number ends where a wall or an ellipsis begins, as if it had been cut off.
fn has_cut_number(text: &str) -> Option<String> {
    let is_number = |c: char| c.is_ascii_digit() || c == 'e' || c == '-' || c == '.';
    text.lines().find_map(|line| {
        let chars: Vec<char> = line.chars().collect();
        let cut = chars.windows(3).position(|three| {
            let [before, last, end] = [three[0], three[1], three[2]];
            // Half an exponent, or digits that run into a wall without the space that follows a value.
            end == '\u{2502}' && (last == 'e' || last == '-' || last == '.') && is_number(before)
        });
        cut.map(|_| line.to_owned())
    })
}

#[test]
fn nothing_is_cut_inside_a_number() {
    for preset in ["wavy-sphere", "fig-9-si", "fig-9"] {
        let mut screen = Screen::new(preset);
        screen.keys("nx");
        for keys in ["", "cj\r"] {
            screen.keys(keys);
            for (width, height) in [(60, 60), (80, 50), (40, 12), (80, 24), (100, 30), (120, 40), (45, 30)] {
                let text = screen.text(width, height);
                assert_eq!(has_cut_number(&text), None, "{width}x{height} {text}");
                // The crests before and after are written together.
                for line in text.lines().filter(|line| line.contains("snap")) {
                    assert!(!line.contains("> ") || line.contains(">-"), "{line}");
                }
            }
        }
    }
    // Under a dead load, the approach is given before and after, and the load once.
    let mut screen = Screen::new("wavy-sphere");
    screen.keys("cj\r");
    let text = screen.text(80, 24);
    let row = text.lines().find(|line| line.contains("·1 snap")).unwrap();
    let words: Vec<&str> = row.split_whitespace().collect();
    assert_eq!([words[3], words[5], words[7]], ["δ", "▸", "P"], "{row}");
    assert!(!["▸"].contains(&words[9]), "{row}");
}

#[test]
fn a_panel_can_have_the_whole_screen_and_an_event_its_number_on_the_curve() {
    let mut screen = Screen::new("wavy-sphere");
    screen.app.model.panel = ScreenPanel::Charts;
    screen.keys("z");
    let text = screen.text(80, 24);
    assert!(!text.contains("Problem") && text.contains("P/Pc over δ"), "{text}");
    screen.press(KeyCode::Tab);
    assert!(screen.text(80, 24).contains("lost up to here"));
    screen.keys("z");
    assert!(screen.text(80, 24).contains("Problem"));
    // The selected one is reversed.
    let reversed = |screen: &Screen, number: &str| {
        let buffer = screen.draw(120, 40);
        let is_it = |cell: &&ratatui::buffer::Cell| {
            cell.symbol() == number && cell.modifier.contains(Modifier::REVERSED)
        };
        let marks = screen.app.theme.styles().mark.fg;
        buffer.content().iter().filter(is_it).any(|cell| cell.fg == marks.unwrap())
    };
    assert!(reversed(&screen, "1") && !reversed(&screen, "2"));
    screen.press(KeyCode::Down);
    assert!(reversed(&screen, "2") && !reversed(&screen, "1"));
}

#[test]
fn every_view_is_drawn_at_every_size_near_and_far() {
    for (preset, keys) in [("wavy-sphere", "nxp}p"), ("fig-1-hertz", " "), ("wavy-sphere", "nxnxnxnxnxnx")] {
        let mut screen = Screen::new(preset);
        screen.keys("y\rj\rj\r\x1b").keys(keys).keys("i");
        for view in View::ALL {
            screen.keys(&format!(":view {}\r", view.name()));
            assert_eq!(screen.app.model.view, view);
            for zoom in ["", "+++++", "++++++++++++++++++++++++++++++", "f------"] {
                screen.keys(zoom);
                for (width, height) in [(40, 10), (80, 24), (120, 40), (200, 60)] {
                    screen.draw(width, height);
                }
            }
            screen.keys("f");
        }
    }
}

#[test]
fn views_follow_each_other_and_three_fit_on_a_wide_screen() {
    let mut screen = Screen::new("wavy-sphere");
    let places: [(&str, &[&str]); 4] = [
        (
            "gc",
            &[
                "P/Pc over δ",
                "P/Pc over s/λ",
                "s/λ over δ",
                "unloading",
                "cycle: P/Pc over δ/R",
                "ΔP/Pc over s/λ",
            ],
        ),
        (
            "gi",
            &[
                "gap/R over r/λ",
                "p/E* over r/λ",
                "contact, s/λ",
                "U over s/λ",
                "contacts over the travel of δ",
            ],
        ),
        ("gm", &["largest pull (P/Pc) over A", "snaps", "limit points under displacement"]),
        ("gd", &["distances of the points"]),
    ];
    for (go, titles) in places {
        screen.keys(go);
        for title in titles {
            let text = screen.text(80, 24);
            assert!(text.contains(title), "{title}: {text}");
            screen.keys("t");
        }
        // Once round the place, and no further.
        assert!(screen.text(80, 24).contains(titles[0]), "{}", screen.text(80, 24));
    }
    screen.keys("gcTTT");
    assert!(screen.text(80, 24).contains("lost 7.9"), "{}", screen.text(80, 24));
    screen.keys("ttt");
    let text = screen.text(200, 60);
    for title in ["P/Pc over δ", "P/Pc over s/λ", "┬contact"] {
        assert!(text.contains(title), "{title}: {text}");
    }
    assert_eq!(text.matches("(t: force-radius)").count(), 1);
    // The loss of a jump is hatched, in ASCII as well.
    screen.app.theme = PLAIN;
    let strokes = |screen: &Screen| screen.text(120, 40).matches(['/', '\\']).count();
    let before = strokes(&screen);
    screen.keys("TTT");
    assert!(strokes(&screen) > before + 5, "{}", screen.text(120, 40));
}

#[test]
fn free_values_and_their_errors_are_seen_in_the_panel() {
    let mut screen = Screen::new("lens");
    let before = screen.text(100, 30);
    assert!(
        before.contains("E*?") && before.contains("measured approach") && !before.contains('±'),
        "{before}"
    );
    screen.keys("F");
    let after = screen.text(100, 30);
    assert!(after.contains(" kPa ±0.66") && after.contains("fitted: χ²"), "{after}");
    let narrow = screen.text(80, 24);
    assert!(narrow.contains("kPa ±0.66"), "{narrow}");
    // The report of the command, as long as the values are those found.
    screen.keys("I");
    let report = screen.text(100, 30);
    for said in ["correlations: E* γ", "with k 10 % larger", "chi squared per point"] {
        assert!(report.contains(said), "{said}: {report}");
    }
    screen.keys("\x1b");
    screen.app.theme = PLAIN;
    assert!(screen.text(100, 30).contains(" kPa +-0.66"), "{}", screen.text(100, 30));
    screen.keys("uI");
    assert!(!screen.text(100, 30).contains("correlations"));
    screen.keys("\x1b");
    assert!(!screen.text(100, 30).contains(" kPa +-"));
}

#[test]
fn zooming_keeps_the_walker_in_place_and_fit_shows_all_again() {
    let mut screen = Screen::new("wavy-sphere");
    screen.keys("nx");
    let whole = screen.text(80, 24);
    screen.keys("++");
    let close = screen.text(80, 24);
    assert!(close.contains("zoom 4x") && close.contains('@'), "{close}");
    let place = |text: &str| text.lines().find_map(|line| Some((line.len(), line.find('@')?)));
    assert!(place(&whole).is_some() && place(&close).is_some());
    // In Charts the arrows move the window; elsewhere they select.
    screen.app.model.panel = ScreenPanel::Charts;
    screen.press(KeyCode::Right);
    assert_ne!(screen.text(80, 24), close);
    assert_eq!(screen.app.model.panel, ScreenPanel::Charts);
    screen.keys("f");
    assert!(!screen.text(80, 24).contains("zoom"));
    screen.press(KeyCode::Tab);
    screen.press(KeyCode::BackTab);
    assert_eq!(screen.app.model.panel, ScreenPanel::Charts);
}

#[test]
fn the_cross_hair_reads_the_chart_and_the_curve() {
    let mut screen = Screen::new("wavy-sphere");
    screen.keys("i");
    let text = screen.text(120, 40);
    assert!(text.contains("* δ/R ") && text.contains("; + δ/R ") && text.contains("stable"), "{text}");
    let before = screen.app.model.cross;
    screen.press(KeyCode::Up);
    screen.press(KeyCode::Right);
    assert_ne!(screen.app.model.cross, before);
    let find_cross = |screen: &Screen| {
        let buffer = screen.draw(80, 24);
        assert!(find(&buffer, "+").modifier.contains(Modifier::BOLD) || screen.app.theme.ascii);
    };
    find_cross(&screen);
    // On a view of the state, only its own coordinates.
    screen.keys("gi");
    let text = screen.text(120, 40);
    assert!(text.contains("+ r/λ ") && !text.contains("* δ/R "), "{text}");
    screen.keys("\x1b");
    assert!(screen.app.model.cross.is_none());
}

#[test]
fn a_map_says_what_its_numbers_are_and_no_title_is_cut_in_a_word() {
    let mut screen = Screen::new("wavy-sphere");
    screen.keys("gmt");
    let text = screen.text(80, 24);
    assert!(text.contains("0-9 snaps"), "{text}");
    assert!(text.contains("limit points under displacement") && !text.contains("displacement…"), "{text}");
}

#[test]
fn the_ring_elements_lie_over_the_exact_curve_and_go_again() {
    let mut screen = Screen::new("wavy-sphere");
    screen.keys("#");
    let text = screen.text(120, 40);
    assert!(text.contains("D rings 200: A ") && text.contains("now   pin D change"), "{text}");
    let said = " pin D, 200 ring elements: largest pull off by ";
    assert!(text.contains(said) && text.contains(" Newton iterations"), "{text}");
    let told = screen.text(80, 24);
    assert!(told.contains(said) && told.contains(" Newton iterations"), "{told}");
    // On the chart if there is no Result, whatever the message is meanwhile.
    screen.keys("]");
    let small = screen.text(80, 24);
    assert!(
        small.contains("D rings 200: A ") && small.contains(" Newton") && !small.contains(said),
        "{small}"
    );
    let pin = &screen.app.model.pins.all()[0];
    let [rings, exact] = [&pin.curve, screen.app.model.curve.as_ref().unwrap()]
        .map(|curve| curve.report.as_ref().unwrap().totals.largest_pull.as_ref().unwrap().force);
    // The method of the paper comes near the exact solution, but differs from it.
    assert!(rings.total_cmp(&exact).is_ne() && (rings / exact - 1.0).abs() < 0.01, "{rings} {exact}");
    screen.keys("#");
    assert!(screen.app.model.pins.is_empty());
    // Beside the rings, the pin is the exact solution.
    screen.keys(":set basis.kind=rings\r#");
    assert!(screen.text(120, 40).contains("D exact: A "), "{}", screen.text(120, 40));
    // With other values it is another problem.
    screen.keys("\u{1b}>");
    assert!(!screen.text(120, 40).contains("D exact: A "), "{}", screen.text(120, 40));
}

#[test]
fn a_log_of_many_events_says_how_many_are_left_out_and_keeps_the_current_one() {
    let mut screen = Screen::new("wavy-sphere");
    screen.keys(":open wavy-sphere gap.wavelength=0.02 gap.amplitude=0.001\r");
    let log = |screen: &Screen| -> Vec<String> {
        let text = screen.text(120, 40);
        let lines = text.lines().skip_while(|line| !line.contains("Log ✓ done")).skip(1);
        lines.take_while(|line| line.starts_with('│')).map(str::to_owned).collect()
    };
    let lines = log(&screen);
    assert!(lines.len() == 9 && lines[0].contains("·1 ") && lines[8].ends_with("+7│"), "{lines:?}");
    screen.keys(&"n".repeat(26));
    let lines = log(&screen);
    let here = lines.iter().position(|line| line.contains('@')).unwrap_or(0);
    assert!(lines[0].contains('+') && here > 0, "{}", screen.text(120, 40));
    // From the other end of the list as well.
    for key in [KeyCode::PageUp, KeyCode::PageUp, KeyCode::End] {
        screen.app.model.panel = ScreenPanel::Log;
        screen.press(key);
        let lines = log(&screen);
        assert!(lines.iter().any(|line| line.contains('@')), "{lines:?}");
        assert!(lines.iter().any(|line| line.starts_with("│>")), "{lines:?}");
    }
}

#[test]
fn characters_tell_stable_and_unstable_parts_apart() {
    let mut screen = Screen::new("wavy-sphere");
    screen.app.theme = PLAIN;
    let text = screen.text(120, 40);
    // Below the legend, and left of the second chart.
    let chart: String = text
        .lines()
        .skip(4)
        .take(22)
        .map(|line| line.chars().skip(30).take(40).collect::<String>() + "\n")
        .collect();
    let count = |wanted: &str| chart.matches(wanted).count();
    assert!(count("o") > 20 && count("..") > 3, "{chart}");
}

#[test]
fn what_lies_behind_a_turned_value_is_passed_by_and_did_not_happen_at_it() {
    let mut screen = Screen::new("wavy-sphere");
    screen.keys("nn");
    assert!(screen.text(160, 45).contains("\u{2713}1 "));
    screen.keys(">");
    let text = screen.text(160, 45);
    assert!(
        text.contains("-1 ") && text.contains("- passed by") && text.contains("lost at these values 0 of"),
        "{text}"
    );
    // The total stays that of the path, as in Result.
    let path = screen.app.model.path().unwrap();
    let [all, passed] = [path.totals.dissipated.unwrap(), path.events[0].dissipated.unwrap()].map(loss);
    let sums = format!("lost at these values 0 of {all}, {passed} passed by");
    assert!(text.contains(&sums) && text.contains(&format!("lost in all {all}")), "{sums} {text}");
    assert!(screen.text(80, 24).contains(&format!("0 of {all}")), "{text}");
    screen.keys("nn>");
    let text = screen.text(160, 45);
    assert!(text.contains("-1 ") && text.contains("-2 ") && !text.contains("-3 "), "{text}");
    // At the start, nothing lies behind.
    let mut screen = Screen::new("wavy-sphere");
    screen.keys(">");
    assert!(!screen.text(160, 45).contains("-1 "));
}

#[test]
fn an_ascii_terminal_gets_nothing_else() {
    let mut screen = Screen::new("wavy-sphere");
    screen.app.theme = PLAIN;
    for keys in ["", "n", "x", "t", "?", "\x1bo", "\x1b\r", "\x1bp}i+", "gcttttgmgigdy\r", "\x1bP"] {
        screen.keys(keys);
        for (width, height) in [(80, 24), (120, 40)] {
            let text = screen.text(width, height);
            assert!(text.is_ascii(), "{keys}: {text}");
        }
    }
}

#[test]
fn selection_instability_and_errors_have_their_styles() {
    let mut screen = Screen::new("wavy-sphere");
    let buffer = screen.draw(80, 24);
    assert!(find(&buffer, ">A ").modifier.contains(Modifier::REVERSED));
    screen.keys("n");
    let buffer = screen.draw(80, 24);
    let error = screen.app.theme.error().fg.unwrap();
    assert_eq!(find(&buffer, "LIMIT").fg, error);
    let walker =
        |cell: &&ratatui::buffer::Cell| cell.symbol() == "@" && cell.modifier.contains(Modifier::REVERSED);
    assert!(buffer.content().iter().any(|cell| walker(&cell)));
    screen.app.model.panel = ScreenPanel::Log;
    let buffer = screen.draw(80, 24);
    assert!(find(&buffer, ">@1").modifier.contains(Modifier::REVERSED));
    screen.keys("\t{");
    screen.app.model.panel = ScreenPanel::Here;
    screen.keys("{");
    let buffer = screen.draw(80, 24);
    assert_eq!(find(&buffer, "select a value first").fg, error);
    assert!(find(&buffer, "* unsaved").modifier.contains(Modifier::BOLD));
}

#[test]
fn inadmissible_parts_need_no_colour() {
    let mut screen = Screen::new("wavy-sphere");
    assert!(!screen.text(160, 50).contains("inadmissible"));
    let weak = Command::Set { key: "material.work_of_adhesion".into(), text: "1e-4".to_owned() };
    let effects = crate::explorer::update(&mut screen.app.model, weak);
    screen.settle(effects);
    // With enough colours, the curve keeps its shape and takes the colour of a warning.
    let warning = screen.app.theme.styles().warning.fg.unwrap();
    let buffer = screen.draw(160, 50);
    let warned = buffer.content().iter().filter(|cell| cell.fg == warning && is_braille(cell.symbol()));
    assert!(warned.count() > 5);
    for theme in [PLAIN, Theme { palette: Palette::Mono, ..Theme::default() }] {
        screen.app.theme = theme;
        let text = screen.text(160, 50);
        // In the legend and in the log; the others stand on the curves.
        let told = text.matches("! inadmissible").count();
        assert!(text.contains("! inadmissible s = ") && told > 3, "{text}");
        assert!(text.matches('!').count() > told + screen.app.model.shown_inadmissible().len(), "{text}");
    }
    screen.app.theme = Theme::default();
    screen.keys("[[");
    for _ in 0..200 {
        if !screen.app.model.walker().unwrap().admissibility.holds {
            break;
        }
        screen.keys(" ");
    }
    for (width, height) in [(80, 24), (160, 50)] {
        let error = screen.app.theme.error().fg.unwrap();
        assert_eq!(find(&screen.draw(width, height), "inadmissible: r 0.").fg, error);
    }
}

#[test]
fn too_few_rings_are_a_warning_on_the_screen() {
    let mut screen = Screen::new("fig-9");
    let set = Command::Set { key: "basis.rings".into(), text: "40".to_owned() };
    let effects = crate::explorer::update(&mut screen.app.model, set);
    screen.settle(effects);
    let buffer = screen.draw(120, 40);
    assert_eq!(find(&buffer, "! only 4.0 rings per wave").fg, screen.app.theme.error().fg.unwrap());
}

#[test]
fn a_digit_goes_to_the_event_of_its_number_and_home_starts_again() {
    let mut screen = Screen::new("wavy-sphere");
    screen.keys("3");
    assert!(screen.text(80, 24).contains("Event 3 of 6"), "{}", screen.text(80, 24));
    assert!(screen.app.model.can_jump());
    screen.keys("9");
    assert!(screen.text(80, 24).contains("there is no event 9: the path has 6"));
    // At a different place each time, and g takes no digit.
    screen.keys("1");
    assert!(screen.text(80, 24).contains("Event 1 of 6"));
    let mut screen = Screen::new("fig-3-jkr");
    screen.keys("            ");
    assert_eq!(screen.app.model.history.current().unwrap().step, 12);
    screen.press(KeyCode::Home);
    assert!(screen.text(80, 24).contains("@ 0 "));
    // Solved again at the same radius: equal up to the rounding of sums taken in another order.
    let [start, here] = [screen.app.model.history.node(0), screen.app.model.history.current()]
        .map(|node| node.unwrap().state);
    assert_eq!(here.contact_radius.to_bits(), start.contact_radius.to_bits());
    assert!((here.force / start.force - 1.0).abs() < 1e-12, "{here:?} {start:?}");
}

#[test]
fn a_warning_cut_in_the_header_is_whole_in_the_help() {
    let mut screen = Screen::new("wavy-sphere");
    for (key, text) in [("basis.kind", "rings"), ("basis.rings", "40")] {
        let effects = update(&mut screen.app.model, Command::Set { key: key.into(), text: text.to_owned() });
        screen.settle(effects);
    }
    let warning = screen.app.model.warnings()[0].clone();
    let text = screen.text(80, 24);
    assert!(text.lines().next().unwrap().ends_with("... ?: all"), "{text}");
    assert!(!text.contains(&warning));
    screen.keys("?");
    let is_frame = |c: &char| ('\u{2500}'..='\u{257f}').contains(c);
    let unwrapped: String =
        screen.text(80, 24).chars().filter(|c| !c.is_whitespace() && !is_frame(c)).collect();
    let wanted: String = warning.chars().filter(|c| !c.is_whitespace()).collect();
    assert!(unwrapped.contains(&wanted), "{unwrapped}");
}

#[test]
fn groups_are_selected_where_they_stand() {
    let mut screen = Screen::new("wavy-sphere");
    let knobs = screen.app.model.knobs().len();
    for (key, label) in [("amplitude_over_wavelength", ">A/λ 0.05"), ("adhesion", ">γ' 0.025")] {
        screen.app.model.parameter = 0;
        screen.keys(&"j".repeat(knobs));
        while screen.app.model.selected_knob().unwrap().0.key != format!("groups.{key}") {
            screen.keys("k");
        }
        for (width, height) in [(80, 24), (100, 30), (200, 60)] {
            let buffer = screen.draw(width, height);
            assert!(find(&buffer, label).modifier.contains(Modifier::REVERSED), "{label} {width}x{height}");
        }
    }
    screen.keys(">");
    assert!(screen.text(80, 24).contains(">γ' 0.026"), "{}", screen.text(80, 24));
}

#[test]
fn every_column_of_the_events_is_in_its_unit() {
    let screen = Screen::new("fig-9-si");
    for (width, length) in [(80, " δ  548.0 "), (120, " δ (µm)  548.0 ")] {
        let text = screen.text(width, 40);
        assert!(text.contains(length) && text.contains(" nJ"), "{text}");
    }
    let mut rough = Screen::new("fig-9-si");
    rough.keys("\r").keys("40\r");
    let text = rough.text(120, 60);
    assert!(text.contains("! inadmissible s = ") && text.contains("at the crest r = "), "{text}");
    let part = text.lines().find(|line| line.contains("! inadmissible s = ")).unwrap();
    assert_eq!(part.matches(" µm").count(), 3, "{part}");
    // A cone has no P_c: its forces are forces, and the head says so.
    let text = Screen::new("cone").text(80, 24);
    assert!(!text.contains("P/Pc") && text.contains("-0.0002387"), "{text}");
}
