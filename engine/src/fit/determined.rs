//! What the points determine: covariance, condition, and the direction in which they say nothing.
//!
//! ```text
//! C = H⁻¹ (JᵀVRVJ + K) H⁻¹,    H = JᵀΦJ + K,    J as in `folds`
//! Φ_i = E ψ'(r_i) = erf(t/√2),    V_i² = E ψ(r_i)² = s_i² [erf(t/√2) − √(2/π) t exp(−t²/2) + t² erfc(t/√2)],    t = c/s_i
//! ```
//!
//! ψ is Huber's, linear up to c; `s_i` is the standard deviation of the residual i, which depends on the slope of the
//! curve, from the mean of squares that count up to 2.5 deviations: P. J. Huber, Ann. Math. Stat. 35, 73 (1964),
//! proposal 2. R is the correlation of the noise of the rows, 1 for white noise, and K the weights of what is known
//! before. Where all `s_i` are one and K is zero this is P. J. Huber, *Robust Statistics* (1981), section 7.6; where
//! they differ, H. White, Econometrica 48, 817 (1980), with variances that are known up to two factors. The condition
//! is that of J with columns of length 1: beyond [`LARGEST_CONDITION`] no errors are reported.

use super::degrees::{VarianceSources, degrees};
use super::options::letter;
use super::prior::{Prior, with_derivatives};
use super::problem::{FitProblem, FreeParameter};
use super::scatter::{Correlation, Scatter, together, variance};
use super::solve::{HUBER, LEAST_SCALE, SolvedFit};
use super::spread::{LEAST_LEFT, Spread};
use crate::elementary::{exp, exp_m1, ln};
use crate::preset::Preset;
use crate::units::number::{said, significant};
use nalgebra::{DMatrix, DVector};
use std::f64::consts::{FRAC_1_SQRT_2, PI};

/// The condition beyond which errors mean nothing.
pub const LARGEST_CONDITION: f64 = 1e3;
/// The same where values given with an error provide most of what is known in the weakest direction: the limit set by
/// rounding.
const LARGEST_WITH_GIVEN: f64 = 1e6;
/// Most of what is known.
const HALF: f64 = 0.5;
/// Exponents this near to a multiple of a half count as one.
const HALVES: f64 = 0.02;

/// What the points determine.
#[derive(Debug, Clone)]
pub struct Determined {
    /// The condition of the whitened Jacobian.
    pub condition: f64,
    /// The standard errors of u; `None` where the condition is too large.
    pub errors: Option<DVector<f64>>,
    /// The degrees of freedom of their squares, where they are determined.
    pub degrees: Option<DVector<f64>>,
    /// The correlations.
    pub correlations: Option<DMatrix<f64>>,
    /// (JᵀJ)⁻¹, where they are determined.
    pub inner: Option<DMatrix<f64>>,
    /// For each value given with an error, its share of the variance of each parameter.
    pub shares: Vec<Vec<f64>>,
    /// What the points cannot tell, in words.
    pub direction: Option<String>,
}

impl Determined {
    /// The same without errors, as the points say nothing in this direction.
    pub(super) fn without_errors(self, direction: String) -> Self {
        Self { errors: None, degrees: None, correlations: None, direction: Some(direction), ..self }
    }
}

