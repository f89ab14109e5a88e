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
//! | [`view`] | the views, their windows, the overlays: what is shown of curve and walker |
//! | [`look`] | the commands that change it |
//! | [`pins`] | curves kept to compare the next ones with |
//! | [`theory`] | the theory drawn over a curve, computed with it |
//! | [`nudge`] | a parameter changed by a little |
//! | [`history`] | the walk as an append-only tree |
//! | [`beside`] | what is under way beside the curve and the walk |
//! | [`branches`] | its branches: what each ended with |
//! | `thin` | which states of a long walk may be forgotten |
//! | [`curve`] | the background curve: the sweep of the problem, and what belongs to the control |
//! | [`progress`] | how far a curve that is computed has come |
//! | [`data`] | the profiles of a folder, to choose from |
//! | [`device`] | the line of the loading device through the walker |
//! | [`profile`] | the inside of one state: pressure, gap, potential |
//! | [`walk`] | steps, runs and jumps along the curve |
//! | [`files`] | opening, saving and exporting |
//! | [`session`] | a session as a document, to be resumed |
//! | [`archive`] | the sessions kept on disk |
//! | `saves` | saves that follow each other faster than they are answered |
//! | [`journal`] | what was done, as the lines of a script |
//! | [`script`] | commands as text, and scripts driven through a model |
//! | [`driver`] | effects run inline (tests, scripts) or on worker threads (the screen) |
//!
//! Nothing here knows terminals, keys or colours.

pub mod archive;
pub mod beside;
pub mod branches;
pub mod command;
pub mod curve;
pub mod data;
pub mod device;
pub mod driver;
pub mod files;
pub mod history;
pub mod journal;
pub mod look;
pub mod model;
pub mod nudge;
pub mod pins;
pub mod profile;
pub mod progress;
mod saves;
pub mod script;
pub mod session;
pub mod theory;
mod thin;
pub mod update;
pub mod view;
pub mod walk;

pub use command::{Command, Id};
pub use curve::{CurveData, Inadmissible, Sweep};
pub use driver::{Check, Effect, Inline, Reply, Wish, Workers};
pub use history::{History, Node, NodeKind};
pub use journal::Journal;
pub use model::{Axes, EventSource, Level, Model, Panel};
pub use progress::Progress;
pub use update::{answer, open, update};
pub use view::{Overlay, Overlays, View, Window};
