//! The terminal itself: the modes switched on, the string that undoes them, and writing that cannot get stuck.
//!
//! The terminal is opened a second time, non-blocking. Setting the flag on standard output would set it for the shell
//! too, since they share one open file. A write then never waits inside the kernel: the drawing thread waits for room
//! with `poll`, holding no lock, so any other thread can give the terminal back meanwhile.

use std::{
    io,
    os::fd::{AsFd, OwnedFd},
    sync::{
        Mutex, MutexGuard, OnceLock, PoisonError, TryLockError,
        atomic::{AtomicBool, AtomicU32, Ordering},
    },
    thread,
    time::{Duration, Instant},
};

use rustix::{
    event::{PollFd, PollFlags, Timespec, poll},
    fs::{Mode, OFlags, open},
    io::{Errno, retry_on_intr},
    process::{getpgrp, getsid},
    stdio::{stdin, stdout},
    termios::{
        OptionalActions, QueueSelector, SpecialCodeIndex, Termios, tcflush, tcgetattr, tcgetpgrp, tcgetsid,
        tcgetwinsize, tcsetattr, ttyname,
    },
};

use super::sink::FrameSink;

/// Switches to the alternate screen, cleared, without cursor, and makes pastes distinguishable from keys.
const TAKE: &[u8] = b"\x1b[?1049h\x1b[?25l\x1b[?2004h\x1b[0m\x1b[2J\x1b[H";

/// Presses and the wheel are reported, with coordinates of any size; movements are not, since a slow line would feel
/// them.
const MOUSE_ON: &[u8] = b"\x1b[?1000h\x1b[?1006h";

/// Switches these reports off again.
const MOUSE_OFF: &[u8] = b"\x1b[?1006l\x1b[?1000l";

/// Undoes everything that [`TAKE`], [`MOUSE_ON`] and a frame can leave on.
///
/// It starts with CAN, since discarded output may have ended within a sequence.
const GIVE_BACK: &[u8] = b"\x18\x1b[0m\x1b[?1006l\x1b[?1000l\x1b[?2004l\x1b[?1049l\x1b[?25h";

/// How long giving back may wait: first for a writer in the middle of a write, then for room for [`GIVE_BACK`].
const PATIENCE: Duration = Duration::from_millis(80);

/// How long taking the terminal may wait for room.
const TAKE_PATIENCE: Duration = Duration::from_secs(1);

/// A size of zero means that nobody knows it (serial lines); then this is assumed, as elsewhere.
const USUAL_SIZE: (u16, u16) = (80, 24);

static LINE: OnceLock<Tty> = OnceLock::new();

/// The terminal of this process.
pub(super) struct Tty {
    fd: OwnedFd,
    /// The modes before the terminal was taken.
    before: Mutex<Termios>,
    /// How often the terminal has changed hands. Odd: it is ours. A frame begun under another number is not continued.
    hands: AtomicU32,
    mouse: AtomicBool,
    /// Held during one write.
    turn: Mutex<()>,
    /// Held while the terminal is given back.
    giving: Mutex<()>,
}

