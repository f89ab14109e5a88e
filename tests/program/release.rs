//! What is distributed: `scripts/release.sh` packs a program, and its Debian package is installed and removed.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a helper of a test fails the test by panicking")]

use std::fs::{self, Permissions};
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

const SCRIPT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/scripts/release.sh");
const LICENCES: [&str; 2] = ["LICENSE-APACHE", "LICENSE-MIT"];

fn run(command: &mut Command) -> Output {
    command.output().unwrap_or_else(|error| panic!("{command:?}: {error}"))
}

fn release(folder: &Path, parts: &str) -> Output {
    let mut command = Command::new("bash");
    command.env("PROGRAM", env!("CARGO_BIN_EXE_pulloff")).env("PARTS", parts).env("PIP_NO_INDEX", "1");
    run(command.arg(SCRIPT).arg(folder))
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
    // Unpacked as the book describes, with the commands for the other machine, it runs.
    let page = include_str!("../../docs/src/first-steps.md");
    let there = page.split_once("| ssh NODE '").unwrap().1.split_once('\'').unwrap().0;
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
    // Into a root of its own, with its own list of packages.
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
    assert!(said.contains("MAINTAINER='NAME <ADDRESS>'"), "{said}");
    dpkg(&["-i", &file(folder.path(), ".deb")]);
    assert!(run(Command::new(&program).arg("--version")).status.success());
    assert!(root.join("usr/share/man/man1/pulloff.1.gz").exists());
    let copyright = fs::read_to_string(root.join("usr/share/doc/pulloff/copyright")).unwrap();
    assert!(
        copyright.starts_with("Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/\n")
    );
    for said in [
        "License: Expat or Apache-2.0",
        "the pulloff authors",
        "Permission is hereby granted",
        "common-licenses",
    ] {
        assert!(copyright.contains(said), "{copyright}");
    }
    dpkg(&["-r", "pulloff"]);
    assert!(!program.exists() && !root.join("usr/share/doc/pulloff").exists());
}

/// A program that is small to pack: it runs the tested one.
fn small(folder: &Path) -> PathBuf {
    let path = folder.join("small");
    script(&path, &format!("exec '{}' \"$@\"", env!("CARGO_BIN_EXE_pulloff")));
    path
}

fn script(path: &Path, text: &str) {
    fs::write(path, format!("#!/bin/sh\n{text}\n")).unwrap();
    fs::set_permissions(path, Permissions::from_mode(0o755)).unwrap();
}

#[test]
fn the_same_sources_give_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let program = small(folder.path());
    let made = |name: &str, umask: &str, epoch: &str| {
        let line = format!("umask {umask}; exec bash '{SCRIPT}' {name}");
        let mut command = Command::new("sh");
        command.args(["-c", &line]).current_dir(folder.path()).env("PIP_NO_INDEX", "1");
        command.env("PROGRAM", &program).env("PARTS", "tar deb").env("SOURCE_DATE_EPOCH", epoch);
        let done = run(command.env("MAINTAINER", "A. Person <a@person.example>"));
        let said = String::from_utf8_lossy(&done.stderr).into_owned();
        assert!(!said.contains("no address"), "{said}");
        assert!(done.status.success() || said.contains("dpkg-deb is not here"), "{said}");
        let mut files: Vec<_> =
            fs::read_dir(folder.path().join(name)).unwrap().map(|e| e.unwrap().path()).collect();
        files.sort();
        files
            .iter()
            .map(|file| (file.file_name().unwrap().to_owned(), fs::read(file).unwrap()))
            .collect::<Vec<_>>()
    };
    let first = made("one", "022", "1700000000");
    // Another time, other permissions of new files.
    std::thread::sleep(std::time::Duration::from_millis(1100));
    assert!(first == made("two", "077", "1700000000"));
    assert!(first.len() >= 2 && first != made("three", "022", "1700000001"));
}

/// Scripts in place of what a build needs: a cargo that records what it is asked, and a compiler's sysroot with the target.
fn toolchain(folder: &Path) -> String {
    let tools = folder.join("tools");
    fs::create_dir_all(tools.join("sysroot/lib/rustlib/x86_64-unknown-linux-musl")).unwrap();
    script(&tools.join("rustc"), &format!("echo '{}'", tools.join("sysroot").display()));
    let build = format!(
        "echo \"$*\" >>'{0}/asked'\n[ \"$1\" = build ] || exec '{1}' \"$@\"\n\
         out=$CARGO_TARGET_DIR/x86_64-unknown-linux-musl/release\nmkdir -p \"$out\" && cp '{2}' \"$out/pulloff\"",
        folder.display(),
        env!("CARGO"),
        small(folder).display()
    );
    script(&tools.join("cargo"), &build);
    script(&tools.join("some-cc"), "exit 0");
    format!("{}:/usr/bin:/bin", tools.display())
}

