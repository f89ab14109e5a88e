//! A figure as pixels.

use super::DrawError;
use resvg::{tiny_skia, usvg};

/// Pixels of a unit of 1/96 inch: 384 dots an inch, above the 300 that journals ask of figures with letters.
const SCALE: f32 = 4.0;
/// The most pixels a side: a figure of the widest paper stays below.
const MOST: f32 = 20_000.0;

/// `tree` as PNG with 384 dots an inch.
pub(super) fn png(tree: &usvg::Tree) -> Result<Vec<u8>, DrawError> {
    let [width, height] = [tree.size().width(), tree.size().height()].map(|side| (side * SCALE).ceil());
    let too_large = DrawError::Size(width, height);
    if !(1.0..=MOST).contains(&width) || !(1.0..=MOST).contains(&height) {
        return Err(too_large);
    }
    // Between 1 and `MOST`.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    let pixels = tiny_skia::Pixmap::new(width as u32, height as u32);
    let mut pixels = pixels.ok_or(too_large)?;
    resvg::render(tree, tiny_skia::Transform::from_scale(SCALE, SCALE), &mut pixels.as_mut());
    pixels.encode_png().map_err(|error| DrawError::Refused { format: "PNG", cause: error.to_string() })
}
