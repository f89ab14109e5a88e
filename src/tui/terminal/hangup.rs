//! Notices that the terminal has gone away, even where no SIGHUP says so (sudo, nohup, some task runners).
//!
//! Needed because the event reader does not treat end-of-file as an end: it would read it again and again at full
//! speed, and never return.

use std::{io, thread};

use super::end::{HUNG_UP, end};
use super::tty::Tty;

/// Starts the watch; it sleeps until there is a hang-up.
pub(super) fn watch(tty: &'static Tty) -> io::Result<()> {
    thread::Builder::new().name("hang-up".to_owned()).spawn(|| {
        if tty.wait_for_hang_up().is_ok() {
            end(HUNG_UP);
        }
    })?;
    Ok(())
}
