//! Frames, at a pace that the line can carry.
//!
//! A frame is written before the next one is begun, so at most one is on its way to the kernel. That alone is not
//! enough: a network connection accepts some hundred kilobytes before it makes anybody wait, and a slow line needs many
//! seconds to show them. So the pace also depends on the size of the frames.

use std::{
    collections::VecDeque,
    io,
    time::{Duration, Instant},
};

use crossterm::{Command, clipboard::CopyToClipboard};
use ratatui::{
    Frame, Terminal,
    backend::{Backend, ClearType},
};

use super::end::{HUNG_UP, end};
use super::screen::{FrameCost, Screen};
use super::sink::FrameSink;

/// How frames follow each other. The first one after a pause never waits.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pace {
    /// Shortest time between frames, above zero: 33 ms, about as fast as keys repeat.
    pub shortest: Duration,
    /// Bytes per second that any line is trusted to carry, above zero: 16 000, a poor mobile connection.
    pub rate: f64,
    /// Longest wait because of a frame's size: 150 ms, so that a change of the whole screen does not delay the next key.
    pub longest_for_size: Duration,
    /// The multiple of the time that the last write took, from 0: 2, so that the terminal has twice as long as it
    /// needed.
    pub write_factor: u32,
    /// Longest wait because of a slow write: 500 ms.
    pub longest_for_write: Duration,
}

impl Default for Pace {
    fn default() -> Self {
        Self {
            shortest: Duration::from_millis(33),
            rate: 16_000.0,
            longest_for_size: Duration::from_millis(150),
            write_factor: 2,
            longest_for_write: Duration::from_millis(500),
        }
    }
}

impl Pace {
    /// The wait from the end of a frame to the start of the next.
    fn gap(&self, written: FrameCost) -> Duration {
        if written.bytes == 0 {
            return Duration::ZERO;
        }
        let for_size = Duration::try_from_secs_f64(written.bytes as f64 / self.rate).unwrap_or(Duration::MAX);
        let for_write = written.took.saturating_mul(self.write_factor);
        self.shortest.max(for_size.min(self.longest_for_size)).max(for_write.min(self.longest_for_write))
    }
}

/// The shortest time between frames of a run: ten a second are seen as one motion.
const BETWEEN: Duration = Duration::from_millis(100);
/// The bytes that all frames of a run may have in any second: a quarter of a poor line, so that a key finds it free.
const SHARE: usize = 4000;
/// The time over which they are counted.
const SECOND: Duration = Duration::from_secs(1);

/// The frames of a run during the last second.
#[derive(Debug, Default)]
struct Allowance(VecDeque<(Instant, usize)>);

impl Allowance {
    /// Whether a frame of this many bytes may be written now: one larger than the whole share only after a silent
    /// second.
    fn allows(&mut self, now: Instant, bytes: usize) -> bool {
        while self.0.front().is_some_and(|(at, _)| now.duration_since(*at) >= SECOND) {
            self.0.pop_front();
        }
        let spent: usize = self.0.iter().map(|(_, bytes)| bytes).sum();
        spent == 0 || spent + bytes <= SHARE
    }

    fn take(&mut self, now: Instant, bytes: usize) {
        self.allows(now, 0);
        if bytes > 0 {
            self.0.push_back((now, bytes));
        }
    }
}

/// The screen to draw on.
pub struct Display<S: FrameSink + 'static> {
    terminal: Terminal<Screen<S>>,
    line: &'static S,
    pace: Pace,
    due: Instant,
    /// What the frames of a run have used of the line.
    spent: Allowance,
    /// When the next frame of a run may be tried.
    due_running: Instant,
}

impl<S: FrameSink> Display<S> {
    pub fn new(line: &'static S) -> io::Result<Self> {
        Self::paced(line, Pace::default())
    }

    pub fn paced(line: &'static S, pace: Pace) -> io::Result<Self> {
        Ok(Self {
            terminal: Terminal::new(Screen::new(line))?,
            line,
            pace,
            due: Instant::now(),
            spent: Allowance::default(),
            due_running: Instant::now(),
        })
    }

