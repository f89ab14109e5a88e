//! A whole session in a pseudo-terminal, as a user experiences it: open, step, run to an instability, jump, turn a
//! knob, save, export, quit, and find the preset again.

use crate::support::home::Home;
use crate::support::pty::Pty;
use crate::support::session::Session;
use std::fs;
use std::path::Path;

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

/// Moves down the parameters to the one with this label.
fn select(pty: &mut Pty, label: &str) {
    let selected = format!(">{label}");
    pty.press_until("l", |screen| word_after(screen, ">"), |screen| screen.contains(&selected));
}

/// The first word after a mark.
fn word_after(screen: &str, mark: &str) -> Option<String> {
    screen.split_once(mark)?.1.split_whitespace().next().map(str::to_owned)
}

#[test]
fn a_session_from_opening_to_finding_the_preset_again() {
    let home = tempfile::tempdir().unwrap();
    let config = home.path().join("config");
    let export = home.path().join("walk.csv");
    let env = [("XDG_CONFIG_HOME", config.to_str().unwrap()), ("HOME", home.path().to_str().unwrap())];
    let mut pty = Pty::spawn(program(), &[], &env, 100, 30);
    pty.wait_for(|screen| screen.contains("lost up to here 0 of"), "the curve and its events");

    // Steps, one and several.
    pty.keys(" ");
    pty.wait_for(|screen| screen.contains("@ 1 "), "one step");
    pty.keys("   ");
    pty.wait_for(|screen| screen.contains("@ 4 "), "three more");

    // To the first instability, and the jump from crest 8 to crest 7.
    pty.keys("n");
    pty.wait_for(
        |screen| screen.contains("Event 1 of 6: n or x lets the edge snap to crest 7"),
        "the limit point",
    );
    pty.wait_for(
        |screen| line_of(screen, "│ @ ").is_some_and(|row| row.contains("δ LIMIT")),
        "the walker at the limit",
    );
    pty.keys("x");
    pty.wait_for(|screen| screen.contains("Landed, lost 1.217e-4, stable again"), "the landing");

    // Undo and redo move a cursor over the kept states.
    pty.keys("u");
    pty.wait_for(|screen| screen.contains("Event 1 of 6"), "back at the limit point");
    pty.keys("\x12");
    pty.wait_for(|screen| screen.contains("Landed"), "landed again");

    // A knob: a value out of range is refused with the reason; a valid one changes curve and log.
    let before = line(&pty, "1 snap");
    pty.keys("\r");
    pty.wait_for(|screen| screen.contains("amplitude of the wave"), "the prompt");
    pty.keys("\x15-1\r");
    pty.wait_for(|screen| screen.contains("gap.amplitude"), "the refusal");
    pty.keys("\x150.003\r");
    pty.wait_for(|screen| screen.contains("unsaved") && screen.contains("0.003 "), "the new value");
    pty.wait_for(|screen| !screen.contains("computing") && !screen.contains(&before), "the new log");

    // Saved under a new name; the walk is exported.
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
    pty.wait_for(|screen| screen.contains("lost up to here 0 of"), "the curve");
    pty.keys("o");
    pty.wait_for(|screen| screen.contains("lab-3"), "the list");
    pty.press_until("j", |screen| word_after(screen, "> "), |screen| screen.contains("> lab-3"));
    pty.keys("\r");
    pty.wait_for(|screen| screen.contains(" lab-3  control") && screen.contains("0.003 "), "the preset");
    pty.keys("q");
    assert_eq!(pty.exit_code(), 0);
}

