//! The terminal layer: taking the terminal, giving it back, and one queue of everything that happens.
//!
//! | file | what it holds |
//! |---|---|
//! | `refuse` | whether there is a terminal to draw on at all |
//! | `tty` | the terminal itself: its modes, the string that undoes them, writing without being stuck |
//! | `sink` | where frames go |
//! | `guard` | [`enter`]: takes the terminal, starts the threads, gives it back when dropped |
//! | `end` | the one way out for signals, hang-ups and panics |
//! | `report` | the file that a panic leaves behind |
//! | `signals` | ending, stopping, continuing and resizing on signals |
//! | `hangup` | notices that the terminal has gone away |
//! | `input` | the [`Inbox`]: keys, pastes, sizes and the program's own messages in one queue |
//! | `screen` | the ratatui backend: a frame is one write, nothing is asked of the terminal |
//! | `cell_encoder` | cells encoded in as few bytes as a terminal needs |
//! | `display` | [`Display`]: frames at a pace the line can carry |
//!
//! # Threads
//!
//! The caller's thread draws. Beside it: `input` (the only reader of the terminal), `signals`, `hang-up`; all three
//! sleep in the kernel until something happens. Any thread that learns that the program must end calls `end`; it never
//! asks the drawing thread, which may be waiting for a terminal that nobody reads.
//!
//! # A main loop
//!
//! ```no_run
//! use pulloff::tui::terminal::{self, Incoming};
//!
//! if let Some(reason) = terminal::refuse_reason() {
//!     eprintln!("{reason}");
//!     std::process::exit(2);
//! }
//! let (guard, mut display, inbox) = terminal::enter::<String>()?;
//! let mut dirty = true;
//! let mut running = true;
//! while running {
//!     // Unchanged: wait for as long as it takes. Changed: only until the next frame is due.
//!     let first = inbox.next(dirty.then(|| display.due()));
//!     for message in first.into_iter().chain(inbox.pending()) {
//!         match message {
//!             Incoming::Key(key) => running = key.code != terminal::KeyCode::Char('q'),
//!             Incoming::Resized | Incoming::Resumed => display.repaint(),
//!             Incoming::Mouse(_) | Incoming::Paste(_) | Incoming::App(_) => {}
//!         }
//!         dirty = true;
//!     }
//!     if dirty && std::time::Instant::now() >= display.due() {
//!         display.draw(|frame| frame.render_widget("q quits", frame.area()));
//!         dirty = false;
//!     }
//! }
//! drop(guard);
//! # Ok::<(), std::io::Error>(())
//! ```

mod cell_encoder;
mod display;
mod end;
mod guard;
mod hangup;
mod input;
mod refuse;
mod report;
mod screen;
mod signals;
mod sink;
mod tty;

pub use crossterm::event::{KeyCode, KeyEvent, KeyModifiers, MouseButton, MouseEvent, MouseEventKind};
pub use display::{Display, Pace};
pub use end::set_last_words;
pub use guard::{Guard, enter, restore};
pub use input::{Inbox, Incoming, Sender};
pub use refuse::{refuse_reason, utf8_locale};
pub use screen::Screen;
pub use signals::suspend;
pub use sink::FrameSink;
