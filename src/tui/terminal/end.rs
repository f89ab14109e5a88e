//! The one way out for everything that ends the program from outside its main loop.
//!
//! The first thread to arrive ends the process; the others wait for it. From then on a timer runs that ends the
//! process even if the rest of it is stuck.

use std::{
    backtrace::{Backtrace, BacktraceStatus},
    io::{self, IsTerminal, Write as _},
    panic::{self, PanicHookInfo},
    process,
    sync::{
        Arc, Mutex, PoisonError,
        atomic::{AtomicBool, Ordering},
    },
    thread::{self, JoinHandle},
    time::Duration,
};

use super::report;
use super::tty::Tty;
use crate::store::temporary;

/// The status after a hang-up, the same as after SIGHUP.
pub(super) const HUNG_UP: i32 = 129;

/// The status after a panic, the usual one.
const PANICKED: i32 = 101;

/// How long the last words may take.
const LIMIT: Duration = Duration::from_secs(1);

/// How long a file that is being written may take: a save cut off would leave a temporary file behind.
const SAVE_PATIENCE: Duration = Duration::from_millis(500);

/// How long a panic message may wait for room on the terminal.
const MESSAGE_PATIENCE: Duration = Duration::from_millis(200);

/// The thread that speaks the last words; a panic in it ends only the words.
const LAST_WORDS: &str = "last-words";

type LastWords = Arc<dyn Fn() + Send + Sync>;

static ENDING: AtomicBool = AtomicBool::new(false);
static WORDS: Mutex<Option<LastWords>> = Mutex::new(None);

/// What to do before the process ends on a signal, a hang-up or a panic: save unsaved work.
///
/// It runs on a thread of its own while the other threads still run, or are stuck, or hold their locks: take what it
/// needs with `try_lock`, and be done within a second, after which the process ends anyway. It is not called
/// when the main loop ends by itself. The terminal may belong to anybody by then: print nothing.
pub fn set_last_words(words: Box<dyn Fn() + Send + Sync>) {
    *WORDS.lock().unwrap_or_else(PoisonError::into_inner) = Some(words.into());
}

/// Gives the terminal back, speaks the last words and ends the process with `status`.
pub(super) fn end(status: i32) -> ! {
    claim(status);
    // This comes first, since the last words may take long.
    restore();
    speak();
    temporary::finish(SAVE_PATIENCE);
    process::exit(status)
}

/// From now on a panic in any thread gives the terminal back, says what happened and ends the process.
///
/// Otherwise a panicking worker would leave a screen that waits for it for ever.
pub(super) fn install_panic_hook() {
    panic::set_hook(Box::new(|info| {
        if thread::current().name() == Some(LAST_WORDS) {
            return;
        }
        let what = describe(info);
        // Taken before the claim, which may be the last thing this thread does; names are looked up later.
        let trace = Backtrace::force_capture();
        claim(PANICKED);
        restore();
        say(&what);
        // At the same time, since the work must not wait for the report, and both together have one second.
        let words = start_to_speak();
        match report::write(&what, &trace) {
            Ok(path) => say(&format!("A report is in {path}\n")),
            Err(why) => say(&format!("No report could be written: {why}\n")),
        }
        if Backtrace::capture().status() == BacktraceStatus::Captured {
            say(&report::visible(&trace.to_string()));
        }
        join(words);
        temporary::finish(SAVE_PATIENCE);
        process::exit(PANICKED)
    }));
}

/// Gives the terminal back, if it was ever taken.
pub(super) fn restore() {
    if let Some(tty) = Tty::get() {
        tty.give_back();
    }
}

/// Returns in the first thread that calls it, with the timer running; the others wait for ever.
fn claim(status: i32) {
    if ENDING.swap(true, Ordering::SeqCst) {
        loop {
            thread::park();
        }
    }
    // Even without a timer the end is near: only the last words could delay it.
    let _ = thread::Builder::new().name("end".to_owned()).spawn(move || {
        thread::sleep(LIMIT);
        restore();
        // At once: the usual exit would wait for the thread that is stuck.
        signal_hook::low_level::exit(status)
    });
}

fn speak() {
    join(start_to_speak());
}

fn start_to_speak() -> Option<JoinHandle<()>> {
    let words = WORDS.lock().unwrap_or_else(PoisonError::into_inner).take()?;
    thread::Builder::new().name(LAST_WORDS.to_owned()).spawn(move || words()).ok()
}

fn join(speaker: Option<JoinHandle<()>>) {
    if let Some(speaker) = speaker {
        let _ = speaker.join();
    }
}

/// A panic as text for the main screen: where, in which thread, what.
fn describe(info: &PanicHookInfo<'_>) -> String {
    let what = info
        .payload()
        .downcast_ref::<&str>()
        .copied()
        .or_else(|| info.payload().downcast_ref::<String>().map(String::as_str))
        .unwrap_or("no message");
    let place = info.location().map_or_else(|| "an unknown place".to_owned(), ToString::to_string);
    let thread = thread::current();
    report::visible(&format!(
        "{name} panicked at {place} (thread {thread}):\n{what}\nThis is a fault in {name} {version}. Please report it.",
        name = env!("CARGO_PKG_NAME"),
        thread = thread.name().unwrap_or("without a name"),
        version = env!("CARGO_PKG_VERSION"),
    ))
}

/// Writes to standard error without being held up by a terminal that nobody reads.
fn say(text: &str) {
    match Tty::get() {
        Some(tty) if io::stderr().is_terminal() => drop(tty.send(text.as_bytes(), MESSAGE_PATIENCE)),
        _ => drop(io::stderr().write_all(text.as_bytes())),
    }
}
