//! Least squares with Huber's loss, by Levenberg and Marquardt with Nielsen's damping. What is known of the values
//! before is a term for each, after the residuals.
//!
//! ```text
//! minimize  Σ m_i ρ(r_i),   ρ = r²/2 for |r| ≤ c, c|r| − c²/2 beyond;      weights w = m ψ/r = m min(1, c/|r|)
//! (JᵀWJ + μ D²) h = −JᵀWr,   D_j the largest length of column j of √W J so far
//! ```
//!
//! In each round √W J is QR-factored once; a damped step then costs a matrix of 2p rows. K. Levenberg (1944), D. W.
//! Marquardt (1963); the damping: H. B. Nielsen, IMM-REP-1999-05. `levenberg-marquardt` 0.15 uses another version of
//! nalgebra than ours, and has neither weights nor a way to be stopped.

use super::prior::{Prior, with_derivatives, with_terms};
use crate::progress::Progress;
use nalgebra::{DMatrix, DVector};

/// Residuals at some parameters, with their derivatives in columns.
#[derive(Debug, Clone)]
pub struct Evaluated {
    /// r.
    pub residuals: DVector<f64>,
    /// ∂r/∂u.
    pub jacobian: DMatrix<f64>,
}

impl Evaluated {
    /// The points and what is known before, at `u`.
    fn informed(self, priors: &[Prior], u: &[f64]) -> Self {
        Self {
            residuals: with_terms(self.residuals, priors, u),
            jacobian: with_derivatives(self.jacobian, priors, 1.0),
        }
    }

    /// The points alone, without the `known` rows of what is known before.
    fn of_points(self, known: usize) -> Self {
        let rows = self.residuals.len() - known;
        let (residuals, jacobian) = (self.residuals, self.jacobian);
        Self {
            residuals: residuals.resize_vertically(rows, 0.0),
            jacobian: jacobian.resize_vertically(rows, 0.0),
        }
    }
}

/// What is fitted.
pub trait LeastSquares {
    /// What the residuals are made from; their derivatives use it again.
    type Look;

    /// The residuals at `u`; `None` where there are none.
    fn look(&self, u: &[f64]) -> Option<(DVector<f64>, Self::Look)>;

    /// The derivatives at `u`, from what was seen there.
    fn derivatives(&self, u: &[f64], look: &Self::Look) -> Option<DMatrix<f64>>;

    /// The residuals at `u` alone.
    fn residuals(&self, u: &[f64]) -> Option<DVector<f64>> {
        self.look(u).map(|(residuals, _)| residuals)
    }

    /// Σ m ρ of them, with Huber's loss from `huber` on.
    fn cost_at(&self, u: &[f64], huber: f64) -> Option<f64> {
        self.residuals(u).map(|residuals| cost(&residuals, self.counts(), huber))
    }

    /// The residuals at `u` with derivatives.
    fn evaluate(&self, u: &[f64]) -> Option<Evaluated> {
        let (residuals, look) = self.look(u)?;
        let jacobian = self.derivatives(u, &look)?;
        Some(Evaluated { residuals, jacobian })
    }

    /// How often each residual counts; without counts, each counts once.
    fn counts(&self) -> Option<&[f64]> {
        None
    }

    /// What is known of the values before. The residuals and derivatives above are those of the points alone.
    fn priors(&self) -> &[Prior] {
        &[]
    }
}

/// Settings of one minimization.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MinimizationSettings {
    /// The most rounds.
    pub rounds: usize,
    /// Steps that would move the residuals by less than this share of their size end it.
    pub tolerance: f64,
    /// The size of a residual that is as good as zero: where residuals vanish, the tolerance is a share of this.
    pub resolution: f64,
    /// c: residuals beyond it count linearly; infinite for plain squares.
    pub huber: f64,
    /// A gain of the cost too small to show in any value, on top of a share of the cost itself: where the residuals
    /// have kinks, ever smaller gains are found without end.
    pub nothing: f64,
    /// A gain of the cost over many rounds that shows in no value beside its error: rounds that end with less have
    /// found the minimum, as near as kinks of the residuals let them.
    pub small: f64,
}

impl Default for MinimizationSettings {
    fn default() -> Self {
        Self { rounds: 100, tolerance: 1e-9, resolution: 1.0, huber: f64::INFINITY, nothing: 0.0, small: 0.0 }
    }
}