    /// Draws a frame and writes what has changed, in one write; nothing if nothing has.
    ///
    /// Inside `render`, only the frame's own area counts: the window may have another size by then. Returns once
    /// the terminal has taken the bytes; if it has gone away, the program ends here. A frame drawn before it is due
    /// adds the rest of its wait to that of the next one: the line has to carry both.
    pub fn draw(&mut self, render: impl FnOnce(&mut Frame<'_>)) {
        if self.terminal.draw(render).is_err() {
            end(HUNG_UP);
        }
        self.written();
    }

    fn written(&mut self) {
        let last = self.terminal.backend().last_written();
        self.due = self.due.max(Instant::now()) + self.pace.gap(last);
    }

    /// Draws a frame of a run, as [`draw`](Self::draw) does, if the line's share is not used up; otherwise draws
    /// nothing and returns false.
    pub fn draw_running(&mut self, render: impl FnOnce(&mut Frame<'_>)) -> bool {
        self.due_running = Instant::now() + BETWEEN;
        let encoded = self.terminal.autoresize().and_then(|()| {
            render(&mut self.terminal.get_frame());
            self.terminal.flush()
        });
        if encoded.is_err() {
            end(HUNG_UP);
        }
        if !self.spent.allows(Instant::now(), self.terminal.backend().pending()) {
            self.terminal.backend_mut().forget();
            // The next frame starts from an empty one, and is compared with what the terminal shows.
            self.terminal.current_buffer_mut().reset();
            return false;
        }
        self.terminal.swap_buffers();
        if Backend::flush(self.terminal.backend_mut()).is_err() {
            end(HUNG_UP);
        }
        self.spent.take(Instant::now(), self.terminal.backend().last_written().bytes);
        self.written();
        true
    }

    /// When the next frame of a run may be tried.
    pub fn due_running(&self) -> Instant {
        self.due.max(self.due_running)
    }

    /// When the next frame may be drawn.
    pub fn due(&self) -> Instant {
        self.due
    }

    /// Takes the mouse from the terminal, or leaves it to it.
    pub fn take_mouse(&mut self, wanted: bool) {
        if self.line.take_mouse(wanted).is_err() {
            end(HUNG_UP);
        }
    }

    /// Puts text into the clipboard of the person's terminal, if it accepts it (OSC 52).
    pub fn copy(&mut self, text: &str) {
        let mut sequence = String::new();
        // Writing to a string cannot fail.
        let _ = CopyToClipboard::to_clipboard_from(text).write_ansi(&mut sequence);
        if self.line.write_frame(sequence.as_bytes()).is_err() {
            end(HUNG_UP);
        }
    }

    /// Makes the next frame draw everything, whatever the terminal shows now.
    ///
    /// Needed after a stop and after any resize: a window that shrank and grew back between two frames has its old size
    /// but has lost what it showed.
    pub fn repaint(&mut self) {
        // Not the terminal's own `clear`, which asks for the cursor's position.
        if self.terminal.backend_mut().clear_region(ClearType::All).is_err() {
            end(HUNG_UP);
        }
        // Blanks the buffer with which the next frame is compared.
        self.terminal.swap_buffers();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_frames_follow_at_thirty_per_second_and_large_ones_at_the_rate() {
        let pace = Pace::default();
        let gap = |bytes, took| pace.gap(FrameCost { bytes, took: Duration::from_millis(took) }).as_millis();
        assert_eq!(gap(0, 0), 0);
        assert_eq!(gap(200, 0), 33);
        assert_eq!(gap(1600, 0), 100);
        assert_eq!(gap(100_000, 0), 150);
        assert_eq!(gap(200, 100), 200);
        assert_eq!(gap(200, 60_000), 500);
    }

    #[test]
    fn frames_of_a_run_keep_within_their_share_of_every_second() {
        let mut allowance = Allowance::default();
        let begun = Instant::now();
        let mut written: Vec<(u128, usize)> = Vec::new();
        // Ten attempts per second for a minute, with sizes that recur after a while.
        for k in 0..600_u32 {
            let (now, bytes) = (begun + k * BETWEEN, 150 + (k as usize * 977) % 3700);
            if allowance.allows(now, bytes) {
                allowance.take(now, bytes);
                written.push(((k * BETWEEN).as_millis(), bytes));
            }
        }
        for (at, _) in &written {
            let within = written.iter().filter(|(other, _)| other >= at && *other < at + 1000);
            assert!(within.map(|(_, bytes)| bytes).sum::<usize>() <= SHARE);
        }
        assert!(written.len() > 60, "{} frames", written.len());
        // A frame too large for any second is written once nothing else has been.
        let later = begun + Duration::from_secs(100);
        assert!(allowance.allows(later, 9000));
        allowance.take(later, 9000);
        assert!(!allowance.allows(later + SECOND / 2, 1) && allowance.allows(later + SECOND, 1));
    }
}
