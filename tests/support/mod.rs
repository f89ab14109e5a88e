//! What the tests share. Each binary uses a part of it.
#![allow(
    dead_code,
    unused_imports,
    clippy::unwrap_used,
    clippy::panic,
    reason = "each binary uses a part of it, and a helper fails a test by panicking"
)]

pub mod home;
pub mod hostile;
pub mod problems;
pub mod pty;
pub mod quadrature;
pub mod schema;
pub mod session;
pub mod sshd;
