//! Presets: one problem, its basis and its path, as a TOML file that a user can read and edit.
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
//! | `values` | values by dotted key, and the words of choices among them |
//! | `given` | values read one by one, with what is wrong with each |
//! | [`build`](mod@build) | values → preset: defaults, required keys, checks across keys |
//! | `resolve` | the units of a preset, and its texts with units converted to numbers in them |
//! | [`shipped`] | the presets that come with the program, and their data |
//! | `shape` | the values of `[gap]` → the gap's shape, and back |
//! | [`read`](mod@read) | TOML text and `--set` assignments → preset; each mistake with its line |
//! | [`write`](mod@write) | preset → TOML text |
//! | [`edge`] | how an edge moves: the keys of `[edge]` and of rates |
//! | `steps` | the table `[edge]` as it is read, and the parts of a test |
//! | [`edit`] | a preset laid over the text it was read from, comments and order kept |
//! | [`called`] | keys by their short names |
//! | [`changes`] | what turns one preset into another, as assignments |
//! | [`manual`] | the key table as text for the manual |
//! | [`family`] | rows by the form of their keys: a formula's parameters, waves |
//! | [`rows`] | any row by its dotted key |
//! | [`groups`] | the dimensionless groups as values to set |
//! | [`measured`] | the columns of a measured profile → rows of a gap; where they come from |
//! | [`data`], `attached` | what the table `[data]` holds: a measured curve; how it is read, and its points |
//! | [`profile`] | reading a measured profile: two columns, each fault with its line |

mod attached;
pub mod build;
pub mod called;
pub mod changes;
pub mod data;
pub mod edge;
pub mod edit;
pub mod family;
#[cfg(test)]
mod fixtures;
mod given;
pub mod groups;
pub mod invalid;
pub mod manual;
pub mod measured;
pub mod model;
pub mod profile;
pub mod read;
mod resolve;
pub mod rows;
pub mod schema;
pub mod shape;
pub mod shipped;
mod steps;
pub mod value;
pub mod values;
pub mod write;

pub(crate) use attached::OtherReading;
pub use edge::EdgeSpec;
pub use invalid::Invalid;
pub use measured::Files;
pub use model::{BasisSpec, Material, PathSpec, Preset};
pub use read::{Mistake, ReadError, ValueOrigin, read, read_in, read_shipped, read_with};
pub use rows::parameter;
pub use schema::{Key, PARAMETERS, Parameter, Row};
pub use value::Value;
pub use write::write;
