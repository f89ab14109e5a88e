//! The appearance of the roles on paper.
//!
//! The colours are those of Okabe and Ito, which people with any of the common colour vision deficiencies can tell
//! apart. No two roles that meet in one chart have the same dashes, so a grey print is readable too.

use crate::figure::{Role, Sign};
use kuva::plot::scatter::MarkerShape;
use pulloff_engine::problem::Control;

/// How a line is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stroke {
    /// Its colour, `#rrggbb`.
    pub color: &'static str,
    /// Its width in units of 1/96 inch.
    pub width: f64,
    /// The lengths of dashes and gaps in the same units; empty for a solid line.
    pub dashes: &'static str,
}

/// How a sign is drawn, and what it means in a legend.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stamp {
    pub shape: MarkerShape,
    pub color: &'static str,
    /// Half its width in units of 1/96 inch.
    pub size: f64,
    /// Its name in a legend; empty where it needs none.
    pub name: &'static str,
}

const BLACK: &str = "#000000";
const GREY: &str = "#7a7a7a";
const ORANGE: &str = "#e69f00";
const SKY: &str = "#56b4e9";
const GREEN: &str = "#009e73";
const BLUE: &str = "#0072b2";
const VERMILLION: &str = "#d55e00";
const PURPLE: &str = "#cc79a7";

/// The strokes of the numbered curves: pins, loads, members of a family.
const NUMBERED: [Stroke; 6] = [
    Stroke { color: ORANGE, width: 1.2, dashes: "6 2" },
    Stroke { color: SKY, width: 1.2, dashes: "2 2" },
    Stroke { color: PURPLE, width: 1.2, dashes: "8 2 2 2" },
    Stroke { color: GREEN, width: 1.2, dashes: "4 1.5" },
    Stroke { color: VERMILLION, width: 1.2, dashes: "1.5 1.5" },
    Stroke { color: BLUE, width: 1.2, dashes: "10 3" },
];

/// The stroke of a role.
pub fn stroke(role: Role) -> Stroke {
    let stroke = |color, width, dashes| Stroke { color, width, dashes };
    match role {
        Role::Zero => stroke(GREY, 0.5, ""),
        Role::Undeformed => stroke(GREY, 1.0, "1 2"),
        Role::Branch => stroke(GREY, 0.8, "4 1 1 1"),
        Role::Smooth => stroke(GREY, 1.0, "7 3"),
        Role::Envelope => stroke(GREEN, 1.0, "9 2 2 2"),
        Role::Pin(number) => NUMBERED[number.saturating_sub(1) % NUMBERED.len()],
        // Over the curve: the dots lie on the line that they agree with.
        Role::Exact => stroke(BLACK, 1.0, "0.8 3.2"),
        Role::Unstable => stroke(VERMILLION, 1.0, "3 2"),
        Role::Stable => stroke(BLUE, 1.6, ""),
        Role::Inadmissible => stroke(PURPLE, 3.0, "0.8 2.4"),
        Role::Loading => stroke(GREEN, 1.3, "5 1.2"),
        Role::Unloading => stroke(BLUE, 1.3, "5 1 1 1 1 1"),
        Role::Edges => stroke(BLUE, 1.0, ""),
        Role::Body => stroke(BLUE, 1.4, ""),
        Role::Contact => stroke(BLACK, 2.0, ""),
        Role::Zone => stroke(ORANGE, 2.0, "4 1"),
        Role::Barrier => stroke(VERMILLION, 0.8, "2.5 1"),
        Role::Device => stroke(GREY, 0.8, "2 1 6 1"),
        Role::Pull => stroke(ORANGE, 1.5, "14 2"),
        Role::Walk | Role::Chosen => stroke(BLACK, 0.8, ""),
        Role::Jump => stroke(VERMILLION, 0.8, ""),
        Role::Unchanged => stroke(GREY, 0.8, "1 2.5"),
        Role::Starts => stroke(GREY, 0.8, "8 2"),
        Role::Landings => stroke(VERMILLION, 1.2, "4 1.5"),
        Role::Cusps | Role::Law => stroke(BLUE, 1.3, ""),
        Role::Twin => stroke(GREY, 1.0, "5 2"),
        Role::Level => stroke(BLACK, 0.9, "7 2 1.5 2"),
    }
}