/// How a minimization ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ending {
    /// No step would change anything.
    Converged,
    /// The rounds were used up.
    Rounds,
    /// The minimization was no longer wanted.
    Cancelled,
}

/// The best that was found.
#[derive(Debug, Clone)]
pub struct Minimum {
    /// u.
    pub parameters: Vec<f64>,
    /// Residuals and derivatives of the points there.
    pub at: Evaluated,
    /// Σ m ρ, with the terms of what is known before.
    pub cost: f64,
    /// How it ended.
    pub ending: Ending,
    /// How many rounds it took.
    pub rounds: usize,
}

/// ρ.
fn loss(r: f64, c: f64) -> f64 {
    if r.abs() <= c { 0.5 * r * r } else { c * r.abs() - 0.5 * c * c }
}

/// ψ/r.
pub fn weight(r: f64, c: f64) -> f64 {
    if r.abs() <= c { 1.0 } else { c / r.abs() }
}

/// How often the residual `i` counts. What is known before comes after the residuals of the points, and counts once.
fn count(counts: Option<&[f64]>, i: usize) -> f64 {
    counts.and_then(|counts| counts.get(i)).copied().unwrap_or(1.0)
}

/// Σ m ρ.
pub(super) fn cost(residuals: &DVector<f64>, counts: Option<&[f64]>, c: f64) -> f64 {
    residuals.iter().enumerate().map(|(i, r)| count(counts, i) * loss(*r, c)).sum()
}

/// R and −Qᵀr of √W J, and the lengths of its columns.
struct TriangularSystem {
    r: DMatrix<f64>,
    right: DVector<f64>,
    lengths: DVector<f64>,
}

impl TriangularSystem {
    fn of(at: &Evaluated, counts: Option<&[f64]>, c: f64) -> Self {
        let roots = DVector::from_iterator(
            at.residuals.len(),
            at.residuals.iter().enumerate().map(|(i, r)| (count(counts, i) * weight(*r, c)).sqrt()),
        );
        let mut jacobian = at.jacobian.clone();
        for mut column in jacobian.column_iter_mut() {
            column.component_mul_assign(&roots);
        }
        let mut right = -at.residuals.component_mul(&roots);
        let lengths =
            DVector::from_iterator(jacobian.ncols(), jacobian.column_iter().map(|column| column.norm()));
        let qr = jacobian.qr();
        qr.q_tr_mul(&mut right);
        let r = qr.r();
        let right = right.rows(0, r.nrows()).into_owned();
        Self { r, right, lengths }
    }

    /// The damped step.
    fn step(&self, mu: f64, scales: &DVector<f64>) -> Option<DVector<f64>> {
        let (rows, p) = self.r.shape();
        // A column of zeros: the parameter stays where it is, whatever its scale.
        let scale = |j: usize| if scales[j] > 0.0 { scales[j] } else { 1.0 };
        let stacked = DMatrix::from_fn(rows + p, p, |i, j| {
            if i < rows {
                self.r[(i, j)]
            } else if i - rows == j {
                mu.sqrt() * scale(j)
            } else {
                0.0
            }
        });
        let mut right = DVector::zeros(rows + p);
        right.rows_mut(0, rows).copy_from(&self.right);
        let qr = stacked.qr();
        qr.q_tr_mul(&mut right);
        let step = qr.r().solve_upper_triangular(&right.rows(0, p).into_owned())?;
        step.iter().all(|x| x.is_finite()).then_some(step)
    }
}

/// Minimizes from `start`. `progress` is asked before each round; once it says stop, the best so far is returned with
/// [`Ending::Cancelled`]. `None` where there are no residuals at the start.
pub fn minimize<P: LeastSquares>(
    problem: &P,
    start: &[f64],
    settings: &MinimizationSettings,
    progress: &dyn Progress,
) -> Option<Minimum> {
    minimize_from(problem, start, problem.evaluate(start)?, settings, progress)
}

/// The damping μ, raised by ever larger factors while steps fail.
struct Damping {
    mu: f64,
    growth: f64,
}

impl Damping {
    /// The first one, and the largest that is tried.
    const FIRST: f64 = 1e-3;
    const LARGEST: f64 = 1e16;

    /// False where it becomes too large.
    fn raise(&mut self) -> bool {
        (self.mu, self.growth) = (self.mu * self.growth, 2.0 * self.growth);
        self.mu <= Self::LARGEST
    }