/// What the fit `solved` of `problem` determines, its noise correlated from row to row as `scatter` says.
pub fn determined(problem: &FitProblem, solved: &SolvedFit, scatter: &Scatter, robust: bool) -> Determined {
    let (at, u) = (&solved.minimum.at, &solved.minimum.parameters[..]);
    let none = Determined {
        condition: f64::INFINITY,
        errors: None,
        degrees: None,
        correlations: None,
        inner: None,
        shares: Vec::new(),
        direction: None,
    };
    let p = u.len();
    let factor = level(&problem.real(&at.residuals), problem.taken(), robust);
    // What is known before counts like the points.
    let all = with_derivatives(at.jacobian.clone(), &problem.priors, factor.sqrt());
    let Some(White { condition, inner, weakest, .. }) = White::of(all, problem.priors.len()) else {
        return none;
    };
    let Some(inner) = inner else {
        let words = words(&problem.preset, &problem.parameters, &at.jacobian, u, &weakest);
        return Determined { condition, direction: Some(words), ..none };
    };
    // Whether all values are determined, the fit itself says; how well, the folds do too.
    let beside = problem.beside_folds(solved);
    let solved = beside.as_ref().unwrap_or(solved);
    let at = &solved.minimum.at;
    let Sandwich { points, bread, noisy, spread } =
        sandwich(problem, solved, &inner, &scatter.correlation, robust);
    let known = with_derivatives(DMatrix::zeros(0, p), &problem.priors, 1.0);
    let known = known.tr_mul(&known);
    let Some(bread) = (bread + &known).try_inverse() else { return none };
    let of_points = (&bread * &points * &bread).diagonal();
    let mut whole = &bread * (points + &known) * &bread;
    // The level of a force in steps is known no better than the steps allow, however many rows stand at it.
    let level = &inner * at.jacobian.tr_mul(&rounding(problem, scatter, at.residuals.len()));
    whole += &level * level.transpose();
    let share = |prior: &Prior, j: usize| {
        let along = bread.column(prior.parameter)[j] / prior.sigma;
        (along * along / whole[(j, j)]).min(1.0)
    };
    let shares = problem.priors.iter().map(|prior| (0..p).map(|j| share(prior, j)).collect()).collect();
    let errors = DVector::from_iterator(p, (0..p).map(|j| whole[(j, j)].sqrt()));
    let made = VarianceSources {
        bread: &bread,
        noisy: &noisy,
        jacobian: &at.jacobian,
        points: &of_points,
        whole: &whole.diagonal(),
        rows: problem.real(&at.residuals).len(),
    };
    let degrees = degrees(problem, &made, &spread, scatter, robust);
    let correlations = DMatrix::from_fn(p, p, |i, j| whole[(i, j)] / (whole[(i, i)] * whole[(j, j)]).sqrt());
    Determined {
        condition,
        errors: Some(errors),
        degrees: Some(degrees),
        correlations: Some(correlations),
        inner: Some(inner),
        shares,
        direction: None,
    }
}

/// A Jacobian with columns of length 1.
pub(super) struct White {
    pub(super) condition: f64,
    /// (JᵀJ)⁻¹; `None` where the condition is too large.
    pub(super) inner: Option<DMatrix<f64>>,
    /// The direction about which it says least.
    pub(super) weakest: Vec<f64>,
}

impl White {
    /// For a Jacobian whose last `known` rows stand for what is known before; `None` without columns.
    pub(super) fn of(mut jacobian: DMatrix<f64>, known: usize) -> Option<Self> {
        let p = jacobian.ncols();
        let lengths: Vec<f64> = jacobian.column_iter().map(|column| column.norm()).collect();
        for (mut column, length) in jacobian.column_iter_mut().zip(&lengths) {
            if *length > 0.0 {
                column /= *length;
            }
        }
        let of_known = jacobian.rows(jacobian.nrows() - known, known).into_owned();
        let svd = jacobian.svd(false, true);
        let v = svd.v_t.filter(|_| p > 0)?;
        let values = svd.singular_values;
        let (most, least) = (values.max(), values.min());
        let condition = if least > 0.0 { most / least } else { f64::INFINITY };
        let weakest = values.imin();
        // A direction about which the points say little is still known where a value is given with an error.
        let given = (of_known * v.row(weakest).transpose()).norm_squared() > HALF * least * least;
        let most = if given { LARGEST_WITH_GIVEN } else { LARGEST_CONDITION };
        let refused = condition.is_nan() || condition > most || lengths.contains(&0.0);
        let inner = (!refused).then(|| {
            DMatrix::from_fn(p, p, |i, j| {
                let sum: f64 = (0..p).map(|k| v[(k, i)] * v[(k, j)] / values[k].powi(2)).sum();
                sum / (lengths[i] * lengths[j])
            })
        });
        let weakest =
            (0..p).map(|j| if lengths[j] > 0.0 { v[(weakest, j)] / lengths[j] } else { 1.0 }).collect();
        Some(Self { condition, inner, weakest })
    }
}

