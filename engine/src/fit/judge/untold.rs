//! Whether the points could tell a work of adhesion that grows with the speed of the edge from one that does not.
//!
//! ```text
//! G = γ (1 + √(v/v₀))         v₀ = 3 times the median speed of the rows:     G is 1.6 γ there
//! G = γ/(1 + √(v/v₀))         of a closing edge
//! ```
//!
//! after A. N. Gent and J. Schultz, J. Adhesion 3, 281 (1972), with their exponent near ½. A modulus takes up much of
//! such a law: for force over radius, all of √G that goes as s^{3/2}. The law is fitted. Where it fits as well as none,
//! within one and a half standard errors plus those by which the points lean to such a law, the values are only a
//! guess. Steeper laws are told more easily, and weaker ones move the values by less. A point is moved to where its
//! state would be with γ alone, at its own radius:
//!
//! ```text
//! P + 2E* s T (√(G/γ) − 1)     δ + T (√(G/γ) − 1)     T = √(2πγs/E*)
//! ```
//!
//! Each row counts as far as its speed is known: an error in the speed changes its G.

use super::super::options::letter;
use super::super::problem::FitProblem;
use super::super::solve::solve;
use super::super::track::Mover;
use super::super::verdict::{Reason, UNTOLD};
use super::Evidence;
use super::edge::EdgeMotion;
use crate::elementary::{exp_m1, hypot, pow};
use crate::measured::branches::median;
use crate::measured::{Abscissa, Segment};
use crate::problem::Control;
use crate::progress::Unwatched;
use crate::units::number::short;
use nalgebra::DVector;
use std::collections::BTreeMap;
use std::f64::consts::TAU;

/// v₀ over the median speed.
const REFERENCE: f64 = 3.0;
/// A law that is off by no more than this many standard errors is as good; the limit is larger by the standard errors
/// by which the points lean to such a law, up to three.
const AS_GOOD: f64 = 1.5;
const MOST_LEANING: f64 = 3.0;
/// A value that such a law moves by no more than this many of its errors counts as determined all the same.
const MOVED: f64 = 3.0;
/// Rows of the fits; where there are more, a part stands for all.
const ROWS: usize = 400;
/// Rounds of each fit, and how often the points are moved again.
const ROUNDS: usize = 40;
const TIMES: usize = 30;
/// Residuals count as at most this many s.
const MOST: f64 = 4.0;
/// The standard deviation, in units of the bend, of a speed that may be anything within ± its bend. A logarithm that is
/// less certain than this says nothing.
const OF_BEND: f64 = 0.577_35;
const NOTHING: f64 = 3.0;

/// A law that grows with the speed and fits as well; `lean` is the number of standard errors by which the points lean
/// to one.
pub(super) fn untold(evidence: Evidence, edge: &EdgeMotion, lean: f64) -> Option<Reason> {
    let Evidence { problem, solved, scatter, inner } = evidence;
    let (s, inner) = (scatter.contact?, inner?);
    let usual = median((0..problem.data.len()).filter_map(|i| edge.speed(i)).collect())?;
    let u = &solved.minimum.parameters;
    let slopes = problem.changed(u, Mover::Adhesion, |_| 1.0)?;
    let law = AdhesionGrowth::of(problem, edge, (REFERENCE * usual, &slopes, s));
    let (moved, worse) = law.against_none(problem, u, s)?;
    let errors = |j: usize| moved[j].abs() / (s * inner[(j, j)].max(0.0).sqrt());
    let enough = AS_GOOD + lean.clamp(0.0, MOST_LEANING);
    if worse > enough * enough || (0..moved.len()).all(|j| errors(j) < MOVED) {
        return None;
    }
    let model = problem.parameters.iter().enumerate().filter(|(_, parameter)| parameter.scale.is_none());
    let told: Vec<String> = model
        .map(|(j, parameter)| {
            let name = letter(&problem.preset, &parameter.key());
            format!("{name} {:+.0} %", 100.0 * exp_m1(moved[j])).replace('-', "−")
        })
        .collect();
    let sentence = format!(
        "the points do not show whether the work of adhesion {} with the speed of the {}{}: one that is \
         {} times its value at rest at the median speed fits as well, with {}. Slower edges, or a wider \
         range of speeds, would decide",
        edge.verb(),
        edge.noun(),
        edge.clock.condition(),
        short(pow(1.0 + REFERENCE.recip().sqrt(), edge.sense()), 2),
        told.join(", ")
    );
    Some(Reason::new(UNTOLD, worse, sentence))
}

