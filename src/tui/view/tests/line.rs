//! The command line, the search in the help, and a person's own keys, on the screen.

use super::Screen;
use crate::explorer::Id;
use crate::tui::config;
use crate::tui::keymap::Keymap;
use crate::tui::overlay::Dialog;
use crossterm::event::{KeyCode, KeyEvent, KeyModifiers};
use pulloff_engine::problem::Control;
use ratatui::layout::Rect;

fn prompt(screen: &Screen) -> (String, Option<String>, Option<usize>) {
    match &screen.app.overlay {
        Some(Dialog::Prompt(prompt)) => (prompt.input.value().to_owned(), prompt.error.clone(), prompt.fault),
        other => unreachable!("no line to type: {other:?}"),
    }
}

#[test]
fn a_typed_command_does_what_its_key_does() {
    let mut screen = Screen::new("wavy-sphere");
    screen.keys(":step 3\r");
    assert_eq!(screen.app.model.history.nodes().len(), 4);
    assert!(screen.app.overlay.is_none());
    screen.keys(":control force\r:set gap.amplitude=0.003 title=\"two  words\"\r:run\r");
    let model = &screen.app.model;
    assert_eq!(model.preset.path.control, Control::Force);
    assert_eq!(model.preset.title, "two  words");
    assert!(model.history.current().unwrap().is_limit(Control::Force));
    // Commands that only affect the screen work here too, and ask for what they need.
    screen.keys(":help\r\t");
    assert!(matches!(screen.app.overlay, Some(Dialog::Help(_))));
    screen.keys("\x1b:export\r");
    assert!(matches!(screen.app.overlay, Some(Dialog::Choose(_))));
    screen.keys("\x1b:quit\r");
    assert!(matches!(screen.app.overlay, Some(Dialog::Confirm(_))) && !screen.app.model.quit);
    screen.keys("\x1b:open fig-3-jkr\r");
    assert!(matches!(screen.app.overlay, Some(Dialog::Confirm(_))), "unsaved changes are not lost unasked");
}

#[test]
fn the_largest_pull_is_a_limit_point_once_the_force_is_controlled() {
    let mut screen = Screen::new("wavy-sphere");
    screen.keys("L:control force\r");
    let node = screen.app.model.history.current().unwrap();
    assert!(node.is_limit(Control::Force), "{:?}", node.kind);
    // A dead load at the largest pull has no equilibrium beyond: the bodies come apart.
    screen.keys("n");
    assert!(screen.app.model.history.current().unwrap().is_apart());
}

#[test]
fn an_edge_runs_the_way_that_the_screen_shows() {
    // At an event one can arrive by `n` or by its number; the other control is unstable there.
    let landing = |keys: &str| {
        let mut screen = Screen::new("wavy-sphere");
        screen.keys(&format!("{keys}:control force\r"));
        assert!(screen.text(80, 24).contains("lets the edge run inward"), "{}", screen.text(80, 24));
        screen.keys("n");
        screen.app.model.history.current().unwrap().state.contact_radius
    };
    // A landing is one of its own control.
    let mut screen = Screen::new("wavy-sphere");
    screen.keys("nn");
    assert!(screen.text(80, 24).contains("Landed"), "{}", screen.text(80, 24));
    screen.keys(":control force\r");
    assert!(!screen.text(80, 24).contains("Landed"), "{}", screen.text(80, 24));
    let (walked, led) = (landing("n"), landing("1"));
    assert!((walked / led - 1.0).abs() < 1e-9 && walked < 0.37, "{walked} {led}");
}

#[test]
fn what_is_wrong_is_said_with_its_column_and_stays_to_be_mended() {
    let mut screen = Screen::new("wavy-sphere");
    screen.keys(":step 3 x\r");
    let (line, error, fault) = prompt(&screen);
    assert_eq!((line.as_str(), fault), ("step 3 x", Some(8)));
    assert_eq!(error.as_deref(), Some("column 8: step takes no \"x\" here"));
    let text = screen.text(80, 24);
    let row = text.lines().position(|row| row.contains("> step 3 x")).unwrap();
    let caret = text.lines().nth(row + 1).unwrap();
    let at = |line: &str, c: char| line.chars().position(|found| found == c).unwrap();
    assert_eq!(at(caret, '^'), at(text.lines().nth(row).unwrap(), 'x'));
    // Once corrected, it is run; a line refused by the model stays as well.
    screen.press(KeyCode::Backspace);
    screen.keys("\r:jump\r");
    assert!(prompt(&screen).1.unwrap().contains("the state is stable"));
    screen.keys("\x1b:\r");
    assert!(screen.app.overlay.is_none());
}

