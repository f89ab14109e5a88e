//! Presets: one problem, its basis and its path, as a TOML file a person can read and edit.
//!
//! Everything that knows the keys (reader, writer, `--set`, the screen's knobs, the manual's key table) reads
//! the one table in [`schema`].
//!
//! | file | what lives there |
//! |---|---|
//! | [`schema`] | the table of parameters: one row per dotted key |
//! | [`value`] | one parameter's value, checked against its row |
//! | [`invalid`] | what can be wrong with a value or a key |
//! | [`model`] | the preset itself, read and changed by dotted key |
//! | [`build`](mod@build) | values → preset: defaults, required keys, checks across keys |
//! | `resolve` | the units of a preset, and its texts with units as numbers in them |
//! | `shape` | the values of `[gap]` → the gap's shape, and back |
//! | [`read`](mod@read) | TOML text and `--set` assignments → preset, each mistake with its line |
//! | [`write`](mod@write) | preset → TOML text |
//! | [`edit`] | a preset laid over the text it was read from, comments and order kept |
//! | [`changes`] | what turns one preset into another, as assignments |
//! | [`manual`] | the key table as text for the manual |
//! | [`shipped`] | the presets that come with the program |
//! | [`name`] | which names a person's preset may have |
//! | [`family`] | rows by the form of their keys: a formula's parameters, waves |
//! | `former` | keys and words of before, and what to write for them |
//! | [`groups`] | the dimensionless groups as values to set |
//! | [`measured`] | the file of a measured profile → rows of a gap |
//! | [`file`](mod@file) | reading regular files of bounded size; fingerprints |
//! | [`stream`] | standard input and output, pipes and devices, which are read and written straight |
//! | [`beside`] | the data of a profile copied beside a preset |
//! | [`profile`] | reading a measured profile: two columns, each fault with its line |
//! | [`atomic`] | writing a file whole or not at all |
//! | [`temporary`] | the temporary file of a save, and what a killed save has left |
//! | [`lock`] | one saver at a time in a folder |
//! | [`store`] | the folder of a person's presets: resolve, load, list, save |
//! | [`text`] | foreign text made safe to show |
//! | [`suggest`] | "did you mean" |

pub mod atomic;
pub mod beside;
pub mod build;
pub mod changes;
pub mod edit;
#[cfg(test)]
mod examples;
pub mod family;
pub mod file;
pub(crate) mod former;
pub mod groups;
pub mod invalid;
pub mod lock;
pub mod manual;
pub mod measured;
pub mod model;
pub mod name;
pub mod profile;
pub mod read;
mod resolve;
pub mod schema;
mod shape;
pub mod shipped;
pub mod store;
pub mod stream;
pub mod suggest;
pub mod temporary;
pub mod text;
pub mod value;
pub mod write;

pub use atomic::{Overwrite, WriteError, write_atomically};
pub use file::Fingerprint;
pub use invalid::Invalid;
pub use model::{BasisSpec, Material, PathSpec, Preset};
pub use read::{Mistake, Origin, ReadError, read, read_with};
pub use schema::{Key, PARAMETERS, Parameter, Row, parameter};
pub use shipped::SHIPPED;
pub use store::{Listed, Listing, Loaded, Source, Store, StoreError};
pub use value::Value;
pub use write::write;
