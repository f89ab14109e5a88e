//! Where frames go: the terminal, or a test's stand-in.

use std::io;

/// Where frames go.
pub trait FrameSink {
    /// Writes a whole frame, waiting for room as long as it takes.
    fn write_frame(&self, frame: &[u8]) -> io::Result<()>;

    /// Takes the mouse from the terminal, or leaves it to the terminal, now and whenever the terminal is taken again.
    fn take_mouse(&self, wanted: bool) -> io::Result<()>;

    /// Columns and rows.
    fn size(&self) -> io::Result<(u16, u16)>;
}
