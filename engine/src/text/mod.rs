//! Foreign text: read from bytes, and made safe to show in messages; also the names that were probably meant.

mod decode;
mod headline;
mod quote;
mod suggest;

pub use decode::{NotText, decode};
pub use headline::headline;
pub use quote::{counted, greek, is_unsafe, listed, quote, sanitize, show_name, show_path};
pub use suggest::{closest, closest_key};
