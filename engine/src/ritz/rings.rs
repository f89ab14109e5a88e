//! The paper's ring elements, eqs. (13)-(18).
//!
//! N rings with edges `r̃_j` on the unit disc ([`Grading`]: uniform, `j/N`, or crowded towards the edge), scaled by the
//! contact radius: the pressure is constant on each ring, the gap piecewise linear between the N + 1 nodes
//! `r̃_j`. All coefficients are closed forms:
//!
//! ```text
//! B̃_ab = second mixed difference of I over the edges of rings a and b         (N × N)
//! W̃_aj = ∫_ring a ψ_j dS = π d (x_a + d/3), π d (x_a + 2d/3) for j = a, a + 1  (N × (N+1))
//! ```
//!
//! `B̃ = LLᵀ` is factored once per mesh. The forms of [`super::functional`] are then dot products of the vectors
//! L⁻¹W̃v: one triangular solve per vector, and never the N³ product K. A curve asks for many radii at once; their
//! vectors are solved for together, as matrix products on every core.
//!
//! Accuracy (relative, JKR at δ = 0.1 R, γ = 0.01 E*R): with uniform rings the contact radius is good to about 0.16/N
//! and the force to 1.4/N; with graded rings to 0.34/N² and 9.4/N². Without adhesion the radius is good to 0.5/N
//! (graded 0.37/N), and the force to better than 1/N² with either.

use super::caution::{Caution, RINGS_PER_WAVE, WEAK_ADHESION};
use super::cholesky::{BLOCK, CholeskyFactor, NoFactor};
use super::functional::Forms;
use super::kernel::disc_interaction;
use super::mesh::Grading;
use super::outside;
use super::parallel;
use crate::disc::sampled::Sampled;
use crate::disc::{Basis, Evaluation, Order, Solution};
use crate::elementary::{exp2, log2, log10};
use crate::gap::Gap;
use crate::problem::Reduced;
use crate::progress::{Progress, ProgressPart, Stopped, Unwatched};
use nalgebra::{DMatrix, DMatrixView, DVector};
use std::f64::consts::PI;
use std::sync::{Arc, Mutex, PoisonError};

/// How many factorizations are kept: enough to go back and forth between two meshes, 32 MB each at most.
const KEPT: usize = 3;

/// Radii of a curve whose vectors are solved for together: four columns for each radius, 2 MB at most.
const TOGETHER: usize = 32;

/// Fewer rings than this do not repay a thread.
const RINGS_PER_THREAD: usize = 100;

/// How far inward of a path's end its landings are looked for, as a fraction of the end radius.
const INWARD_REACH: f64 = 1e-4;

/// Samples of the gap at a node: h, h1, h2 and h3 of [`super::functional`].
const SAMPLES: usize = 4;

/// Why a ring basis could not be made.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum RingsError {
    /// The number of rings is out of range.
    #[error(
        "rings = {rings} is out of range: {lo} to {hi} are allowed with {grading} spacing",
        lo = grading.ring_range().start(), hi = grading.ring_range().end(), grading = grading.name()
    )]
    OutOfRange {
        /// Their number.
        rings: usize,
        /// How they are spaced.
        grading: Grading,
    },
    /// The matrix of the pressures lost positive definiteness.
    #[error("the pressure matrix of {0} rings is not positive definite")]
    NotPositiveDefinite(usize),
    /// The basis was no longer wanted.
    #[error(transparent)]
    Stopped(#[from] Stopped),
}

/// Ring elements with their factored matrix; independent of the geometry, so one set serves every problem.
#[derive(Debug)]
pub struct Rings {
    grading: Grading,
    /// `r̃_j`, N + 1 of them.
    nodes: Vec<f64>,
    /// How much the values at the inner and the outer edge of each ring contribute to the integral over it: the entries
    /// of W̃.
    weights: Vec<[f64; 2]>,
    factor: CholeskyFactor,
    /// L⁻¹W̃1, and its square 1ᵀK1.
    ones: DVector<f64>,
    cc: f64,
}

impl Rings {
    /// N uniform rings; computed once and then shared.
    ///
    /// # Errors
    /// When `rings` is out of range, or the matrix cannot be factored.
    pub fn shared(rings: usize) -> Result<Arc<Self>, RingsError> {
        Self::shared_with(rings, Grading::Uniform, &Unwatched)
    }

