//! Measured points behind a curve.

use super::bounds::Bounds;
use super::parts::{Figure, Mark, Sign};
use super::scale::Scale;
use crate::explorer::View;
use pulloff_engine::measured::{Abscissa, Branches, Segment};

/// The most points that are drawn; a fit takes all.
const DRAWN: usize = 3000;

/// Measured points as δ, P and s in base units, not a number where one is not measured.
#[derive(Debug, Clone, PartialEq)]
pub struct Points(Vec<(Segment, [f64; 3])>);

impl Points {
    /// The points of `branches` less the offset δ₀ and the baseline P₀; `spring` is the stiffness of the device where x is its way.
    pub fn new(branches: &Branches, offset: f64, baseline: f64, spring: Option<f64>) -> Self {
        let of = |x: f64, force: f64, radius: f64| {
            let force = force - baseline;
            match (branches.abscissa, spring) {
                (Abscissa::Radius, _) => [f64::NAN, force, x],
                // δ = Δ − P/k.
                (Abscissa::Position, Some(k)) => [x - offset - force / k, force, radius],
                _ => [x - offset, force, radius],
            }
        };
        let all = branches.list.iter().flat_map(|branch| {
            let points = branch.attached.iter().chain(&branch.free);
            points.map(|point| (branch.segment, of(point.x, point.force, point.radius)))
        });
        Self(all.collect())
    }

    /// Lays them behind the signs of `figure`, as far as it has their columns; whether it has.
    pub fn lay(&self, view: View, figure: &mut Figure, scale: Scale<'_>) -> bool {
        if !matches!(view, View::ForceApproach | View::RadiusForce | View::RadiusApproach) {
            return false;
        }
        let step = self.0.len().div_ceil(DRAWN).max(1);
        let mark = |(segment, place): &(Segment, [f64; 3])| {
            let sign = Sign::Measured { loading: *segment == Segment::Approach };
            let at = scale.place(view, *place);
            (at.0.is_finite() && at.1.is_finite()).then_some(Mark { sign, at })
        };
        // Sorted by branch: each is drawn as one.
        let marks: Vec<Mark> = self.0.iter().step_by(step).filter_map(mark).collect();
        if marks.is_empty() {
            return false;
        }
        let Bounds { x, y } = figure.bounds;
        let ends = [(x[0], y[0]), (x[1], y[1])];
        figure.bounds = Bounds::of(ends.into_iter().chain(marks.iter().map(|mark| mark.at)));
        figure.marks.splice(0..0, marks);
        true
    }
}
