//! Fits of made curves compared with the truth: every value is right, or is said not to be trusted.
//!
//! The generators share no code with the engine: `bodies` has closed forms, `device` what a device sees of them,
//! `record` the faults of an instrument and the text of its file, `kinds` the kinds of curves.
//!
//! `cargo test -p pulloff-engine --test fit_campaign` tries a few seeds of each kind. For a thousand seeds of each of
//! eleven kinds, and a hundred of each of the others:
//!
//! ```text
//! cargo test --release -p pulloff-engine --test fit_campaign -- --ignored --nocapture
//! ```
//!
//! `PULLOFF_CAMPAIGN=17..18` before that line runs only those seeds, `PULLOFF_KIND=tilt` only one kind,
//! `PULLOFF_FINDINGS=FOLDER` keeps the curves that are judged wrongly, each with the command that fits it, and
//! `PULLOFF_SAID=1` prints what is said by fits that are doubted or whose interval does not hold the truth.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a helper of a test fails the test by panicking")]
#![allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "small counts")]
#![allow(clippy::float_cmp, reason = "what is 0 was set to it")]
#![allow(
    clippy::disallowed_methods,
    reason = "no code is shared with the engine, its elementary functions neither"
)]

mod bodies;
mod campaign;
mod device;
mod directions;
mod kinds;
mod minima;
mod models;
mod record;
mod rows;
mod trial;