    /// N rings; computed once per mesh and then shared. `progress` is told how far the work is.
    ///
    /// # Errors
    /// As [`Rings::new`].
    pub fn shared_with(
        rings: usize,
        grading: Grading,
        progress: &dyn Progress,
    ) -> Result<Arc<Self>, RingsError> {
        static CACHE: Mutex<Vec<Arc<Rings>>> = Mutex::new(Vec::new());
        {
            let mut cache = CACHE.lock().unwrap_or_else(PoisonError::into_inner);
            let same = |kept: &Arc<Self>| kept.size() == rings && kept.grading == grading;
            if let Some(at) = cache.iter().position(same) {
                let found = cache.remove(at);
                cache.push(Arc::clone(&found));
                return Ok(found);
            }
        }
        // Made without holding the lock: another mesh must not wait for this one.
        let made = Arc::new(Self::new(rings, grading, progress)?);
        let mut cache = CACHE.lock().unwrap_or_else(PoisonError::into_inner);
        if cache.len() >= KEPT {
            cache.remove(0);
        }
        cache.push(Arc::clone(&made));
        Ok(made)
    }

    /// N rings. `progress` is told the share of the work done, between blocks of columns.
    ///
    /// # Errors
    /// [`RingsError::OutOfRange`] outside [`Grading::ring_range`], [`RingsError::NotPositiveDefinite`], and
    /// [`RingsError::Stopped`] when `progress` said stop.
    pub fn new(rings: usize, grading: Grading, progress: &dyn Progress) -> Result<Self, RingsError> {
        /// The share of the assembly: it costs N² and the factorization N³, and in practice each takes about half.
        const ASSEMBLY: f64 = 0.5;
        if !grading.ring_range().contains(&rings) {
            return Err(RingsError::OutOfRange { rings, grading });
        }
        let (edges, radius) = grading.edges(rings);
        let matrix = pressure_matrix(&edges, radius, &ProgressPart::new(progress, [0.0, ASSEMBLY]))?;
        let factor = CholeskyFactor::new(matrix, &ProgressPart::new(progress, [ASSEMBLY, 1.0])).map_err(
            |failure| match failure {
                NoFactor::NotPositiveDefinite => RingsError::NotPositiveDefinite(rings),
                NoFactor::Stopped(Stopped) => RingsError::Stopped(Stopped),
            },
        )?;
        let nodes: Vec<f64> = edges.iter().map(|edge| edge / radius).collect();
        let weights: Vec<[f64; 2]> = nodes
            .windows(2)
            .map(|edge| {
                let width = edge[1] - edge[0];
                [edge[0] + width / 3.0, edge[0] + width * 2.0 / 3.0].map(|x| PI * width * x)
            })
            .collect();
        let mut ones = DMatrix::from_iterator(rings, 1, weights.iter().map(|[a, b]| a + b));
        factor.forward(&mut ones);
        let ones = ones.column(0).into_owned();
        let cc = ones.norm_squared();
        Ok(Self { grading, nodes, weights, factor, ones, cc })
    }

    /// L⁻¹W̃v for the first M samples at each of `radii`: M columns per radius.
    fn reduced<const M: usize>(&self, gap: &dyn Gap, radii: &[f64]) -> DMatrix<f64> {
        let rings = self.size();
        let mut columns = DMatrix::zeros(rings, M * radii.len());
        let mut samples = [(); SAMPLES].map(|()| vec![0.0; rings + 1]);
        for (&s, part) in radii.iter().zip(columns.as_mut_slice().chunks_mut(M * rings)) {
            self.sample::<M>(gap, s, &mut samples);
            for (samples, column) in samples.iter().zip(part.chunks_mut(rings)) {
                let edges = samples.iter().zip(&samples[1..]);
                for ((integral, [a, b]), (inner, outer)) in column.iter_mut().zip(&self.weights).zip(edges) {
                    *integral = a * inner + b * outer;
                }
            }
        }
        self.factor.forward(&mut columns);
        columns
    }

    /// The first M samples of the gap at the nodes of a disc of radius `s`.
    fn sample<const M: usize>(&self, gap: &dyn Gap, s: f64, [h, h1, h2, h3]: &mut [Vec<f64>; SAMPLES]) {
        gap.values(s, &self.nodes, h);
        if M > 1 {
            gap.derivatives(s, &self.nodes, [&mut *h1, &mut *h2, &mut *h3]);
            for (((x, h1), h2), h3) in self.nodes.iter().zip(h1).zip(h2).zip(h3) {
                *h1 *= x;
                *h2 *= x * x;
                *h3 *= x * x * x;
            }
        }
    }

