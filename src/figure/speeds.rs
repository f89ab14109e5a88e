//! G of the measured rows over the speed of the edge, with the law of the preset, both as logarithms: a power law is a
//! straight line.

use super::bounds::Bounds;
use super::measured::DRAWN;
use super::parts::{Figure, Line, Mark, Role, Sign};
use super::subject::Subject;
use crate::explorer::speeds::untimed;
use pulloff_engine::measured::Segment;
use pulloff_engine::preset::Preset;
use pulloff_engine::rate::law::Motion;
use pulloff_engine::report::pull::law;
use pulloff_engine::report::speeds::SpeedRow;
use pulloff_engine::units::Quantity;

/// The number of points on the line of a law.
const POINTS: u32 = 100;

/// Builds the view.
pub fn figure(subject: &Subject<'_>) -> Figure {
    let scale = subject.scale();
    let axis = |symbol: &str, unit, quantity| scale.axis(&format!("lg {symbol}"), unit, quantity);
    let (x, y) = (axis("v", "speed", Quantity::Speed), axis("G", "energy per area", Quantity::EnergyPerArea));
    let mut figure = Figure::empty(format!("{} over {}", y.title(), x.symbol), x, y);
    let report = match subject.speeds.map(|speeds| &speeds.report) {
        Some(Ok(report)) => report,
        Some(Err(why)) => {
            figure.missing = Some(format!("no speeds: {why}"));
            return figure;
        }
        None => {
            figure.missing = Some(untimed(subject.preset).unwrap_or_else(|| "no speeds yet".to_owned()));
            return figure;
        }
    };
    let at = |speed: f64, released: f64| {
        let speed = scale.shown(Quantity::Speed, speed).log10();
        (speed, scale.shown(Quantity::EnergyPerArea, released).log10())
    };
    // A value no larger than its error has no meaningful logarithm.
    let known = |row: &&SpeedRow| {
        let speed = row.speed.zip(row.speed_error).is_some_and(|(speed, error)| speed.abs() > error);
        speed && row.energy_release_rate > row.error
    };
    let rows: Vec<&SpeedRow> = report.rows.iter().filter(known).collect();
    figure.marks.extend(rows.iter().step_by(rows.len().div_ceil(DRAWN).max(1)).filter_map(|row| {
        let speed = row.speed?;
        let sign = Sign::Measured { loading: is_closing(row), apart: false };
        Some(Mark { sign, at: at(speed.abs(), row.energy_release_rate) })
    }));
    // The approach first, because each is drawn as one.
    figure.marks.sort_by_key(|mark| mark.sign != Sign::Measured { loading: true, apart: false });
    let speeds = rows.iter().filter_map(|row| row.speed.map(f64::abs));
    let [lo, hi] = speeds.fold([f64::INFINITY, 0.0_f64], |[lo, hi], v| [lo.min(v), hi.max(v)]);
    if lo < hi {
        let between = |i: u32| lo * (hi / lo).powf(f64::from(i) / f64::from(POINTS));
        for (motion, role, name) in [
            (Motion::Opening, Role::Law, "law of the edge"),
            (Motion::Closing, Role::Loading, "as it closes"),
        ] {
            let goes = |row: &&SpeedRow| is_closing(row) == (motion == Motion::Closing);
            let Some(released) = of_law(subject.preset, motion).filter(|_| rows.iter().any(goes)) else {
                continue;
            };
            let points = (0..=POINTS).map(between).map(|v| at(v, released(v))).collect();
            figure.lines.push(Line::new(role, name, points));
        }
    }
    let places = figure.marks.iter().map(|mark| mark.at);
    figure.bounds = Bounds::of(places.chain(figure.lines.iter().flat_map(|line| line.points.clone())));
    figure
}

/// Whether the edge closes at a row: the sign of a speed near its error would be that of the noise.
fn is_closing(row: &SpeedRow) -> bool {
    row.segment == Segment::Approach.name()
}

/// G over the speed of an edge in this motion, by the law of a preset that has one.
fn of_law(preset: &Preset, motion: Motion) -> Option<impl Fn(f64) -> f64> {
    let (law, reference) = law(preset).ok()?;
    let opening = preset.material.work_of_adhesion;
    let closing = preset.edge.closing_work_of_adhesion.unwrap_or(opening);
    Some(move |speed: f64| {
        let [drive, _] = law.of(motion).drive(speed / reference);
        match motion {
            Motion::Opening => opening * (1.0 + drive),
            Motion::Closing => closing / (1.0 + drive),
        }
    })
}
