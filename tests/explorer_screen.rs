//! A whole session in a pseudo-terminal, as a person has it: open, step, run to an instability, jump, turn a
//! knob, save, export, quit, and find the preset again.

mod support;

use std::fs;
use std::path::Path;
use support::pty::Pty;

fn program() -> &'static Path {
    Path::new(env!("CARGO_BIN_EXE_pulloff"))
}

/// The line of the screen with this text.
fn line(pty: &Pty, text: &str) -> String {
    let screen = pty.screen();
    let found = screen.lines().find(|line| line.contains(text));
    assert!(
        found.is_some(),
        "no {text} in
{screen}"
    );
    found.unwrap_or_default().to_owned()
}

/// Goes down the parameters to the one of this label.
fn select(pty: &mut Pty, label: &str) {
    let selected = format!(">{label}");
    while !pty.screen().contains(&selected) {
        let before = pty.screen();
        pty.keys("j");
        // At the last parameter nothing moves, and this fails.
        pty.wait_for(|screen| screen != before, "another parameter");
    }
}

#[test]
fn a_session_from_opening_to_finding_the_preset_again() {
    let home = tempfile::tempdir().unwrap();
    let config = home.path().join("config");
    let export = home.path().join("walk.csv");
    let env = [("XDG_CONFIG_HOME", config.to_str().unwrap()), ("HOME", home.path().to_str().unwrap())];
    let mut pty = Pty::spawn(program(), &[], &env, 100, 30);
    pty.wait_for(|screen| screen.contains("Events on the curve: 6"), "the curve and its events");

    // Steps, one and several.
    pty.keys(" ");
    pty.wait_for(|screen| screen.contains("Walker, step 1"), "one step");
    pty.keys("3 ");
    pty.wait_for(|screen| screen.contains("Walker, step 4"), "three more");

    // To the first instability, and the jump from crest 8 to crest 7.
    pty.keys("n");
    pty.wait_for(|screen| screen.contains("Limit point 1/15: x jumps to crest 7"), "the limit point");
    assert!(line(&pty, " stable δ").contains("δ LIMIT"));
    pty.keys("x");
    pty.wait_for(|screen| screen.contains("Landed, stable again, lost 1.217e-4"), "the landing");
    assert!(line(&pty, "crest 7").contains("crest 7"));

    // Undo and redo move a cursor over what is kept.
    pty.keys("u");
    pty.wait_for(|screen| screen.contains("Limit point 1/15"), "back at the limit point");
    pty.keys("\x12");
    pty.wait_for(|screen| screen.contains("Landed"), "landed again");

    // A knob: a value out of range is refused with the reason, a good one moves curve and log.
    let before = line(&pty, "  1  ");
    pty.keys("\r");
    pty.wait_for(|screen| screen.contains("amplitude of the wave"), "the prompt");
    pty.keys("\x15-1\r");
    pty.wait_for(|screen| screen.contains("gap.amplitude"), "the refusal");
    pty.keys("\x150.003\r");
    pty.wait_for(|screen| screen.contains("unsaved") && screen.contains("0.003 "), "the new value");
    pty.wait_for(|screen| !screen.contains("computing") && !screen.contains(&before), "the new log");

    // Saved under a name of one's own; the walk exported.
    pty.keys("s");
    pty.wait_for(|screen| screen.contains("Save the preset as"), "the prompt");
    pty.keys("\x15lab-3\r");
    pty.wait_for(|screen| screen.contains("saved as lab-3") && !screen.contains("unsaved"), "saved");
    pty.keys("ej\r");
    pty.wait_for(|screen| screen.contains("Export the walk to"), "the prompt");
    pty.keys("\x15");
    pty.paste(export.to_str().unwrap());
    pty.keys("\r");
    pty.wait_for(|screen| screen.contains("exported to"), "exported");

    // Nothing unsaved: it quits at once.
    pty.keys("q");
    assert_eq!(pty.exit_code(), 0);
    pty.assert_restored();

    let walk = fs::read_to_string(&export).unwrap();
    let kinds: Vec<&str> = walk.lines().skip(1).filter_map(|line| line.split(',').nth(1)).collect();
    assert_eq!(kinds[0], "start");
    assert!(kinds.contains(&"limit") && kinds.contains(&"snap"));
    assert_eq!(kinds.last(), Some(&"solved"));

    // The preset is there again, from the list.
    let mut pty = Pty::spawn(program(), &[], &env, 100, 30);
    pty.wait_for(|screen| screen.contains("Events on the curve: 6"), "the curve");
    pty.keys("o");
    pty.wait_for(|screen| screen.contains("lab-3"), "the list");
    // Last but one: only "a file" stands behind it.
    pty.keys("jjjjjjjjjjjjjjjjjjjjjjjjjjjk\r");
    pty.wait_for(|screen| screen.contains(" lab-3  control") && screen.contains("0.003 "), "the preset");
    pty.keys("q");
    assert_eq!(pty.exit_code(), 0);
}

