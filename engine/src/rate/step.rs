//! One implicit step of the equation of motion.
//!
//! The unknowns of a stage are `p_i` = φ, by full Newton iteration. As a function of y, φ is a sigmoid, the narrower
//! the lower the speed. Where it is steep compared with the step, its inverse, which is nearly a line, is solved
//! instead,
//!
//! ```text
//! p − φ(ξ, y) = 0    or    drive(ξ, y) − drive of the speed of p = 0
//! ```

use super::equation::{Equation, StretchMoment};
use super::radau::{ERROR_WEIGHTS, NODES, REAL_EIGENVALUE, STAGES, WEIGHTS, dot};
use super::settings::PullSettings;
use crate::root::RootBracket;
use nalgebra::{SMatrix, SVector};

/// A step that was solved.
#[derive(Debug, Clone, Copy, Default)]
pub struct SolvedStep {
    /// ξ at its beginning.
    pub from: f64,
    /// h.
    pub length: f64,
    /// The stages: p.
    pub slopes: [f64; STAGES],
    /// Their moments; the last one is the end of the step.
    pub nodes: [StretchMoment; STAGES],
    /// y at the end.
    pub y: f64,
    /// The estimated error of y.
    pub error: f64,
}

impl SolvedStep {
    /// The moment at its end.
    pub fn end(&self) -> &StretchMoment {
        &self.nodes[STAGES - 1]
    }

    /// The estimated error of what is summed over the step, which begins at `start`.
    pub fn error_of(&self, density: fn(&StretchMoment) -> f64, start: &StretchMoment) -> f64 {
        let values = self.nodes.each_ref().map(density);
        self.length * (REAL_EIGENVALUE * density(start) + dot(&ERROR_WEIGHTS, &values))
    }

    /// The sums over the step up to each stage.
    pub fn sums(&self, density: fn(&StretchMoment) -> f64) -> [f64; STAGES] {
        let values = self.nodes.each_ref().map(density);
        WEIGHTS.map(|row| self.length * dot(&row, &values))
    }
}

/// The end of a step is brought to a place within this share of its length.
const THERE: f64 = 1e-14;
/// Where Newton's method would pass a bound, φ keeps this share of its distance from it.
const TOWARDS_BOUND: f64 = 0.1;

/// Solves a step of the length `h` from ξ and y, where the moment is `start`; `guess` are the expected stages,
/// `tolerance` is that of y. `None` where Newton's method finds nothing.
pub fn solve(
    equation: &Equation<'_>,
    [xi, y]: [f64; 2],
    start: &StretchMoment,
    h: f64,
    guess: [f64; STAGES],
    tolerance: f64,
    settings: &PullSettings,
) -> Option<Box<SolvedStep>> {
    let mut p = guess;
    let mut found = Box::new(SolvedStep { from: xi, length: h, ..SolvedStep::default() });
    let nodes = &mut found.nodes;
    for _ in 0..settings.newton {
        let ways: [f64; STAGES] = std::array::from_fn(|i| y + h * dot(&WEIGHTS[i], &p));
        equation.fill(&NODES.map(|c| xi + c * h), &ways, nodes)?;
        let mut matrix = SMatrix::<f64, STAGES, STAGES>::zeros();
        let mut right = SVector::<f64, STAGES>::zeros();
        let mut inverse = [false; STAGES];
        for (i, node) in nodes.iter().enumerate() {
            let steepness = (h * WEIGHTS[i][i] * node.phi_by_y).abs();
            inverse[i] = steepness.is_nan() || steepness >= 1.0;
            let (by_y, own) = if inverse[i] {
                let [drive, slope] = equation.drive_of(p[i]);
                right[i] = node.drive - drive;
                (node.drive_by_y, -slope)
            } else {
                right[i] = p[i] - node.phi;
                (-node.phi_by_y, 1.0)
            };
            for (j, weight) in WEIGHTS[i].iter().enumerate() {
                matrix[(i, j)] = h * weight * by_y;
            }
            matrix[(i, i)] += own;
        }
        if !matrix.lu().solve_mut(&mut right) {
            return None;
        }
        let mut size = 0.0_f64;
        for (i, p) in p.iter_mut().enumerate() {
            let mut next = *p - right[i];
            if next.is_nan() {
                return None;
            }
            if next.abs() >= 1.0 {
                next = (1.0 - TOWARDS_BOUND * (1.0 - p.abs())).copysign(next);
            }
            if inverse[i] && *p > 0.0 && next <= 0.0 && nodes[i].drive > 0.0 {
                next = TOWARDS_BOUND * *p;
            }
            size = size.max((next - *p).abs());
            *p = next;
        }
        if h * size <= settings.converged * tolerance {
            // What is summed over the step then belongs to the same way as y.
            nodes.iter_mut().zip(p).for_each(|(node, p)| node.phi = p);
            let along = REAL_EIGENVALUE * start.phi + dot(&ERROR_WEIGHTS, &p);
            let damped = 1.0 - h * REAL_EIGENVALUE * start.phi_by_y;
            // An estimate that grew where the edge runs away by itself would be useless.
            let error = if damped.is_finite() { h * along / damped.abs().max(1.0) } else { 0.0 };
            (found.slopes, found.y, found.error) = (p, y + h * dot(&WEIGHTS[STAGES - 1], &p), error);
            return Some(found);
        }
    }
    None
}

/// The step that ends where `of` vanishes, found by its length in `[from, to]`; `before` is the value at the shorter
/// length, `longest` is the step of the longer one.
pub fn landed(
    step: &dyn Fn(f64) -> Option<Box<SolvedStep>>,
    [from, to]: [f64; 2],
    before: f64,
    longest: Box<SolvedStep>,
    of: &dyn Fn(&StretchMoment) -> f64,
) -> Option<Box<SolvedStep>> {
    let mut found = longest;
    let after = of(found.end());
    let Some(mut bracket) = RootBracket::new([from, before], [to, after]) else {
        // If the place was passed before the step begins, the step ends where it begins.
        return if after == 0.0 { Some(found) } else { step(THERE * to) };
    };
    bracket.close(THERE * to, |h| {
        let tried = step(h)?;
        let value = of(tried.end());
        if value == 0.0 || (value > 0.0) == (after > 0.0) {
            found = tried;
        }
        Some(value)
    })?;
    Some(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_passed_before_a_step_ends_it_where_it_begins() {
        let step = |h: f64| {
            let mut found = Box::new(SolvedStep { length: h, ..SolvedStep::default() });
            found.nodes[STAGES - 1].time = h;
            Some(found)
        };
        let passed = |from: f64| move |at: &StretchMoment| at.time - from;
        let found =
            |from: f64| landed(&step, [0.0, 1.0], -from, step(1.0).unwrap(), &passed(from)).unwrap().length;
        assert!((found(0.3) - 0.3).abs() < 1e-13);
        assert_eq!(found(1.0).to_bits(), 1f64.to_bits());
        assert!(found(-1e-17) < 1e-12);
    }
}
