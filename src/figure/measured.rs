//! Measured points behind a curve.

use super::bounds::Bounds;
use super::parts::{Figure, Mark, Sign};
use super::scale::Scale;
use crate::explorer::View;
use pulloff_engine::measured::{Abscissa, Branches, Instrument, Segment};
use pulloff_engine::preset::Preset;

/// The largest number of points drawn; a fit uses all of them.
pub const DRAWN: usize = 3000;

/// Measured points as δ, P and s in base units, NaN where one is not measured.
#[derive(Debug, Clone, PartialEq)]
pub struct MeasuredMarks(Vec<(Sign, [f64; 3])>);

impl MeasuredMarks {
    /// The points of a preset's measured curve, less its offset δ₀ and its baseline P₀; `None` without a curve.
    /// Errors: Why there are none, in words.
    pub fn of(preset: &Preset) -> Option<Result<Self, String>> {
        Some(preset.branches()?.map(|branches| Self::new(&branches, preset)))
    }

    fn new(branches: &Branches, preset: &Preset) -> Self {
        let Instrument { offset, baseline, tilt } = preset.data.instrument(branches);
        let of = |x: f64, force: f64, radius: f64| {
            let force = force - baseline - tilt * x;
            match (branches.abscissa, preset.reading().spring) {
                (Abscissa::Radius, _) => [f64::NAN, force, x],
                // δ = Δ − P/k.
                (Abscissa::Position, Some(k)) => [x - offset - force / k, force, radius],
                _ => [x - offset, force, radius],
            }
        };
        let count: usize = branches.list.iter().map(|branch| branch.attached.len() + branch.free.len()).sum();
        let step = count.div_ceil(DRAWN).max(1);
        let all = branches.list.iter().flat_map(|branch| {
            let loading = branch.segment == Segment::Approach;
            [(false, &branch.attached), (true, &branch.free)].into_iter().flat_map(move |(apart, part)| {
                let sign = Sign::Measured { loading, apart };
                part.iter().step_by(step).map(move |point| (sign, of(point.x, point.force, point.radius)))
            })
        });
        Self(all.collect())
    }

    /// Draws them behind the marks of `figure`, if its view has their columns.
    pub fn lay(&self, view: View, figure: &mut Figure, scale: Scale<'_>) {
        if !(view.is_curve() || matches!(view, View::Unloading | View::Cycle)) {
            return;
        }
        let mark = |(sign, place): &(Sign, [f64; 3])| {
            let at = scale.place(view, *place);
            (at.0.is_finite() && at.1.is_finite()).then_some(Mark { sign: *sign, at })
        };
        // Sorted by branch and part, because each is drawn as one.
        let marks: Vec<Mark> = self.0.iter().filter_map(mark).collect();
        if marks.is_empty() {
            return;
        }
        let Bounds { x, y } = figure.bounds;
        let ends = [(x[0], y[0]), (x[1], y[1])];
        figure.bounds = Bounds::of(ends.into_iter().chain(marks.iter().map(|mark| mark.at)));
        figure.marks.splice(0..0, marks);
    }
}
