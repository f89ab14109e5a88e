//! The program in a pseudo-terminal: whatever ends it, the terminal is restored.

use std::{
    fs,
    path::PathBuf,
    process::{Command, Stdio},
    time::Instant,
};

use crate::support::pty::Pty;
use rustix::process::Signal;

/// The program under test.
fn program() -> PathBuf {
    PathBuf::from(env!("CARGO_BIN_EXE_pulloff"))
}

fn start(cols: u16, rows: u16) -> Pty {
    let pty = Pty::spawn(&program(), &[], &[], cols, rows);
    wait_until_up(&pty);
    pty
}

fn wait_until_up(pty: &Pty) {
    pty.wait_for(|screen| screen.contains("stable under displacement control"), "the curve");
}

/// Whether the knob with this label is selected.
fn selects(screen: &str, label: &str) -> bool {
    screen.contains(&format!(">{label}"))
}

#[test]
fn quitting_gives_the_terminal_back() {
    let mut pty = start(80, 24);
    assert_eq!(pty.modes_left(), [25, 1049, 2004]);
    pty.keys("q");
    assert_eq!(pty.exit_code(), 0);
    pty.assert_restored();
}

#[test]
fn signals_end_the_program_and_give_the_terminal_back() {
    for (signal, code) in [(Signal::TERM, 143), (Signal::HUP, 129), (Signal::INT, 130), (Signal::QUIT, 131)] {
        let mut pty = start(80, 24);
        pty.signal(signal);
        assert_eq!(pty.exit_code(), code);
        pty.assert_restored();
    }
}

#[test]
fn a_terminal_that_nobody_reads_does_not_hold_up_the_end() {
    let mut pty = start(300, 100);
    pty.stop_reading();
    // Sends whole frames until the terminal accepts no more and the drawing thread waits for room.
    let waits_in = format!("/proc/{}/wchan", pty.pid().as_raw_nonzero());
    let start = Instant::now();
    while !fs::read_to_string(&waits_in).is_ok_and(|place| place.contains("poll")) {
        assert!(start.elapsed() < crate::support::pty::LIMIT, "the program does not wait for the terminal");
        for cols in [299, 300] {
            pty.resize(cols, 100);
        }
    }
    pty.signal(Signal::TERM);
    assert_eq!(pty.exit_code(), 143);
    pty.go_on_reading();
    pty.wait_until(|pty| pty.modes_left().is_empty(), "the modes to be undone");
}

#[test]
fn keys_and_pastes_arrive_and_a_paste_is_never_a_command() {
    let mut pty = start(80, 24);
    pty.keys("l");
    pty.wait_for(|screen| selects(screen, "λ"), "the next knob");
    pty.keys("\x1b[D");
    pty.wait_for(|screen| selects(screen, "A"), "the knob before");
    // Outside a prompt a paste does nothing; inside one it is text up to its first line end.
    pty.paste("q\rq\x1b[31m");
    pty.keys("\r");
    pty.wait_for(|screen| screen.contains("amplitude of the wave"), "the prompt");
    pty.paste("9\rq");
    pty.wait_for(|screen| screen.contains("> 9 "), "the paste, as text");
    pty.keys("\x1bq");
    assert_eq!(pty.exit_code(), 0);
}

#[test]
fn no_key_waits_for_the_next_one() {
    let mut pty = start(80, 24);
    // More than the reader takes at once, without the marks of a paste.
    pty.keys(&"lh".repeat(1500));
    pty.keys("l");
    pty.wait_for(|screen| selects(screen, "λ"), "the last key");
    for round in 2..20 {
        // Together with a resize, which the reader receives in the same wait.
        pty.resize(80 + round, 24);
        let (key, label) = if round % 2 == 0 { ("h", "A") } else { ("l", "λ") };
        pty.keys(key);
        pty.wait_for(|screen| selects(screen, label), "the key");
    }
    pty.keys("q");
    assert_eq!(pty.exit_code(), 0);
}

#[test]
fn a_lost_terminal_ends_the_program() {
    for spawn in [Pty::spawn, Pty::spawn_ignoring_hup] {
        let mut pty = spawn(&program(), &[], &[], 80, 24);
        wait_until_up(&pty);
        pty.close_terminal();
        assert_eq!(pty.exit_code(), 129);
    }
}

