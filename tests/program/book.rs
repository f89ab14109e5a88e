//! Runs the blocks of README and book as they are: commands in a shell; presets, specs, settings and scripts through
//! their readers. The tests of the Python package run those of `docs/src/python.md`.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a helper of a test fails the test by panicking")]

use crate::fit_rates::{SOFT, SPEEDS, pulled};
use crate::support::home::{Ended, Home};
use pulloff_engine::preset::{self, Files, read, read_in};
use pulloff_engine::sweep::Spec;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::rc::Rc;

/// Commands that need something a test does not have, and commands with tests of their own.
const LEFT_OUT: [&str; 8] = [
    // The compiler and other installers.
    "cargo ",
    "pip ",
    "scripts/release.sh",
    // A terminal: the tests of the explorer have one.
    "pulloff --resume",
    "pulloff wavy-sphere\n",
    // A test of its own looks at what it writes: half a minute.
    "pulloff figures",
    // These compute nothing.
    "pulloff sessions",
    "NAME",
];

/// A spec with few rows, for the book's `SPEC.toml`.
const SPEC: &str = "preset = 'fig-9'\nquantities = ['snaps']\n[[axis]]\nkey = 'gap.amplitude'\n\
                    linear = { from = 1e-3, to = 2e-3, count = 4 }\n";

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// README and the chapters.
fn pages() -> Vec<PathBuf> {
    let chapters = fs::read_dir(root().join("docs/src")).unwrap().map(|entry| entry.unwrap().path());
    let mut pages: Vec<PathBuf> =
        chapters.filter(|path| path.extension().is_some_and(|ending| ending == "md")).collect();
    pages.push(root().join("README.md"));
    pages.sort();
    pages
}

/// The blocks of a language on a page.
fn blocks(page: &Path, language: &str) -> Vec<String> {
    let text = fs::read_to_string(page).unwrap();
    let fence = format!("\n```{language}\n");
    text.split(&fence).skip(1).map(|rest| rest.split_once("\n```").unwrap().0.to_owned() + "\n").collect()
}

/// A folder with everything that a page and one of its blocks assume.
fn folder(page: &str, block: &str) -> Home {
    let home = Home::new();
    home.file("SPEC.toml", SPEC);
    let cluster = fs::read_to_string(root().join("examples/cluster/sweep.toml")).unwrap();
    home.file("examples/cluster/sweep.toml", &cluster.replace("count = 40", "count = 4"));
    if page == "figures.md" {
        let Ended { status, err, .. } =
            home.run(&["sweep", "examples/cluster/sweep.toml", "-o", "results.csv"]);
        assert_eq!(status, 0, "{err}");
    }
    if ["fitting.md", "pulls.md"].contains(&page) {
        let lens = fs::read_to_string(root().join("presets/lens.toml")).unwrap();
        home.file("mine.toml", &lens.replace("shipped:lens.csv", "curve.csv"));
        home.file("curve.csv", &fs::read_to_string(root().join("presets/data/lens.csv")).unwrap());
    }
    if block.contains("slow.csv") {
        home.file("soft.toml", SOFT);
        for (rate, file) in SPEEDS {
            pulled(&home, "soft.toml", rate, file);
        }
    }
    home
}

/// The commands of a block, which share one folder; a command may span several lines.
fn commands(block: &str, home: Home) -> Vec<(Rc<Home>, String)> {
    let (joined, home) = (block.replace("\\\n", " "), Rc::new(home));
    let all = joined.lines().map(|line| (Rc::clone(&home), format!("{line}\n")));
    all.filter(|(_, command)| !LEFT_OUT.iter().any(|left| command.contains(left))).collect()
}

#[test]
fn every_command_of_the_book_does_what_it_says() {
    let program = Path::new(env!("CARGO_BIN_EXE_pulloff")).parent().unwrap();
    let mut count = 0;
    for page in pages() {
        let name = page.file_name().unwrap().to_str().unwrap();
        let all = blocks(&page, "sh").into_iter().map(|block| (folder(name, &block), block));
        for (home, command) in all.flat_map(|(home, block)| commands(&block, home)) {
            count += 1;
            let path = format!("{}:/usr/bin:/bin", program.display());
            let mut shell = Command::new("sh");
            shell.args(["-c", &command]).current_dir(home.folder()).stdin(Stdio::null());
            shell.env_clear().env("PATH", path).env("HOME", home.folder());
            let done = shell.env("XDG_CONFIG_HOME", home.path("config")).output().unwrap();
            let said = String::from_utf8_lossy(&done.stderr);
            assert!(done.status.success(), "{name}: {command}{said}");
            // A table of residuals is not a measured curve, and the next command is given every .csv file.
            let _ = fs::remove_file(home.path("residuals.csv"));
        }
    }
    assert!(count > 40, "{count}");
}

