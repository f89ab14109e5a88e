//! Where a fit starts: the preset's values and a scan around them.
//!
//! E* runs over five decades; at each value γ is such that the smallest force is that of the points, and δ₀ is the
//! median offset. Other free keys are tried at a few multiples of their values.

use super::aligned::may_end_early;
use super::least_squares::{LeastSquares, cost};
use super::problem::{ADHESION, Datum, FitProblem, MODULUS, START, Target};
use super::pulled::is_pulled;
use super::solve::{HUBER, solve};
use super::track::begins;
use crate::elementary::ln;
use crate::gap::Gap;
use crate::measured::branches::median;
use crate::measured::{Abscissa, Segment};
use crate::preset::edge;
use crate::preset::schema::RANGE_KEYS;
use crate::problem::{Adhesion, Cohesion, Control};
use crate::progress::{Progress, ProgressPart};
use nalgebra::DVector;

/// Values of E*, and the decades they span.
const MODULI: usize = 31;
const DECADES: f64 = 5.0;
/// What a closing edge gains, over the first guess.
const CLOSINGS: [f64; 3] = [1.0, 0.4, 0.1];
/// Factors at which another free key is tried.
const FACTORS: [f64; 5] = [1.0, 0.577_350_269_189_625_8, 1.732_050_807_568_877_2, 1.0 / 3.0, 3.0];
/// The most candidates.
const MOST: usize = 400;
/// The number of points by which candidates are compared, and of those on which the best are run.
const COMPARED: usize = 60;
const RUN: usize = 240;
/// On waves a candidate is judged by where a few rounds lead it: how many of the best are run, and how many of a record that may
/// end early, how many times as far off as the nearest they may be, and for how many rounds.
const POOL: usize = 12;
const MANY: usize = 48;
const NEAR: f64 = 3.0;
const FEW_ROUNDS: usize = 4;
/// How many of the best are run, and for how many rounds.
pub const BEST: usize = 5;
const ROUNDS: usize = 40;

/// Ends count as one if no value differs by more than the first of these, and starts as two if some value differs by
/// more than the second.
const ONE: f64 = 0.01;
const OTHER: f64 = 0.2;
/// Points at a larger mean distance, in σ, are not reached, whatever starts end there.
pub(super) const REACHED: f64 = 2.0;
/// Ends whose mean distances differ by less than this factor, or by a share of less than `FEW` over the number of rows, are left
/// to all rows, which may not tell them apart either.
const AS_NEAR: f64 = 1.02;
const FEW: f64 = 4.0;

/// A start that was run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tried {
    /// The mean distance of the points at its end, in σ.
    pub distance: f64,
    /// The snaps of its path there.
    pub snaps: usize,
}

/// Where a start ends.
#[derive(Debug, Clone)]
struct FitEnd {
    u: Vec<f64>,
    residuals: DVector<f64>,
    /// Their scale, in σ.
    scale: f64,
    /// Their mean, in σ.
    distance: f64,
    /// Whether rows are apart where it holds the bodies in contact.
    is_late: bool,
}

impl FitEnd {
    /// Whether it is nearer to the points than another one: by what a fit minimizes, at the scale of the better one, or by
    /// the mean distance where neither is near them. One that has contact where the bodies are apart must be much nearer.
    fn is_nearer(&self, other: &Self, robust: bool) -> bool {
        const MUCH: f64 = 1.5;
        let huber = if robust { HUBER * self.scale.min(other.scale) } else { f64::INFINITY };
        let is_near = self.distance.min(other.distance) < REACHED;
        let far = |end: &Self| {
            let far = if is_near { cost(&end.residuals, None, huber) } else { end.distance };
            if end.is_late { MUCH * far } else { far }
        };
        // Less than half of χ² tells nothing, and the first of two equal ends stays.
        let nothing = if is_near { 0.25 * self.scale.min(other.scale).powi(2) } else { 0.0 };
        far(self) < far(other) - nothing
    }
}