#[test]
fn any_size_is_survived_and_the_next_one_drawn() {
    let mut pty = start(80, 24);
    for (cols, rows) in [(1, 1), (0, 0), (0, 5), (300, 1), (1, 100), (2, 2)] {
        pty.resize(cols, rows);
        pty.keys("t");
    }
    // Back to the initial views, however many there are.
    pty.keys(":view force-approach\r");
    pty.resize(30, 8);
    pty.wait_for(|screen| screen.contains("pulloff needs 40x10"), "the notice");
    pty.resize(160, 45);
    let both = |screen: &str| screen.contains("P/Pc over δ") && screen.contains("P/Pc over s/λ");
    pty.wait_for(both, "both charts at the new size");
    pty.keys("q");
    assert_eq!(pty.exit_code(), 0);
    pty.assert_restored();
}

#[test]
fn ctrl_z_hands_the_terminal_to_the_shell_and_fg_takes_it_again() {
    let mut pty = Pty::spawn_in_shell(&program(), &[], &[], 80, 24);
    wait_until_up(&pty);
    for round in 1..=2 {
        let ours = pty.line_modes();
        pty.keys("\x1a");
        // Counted in the bytes, because the shell's screen still shows the previous time.
        let stops = |pty: &Pty| String::from_utf8_lossy(&pty.raw()).matches("[stopped]").count();
        pty.wait_until(|pty| stops(pty) == usize::from(round), "the shell");
        pty.assert_restored();
        pty.resize(90 + round, 24);
        pty.keys("\r");
        pty.wait_for(|screen| screen.contains("Log") && screen.contains("quit"), "all of it");
        assert_eq!(pty.line_modes(), ours);
        assert_eq!(pty.modes_left(), [25, 1049, 2004]);
        let (key, label) = if round == 1 { ("l", "λ") } else { ("h", "A") };
        pty.keys(key);
        pty.wait_for(|screen| selects(screen, label), "an answer to a key");
    }
    pty.keys("q");
    pty.wait_for(|screen| screen.contains("[ended 0]"), "the end");
    pty.assert_restored();
    pty.keys("\r");
    assert_eq!(pty.exit_code(), 0);
}

#[test]
fn without_a_shell_ctrl_z_does_nothing() {
    let mut pty = start(80, 24);
    pty.keys("\x1al");
    pty.wait_for(|screen| selects(screen, "λ"), "an answer to the next key");
    pty.keys("q");
    assert_eq!(pty.exit_code(), 0);
}

#[test]
fn nothing_is_written_while_nothing_changes() {
    let mut pty = start(80, 24);
    pty.keys("lh");
    pty.wait_for(|screen| selects(screen, "A"), "a round trip");
    pty.keys("{");
    pty.wait_for(|screen| screen.contains("unsaved"), "a change");
    pty.keys("u");
    pty.wait_for(|screen| !screen.contains("unsaved"), "the change undone");
    let before = pty.raw().len();
    // Back where it was, because only the differences between two frames are sent.
    pty.keys("lh");
    pty.keys("t");
    pty.wait_for(|screen| screen.contains("s/λ over δ/R  (t:"), "the next view");
    let bytes = pty.raw().len() - before;
    assert!(bytes < 8000, "{bytes} bytes");
    pty.keys("q");
    assert_eq!(pty.exit_code(), 0);
}

#[test]
fn without_a_terminal_it_says_so_in_one_line() {
    let output = Command::new(program()).stdin(Stdio::null()).output().expect("it runs");
    assert_eq!(output.status.code(), Some(2));
    assert_eq!(output.stdout, b"");
    let error = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(error.starts_with("pulloff: needs a terminal: standard input is not one"), "{error}");
    assert_eq!(error.lines().count(), 1);
}

#[test]
fn on_a_terminal_that_cannot_draw_it_says_so_in_one_line() {
    for term in ["", "dumb", "unknown", "nonesuch-9"] {
        let mut pty = Pty::spawn(&program(), &[], &[("TERM", term)], 160, 24);
        assert_eq!(pty.exit_code(), 2);
        assert!(pty.screen().starts_with("pulloff: needs a terminal: TERM is "), "{}", pty.screen());
        assert!(!pty.raw().contains(&0x1b));
        pty.assert_restored();
    }
}

/// Sequences that a terminal would obey: a title, the clipboard, a query, an 8-bit introducer, a device control, a text
/// direction.
const HOSTILE: [&str; 6] = [
    "\x1b]0;EVIL\x07",
    "\x1b]52;c;RVZJTA==\x07",
    "\x1b[6n\x05",
    "\u{9b}31mEVIL",
    "\x1bP+q544e\x1b\\",
    "\u{202e}EVIL",
];

