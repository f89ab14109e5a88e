//! Shared by the tests. Each binary uses a part of it.
#![allow(
    dead_code,
    unused_imports,
    clippy::unwrap_used,
    clippy::panic,
    clippy::float_cmp,
    clippy::items_after_statements,
    clippy::maybe_infinite_iter,
    clippy::too_many_lines,
    reason = "each binary uses a part of it, a helper fails a test by panicking, and the judges are written as their formulas are"
)]

pub mod home;
pub mod hostile;
pub mod presets;
pub mod problems;
pub mod pty;
pub mod quadrature;
pub mod schema;
pub mod session;
pub mod sshd;
