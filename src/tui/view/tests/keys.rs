//! Sentences name the keys that the person has set.

use super::Screen;
use crate::explorer::{Id, ScreenPanel, View};
use crate::tui::config::read;
use crate::tui::keymap::Keymap;
use crossterm::event::KeyCode;
use pulloff_engine::problem::Control;
use ratatui::layout::Rect;

fn bind(screen: &mut Screen, keys: &str) {
    screen.app.keymap = Keymap::of(&read("c", &format!("[keys]\n{keys}")).unwrap()).unwrap();
}

#[test]
fn sentences_name_the_keys_of_a_person() {
    let mut screen = Screen::new("wavy-sphere");
    assert!(screen.text(100, 30).contains("n runs to the first event, ? helps"));
    bind(
        &mut screen,
        "next-event = \"F2\"\nstep = \"F3\"\nundo = \"F4\"\njump = \"J\"\nhelp = \"F5\"\nrestart = \"F6\"\n\
         save-as = \"W\"\nwhole = \"F8\"\npin = \"F9\"\npins = []\nedit = \"F12\"\nless = \"(\"\nmore = \")\"\nslower = []\nfaster = []",
    );
    let says = |screen: &Screen, text: &str| {
        let shown = screen.text(120, 40);
        assert!(shown.contains(text), "{text}: {shown}");
        assert!(!shown.contains('\u{1}'), "{shown}");
    };
    says(&screen, "F2 runs to the first event, F5 helps");
    says(&screen, "A         0.0025 ( )");
    screen.keys("f");
    says(&screen, "that key does nothing here; F5 shows all keys");
    screen.press(KeyCode::F(2));
    says(&screen, ": F2 or J lets the edge snap to");
    says(&screen, "F3 goes on, unstable");
    screen.keys("J");
    says(&screen, "F2 runs inward to the next event, F4 undoes");
    screen.press(KeyCode::F(9));
    says(&screen, ":pins removes it");
    screen.press(KeyCode::F(5));
    let help =
        (0..3).flat_map(|page| super::super::help::plain(&screen.app, page)).collect::<Vec<_>>().join("\n");
    assert!(help.contains("F2 runs to the first event") && help.contains("press )"));
    screen.keys("\x1b)q");
    says(&screen, "Esc stays, W");
    screen.keys("W");
    says(&screen, "Save");
    screen.keys("\x1b");
    // Until the bodies are apart.
    while !screen.app.model.history.current().unwrap().is_apart() {
        screen.press(KeyCode::F(2));
        screen.keys("J");
    }
    says(&screen, "apart, lost");
    says(&screen, ". F6 restarts; begin=apart: whole loop");
    let footer = screen.text(120, 40).lines().last().unwrap().to_owned();
    assert!(footer.starts_with(" F4 undo  F6 start  ") && !footer.contains("F2 next"), "{footer}");
    screen.press(KeyCode::F(3));
    says(&screen, "the bodies are apart: F4 goes back, F6 starts again");
    // What was lost there is no loss of other values.
    screen.keys(":A 0.001\r");
    says(&screen, "came apart at other values: F6 starts again");
}

#[test]
fn what_was_refused_in_a_prompt_names_keys_too() {
    let mut screen = Screen::new("wavy-sphere");
    bind(&mut screen, "pins = \"F2\"\npin = \"F3\"\nsave-as = []");
    screen.keys(":pins\r");
    let shown = screen.text(100, 30);
    assert!(shown.contains("no curve is pinned: F3 pins the one on the screen"), "{shown}");
    screen.keys("\x1b>q");
    assert!(screen.text(100, 30).contains("y quits, Esc stays."), "{}", screen.text(100, 30));
    assert_eq!(screen.app.keymap.first(Id::SaveAs), ":save-as");
}

