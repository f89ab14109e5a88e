//! A panic in any thread ends the program in an orderly way. Needs a build that panics on demand (`fault-injection`).

use std::{
    fs,
    path::{Path, PathBuf},
};

use crate::support::pty::Pty;

fn program() -> PathBuf {
    PathBuf::from(env!("CARGO_BIN_EXE_pulloff"))
}

/// The program, about to panic in the thread named; its state folder is `state`.
fn start(place: &str, state: &Path) -> Pty {
    let state = state.to_str().expect("a path in Unicode");
    Pty::spawn(&program(), &[], &[("PULLOFF_PANIC", place), ("XDG_STATE_HOME", state)], 200, 24)
}

/// Makes the program do what lets it panic.
fn provoke(pty: &mut Pty, place: &str) {
    // The worker panics over the first curve, so the screen never gets one.
    if place == "worker" {
        return;
    }
    pty.wait_for(|screen| screen.contains("stable under displacement control"), "the curve");
    if place == "signal" { pty.resize(199, 24) } else { pty.keys("j") }
}

fn only_file(folder: &Path) -> PathBuf {
    let mut files: Vec<_> =
        fs::read_dir(folder).expect("a folder").map(|e| e.expect("a file").path()).collect();
    assert_eq!(files.len(), 1, "{files:?}");
    files.remove(0)
}

#[test]
fn a_panic_in_any_thread_gives_the_terminal_back_and_leaves_a_report() {
    for (place, thread) in [("ui", "main"), ("worker", "curve"), ("input", "input"), ("signal", "signals")] {
        let state = tempfile::tempdir().expect("a folder");
        let mut pty = start(place, state.path());
        provoke(&mut pty, place);
        assert_eq!(pty.exit_code(), 101, "{place}");
        pty.assert_restored();
        let report = only_file(&state.path().join("pulloff/reports"));
        let screen = pty.screen();
        for part in [
            &format!("(thread {thread})"),
            "panicked at",
            "Please report it",
            report.to_str().expect("Unicode"),
        ] {
            assert!(screen.contains(part), "{place}: no {part} in\n{screen}");
        }
        // A parser that keeps both screens could show what was written to the other one.
        let raw = String::from_utf8_lossy(&pty.raw()).into_owned();
        assert!(
            raw.rfind("\x1b[?1049l") < raw.find("panicked at"),
            "{place}: the message is on the wrong screen"
        );
        let text = fs::read_to_string(&report).expect("a report");
        assert!(
            text.contains(&format!("PULLOFF_PANIC={place}")) && text.contains("command line: "),
            "{text}"
        );
    }
}

#[test]
fn without_a_state_folder_the_message_is_all() {
    let mut pty = start("worker", Path::new("/proc/nowhere"));
    assert_eq!(pty.exit_code(), 101);
    pty.assert_restored();
    let screen = pty.screen();
    assert!(
        screen.contains("panicked at") && screen.contains("No report could be written: /proc/nowhere"),
        "{screen}"
    );
}

#[test]
fn a_terminal_that_nobody_reads_does_not_hold_up_a_panic() {
    let state = tempfile::tempdir().expect("a folder");
    let mut pty = start("ui", state.path());
    pty.wait_for(|screen| screen.contains("stable under displacement control"), "the curve");
    pty.stop_reading();
    pty.keys("j");
    assert_eq!(pty.exit_code(), 101);
    pty.go_on_reading();
    pty.wait_until(|pty| pty.modes_left().is_empty(), "the modes to be undone");
    only_file(&state.path().join("pulloff/reports"));
}

#[test]
fn another_name_is_no_fault() {
    let state = tempfile::tempdir().expect("a folder");
    let mut pty = start("nothing", state.path());
    provoke(&mut pty, "ui");
    pty.keys("q");
    assert_eq!(pty.exit_code(), 0);
    assert!(!state.path().join("pulloff").exists());
}