/// The standard deviation in σ by which all rows apart are off together, where the force comes in steps:
///
/// ```text
/// q²/(2π²) Σ_k exp(−4π²k²σ²/q²)/k²         q²/12 without noise, and nothing where noise carries the force over many steps
/// ```
///
/// B. Widrow and I. Kollár, *Quantization Noise* (2008), chapter 4. Rows apart on both sides of an edge between two
/// steps scatter by up to q/2 without any noise, so the noise is taken from the rows in contact, whose force covers
/// many steps.
fn rounding(problem: &FitProblem, scatter: &Scatter, rows: usize) -> DVector<f64> {
    const TERMS: u32 = 20;
    let (per, step, sigma) = (problem.per_point(), problem.step, problem.sigma[1]);
    let found = scatter.contact.map_or(1.0, |s| s.min(1.0)) * sigma;
    let noise = (found * found / (step * step) - 1.0 / 12.0).max(0.0);
    let term = |k: u32| {
        let square = f64::from(k * k);
        exp(-4.0 * PI * PI * square * noise) / (2.0 * PI * PI * square)
    };
    let off = if step > 0.0 { step * (1..=TERMS).map(term).sum::<f64>().sqrt() / sigma } else { 0.0 };
    DVector::from_fn(rows, |i, _| if problem.data[i / per].free && i.is_multiple_of(per) { off } else { 0.0 })
}

/// What the covariance is made of.
pub(super) struct Sandwich {
    /// `JᵀVRVJ`.
    pub(super) points: DMatrix<f64>,
    /// `JᵀΦJ`.
    pub(super) bread: DMatrix<f64>,
    /// VJ.
    noisy: DMatrix<f64>,
    spread: Spread,
}

pub(super) fn sandwich(
    problem: &FitProblem,
    solved: &SolvedFit,
    inner: &DMatrix<f64>,
    correlation: &Correlation,
    robust: bool,
) -> Sandwich {
    let at = &solved.minimum.at;
    let leverage = at.jacobian.row_iter().map(|row| (row * inner).dot(&row));
    let spread = problem.spread(solved, &DVector::from_iterator(at.residuals.len(), leverage));
    let limit = if robust { HUBER * solved.scale } else { f64::INFINITY };
    // Φ and V.
    let of_row = |s: &f64| {
        let t = limit / s;
        if t.is_infinite() {
            return [1.0, *s];
        }
        let inside = libm::erf(t * FRAC_1_SQRT_2);
        let tail = t * t * libm::erfc(t * FRAC_1_SQRT_2) - (2.0 / PI).sqrt() * t * exp(-0.5 * t * t);
        [inside, s * (inside + tail).sqrt()]
    };
    let of_rows: Vec<[f64; 2]> = spread.of_rows.iter().map(of_row).collect();
    let scaled = |by: &dyn Fn(&[f64; 2]) -> f64| {
        let mut jacobian = at.jacobian.clone();
        for (mut row, of_row) in jacobian.row_iter_mut().zip(&of_rows) {
            row *= by(of_row);
        }
        jacobian
    };
    let noisy = scaled(&|[_, v]| *v);
    let points =
        if correlation.share > 0.0 { together(problem, &noisy, correlation) } else { noisy.tr_mul(&noisy) };
    // A fit takes up more of correlated noise: tr (JᵀJ)⁻¹JᵀRJ of n rows, instead of p for white noise.
    let taken_more = if correlation.share > 0.0 {
        let n = problem.real(&at.residuals).len() as f64;
        let of = |crossed: DMatrix<f64>| (inner * crossed).trace();
        let white = n - of(at.jacobian.tr_mul(&at.jacobian));
        white / (n - of(together(problem, &at.jacobian, correlation))).max(LEAST_LEFT * n)
    } else {
        1.0
    };
    // Without a limit on what counts, the squares of all rows do.
    let level = if robust {
        1.0
    } else {
        let of_rows = problem.real(&spread.of_rows);
        let mean = of_rows.iter().map(|s| s * s).sum::<f64>() / of_rows.len() as f64;
        level(&problem.real(&at.residuals), problem.taken(), robust) / mean
    };
    let bread = at.jacobian.tr_mul(&scaled(&|[inside, _]| *inside));
    Sandwich { points: points * (level * taken_more), bread, noisy, spread }
}

/// The variance of the residuals, of which the parameters take up `p`.
fn level(residuals: &[f64], p: usize, robust: bool) -> f64 {
    let n = residuals.len() as f64;
    let squares = residuals.iter().map(|r| r * r).sum::<f64>() / n;
    let found = if robust { variance(residuals).unwrap_or(squares) } else { squares };
    found.max(LEAST_SCALE * LEAST_SCALE) * n / (n - p as f64).max(1.0)
}