/// How the bytes of a measured curve are obtained.
type Points = fn(Option<&Path>, &str) -> Result<Vec<u8>, String>;

/// Completes a part of a preset to a whole problem, depending on what the part gives.
fn around(part: &str) -> String {
    const MATERIAL: &str = "[material]\neffective_modulus = 1.0\nwork_of_adhesion = 0.004\n";
    const SPHERE: &str = "[gap]\nshape = \"sphere\"\nradius_of_curvature = 1.0\n";
    const WAVES: &str = "[gap]\nshape = \"harmonics\"\nradius_of_curvature = 1.0\n";
    const SI: &str = "units = \"SI\"\n[material]\neffective_modulus = \"1 MPa\"\nwork_of_adhesion = \"50 mJ/m^2\"\n\
                      [gap]\nshape = \"sphere\"\nradius_of_curvature = \"1 mm\"\n\
                      [path]\ncontrol = { stiffness = \"500 N/m\" }\n";
    const DATA: &str = "[data]\nfile = \"curve.csv\"\nfree = \"E*\"\n";
    match part {
        _ if part.contains("[material]") && part.contains("[gap]") => part.to_owned(),
        _ if part.contains("surface_tension") => {
            format!("units = \"SI\"\n{part}\n[gap]\nshape = \"sphere\"\nradius_of_curvature = \"1 um\"\n")
        }
        _ if part.contains("[material]") => format!("{part}\n{SPHERE}"),
        _ if part.contains("[[gap.waves]]") => format!("{MATERIAL}{WAVES}{part}"),
        _ if part.contains("[gap]") => format!("{MATERIAL}{part}"),
        _ if part.contains("[data]") => format!("{SI}{part}"),
        _ if part.contains("[data.uncertain]") => format!("{SI}{DATA}{part}"),
        _ => format!("{MATERIAL}{SPHERE}{part}"),
    }
}

#[test]
fn every_file_of_the_book_is_read() {
    let mut count = 0;
    let points: Points = |_, _| Ok(fs::read(root().join("presets/data/lens.csv")).unwrap());
    for page in pages() {
        for block in blocks(&page, "toml") {
            count += 1;
            let wrong = |error: String| -> ! { panic!("{}: {error}\n{block}", page.display()) };
            if block.contains("[dependencies]") {
                block.parse::<toml::Table>().unwrap_or_else(|error| wrong(error.to_string()));
            } else if block.contains("preset = ") {
                let presets = |name: &str, set: &[&str]| match preset::shipped::find(name) {
                    Some(found) => {
                        read_in(Files::SHIPPED, None, name, found.text, set).map_err(|e| e.to_string())
                    }
                    None => Err(format!("no preset {name}")),
                };
                Spec::read(&presets, "spec", &block).unwrap_or_else(|error| wrong(error.to_string()));
            } else if block.contains("[keys]") || block.contains("[look]") {
                pulloff::tui::config::read("settings", &block)
                    .unwrap_or_else(|error| wrong(error.to_string()));
            } else {
                let files = Files { points, ..Files::SHIPPED };
                let set: [&str; 0] = [];
                let read = read_in(files, None, "preset", &around(&block), &set);
                read.unwrap_or_else(|error| wrong(error.to_string()));
            }
        }
    }
    assert!(count >= 12, "{count}");
    read("empty", "").unwrap_err();
}

#[test]
fn the_script_of_the_book_is_played() {
    let home = Home::new();
    let script = blocks(&root().join("docs/src/scripts.md"), "text").remove(0);
    home.file("script", &script);
    let Ended { status, err, .. } = home.run(&["run", "script"]);
    assert_eq!(status, 0, "{err}");
    assert!(home.path("walk.csv").exists());
}
