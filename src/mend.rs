//! Whether a fault is one that the person can mend, or one in which something failed: the two exit statuses 2 and 1.
//!
//! The person can mend a bad value, a bad option, a path that leads nowhere or must not be written, a file that is there
//! already. A full disk, a computation that ends early, a fault of the program are for nobody to mend by other words. One
//! place says which is which, so that the same fault has the same status in every command and in scripts.

use crate::explorer::archive::ArchiveError;
use crate::plot::map::MapError;
use crate::print::{DrawError, FormatError};
use crate::store::beside::DataError;
use crate::store::file::FileError;
use crate::store::{StoreError, WriteError};
use crate::sweep::OutputError;
use crate::sweep::merge::MergeError;
use crate::sweep::results::ResultsError;
use crate::sweep::side::SideError;
use crate::sweep::spec::LoadError;
use pulloff_engine::case::CaseError;
use rustix::io::Errno;
use std::fmt;
use std::io::{self, ErrorKind};

/// A fault that somebody may be able to mend.
pub trait Mend {
    /// Whether other values, options, paths or permissions mend it.
    fn can_be_mended(&self) -> bool;
}

/// A fault in words.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Reason {
    /// The words.
    pub text: String,
    /// As [`Mend::can_be_mended`].
    pub can_be_mended: bool,
}

impl Reason {
    /// What the person can mend.
    pub fn mendable(text: impl Into<String>) -> Self {
        Self { text: text.into(), can_be_mended: true }
    }

    /// The words of `error` behind those of `before`.
    pub fn of(before: &str, error: &(impl Mend + fmt::Display)) -> Self {
        Self { text: format!("{before}{error}"), can_be_mended: error.can_be_mended() }
    }
}

impl fmt::Display for Reason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

impl Mend for Reason {
    fn can_be_mended(&self) -> bool {
        self.can_be_mended
    }
}

impl Mend for io::Error {
    /// A path can be chosen otherwise, and what it forbids allowed.
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

impl Mend for FileError {
    fn can_be_mended(&self) -> bool {
        match self {
            Self::Io { cause, .. } => cause.can_be_mended(),
            Self::NotRegular { .. } | Self::TooLarge { .. } | Self::Endless { .. } | Self::NotText { .. } => {
                true
            }
        }
    }
}

impl Mend for WriteError {
    fn can_be_mended(&self) -> bool {
        match self {
            Self::Io { cause, .. } => cause.can_be_mended(),
            Self::NotReadBack { .. } => false,
            Self::Exists { .. }
            | Self::Changed { .. }
            | Self::ReadOnly { .. }
            | Self::NotRegular { .. }
            | Self::Locked { .. } => true,
        }
    }
}

impl Mend for StoreError {
    fn can_be_mended(&self) -> bool {
        match self {
            Self::File(error) => error.can_be_mended(),
            Self::Write(error) => error.can_be_mended(),
            Self::Data(error) => error.can_be_mended(),
            Self::Folder { cause, .. } | Self::Delete { cause, .. } => cause.can_be_mended(),
            Self::NotFound { .. }
            | Self::Name(_)
            | Self::Read(_)
            | Self::Invalid(_)
            | Self::NoFolder
            | Self::Shipped(_) => true,
        }
    }
}

impl Mend for DataError {
    fn can_be_mended(&self) -> bool {
        match self {
            Self::File(error) => error.can_be_mended(),
            Self::Write(error) => error.can_be_mended(),
            Self::Other(_) => true,
        }
    }
}

impl Mend for ArchiveError {
    fn can_be_mended(&self) -> bool {
        match self {
            Self::File(error) => error.can_be_mended(),
            Self::Write(error) => error.can_be_mended(),
            Self::Io { cause, .. } => cause.can_be_mended(),
            Self::Document(_) => false,
            Self::NoFolder
            | Self::NotFound { .. }
            | Self::Empty
            | Self::Running { .. }
            | Self::Unreadable { .. } => true,
        }
    }
}

impl Mend for CaseError {
    /// A start or an end that cannot be is a value; what is computed from them may fail.
    fn can_be_mended(&self) -> bool {
        !matches!(self, Self::Cancelled)
    }
}

impl Mend for SideError {
    fn can_be_mended(&self) -> bool {
        match self {
            Self::File(error) => error.can_be_mended(),
            Self::Unknown { .. } => true,
        }
    }
}

impl Mend for ResultsError {
    fn can_be_mended(&self) -> bool {
        match self {
            Self::Side(error) => error.can_be_mended(),
            Self::NoColumn { .. } | Self::Table { .. } => true,
        }
    }
}

impl Mend for MapError {
    fn can_be_mended(&self) -> bool {
        match self {
            Self::Results(error) => error.can_be_mended(),
            Self::Grid(_) => true,
        }
    }
}

impl Mend for FormatError {
    fn can_be_mended(&self) -> bool {
        true
    }
}

impl Mend for DrawError {
    fn can_be_mended(&self) -> bool {
        false
    }
}

impl Mend for LoadError {
    fn can_be_mended(&self) -> bool {
        match self {
            Self::File(error) => error.can_be_mended(),
            Self::Spec(_) => true,
        }
    }
}

impl Mend for OutputError {
    fn can_be_mended(&self) -> bool {
        match self {
            Self::Write(error) => error.can_be_mended(),
            Self::Io { cause, .. } => cause.can_be_mended(),
            Self::NotOurs { cause, .. } => cause.can_be_mended(),
            Self::Threads(_) => false,
            Self::Busy { .. } | Self::OtherSweep { .. } | Self::OtherShard { .. } | Self::Changed { .. } => {
                true
            }
        }
    }
}

impl Mend for MergeError {
    fn can_be_mended(&self) -> bool {
        match self {
            Self::Output(error) => error.can_be_mended(),
            Self::Io { cause, .. } => cause.can_be_mended(),
            Self::NotOurs { cause, .. } => cause.can_be_mended(),
            Self::Exists { .. }
            | Self::OtherSweep { .. }
            | Self::OtherDivision { .. }
            | Self::Doubled { .. }
            | Self::Missing(_)
            | Self::Incomplete { .. }
            | Self::Changed { .. } => true,
        }
    }
}

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