    /// The forms of the M columns of one radius; forms that need more columns are NaN.
    fn forms_of<const M: usize>(&self, columns: &[f64]) -> Forms {
        let columns = DMatrixView::from_slice(columns, self.size(), M);
        let product = |a: usize, b: usize| {
            if a.max(b) < M { columns.column(a).dot(&columns.column(b)) } else { f64::NAN }
        };
        let integral = |a: usize| if a < M { self.ones.dot(&columns.column(a)) } else { f64::NAN };
        Forms {
            cc: self.cc,
            ch: integral(0),
            c1: integral(1),
            c2: integral(2),
            c3: integral(3),
            hh: product(0, 0),
            h1: product(0, 1),
            h2: product(0, 2),
            h3: product(0, 3),
            f11: product(1, 1),
            f12: product(1, 2),
        }
    }

    /// The forms of `gap` at radius `s`.
    fn forms(&self, gap: &dyn Gap, s: f64) -> Forms {
        self.forms_of::<SAMPLES>(self.reduced::<SAMPLES>(gap, &[s]).as_slice())
    }

    /// What `evaluate` makes of the forms from the first M samples at each of `places`, in order; it ends at the first
    /// place for which `evaluate` gives nothing, or where `progress` said stop. `radius` gives the radius of a place.
    fn together<const M: usize, T: Copy + Sync>(
        &self,
        gap: &dyn Gap,
        places: &[T],
        radius: impl Fn(T) -> f64 + Sync,
        evaluate: impl Fn(&Forms, T) -> Option<Evaluation> + Sync,
        progress: &dyn Progress,
    ) -> Vec<Evaluation> {
        let threads = if self.size() < RINGS_PER_THREAD { 1 } else { parallel::cores() };
        let mut found = Vec::with_capacity(places.len());
        for round in places.chunks(TOGETHER * threads) {
            let complete = found.len() + round.len();
            let wanted = round.iter().take_while(|_| !progress.stop()).count();
            let mut answers = vec![None; wanted];
            // Every thread gets equally many, even in a short round.
            let share = wanted.div_ceil(threads).max(1);
            let parts = round[..wanted].chunks(share).zip(answers.chunks_mut(share));
            parallel::each(parts, |(places, answers)| {
                let radii: Vec<f64> = places.iter().map(|place| radius(*place)).collect();
                let columns = self.reduced::<M>(gap, &radii);
                let parts = columns.as_slice().chunks(M * self.size());
                for ((place, part), answer) in places.iter().zip(parts).zip(answers) {
                    *answer = evaluate(&self.forms_of::<M>(part), *place);
                }
            });
            found.extend(answers.into_iter().map_while(|answer| answer));
            if found.len() < complete {
                break;
            }
        }
        found
    }

    /// The pressure on each ring.
    fn ring_pressures(&self, gap: &dyn Gap, s: f64, delta: f64) -> DVector<f64> {
        let mut samples = vec![0.0; self.nodes.len()];
        gap.values(s, &self.nodes, &mut samples);
        let edges = samples.windows(2).zip(&self.weights);
        let loads = edges.map(|(h, [a, b])| a * (h[0] - delta) + b * (h[1] - delta));
        let mut load = DVector::from_iterator(self.size(), loads);
        self.factor.solve(&mut load);
        load / -s
    }
}

/// The state of radius `s` in equilibrium, from the forms there.
fn equilibrium_of(forms: &Forms, s: f64, gamma: f64) -> Option<Evaluation> {
    let delta = forms.equilibrium_approach(s, gamma)?;
    Some(forms.evaluate(s, delta, gamma))
}

/// B̃ of the rings between `edges` on the disc of radius `radius`, for the unit disc: its lower triangle.
fn pressure_matrix(edges: &[f64], radius: f64, progress: &dyn Progress) -> Result<DMatrix<f64>, Stopped> {
    let rings = edges.len() - 1;
    let unit = radius.powi(-3);
    let mut matrix = DMatrix::zeros(rings, rings);
    let together = BLOCK * parallel::cores();
    for (round, columns) in matrix.as_mut_slice().chunks_mut(rings * together).enumerate() {
        progress.report((round * together) as f64 / rings as f64);
        progress.go_on()?;
        let parts = columns.chunks_mut(rings * BLOCK).enumerate();
        parallel::each(parts, |(part, columns)| {
            fill(columns, round * together + part * BLOCK, edges, unit);
        });
    }
    Ok(matrix)
}

