//! Why a figure has no file.

use super::PictureFormat;
use crate::mend::Mend;

/// Why no figure can be written to a file of this name.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum FormatError {
    #[error("{name}: a figure's file ends in .{}", PictureFormat::ENDINGS.join(" or ."))]
    Ending { name: String },
    /// This build does not include the format.
    #[error("this build cannot write {name} (feature `{feature}` is off); use .{}", PictureFormat::ENDINGS.join(" or ."))]
    Missing { name: &'static str, feature: &'static str },
}

impl Mend for FormatError {
    fn can_be_mended(&self) -> bool {
        true
    }
}

/// Why a figure cannot be drawn.
#[derive(Debug, thiserror::Error)]
pub enum DrawError {
    #[error("the figure cannot be read back: {0}")]
    Document(String),
    /// The figure has no area, or too large a one.
    #[error("a figure of {0} x {1} cannot be drawn")]
    Size(f32, f32),
    #[error("the figure cannot be written as {format}: {cause}")]
    Refused { format: &'static str, cause: String },
}

impl Mend for DrawError {
    fn can_be_mended(&self) -> bool {
        false
    }
}
