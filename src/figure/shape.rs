//! The undeformed gap of a preset, h over r, with the disc at the start: a small picture for choosing a shape.
//!
//! Where the start is not given as a contact radius, the size of the disc is unknown without solving, and the gap is
//! drawn over its own length.

use super::{Bounds, Figure, Line, Mark, Role, Scale, Sign};
use pulloff_engine::gap::Gap;
use pulloff_engine::preset::Preset;
use pulloff_engine::problem::Start;

/// The number of points along the radius.
const POINTS: u32 = 400;
/// The outermost radius, over that of the disc.
const BEYOND: f64 = 1.5;

/// The undeformed gap of `preset` in its own units.
pub fn undeformed(preset: &Preset) -> Figure {
    let scale = Scale::raw(&preset.units);
    let name = preset.gap.name().to_owned();
    let mut figure = Figure::empty(name, scale.length_axis("r"), scale.length_axis("h"));
    let disc = match preset.path.start {
        Start::ContactRadius(s) => Some(s),
        Start::Approach(_) | Start::Force(_) => None,
    };
    let end = disc.map_or_else(|| preset.gap.reference_length(), |s| BEYOND * s);
    let shown_end = scale.radius(end);
    let points: Vec<(f64, f64)> = (0..=POINTS)
        .map(|i| end * f64::from(i) / f64::from(POINTS))
        .map(|r| (scale.radius(r), scale.radius(preset.gap.jet(r).value)))
        .collect();
    figure.bounds = Bounds::of(points.iter().copied().chain([(0.0, 0.0), (shown_end, 0.0)]));
    figure.lines.push(Line::new(Role::Body, "", points));
    if let Some(s) = disc.map(|s| scale.radius(s)) {
        figure.lines.push(Line::new(Role::Contact, "", vec![(0.0, 0.0), (s, 0.0)]));
        figure.marks.push(Mark { sign: Sign::Edge, at: (s, 0.0) });
    }
    figure
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::store::Store;

    #[test]
    fn the_gap_is_drawn_beyond_the_disc_as_far_as_it_is_known() {
        let store = Store::at("/nowhere", &[]);
        for name in ["wavy-sphere", "exact-sphere", "cone", "harmonics", "random-waves", "formula", "profile"]
        {
            let source = store.resolve(name).unwrap();
            let preset = store.load(&source, &[] as &[&str]).unwrap().preset;
            let Start::ContactRadius(s) = preset.path.start else { panic!("{name}") };
            let figure = undeformed(&preset);
            assert_eq!(figure.marks[0].at, (s, 0.0));
            let points = &figure.lines[0].points;
            assert_eq!(points[0], (0.0, 0.0));
            let known = preset.gap.largest_radius().unwrap_or(f64::INFINITY);
            for (r, h) in points {
                assert!(h.is_finite() == (*r <= known) || (r - known).abs() < 1e-9, "{name} {r} {h}");
            }
            assert!(figure.bounds.x[1] > s && figure.bounds.y[1] >= preset.gap.jet(s).value, "{name}");
        }
    }
}