#[test]
fn no_text_of_a_file_reaches_the_terminal_as_a_control() {
    let home = tempfile::tempdir().expect("a home");
    let presets = home.path().join("pulloff/presets");
    let folder = home.path().join("data");
    fs::create_dir_all(&presets).expect("a folder");
    fs::create_dir_all(&folder).expect("a folder");
    let row = |i: i32| format!("{},{}", f64::from(i) / 4.0, f64::from(i * i) / 32.0);
    let rows = (0..13).map(row).collect::<Vec<_>>().join("\n") + "\n";
    for (number, sequence) in HOSTILE.iter().enumerate() {
        fs::write(presets.join(format!("bad{number}.toml")), format!("{sequence} = {sequence}"))
            .expect("a file");
        fs::write(presets.join(format!("{sequence}{number}.toml")), "title").expect("a file");
        fs::write(home.path().join(format!("data{sequence}.csv")), format!("{rows}{sequence}\n"))
            .expect("a file");
        fs::create_dir(home.path().join(format!("folder{sequence}"))).expect("a folder");
    }
    fs::write(folder.join("good.csv"), rows).expect("a file");
    let own = folder.join("own.toml");
    let text = "[material]\neffective_modulus = 10\nwork_of_adhesion = 0.01\n[gap]\nshape = \"profile\"\n\
                file = \"good.csv\"\n[path]\nstart_contact_radius = 1\nend_contact_radius = 0.1\n";
    fs::write(&own, text).expect("a preset");
    let env = [("XDG_CONFIG_HOME", home.path().to_str().expect("Unicode"))];
    let mut pty = Pty::spawn(&program(), &[own.to_str().expect("Unicode")], &env, 200, 60);
    pty.wait_for(|screen| screen.contains("stable under displacement control"), "the curve");
    // The presets, with the reasons why some cannot be read, and an attempt to open each of those.
    let shipped = fs::read_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/presets"))
        .expect("the shipped presets")
        .filter(|entry| {
            entry.as_ref().is_ok_and(|file| file.path().extension().is_some_and(|end| end == "toml"))
        })
        .count();
    for down in shipped..shipped + 2 * HOSTILE.len() {
        pty.keys("o");
        pty.wait_for(|screen| screen.contains("Open a preset") && screen.contains("EVIL"), "the presets");
        pty.keys(&"j".repeat(down));
        pty.keys("\r");
        pty.wait_for(|screen| !screen.contains("Open a preset"), "the refusal");
    }
    let label = |screen: &str| screen.split_once("│>")?.1.split_whitespace().next().map(str::to_owned);
    pty.press_until("j", label, |screen| selects(screen, "file"));
    // The files beside the data; those with hostile names are not offered.
    pty.keys("\r");
    pty.wait_for(|screen| screen.contains("Profiles in") && screen.contains("good.csv"), "the folder");
    pty.keys("\x03\x03");
    assert_eq!(pty.exit_code(), 0);
    for sequence in HOSTILE {
        assert!(!pty.wrote(sequence.as_bytes()), "{sequence:?} reached the terminal");
    }
}

#[test]
fn keys_come_from_the_settings_and_bad_settings_are_said_and_left_alone() {
    let home = tempfile::tempdir().expect("a home");
    let (folder, file) = (home.path().join("pulloff"), home.path().join("pulloff/config.toml"));
    fs::create_dir(&folder).expect("a folder");
    let env = [("XDG_CONFIG_HOME", home.path().to_str().expect("a path"))];
    fs::write(&file, "[keys]\nquit = \"Z\"\n").expect("a file");
    let mut pty = Pty::spawn(&program(), &[], &env, 80, 24);
    pty.wait_for(|screen| screen.contains("Z quit"), "the person's key in the footer");
    pty.keys("Z");
    assert_eq!(pty.exit_code(), 0);
    // A conflict: the usual keys apply, with a message on the screen and before it; the file is unchanged.
    let bad = "[keys]\nstep = \"x\"\n";
    fs::write(&file, bad).expect("a file");
    let mut pty = Pty::spawn(&program(), &[], &env, 160, 24);
    pty.wait_for(
        |screen| screen.contains("the settings are not used") && screen.contains("q quit"),
        "the notice",
    );
    pty.keys("q");
    assert_eq!(pty.exit_code(), 0);
    assert!(String::from_utf8_lossy(&pty.raw()).contains("pulloff: the settings are not used: "));
    assert_eq!(fs::read_to_string(&file).expect("the file"), bad);
    // A file requested explicitly must be valid.
    for (path, said) in [
        (file.as_path(), "config.toml:2: x would be the key for both step and jump"),
        (&folder.join("none.toml"), "none.toml: cannot read: No such file"),
    ] {
        let mut pty = Pty::spawn(&program(), &["--config", path.to_str().expect("a path")], &env, 160, 24);
        assert_eq!(pty.exit_code(), 2);
        assert!(pty.screen().contains(said), "{}", pty.screen());
        pty.assert_restored();
    }
}
