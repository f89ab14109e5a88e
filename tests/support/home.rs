//! A separate home in which the program runs, so that nothing of the machine's user is seen or touched.
#![allow(dead_code, reason = "each test file uses a part of it")]
#![allow(clippy::unwrap_used, clippy::panic, reason = "a helper of a test fails the test by panicking")]

use super::schema;

use rustix::process::{Pid, Signal, kill_process};
use serde_json::Value;
use std::ffi::OsString;
use std::fs;
use std::io::{Read, Seek};
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};
use tempfile::TempDir;

/// A folder that serves as home, configuration folder and current folder of the program.
pub struct Home(TempDir);

/// How a run ended.
pub struct Ended {
    pub status: i32,
    pub out: String,
    pub err: String,
}

impl Home {
    pub fn new() -> Self {
        Self(tempfile::tempdir().expect("a folder"))
    }

    pub fn folder(&self) -> &Path {
        self.0.path()
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// Writes a file below the home; returns its path.
    pub fn file(&self, name: &str, text: &str) -> String {
        let path = self.path(name);
        fs::create_dir_all(path.parent().expect("below the home")).expect("a folder");
        fs::write(&path, text).expect("a file");
        path.to_str().expect("UTF-8").to_owned()
    }

    pub fn text(&self, name: &str) -> String {
        let text = fs::read_to_string(self.path(name)).expect("a file of text");
        schema::check(&text);
        text
    }

    /// The program with nothing on standard input and no environment variables but these.
    pub fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_pulloff"));
        command.env_clear().env("HOME", self.folder()).env("XDG_CONFIG_HOME", self.path("config"));
        command.current_dir(self.folder()).args(arguments).stdin(Stdio::null());
        command
    }

    /// Runs a line of the shell in the home, with the program as `$pulloff`.
    pub fn shell(&self, line: &str) -> Ended {
        let mut command = Command::new("bash");
        command.env_clear().env("HOME", self.folder()).env("XDG_CONFIG_HOME", self.path("config"));
        command.env("PATH", "/usr/bin:/bin").env("pulloff", env!("CARGO_BIN_EXE_pulloff"));
        command.current_dir(self.folder()).stdin(Stdio::null()).args(["-c", line]);
        Ended::of(command.output().expect("a run"))
    }

    pub fn run(&self, arguments: &[&str]) -> Ended {
        Ended::of(self.command(arguments).output().expect("a run"))
    }

    /// Runs the program for at most `patience`; `None` if it had to be killed.
    pub fn within(&self, arguments: &[OsString], patience: Duration) -> Option<Ended> {
        // Files accept whatever is written, without anyone reading them meanwhile.
        let [mut out, mut err] = [(); 2].map(|()| tempfile::tempfile().expect("a file"));
        let [to_out, to_err] = [&out, &err].map(|file| file.try_clone().expect("a handle"));
        let mut child =
            self.command(&[]).args(arguments).stdout(to_out).stderr(to_err).spawn().expect("a run");
        let begun = Instant::now();
        let status = loop {
            if let Some(status) = child.try_wait().expect("its state") {
                break status;
            }
            if begun.elapsed() > patience {
                child.kill().and_then(|()| child.wait()).expect("its end");
                return None;
            }
            sleep(Duration::from_millis(5));
        };
        let [stdout, stderr] = [&mut out, &mut err].map(|file| {
            let mut bytes = Vec::new();
            file.rewind().and_then(|()| file.read_to_end(&mut bytes)).expect("what was said");
            bytes
        });
        Some(Ended::of(Output { status, stdout, stderr }))
    }

    /// Starts the program, sends the signal once it is caught, and returns how it ended.
    pub fn stopped(&self, arguments: &[&str], signal: Signal) -> Ended {
        let mut command = self.command(arguments);
        let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("a run");
        let status = format!("/proc/{}/status", child.id());
        let is_caught = || {
            let text = fs::read_to_string(&status).unwrap_or_default();
            let mask = text.lines().find_map(|line| line.strip_prefix("SigCgt:"));
            let mask = mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).unwrap_or(0);
            mask >> (signal.as_raw() - 1) & 1 == 1
        };
        while !is_caught() && child.try_wait().expect("its state").is_none() {
            sleep(Duration::from_millis(5));
        }
        // The handler is installed a moment before it knows what to do: a signal in between is lost.
        sleep(Duration::from_millis(20));
        // If it has already ended, its status shows that.
        let _ = kill_process(Pid::from_child(&child), signal);
        Ended::of(child.wait_with_output().expect("its end"))
    }

    /// A run that succeeds and says nothing on standard error.
    pub fn quiet(&self, arguments: &[&str]) -> String {
        let ended = self.run(arguments);
        assert_eq!((ended.status, ended.err.as_str()), (0, ""), "{arguments:?}");
        ended.out
    }

    pub fn json(&self, arguments: &[&str]) -> Value {
        serde_json::from_str(&self.quiet(&[arguments, &["--format", "json"]].concat())).expect("JSON")
    }

    /// A run that is refused: status 2, nothing on standard output, one message that contains all of `said`.
    pub fn refused(&self, arguments: &[&str], said: &[&str]) {
        let ended = self.run(arguments);
        assert_eq!((ended.status, ended.out.as_str()), (2, ""), "{arguments:?}: {}", ended.err);
        for text in said {
            assert!(ended.err.contains(text), "{arguments:?}: no {text:?} in {}", ended.err);
        }
        assert!(!ended.err.contains('\x1b'), "{arguments:?}: {:?}", ended.err);
    }
}

impl Ended {
    /// The end of a program that ended by itself.
    pub fn of(output: Output) -> Self {
        let out = String::from_utf8(output.stdout).expect("UTF-8");
        // Any document that a command writes must follow its schema.
        schema::check(&out);
        Self {
            status: output.status.code().expect("no signal"),
            out,
            err: String::from_utf8(output.stderr).expect("UTF-8"),
        }
    }
}
