//! Words in messages: foreign text made safe to show, and names that may have been meant.

mod headline;
mod quote;
mod suggest;

pub use headline::headline;
pub use quote::{greek, is_unsafe, quote, sanitize, show_name, show_path};
pub use suggest::{closest, closest_key};
