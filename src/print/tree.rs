//! The document parsed again, its letters in the bundled font.

use super::error::DrawError;
use resvg::usvg;
use std::sync::Arc;

/// `svg` as a tree of what it draws.
pub(super) fn tree(svg: &str) -> Result<usvg::Tree, DrawError> {
    let mut fonts = usvg::fontdb::Database::new();
    // The machine may have no fonts at all, and letters without one vanish silently.
    fonts.load_font_data(dejavu::sans::regular().to_vec());
    fonts.load_font_data(dejavu::sans::bold().to_vec());
    let options = usvg::Options {
        fontdb: Arc::new(fonts),
        font_family: "DejaVu Sans".to_owned(),
        ..usvg::Options::default()
    };
    usvg::Tree::from_str(svg, &options).map_err(|error| DrawError::Document(error.to_string()))
}