#[test]
fn every_view_a_closer_look_and_a_pin() {
    let mut pty = Pty::spawn(program(), &["fig-8"], &[], 80, 24);
    pty.wait_for(|screen| screen.contains("lost up to here 0 of"), "the curve");
    for (keys, title) in [
        ("t", "s/λ over δ"),
        ("t", "unloading: P/Pc"),
        ("t", "cycle: P/Pc"),
        ("t", "ΔP/Pc over"),
        ("gi", "gap/R over r/λ"),
        ("t", "p/E* over r/λ"),
        ("t", "contact, s/λ"),
        ("t", "U over s/λ"),
        ("t", "contacts over"),
        ("gm", "largest pull (P/Pc) over A"),
        ("t", "where snaps begin"),
        ("t", "limit points under"),
        ("gc", "ΔP/Pc over"),
    ] {
        pty.keys(keys);
        pty.wait_for(|screen| screen.contains(title), title);
        // The views of the state are drawn by a worker.
        pty.wait_for(|screen| !screen.contains("computing"), "its picture");
    }
    pty.keys("t");
    pty.wait_for(|screen| screen.contains("P/Pc over δ/R  (t:"), "the first view again");

    pty.keys("++");
    pty.wait_for(|screen| screen.contains("zoom 4x"), "a closer look");
    pty.keys("i");
    pty.wait_for(|screen| screen.contains("* δ/R "), "the cross-hair");
    pty.keys("\x1bf");
    pty.wait_for(|screen| !screen.contains("zoom") && !screen.contains("* δ/R "), "all of it");

    // Back to the Problem panel, where > turns the amplitude.
    pty.keys("\t\t");
    pty.keys("p");
    pty.wait_for(|screen| screen.contains("pinned as D"), "a pin");
    pty.keys("}");
    pty.wait_for(|screen| screen.contains("D A 0.001"), "the pin by what differs");
    pty.keys("P");
    pty.wait_for(|screen| screen.contains("Remove a pinned curve"), "the list of pins");
    pty.keys("\r");
    pty.wait_for(|screen| !screen.contains("D A 0.001"), "the pin taken away");
    pty.keys("y\r\x1b");
    pty.wait_for(|screen| !screen.contains("Theory"), "the overlays closed");
    pty.keys("qy");
    assert_eq!(pty.exit_code(), 0);
}

#[test]
fn quitting_with_unsaved_changes_asks_first() {
    let mut pty = Pty::spawn(program(), &["fig-8"], &[], 80, 24);
    pty.wait_for(|screen| screen.contains("lost up to here 0 of"), "the curve");
    pty.keys("}");
    pty.wait_for(|screen| screen.contains("unsaved"), "a change");
    pty.keys("q");
    pty.wait_for(|screen| screen.contains("y quits, Esc stays"), "the question");
    pty.keys("\x1b");
    pty.wait_for(|screen| !screen.contains("y quits, Esc stays"), "the screen");
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
    pty.wait_for(|screen| screen.contains("lost up to here 0 of"), "the curve");
    pty.keys("n");
    pty.wait_for(|screen| screen.contains("Event 1 of"), "a limit point of the displacement");
    select(&mut pty, "control");
    pty.keys("<");
    pty.wait_for(|screen| screen.contains("STIFFNESS=") && screen.contains("of 2E*s)"), "a stiff device");
    // The walker stays, and is now past the limit point of the softer device.
    pty.keys("{{{{{{{{{{{{");
    pty.wait_for(|screen| screen.contains("unstable under spring control"), "the flags of the walker");
    pty.keys("\r");
    pty.wait_for(|screen| screen.contains("> stiffness ..."), "the list");
    pty.keys("\r");
    pty.wait_for(|screen| screen.contains("stiffness = k"), "the prompt");
    pty.keys("\x150.31\r");
    pty.wait_for(|screen| screen.contains("STIFFNESS=0.31"), "a bare number");
    pty.keys("c");
    pty.wait_for(|screen| screen.contains("> stiffness ..."), "the same list");
    pty.keys("kk\r");
    pty.wait_for(|screen| screen.contains("control DISPLACEMENT"), "the choice");
    pty.wait_for(|screen| screen.contains("Event 1 of"), "the limit point again");
    pty.keys("cjj\r");
    pty.wait_for(|screen| screen.contains("stiffness=0.31"), "the last stiffness");
    pty.keys("\r");
    pty.wait_for(|screen| screen.contains("STIFFNESS=0.31"), "a spring again");
    pty.keys("q");
    pty.wait_for(|screen| screen.contains("y quits, Esc stays"), "the question");
    pty.keys("y");
    assert_eq!(pty.exit_code(), 0);
}