impl FitProblem {
    /// The end that is reached from `u`; `u` itself where nothing is.
    fn end_from(&self, u: Vec<f64>, robust: bool, progress: &dyn Progress) -> Option<FitEnd> {
        let solved = solve(self, &u, robust, ROUNDS, progress).map(|solved| solved.minimum.parameters);
        let solved = solved.filter(|end| !self.runs_away(&u, end));
        let of = |u: Vec<f64>| {
            let residuals = self.residuals(&u)?;
            let (scale, distance) = (self.scale(&residuals), self.distance(&u)?);
            let is_late = self.is_late(&u, scale);
            Some(FitEnd { u, residuals, scale, distance, is_late })
        };
        solved.and_then(of).or_else(|| of(u))
    }

    /// Whether E* changes on the way from `u` to `end` by far more than the scan of starts spans: then rounding alone makes the
    /// path go through the points.
    fn runs_away(&self, u: &[f64], end: &[f64]) -> bool {
        const FAR: f64 = 2.0 * DECADES * std::f64::consts::LN_10;
        self.index(|target| target.key() == MODULUS).into_iter().any(|j| (u[j] - end[j]).abs() > FAR)
    }

    /// The mean distance at `u`.
    fn distance(&self, u: &[f64]) -> Option<f64> {
        let residuals = self.residuals(u)?;
        let mean = residuals.iter().map(|r| r.abs()).sum::<f64>() / residuals.len() as f64;
        mean.is_finite().then_some(mean)
    }

    fn index(&self, is: impl Fn(&Target) -> bool) -> Vec<usize> {
        (0..self.parameters.len()).filter(|j| is(&self.parameters[*j].target)).collect()
    }

    /// Sets γ so that the smallest force is that of the points, and δ₀ to their median offset; where several states have the
    /// same force, on waves and if all of it is tension, also to that of the pull-off.
    fn settled(&self, mut u: Vec<f64>, least: f64) -> Option<Vec<Vec<f64>>> {
        const TIMES: usize = 6;
        let adhesions =
            self.index(|t| matches!(t, Target::Adhesion(_)) || *t == Target::Key(ADHESION.to_owned()));
        let offsets = self.index(|t| *t == Target::Offset);
        self.begun(&mut u);
        for _ in 0..if adhesions.is_empty() || least >= 0.0 { 0 } else { TIMES } {
            self.begun(&mut u);
            let paths = self.paths(&u)?;
            let ratio = least / paths.of(Segment::Retraction).least_force;
            if !(ratio > 0.0 && ratio.is_finite()) || (ratio - 1.0).abs() < 0.01 {
                break;
            }
            // The smallest force of a cone grows with the square of γ.
            for &j in &adhesions {
                u[j] += 0.7 * ln(ratio);
            }
        }
        let early = if may_end_early(&self.preset, &self.data) {
            self.cut_early(&u, &adhesions, &offsets)
        } else {
            Vec::new()
        };
        if let (&[j], false) = (offsets.as_slice(), self.abscissa == Abscissa::Radius) {
            let paths = self.paths(&u)?;
            let at = self.instrument_at(&u);
            let offset = |datum: &Datum| {
                let x = paths.of(datum.segment).x_at_force(datum.point.force - at.baseline)?;
                Some(datum.point.x - x)
            };
            let offsets: Vec<f64> = self.data.iter().filter(|datum| !datum.free).filter_map(offset).collect();
            let of_retraction =
                self.data.iter().filter(|datum| !datum.free && datum.segment == Segment::Retraction);
            let last = of_retraction.map(|datum| datum.point.x).fold(f64::INFINITY, f64::min);
            let ends = paths.of(Segment::Retraction).vertices.iter().map(|vertex| vertex.at[0]);
            let pull_off = last - ends.fold(f64::INFINITY, f64::min);
            let attached = self.data.iter().filter(|datum| !datum.free);
            let most =
                attached.map(|datum| datum.point.force - at.baseline).fold(f64::NEG_INFINITY, f64::max);
            let is_ambiguous = self.preset.gap.feature_length().is_some() || most < 0.0;
            let pull_off = Some(pull_off).filter(|x| is_ambiguous && x.is_finite());
            let found = median(offsets).into_iter().chain(pull_off);
            let with = |offset| {
                let mut u = u.clone();
                u[j] = self.parameters[j].inner(Target::Offset.sign(self.turned) * offset);
                // Where x is zero tells at which radius the first points lie.
                self.begun(&mut u);
                u
            };
            let found: Vec<Vec<f64>> = found.map(with).chain(early).collect();
            return Some(if found.is_empty() { vec![u] } else { found });
        }
        Some([u].into_iter().chain(early).collect())
    }

