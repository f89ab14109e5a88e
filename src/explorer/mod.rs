//! The explorer without a terminal: a pure state machine and the drivers that run its effects.
//!
//! ```text
//! Command | Reply ──► update(model) ──► effects ──► driver ──► Reply …
//! ```
//!
//! | file | what lives there |
//! |---|---|
//! | [`command`] | the one table of commands |
//! | [`model`] | the state of a session |
//! | [`update`](mod@update) | the only code that changes the model; it never solves and never reads a file |
//! | [`nudge`] | a parameter changed by a little |
//! | [`history`] | the walk as an append-only tree |
//! | [`curve`] | the background curve: the sweep of the problem, and what belongs to the control |
//! | [`device`] | the line of the loading device through the walker |
//! | [`walk`] | steps, runs and jumps along the curve |
//! | [`files`] | opening, saving and exporting |
//! | [`driver`] | effects run inline (tests, scripts) or on worker threads (the screen) |
//!
//! Nothing here knows terminals, keys or colours.

pub mod command;
pub mod curve;
pub mod device;
pub mod driver;
pub mod files;
pub mod history;
pub mod model;
pub mod nudge;
pub mod update;
pub mod walk;

pub use command::{Command, Id};
pub use curve::{CurveData, Sweep};
pub use driver::{Effect, Inline, Reply, Wish, Workers};
pub use history::{History, Node, NodeKind};
pub use model::{Axes, Chart, EventSource, Level, Model, Panel};
pub use update::{answer, open, update};