#[test]
fn a_curve_that_takes_long_can_be_given_up() {
    let mut pty = Pty::spawn(program(), &["fig-9"], &[], 100, 30);
    pty.wait_for(|screen| screen.contains("lost up to here 0 of"), "the curve");
    select(&mut pty, "N ");
    // Two thousand rings take seconds to factorize.
    pty.keys("\r");
    pty.wait_for(|screen| screen.contains("from 4 to 2000"), "the prompt");
    pty.keys("\x152000\r");
    pty.wait_for(|screen| screen.contains("computing point "), "how many points of the curve are known");
    pty.keys("\x1b");
    pty.wait_for(|screen| screen.contains("cancelled: the curve is the old one"), "given up");
    pty.wait_for(
        |screen| screen.contains("lost up to here 0 of") && screen.contains("unsaved"),
        "the curve of before",
    );
    pty.keys("u");
    pty.wait_for(|screen| !screen.contains("unsaved") && !screen.contains("computing"), "the values back");
    pty.keys("n");
    pty.wait_for(|screen| screen.contains("Event 1 of"), "the walk goes on");
    pty.keys("q");
    assert_eq!(pty.exit_code(), 0);
}

#[test]
fn a_formula_is_typed_and_its_parameters_are_knobs() {
    let mut pty = Pty::spawn(program(), &["formula"], &[], 100, 30);
    pty.wait_for(|screen| screen.contains("lost up to here 0 of"), "the curve");
    select(&mut pty, "h(r)");
    pty.wait_for(|screen| !screen.contains("computing"), "all of it");
    let waves = chart(&pty.screen());
    pty.keys("\r");
    pty.wait_for(|screen| screen.contains("the curve follows"), "the prompt");
    // Without the waves, their parameters go and the curve follows, while the prompt stays open.
    pty.keys("\x15r^2/(2*R)");
    pty.wait_for(
        |screen| {
            screen.contains("> r^2/(2*R)") && line_of(screen, "│ A ").is_none() && chart(screen) != waves
        },
        "the curve of what is typed",
    );
    // The state is solved again after the curve.
    pty.wait_for(on_curve, "the state on the curve");
    pty.keys(" + * B");
    pty.wait_for(|screen| screen.contains("column 13: expected a number"), "what is wrong, and where");
    pty.wait_for(|screen| on_curve(screen) && chart(screen) != waves, "the curve before stays");
    // Taken back as a whole.
    pty.keys("\x1b");
    pty.wait_for(
        |screen| screen.contains("lost up to here 0 of") && !screen.contains("unsaved"),
        "as it was",
    );
    pty.keys("\r");
    pty.wait_for(|screen| screen.contains("the curve follows"), "the prompt");
    pty.keys("\x15");
    pty.paste("r^2/(2*R) + A*(1 - cos(2*pi*r/lambda)) + depth*r^4");
    pty.wait_for(|screen| line_of(screen, " depth").is_some(), "a knob for the new parameter");
    pty.keys("\r");
    pty.wait_for(
        |screen| !screen.contains("the curve follows") && screen.contains("unsaved"),
        "the formula kept",
    );
    select(&mut pty, "depth");
    pty.wait_for(|screen| !screen.contains("computing"), "its curve");
    pty.keys("}");
    pty.wait_for(
        |screen| line_of(screen, ">depth").is_some_and(|line| line.contains(" 2")),
        "the knob turned",
    );
    pty.wait_for(|screen| !screen.contains("computing"), "its curve");
    pty.keys("qy");
    assert_eq!(pty.exit_code(), 0);
}

/// Whether the state is in the upper chart and nothing is being computed.
fn on_curve(screen: &str) -> bool {
    !screen.contains("computing")
        && chart(screen).iter().any(|row| row.contains('@') && !row.contains("@ here"))
}

/// The contents of the upper chart, above everything that may cover it.
fn chart(screen: &str) -> Vec<String> {
    screen.lines().skip(2).take(8).map(|line| line.chars().skip(34).collect()).collect()
}

/// The line of a screen with this text, if there is one.
fn line_of<'a>(screen: &'a str, text: &str) -> Option<&'a str> {
    screen.lines().find(|line| line.contains(text))
}