    /// Candidates for a record that ends before the smallest force of its path: larger works of adhesion than that of `u`, each
    /// with the offset that suits it.
    fn cut_early(&self, u: &[f64], adhesions: &[usize], offsets: &[usize]) -> Vec<Vec<f64>> {
        const LARGER: [f64; 7] = [1.0, 1.25, 1.6, 2.0, 2.5, 3.2, 4.0];
        /// Where a wave more or less is held open.
        const WAVES: usize = 2;
        let with = |factor: &f64| {
            let mut u = u.to_vec();
            for &j in adhesions {
                u[j] += ln(*factor);
            }
            match offsets {
                [j] => self.aligned(&u, *j, WAVES),
                _ => vec![u],
            }
        };
        let count = if adhesions.is_empty() { 1 } else { LARGER.len() };
        LARGER[..count].iter().flat_map(with).collect()
    }

    /// Candidates where adhesion has a range: the best ones without a range, which are found quickly, with some ranges
    /// where that is free. `None` where adhesion has no range, or where nothing is found without one.
    fn of_ranges(&self, robust: bool, progress: &dyn Progress) -> Option<Vec<Vec<f64>>> {
        /// Maugis' `λ_M`.
        const MAUGIS: [f64; 4] = [0.15, 0.5, 1.2, 3.0];
        self.preset.cohesion()?;
        let own: Vec<f64> =
            self.parameters.iter().map(|parameter| parameter.inner(parameter.start)).collect();
        let range = self.free_range();
        let mut short = match range {
            Some(j) => self.holding(j, own[j])?,
            None => self.clone(),
        };
        short.preset.material.adhesion = Adhesion::ShortRange;
        let found = start(&short, true, robust, &ProgressPart::new(progress, [0.0, 0.5]))?.best;
        let Some(j) = range else { return Some(vec![own, found]) };
        let preset = short.preset_at(&found, Segment::Retraction)?;
        let (gamma, e) = (preset.material.work_of_adhesion, preset.material.effective_modulus);
        // λ_M is σ₀ times this.
        let unit = Cohesion { strength: 1.0, range: gamma };
        let own_strength = self.preset.cohesion()?.strength;
        let strengths = MAUGIS.map(|maugis| match preset.gap.radius_of_curvature() {
            Some(radius) => maugis / unit.maugis(radius, e),
            None => maugis * own_strength,
        });
        let is_strength = self.parameters[j].key() == RANGE_KEYS[0];
        let with = |strength: f64| {
            let mut u = found.clone();
            u.insert(j, self.parameters[j].inner(if is_strength { strength } else { gamma / strength }));
            u
        };
        Some(std::iter::once(own).chain(strengths.map(with)).collect())
    }

    /// Candidates around the preset's values where adhesion has a range: with it, and E*, a few times smaller and larger.
    fn around_own(&self) -> Vec<Vec<f64>> {
        const RANGES: [f64; 5] = [1.0, 0.5, 2.0, 0.25, 4.0];
        const MODULI: [f64; 5] = [1.0, 0.3, 3.0, 0.1, 10.0];
        let own: Vec<f64> =
            self.parameters.iter().map(|parameter| parameter.inner(parameter.start)).collect();
        let modulus = self.index(|target| target.key() == MODULUS);
        varied(varied(vec![own], self.free_range(), &RANGES), modulus.first().copied(), &MODULI)
    }

