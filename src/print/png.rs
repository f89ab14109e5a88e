//! A figure as pixels.

use super::error::DrawError;
use resvg::{tiny_skia, usvg};

/// Pixels per unit of 1/96 inch: 384 dots per inch, above the 300 that journals require for figures with letters.
const SCALE: f32 = 4.0;
/// The same value as stored in the file: pixels per metre, 384 / 0.0254.
const PER_METRE: u32 = 15_118;
/// The largest number of pixels per side; a figure on the widest paper stays below it.
const MOST: f32 = 20_000.0;

/// `tree` as PNG at 384 dots per inch.
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
    let (width, height) = (pixels.width(), pixels.height());
    encoded(width, height, &pixels.take_demultiplied())
        .map_err(|error| DrawError::Refused { format: "PNG", cause: error.to_string() })
}

/// The pixels as a file that states their size on paper.
fn encoded(width: u32, height: u32, rgba: &[u8]) -> Result<Vec<u8>, png::EncodingError> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_pixel_dims(Some(png::PixelDimensions {
        xppu: PER_METRE,
        yppu: PER_METRE,
        unit: png::Unit::Meter,
    }));
    let mut writer = encoder.write_header()?;
    writer.write_image_data(rgba)?;
    writer.finish()?;
    Ok(bytes)
}
