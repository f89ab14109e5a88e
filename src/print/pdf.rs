//! A figure as a page of a PDF: lines stay lines, and letters stay letters, in an embedded font.

use super::error::DrawError;
use krilla::Document;
use krilla::geom::Size;
use krilla::metadata::Metadata;
use krilla::page::PageSettings;
use krilla_svg::{SurfaceExt, SvgSettings};
use resvg::usvg;

/// Points per unit of 1/96 inch.
const POINTS: f32 = 0.75;

/// `tree` as a PDF with one page, as large as the figure on paper.
pub(super) fn pdf(tree: &usvg::Tree) -> Result<Vec<u8>, DrawError> {
    let [width, height] = [tree.size().width(), tree.size().height()].map(|side| side * POINTS);
    let size = Size::from_wh(width, height).ok_or(DrawError::Size(width, height))?;
    let mut document = Document::new();
    // No date, so that the same figure gives the same file.
    document.set_metadata(Metadata::new().creator(format!("pulloff {}", env!("CARGO_PKG_VERSION"))));
    let mut page = document.start_page_with(PageSettings::new(size));
    let mut surface = page.surface();
    let drawn = surface.draw_svg(tree, size, SvgSettings::default());
    surface.finish();
    page.finish();
    let refused = |cause: String| DrawError::Refused { format: "PDF", cause };
    drawn.ok_or_else(|| refused("a part of it cannot be drawn".to_owned()))?;
    document.finish().map_err(|error| refused(format!("{error:?}")))
}
