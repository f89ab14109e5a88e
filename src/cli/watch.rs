//! What watches a long command: a bar on a terminal, and the signals that end it.

use super::Failure;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use pulloff_engine::progress::Progress;
use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag;
use std::cell::OnceCell;
use std::io;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError, Sender};
use std::sync::{Arc, OnceLock};
use std::thread;
use std::time::{Duration, Instant};

/// A command that takes less than this shows no bar.
const MOMENT: Duration = Duration::from_millis(500);

/// Holds the number of the received signal, once signals are caught.
static CAUGHT: OnceLock<Arc<AtomicUsize>> = OnceLock::new();

/// The received signal, where a command catches signals.
pub(super) fn signal() -> Option<u8> {
    number(CAUGHT.get()?)
}

fn number(signal: &AtomicUsize) -> Option<u8> {
    u8::try_from(signal.load(Ordering::Relaxed)).ok().filter(|signal| *signal != 0)
}

/// The signals that stop a command: the first lets it keep what is done, the second ends it at once.
pub struct StopSignal {
    signal: Arc<AtomicUsize>,
}

impl StopSignal {
    /// Catches the signals from now on.
    pub fn catch() -> Result<Self, Failure> {
        let signal = Arc::clone(CAUGHT.get_or_init(Arc::default));
        let again = Arc::new(AtomicBool::new(false));
        let catch = |number: i32, value: usize| -> io::Result<()> {
            // Registered before the flag is set, so that it acts on the next signal.
            flag::register_conditional_shutdown(number, 128 + number, Arc::clone(&again))?;
            flag::register(number, Arc::clone(&again))?;
            flag::register_usize(number, Arc::clone(&signal), value).map(drop)
        };
        catch(SIGINT, 2)
            .and_then(|()| catch(SIGTERM, 15))
            .map_err(|cause| Failure::System { what: "cannot catch signals".to_owned(), cause })?;
        Ok(Self { signal })
    }

    /// The received signal.
    pub fn signal(&self) -> Option<u8> {
        number(&self.signal)
    }
}

impl Progress for StopSignal {
    fn stop(&self) -> bool {
        self.signal().is_some()
    }
}

/// The completed fraction, shown on a terminal once the command takes longer than a moment.
pub struct Bar<'a> {
    begun: Instant,
    shown: OnceCell<ProgressBar>,
    stop: Option<&'a StopSignal>,
    hidden: bool,
}

impl<'a> Bar<'a> {
    /// Starts the bar of a command that begins now. Without `stop`, a signal ends the program as usual.
    pub fn begin(stop: Option<&'a StopSignal>, hidden: bool) -> Self {
        Self { begun: Instant::now(), shown: OnceCell::new(), stop, hidden }
    }
}

/// The current line of a script, shown on a terminal once the script takes longer than a moment, since its first line
/// may take all of that time.
pub struct Lines {
    bar: ProgressBar,
    /// Dropped at the end, so that nothing is shown for a script that is already over.
    _ends: Sender<()>,
}

impl Lines {
    /// Starts the bar of a script of `count` lines.
    pub fn begin(count: usize, hidden: bool) -> Self {
        let bar = ProgressBar::with_draw_target(Some(count as u64), ProgressDrawTarget::hidden());
        if let Ok(style) = ProgressStyle::with_template("{wide_bar} line {msg} of {len}, {elapsed}") {
            bar.set_style(style);
        }
        bar.set_message("1");
        let (ends, over) = mpsc::channel::<()>();
        let later = bar.clone();
        if !hidden {
            thread::spawn(move || {
                if over.recv_timeout(MOMENT) == Err(RecvTimeoutError::Timeout) {
                    later.set_draw_target(ProgressDrawTarget::stderr_with_hz(5));
                    later.enable_steady_tick(Duration::from_secs(1));
                }
            });
        }
        Self { bar, _ends: ends }
    }

    /// Reports that `lines` lines are done; `says` writes to standard error meanwhile.
    pub fn done(&self, lines: usize, says: impl FnOnce()) {
        self.bar.suspend(says);
        self.bar.set_position(lines as u64);
        self.bar.set_message((lines as u64 + 1).min(self.bar.length().unwrap_or(0)).to_string());
    }
}

impl Drop for Lines {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}

fn drawn() -> ProgressBar {
    let bar = ProgressBar::with_draw_target(Some(100), ProgressDrawTarget::stderr_with_hz(5));
    if let Ok(style) = ProgressStyle::with_template("{wide_bar} {percent} %") {
        bar.set_style(style);
    }
    bar.enable_steady_tick(Duration::from_secs(1));
    bar
}

impl Progress for Bar<'_> {
    fn report(&self, share: f64) {
        if self.hidden || self.begun.elapsed() < MOMENT {
            return;
        }
        // In per cent.
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        self.shown.get_or_init(drawn).set_position((share.clamp(0.0, 1.0) * 100.0) as u64);
    }

    fn stop(&self) -> bool {
        self.stop.is_some_and(Progress::stop)
    }
}

impl Drop for Bar<'_> {
    fn drop(&mut self) {
        if let Some(bar) = self.shown.get() {
            bar.finish_and_clear();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_short_command_shows_no_bar() {
        let bar = Bar::begin(None, false);
        bar.report(0.5);
        assert!(bar.shown.get().is_none());
        let long = |hidden| Bar {
            begun: Instant::now().checked_sub(2 * MOMENT).unwrap(),
            shown: OnceCell::new(),
            stop: None,
            hidden,
        };
        let [bar, hidden] = [false, true].map(long);
        bar.report(0.5);
        hidden.report(0.5);
        assert_eq!(bar.shown.get().unwrap().position(), 50);
        assert!(hidden.shown.get().is_none());
    }
}
