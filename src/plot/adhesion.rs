//! The effect of the range of adhesion, over Maugis' `λ_M`: the loss of a loop and its largest pull, for the smooth
//! sphere and for the waves of Fig. 9. K. L. Johnson and J. A. Greenwood, J. Colloid Interface Sci. 192, 326 (1997),
//! doi:10.1006/jcis.1997.4984, map the regimes for the sphere.

use super::paper::{PaperError, PaperSheet, shipped};
use crate::figure::{Axis, AxisScale, Figure, Line, Mark, Role, Sign};
use pulloff_engine::case::{Case, CaseError};
use pulloff_engine::problem::cohesion::StatedCohesion;
use pulloff_engine::problem::{Adhesion, Control, Turn};
use pulloff_engine::progress::Unwatched;
use pulloff_engine::quasistatic::path::PathSetting;
use pulloff_engine::quasistatic::{Detail, Losses};
use pulloff_engine::report::number::significant;
use pulloff_engine::theory::maugis::Maugis;
use rayon::iter::{IntoParallelIterator, ParallelIterator};
use std::f64::consts::PI;

/// The names of the figures.
pub const NAMES: [&str; 2] = ["range-loss", "range-pull"];

/// The range of `λ_M`, from where the range of adhesion is long to where it hardly matters, and the number of values.
const FROM: f64 = 0.05;
const TO: f64 = 50.0;
const COUNT: i32 = 31;

/// δ/R at which the loops turn.
const TURN: f64 = 0.02;

/// Loops over `λ_M`: `λ_M`, the loss over that of adhesion without a range, and −P/πγR of the largest pull.
struct Over {
    name: &'static str,
    points: Vec<[f64; 3]>,
    /// The largest `λ_M` at which a loop reaches states with more than one disc in one zone.
    ends: Option<f64>,
}

fn loops(name: &'static str, preset: &'static str) -> Result<Over, PaperError> {
    let preset = shipped(preset, &["basis.kind=exact", "path.control=displacement"])?;
    let (gamma, setting) = (preset.material.work_of_adhesion, PathSetting::new(Control::Displacement));
    let setting = PathSetting { losses: Losses::Once, detail: Detail::Borders, ..setting };
    let of = |case: &Case| case.cycle(Some(Turn::Approach(TURN)), &setting, &Unwatched);
    let short = of(&Case::new(&preset)?)?.losses();
    let at = |k| FROM * (TO / FROM).powf(f64::from(k) / f64::from(COUNT - 1));
    let loop_at = |maugis| {
        let mut preset = preset.clone();
        // The preset has R = E* = 1.
        preset.material.adhesion =
            Adhesion::Dugdale(StatedCohesion::Strength(Maugis::of(maugis, gamma).strength));
        match of(&Case::with_range(&preset, &Unwatched)?) {
            Ok(path) if path.is_whole() => {
                let pull = path.largest_pull().map_or(f64::NAN, |at| -at.force / (PI * gamma));
                Ok(Some([maugis, path.losses() / short, pull]))
            }
            Ok(_) | Err(CaseError::Path { .. }) => Ok(None),
            Err(error) => Err(PaperError::from(error)),
        }
    };
    // One loop takes up to a second.
    let loops = (0..COUNT).into_par_iter().map(|k| loop_at(at(k))).collect::<Result<Vec<_>, _>>()?;
    let ends = (0..COUNT).zip(&loops).rfind(|(_, found)| found.is_none()).map(|(k, _)| at(k));
    Ok(Over { name, points: loops.into_iter().flatten().collect(), ends })
}

/// Both figures.
///
/// # Errors
/// [`PaperError`].
pub fn sheets() -> Result<[PaperSheet; 2], PaperError> {
    let all = [loops("smooth sphere", "fig-3-jkr")?, loops("waves of Fig. 9", "fig-9")?];
    let ends = all.iter().filter_map(|over| {
        let (last, name) = (over.ends?, over.name);
        let first = over.points.first()?[0];
        Some(format!(
            " For the {name} λ_M = {} is the smallest shown; at {} the contact is no longer one disc in one zone.",
            significant(first, 3),
            significant(last, 3)
        ))
    });
    let ends: String = ends.collect();
    let [sphere, _] = &all;
    let gamma = shipped("fig-3-jkr", &[])?.material.work_of_adhesion;
    let exact: Vec<(f64, f64)> =
        sphere.points.iter().map(|at| (at[0], Maugis::of(at[0], gamma).largest_pull())).collect();
    let apart = sphere.points.iter().zip(&exact).map(|(at, exact)| (at[2] / exact.1 - 1.0).abs());
    let apart = apart.fold(0.0, f64::max);
    let axis = |title: &str, run: AxisScale| Axis::pure(title.to_owned()).running(run);
    let sheet = |name, of: usize, y: &str, more: Vec<Line>, caption: String| {
        let at = |over: &Over| over.points.iter().map(|at| (at[0], at[of])).collect::<Vec<_>>();
        let marks = all.iter().flat_map(&at).map(|at| Mark { sign: Sign::Value, at }).collect();
        let lines = (1..)
            .zip(&all)
            .map(|(k, over)| Line::new(Role::Pin(k), over.name, at(over)))
            .chain(more)
            .collect();
        let figure = Figure::of(axis("λ_M", AxisScale::Logarithmic), axis(y, AxisScale::Linear), lines);
        PaperSheet { name, figure: Figure { marks, ..figure }, caption }
    };
    let level = |y: f64| Line::new(Role::Zero, "", vec![(FROM, y), (TO, y)]);
    let what = format!(
        "loops under displacement that turn at δ = {TURN} R, computed at the marks, over Maugis' λ_M.{ends}"
    );
    Ok([
        sheet(
            NAMES[0],
            1,
            "loss over short-range loss",
            vec![level(1.0)],
            format!("What adhesion with a range loses, over what short-range adhesion loses: {what}"),
        ),
        sheet(
            NAMES[1],
            2,
            "-P/(πγR)",
            vec![level(1.5), level(2.0), Line::new(Role::Exact, "Maugis", exact)],
            format!(
                "The largest pull of {what} Of the sphere it differs from Maugis' closed form (dots) by at most {} of it; the thin \
                 lines are the limits of Johnson, Kendall and Roberts (1.5) and of Derjaguin, Muller and Toporov (2).",
                significant(apart, 2)
            ),
        ),
    ])
}
