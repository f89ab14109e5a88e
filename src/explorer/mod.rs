//! The explorer without a terminal: a pure state machine and the drivers that run its effects.
//!
//! ```text
//! Command | Reply ──► update(model) ──► effects ──► driver ──► Reply …
//! ```
//!
//! | file | what lives there |
//! |---|---|
//! | [`command`], [`table`] | the commands; the table of what is known of each |
//! | [`availability`] | what a command requires before it can be run |
//! | [`model`] | the state of a session |
//! | [`update`](mod@update) | the only code that changes the model; it never solves and never reads a file |
//! | [`effect`] | the work that the model asks for, and the replies |
//! | [`requests`] | the effects that several commands request |
//! | [`status_line`] | what the status line says |
//! | [`view`] | panels, views, windows, overlays |
//! | [`look`] | the commands that change them |
//! | [`log`] | what happens on the path: done, here, ahead |
//! | [`reach`] | which views have something to show, and why the others have nothing |
//! | [`pins`] | curves kept for comparison with later ones |
//! | [`theory`] | closed forms drawn over a curve |
//! | [`nudge`] | a parameter changed by a small amount |
//! | [`setting`], [`node`], [`history`] | the walk: the problem of a state, a state, and the tree of all states |
//! | [`undo`] | where the session stood before each command |
//! | [`branches`] | the branches of the walk, and what each ended with |
//! | `prune` | which states of a long walk may be forgotten |
//! | [`curve`] | the equilibrium curve of a problem, and what belongs to its control |
//! | [`progress`] | how far the computation of a curve has come |
//! | [`background`], [`backgrounds`], [`results`] | results computed in the background; the list of them; what there is |
//! | [`admissibility`], `pinned` | which states of the curve are admissible; the curves of pins |
//! | [`loops`] | the loop of loading and unloading with rings of contact |
//! | [`pulls`] | the pull at the rate of the preset |
//! | [`onset`] | the smallest amplitude at which a problem snaps |
//! | [`maps`], [`map_axes`], [`studies`], [`study`], `study_table` | a map of two numbers, its axes; a study, its documents |
//! | [`fitting`], `fit` | the distances of measured points; a fit |
//! | [`speeds`] | G of measured rows, and the speed of the edge there |
//! | [`device`] | the line of the loading device through the walker |
//! | [`profile`] | pressure, gap and potential of one state |
//! | [`walk`] | steps, runs and jumps along the curve |
//! | `watch` | the pace of a run, and its end |
//! | [`export`], [`job`], [`files`], [`walk_table`] | opening, saving and exporting |
//! | [`data`] | the profiles of a folder, to choose from |
//! | [`follow`] | edges of rings, followed through a change of the problem |
//! | `saves` | saves that follow each other faster than they are answered |
//! | [`session`] | a session as a document, to be resumed |
//! | [`archive`] | the sessions on disk |
//! | [`journal`] | how each state came about, as the lines of a script |
//! | [`script`] | commands as text, and scripts run on a model |
//! | [`driver`] | runs effects inline (tests, scripts) or on worker threads (the screen) |
//!
//! Nothing here knows terminals, keys or colours.

pub mod admissibility;
pub mod archive;
pub mod availability;
pub mod background;
pub mod backgrounds;
pub mod branches;
pub mod command;
pub mod curve;
pub mod data;
pub mod device;
pub mod driver;
pub mod effect;
pub mod export;
pub mod files;
pub mod fit;
pub mod fitting;
pub mod follow;
pub mod history;
pub mod job;
pub mod journal;
pub mod log;
pub mod look;
pub mod loops;
pub mod map_axes;
pub mod maps;
pub mod model;
pub mod node;
pub mod nudge;
pub mod onset;
pub mod pinned;
pub mod pins;
pub mod profile;
pub mod progress;
mod prune;
pub mod pulls;
pub mod reach;
pub mod requests;
pub mod results;
mod saves;
pub mod script;
pub mod session;
pub mod setting;
pub mod speeds;
pub mod status_line;
pub mod studies;
pub mod study;
mod study_table;
pub mod table;
pub mod theory;
pub mod undo;
pub mod update;
pub mod view;
pub mod walk;
pub mod walk_table;
mod watch;

pub use command::{Command, Id};
pub use curve::{CurveData, Inadmissible, ProblemCurve};
pub use driver::{Inline, Workers};
pub use effect::{Effect, Reply, Wish};
pub use history::History;
pub use journal::Journal;
pub use model::{Level, Model};
pub use node::{Node, NodeKind};
pub use progress::{CurveStage, Staged};
pub use update::{answer, open, update};
pub use view::{Axes, Home, Overlay, Overlays, ScreenPanel, View, Window};