    /// Candidates for a pull at a rate: the best ones of a quasi-static retraction, whose moduli are too large, with
    /// slow and fast laws. `None` where there is no such pull.
    fn of_rates(&self, robust: bool, progress: &dyn Progress) -> Option<Vec<Vec<f64>>> {
        /// E* over that of the quasi-static fit, v₀ over the rate of the device, n.
        const SOFTER: [f64; 3] = [1.0, 0.7, 0.45];
        const SPEEDS: [f64; 4] = [0.01, 0.3, 3.0, 100.0];
        const EXPONENTS: [f64; 2] = [0.35, 0.7];
        if !is_pulled(&self.preset) {
            return None;
        }
        let own: Vec<f64> =
            self.parameters.iter().map(|parameter| parameter.inner(parameter.start)).collect();
        let of_edge =
            |target: &Target| matches!(target, Target::Key(key) if key.starts_with("edge.") || key == START);
        let free = self.index(of_edge);
        let mut still = self.clone();
        for &j in free.iter().rev() {
            still = still.holding(j, own[j])?;
        }
        still.preset.edge.rate = None;
        let mut base = start(&still, true, robust, &ProgressPart::new(progress, [0.0, 0.3]))?.best;
        for &j in &free {
            base.insert(j, own[j]);
        }
        let [modulus, speed, exponent] = [MODULUS, edge::REFERENCE_SPEED, edge::EXPONENT]
            .map(|key| self.index(|target| target.key() == key).first().copied());
        // The rate of a force is not a speed: there the guess of the preset takes its place.
        let is_force = self.preset.path.control == Control::Force;
        let unit = self.preset.edge.rate.filter(|_| !is_force).or(self.preset.edge.reference_speed)?;
        let mut list = vec![own];
        for (j, value) in [(speed, unit), (exponent, 1.0)] {
            if let Some(j) = j {
                base[j] = ln(value);
            }
        }
        list.extend(varied(
            varied(varied(vec![base], modulus, &SOFTER), speed, &SPEEDS),
            exponent,
            &EXPONENTS,
        ));
        Some(list)
    }

    /// Sets the contact radius at which a pull begins, or an edge is pinned, where that is free, to what the values
    /// give at the first points.
    pub(super) fn begun(&self, u: &mut [f64]) {
        let Some(&j) = self.index(|target| target.key() == START).first() else { return };
        let at = self.instrument_at(u);
        let x = self.reach.turn[0] - if self.abscissa == Abscissa::Radius { 0.0 } else { at.offset };
        let before = if self.splits() { Segment::Approach } else { Segment::Retraction };
        let preset = self.preset_at(u, before);
        let outermost = || begins(&preset?, self.abscissa, x, self.reach.length);
        if let Some(s) = self.reached(u, x).or_else(outermost) {
            u[j] = self.parameters[j].inner(s);
        }
    }

    /// The best start of an edge that is pinned on waves, by that of one which is not: while the way up is not known,
    /// neither is the wave on which it ends.
    fn pinned(&self, robust: bool, progress: &dyn Progress) -> Option<(Vec<f64>, Vec<Tried>)> {
        const TIMES: usize = 4;
        let j = *self.index(|target| target.key() == START).first()?;
        let own = self.parameters[j].inner(self.parameters[j].start);
        let StartEnds { best: mut u, tried, .. } = start(&self.holding(j, own)?, true, robust, progress)?;
        u.insert(j, own);
        let run = self.thinned(RUN);
        let mut nearest = f64::INFINITY;
        for _ in 0..TIMES {
            let mut next = u.clone();
            self.begun(&mut next);
            let Some(found) = solve(&run, &next, robust, ROUNDS, progress) else { break };
            let next = found.minimum.parameters;
            let Some(distance) = run.distance(&next).filter(|distance| *distance < nearest) else { break };
            (nearest, u) = (distance, next);
        }
        Some((u, tried))
    }

