//! The pull at the rate of the preset: over the curve that it leaves and returns to, and P over time.

use super::bounds::Bounds;
use super::parts::{Figure, Line, Mark, Role, Sign};
use super::scale::Scale;
use super::subject::Subject;
use crate::explorer::View;
use pulloff_engine::problem::Control;
use pulloff_engine::report::number::significant;
use pulloff_engine::report::pull::{MomentReport, MomentRow, RunReport, missing};
use pulloff_engine::units::Quantity;

/// The message where no pull has been computed.
const NO_PULL: &str = "no pull yet";

fn line(run: &RunReport, place: impl Fn(&MomentRow) -> (f64, f64)) -> Line {
    Line::new(Role::Pull, "pull at a rate", run.moments.iter().map(place).collect())
}

/// Adds the pull to a view of the curve; returns its points for the bounds. A dead load falls without end, so its
/// points count only within one width of the curve, which runs from `lo` to `hi`.
pub fn over_curve(
    subject: &Subject<'_>,
    scale: Scale<'_>,
    view: View,
    figure: &mut Figure,
    [lo, hi]: [f64; 2],
) -> Vec<(f64, f64)> {
    let Some(run) = subject.pull.and_then(|pull| pull.run()) else { return Vec::new() };
    let line = line(run, |at| scale.place(view, [at.approach, at.force, at.contact_radius]));
    let falls = subject.curve.setting.control == Control::Force;
    let is_near = |(x, _): &(f64, f64)| !falls || (2.0 * lo - hi..=2.0 * hi - lo).contains(x);
    let points = line.points.iter().copied().filter(is_near).collect();
    figure.lines.push(line);
    points
}

/// P over time.
pub fn figure(subject: &Subject<'_>) -> Figure {
    let scale = subject.scale();
    let time = |t: f64| scale.shown(Quantity::Time, t);
    let (x, y) = (scale.axis("t", "time", Quantity::Time), scale.force_axis());
    let mut figure = Figure::empty(format!("{} over {}", y.title(), x.symbol), x, y);
    let Some(pull) = subject.pull else {
        let why = missing(subject.preset).map_or_else(|| NO_PULL.to_owned(), |why| why.to_string());
        figure.missing = Some(why);
        return figure;
    };
    let Some(run) = pull.run() else {
        figure.missing = pull.report.as_ref().err().map(|reason| format!("no pull: {reason}"));
        return figure;
    };
    let line = line(run, |at| (time(at.time), scale.force(at.force)));
    figure.bounds = Bounds::of(line.points.iter().copied());
    figure.lines.push(line);
    let mark = |sign, at: &MomentReport| Mark { sign, at: (time(at.time), scale.force(at.force)) };
    // A stands for the largest pull of the quasi-static path alone, which the log and the other charts show.
    let others = run.tension_peaks.iter().filter(|peak| **peak != run.peak);
    figure.marks.extend(others.chain([&run.peak]).map(|peak| mark(Sign::Minimum, peak)));
    figure.notes.push(format!("{} {}", figure.y.symbol, significant(scale.force(run.peak.force), 4)));
    figure
}