#[test]
fn turns_of_one_value_are_taken_back_together() {
    let amplitude = |keys: &str| {
        let mut screen = Screen::new("wavy-sphere");
        screen.keys(keys);
        screen.app.model.preset.get("gap.amplitude").unwrap().to_string()
    };
    for (keys, value) in [
        (">>>", "0.0028"),
        (">>>u", "0.0025"),
        // Something in between separates them: a step, another value.
        (">> >u", "0.0027"),
        (">>l>hu", "0.0027"),
        (">>l>h>u", "0.0027"),
        (">u>>u", "0.0025"),
        ("}}<,,u", "0.0025"),
        ("}}<,,", "0.00388"),
    ] {
        assert_eq!(amplitude(keys), value, "{keys}");
    }
}

#[test]
fn the_footer_offers_what_the_selected_panel_has_and_g_the_places() {
    let mut screen = Screen::new("wavy-sphere");
    let footer = |screen: &Screen| screen.text(160, 45).lines().last().unwrap().to_owned();
    assert!(footer(&screen).contains("< less  > more  ? keys  Enter type"), "{}", footer(&screen));
    screen.app.model.panel = ScreenPanel::Log;
    assert!(footer(&screen).contains("Enter go there") && !footer(&screen).contains("more"));
    screen.app.model.panel = ScreenPanel::Charts;
    assert!(footer(&screen).contains("i cross-hair"), "{}", footer(&screen));
    screen.keys("gm");
    assert!(footer(&screen).contains("Enter quantity"), "{}", footer(&screen));
    assert!(screen.text(160, 45).lines().next().unwrap().contains("g:  curve  inside  MAP  data"));
    screen.keys("g");
    assert!(
        footer(&screen).starts_with(" c curve  i inside  m map  d data  Esc back"),
        "{}",
        footer(&screen)
    );
    // Any other key has its usual effect, and Escape has none.
    screen.keys("n");
    assert!(footer(&screen).contains("x jump"));
    screen.keys("g\x1b");
    assert_eq!(screen.app.model.view, View::Study);
}

#[test]
fn choices_are_lists() {
    let mut screen = Screen::new("wavy-sphere");
    let select = |screen: &mut Screen, key: &str| {
        let at = screen.app.model.knobs().iter().position(|(row, _)| row.key == key).unwrap();
        screen.app.model.parameter = at;
    };
    select(&mut screen, "path.begin");
    screen.keys("\r");
    let text = screen.text(80, 24);
    for word in ["> disc", "apart"] {
        assert!(text.contains(word), "{word}: {text}");
    }
    screen.keys("apart\r");
    assert_eq!(screen.app.model.preset.get("path.begin").unwrap().to_string(), "apart");
    // A spring is chosen, and its stiffness typed.
    select(&mut screen, "path.control");
    screen.keys("\rjj\r0.3\r");
    assert_eq!(screen.app.model.preset.path.control, Control::Stiffness(0.3));
    screen.keys("\rkk\r");
    assert_eq!(screen.app.model.preset.path.control, Control::Displacement);
    // Or both in one line, as on the command line.
    screen.keys("cstiff=0.4\r");
    assert_eq!(screen.app.model.preset.path.control, Control::Stiffness(0.4));
}

#[test]
fn what_comes_next_and_the_keys_of_a_list_are_not_cut() {
    let mut screen = Screen::new("wavy-sphere");
    screen.keys("  b");
    let text = screen.text(80, 24);
    assert!(text.contains("displacement control. Space steps outward, n to the next event"), "{text}");
    screen.keys("c");
    let text = screen.text(120, 40);
    assert!(text.contains("Esc goes back, letters filter"), "{text}");
}

