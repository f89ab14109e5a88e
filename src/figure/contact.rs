//! The contact of a state from above: half of it, filled where the bodies touch, with their crests as thin rings.

use super::bounds::Bounds;
use super::parts::{Area, Figure, Line, Meaning, Role};
use std::f64::consts::PI;

/// The number of corners of half a circle.
const CORNERS: u32 = 180;

/// Draws the contacts (as [inner, outer] on the axis of radii), the parts of them in which the bodies pull, and the
/// crests, on a figure that shows radii up to `reach`.
pub fn lay(
    figure: &mut Figure,
    contacts: &[[f64; 2]],
    tensions: &[[f64; 2]],
    crests: impl Iterator<Item = f64>,
    reach: f64,
) {
    figure.bounds = Bounds { x: [-reach, reach], y: [0.0, reach] };
    let all = [(Meaning::Contact, contacts), (Meaning::Tension, tensions)];
    for (meaning, [inner, outer]) in
        all.into_iter().flat_map(|(meaning, all)| all.iter().map(move |at| (meaning, at)))
    {
        let outline = half(*outer).into_iter().chain(half(*inner).into_iter().rev()).collect();
        figure.areas.push(Area { meaning, outline, lost: None });
    }
    figure.lines.extend(crests.map(|r| Line::new(Role::Undeformed, "crest", half(r))));
    // The axis is not an edge.
    let edges = contacts.iter().flatten().filter(|r| **r > 0.0);
    figure.lines.extend(edges.map(|r| Line::new(Role::Edges, "edge", half(*r))));
}

/// Half a circle about the axis, from the right over the top to the left.
fn half(radius: f64) -> Vec<(f64, f64)> {
    let angle = |k: u32| PI * f64::from(k) / f64::from(CORNERS);
    (0..=CORNERS).map(|k| (radius * angle(k).cos(), radius * angle(k).sin())).collect()
}
