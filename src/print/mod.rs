//! A figure as the bytes of a file: the SVG itself, its pixels, or a page of a PDF.
//!
//! | file | what lives there |
//! |---|---|
//! | `tree` | the SVG parsed again, its letters in the bundled font (features `png`, `pdf`) |
//! | `png` | the pixels (feature `png`) |
//! | `pdf` | a page as large as the figure (feature `pdf`) |
//!
//! A format that a build lacks is refused by name; SVG is always available.

mod error;
#[cfg(feature = "pdf")]
mod pdf;
#[cfg(feature = "png")]
mod png;
#[cfg(feature = "png")]
mod tree;

pub use error::{DrawError, FormatError};

use pulloff_engine::text::show_path;
use std::path::Path;

/// The format of a figure's file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PictureFormat {
    Svg,
    /// Pixels, 384 per inch.
    Png,
    /// A page with its letters in an embedded font.
    Pdf,
}

impl PictureFormat {
    /// The extensions of the files that this build writes.
    pub const ENDINGS: &'static [&'static str] = if cfg!(feature = "pdf") {
        &["svg", "png", "pdf"]
    } else if cfg!(feature = "png") {
        &["svg", "png"]
    } else {
        &["svg"]
    };

    /// The format named by the extension of `path`.
    pub fn of(path: &Path) -> Result<Self, FormatError> {
        let ending = path.extension().map(|ending| ending.to_string_lossy().to_ascii_lowercase());
        let missing = |name, feature| Err(FormatError::Missing { name, feature });
        match ending.as_deref() {
            Some("svg") => Ok(Self::Svg),
            Some("png") if cfg!(feature = "png") => Ok(Self::Png),
            Some("png") => missing("PNG", "png"),
            Some("pdf") if cfg!(feature = "pdf") => Ok(Self::Pdf),
            Some("pdf") => missing("PDF", "pdf"),
            _ => Err(FormatError::Ending { name: show_path(path) }),
        }
    }

    /// The bytes of the file for `svg`, a figure of this program.
    pub fn bytes(self, svg: &str) -> Result<Vec<u8>, DrawError> {
        match self {
            Self::Svg => Ok(svg.as_bytes().to_vec()),
            #[cfg(feature = "png")]
            Self::Png => png::png(&tree::tree(svg)?),
            #[cfg(feature = "pdf")]
            Self::Pdf => pdf::pdf(&tree::tree(svg)?),
            #[cfg(not(all(feature = "png", feature = "pdf")))]
            lacking => {
                let refused = |format| DrawError::Refused { format, cause: "this build lacks it".to_owned() };
                Err(refused(if lacking == Self::Png { "PNG" } else { "PDF" }))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_format_is_named_by_the_ending() {
        assert_eq!(PictureFormat::of(Path::new("a/b.SVG")), Ok(PictureFormat::Svg));
        for (name, feature, has) in
            [("png", "png", cfg!(feature = "png")), ("pdf", "pdf", cfg!(feature = "pdf"))]
        {
            let format = PictureFormat::of(Path::new("figure").with_extension(name).as_path());
            match format {
                Ok(_) => assert!(has),
                Err(error) => {
                    let words = format!(
                        "this build cannot write {} (feature `{feature}` is off)",
                        name.to_uppercase()
                    );
                    assert!(!has && error.to_string().starts_with(&words), "{error}");
                }
            }
        }
        for path in ["a.gif", "svg", "a\u{1b}"] {
            let said = PictureFormat::of(Path::new(path)).unwrap_err().to_string();
            assert!(said.contains("ends in .svg") && !said.contains('\u{1b}'), "{said}");
        }
    }

    #[test]
    #[cfg(feature = "png")]
    fn what_is_no_figure_is_refused() {
        for text in ["", "<svg", "<svg xmlns='http://www.w3.org/2000/svg' width='0' height='5'/>"] {
            assert!(PictureFormat::Png.bytes(text).is_err(), "{text}");
        }
        let wide = "<svg xmlns='http://www.w3.org/2000/svg' width='9000mm' height='5mm'/>";
        assert!(PictureFormat::Png.bytes(wide).unwrap_err().to_string().contains("cannot be drawn"));
    }
}
