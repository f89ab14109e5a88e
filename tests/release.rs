//! What is handed out: `scripts/release.sh` packs a program, and its Debian package is installed and removed.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a helper of a test fails the test by panicking")]

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

fn run(command: &mut Command) -> Output {
    command.output().unwrap_or_else(|error| panic!("{command:?}: {error}"))
}

fn release(folder: &Path, parts: &str) -> Output {
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/scripts/release.sh");
    let mut command = Command::new("bash");
    command.env("PROGRAM", env!("CARGO_BIN_EXE_pulloff")).env("PARTS", parts).env("PIP_NO_INDEX", "1");
    run(command.arg(script).arg(folder))
}

fn file(folder: &Path, ending: &str) -> String {
    let names = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap());
    names.filter(|name| name.ends_with(ending)).collect::<Vec<_>>().concat()
}

#[test]
fn the_archive_holds_the_program_with_its_papers_and_its_sum() {
    let folder = tempfile::tempdir().unwrap();
    let done = release(folder.path(), "tar");
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    let archive = file(folder.path(), ".tar.gz");
    let listed = run(Command::new("tar").arg("-tzf").arg(folder.path().join(&archive)));
    let listed = String::from_utf8(listed.stdout).unwrap();
    for name in [
        "/bin/pulloff",
        "/share/man/man1/pulloff.1",
        "/share/bash-completion/completions/pulloff",
        "/share/zsh/vendor-completions/_pulloff",
        "/share/fish/vendor_completions.d/pulloff.fish",
        "/share/doc/pulloff/LICENSE-MIT",
        "/share/doc/pulloff/LICENSE-APACHE",
    ] {
        assert!(listed.lines().any(|line| line.ends_with(name)), "{name} is not in {listed}");
    }
    let sums = run(Command::new("sha256sum").arg("-c").arg("SHA256SUMS").current_dir(folder.path()));
    assert!(sums.status.success() && !sums.stdout.is_empty());
    // Unpacked as the README says, by what it runs on the other machine, it runs.
    let readme = include_str!("../README.md");
    let there = readme.split_once("| ssh NODE '").unwrap().1.split_once('\'').unwrap().0;
    let home = folder.path().join("home");
    fs::create_dir(&home).unwrap();
    let bytes = fs::File::open(folder.path().join(&archive)).unwrap();
    let unpacked = run(Command::new("sh").args(["-c", there]).current_dir(&home).stdin(bytes));
    assert!(unpacked.status.success(), "{}", String::from_utf8_lossy(&unpacked.stderr));
    assert!(run(Command::new(home.join(".local/bin/pulloff")).arg("--version")).status.success());
    assert!(home.join(".local/share/man/man1/pulloff.1").exists());
}

#[test]
fn the_package_is_installed_and_removed() {
    let folder = tempfile::tempdir().unwrap();
    let done = release(folder.path(), "deb");
    let said = String::from_utf8_lossy(&done.stderr).into_owned();
    if done.status.code() == Some(3) {
        assert!(said.contains("dpkg-deb is not here"), "{said}");
        eprintln!("LEFT OUT: {said}");
        return;
    }
    assert!(done.status.success(), "{said}");
    // Into a root of its own, with a list of packages of its own.
    let root = folder.path().join("root");
    for below in ["var/lib/dpkg/info", "var/lib/dpkg/updates", "var/log"] {
        fs::create_dir_all(root.join(below)).unwrap();
    }
    for list in ["status", "available"] {
        fs::write(root.join("var/lib/dpkg").join(list), "").unwrap();
    }
    let dpkg = |arguments: &[&str]| {
        let mut command = Command::new("dpkg");
        command.arg(format!("--root={}", root.display())).args(["--force-not-root", "--force-bad-path"]);
        let done = run(command.args(arguments).current_dir(folder.path()));
        assert!(done.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&done.stderr));
    };
    let program = root.join("usr/bin/pulloff");
    let field = run(Command::new("dpkg-deb")
        .arg("-f")
        .arg(folder.path().join(file(folder.path(), ".deb")))
        .arg("Maintainer"));
    assert_eq!(String::from_utf8(field.stdout).unwrap().trim(), "the pulloff authors");
    dpkg(&["-i", &file(folder.path(), ".deb")]);
    assert!(run(Command::new(&program).arg("--version")).status.success());
    assert!(root.join("usr/share/man/man1/pulloff.1.gz").exists());
    dpkg(&["-r", "pulloff"]);
    assert!(!program.exists() && !root.join("usr/share/doc/pulloff").exists());
}

#[test]
fn what_cannot_be_made_is_refused_with_a_sentence() {
    if Command::new("maturin").arg("--version").output().is_ok() {
        eprintln!("LEFT OUT: what builds the wheels may be here, and building them takes long");
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    // Without PyPI they cannot be had.
    let done = release(folder.path(), "wheels");
    let said = String::from_utf8_lossy(&done.stderr).into_owned();
    assert_eq!(done.status.code(), Some(3), "{said}");
    assert!(said.contains("maturin and zig are needed"), "{said}");
}
