//! Sentences name the keys that the person has.

use super::Screen;
use crate::config::read;
use crate::explorer::Id;
use crate::tui::keymap::Keymap;
use crossterm::event::KeyCode;

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
    says(&screen, "F2 runs to the next event, F4 undoes");
    screen.press(KeyCode::F(9));
    says(&screen, ":pins lists the pins");
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
    says(&screen, "F4 goes back, F6 starts again");
    screen.press(KeyCode::F(3));
    says(&screen, "the bodies are apart: F4 goes back, F6 starts again");
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
fn a_number_before_a_command_does_it_so_often() {
    let state = |keys: &str| {
        let mut screen = Screen::new("wavy-sphere");
        screen.keys(keys);
        let node = screen.app.model.history.current().unwrap();
        let preset = &screen.app.model.preset;
        // Solved once for each value or for the last alone: the same to rounding.
        (format!("{:.9}", node.state.contact_radius), preset.get("gap.amplitude"))
    };
    assert_eq!(state("3n"), state("nnn"));
    assert_eq!(state("n2xn"), state("nxxn"));
    assert_eq!(state("4>2n"), state(">>>>nn"));
    assert_ne!(state("3n"), state("n"));
    // Each is a command of its own to undo.
    assert_eq!(state("3>u"), state(">>"));
}