/// `R +10 %, E* -4.7 %, γ -9.1 % together move the curve by less than its noise: fix one of them (only γ·R and E*·√R)`.
pub(super) fn words(
    preset: &Preset,
    parameters: &[FreeParameter],
    jacobian: &DMatrix<f64>,
    u: &[f64],
    direction: &[f64],
) -> String {
    let largest = direction.iter().fold(0.0_f64, |most, d| most.max(d.abs()));
    // A length of the gap is what people know best; it leads unless another moves clearly more.
    let leads = |j: &usize| {
        let of_gap = parameters[*j].key().starts_with("gap.");
        direction[*j].abs() * if of_gap { 1.2 } else { 1.0 }
    };
    let logs = (0..direction.len()).filter(|j| parameters[*j].scale.is_none());
    let lead =
        logs.max_by(|a, b| leads(a).total_cmp(&leads(b))).filter(|j| direction[*j].abs() > 1e-3 * largest);
    let unit = match lead {
        Some(lead) => ln(1.1_f64) / direction[lead],
        None => 1.0 / largest,
    };
    let moves: Vec<f64> = direction.iter().map(|d| d * unit).collect();
    let name = |j: usize| letter(preset, &parameters[j].key());
    let mut order: Vec<usize> = (0..moves.len()).collect();
    order.sort_by_key(|j| Some(*j) != lead);
    let share = |j: usize| moves[j].abs() / (largest * unit.abs());
    let told: Vec<String> = order
        .iter()
        .filter(|j| share(**j) > 0.01)
        .map(|&j| format!("{} {}", name(j), change(preset, &parameters[j], u[j], moves[j])))
        .collect();
    let moved = jacobian * DVector::from_vec(moves.clone());
    let noise = match moved.amax() {
        most if most < 1.0 => "by less than its noise".to_owned(),
        most => format!("by at most {} times its noise", significant(most, 2)),
    };
    let only = lead.and_then(|lead| products(&order, &moves, lead, parameters, &name));
    let only = only.map_or_else(String::new, |only| format!(" ({only} can be found)"));
    if let [alone] = told.as_slice() {
        return format!("{alone} moves the curve {noise}: fix it");
    }
    format!("{} together move the curve {noise}: fix one of them{only}", told.join(", "))
}

/// `+10 %`, or for a shift `+3 um`.
fn change(preset: &Preset, parameter: &FreeParameter, u: f64, by: f64) -> String {
    let (before, after) = (parameter.value(u), parameter.value(u + by));
    if parameter.scale.is_none() {
        let percent = 100.0 * exp_m1(by);
        let digits = match percent.abs() {
            0.0..0.0005 => return "0 %".to_owned(),
            0.0005..0.095 => 3,
            0.095..9.95 => 1,
            _ => 0,
        };
        return format!("{percent:+.digits$} %").replace('-', "−");
    }
    let text = said(&preset.units, super::fitted::quantity(preset, &parameter.key()), after - before);
    if after >= before { format!("+{text}") } else { text.replacen('-', "−", 1) }
}

/// `only γ·R and E*·√R`, where all exponents are halves.
fn products(
    order: &[usize],
    moves: &[f64],
    lead: usize,
    parameters: &[FreeParameter],
    name: &dyn Fn(usize) -> String,
) -> Option<String> {
    let mut products = Vec::new();
    for &j in order.iter().filter(|j| **j != lead) {
        let exponent = -moves[j] / moves[lead];
        if parameters[j].scale.is_some() {
            // A shift that hardly moves plays no part.
            if exponent.abs() > HALVES {
                return None;
            }
            continue;
        }
        let halves = (2.0 * exponent).round();
        if (exponent - 0.5 * halves).abs() > HALVES || halves.abs() > 6.0 {
            return None;
        }
        if halves != 0.0 {
            let r = name(lead);
            let size = 0.5 * halves.abs();
            let power = match halves.abs() {
                1.0 => format!("√{r}"),
                2.0 => r,
                4.0 => format!("{r}²"),
                6.0 => format!("{r}³"),
                _ => format!("{r}^{size}"),
            };
            products.push(format!("{}{}{power}", name(j), if halves > 0.0 { "·" } else { "/" }));
        }
    }
    products.reverse();
    (!products.is_empty()).then(|| format!("only {}", products.join(" and ")))
}