/// The stamp of a sign.
pub fn stamp(sign: Sign) -> Stamp {
    let stamp = |shape, color, size, name| Stamp { shape, color, size, name };
    match sign {
        Sign::OtherLimit(Control::Force) => stamp(MarkerShape::Square, ORANGE, 1.8, "limit of P"),
        Sign::OtherLimit(_) => stamp(MarkerShape::Diamond, ORANGE, 1.8, "limit of δ"),
        Sign::Limit | Sign::Event(_) => stamp(MarkerShape::TriangleDown, VERMILLION, 2.3, "limit point"),
        Sign::Passing(_) => stamp(MarkerShape::Pentagon, BLACK, 2.4, "event without a limit point"),
        // The name used in the tables of the figures, which programs read.
        Sign::LastContact(_) => stamp(MarkerShape::Cross, VERMILLION, 2.8, "last contact"),
        Sign::LargestPull => stamp(MarkerShape::Triangle, BLACK, 3.8, "A, largest pull"),
        Sign::Farthest => stamp(MarkerShape::Diamond, BLACK, 3.8, "B, farthest"),
        Sign::Landing => stamp(MarkerShape::Circle, GREEN, 2.2, "landing"),
        Sign::Touch => stamp(MarkerShape::Pentagon, BLACK, 2.4, "touch"),
        Sign::Turn => stamp(MarkerShape::Square, BLACK, 2.2, "turn"),
        Sign::Crest => stamp(MarkerShape::Triangle, GREY, 2.2, "crest"),
        Sign::Edge => stamp(MarkerShape::Plus, BLACK, 3.0, "edge"),
        Sign::Minimum => stamp(MarkerShape::Circle, BLUE, 2.4, "minimum"),
        Sign::Maximum => stamp(MarkerShape::Diamond, VERMILLION, 2.4, "maximum"),
        Sign::Barrier => stamp(MarkerShape::Star, VERMILLION, 3.0, "barrier"),
        Sign::Stray | Sign::Walker => stamp(MarkerShape::Hexagon, BLACK, 2.6, "state"),
        Sign::Cusp => stamp(MarkerShape::TriangleDown, BLUE, 2.3, "cusp"),
        Sign::Swallowtail => stamp(MarkerShape::Star, BLUE, 2.8, "swallowtail"),
        Sign::Preset => stamp(MarkerShape::Plus, BLACK, 3.2, "now"),
        // Snap counts and crests are written as numbers; a letter is beside its point.
        Sign::Snaps(_) | Sign::OfCrest(_) => stamp(MarkerShape::Circle, BLACK, 0.0, ""),
        Sign::Letter(_) => stamp(MarkerShape::Circle, BLACK, 1.6, ""),
        Sign::Measured { loading: true, apart: false } => {
            stamp(MarkerShape::Circle, GREEN, 1.1, "measured approach")
        }
        Sign::Measured { loading: true, apart: true } => {
            stamp(MarkerShape::Plus, GREEN, 1.7, "measured approach, apart")
        }
        Sign::Measured { loading: false, apart: false } => {
            stamp(MarkerShape::Square, GREY, 1.1, "measured retraction")
        }
        Sign::Measured { loading: false, apart: true } => {
            stamp(MarkerShape::Cross, GREY, 1.3, "measured retraction, apart")
        }
        // The axes say what this is.
        Sign::Value => stamp(MarkerShape::Circle, BLUE, 2.2, ""),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    #[test]
    fn lines_that_meet_differ_without_their_colours() {
        let curve = [Role::Smooth, Role::Envelope, Role::Exact, Role::Unstable, Role::Stable];
        let more = [Role::Branch, Role::Inadmissible, Role::Device, Role::Undeformed, Role::Barrier]
            .into_iter()
            .chain([Role::Loading, Role::Unloading, Role::Pull]);
        let looks: Vec<(String, &str)> = curve
            .into_iter()
            .chain(more)
            .chain((1..=6).map(Role::Pin))
            .map(|role| {
                let stroke = stroke(role);
                (format!("{:.1}", stroke.width), stroke.dashes)
            })
            .collect();
        let distinct: HashSet<_> = looks.iter().map(|(_, dashes)| dashes).collect();
        assert_eq!(distinct.len(), looks.len(), "{looks:?}");
    }
}