#[test]
fn tab_takes_an_entry_and_up_brings_lines_back() {
    let mut screen = Screen::new("wavy-sphere");
    screen.keys(":ha\t\r:set gap.am\t0.003\r:set gap.shape=exp");
    assert_eq!(screen.app.model.preset.gap.wave(), Some((0.003, 0.05)));
    let line = |screen: &Screen| prompt(screen).0;
    screen.press(KeyCode::Up);
    assert_eq!(line(&screen), "set gap.amplitude=0.003");
    screen.press(KeyCode::Up);
    screen.press(KeyCode::Up);
    assert_eq!(line(&screen), "halve-step");
    screen.press(KeyCode::Down);
    screen.press(KeyCode::Down);
    assert_eq!(line(&screen), "set gap.shape=exp");
    // The text before the cursor is replaced; after the cursor nothing is lost.
    screen.keys("\x1b: 5");
    screen.press(KeyCode::Home);
    screen.keys("step\t");
    assert_eq!(line(&screen), "step 5");
    // Enter does not run an entry without that text either.
    screen.keys("\x1b: 5");
    screen.press(KeyCode::Home);
    let states = screen.app.model.history.nodes().len();
    screen.keys("ste\r");
    assert_eq!((line(&screen), screen.app.model.history.nodes().len()), ("step 5".to_owned(), states));
    screen.keys("\r");
    assert_eq!(screen.app.model.history.nodes().len(), states + 5);
}

#[test]
fn what_is_typed_keeps_what_has_it_and_enter_runs_what_is_selected() {
    let mut screen = Screen::new("wavy-sphere");
    screen.keys(":");
    let shown = screen.text(80, 24);
    assert!(shown.contains("Space") && shown.contains("one step along"), "{shown}");
    // A command that cannot be run now says why.
    screen.keys("jump");
    assert!(screen.text(120, 40).contains("- the state is stable"), "{}", screen.text(120, 40));
    screen.keys("\x1b:A 0.003\r");
    assert_eq!(screen.app.model.preset.gap.wave(), Some((0.003, 0.05)));
    screen.keys(":amplitude\r");
    assert_eq!(prompt(&screen).0, "set gap.amplitude=");
    screen.keys("0.002\r");
    assert_eq!(screen.app.model.preset.gap.wave(), Some((0.002, 0.05)));
    // The arrows move through the list; more names are below.
    screen.keys(":fig-");
    screen.press(KeyCode::Down);
    let shown = screen.text(80, 24);
    let chosen = shown.lines().find(|line| line.contains("> ") && line.contains("open fig-")).unwrap();
    assert!(shown.contains("2 of ") && !chosen.contains("fig-1-hertz"), "{shown}");
    for _ in 0..50 {
        screen.press(KeyCode::Down);
    }
    let Some(Dialog::Prompt(prompt)) = &screen.app.overlay else { unreachable!() };
    assert_eq!(prompt.selected, Some(prompt.entries.len() - 1));
    let states = screen.app.model.history.nodes().len();
    screen.keys("\x1b?");
    screen.press(KeyCode::Down);
    screen.keys("\r");
    assert_eq!(screen.app.model.history.nodes().len(), states + 1, "the first is a step");
    screen.keys("?");
    for _ in 0..2 {
        screen.press(KeyCode::Up);
    }
    assert!(matches!(&screen.app.overlay, Some(Dialog::Prompt(_))));
}

#[test]
fn the_header_says_what_the_preset_says_and_what_was_changed_and_a_chart_when_it_is_past_the_curve() {
    let mut screen = Screen::new("wavy-sphere");
    let header = |screen: &mut Screen| {
        let header = screen.text(160, 45).lines().next().unwrap().to_owned();
        header.trim_end().strip_suffix("g:  CURVE  inside  map  data").unwrap().to_owned()
    };
    let says = "A sphere with waves on it, pulled off by fixed grips: the place to start.";
    assert!(header(&mut screen).contains(says), "{}", header(&mut screen));
    screen.keys(":set gap.amplitude=0.003\r");
    assert!(header(&mut screen).trim_end().ends_with("  A 0.0025 → 0.003"), "{}", header(&mut screen));
    screen.keys(":set gap.amplitude=0.0025000001\r");
    assert!(header(&mut screen).trim_end().ends_with("  A 0.0025 → 0.0025000001"), "{}", header(&mut screen));
    // Everything it says, and what was changed.
    screen.keys("I");
    let text = screen.text(120, 40);
    assert!(
        text.contains("1.48 times that of the smooth sphere") && text.contains("Changed since"),
        "{text}"
    );
    screen.keys("\x1buu");
    assert!(header(&mut screen).contains(says), "{}", header(&mut screen));
    screen.app.model.panel = crate::explorer::ScreenPanel::Charts;
    let past =
        |screen: &mut Screen| screen.text(120, 40).contains("past the end of the curve: f shows all of it");
    screen.keys("++");
    screen.press(KeyCode::Right);
    assert!(!past(&mut screen));
    for _ in 0..20 {
        screen.press(KeyCode::Right);
    }
    assert!(past(&mut screen));
    screen.keys("f");
    assert!(screen.app.model.window(screen.app.model.view).is_whole());
}

