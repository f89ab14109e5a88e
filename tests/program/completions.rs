//! Completion: what the program answers a shell, and what bash, zsh and fish do with it.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a helper of a test fails the test by panicking")]

use crate::support::home::Home;
use crate::support::pty::Pty;
use std::os::unix::fs::symlink;
use std::path::Path;
use std::process::Command;

/// The program's answer for the last of these words, as each shell asks; only the values.
fn asked(home: &Home, shell: &str, words: &[&str]) -> Vec<String> {
    let index = words.len().to_string();
    let mut command = home.command(&[&["--", "pulloff"], words].concat());
    command.env("COMPLETE", shell).env("_CLAP_IFS", "\n").env("_CLAP_COMPLETE_INDEX", index);
    let output = command.output().unwrap();
    assert!(output.status.success(), "{shell} {words:?}: {}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8(output.stdout).unwrap();
    let value = |line: &str| match shell {
        "fish" => line.split('\t').next().unwrap_or_default().to_owned(),
        // Its own colons are escaped, the one before the explanation is not.
        "zsh" => line.replace("\\:", "\0").split(':').next().unwrap_or_default().replace('\0', ":"),
        _ => line.to_owned(),
    };
    text.lines().map(value).collect()
}

#[test]
fn the_program_answers_every_shell_alike() {
    let home = Home::new();
    home.file("mine.toml", &home.quiet(&["presets", "show", "lens"]));
    home.file("curve.csv", "x,force\n");
    home.file("config/pulloff/presets/own-one.toml", &home.quiet(&["presets", "show", "cone"]));
    for shell in ["bash", "zsh", "fish"] {
        let has = |words: &[&str], expected: &[&str], others: &[&str]| {
            let found = asked(&home, shell, words);
            for word in expected {
                assert!(found.iter().any(|other| other == word), "{shell} {words:?}: no {word} in {found:?}");
            }
            for word in others {
                assert!(!found.iter().any(|other| other == word), "{shell} {words:?}: {word} in {found:?}");
            }
        };
        // Subcommands, and their own subcommands; existing presets, and files.
        has(&["un"], &["unload"], &["trace"]);
        has(&["presets", ""], &["list", "show", "delete", "path"], &[]);
        has(&["sweep", "mer"], &["merge"], &["check"]);
        has(&["trace", ""], &["wavy-sphere", "lens", "own-one", "mine.toml"], &["curve.csv"]);
        has(&["trace", "fig-9"], &["fig-9", "fig-9-weak"], &["fig-8"]);
        has(&["presets", "delete", ""], &["own-one"], &["lens", "mine.toml"]);
        has(&["fit", ""], &["curve.csv", "lens"], &[]);
        // Keys of this preset, and of a changed one.
        has(&["trace", "--set", "gap.w"], &["gap.wavelength="], &["gap.slope="]);
        has(&["trace", "cone", "--set", "gap."], &["gap.slope="], &["gap.wavelength="]);
        has(&["trace", "--set", "gap.shape=power-law", "--set", "gap.e"], &["gap.exponent="], &[]);
        has(&["trace", "--set", "groups.a"], &["groups.adhesion="], &[]);
        has(&["run", "x.pulloff", "--set", "material.w"], &["material.work_of_adhesion="], &[]);
        // Words of keys, and files.
        has(&["trace", "--set", "gap.shape=power"], &["gap.shape=power-law"], &["gap.shape=cone"]);
        has(&["trace", "--set", "basis.kind="], &["basis.kind=exact"], &[]);
        has(&["trace", "--set", "path.control=s"], &["path.control=stiffness="], &[]);
        has(&["trace", "lens", "--set", "data.file=cur"], &["data.file=curve.csv"], &[]);
        has(&["trace", "lens", "--set", "data.segment="], &["data.segment=retraction"], &[]);
        // Other options.
        has(&["unload", "--control", "d"], &["displacement"], &["force"]);
        has(&["map", "--x-key", "comp"], &["compliance="], &[]);
        has(&["map", "--x-key", "gap.a"], &["gap.amplitude="], &[]);
        has(&["fit", "curve.csv", "lens", "--free", "data.o"], &["data.offset"], &[]);
        has(
            &["fit", "curve.csv", "lens", "--free", "material.work_of_adhesion,data.o"],
            &["material.work_of_adhesion,data.offset"],
            &[],
        );
        has(&["plot", "--view", "press"], &["pressure"], &[]);
        has(&["completions", "f"], &["fish"], &[]);
        // What cannot be known gives no candidates, and no failure.
        has(&["trace", "--set", "banana="], &[], &["banana="]);
        has(&["trace", "no/such.toml", "--set", "gap.amp"], &["gap.amplitude="], &[]);
        has(&["\u{1b}[31m", ""], &[], &[]);
    }
}

#[test]
fn a_variable_of_somebody_else_changes_nothing() {
    let home = Home::new();
    for value in ["", "0", "1", "yes", "tcsh"] {
        let output = home.command(&["--version"]).env("COMPLETE", value).output().unwrap();
        assert!(output.status.success() && output.stdout.starts_with(b"pulloff "), "{value}");
    }
    home.refused(&["completions", "none"], &["possible values"]);
    for shell in ["bash", "elvish", "fish", "powershell", "zsh"] {
        let script = home.quiet(&["completions", shell]);
        assert!(script.contains("COMPLETE") && !script.contains(env!("CARGO_BIN_EXE_pulloff")), "{script}");
    }
}

/// Runs the real shell at a terminal, and checks the line after a Tab.
fn completes(shell: &str, arguments: &[&str], setup: &str) {
    if Command::new(shell).arg("--version").output().is_err() {
        eprintln!("LEFT OUT: {shell} is not here");
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    symlink(env!("CARGO_BIN_EXE_pulloff"), folder.path().join("pulloff")).unwrap();
    std::fs::write(folder.path().join("two words.toml"), "").unwrap();
    let home = folder.path().to_str().unwrap();
    let path = format!("{home}:/usr/bin:/bin");
    let program = ["/usr/bin", "/bin"].map(|below| Path::new(below).join(shell));
    let program = program.iter().find(|path| path.exists()).unwrap();
    let env = [("PATH", &*path), ("HOME", home), ("TERM", "dumb"), ("PS1", "$ ")];
    let env = if shell == "fish" { [env[0], env[1], ("TERM", "xterm"), env[3]] } else { env };
    let mut pty = Pty::spawn(program, arguments, &env, 100, 40);
    pty.keys(&format!("cd {home}; {setup}; echo re''ady\r"));
    pty.wait_for(|screen| screen.contains("\nready") || screen.contains("\r\nready"), "the completions");
    for (typed, expected) in [
        ("pulloff unl", "pulloff unload x"),
        ("pulloff trace exact-s", "pulloff trace exact-sphere x"),
        ("pulloff trace --set gap.wavel", "pulloff trace --set gap.wavelength=x"),
        ("pulloff trace --set basis.kind=ex", "pulloff trace --set basis.kind=exact x"),
        ("pulloff trace --set gap.shape=pow", "pulloff trace --set gap.shape=power-law x"),
        ("pulloff unload --control=dis", "pulloff unload --control=displacement x"),
        ("pulloff presets del", "pulloff presets delete x"),
        ("pulloff fit shipped:lens.csv le", "pulloff fit shipped:lens.csv lens x"),
        ("pulloff trace two", "pulloff trace two\\ words.toml x"),
    ] {
        // The letter shows whether a space was added after the word.
        pty.keys(&format!("{typed}\t"));
        pty.wait_for(|screen| screen.contains(expected.trim_end_matches('x').trim_end()), expected);
        pty.keys("x");
        pty.wait_for(|screen| screen.contains(expected), expected);
        pty.keys("\x15");
    }
}

#[test]
fn bash_completes() {
    completes("bash", &["--norc", "--noprofile", "-i"], "source <(pulloff completions bash)");
}

#[test]
fn zsh_completes() {
    completes("zsh", &["-f", "-i"], "autoload -U compinit; compinit -u; source <(pulloff completions zsh)");
}

/// As installed: a function file, loaded at the first Tab.
#[test]
fn zsh_completes_with_the_file_of_the_package() {
    let setup = "mkdir site; pulloff completions zsh >site/_pulloff; fpath=($PWD/site $fpath); autoload -U compinit; compinit -u";
    completes("zsh", &["-f", "-i"], setup);
}

#[test]
fn fish_completes() {
    completes("fish", &["--no-config", "-i"], "pulloff completions fish | source");
}