#[test]
fn every_view_a_closer_look_and_a_pin() {
    let mut pty = Pty::spawn(program(), &["fig-8"], &[], 80, 24);
    pty.wait_for(|screen| screen.contains("Events on the curve: 2"), "the curve");
    for title in
        ["s/λ over P/Pc", "s/λ over δ", "p/E* over r/λ", "gap over r/λ", "U over s/λ", "unloading: P/Pc"]
    {
        pty.keys("t");
        pty.wait_for(|screen| screen.contains(title), title);
        // The state's own views come from a worker.
        pty.wait_for(|screen| !screen.contains("computing"), "its picture");
    }
    pty.keys("t");
    pty.wait_for(|screen| screen.contains("P/Pc over δ  (t:"), "the first view again");

    pty.keys("++");
    pty.wait_for(|screen| screen.contains("zoom 4x"), "a closer look");
    pty.keys("i");
    pty.wait_for(|screen| screen.contains("; * δ "), "the cross-hair");
    pty.keys("\x1bf");
    pty.wait_for(|screen| !screen.contains("zoom") && !screen.contains("; * δ "), "all of it");

    // Back to the Problem panel, where > turns the amplitude.
    pty.keys("\t\t");
    pty.keys("p");
    pty.wait_for(|screen| screen.contains("pinned as 1"), "a pin");
    pty.keys("}");
    pty.wait_for(|screen| screen.contains("1 A 0.001"), "the pin by what differs");
    pty.keys("P");
    pty.wait_for(|screen| screen.contains("Take a pinned curve away"), "the list of pins");
    pty.keys("\r");
    pty.wait_for(|screen| !screen.contains("1 A 0.001"), "the pin taken away");
    pty.keys("y\r\x1b");
    pty.wait_for(|screen| !screen.contains("Theory"), "the overlays closed");
    pty.keys("qy");
    assert_eq!(pty.exit_code(), 0);
}

#[test]
fn quitting_with_unsaved_changes_asks_first() {
    let mut pty = Pty::spawn(program(), &["fig-8"], &[], 80, 24);
    pty.wait_for(|screen| screen.contains("Events on the curve: 2"), "the curve");
    pty.keys("}");
    pty.wait_for(|screen| screen.contains("unsaved"), "a change");
    pty.keys("q");
    pty.wait_for(|screen| screen.contains("y quits without saving"), "the question");
    pty.keys("\x1b");
    pty.wait_for(|screen| !screen.contains("y quits without saving"), "the screen");
    pty.keys("qy");
    assert_eq!(pty.exit_code(), 0);
}

#[test]
fn a_bad_preset_is_an_error_before_the_screen_is_taken() {
    let mut pty = Pty::spawn(program(), &["wavy-spere"], &[], 100, 24);
    assert_eq!(pty.exit_code(), 2);
    assert!(pty.screen().contains("did you mean wavy-sphere"), "{}", pty.screen());
    assert!(!pty.raw().contains(&0x1b));
}

#[test]
fn the_stiffness_of_the_device_is_a_knob_from_displacement_to_force() {
    let mut pty = Pty::spawn(program(), &[], &[], 120, 40);
    pty.wait_for(|screen| screen.contains("Events on the curve: 6"), "the curve");
    pty.keys("n");
    pty.wait_for(|screen| screen.contains("Limit point 1/"), "a limit point of the displacement");
    select(&mut pty, "control");
    pty.keys("<");
    pty.wait_for(
        |screen| screen.contains("STIFFNESS=") && screen.contains("of the contact's"),
        "a stiff device",
    );
    // The walker stays, and is past the limit point of the softer device.
    pty.keys("{{{{{{{{{{{{{{{{{{{{{{{{{{");
    pty.wait_for(|screen| screen.contains("Unstable under stiffness control"), "the flags of the walker");
    pty.keys("\r");
    pty.wait_for(|screen| screen.contains("stiffness = k"), "the prompt");
    pty.keys("\x150.31\r");
    pty.wait_for(|screen| screen.contains("STIFFNESS=0.31"), "a bare number");
    pty.keys("c");
    pty.wait_for(|screen| screen.contains("control DISPLACEMENT"), "round");
    pty.wait_for(|screen| screen.contains("Limit point 1/"), "the limit point again");
    pty.keys("cc");
    pty.wait_for(|screen| screen.contains("STIFFNESS=0.31"), "the last stiffness");
    pty.keys("q");
    pty.wait_for(|screen| screen.contains("y quits without saving"), "the question");
    pty.keys("y");
    assert_eq!(pty.exit_code(), 0);
}

#[test]
fn a_curve_that_takes_long_can_be_given_up() {
    let mut pty = Pty::spawn(program(), &["fig-9"], &[], 100, 30);
    pty.wait_for(|screen| screen.contains("Events on the curve: 8"), "the curve");
    select(&mut pty, "N ");
    // Two thousand rings take seconds to factorize.
    pty.keys("\r");
    pty.wait_for(|screen| screen.contains("from 4 to 2000"), "the prompt");
    pty.keys("\x152000\r");
    pty.wait_for(|screen| screen.contains("computing"), "the new curve under way");
    pty.keys("\x1b");
    pty.wait_for(|screen| screen.contains("cancelled: the curve shown is of the values before"), "given up");
    assert!(pty.screen().contains("Events on the curve: 8") && pty.screen().contains("unsaved"));
    pty.keys("u");
    pty.wait_for(|screen| !screen.contains("unsaved") && !screen.contains("computing"), "the values back");
    pty.keys("n");
    pty.wait_for(|screen| screen.contains("Limit point 1/"), "the walk goes on");
    pty.keys("q");
    assert_eq!(pty.exit_code(), 0);
}