#[test]
fn the_help_is_searched() {
    let mut screen = Screen::new("fig-3-jkr");
    let found = |screen: &Screen| match &screen.app.overlay {
        Some(Dialog::Help(help)) => help.found,
        other => unreachable!("no help: {other:?}"),
    };
    screen.keys("?\t/PRESET\r");
    let first = found(&screen).unwrap();
    let of = first.of;
    assert!(first.number == 1 && of > 1, "{first:?}");
    assert!(screen.text(80, 24).contains(&format!("/PRESET: 1 of {of}")));
    screen.keys("n");
    let second = found(&screen).unwrap();
    assert!((second.page, second.line) > (first.page, first.line));
    screen.keys("NN");
    assert_eq!(found(&screen).unwrap().number, of);
    screen.keys("n");
    assert_eq!(found(&screen), Some(first));
    screen.keys("/qqq\r");
    assert!(found(&screen).is_none() && screen.text(80, 24).contains("/qqq: not found"));
    // Typed text is not a command, and Esc first leaves the text.
    screen.keys("/nx\x1b");
    assert!(matches!(screen.app.overlay, Some(Dialog::Help(_))));
    screen.keys("\x1b");
    assert!(screen.app.overlay.is_none());
}

#[test]
fn a_persons_keys_work_and_are_shown_in_footer_and_help() {
    let mut screen = Screen::new("wavy-sphere");
    let text = "[keys]\nstep = \"F4\"\nundo = [\"w\", \"Ctrl-U\"]\njump = []\nedit = \"Z\"\n";
    screen.app.keymap = Keymap::of(&config::read("c", text).unwrap()).unwrap();
    screen.press(KeyCode::F(4));
    assert_eq!(screen.app.model.history.nodes().len(), 2);
    screen.keys("wu ");
    assert_eq!(screen.app.model.history.cursor(), Some(0));
    assert!(screen.text(80, 24).contains("F4 step"));
    screen.keys("?");
    let help = screen.text(100, 150);
    assert!(help.contains("F4 ") && help.contains("w Ctrl-U") && help.contains("jump"), "{help}");
    // In a list, Enter still chooses.
    screen.keys("\x1be\r");
    assert!(matches!(screen.app.overlay, Some(Dialog::Prompt(_))));
    assert_eq!(screen.app.keymap.first(Id::Edit), "Z");
}

#[test]
fn a_name_that_is_refused_stays_to_be_mended_and_keys_meanwhile_are_no_commands() {
    let mut screen = Screen::new("wavy-sphere");
    screen.keys("S");
    screen.app.key(KeyEvent::new(KeyCode::Char('u'), KeyModifiers::CONTROL));
    screen.keys("my waves/2");
    let effects = screen.app.key(KeyCode::Enter.into());
    assert!(prompt(&screen).1.is_none());
    // Until the answer arrives, typed keys are neither commands nor text.
    screen.keys("nq");
    screen.settle(effects);
    let (line, error, _) = prompt(&screen);
    assert_eq!(line, "my waves/2");
    assert!(error.unwrap().contains("not saved"));
    assert_eq!(screen.app.model.history.nodes().len(), 1);
    screen.keys("\x1bSx\r");
    assert!(screen.app.overlay.is_none());
    // A path that cannot be written stays as well.
    screen.keys(":export curve /nowhere/at/all.csv\r");
    assert!(prompt(&screen).1.unwrap().contains("not exported"));
}

#[test]
fn text_typed_in_a_list_keeps_the_lines_that_have_it() {
    let mut screen = Screen::new("wavy-sphere");
    screen.keys("ofig-3");
    let Some(Dialog::Choose(choose)) = &screen.app.overlay else { unreachable!() };
    assert_eq!(choose.shown().len(), 1);
    assert!(choose.current().unwrap().1.text.starts_with("fig-3-jkr"));
    screen.keys("xx\r");
    assert!(screen.text(80, 24).contains("no line matches \"fig-3xx\""));
    screen.press(KeyCode::Backspace);
    screen.press(KeyCode::Backspace);
    screen.keys("\r");
    assert_eq!(screen.app.model.source.shown(), "fig-3-jkr");
    screen.keys("o");
    screen.press(KeyCode::End);
    let Some(Dialog::Choose(choose)) = &screen.app.overlay else { unreachable!() };
    assert_eq!(choose.selected, choose.items.len() - 1);
    screen.keys("Fig. 9\r");
    assert_eq!(screen.app.model.source.shown(), "fig-9");
    // A path goes on in the prompt of files.
    screen.keys("o");
    let path = screen.folder.path().join("own.toml");
    let text = crate::store::shipped::find("cone").unwrap().text;
    std::fs::write(&path, text.replace("Adhesive cone", "My cone")).unwrap();
    screen.keys(&format!("{}\r", path.display()));
    assert!(screen.app.model.preset.title.starts_with("My cone"), "{}", screen.text(80, 24));
    screen.keys("\x1b");
    screen.press(KeyCode::End);
    assert_eq!(screen.app.model.parameter, screen.app.model.knobs().len() - 1);
}