/// The columns of the lower triangle, from that of ring `first` on.
fn fill(columns: &mut [f64], first: usize, edges: &[f64], unit: f64) {
    let rings = edges.len() - 1;
    // I of the disc inside edge j with each disc that is not smaller.
    let discs = |j: usize| -> Vec<f64> {
        let not_smaller = edges.iter().enumerate().skip(j);
        std::iter::repeat_n(0.0, j).chain(not_smaller.map(|(_, &b)| disc_interaction(edges[j], b))).collect()
    };
    let mut inner = discs(first);
    for (b, column) in (first..).zip(columns.chunks_mut(rings)) {
        let outer = discs(b + 1);
        // I is symmetric: the value that `outer` lacks at b is that of `inner` at b + 1.
        column[b] = unit * ((outer[b + 1] - inner[b + 1]) - (inner[b + 1] - inner[b]));
        for a in b + 1..rings {
            column[a] = unit * ((outer[a + 1] - inner[a + 1]) - (outer[a] - inner[a]));
        }
        inner = outer;
    }
}

impl Basis for Rings {
    fn evaluate(&self, problem: &Reduced, s: f64, delta: f64) -> Evaluation {
        self.forms(problem.gap.as_ref(), s).evaluate(s, delta, problem.work_of_adhesion)
    }

    fn evaluations(
        &self,
        problem: &Reduced,
        states: &[[f64; 2]],
        progress: &dyn Progress,
    ) -> Vec<Evaluation> {
        let gamma = problem.work_of_adhesion;
        let evaluate = |forms: &Forms, [s, delta]: [f64; 2]| Some(forms.evaluate(s, delta, gamma));
        self.together::<SAMPLES, _>(problem.gap.as_ref(), states, |[s, _]| s, evaluate, progress)
    }

    fn equilibrium(&self, problem: &Reduced, s: f64) -> Option<Evaluation> {
        equilibrium_of(&self.forms(problem.gap.as_ref(), s), s, problem.work_of_adhesion)
    }

    fn equilibria(
        &self,
        problem: &Reduced,
        radii: &[f64],
        order: Order,
        progress: &dyn Progress,
    ) -> Vec<Evaluation> {
        let gap = problem.gap.as_ref();
        let evaluate = |forms: &Forms, s: f64| equilibrium_of(forms, s, problem.work_of_adhesion);
        match order {
            Order::State => self.together::<2, _>(gap, radii, |s| s, evaluate, progress),
            Order::Slopes => self.together::<3, _>(gap, radii, |s| s, evaluate, progress),
            Order::Curvature => self.together::<SAMPLES, _>(gap, radii, |s| s, evaluate, progress),
        }
    }

    fn solution(
        &self,
        problem: &Reduced,
        from: f64,
        to: f64,
        progress: &dyn Progress,
    ) -> Result<Option<Arc<dyn Solution>>, Stopped> {
        // Landings lie anywhere further in; far inward only adhesion matters, and the curve is monotone. The curve
        // reaches to a power of 2^(1/4), so that a given radius always has the same series, however far the curve was
        // asked for.
        let stage = exp2(0.25 * (4.0 * log2(to) - 1e-9).ceil()).max(to);
        let range = [INWARD_REACH * from, stage.min(problem.largest_contact().max(from))];
        let found = Sampled::new(self, problem, range, progress)?;
        Ok(found.map(|sampled| Arc::new(sampled) as Arc<dyn Solution>))
    }

    fn pressure(&self, problem: &Reduced, s: f64, delta: f64) -> Vec<(f64, f64)> {
        let pressures = self.ring_pressures(problem.gap.as_ref(), s, delta);
        let middles = self.nodes.windows(2).map(|edge| 0.5 * s * (edge[0] + edge[1]));
        middles.zip(pressures.iter().copied()).collect()
    }

    fn gap_outside(&self, problem: &Reduced, s: f64, delta: f64, radii: &[f64]) -> Vec<f64> {
        let pressures = self.ring_pressures(problem.gap.as_ref(), s, delta);
        // The pressure of a ring minus that of the next one outward.
        let inward = |j: usize| pressures[j] - pressures.get(j + 1).copied().unwrap_or(0.0);
        let discs: Vec<(f64, f64)> =
            self.nodes[1..].iter().enumerate().map(|(j, edge)| (s * edge, inward(j))).collect();
        let displacement =
            |r: f64| discs.iter().map(|&(edge, step)| step * outside::by_disc(edge.min(r), r)).sum::<f64>();
        radii.iter().map(|&r| problem.gap.jet(r).value - delta + displacement(r)).collect()
    }

