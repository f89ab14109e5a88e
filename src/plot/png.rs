//! An SVG figure as pixels.

use resvg::{tiny_skia, usvg};
use std::sync::Arc;

/// Pixels of a unit of 1/96 inch: 384 dots an inch, above the 300 that journals ask of figures with letters.
const SCALE: f32 = 4.0;
/// The most pixels a side: a figure of the widest paper stays below.
const MOST: f32 = 20_000.0;

/// Why there is no picture.
#[derive(Debug, thiserror::Error)]
pub enum PngError {
    /// The document could not be read back.
    #[error("the figure could not be drawn as pixels: {0}")]
    Document(#[from] usvg::Error),
    /// It has no area, or too large a one.
    #[error("a figure of {0} x {1} pixels cannot be drawn")]
    Size(f32, f32),
    /// The file format refused it.
    #[error("the pixels could not be written as PNG: {0}")]
    Format(String),
}

/// `svg` as PNG with 384 dots an inch.
///
/// # Errors
/// [`PngError`] when the document is no figure of this program.
pub fn png(svg: &str) -> Result<Vec<u8>, PngError> {
    let mut fonts = usvg::fontdb::Database::new();
    // The machine may have no font at all, and letters without one vanish without a word.
    fonts.load_font_data(dejavu::sans::regular().to_vec());
    fonts.load_font_data(dejavu::sans::bold().to_vec());
    let options = usvg::Options {
        fontdb: Arc::new(fonts),
        font_family: "DejaVu Sans".to_owned(),
        ..usvg::Options::default()
    };
    let tree = usvg::Tree::from_str(svg, &options)?;
    let [width, height] = [tree.size().width(), tree.size().height()].map(|side| (side * SCALE).ceil());
    let too_large = PngError::Size(width, height);
    if !(1.0..=MOST).contains(&width) || !(1.0..=MOST).contains(&height) {
        return Err(too_large);
    }
    // Between 1 and `MOST`.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    let pixels = tiny_skia::Pixmap::new(width as u32, height as u32);
    let mut pixels = pixels.ok_or(too_large)?;
    resvg::render(&tree, tiny_skia::Transform::from_scale(SCALE, SCALE), &mut pixels.as_mut());
    pixels.encode_png().map_err(|error| PngError::Format(error.to_string()))
}
