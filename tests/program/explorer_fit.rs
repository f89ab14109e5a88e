//! A fit in the background of a real screen: its progress, and its best values so far when it is stopped.

use crate::support::pty::Pty;
use std::fmt::Write;
use std::fs;
use std::path::Path;

/// The shipped curve with this many rows in place of each, so that a fit takes long enough to be seen and stopped.
const TIMES: u32 = 150;

#[test]
fn a_fit_tells_its_progress_and_escape_takes_the_best_so_far() {
    let folder = tempfile::tempdir().unwrap();
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let curve = fs::read_to_string(root.join("presets/data/lens.csv")).unwrap();
    let (head, rows): (Vec<&str>, Vec<&str>) =
        curve.lines().partition(|line| line.starts_with('#') || line.starts_with("position"));
    let mut text = head.join("\n");
    for row in &rows {
        let [x, force, branch] = row.split(", ").collect::<Vec<_>>()[..] else { panic!("{row}") };
        let [x, force]: [f64; 2] = [x, force].map(|cell| cell.parse().unwrap());
        for copy in 0..TIMES {
            // No row copies another, because copies are dropped; all lie within the noise.
            let shift = f64::from(copy * 89 % TIMES) / f64::from(TIMES) - 0.5;
            write!(text, "\n{}, {}, {branch}", x + 0.01 * shift, force + shift).unwrap();
        }
    }
    fs::write(folder.path().join("long.csv"), text + "\n").unwrap();
    let preset = fs::read_to_string(root.join("presets/lens.toml")).unwrap();
    let preset = preset.replace("shipped:lens.csv", "long.csv");
    let path = folder.path().join("long.toml");
    fs::write(&path, preset).unwrap();
    let program = Path::new(env!("CARGO_BIN_EXE_pulloff"));
    let mut pty = Pty::spawn(program, &[path.to_str().unwrap()], &[], 120, 36);
    pty.wait_for(|screen| screen.contains("Log"), "the curve");
    pty.keys("F");
    let progress = |screen: &str| {
        let percent = screen.split_once("fitting, ")?.1.split_once(" %")?.0;
        percent.parse::<u32>().ok()
    };
    pty.wait_for(|screen| progress(screen).is_some_and(|percent| percent > 0), "progress of the fit");
    pty.keys("\x1b");
    pty.wait_for(|screen| screen.contains("stopped, the best so far: χ²"), "the best so far");
    assert!(progress(&pty.screen()).is_none(), "{}", pty.screen());
    // Its best values are set as one command.
    pty.wait_for(|screen| screen.contains("unsaved"), "other values");
    pty.keys("u");
    pty.wait_for(|screen| !screen.contains("unsaved"), "the values of before");
    pty.keys("q");
    assert_eq!(pty.exit_code(), 0);
}
