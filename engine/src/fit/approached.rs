//! The rows of a retraction in which the edge still closes: after an approach at a rate G is below γ at the turn, and the
//! edge comes to rest only where G has risen to γ. From there on it is pulled from equilibrium, as the model has it.

use super::least_squares::LeastSquares;
use super::options::FitError;
use super::pose::PER_PARAMETER;
use super::problem::{FitProblem, START, Target};
use super::pulled::{is_pulled, rest_behind};
use super::rates::rate;
use super::solve::SolvedFit;
use crate::measured::asked::ValueRange;
use crate::measured::branches::{MeasuredPoint, median};
use crate::measured::{Abscissa, Branches, Instrument, Segment};
use crate::problem::Control;
use crate::units::Quantity;
use crate::units::number::{said, short};
use std::collections::BTreeSet;

/// The edge closes at most this much longer than the fitted values say, as a share of the way behind the turn.
const MARGIN: f64 = 1.1;
/// Rounds in which the values and the rows that are left out come to agree.
const ROUNDS: usize = 2;
/// Values that differ by more than so many errors contradict each other.
const DIFFERENT: f64 = 2.0;

/// The doubt about a fit whose approach cannot be followed.
const NOT_FOLLOWED: &str = "after an approach as fast as in this file the edge may still close in the first rows of the \
     retraction; the approach cannot be followed at the fitted values, so these rows are not left out";

/// That an approach cannot be followed, as where the bodies touch ahead of the edge.
struct NotFollowed;

/// The approach before a pull.
#[derive(Clone)]
pub(super) struct Approached {
    /// The rate of the control on the way up, and how long it was held at the turn.
    way: [f64; 2],
    /// Whether rows of the file show its rate. Otherwise it is taken to be as fast as the retraction.
    is_seen: bool,
    /// Whether the user leaves out the rows near the turn.
    is_cut: bool,
    /// What is doubtful if all its rows are used, in words.
    pub(super) doubt: Option<String>,
}

impl Approached {
    /// The approach before the points of `problem`, of which those within `range` of x in the file are used; `None` where
    /// these are not those of a pull from a turn.
    pub(super) fn of(problem: &FitProblem, branches: &Branches, range: Option<ValueRange>) -> Option<Self> {
        if !is_pulled(&problem.preset) || branches.abscissa == Abscissa::Radius {
            return None;
        }
        let of = |segment: Segment| {
            // Of several loops, the first one.
            let branch = branches.list.iter().find(|branch| branch.segment == segment);
            let mut points: Vec<&MeasuredPoint> = branch.iter().flat_map(|branch| &branch.attached).collect();
            points.sort_by_key(|point| point.at);
            points
        };
        let [up, down] = [of(Segment::Approach), of(Segment::Retraction)];
        let is_way =
            branches.abscissa == Abscissa::Position || problem.preset.path.control == Control::Displacement;
        let measured = rate(&up).map(|[rate, _]| -rate).filter(|rate| is_way && *rate > 0.0);
        let rate = measured.or(problem.preset.edge.rate)?;
        let hold = down.first().zip(up.last()).map_or(0.0, |(first, last)| {
            let pause = first.time - last.time;
            // Rows without times are taken to be even in time.
            let step = up.windows(2).map(|pair| (pair[1].x - pair[0].x).abs()).filter(|_| is_way).collect();
            let even = || median(step).map(|step| (first.at - last.at) as f64 * step / rate);
            if pause.is_finite() { pause } else { even().unwrap_or(0.0) }
        });
        let is_cut =
            range.is_some_and(|range| if branches.turned[0] { range.lo } else { range.hi }.is_finite());
        Some(Self { way: [rate, hold.max(0.0)], is_seen: measured.is_some(), is_cut, doubt: None })
    }

    /// `problem` without the rows in which the edge still closes at the values `u`. `None` where there are none, or where too
    /// few others are left; an error where the approach cannot be followed.
    fn without(&self, problem: &FitProblem, u: &[f64]) -> Result<Option<FitProblem>, NotFollowed> {
        let preset = problem.preset_at(u, Segment::Retraction).ok_or(NotFollowed)?;
        let at = problem.instrument_at(u);
        let value = |place| driven(problem.abscissa, preset.path.control, &at, place);
        let turn = value(problem.reach.turn);
        let rest = rest_behind(&preset, problem.reach.length, turn, self.way).ok_or(NotFollowed)?;
        let last = turn - MARGIN * (turn - rest);
        let mut left = problem.clone();
        left.data.retain(|datum| datum.free || value([datum.point.x, datum.point.force]) <= last);
        let rows = left.data.iter().filter(|datum| !datum.free).count();
        let is_enough = rows >= PER_PARAMETER * problem.parameters.len();
        Ok(Some(left).filter(|left| left.data.len() < problem.data.len() && is_enough))
    }

    /// `problem` at the values `u`, without the rows that a fit leaves out, σ being `scale` times as large; `None` where it
    /// leaves none out.
    pub(super) fn seen(&self, problem: &FitProblem, u: &[f64], scale: f64) -> Option<FitProblem> {
        let left = self.without(problem, u).ok().flatten();
        left.filter(|left| self.is_seen || contradicts(problem, left, [u, u], scale))
    }

