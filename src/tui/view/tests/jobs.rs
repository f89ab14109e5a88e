//! What a person wants to do, from a fresh start, with keys that the screen has offered. The keys are counted so that
//! their number does not grow. A typed name or number counts as one.

use super::Screen;
use crate::explorer::ScreenPanel;
use crossterm::event::{KeyCode, KeyEvent, KeyModifiers};

/// The size of the screens; no other size offers more.
const SIZE: (u16, u16) = (160, 45);
/// No job takes more keys than this,
const MOST: usize = 12;
/// and on average a job takes no more than this.
const AVERAGE: usize = 6;

/// A job, its keys or typed words, and what the screen says then.
type Job = (&'static str, &'static [&'static str], &'static [&'static str]);

/// `FOLDER` stands for a folder of the test, in which `own.csv` is a walk.
const JOBS: &[Job] = &[
    ("the largest pull over the amplitude", &["g", "m"], &["largest pull (P/Pc) over A", "now"]),
    ("two snaps by hand with their losses", &["n", "n", "n", "n"], &["✓1", "✓2", "1.217e-4", "1.149e-4"]),
    (
        "A 0.002 against 0.003 by eye and number",
        &["Enter", "0.002", "Enter", "p", "Enter", "0.003", "Enter"],
        &["D A 0.002", "pin D", "snaps"],
    ),
    (
        "a spring of a stiffness",
        &["Down", "Down", "Down", "Enter", "stiffness", "Enter", "0.31", "Enter"],
        &["STIFFNESS=0.31"],
    ),
    ("rings on approach at weak adhesion", &["o", "fig-9-weak", "Enter", "n", "n"], &["Landed"]),
    ("where snaps begin", &["g", "m", "t"], &["where snaps begin"]),
    (
        "own data laid over and fitted",
        &[":", "data FOLDER/own.csv", "Enter", "Up", "Up", "Up", "*", "F"],
        &["fitted: χ²"],
    ),
    (
        "a formula of one's own with letters",
        &["o", "formula", "Enter", "Down", "Down", "Down", "Enter", "r^2/(2*R) + B*r^4", "Enter"],
        &["unsaved", " B "],
    ),
    ("saved under a name", &["s", "mine", "Enter"], &["saved as mine"]),
    ("a figure for a paper", &["e", "figure", "Enter", "FOLDER/fig.svg", "Enter"], &["exported to"]),
    (
        "a script to be replayed",
        &["n", "n", "e", "script", "Enter", "FOLDER/a.pulloff", "Enter"],
        &["exported to"],
    ),
    ("everything undone", &["n", "n", ">", ">", "u", "u", "u"], &["Here, step 0", "Start, stable"]),
];

/// Whether the screen offers a key: in the footer, in the header or in the status line; in a list or a prompt, also the
/// usual keys there.
fn is_offered(screen: &Screen, stroke: &str) -> bool {
    let text = screen.text(SIZE.0, SIZE.1);
    let lines: Vec<&str> = text.lines().collect();
    if screen.app.overlay.is_some() && !matches!(stroke, "g" | "n" | "t") {
        return true;
    }
    let says = |line: &str| line.split([' ', '(', ',', ':', ';']).any(|word| word == stroke);
    // A title with a number of lines means that there are lines to move through.
    let goes_through = matches!(stroke, "Up" | "Down") && screen.app.model.panel == ScreenPanel::Problem;
    let footer = lines.last().unwrap();
    // `:` separates words, but here it is one.
    goes_through && text.contains("Problem ")
        || [lines[0], lines[lines.len() - 2], *footer].iter().any(|line| says(line))
        || footer.contains(&format!(" {stroke} "))
}

fn do_job(screen: &mut Screen, (job, strokes, said): &Job) {
    for stroke in *strokes {
        let stroke = stroke.replace("FOLDER", screen.folder.path().to_str().unwrap());
        assert!(
            is_offered(screen, &stroke),
            "{job}: {stroke} is not offered\n{}",
            screen.text(SIZE.0, SIZE.1)
        );
        match &*stroke {
            "Enter" => screen.press(KeyCode::Enter),
            "Up" => screen.press(KeyCode::Up),
            "Down" => screen.press(KeyCode::Down),
            one if one.chars().count() == 1 => {
                screen.keys(one);
            }
            typed => {
                assert!(screen.app.overlay.is_some(), "{job}: nothing asks for {typed}");
                // The present text is removed first.
                let clear = KeyEvent::new(KeyCode::Char('u'), KeyModifiers::CONTROL);
                let effects = screen.app.key(clear);
                screen.settle(effects);
                screen.keys(typed);
            }
        }
    }
    let text = screen.text(SIZE.0, SIZE.1);
    for words in *said {
        assert!(text.contains(words), "{job}: {words} is missing\n{text}");
    }
}

#[test]
fn jobs_take_few_keys_that_the_screen_offers() {
    let mut all = 0;
    for job in JOBS {
        let mut screen = Screen::new("wavy-sphere");
        let own = screen.folder.path().join("own.csv");
        if job.1.iter().any(|stroke| stroke.contains("own.csv")) {
            let mut other = Screen::new("wavy-sphere");
            other.keys(&"n".repeat(12)).keys(&format!(":export walk {}\r", own.display()));
        }
        do_job(&mut screen, job);
        let keys = job.1.len();
        assert!(keys <= MOST, "{}: {keys} keys", job.0);
        all += keys;
    }
    assert!(all <= AVERAGE * JOBS.len(), "{all} keys for {} jobs", JOBS.len());
}

#[test]
fn questions_of_a_longer_way_have_their_answers() {
    for (keys, said) in [
        // Which of two values is nearer to theory at the third snap.
        ("\r0.003\rp\r0.004\r3T", &["at @, equal s: D ", ", JKR 1971 "][..]),
        // A spring that makes the second snap vanish.
        ("cjj\r\rjjj:study snaps\rilllllllllll", &["snaps over k", "k ", ": snaps "]),
        // The contact at the worst state.
        ("Lgi", &["contact, s/λ", "A -1.480 Pc", "/Pc -1.480"]),
        // What was done between the second and the third jump.
        ("nxnx>>nxgd", &["jumps 3", "A 0.0027", "limit", "crest lost"]),
    ] {
        let mut screen = Screen::new("wavy-sphere");
        screen.text(300, 70);
        screen.keys(keys);
        let text = screen.text(300, 70);
        for words in said {
            assert!(text.contains(words), "{keys}: {words} is missing\n{text}");
        }
    }
}