#[test]
fn the_help_names_commands_and_undo_takes_a_count() {
    let mut screen = Screen::new("wavy-sphere");
    screen.keys("?\t");
    let shown = screen.text(100, 30);
    assert!(shown.lines().next().unwrap().contains("Help 1 of 3: how to read it"), "{shown}");
    screen.keys("\t");
    assert!(screen.text(100, 30).lines().nth(1).unwrap().contains("First steps"));
    screen.press(KeyCode::BackTab);
    assert_eq!(screen.text(100, 30), shown);
    for (keys, found) in [("/Ctrl-Z\r", "back to the shell"), ("/crest\r", "crest")] {
        screen.keys(keys);
        let shown = screen.text(100, 30);
        assert!(!shown.contains("not found") && shown.contains(found), "{shown}");
    }
    screen.press(KeyCode::Esc);
    screen.keys("   ");
    let steps = screen.app.model.history.len();
    screen.keys(":undo 3\r");
    assert_eq!(screen.app.model.history.cursor(), Some(steps - 4));
    screen.keys(":undo 9\r");
    assert_eq!(screen.app.model.history.cursor(), Some(0), "as far as it goes");
}

#[test]
fn figures_and_the_screen_are_exported_by_a_line() {
    let mut screen = Screen::new("wavy-sphere");
    screen.app.screen = Rect::new(0, 0, 100, 30);
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).display().to_string();
    screen.keys(&format!(":export figure {}\r", path("a.svg")));
    screen.keys(&format!(":export figure {} stability\r", path("b.svg")));
    screen.keys(&format!(":export screen {}\r", path("c.txt")));
    let read = |name: &str| std::fs::read_to_string(path(name)).unwrap();
    assert!(read("a.svg").starts_with("<svg") && read("b.svg").contains("γ"));
    assert_ne!(read("a.svg"), read("b.svg"));
    assert!(read("c.txt").contains("lost up to here 0 of"));
    // An existing file is replaced only when told.
    screen.keys(&format!(":export screen {}\r", path("c.txt")));
    assert!(screen.text(100, 30).contains("Replace it? y does"), "{}", screen.text(100, 30));
    screen.keys("n").keys(&format!(":export figure {} walk\r", path("d.svg")));
    assert!(screen.text(100, 30).contains("export walk writes it"), "{}", screen.text(100, 30));
    screen.keys("\x1b").keys(&format!(":export figure {} wak\r", path("d.svg")));
    assert!(screen.text(100, 30).contains("did you mean walk?"), "{}", screen.text(100, 30));
}

#[test]
fn a_formula_set_by_a_line_names_its_new_parameters() {
    let mut screen = Screen::new("formula");
    screen.keys(":set gap.formula=r^2/(2*R)+D*r^4\r");
    assert!(screen.text(120, 40).contains("new parameter D = 1"), "{}", screen.text(120, 40));
}

#[test]
fn what_is_undone_of_other_values_is_not_drawn_and_the_selection_stays_near() {
    let mut screen = Screen::new("wavy-sphere");
    screen.keys("nnuu");
    assert!(screen.text(120, 40).contains("other branch"), "{}", screen.text(120, 40));
    let mut screen = Screen::new("wavy-sphere");
    screen.keys(":set gap.amplitude=0.005\rnnnnuuuuu");
    assert!(!screen.text(120, 40).contains("other branch"), "{}", screen.text(120, 40));
    // A value that an undo takes out of the list hands the selection to the value above it.
    screen.keys(":set edge.reference_speed=0.01 edge.exponent=0.5 path.rate=0.001\r");
    screen.keys(":study peak_force path.rate=log:1e-4..1e-2\r");
    let key = |screen: &Screen| screen.app.model.selected_knob().unwrap().0.key.to_string();
    assert_eq!(key(&screen), "path.rate");
    screen.keys("uu");
    assert!(
        screen.app.model.preset.edge.rate.is_none() && key(&screen).starts_with("path."),
        "{}",
        key(&screen)
    );
}