    fn size(&self) -> usize {
        self.nodes.len() - 1
    }

    fn trusted_digits(&self, problem: &Reduced, _s: f64) -> f64 {
        let n = self.size() as f64;
        // The larger of the relative errors of force and contact radius given in the module header.
        let error = match (self.grading, problem.work_of_adhesion > 0.0) {
            (Grading::Uniform, true) => 1.4 / n,
            (Grading::Uniform, false) => 0.5 / n,
            (Grading::Edge, true) => 9.4 / (n * n),
            (Grading::Edge, false) => 0.37 / n,
        };
        -log10(error)
    }

    fn cautions(&self, problem: &Reduced, s: f64) -> Vec<String> {
        let mut cautions = Vec::new();
        if let Some(wave) = problem.gap.feature_length() {
            // Judged by the widest ring, because waves are everywhere.
            let per_wave = wave / (s * self.grading.widest(self.size()));
            if per_wave < RINGS_PER_WAVE {
                let wanted = (self.size() as f64 * RINGS_PER_WAVE / per_wave).ceil();
                cautions.push(Caution::FewRings { per_wave, wanted, grading: self.grading }.to_string());
            }
        }
        let gamma = problem.work_of_adhesion;
        if gamma > 0.0 && gamma < WEAK_ADHESION {
            cautions.push(Caution::WeakAdhesion(gamma).to_string());
        }
        cautions
    }
}

#[cfg(test)]
mod tests {
    use super::super::fixtures::{check_derivatives, check_units, wavy};
    use super::*;
    use crate::progress::{Heard, until};

    fn rings(rings: usize, grading: Grading) -> Rings {
        Rings::new(rings, grading, &Unwatched).unwrap()
    }

    #[test]
    fn the_pressure_matrix_sums_to_the_full_disc_and_is_positive_definite() {
        for grading in Grading::ALL {
            for rings in [4, 37, 200, *Grading::Edge.ring_range().end()] {
                let (edges, radius) = grading.edges(rings);
                let b = pressure_matrix(&edges, radius, &Unwatched).unwrap();
                assert!(b.lower_triangle() == b);
                let sum = 2.0 * b.sum() - b.trace();
                assert!((sum / (16.0 / 3.0) - 1.0).abs() < 1e-12, "{grading:?} {rings}: {sum}");
                assert!((0..rings).all(|a| (0..=a).all(|b_| b[(a, b_)] > 0.0)));
                // Symmetric: the other triangle from its own differences.
                let at = |i: usize, j: usize| disc_interaction(edges[i.min(j)], edges[i.max(j)]);
                for (a, c) in
                    [(0, 0), (rings - 1, rings - 1), (rings - 1, rings - 2), (rings - 1, 0), (rings / 2, 1)]
                {
                    let upper = (at(c + 1, a + 1) - at(c + 1, a)) - (at(c, a + 1) - at(c, a));
                    assert!(
                        (upper * radius.powi(-3) - b[(a, c)]).abs() < 1e-14,
                        "{grading:?} {rings} {a} {c}"
                    );
                }
                assert!(CholeskyFactor::new(b, &Unwatched).is_ok(), "{grading:?} {rings}");
            }
        }
    }

    #[test]
    fn many_radii_at_once_are_answered_as_one_by_one() {
        let problem = wavy(0.004);
        for (n, grading) in [(30, Grading::Uniform), (150, Grading::Edge)] {
            let basis = rings(n, grading);
            let radii: Vec<f64> = (0..150).map(|i| 0.4 - 0.002 * f64::from(i)).collect();
            let all = basis.equilibria(&problem, &radii, Order::Curvature, &Unwatched);
            assert_eq!(all.len(), radii.len());
            for (one, &s) in all.iter().zip(&radii) {
                let alone = basis.equilibrium(&problem, s).unwrap();
                assert!((one.approach - alone.approach).abs() < 1e-12);
                assert!((one.force - alone.force).abs() < 1e-12);
                assert!((one.residual_second[2] / alone.residual_second[2] - 1.0).abs() < 1e-9);
            }
            // What was not asked for is missing; the rest is the same.
            let of = |order| basis.equilibria(&problem, &radii, order, &Unwatched);
            let same = |a: f64, b: f64| assert!((a / b - 1.0).abs() < 1e-9, "{a} {b}");
            for ((state, slopes), full) in of(Order::State).iter().zip(&of(Order::Slopes)).zip(&all) {
                same(state.approach, full.approach);
                same(state.force_gradient[1], full.force_gradient[1]);
                same(slopes.residual_gradient[1], full.residual_gradient[1]);
                same(slopes.slopes()[1], full.slopes()[1]);
                assert!(state.residual_gradient[1].is_nan() && slopes.residual_second[2].is_nan());
            }
            for wanted in [0, 1, 64, 70] {
                let until = until(wanted);
                assert_eq!(basis.equilibria(&problem, &radii, Order::State, &until).len(), wanted);
            }
            // The equilibria end at a radius without one.
            let ended = [&radii[..40], &[f64::NAN], &radii[40..]].concat();
            assert_eq!(basis.equilibria(&problem, &ended, Order::Slopes, &Unwatched).len(), 40);
        }
    }