    /// The end of a pull that is reached by leaving `best` a few times, each time with one value changed by a large factor:
    /// the valleys of a pull are long, and two of them may lie side by side.
    fn left(&self, mut best: FitEnd, robust: bool, progress: &dyn Progress) -> FitEnd {
        /// How often, while that leads anywhere.
        const TIMES: usize = 3;
        const KEYS: [&str; 3] = [MODULUS, edge::REFERENCE_SPEED, START];
        const FACTORS: [[f64; 2]; 3] = [[0.7, 1.4], [0.1, 10.0], [0.7, 1.4]];
        for _ in 0..TIMES {
            let (before, from) = (best.distance, best.u.clone());
            for (key, factors) in KEYS.into_iter().zip(FACTORS) {
                let places = self.index(|target| target.key() == key);
                for (j, factor) in places.into_iter().flat_map(|j| factors.map(|factor| (j, factor))) {
                    if progress.stop() {
                        return best;
                    }
                    let mut next = from.clone();
                    next[j] += ln(factor);
                    if key != START {
                        self.begun(&mut next);
                    }
                    let end = self.end_from(next, robust, progress);
                    if let Some(end) = end.filter(|end| end.is_nearer(&best, robust)) {
                        best = end;
                    }
                }
            }
            if best.distance > (1.0 - ONE) * before {
                break;
            }
        }
        best
    }

    /// What became of a start that led to `end`.
    fn tried(&self, end: &FitEnd) -> Tried {
        let snaps = self.paths(&end.u).map_or(0, |paths| paths.of(Segment::Retraction).snaps);
        Tried { distance: end.distance, snaps }
    }

    /// The candidates, that of the preset first.
    fn candidates(&self, scan: bool) -> Vec<Vec<f64>> {
        let own: Vec<f64> =
            self.parameters.iter().map(|parameter| parameter.inner(parameter.start)).collect();
        let mut list = vec![own.clone()];
        if !scan {
            return list;
        }
        let modulus = self.index(|t| *t == Target::Key(MODULUS.to_owned()));
        // Where an edge is pinned follows from the other values.
        let is_other = |key: &str| key != ADHESION && key != MODULUS && key != START;
        let others = self.index(|t| matches!(t, Target::Key(key) if is_other(key)));
        let closing = self.index(|t| *t == Target::Adhesion(Segment::Approach));
        let mut grid = vec![own];
        for j in closing {
            grid = varied(grid, Some(j), &CLOSINGS);
        }
        for j in others {
            if grid.len() * FACTORS.len() > MOST / if modulus.is_empty() { 1 } else { MODULI } {
                break;
            }
            grid = varied(grid, Some(j), &FACTORS);
        }
        // On waves a smaller step is needed so as not to miss the right count of snaps.
        let fine = self.preset.gap.feature_length().is_some() && grid.len() == 1;
        let count = if fine { 2 * MODULI - 1 } else { MODULI };
        for u in grid {
            match modulus.first() {
                None => list.push(u),
                Some(&j) => list.extend((0..count).map(|i| {
                    let mut u = u.clone();
                    u[j] += (i as f64 / (count - 1) as f64 - 0.5) * DECADES * std::f64::consts::LN_10;
                    u
                })),
            }
        }
        list
    }
}

/// Where starts end.
#[derive(Debug, Clone)]
pub struct StartEnds {
    /// The best one.
    pub best: Vec<f64>,
    /// Others that are as near to the points, which are not all of the rows.
    pub others: Vec<Vec<f64>>,
    /// Those that were run.
    pub tried: Vec<Tried>,
}

impl StartEnds {
    /// The least mean distance of those that were run.
    fn nearest(&self) -> f64 {
        self.tried.iter().map(|tried| tried.distance).fold(f64::INFINITY, f64::min)
    }
}

