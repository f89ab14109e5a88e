//! The distances of the measured points from the curve, in standard deviations of their noise, over x.
//!
//! The distance is taken along the normal of the curve, as in a fit. Noise scatters about zero; a distance that keeps
//! its sign for long is something that the model does not describe.

use super::bounds::Bounds;
use super::measured::DRAWN;
use super::parts::{Axis, Figure, Line, Mark, Role, Sign};
use super::subject::Subject;
use crate::explorer::fitting::NO_POINTS;
use pulloff_engine::fit::residuals::Residual;
use pulloff_engine::measured::{Abscissa, Segment};

/// Nearly all normal noise lies within this many deviations.
const USUAL: f64 = 3.0;

/// Builds the view.
pub fn figure(subject: &Subject<'_>) -> Figure {
    let scale = subject.scale();
    let x = match subject.distances.and_then(|found| found.as_ref().ok()) {
        Some((Abscissa::Radius, _)) => scale.length_axis("s"),
        Some((Abscissa::Position, _)) => scale.length_axis("Δ"),
        _ => scale.length_axis("δ"),
    };
    let mut figure = Figure::empty(
        "distances of the points from the curve, in σ".to_owned(),
        x,
        Axis::pure("r/σ".to_owned()),
    );
    let residuals = match subject.distances {
        _ if subject.preset.data.source.is_none() => {
            figure.missing = Some(NO_POINTS.to_owned());
            return figure;
        }
        Some(Ok((_, residuals))) => residuals,
        Some(Err(reason)) => {
            figure.missing = Some(format!("no residuals: {reason}"));
            return figure;
        }
        None => {
            figure.missing = Some("no residuals yet".to_owned());
            return figure;
        }
    };
    let branches = subject.preset.branches().and_then(Result::ok);
    let offset = branches.map_or(0.0, |branches| subject.preset.data.instrument(&branches).offset);
    let at = |residual: &Residual| (scale.length(residual.datum.point.x - offset), residual.residual);
    let step = residuals.len().div_ceil(DRAWN).max(1);
    let parts = [Segment::Approach, Segment::Retraction].map(|segment| [(segment, false), (segment, true)]);
    for (segment, apart) in parts.into_iter().flatten() {
        let is_of = |residual: &&Residual| residual.datum.segment == segment && residual.datum.free == apart;
        let of = residuals.iter().filter(is_of);
        let sign = Sign::Measured { loading: segment == Segment::Approach, apart };
        let marks = of.step_by(step).map(|residual| Mark { sign, at: at(residual) });
        figure.marks.extend(marks.filter(|mark| mark.at.0.is_finite() && mark.at.1.is_finite()));
    }
    let places = || figure.marks.iter().map(|mark| mark.at);
    let [lo, hi] =
        places().fold([f64::INFINITY, f64::NEG_INFINITY], |[lo, hi], (x, _)| [lo.min(x), hi.max(x)]);
    if lo <= hi {
        figure.bounds = Bounds::of(places().chain([(lo, -USUAL), (hi, USUAL)]));
        figure.lines.push(Line::new(Role::Zero, "", vec![(lo, 0.0), (hi, 0.0)]));
    }
    figure
}
