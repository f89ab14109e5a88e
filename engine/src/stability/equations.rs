//! Lines in two numbers as curves of a system, for the common tracer: for pairs of numbers whose lines do not follow
//! from s.
//!
//! ```text
//! fold      (s, p)           F = √(πγ/2)
//! cusp      (s, p, q)        F = √(πγ/2),  F' = 0
//! landing   (sᵢ, sⱼ, p, q)   F = √(πγ/2) at both,  the control at sᵢ that at sⱼ
//! start     (p, q)           F = √(πγ/2) at the start of the path
//! arrival   (s, p, q)        F = √(πγ/2),  the control at s that at the start, which is unstable
//! ```
//!
//! Radii are in waves, numbers in shares of their axes. Derivatives by s are exact, those by the numbers central differences.

use super::family::{Family, LocalLaw};
use crate::continuation::{Linearization, Point, Settings, System, Vector};
use crate::quasistatic::monotone::weighted;
use nalgebra::{DMatrix, DVector};

/// What a line consists of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sort {
    /// Limit points.
    Fold,
    /// Cusps.
    Cusp,
    /// A jump that just reaches, or just passes over, a crest.
    Landing,
    /// A limit point at the start of the path.
    Start,
    /// The edge that runs outward from an unstable start just passes, or just does not pass, over a crest.
    Arrival,
}

/// Half the step of a difference quotient by a share: the rounding of the table leaves eight digits.
const STEP: f64 = 3e-6;

/// Rounds of Newton's method, and the size of correction at which it has converged.
const ROUNDS: usize = 30;
const CONVERGED: f64 = 1e-12;

/// The equations of one sort of line.
#[derive(Debug, Clone, Copy)]
pub struct Equations<'a> {
    /// The family.
    pub family: &'a Family,
    /// What is sought.
    pub sort: Sort,
    /// The unit of radii.
    pub unit: f64,
}

/// One equation: its value, the size of its terms, and its derivatives by the radii.
struct EquationRow {
    value: f64,
    size: f64,
    by_radius: [f64; 2],
}

impl<'a> Equations<'a> {
    /// The equations of `sort` in `family`.
    pub fn new(family: &'a Family, sort: Sort) -> Self {
        Self { family, sort, unit: family.wave().unwrap_or(0.1 * family.radii[1]) }
    }

    /// How many of the unknowns are radii.
    pub fn radii(&self) -> usize {
        match self.sort {
            Sort::Fold | Sort::Cusp | Sort::Arrival => 1,
            Sort::Landing => 2,
            Sort::Start => 0,
        }
    }

    /// Settings of the tracer: steps that are short compared with a wave and with the map.
    pub fn settings(&self) -> Settings {
        let mut settings = Settings::new(self.unknowns());
        settings.largest_increment.fill(0.05);
        settings.longest = 0.06;
        settings.first = 0.01;
        settings.tolerance = 1e-9;
        settings.shortest = 1e-5;
        settings.points = 1500;
        settings
    }

    /// What the law needs to know at the radii of `y`.
    pub fn locals(&self, y: &[f64]) -> Option<Vec<LocalLaw>> {
        let (radii, shares) = y.split_at(self.radii());
        let member = self.family.member(shares).ok()?;
        if self.sort == Sort::Start {
            return Some(vec![member.local(self.family.start()?)?]);
        }
        let mut locals: Vec<LocalLaw> =
            radii.iter().map(|s| member.local(s * self.unit)).collect::<Option<_>>()?;
        if self.sort == Sort::Arrival {
            locals.push(member.local(self.family.start()?)?);
        }
        Some(locals)
    }

