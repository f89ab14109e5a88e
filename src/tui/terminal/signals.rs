//! Signals: ending, stopping and continuing, resizing.
//!
//! The handlers only write to a pipe; the thread here does the work, and does it itself rather than ask the main
//! loop, which may be waiting for a terminal that nobody reads.

use std::{
    io, thread,
    time::{Duration, Instant},
};

use rustix::process::{Signal, getpgrp, getsid, kill_current_process_group};
use signal_hook::{
    consts::{SIGCONT, SIGHUP, SIGINT, SIGQUIT, SIGTERM, SIGTSTP, SIGWINCH},
    iterator::Signals,
    low_level::raise,
};

use super::end::{HUNG_UP, end, restore};
use super::input::Notifier;
use super::tty::Tty;
use crate::fault;

/// The signals that end the program.
const ENDING: [i32; 4] = [SIGTERM, SIGINT, SIGHUP, SIGQUIT];

/// How long to wait for the terminal after being continued: some shells continue a job before handing it over.
const FOREGROUND_PATIENCE: Duration = Duration::from_millis(500);

/// Stops the program as the shell's stop key would, for the key that raw mode delivers instead (Ctrl-Z).
///
/// Returns at once; the stop follows. Ignored if there is no shell to return to.
pub fn suspend() {
    // Only an unknown signal can fail.
    let _ = raise(SIGTSTP);
}

/// Catches the signals from now on; they are answered once [`serve`] runs.
pub(super) fn catch() -> io::Result<Signals> {
    Signals::new(ENDING.into_iter().chain([SIGTSTP, SIGCONT, SIGWINCH]))
}

pub(super) fn serve(mut signals: Signals, tty: &'static Tty, notifier: Notifier) -> io::Result<()> {
    thread::Builder::new().name("signals".to_owned()).spawn(move || {
        loop {
            // Together, since signals that arrived while stopped are delivered at once: an end comes first, and a
            // continue undoes a stop.
            let batch: Vec<i32> = signals.wait().collect();
            fault::point(fault::SIGNAL);
            if let Some(signal) = batch.iter().find(|signal| ENDING.contains(signal)) {
                end(128 + signal);
            }
            if batch.contains(&SIGWINCH) {
                notifier.resized();
            }
            if batch.contains(&SIGCONT) {
                go_on(tty, &notifier);
            } else if batch.contains(&SIGTSTP) {
                stop(tty);
            }
        }
    })?;
    Ok(())
}

/// Gives the terminal back and stops the whole job.
fn stop(tty: &Tty) {
    if tty.is_taken() && has_shell() {
        restore();
        // The group, since a program that started us (`cargo run`) is part of the job. Not SIGTSTP: we catch it.
        let _ = kill_current_process_group(Signal::STOP);
    }
}

/// Takes the terminal again and has everything redrawn.
fn go_on(tty: &Tty, notifier: &Notifier) {
    let until = Instant::now() + FOREGROUND_PATIENCE;
    while !tty.in_foreground() {
        if Instant::now() > until {
            // Continued in the background (`bg`): nothing can be shown there, so wait for `fg`.
            if !tty.is_taken() {
                let _ = kill_current_process_group(Signal::STOP);
            }
            return;
        }
        thread::sleep(Duration::from_millis(10));
    }
    if tty.take().is_err() {
        end(HUNG_UP);
    }
    notifier.resumed();
}

/// Whether somebody could continue us. A shell puts each job into a group of its own, so a group that contains the
/// session's leader has no shell above it.
fn has_shell() -> bool {
    getsid(None).is_ok_and(|session| session != getpgrp())
}
