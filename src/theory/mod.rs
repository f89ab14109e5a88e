//! Closed forms, independent of the Ritz code: used by tests and by the screen alike.
//!
//! | file | what lives there |
//! |---|---|
//! | [`hertz`] | a smooth sphere without adhesion, eq. (21) |
//! | [`jkr`] | a smooth sphere with adhesion, eq. (22) with its misprints corrected |
//!
//! Any consistent units.

pub mod hertz;
pub mod jkr;