#[test]
fn a_shape_is_chosen_and_a_profile_loaded() {
    let home = tempfile::tempdir().unwrap();
    let rows = |radii: &mut dyn Iterator<Item = u32>| -> String {
        radii
            .map(f64::from)
            .map(|r| format!("{}, {}\n", r / 100.0, r * r / 20000.0))
            .collect::<Vec<_>>()
            .concat()
    };
    fs::write(home.path().join("scan.csv"), rows(&mut (0..100).rev())).unwrap();
    fs::write(home.path().join("worse.csv"), rows(&mut (0..100)) + "one, 2\n").unwrap();
    let config = home.path().join("config");
    let env = [("XDG_CONFIG_HOME", config.to_str().unwrap())];
    let mut pty = Pty::spawn(program(), &[], &env, 120, 40);
    pty.wait_for(|screen| screen.contains("lost up to here 0 of"), "the curve");
    // Two lines above the amplitude.
    pty.keys("kk");
    pty.wait_for(|screen| screen.contains(">gap"), "the shape");
    pty.keys("\r");
    pty.wait_for(|screen| screen.contains("> wavy-sphere") && screen.contains("measured rows"), "the shapes");
    pty.keys("jjjjjjj\r");
    pty.wait_for(|screen| screen.contains("shipped:rough"), "a profile");
    pty.wait_for(|screen| !screen.contains("computing"), "its curve");
    select(&mut pty, "file");
    pty.keys("\r");
    pty.wait_for(|screen| screen.contains("Profiles in"), "the files");
    // The path is at the end of the list.
    pty.keys("\x1b[F");
    pty.wait_for(|screen| screen.contains("> a path ..."), "the last line");
    pty.keys("\r");
    pty.wait_for(|screen| screen.contains("Read a profile"), "the prompt");
    // A refused value leaves the prompt open for correction.
    for (name, said) in [("worse.csv", "worse.csv: line 101"), ("scan.csv", "have been sorted")] {
        pty.keys("\x15");
        pty.paste(home.path().join(name).to_str().unwrap());
        pty.keys("\r");
        pty.wait_for(|screen| screen.contains(said), said);
    }
    pty.wait_for(|screen| !screen.contains("computing") && !screen.contains("shipped:"), "its curve");
    pty.keys("S");
    pty.wait_for(|screen| screen.contains("save with data"), "the choice");
    pty.keys("j\r");
    pty.wait_for(|screen| screen.contains("Save the preset as"), "the prompt");
    pty.keys("\x15mine\r");
    pty.wait_for(|screen| screen.contains("saved as mine"), "saved");
    assert!(config.join("pulloff/presets/scan.csv").is_file());
    pty.keys("q");
    assert_eq!(pty.exit_code(), 0);
}

/// The position of a text on the screen as a mouse report counts it, from 1.
fn place(pty: &Pty, text: &str) -> (usize, usize) {
    let screen = pty.screen();
    let found = screen.lines().enumerate().find_map(|(row, line)| Some((line.find(text)?, row, line)));
    let (at, row, line) = found.unwrap_or((0, 0, ""));
    assert!(!line.is_empty(), "no {text} in\n{screen}");
    (line[..at].chars().count() + 1, row + 1)
}

fn ready(pty: &Pty) {
    pty.wait_for(|screen| screen.contains("lost up to here 0 of"), "the curve and its events");
}