/// A work of adhesion that grows: √(G/γ) − 1 at each row, by its place, and how much the residuals of the row count.
struct AdhesionGrowth(BTreeMap<usize, (f64, Vec<f64>)>);

impl AdhesionGrowth {
    /// With v₀, the derivatives of the residuals with respect to ln γ, and s.
    fn of(
        problem: &FitProblem,
        edge: &EdgeMotion,
        (reference, slopes, s): (f64, &DVector<f64>, f64),
    ) -> Self {
        let per = problem.per_point();
        let mut rows = BTreeMap::new();
        for (i, datum) in problem.data.iter().enumerate() {
            let Some((speed, known)) = edge.speed(i).zip(edge.speeds[i]) else { continue };
            let x = (speed / reference).sqrt();
            let off = (hypot(known.error, OF_BEND * known.bend) / speed).min(NOTHING);
            let of_energy = 0.5 * x / (1.0 + x) * off;
            let count = |k: usize| 1.0 / (1.0 + (slopes[per * i + k] * of_energy / s).powi(2));
            rows.insert(
                datum.point.at,
                (pow(1.0 + x, 0.5 * edge.sense()) - 1.0, (0..per).map(count).collect()),
            );
        }
        Self(rows)
    }

    /// How far the values of `problem` move with it, from `u`, and by how much its χ² is larger than that of no law.
    fn against_none(&self, problem: &FitProblem, u: &[f64], s: f64) -> Option<(DVector<f64>, f64)> {
        let mut part = problem.thinned(ROWS);
        let times = problem.data.len() as f64 / part.data.len() as f64;
        let ones = vec![1.0; problem.per_point()];
        let count = |at: usize| self.0.get(&at).map_or(&ones, |(_, counts)| counts).clone();
        part.counts = Some(part.data.iter().flat_map(|datum| count(datum.point.at)).collect());
        let none = solve(&part, u, true, ROUNDS, &Unwatched)?;
        let growth = |at: usize| self.0.get(&at).map_or(0.0, |(growth, _)| *growth);
        let (with, found) = grown(&part, &none.minimum.parameters, &growth, s)?;
        let worse = times * (found - cost(&part, &none.minimum.at.residuals, s));
        Some((DVector::from_vec(with) - DVector::from_column_slice(&none.minimum.parameters), worse))
    }
}

/// χ² of the points with their counts, in s².
fn cost(problem: &FitProblem, residuals: &DVector<f64>, s: f64) -> f64 {
    let counts = problem.counts.as_deref().unwrap_or_default();
    let of = |(i, r): (usize, &f64)| counts.get(i).unwrap_or(&1.0) * (r / s).clamp(-MOST, MOST).powi(2);
    residuals.iter().enumerate().map(of).sum()
}

/// The fit from `start` in which √G is larger than √γ by the share `growth` of the place of each row, and its χ².
fn grown(
    problem: &FitProblem,
    start: &[f64],
    growth: &dyn Fn(usize) -> f64,
    s: f64,
) -> Option<(Vec<f64>, f64)> {
    /// A χ² that changes by no more than this has settled.
    const SETTLED: f64 = 0.02;
    let compliance = match (problem.abscissa, problem.preset.path.control) {
        (Abscissa::Position, Control::Stiffness(k)) => 1.0 / k,
        _ => 0.0,
    };
    let (mut u, mut last) = (start.to_vec(), f64::INFINITY);
    for _ in 0..TIMES {
        let material = problem.preset_at(&u, Segment::Retraction)?.material;
        let [e, gamma] = [material.effective_modulus, material.work_of_adhesion];
        let mut moved = problem.clone();
        for i in 0..moved.data.len() {
            let radius = moved.radius(i);
            let datum = &mut moved.data[i];
            let way = (TAU * gamma * radius / e).sqrt() * growth(datum.point.at);
            if datum.free || !way.is_finite() {
                continue;
            }
            let force = 2.0 * e * radius * way;
            datum.point.force += force;
            if problem.abscissa != Abscissa::Radius {
                datum.point.x += way + compliance * force;
            }
        }
        let solved = solve(&moved, &u, true, ROUNDS, &Unwatched)?;
        let found = cost(&moved, &solved.minimum.at.residuals, s);
        u = solved.minimum.parameters;
        if (found - last).abs() < SETTLED {
            return Some((u, found));
        }
        last = found;
    }
    None
}
