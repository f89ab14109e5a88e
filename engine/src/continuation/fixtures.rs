//! Small systems with known answers, for the tests of this module.

use super::branch::Point;
use super::system::{Linearization, Matrix, MatrixMut, System, Vector};

/// p = u³ − 3u with unknowns (u, p): folds of p at u = ∓1, p = ±2.
#[derive(Debug)]
pub struct Cubic;

impl Cubic {
    pub fn p(u: f64) -> f64 {
        u * u * u - 3.0 * u
    }

    pub fn point(&self, u: f64) -> Point {
        point(self, vec![u, Self::p(u)], &[1.0, 0.0])
    }
}

/// The point of a solution, with its tangent along `forward`.
pub fn point(system: &dyn System, y: Vec<f64>, forward: &[f64]) -> Point {
    let (y, mut at) = (Vector::from_vec(y), Linearization::new(system.unknowns()));
    system.linearize(&y, &mut at).unwrap();
    Point::new(system, &y, &at, &Vector::from_row_slice(forward)).unwrap()
}

impl System for Cubic {
    fn unknowns(&self) -> usize {
        2
    }

    fn linearize(&self, y: &Vector, at: &mut Linearization) -> Option<()> {
        let (u, p) = (y[0], y[1]);
        at.residual[0] = Self::p(u) - p;
        at.scale[0] = 1.0;
        at.jacobian.copy_from_slice(&[3.0 * u * u - 3.0, -1.0]);
        at.kept.clear();
        at.kept.push(6.0 * u);
        Some(())
    }

    fn second(&self, at: &Linearization, v: &Vector, mut second: MatrixMut<'_>) -> Option<()> {
        second.copy_from_slice(&[at.kept[0] * v[0], 0.0]);
        Some(())
    }
}

/// The unit circle.
#[derive(Debug)]
pub struct Circle;

impl Circle {
    pub fn point(&self, angle: f64) -> Point {
        point(self, vec![angle.cos(), angle.sin()], &[-angle.sin(), angle.cos()])
    }
}

impl System for Circle {
    fn unknowns(&self) -> usize {
        2
    }

    fn linearize(&self, y: &Vector, at: &mut Linearization) -> Option<()> {
        at.residual[0] = y.norm_squared() - 1.0;
        at.scale[0] = 1.0;
        at.jacobian.copy_from_slice(&[2.0 * y[0], 2.0 * y[1]]);
        Some(())
    }
}

/// p = u³ − 3u, v = u², w = uv with unknowns (u, v, w, p): folds of p at u = ∓1, as the cubic's.
#[derive(Debug)]
pub struct Lifted {
    /// Whether it provides its second derivatives.
    pub with_second: bool,
}

impl Lifted {
    pub fn point(&self, u: f64) -> Point {
        point(self, vec![u, u * u, u * u * u, Cubic::p(u)], &[1.0, 0.0, 0.0, 0.0])
    }
}

impl System for Lifted {
    fn unknowns(&self) -> usize {
        4
    }

    fn linearize(&self, y: &Vector, at: &mut Linearization) -> Option<()> {
        let [u, v, w, p] = [y[0], y[1], y[2], y[3]];
        at.residual.copy_from_slice(&[w - 3.0 * u - p, v - u * u, w - u * v]);
        at.scale.fill(1.0);
        let rows = [[-3.0, 0.0, 1.0, -1.0], [-2.0 * u, 1.0, 0.0, 0.0], [-v, -u, 1.0, 0.0]];
        at.jacobian = Matrix::from_row_slice(3, 4, rows.as_flattened());
        Some(())
    }

    fn second(&self, _: &Linearization, v: &Vector, mut second: MatrixMut<'_>) -> Option<()> {
        second.fill(0.0);
        second[(1, 0)] = -2.0 * v[0];
        (second[(2, 0)], second[(2, 1)]) = (-v[1], -v[0]);
        self.with_second.then_some(())
    }
}

/// u″ + λ eᵘ = 0 on 0..1 with u = 0 at both ends (Bratu), by differences on `nodes` inner nodes: fold of λ at
/// 3.513830719 + O(h²).
///
/// Unknowns: √h u at the nodes, so that a step has a length that does not depend on h, and λ.
#[derive(Debug)]
pub struct Bratu {
    pub nodes: usize,
    /// Whether it provides its second derivatives.
    pub with_second: bool,
}

impl Bratu {
    fn spacing(&self) -> f64 {
        1.0 / (self.nodes + 1) as f64
    }

    /// The point u = 0, λ = 0, from which λ grows.
    pub fn start(&self) -> Point {
        let mut forward = vec![0.0; self.nodes];
        forward.push(1.0);
        point(self, vec![0.0; self.nodes + 1], &forward)
    }

    /// The row of λ.
    pub fn load(&self) -> Vector {
        Vector::from_fn(self.nodes + 1, |i, _| f64::from(u8::from(i == self.nodes)))
    }
}

impl System for Bratu {
    fn unknowns(&self) -> usize {
        self.nodes + 1
    }

    fn linearize(&self, y: &Vector, at: &mut Linearization) -> Option<()> {
        let (h, n) = (self.spacing(), self.nodes);
        let unit = h.sqrt();
        let u = |i: usize| if i < n { y[i] / unit } else { 0.0 };
        let load = y[n];
        at.jacobian.fill(0.0);
        at.kept.clear();
        for i in 0..n {
            let (before, after) = (if i > 0 { u(i - 1) } else { 0.0 }, u(i + 1));
            let growth = h * h * u(i).exp();
            at.residual[i] = before - 2.0 * u(i) + after + load * growth;
            at.scale[i] = before.abs() + 2.0 * u(i).abs() + after.abs() + growth * load.abs().max(1.0);
            if i > 0 {
                at.jacobian[(i, i - 1)] = 1.0 / unit;
            }
            if i + 1 < n {
                at.jacobian[(i, i + 1)] = 1.0 / unit;
            }
            at.jacobian[(i, i)] = (load * growth - 2.0) / unit;
            at.jacobian[(i, n)] = growth;
            at.kept.extend([load * growth, growth]);
        }
        Some(())
    }

    fn second(&self, at: &Linearization, v: &Vector, mut second: MatrixMut<'_>) -> Option<()> {
        let (unit, n) = (self.spacing().sqrt(), self.nodes);
        second.fill(0.0);
        for (i, kept) in at.kept.chunks_exact(2).enumerate() {
            second[(i, i)] = (kept[0] * v[i] / unit + kept[1] * v[n]) / unit;
            second[(i, n)] = kept[1] * v[i] / unit;
        }
        self.with_second.then_some(())
    }
}