#[test]
fn the_mouse_is_taken_and_given_back_in_every_way() {
    let mut pty = Pty::spawn_in_shell(program(), &["--mouse"], &[], 100, 30);
    ready(&pty);
    pty.wait_until(|pty| pty.modes_left().contains(&1000), "the mouse taken");
    // Invalid coordinates, in both notations, and distant ones.
    for report in ["\x1b[<0;0;0M", "\x1b[M   ", "\x1b[<0;65535;65535M", "\x1b[<64;0;9M"] {
        pty.keys(report);
    }
    let (column, row) = place(&pty, "@ 0 ");
    pty.keys(&format!("\x1b[<0;{column};{row}M\x1b[<0;{column};{row}m"));
    pty.keys("\x1b ");
    pty.wait_for(|screen| screen.contains("@ 1 "), "a step after all that");
    let (column, row) = place(&pty, "·2 snap");
    pty.keys(&format!("\x1b[<0;{column};{row}M"));
    pty.wait_for(|screen| screen.contains(">·2 snap"), "the event selected");
    // At run time.
    pty.keys("m");
    pty.wait_until(|pty| !pty.modes_left().contains(&1000), "the mouse left");
    pty.keys("m");
    pty.wait_until(|pty| pty.modes_left().contains(&1000), "the mouse taken again");
    // Stopped and continued.
    pty.keys("\x1a");
    pty.wait_for(|screen| screen.contains("[stopped]"), "stopped");
    assert_eq!(pty.modes_left(), [] as [u16; 0]);
    pty.keys("\n");
    pty.wait_until(|pty| pty.modes_left().contains(&1000), "the mouse taken after the stop");
    pty.keys("q");
    pty.wait_for(|screen| screen.contains("[ended 0]"), "the end");
    assert_eq!(pty.modes_left(), [] as [u16; 0]);
    pty.keys("\n");
    pty.exit_code();

    let mut pty = Pty::spawn(program(), &["--mouse"], &[], 100, 30);
    pty.wait_until(|pty| pty.modes_left().contains(&1000), "the mouse taken");
    pty.signal(rustix::process::Signal::TERM);
    assert_eq!(pty.exit_code(), 143);
    pty.assert_restored();
}

#[test]
fn no_color_means_none_unless_a_theme_is_asked_for() {
    // The colour of the frames and axes, in both palettes.
    let colour = b"38;5;24";
    for (args, env, coloured) in [
        ([].as_slice(), [("NO_COLOR", "1")], false),
        (&["--theme", "mono"], [("NO_COLOR", "")], false),
        (&["--theme", "light"], [("NO_COLOR", "1")], true),
        (&[], [("NO_COLOR", "")], true),
        (&[], [("TERM", "vt220")], false),
    ] {
        let mut pty = Pty::spawn(program(), args, &env, 80, 24);
        ready(&pty);
        assert_eq!(pty.wrote(colour), coloured, "{args:?} {env:?}");
        pty.keys("q");
        pty.exit_code();
    }
}

#[test]
fn terminals_without_unicode_get_ascii_and_the_console_blocks() {
    for (args, env, ascii, blocks) in [
        ([].as_slice(), ("LANG", "C"), true, false),
        (&[], ("TERM", "vt100"), true, false),
        (&["--ascii"], ("TERM", "xterm"), true, false),
        (&[], ("TERM", "linux"), false, true),
        (&["--charts", "block"], ("TERM", "xterm"), false, true),
        (&["--ascii=false"], ("LANG", "C"), false, false),
    ] {
        let mut pty = Pty::spawn(program(), args, &[env], 100, 30);
        ready(&pty);
        let screen = pty.screen();
        assert_eq!(screen.is_ascii(), ascii, "{args:?} {env:?}\n{screen}");
        assert_eq!(screen.contains('▀') || screen.contains('▄'), blocks, "{args:?} {env:?}\n{screen}");
        pty.keys("q");
        pty.exit_code();
    }
}

#[test]
fn what_is_copied_goes_through_the_terminal() {
    let mut pty = Pty::spawn(program(), &[], &[], 100, 30);
    ready(&pty);
    pty.keys("Y\r");
    pty.wait_for(|screen| screen.contains("sent to the terminal's clipboard"), "copied");
    // "wavy-sphere" begins the text.
    assert!(pty.wrote(b"\x1b]52;c;d2F2eS1zcGhlcm"));
    pty.keys("q");
    pty.exit_code();
    pty.assert_restored();
}

#[test]
fn the_header_warns_of_a_path_as_its_command_does() {
    let home = Home::new();
    let set = "path.start_contact_radius=1.2";
    let told = home.run(&["unload", "wavy-sphere", "--set", set]).err;
    let session = Session::with("wavy-sphere", &[set]);
    let warnings = session.model.warnings();
    assert!(
        warnings.iter().any(|warning| warning.contains("beyond the radius of curvature")),
        "{warnings:?}"
    );
    for warning in &warnings {
        assert!(told.contains(warning), "{warning}\n{told}");
    }
    assert_eq!(told.matches("warning: ").count(), warnings.len(), "{told}");
}