    /// After a step with this gain, as a share of the predicted one.
    fn lower(&mut self, gain: f64) {
        self.mu *= f64::max(1.0 / 3.0, 1.0 - (2.0 * gain - 1.0).powi(3));
        self.growth = 2.0;
    }
}

/// The cost, the residuals with those of what is known before, and the look at `u`; `None` where the cost is not finite.
fn looked_at<P: LeastSquares>(problem: &P, u: &[f64], c: f64) -> Option<(f64, DVector<f64>, P::Look)> {
    let (residuals, look) = problem.look(u)?;
    let residuals = with_terms(residuals, problem.priors(), u);
    let cost = cost(&residuals, problem.counts(), c);
    cost.is_finite().then_some((cost, residuals, look))
}

/// The same where the residuals and derivatives at the start, `at`, are known.
pub fn minimize_from<P: LeastSquares>(
    problem: &P,
    start: &[f64],
    at: Evaluated,
    settings: &MinimizationSettings,
    progress: &dyn Progress,
) -> Option<Minimum> {
    /// This many rounds, each with a gain that no value shows, end it.
    const IDLE: usize = 6;
    const SHOWN: f64 = 1e-10;
    let mut idle = 0;
    let mut costs: Vec<f64> = Vec::new();
    let (c, counts, priors) = (settings.huber, problem.counts(), problem.priors());
    let mut u = start.to_vec();
    let mut at = at.informed(priors, &u);
    let mut best = cost(&at.residuals, counts, c);
    if !best.is_finite() {
        return None;
    }
    let mut scales = DVector::zeros(u.len());
    let mut damping = Damping { mu: Damping::FIRST, growth: 2.0 };
    let end = |u: Vec<f64>, at: Evaluated, cost, ending, rounds| {
        Some(Minimum { parameters: u, at: at.of_points(priors.len()), cost, ending, rounds })
    };
    for round in 0..settings.rounds {
        if progress.stop() {
            return end(u, at, best, Ending::Cancelled, round);
        }
        costs.push(best);
        let factored = TriangularSystem::of(&at, counts, c);
        for (scale, length) in scales.iter_mut().zip(factored.lengths.iter()) {
            *scale = f64::max(*scale, *length);
        }
        loop {
            let Some(step) = factored.step(damping.mu, &scales) else {
                if damping.raise() {
                    continue;
                }
                return end(u, at, best, Ending::Converged, round);
            };
            let moved = (&factored.r * &step).norm();
            let size = (2.0 * best).sqrt() + settings.resolution * (at.residuals.len() as f64).sqrt();
            let is_last = moved <= settings.tolerance * size;
            let next: Vec<f64> = u.iter().zip(step.iter()).map(|(u, h)| u + h).collect();
            let found = looked_at(problem, &next, c);
            let predicted = moved * moved + 2.0 * damping.mu * step.component_mul(&scales).norm_squared();
            let gain = found.as_ref().map_or(-1.0, |(cost, ..)| 2.0 * (best - cost) / predicted);
            if let Some((cost, residuals, look)) =
                found.filter(|(cost, ..)| *cost < best || (is_last && *cost <= best))
                && let Some(jacobian) = problem.derivatives(&next, &look)
            {
                let evaluated = Evaluated { residuals, jacobian: with_derivatives(jacobian, priors, 1.0) };
                idle = if best - cost <= f64::max(SHOWN * best, settings.nothing) { idle + 1 } else { 0 };
                (u, at, best) = (next, evaluated, cost);
                damping.lower(gain);
                if is_last || idle >= IDLE {
                    return end(u, at, best, Ending::Converged, round + 1);
                }
                break;
            }
            if is_last {
                return end(u, at, best, Ending::Converged, round + 1);
            }
            if !damping.raise() {
                return end(u, at, best, Ending::Converged, round);
            }
        }
    }
    end(u, at, best, after_all(&costs, best, settings.small), settings.rounds)
}

/// How a minimization ends whose rounds are used up, by the cost before each of them and the best one: if many of them
/// gained no more than `small`, it has found the minimum.
fn after_all(costs: &[f64], best: f64, small: f64) -> Ending {
    const MANY: usize = 50;
    let before = costs.len().checked_sub(MANY).map(|at| costs[at]);
    if before.is_some_and(|before| before - best < small) { Ending::Converged } else { Ending::Rounds }
}

#[cfg(test)]
mod tests;