    fn rows(&self, y: &[f64]) -> Option<Vec<EquationRow>> {
        let locals = self.locals(y)?;
        let fold = |local: &LocalLaw, at: usize| {
            let mut by_radius = [0.0; 2];
            by_radius[at] = local.edge.slope * self.unit;
            let size = local.edge.value.abs().max(local.root).max(f64::MIN_POSITIVE);
            EquationRow { value: local.edge.value - local.root, size, by_radius }
        };
        let folds = if self.sort == Sort::Arrival { 1 } else { locals.len() };
        let mut rows: Vec<EquationRow> =
            locals[..folds].iter().enumerate().map(|(at, local)| fold(local, at)).collect();
        match (self.sort, &locals[..]) {
            (Sort::Cusp, [local]) => rows.push(EquationRow {
                value: local.edge.slope * self.unit,
                size: rows[0].size,
                by_radius: [local.edge.bend * self.unit * self.unit, 0.0],
            }),
            (Sort::Landing | Sort::Arrival, [outer, inner]) => {
                let [a, b] = [outer, inner].map(LocalLaw::control_value);
                let [da, db] = [outer, inner].map(|local| {
                    let [approach, force] = local.slopes();
                    weighted(local.control, approach, force) * self.unit
                });
                let size = (a.abs() + b.abs()).max(f64::MIN_POSITIVE);
                let inner = if self.sort == Sort::Arrival { 0.0 } else { -db };
                rows.push(EquationRow { value: a - b, size, by_radius: [da, inner] });
            }
            _ => {}
        }
        Some(rows)
    }

    /// The solution next to `y` with the unknown `held` kept fixed; `None` where Newton's method finds none.
    pub fn polished(&self, y: &[f64], held: usize) -> Option<Vec<f64>> {
        let n = self.unknowns();
        let mut y = DVector::from_column_slice(y);
        let mut at = Linearization::new(n);
        for _ in 0..ROUNDS {
            self.linearize(&y, &mut at)?;
            let free: Vec<usize> = (0..n).filter(|k| *k != held).collect();
            let jacobian = DMatrix::from_fn(n - 1, n - 1, |i, j| at.jacobian[(i, free[j])] / at.scale[i]);
            let right = DVector::from_fn(n - 1, |i, _| -at.residual[i] / at.scale[i]);
            let correction = jacobian.lu().solve(&right)?;
            if !correction.iter().all(|x| x.is_finite()) || correction.norm() > 0.5 {
                return None;
            }
            for (k, dx) in free.iter().zip(correction.iter()) {
                y[*k] += dx;
            }
            if correction.norm() <= CONVERGED {
                return Some(y.as_slice().to_vec());
            }
        }
        // Differences of tables leave corrections as large as their own rounding.
        self.linearize(&y, &mut at)?;
        (at.relative_residual() <= 1e-9).then(|| y.as_slice().to_vec())
    }

    /// The point of a solution, with its tangent along `forward`.
    pub fn point(&self, y: &[f64], forward: &[f64]) -> Option<Point> {
        let y = DVector::from_column_slice(y);
        let mut at = Linearization::new(self.unknowns());
        self.linearize(&y, &mut at)?;
        Point::new(self, &y, &at, &Vector::from_row_slice(forward))
    }
}

impl System for Equations<'_> {
    fn unknowns(&self) -> usize {
        self.radii() + self.family.axes.len()
    }

    fn linearize(&self, y: &Vector, at: &mut Linearization) -> Option<()> {
        let rows = self.rows(y.as_slice())?;
        let radii = self.radii();
        for (i, row) in rows.iter().enumerate() {
            at.residual[i] = row.value;
            at.scale[i] = row.size;
            for k in 0..radii {
                at.jacobian[(i, k)] = row.by_radius[k];
            }
        }
        for k in radii..self.unknowns() {
            // One-sided at the border of the values a number may take.
            let moved = |by: f64| {
                let mut moved = y.as_slice().to_vec();
                moved[k] += by;
                self.rows(&moved)
            };
            let (lo, hi) = (moved(-STEP), moved(STEP));
            let width = if lo.is_some() && hi.is_some() { 2.0 * STEP } else { STEP };
            let (lo, hi) = (lo.as_ref().unwrap_or(&rows), hi.as_ref().unwrap_or(&rows));
            for i in 0..rows.len() {
                at.jacobian[(i, k)] = (hi[i].value - lo[i].value) / width;
            }
        }
        at.kept.clear();
        Some(())
    }
}
