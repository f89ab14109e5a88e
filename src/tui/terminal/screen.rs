//! The ratatui backend: a frame is one write, an unchanged frame is none, and the terminal is never asked anything.
//!
//! Answers arrive as input, late on a slow link, and only the input thread reads; so the cursor's position is
//! remembered instead. Nothing here fails: a terminal that cannot be written to has gone away, which ends the program
//! on the spot, before ratatui could panic over it.

use std::{
    io,
    time::{Duration, Instant},
};

use crossterm::{
    Command,
    cursor::MoveTo,
    terminal::{self, Clear},
};
use ratatui::{
    backend::{Backend, ClearType, WindowSize},
    buffer::Cell,
    layout::{Position, Size},
};

use super::cell_encoder::encode;
use super::end::{HUNG_UP, end};
use super::sink::FrameSink;

/// The terminal as ratatui sees it.
pub struct Screen<S: FrameSink + 'static> {
    line: &'static S,
    frame: Vec<u8>,
    cursor_shown: Option<bool>,
    /// Where the cursor was put, if nothing has been drawn since.
    cursor_at: Option<Position>,
    last: FrameCost,
}

/// What the last frame cost.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct FrameCost {
    pub(super) bytes: usize,
    pub(super) took: Duration,
}

impl<S: FrameSink> Screen<S> {
    pub(super) fn new(line: &'static S) -> Self {
        Self { line, frame: Vec::new(), cursor_shown: None, cursor_at: None, last: FrameCost::default() }
    }

    pub(super) fn last_written(&self) -> FrameCost {
        self.last
    }

    /// The bytes collected for the next frame.
    pub(super) fn pending(&self) -> usize {
        self.frame.len()
    }

    /// Forgets what was collected: the terminal still shows what it showed before.
    pub(super) fn forget(&mut self) {
        self.frame.clear();
    }

    fn collect(&mut self, command: impl Command) {
        self.cursor_at = None;
        let mut text = String::new();
        // Writing to a string cannot fail.
        let _ = command.write_ansi(&mut text);
        self.frame.extend_from_slice(text.as_bytes());
    }

    fn show(&mut self, shown: bool) {
        if self.cursor_shown.replace(shown) != Some(shown) {
            self.frame.extend_from_slice(if shown { b"\x1b[?25h" } else { b"\x1b[?25l" });
        }
    }
}

impl<S: FrameSink> Backend for Screen<S> {
    type Error = io::Error;

    fn draw<'a, I>(&mut self, content: I) -> io::Result<()>
    where
        I: Iterator<Item = (u16, u16, &'a Cell)>,
    {
        let cells: Vec<_> = content.map(|(x, y, cell)| (Position::new(x, y), cell)).collect();
        if !cells.is_empty() {
            self.cursor_at = None;
            self.frame.extend(encode(&cells, self.size()?.width));
        }
        Ok(())
    }

    fn hide_cursor(&mut self) -> io::Result<()> {
        self.show(false);
        Ok(())
    }

    fn show_cursor(&mut self) -> io::Result<()> {
        self.show(true);
        Ok(())
    }

    fn get_cursor_position(&mut self) -> io::Result<Position> {
        Ok(self.cursor_at.unwrap_or(Position::ORIGIN))
    }

    fn set_cursor_position<P: Into<Position>>(&mut self, position: P) -> io::Result<()> {
        let position = position.into();
        if self.cursor_at != Some(position) {
            self.collect(MoveTo(position.x, position.y));
            self.cursor_at = Some(position);
        }
        Ok(())
    }

    fn clear(&mut self) -> io::Result<()> {
        self.clear_region(ClearType::All)
    }

    fn clear_region(&mut self, clear_type: ClearType) -> io::Result<()> {
        // After a stop the modes were set anew, and nothing is known about the cursor.
        self.cursor_shown = None;
        self.collect(Clear(match clear_type {
            ClearType::All => terminal::ClearType::All,
            ClearType::AfterCursor => terminal::ClearType::FromCursorDown,
            ClearType::BeforeCursor => terminal::ClearType::FromCursorUp,
            ClearType::CurrentLine => terminal::ClearType::CurrentLine,
            ClearType::UntilNewLine => terminal::ClearType::UntilNewLine,
        }));
        Ok(())
    }

    fn size(&self) -> io::Result<Size> {
        let (columns, rows) = self.line.size().unwrap_or_else(|_| end(HUNG_UP));
        Ok(Size::new(columns, rows))
    }

    fn window_size(&mut self) -> io::Result<WindowSize> {
        Ok(WindowSize { columns_rows: self.size()?, pixels: Size::ZERO })
    }

    fn flush(&mut self) -> io::Result<()> {
        let start = Instant::now();
        if self.line.write_frame(&self.frame).is_err() {
            end(HUNG_UP);
        }
        self.last = FrameCost { bytes: self.frame.len(), took: start.elapsed() };
        self.frame.clear();
        Ok(())
    }
}