#[test]
fn a_pin_has_a_column_in_result_and_the_change_in_per_cent() {
    let mut screen = Screen::new("wavy-sphere");
    assert!(!screen.text(120, 40).contains("change"));
    screen.keys("p");
    let text = screen.text(120, 40);
    assert!(text.contains("now   pin D change"), "{text}");
    assert!(text.contains(" 0%"), "{text}");
    screen.keys(":set gap.amplitude=0.003\r");
    let text = screen.text(120, 40);
    let row = text.lines().find(|line| line.contains("A P ")).unwrap();
    let cells: Vec<&str> = row.split('│').nth(1).unwrap().split_whitespace().collect();
    let [now, pin, change] = [2, 3, 4].map(|at| cells[at].trim_end_matches('%').parse::<f64>().unwrap());
    assert!((100.0 * (now - pin) / pin - change).abs() < 0.4, "{row}");
    assert!(pin.abs() < now.abs() && change > 0.0, "a larger pull: {row}");
}

#[test]
fn values_that_would_leave_the_walker_far_beyond_the_path_set_it_to_its_start() {
    let mut screen = Screen::new("lens");
    let radius = |screen: &Screen| {
        let node = screen.app.model.history.current().unwrap();
        node.state.in_units(node.setting.units()).contact_radius
    };
    screen.keys("  ");
    let before = radius(&screen);
    // The values that a fit finds: the far end of the spring is held, where the contact would be 130 µm wide.
    screen.keys(":set material.effective_modulus=\"1 MPa\" material.work_of_adhesion=\"50 mJ/m^2\"\r");
    assert!((radius(&screen) - 100e-6).abs() < 1e-12, "{}", radius(&screen));
    assert!(screen.text(120, 40).contains("has the value held"), "{}", screen.text(120, 40));
    screen.keys("u");
    assert!((radius(&screen) - before).abs() < 1e-15);
    // A little beyond the start it is left where it is, and nothing more is said about it.
    let mut screen = Screen::new("lens");
    screen.keys(":set material.effective_modulus=\"2.9 MPa\"\r");
    assert!(radius(&screen) > 100.01e-6 && radius(&screen) < 110e-6, "{}", radius(&screen));
    assert!(!screen.text(120, 40).contains("has the value held"), "{}", screen.text(120, 40));
}

#[test]
fn a_path_that_ends_early_says_so_and_why_is_read_whole() {
    let mut screen = Screen::new("wavy-sphere");
    screen.keys(":material.cohesive_range=0.01\r");
    assert!(screen.text(80, 24).contains(", ends early"), "{}", screen.text(80, 24));
    screen.keys("nnnnnnnnnnnn");
    let short = screen.text(80, 24);
    assert!(short.contains("the path ends here") && !short.contains("torn inside"), "{short}");
    screen.keys("?\t");
    assert!(screen.text(80, 24).contains("contact is torn inside"), "{}", screen.text(80, 24));
}

#[test]
fn keys_that_nobody_sees_do_nothing() {
    let mut screen = Screen::new("wavy-sphere");
    assert!(screen.text(30, 8).contains("pulloff needs 40x10"));
    screen.app.screen = Rect::new(0, 0, 30, 8);
    let states = screen.app.model.history.path().len();
    screen.keys("nn:set gamma=0.1\r");
    assert_eq!((screen.app.model.history.path().len(), screen.app.overlay.is_none()), (states, true));
    screen.app.screen = Rect::new(0, 0, 80, 24);
    screen.keys("n");
    assert!(screen.app.model.history.path().len() > states);
}

#[test]
fn a_rate_that_the_new_control_cannot_have_is_dropped_with_a_word() {
    let mut screen = Screen::new("fig-9-si");
    screen.keys(":set edge.exponent=0.5 reference_speed=1um/s path.rate=\"2 um/s\"\r");
    assert_eq!(screen.app.model.preset.edge.rate, Some(2e-6), "{}", screen.text(100, 30));
    screen.keys("cforce\r");
    let text = screen.text(120, 40);
    assert!(screen.app.model.preset.edge.rate.is_none(), "{text}");
    assert!(text.contains("is dropped: it is no rate under the new control"), "{text}");
}