    /// The fit without the rows in which the edge still closes, if the file shows the rate of the approach, or if these rows
    /// contradict an edge that rests. Otherwise the whole fit, and the approach, all rows of which are then used.
    pub(super) fn settled(
        self,
        whole: FitProblem,
        from: SolvedFit,
        notes: &mut Vec<String>,
        solve: impl Fn(&mut FitProblem, &[f64]) -> Result<SolvedFit, FitError>,
    ) -> (FitProblem, SolvedFit, Option<Self>) {
        let mut found: Option<(FitProblem, SolvedFit)> = None;
        for _ in 0..ROUNDS {
            let u = &found.as_ref().map_or(&from, |(_, solved)| solved).minimum.parameters;
            let mut problem = match self.without(&whole, u) {
                Ok(Some(problem)) => problem,
                Err(NotFollowed) if self.is_seen && found.is_none() => {
                    return (whole, from, Some(Self { doubt: Some(NOT_FOLLOWED.to_owned()), ..self }));
                }
                _ => break,
            };
            let Ok(solved) = solve(&mut problem, u) else { break };
            found = Some((problem, solved));
        }
        let Some((problem, solved)) = found else { return (whole, from, Some(self)) };
        let rows = whole.data.len() - problem.data.len();
        let both = [&from, &solved].map(|solved| &*solved.minimum.parameters);
        if !self.is_seen && !contradicts(&whole, &problem, both, solved.scale) {
            let moved = moved(&from, &solved, &problem).filter(|_| !self.is_cut);
            let doubt = moved.map(|(key, by)| doubt(&problem, rows, &key, by));
            return (whole, from, Some(Self { doubt, ..self }));
        }
        notes.push(self.note(&problem, rows));
        (problem, solved, None)
    }

    /// That so many first rows are left out, and why.
    pub(super) fn note(&self, problem: &FitProblem, rows: usize) -> String {
        let why = if self.is_seen {
            let rate = said(&problem.preset.units, Quantity::Speed, self.way[0]);
            format!("after an approach at {rate} the edge still closes there")
        } else {
            "they contradict an edge that rests at the turn; after a fast approach it would still close there"
                .to_owned()
        };
        format!("the first {rows} rows of the retraction are left out: {why}")
    }
}

/// Whether the rows of `whole` that are not in `left` contradict an edge that rests, σ being `scale` times as large: by how much
/// they raise χ², from a fit without them to one with them, or by the mean of a half of their residuals of one kind.
fn contradicts(whole: &FitProblem, left: &FitProblem, [with, without]: [&[f64]; 2], scale: f64) -> bool {
    /// The standard deviations that are hardly chance. Rows left out by chance cost a little precision, and rows kept against the
    /// evidence put all values off.
    const SURE: f64 = 3.5;
    /// A row counts as at most this many.
    const CLIPPED: f64 = 4.0;
    let mut kept = whole.clone();
    kept.data.clone_from(&left.data);
    let costs = whole.cost_at(with, f64::INFINITY).zip(kept.cost_at(without, f64::INFINITY));
    let rows = ((whole.data.len() - left.data.len()) * whole.per_point()) as f64;
    let raises =
        |(all, others): (f64, f64)| 2.0 * (all - others) / scale.powi(2) > rows + SURE * (2.0 * rows).sqrt();
    let is_kept: BTreeSet<usize> = left.data.iter().map(|datum| datum.point.at).collect();
    let per = whole.per_point();
    let residuals = whole.residuals(with);
    // Across the curve, and along the radius where that is measured, too.
    let of_part = |part: usize| -> Vec<f64> {
        let all = residuals.iter().flat_map(|all| whole.data.iter().zip(all.iter().skip(part).step_by(per)));
        all.filter(|(datum, _)| !is_kept.contains(&datum.point.at))
            .map(|(_, r)| (r / scale).clamp(-CLIPPED, CLIPPED))
            .collect()
    };
    let is_off = |half: &[f64]| half.iter().sum::<f64>().abs() > SURE * (half.len() as f64).sqrt();
    let any_off = |off: Vec<f64>| off.chunks(off.len().div_ceil(2).max(1)).any(is_off);
    costs.is_some_and(raises) || (0..per).any(|part| any_off(of_part(part)))
}

/// That the first rows, without which the value `key` differs by so many errors, may not be those of an edge that rests.
fn doubt(left: &FitProblem, rows: usize, key: &str, by: f64) -> String {
    let largest = left.data.iter().filter(|datum| !datum.free).map(|datum| datum.point.x);
    let to = largest.fold(f64::NEG_INFINITY, f64::max);
    let text = |to| said(&left.preset.units, Quantity::Length, to);
    let range = if left.turned[0] { format!("{}..", text(-to)) } else { format!("..{}", text(to)) };
    format!(
        "the edge is taken to rest where the retraction begins. After an approach as fast as the retraction it would still close in \
         the first {rows} rows, without which {key} differs by {} of its errors: leave them out with --range \"x={range}\"",
        short(by, 2)
    )
}

/// The value of the control at x and P of the points.
fn driven(abscissa: Abscissa, control: Control, at: &Instrument, [x, force]: [f64; 2]) -> f64 {
    let (way, force) = (x - at.offset, force - at.baseline - at.tilt * x);
    match control {
        Control::Force => force,
        Control::Stiffness(k) if abscissa == Abscissa::Approach => way + force / k,
        Control::Displacement | Control::Stiffness(_) => way,
    }
}

/// The value that differs most between two fits, by how many errors of the second one; `None` where none differs.
fn moved(one: &SolvedFit, two: &SolvedFit, problem: &FitProblem) -> Option<(String, f64)> {
    let errors = two.errors()?;
    let by = |j: usize| (two.minimum.parameters[j] - one.minimum.parameters[j]).abs() / errors[j];
    // Where the edge starts is another place in either fit.
    let of_start = Target::Key(START.to_owned());
    let others = problem.parameters.iter().enumerate().filter(|(_, parameter)| parameter.target != of_start);
    let all = others.map(|(j, parameter)| (parameter.key(), by(j)));
    all.max_by(|a, b| a.1.total_cmp(&b.1)).filter(|(_, by)| *by > DIFFERENT)
}