#[test]
fn a_missing_compiler_is_found_before_anything_is_built() {
    let folder = tempfile::tempdir().unwrap();
    let path = toolchain(folder.path());
    let mut command = Command::new("bash");
    command
        .arg(SCRIPT)
        .arg(folder.path().join("out"))
        .env_remove("PROGRAM")
        .env("PARTS", "tar")
        .env("PATH", path);
    let done = run(command.env("CC_x86_64_unknown_linux_musl", "no-such-compiler"));
    let said = String::from_utf8_lossy(&done.stderr).into_owned();
    assert_eq!(done.status.code(), Some(1), "{said}");
    assert!(said.contains("a C compiler for musl is needed: no-such-compiler is not here"), "{said}");
    let asked = fs::read_to_string(folder.path().join("asked")).unwrap_or_default();
    assert!(!asked.contains("build"), "{asked}");
    // The same holds for an unknown part, and for a program that does not exist.
    for (parts, program, expected) in
        [("tar debs", "/bin/true", "debs"), ("tar", "none", "none is no program")]
    {
        let mut command = Command::new("bash");
        command.arg(SCRIPT).arg(folder.path().join("out")).env("PARTS", parts).env("PROGRAM", program);
        let done = run(command.current_dir(folder.path()));
        let said = String::from_utf8_lossy(&done.stderr).into_owned();
        assert!(done.status.code() == Some(1) && said.contains(expected), "{said}");
    }
}

#[test]
fn the_target_folder_of_cargo_is_where_it_is_said() {
    let folder = tempfile::tempdir().unwrap();
    let path = toolchain(folder.path());
    let mut command = Command::new("bash");
    command
        .arg(SCRIPT)
        .env_remove("PROGRAM")
        .env("PARTS", "tar")
        .env("PATH", path)
        .current_dir(folder.path());
    command.env("CC_x86_64_unknown_linux_musl", "some-cc");
    // Relative to the folder from which the script is called.
    let done = run(command.env("CARGO_TARGET_DIR", "my targets"));
    let said = String::from_utf8_lossy(&done.stderr).into_owned();
    assert!(done.status.success(), "{said}");
    assert!(
        file(&folder.path().join("my targets/release-files"), ".tar.gz").starts_with("pulloff-"),
        "{said}"
    );
    let asked = fs::read_to_string(folder.path().join("asked")).unwrap();
    assert!(
        asked.contains("build --locked --release --target x86_64-unknown-linux-musl -p pulloff"),
        "{asked}"
    );
}

/// The licences come with every package: the crates, the sources of the Python package and, checked by the gate, its wheel.
#[test]
fn every_package_has_its_licences() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    for package in ["pulloff", "pulloff-engine"] {
        let mut command = Command::new(env!("CARGO"));
        let listed = run(command
            .args(["package", "--list", "--allow-dirty", "--offline", "-p", package])
            .current_dir(root));
        let listed = String::from_utf8(listed.stdout).unwrap();
        for licence in LICENCES {
            assert!(listed.lines().any(|line| line == licence), "{package}: {listed}");
        }
    }
    for (folder, licence) in
        ["engine", "python"].into_iter().flat_map(|folder| LICENCES.map(|name| (folder, name)))
    {
        assert_eq!(fs::read(root.join(folder).join(licence)).unwrap(), fs::read(root.join(licence)).unwrap());
    }
    let python = fs::read_to_string(root.join("python/pyproject.toml")).unwrap();
    assert!(python.contains("license-files = [\"LICENSE-*\"]"));
}

#[test]
fn what_cannot_be_made_is_refused_with_a_sentence() {
    if Command::new("maturin").arg("--version").output().is_ok() {
        eprintln!("LEFT OUT: what builds the wheels may be here, and building them takes long");
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    // Without PyPI they are not available.
    let done = release(folder.path(), "wheels");
    let said = String::from_utf8_lossy(&done.stderr).into_owned();
    assert_eq!(done.status.code(), Some(3), "{said}");
    assert!(said.contains("maturin and zig are needed"), "{said}");
}
