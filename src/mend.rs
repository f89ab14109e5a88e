//! Whether the user can mend an error: exit status 2, otherwise 1.
//!
//! The user can mend a bad value, a bad option, a path that leads nowhere or must not be written, or a file that
//! already exists, but not a full disk, a computation that ends early, or a fault in the program. Each error type says
//! which it is, so that it has the same status in every command and in scripts.

use pulloff_engine::case::CaseError;
use pulloff_engine::report::map::MapError;
use pulloff_engine::report::pull::PullError;
use rustix::io::Errno;
use std::fmt;
use std::io::{self, ErrorKind};

/// A fault that the user may be able to mend.
pub trait Mend {
    /// Whether other values, options, paths or permissions mend it.
    fn can_be_mended(&self) -> bool;
}

/// Implements [`Mend`] for a type of errors: those of the variants after `of` can be mended if the fault in their
/// field can be, those of the variants after `never` cannot, those after `always` can. Every variant is named.
macro_rules! mend {
    (
        $error:ty $(, as $field:tt of $($variant:ident)|+)*
        $(, never $($never:ident)|+)? $(, always $($always:ident)|+)?
    ) => {
        impl $crate::mend::Mend for $error {
            fn can_be_mended(&self) -> bool {
                match self {
                    $($(Self::$variant { $field: fault, .. } => $crate::mend::Mend::can_be_mended(fault),)+)*
                    $($(Self::$never { .. })|+ => false,)?
                    $($(Self::$always { .. })|+ => true,)?
                }
            }
        }
    };
}

pub(crate) use mend;

/// A fault in words.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct WordedFault {
    /// The words.
    pub text: String,
    /// As [`Mend::can_be_mended`].
    pub can_be_mended: bool,
}

impl WordedFault {
    /// A fault that the user can mend.
    pub fn mendable(text: impl Into<String>) -> Self {
        Self { text: text.into(), can_be_mended: true }
    }

    /// The text of `error`, preceded by `before`.
    pub fn of(before: &str, error: &(impl Mend + fmt::Display)) -> Self {
        Self { text: format!("{before}{error}"), can_be_mended: error.can_be_mended() }
    }
}

impl fmt::Display for WordedFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

impl Mend for WordedFault {
    fn can_be_mended(&self) -> bool {
        self.can_be_mended
    }
}

impl Mend for io::Error {
    /// The user can choose another path, or grant the permission that it lacks.
    fn can_be_mended(&self) -> bool {
        let is_of_path = matches!(
            self.kind(),
            ErrorKind::NotFound
                | ErrorKind::AlreadyExists
                | ErrorKind::PermissionDenied
                | ErrorKind::IsADirectory
                | ErrorKind::NotADirectory
                | ErrorKind::InvalidFilename
                | ErrorKind::InvalidInput
                | ErrorKind::ReadOnlyFilesystem
                | ErrorKind::TooManyLinks
        );
        is_of_path || self.raw_os_error() == Some(Errno::LOOP.raw_os_error())
    }
}

impl Mend for CaseError {
    /// An impossible start or end is a bad value; computing from good ones may still fail.
    fn can_be_mended(&self) -> bool {
        match self {
            Self::Stopped(_) => false,
            Self::Path { error, .. } => error.is_of_values(),
            _ => true,
        }
    }
}

// A law, a rate and an axis are values.
mend!(PullError, as 0 of Case, never Rate, always NoLaw | NoRate);
mend!(MapError, as 0 of Case, never Stopped, always Family);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_are_mended_and_full_disks_are_not() {
        let of = |errno: Errno| io::Error::from(errno).can_be_mended();
        for errno in [
            Errno::NOENT,
            Errno::ACCESS,
            Errno::PERM,
            Errno::ISDIR,
            Errno::NOTDIR,
            Errno::NAMETOOLONG,
            Errno::ROFS,
            Errno::LOOP,
            Errno::EXIST,
        ] {
            assert!(of(errno), "{errno}");
        }
        for errno in [Errno::NOSPC, Errno::FBIG, Errno::DQUOT, Errno::IO, Errno::NOMEM, Errno::BADF] {
            assert!(!of(errno), "{errno}");
        }
    }
}
