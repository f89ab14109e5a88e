//! Taking the terminal, and giving it back.

use std::io;

use super::display::Display;
use super::end::{self, install_panic_hook};
use super::input::Inbox;
use super::sink::FrameSink;
use super::tty::Tty;
use super::{hangup, signals};

/// Gives the terminal back when dropped.
///
/// Everything else that ends the program (signals, a hang-up, a panic) gives it back by itself.
#[must_use = "dropping it gives the terminal back"]
pub struct Guard(());

impl Drop for Guard {
    fn drop(&mut self) {
        restore();
    }
}

/// Takes the terminal: raw mode, alternate screen, hidden cursor, marked pastes. Once per process.
///
/// From here on SIGTERM, SIGINT, SIGHUP and SIGQUIT end the process with 128 plus their number, the loss of the
/// terminal with 129 and a panic in any thread with 101, each after the last words
/// ([`set_last_words`](super::set_last_words)) and with the terminal given back.
/// Errors: If there is no terminal (ask [`refuse_reason`](super::refuse_reason) first), if it was taken before, or if a
/// thread cannot be started. The terminal is then unchanged.
pub fn enter<T: Send + 'static>() -> io::Result<(Guard, Display<impl FrameSink>, Inbox<T>)> {
    let tty = Tty::open()?;
    // Before the first mode is set, so that they are never missing.
    install_panic_hook();
    let signals = signals::catch()?;
    let guard = Guard(());
    tty.take()?;
    let inbox = Inbox::empty();
    signals::serve(signals, tty, inbox.notifier())?;
    hangup::watch(tty)?;
    inbox.read_terminal(tty)?;
    Ok((guard, Display::new(tty)?, inbox))
}

/// Gives the terminal back now, from any thread, any number of times; takes less than 200 ms, whatever state the
/// terminal is in. What is drawn afterwards is dropped.
pub fn restore() {
    end::restore();
}