/// The best start and those that were run; `progress` is told the share that is done.
pub fn start(problem: &FitProblem, scan: bool, robust: bool, progress: &dyn Progress) -> Option<StartEnds> {
    if scan && problem.loops && problem.pins() {
        let (best, tried) = problem.pinned(robust, progress)?;
        return Some(StartEnds { best, others: Vec::new(), tried });
    }
    let run = problem.thinned(RUN);
    let ranked = ranked(problem, scan, robust, progress);
    let found = best_of(&run, ranked, (scan, robust), progress);
    // A record that ends in tension misleads a law without range, and with it the starts taken from there.
    let is_near = |ends: &StartEnds| ends.nearest() < REACHED;
    if !scan || problem.preset.cohesion().is_none() || found.as_ref().is_none_or(is_near) {
        return found;
    }
    let compared = problem.thinned(COMPARED);
    let around = by_distance(problem, &compared, problem.around_own(), scan, progress);
    let mut around = led(&compared, around, POOL, robust, progress);
    around.truncate(BEST);
    let other = best_of(&run, around, (scan, robust), progress);
    // One that is hardly nearer may be worse in another respect.
    let is_better =
        |other: &StartEnds| found.as_ref().is_some_and(|found| 2.0 * other.nearest() < found.nearest());
    other.filter(is_better).or(found)
}

/// The candidates nearest to the points, each with its distance, the nearest first.
fn ranked(problem: &FitProblem, scan: bool, robust: bool, progress: &dyn Progress) -> Vec<(f64, Vec<f64>)> {
    let others = || problem.of_ranges(robust, progress).or_else(|| problem.of_rates(robust, progress));
    let candidates = if scan { others() } else { None }.unwrap_or_else(|| problem.candidates(scan));
    let compared = problem.thinned(COMPARED);
    let mut ranked = by_distance(problem, &compared, candidates, scan, progress);
    if scan && problem.preset.gap.feature_length().is_some() {
        let early = may_end_early(&problem.preset, &problem.data);
        ranked = led(&compared, ranked, if early { MANY } else { POOL }, robust, progress);
    }
    ranked.truncate(BEST);
    // The values of a pull that are given may be guesses that its scan does not come near.
    if scan && is_pulled(&problem.preset) {
        let own = by_distance(problem, &compared, problem.candidates(false), scan, progress);
        ranked = own.into_iter().chain(ranked).collect();
    }
    ranked
}

/// The candidates, the first as it is, and all of them as they suit the smallest force and where x is zero, each with its
/// distance, the nearest first.
fn by_distance(
    problem: &FitProblem,
    compared: &FitProblem,
    candidates: Vec<Vec<f64>>,
    scan: bool,
    progress: &dyn Progress,
) -> Vec<(f64, Vec<f64>)> {
    let attached = problem.data.iter().filter(|datum| !datum.free);
    let least = attached.map(|datum| datum.point.force).fold(f64::INFINITY, f64::min);
    let count = candidates.len() as f64;
    let mut ranked: Vec<(f64, Vec<f64>)> = Vec::new();
    for (i, u) in candidates.into_iter().enumerate() {
        progress.report(0.6 * i as f64 / count);
        if progress.stop() {
            break;
        }
        let at = problem.instrument_at(&u);
        let settled = if scan { compared.settled(u.clone(), least - at.baseline) } else { None };
        let own = Some(u).filter(|_| i == 0 || !scan);
        for u in own.into_iter().chain(settled.into_iter().flatten()) {
            ranked.extend(compared.distance(&u).map(|distance| (distance, u)));
        }
    }
    ranked.sort_by(|a, b| a.0.total_cmp(&b.0));
    ranked
}