    #[test]
    fn a_long_construction_tells_how_far_it_is_and_stops_when_asked() {
        let heard = Heard::until(1.0);
        Rings::new(400, Grading::Uniform, &heard).unwrap();
        let told = heard.told.into_inner();
        assert!(
            told.len() > 6 && told.is_sorted() && told[0] == 0.0 && told.iter().all(|share| *share < 1.0)
        );
        for stop in [0.0, 0.4, 0.7] {
            let stopped = Rings::shared_with(333, Grading::Edge, &Heard::until(stop));
            assert_eq!(stopped.unwrap_err(), RingsError::Stopped(Stopped));
        }
    }

    #[test]
    fn derivatives_agree_with_central_differences() {
        for (gamma, grading) in
            [0.004, 0.0].into_iter().flat_map(|g| Grading::ALL.map(|grading| (g, grading)))
        {
            let rings = rings(60, grading);
            let problem = wavy(gamma);
            for i in 0..40 {
                // Off the curve, on its tension side.
                let s = 0.05 + 0.011 * f64::from(i);
                let delta = rings.equilibrium(&problem, s).unwrap().approach - 0.003 * f64::from(i % 5 + 1);
                let (here, energy_slope) = check_derivatives(&rings, &problem, s, delta);
                // ∂U/∂s = −F, and F follows from the residual.
                let release = if gamma > 0.0 {
                    (here.residual + 1.0).powi(2) * gamma * 2.0 * PI * s
                } else {
                    -here.residual
                };
                assert!((energy_slope - (release - 2.0 * PI * gamma * s)).abs() < 1e-7, "γ={gamma} s={s}");
            }
        }
    }

    #[test]
    fn the_pressure_carries_the_force() {
        for grading in Grading::ALL {
            let rings = rings(100, grading);
            let problem = wavy(0.004);
            let at = rings.equilibrium(&problem, 0.3).unwrap();
            let pressure = rings.pressure(&problem, 0.3, at.approach);
            let widths = rings.nodes.windows(2).map(|edge| 0.3 * (edge[1] - edge[0]));
            let force: f64 =
                pressure.iter().zip(widths).map(|((r, p), width)| p * 2.0 * PI * r * width).sum();
            assert!((force / at.force - 1.0).abs() < 1e-10, "{grading:?}");
            // Tension grows towards the edge.
            assert!(pressure[99].1 < pressure[98].1 && pressure[98].1 < 0.0);
        }
    }

    #[test]
    fn reduced_answers_do_not_depend_on_the_units() {
        check_units(&|_| Rings::shared(50).unwrap());
    }

    #[test]
    fn the_number_of_rings_is_bounded() {
        let shared = |n, grading| Rings::shared_with(n, grading, &Unwatched);
        for (rings, grading) in
            [(3, Grading::Uniform), (2001, Grading::Uniform), (3, Grading::Edge), (401, Grading::Edge)]
        {
            assert_eq!(shared(rings, grading).unwrap_err(), RingsError::OutOfRange { rings, grading });
        }
        let words = RingsError::OutOfRange { rings: 401, grading: Grading::Edge }.to_string();
        assert_eq!(words, "rings = 401 is out of range: 4 to 400 are allowed with edge spacing");
        let (uniform, edge) = (shared(9, Grading::Uniform).unwrap(), shared(9, Grading::Edge).unwrap());
        assert!(!Arc::ptr_eq(&uniform, &edge));
        for (made, grading) in [(uniform, Grading::Uniform), (edge, Grading::Edge)] {
            assert!(Arc::ptr_eq(&made, &shared(9, grading).unwrap()));
        }
    }
}
