//! A closed outline filled with slanting lines or with dots.

use crate::figure::Bounds;
use ratatui::layout::Rect;
use ratatui::symbols::Marker;

/// Every so many dots across a line begins, in braille and in characters.
const APART: [usize; 2] = [6, 2];

/// What an outline is filled with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Texture {
    Slanting,
    /// Dots in straight rows.
    Dotted,
}

/// The dots inside `outline`, in axis values.
pub fn hatch(
    outline: &[(f64, f64)],
    texture: Texture,
    bounds: &Bounds,
    plot: Rect,
    marker: Marker,
) -> Vec<(f64, f64)> {
    let braille = marker == Marker::Braille;
    let (across, upwards, apart) = if braille { (2, 4, APART[0]) } else { (1, 1, APART[1]) };
    let columns = usize::from(plot.width) * across;
    let rows = usize::from(plot.height) * upwards;
    let mut dots = Vec::new();
    if outline.iter().any(|(x, y)| !(x.is_finite() && y.is_finite())) {
        return dots;
    }
    for row in 0..rows {
        let up = (row as f64 + 0.5) / rows as f64;
        let (_, y) = bounds.at((0.0, up));
        let crossings = crossings(outline, y);
        let is_filled = |column: &usize| match texture {
            Texture::Slanting => (column + apart * rows - row).is_multiple_of(apart),
            Texture::Dotted => row.is_multiple_of(2) && column.is_multiple_of(2),
        };
        for column in (0..columns).filter(is_filled) {
            let right = (column as f64 + 0.5) / columns as f64;
            let (x, _) = bounds.at((right, 0.0));
            // Inside when an odd number of sides lies to the left.
            if crossings.iter().filter(|crossing| **crossing < x).count() % 2 == 1 {
                dots.push((x, y));
            }
        }
    }
    dots
}

/// Where the sides of the outline cross the level `y`.
fn crossings(outline: &[(f64, f64)], y: f64) -> Vec<f64> {
    let next = outline.iter().cycle().skip(1);
    outline
        .iter()
        .zip(next)
        .filter(|(a, b)| (a.1 > y) != (b.1 > y))
        .map(|(a, b)| a.0 + (b.0 - a.0) * (y - a.1) / (b.1 - a.1))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dots_fill_the_inside_and_nothing_else() {
        let bounds = Bounds { x: [0.0, 4.0], y: [0.0, 4.0] };
        let plot = Rect::new(0, 0, 60, 30);
        // A square with a notch.
        let outline = [(1.0, 1.0), (3.0, 1.0), (3.0, 3.0), (2.0, 1.5), (1.0, 3.0)];
        for marker in [Marker::Braille, Marker::Custom('/')] {
            for texture in [Texture::Slanting, Texture::Dotted] {
                let dots = hatch(&outline, texture, &bounds, plot, marker);
                assert!(dots.len() > 40, "{}", dots.len());
                for (x, y) in &dots {
                    let notch = 1.5 + 1.5 * (x - 2.0).abs();
                    assert!((1.0..=3.0).contains(x) && *y >= 1.0 && *y <= notch, "{x} {y}");
                }
            }
        }
        assert!(
            hatch(&[(f64::NAN, 0.0), (1.0, 1.0)], Texture::Slanting, &bounds, plot, Marker::Braille)
                .is_empty()
        );
        assert!(hatch(&[], Texture::Slanting, &bounds, plot, Marker::Braille).is_empty());
    }
}