/// At most `most` of the ranked candidates where a few rounds lead them, the nearest first.
fn led(
    compared: &FitProblem,
    mut ranked: Vec<(f64, Vec<f64>)>,
    most: usize,
    robust: bool,
    progress: &dyn Progress,
) -> Vec<(f64, Vec<f64>)> {
    ranked.truncate(most);
    let nearest = ranked.first().map_or(0.0, |(distance, _)| *distance);
    for (distance, u) in ranked.iter_mut().filter(|(distance, _)| *distance <= NEAR * nearest) {
        let led = solve(compared, u, robust, FEW_ROUNDS, progress).map(|led| led.minimum.parameters);
        if let Some((closer, led)) = led.and_then(|led| Some((compared.distance(&led)?, led)))
            && closer < *distance
        {
            (*distance, *u) = (closer, led);
        }
    }
    // Several of them lead to one place.
    let mut places: Vec<(f64, Vec<f64>)> = Vec::new();
    for (distance, u) in ranked {
        if places.iter().all(|(_, other)| apart(other, &u) > ONE) {
            places.push((distance, u));
        }
    }
    places.sort_by(|a, b| a.0.total_cmp(&b.0));
    places
}

/// Each of `list` with its value `j`, a logarithm, at each of `factors`.
fn varied(list: Vec<Vec<f64>>, j: Option<usize>, factors: &[f64]) -> Vec<Vec<f64>> {
    let Some(j) = j else { return list };
    let with = |u: &Vec<f64>, factor: f64| {
        let mut u = u.clone();
        u[j] += ln(factor);
        u
    };
    list.iter().flat_map(|u| factors.iter().map(|factor| with(u, *factor))).collect()
}

/// The largest difference of a value.
fn apart(u: &[f64], v: &[f64]) -> f64 {
    u.iter().zip(v).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// Fits `run` from each candidate, and returns where the best one ends, with what became of all.
fn best_of(
    run: &FitProblem,
    ranked: Vec<(f64, Vec<f64>)>,
    (scan, robust): (bool, bool),
    progress: &dyn Progress,
) -> Option<StartEnds> {
    let mut best: Option<FitEnd> = None;
    let mut tried = Vec::new();
    let mut ends: Vec<(f64, Vec<f64>)> = Vec::new();
    let count = ranked.len() as f64;
    let is_pulled = is_pulled(&run.preset);
    let mut from: Vec<Vec<f64>> = Vec::new();
    let mut is_final = false;
    for (i, (_, begun)) in ranked.into_iter().enumerate() {
        progress.report(0.6 + 0.4 * i as f64 / count);
        let Some(end) = run.end_from(begun.clone(), robust, progress) else { continue };
        tried.push(run.tried(&end));
        ends.push((end.distance, end.u.clone()));
        // Each step of a pull is one more pull, so an end near the points that is reached from two starts far from each other
        // is final.
        let is_end = |best: &FitEnd| {
            best.distance < REACHED
                && apart(&best.u, &end.u) < ONE
                && from.iter().any(|u| apart(u, &begun) > OTHER)
        };
        is_final = is_pulled && best.as_ref().is_some_and(is_end);
        if best.as_ref().is_none_or(|best| end.is_nearer(best, robust)) {
            best = Some(end);
        }
        if is_final {
            break;
        }
        from.push(begun);
    }
    let mut best = best?;
    if is_pulled && scan && !is_final {
        let end = run.left(best.clone(), robust, progress);
        if end.is_nearer(&best, robust) {
            tried.push(run.tried(&end));
            best = end;
        }
    }
    let as_near = AS_NEAR.max(1.0 + FEW / run.data.len() as f64);
    let is_other = |(distance, u): &(f64, Vec<f64>)| {
        *distance < as_near * best.distance && best.distance < REACHED && apart(u, &best.u) > ONE
    };
    let mut others: Vec<Vec<f64>> = Vec::new();
    for (_, u) in ends.into_iter().filter(is_other) {
        if others.iter().all(|other| apart(other, &u) > ONE) {
            others.push(u);
        }
    }
    Some(StartEnds { best: best.u, others, tried })
}