impl Tty {
    /// Opens the terminal once for the whole process; nothing is changed yet.
    pub(super) fn open() -> io::Result<&'static Self> {
        let fd = reopen()?;
        let before = tcgetattr(&fd)?;
        let line = Self {
            fd,
            before: Mutex::new(before),
            hands: AtomicU32::new(0),
            mouse: AtomicBool::new(false),
            turn: Mutex::new(()),
            giving: Mutex::new(()),
        };
        if LINE.set(line).is_err() {
            return Err(io::Error::new(io::ErrorKind::AlreadyExists, "the terminal is already taken"));
        }
        Self::get().ok_or_else(|| io::ErrorKind::NotFound.into())
    }

    /// The terminal, once opened.
    pub(super) fn get() -> Option<&'static Self> {
        LINE.get()
    }

    /// Sets raw mode, alternate screen, no cursor, marked pastes. Taking it again sets all of them anew.
    pub(super) fn take(&self) -> io::Result<()> {
        let (hands, rest) = {
            let _turn = patient(&self.turn, PATIENCE);
            let mut before = self.before.lock().unwrap_or_else(PoisonError::into_inner);
            let ours = self.is_taken();
            if !ours {
                // A shell may have changed the modes since.
                *before = retry_on_intr(|| tcgetattr(&self.fd))?;
            }
            let mut raw = before.clone();
            raw.make_raw();
            raw.special_codes[SpecialCodeIndex::VMIN] = 1;
            raw.special_codes[SpecialCodeIndex::VTIME] = 0;
            // It is ours before the modes are, so that a thread that ends the program now undoes them.
            let more = if ours { 2 } else { 1 };
            let hands = self.hands.fetch_add(more, Ordering::SeqCst).wrapping_add(more);
            if let Err(error) = retry_on_intr(|| tcsetattr(&self.fd, OptionalActions::Now, &raw)) {
                // Unless it was given back meanwhile.
                let was = hands.wrapping_sub(more);
                let _ = self.hands.compare_exchange(hands, was, Ordering::SeqCst, Ordering::SeqCst);
                return Err(error.into());
            }
            // Before any frame, which would be drawn on the other screen.
            (hands, self.written(TAKE)?)
        };
        let until = Some(Instant::now() + TAKE_PATIENCE);
        self.write_ours(hands, rest, until)?;
        if self.mouse.load(Ordering::SeqCst) { self.write_ours(hands, MOUSE_ON, until) } else { Ok(()) }
    }

    /// Gives the terminal back as it was. Works from any thread, any number of times, in less than 200 ms. If another
    /// thread is giving it back, it has done so when this returns.
    ///
    /// There is nobody to report a failure to: a terminal that cannot be restored is gone.
    pub(super) fn give_back(&self) {
        let _giving = patient(&self.giving, 2 * PATIENCE);
        let hands = self.hands.load(Ordering::SeqCst);
        if !is_ours(hands)
            || self
                .hands
                .compare_exchange(hands, hands.wrapping_add(1), Ordering::SeqCst, Ordering::SeqCst)
                .is_err()
        {
            return;
        }
        let _turn = patient(&self.turn, PATIENCE);
        // Output that nobody has read would come before the string that undoes the modes, if there were room for it at
        // all.
        let _ = tcflush(&self.fd, QueueSelector::OFlush);
        let before = self.before.lock().unwrap_or_else(PoisonError::into_inner);
        let _ = retry_on_intr(|| tcsetattr(&self.fd, OptionalActions::Now, &before));
        let _ = self.send(GIVE_BACK, PATIENCE);
    }

    /// Writes what there is room for now; returns the rest.
    fn written<'a>(&self, bytes: &'a [u8]) -> io::Result<&'a [u8]> {
        match rustix::io::write(&self.fd, bytes) {
            Ok(written) => Ok(bytes.get(written..).unwrap_or_default()),
            Err(Errno::AGAIN | Errno::INTR) => Ok(bytes),
            Err(error) => Err(error.into()),
        }
    }

    /// Writes while the terminal has not changed hands, until `until` or as long as it takes. What does not fit by then
    /// is dropped, and so is the rest when the terminal is given back: it belongs to a screen that is no longer shown.
    fn write_ours(&self, hands: u32, bytes: &[u8], until: Option<Instant>) -> io::Result<()> {
        let mut rest = bytes;
        while !rest.is_empty() {
            {
                let _turn = self.turn.lock().unwrap_or_else(PoisonError::into_inner);
                if !is_ours(hands) || self.hands.load(Ordering::SeqCst) != hands {
                    return Ok(());
                }
                rest = self.written(rest)?;
            }
            let left = until.map(|until| until.saturating_duration_since(Instant::now()));
            if left.is_some_and(|left| left.is_zero()) {
                return Ok(());
            }
            if !rest.is_empty() {
                self.wait(PollFlags::OUT, left)?;
            }
        }
        Ok(())
    }

    /// Writes outside a frame, for at most `patience`; what does not fit by then is dropped.
    pub(super) fn send(&self, bytes: &[u8], patience: Duration) -> io::Result<()> {
        let until = Instant::now() + patience;
        let mut rest = bytes;
        loop {
            rest = self.written(rest)?;
            let left = until.saturating_duration_since(Instant::now());
            if rest.is_empty() || left.is_zero() {
                return Ok(());
            }
            self.wait(PollFlags::OUT, Some(left))?;
        }
    }

    pub(super) fn wait_for_hang_up(&self) -> io::Result<()> {
        // Hang-up and error are reported without being requested.
        while !self.wait(PollFlags::empty(), None)? {}
        Ok(())
    }

    /// Makes the event reader look at input that it has overlooked, if there is any.
    ///
    /// It is notified of input only when some arrives, and forgets the notification if the window is resized at the
    /// same moment, or if it has read one full buffer out of several: those keys would wait for the next one. Setting
    /// the modes, here to what they already are, makes the kernel notify it again.
    pub(super) fn remind_of_input(&self) {
        let waiting = poll(&mut [PollFd::new(&stdin(), PollFlags::IN)], Some(&Timespec::default()));
        if !matches!(waiting, Ok(1..)) {
            return;
        }
        let _turn = patient(&self.turn, PATIENCE);
        // In the background this would stop us.
        if self.is_taken()
            && self.in_foreground()
            && let Ok(modes) = tcgetattr(stdin())
        {
            let _ = tcsetattr(stdin(), OptionalActions::Now, &modes);
        }
    }

    pub(super) fn is_taken(&self) -> bool {
        is_ours(self.hands.load(Ordering::SeqCst))
    }

    /// Whether the terminal listens to our process group. Also true without job control.
    pub(super) fn in_foreground(&self) -> bool {
        tcgetpgrp(&self.fd).map_or(true, |foreground| foreground == getpgrp())
    }

    /// Waits until one of `flags`, or a hang-up, is reported; false if interrupted or out of time.
    fn wait(&self, flags: PollFlags, patience: Option<Duration>) -> io::Result<bool> {
        let patience = patience.and_then(|patience| Timespec::try_from(patience).ok());
        match poll(&mut [PollFd::new(&self.fd, flags)], patience.as_ref()) {
            Ok(ready) => Ok(ready > 0),
            Err(Errno::INTR) => Ok(false),
            Err(error) => Err(error.into()),
        }
    }
}

