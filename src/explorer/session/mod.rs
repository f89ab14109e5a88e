//! A session as a document: what is kept so that nothing is lost if a connection drops.
//!
//! ```text
//! Model ──► Snapshot ──► document ──► Snapshot ──► Model
//! ```
//!
//! A [`Snapshot`] is what a person made: the current and the saved preset, the walk with all its branches, the pins,
//! and how all of it is displayed. What follows from that (curves, profiles) is not kept and is computed again. Making
//! one takes no time however long the walk, so whatever ends the program always finds the newest one.
//!
//! Everything comes back bit for bit, and a walk continues as if it had never been interrupted.
//!
//! | file | what lives there |
//! |---|---|
//! | [`snapshot`] | what is kept of a model, and the model restored from it |
//! | [`document`] | the same as JSON |
//! | `problems` | the presets and settings of a document, each stored once |
//! | `tree` | the nodes of the walk |
//! | `places` | what undo goes back to |
//! | `aside` | what presets take from files |
//! | `unreadable` | why a session cannot be read |
//!
//! Nothing here touches a file; [`archive`](super::archive) does.

mod aside;
pub mod document;
mod places;
mod problems;
pub mod snapshot;
mod tree;
mod unreadable;

pub use aside::{Aside, SavedFile};
pub use document::{Document, Ended, SessionSummary, summary};
pub use snapshot::Snapshot;
pub use unreadable::{FORMAT, Unreadable};