/// The lock; `None` after waiting `patience` for it. Nobody holds the turn to write longer than one non-blocking write
/// takes, unless the terminal could not be reopened.
fn patient(lock: &Mutex<()>, patience: Duration) -> Option<MutexGuard<'_, ()>> {
    let until = Instant::now() + patience;
    loop {
        match lock.try_lock() {
            Ok(held) => return Some(held),
            Err(TryLockError::Poisoned(held)) => return Some(held.into_inner()),
            Err(TryLockError::WouldBlock) if Instant::now() < until => {
                thread::sleep(Duration::from_millis(1));
            }
            Err(TryLockError::WouldBlock) => return None,
        }
    }
}

impl FrameSink for Tty {
    fn write_frame(&self, frame: &[u8]) -> io::Result<()> {
        self.write_ours(self.hands.load(Ordering::SeqCst), frame, None)
    }

    fn take_mouse(&self, wanted: bool) -> io::Result<()> {
        if self.mouse.swap(wanted, Ordering::SeqCst) == wanted {
            return Ok(());
        }
        self.write_frame(if wanted { MOUSE_ON } else { MOUSE_OFF })
    }

    fn size(&self) -> io::Result<(u16, u16)> {
        let size = tcgetwinsize(&self.fd)?;
        Ok(if (size.ws_col, size.ws_row) == (0, 0) { USUAL_SIZE } else { (size.ws_col, size.ws_row) })
    }
}

/// What a count of [`Tty::hands`] means.
fn is_ours(hands: u32) -> bool {
    !hands.is_multiple_of(2)
}

/// Another open file of the terminal on standard output.
fn reopen() -> io::Result<OwnedFd> {
    let flags = OFlags::RDWR | OFlags::NONBLOCK | OFlags::NOCTTY | OFlags::CLOEXEC;
    if let Ok(name) = ttyname(stdout(), Vec::new())
        && let Ok(fd) = open(name, flags, Mode::empty())
    {
        return Ok(fd);
    }
    // After `su` the terminal still belongs to somebody else; a process may always open its own controlling terminal.
    let controlling = matches!((tcgetsid(stdout()), getsid(None)), (Ok(theirs), Ok(ours)) if theirs == ours);
    if controlling && let Ok(fd) = open("/dev/tty", flags, Mode::empty()) {
        return Ok(fd);
    }
    // A blocking one: then only the timer of `end` protects against a terminal that nobody reads.
    stdout().as_fd().try_clone_to_owned()
}
