//! Where a control turns along a branch: sign changes of its slope, and pairs hidden inside one step.
//!
//! The slope of the control c is φ = c·t with dφ/dℓ = c·k. Between two points
//!
//! 1. a sign change of φ brackets a limit point;
//! 2. equal signs can hide a pair. The cubic through both values and slopes is looked at: where its
//!    extreme comes close to zero, the curve is solved there and both halves are judged anew.

use super::branch::{Point, Work, hermite};
use super::corrector::{Constraint, correct};
use super::settings::Settings;
use super::system::{System, Vector};

/// Two neighbouring points between which the slope of a control changes its sign.
#[derive(Debug, Clone, PartialEq)]
pub struct Bracket<const N: usize> {
    /// The index of the branch point before it.
    pub index: usize,
    /// The point before.
    pub from: Point<N>,
    /// The point after.
    pub to: Point<N>,
}

/// All sign changes of the slope of `row` along `points`, in order.
pub fn brackets<const N: usize>(
    system: &dyn System<N>,
    points: &[Point<N>],
    row: &Vector<N>,
    settings: &Settings,
    work: &mut Work,
) -> Vec<Bracket<N>> {
    let mut found = Vec::new();
    for (index, pair) in points.windows(2).enumerate() {
        let mut search = Search { system, row, settings, work: &mut *work, index, found: &mut found };
        search.piece(&pair[0], &pair[1], settings.grazing_depth);
    }
    found
}

struct Search<'a, const N: usize> {
    system: &'a dyn System<N>,
    row: &'a Vector<N>,
    settings: &'a Settings,
    work: &'a mut Work,
    index: usize,
    found: &'a mut Vec<Bracket<N>>,
}

impl<const N: usize> Search<'_, N> {
    fn piece(&mut self, from: &Point<N>, to: &Point<N>, depth: usize) {
        let (f0, f1) = (from.slope(self.row), to.slope(self.row));
        // A slope of exactly zero belongs to the piece that ends with it, so that it counts once.
        if (f0 > 0.0) != (f1 > 0.0) && f0 != 0.0 {
            self.found.push(Bracket { index: self.index, from: from.clone(), to: to.clone() });
            return;
        }
        let length = (to.y - from.y).norm();
        if depth == 0 || length < self.settings.grazing_shortest {
            return;
        }
        let slopes = [from, to].map(|p| length * self.row.dot(&p.frame.curvature));
        let Some(x) = approach_to_zero([f0, f1], slopes, self.settings.grazing) else { return };
        let guess = hermite(from, to, x);
        let across = from.frame.tangent * (1.0 - x) + to.frame.tangent * x;
        let plane = Constraint::Plane { value: across.dot(&guess), row: across };
        let Ok(corrected) = correct(self.system, guess, &plane, self.settings) else { return };
        self.work.evaluations += corrected.rounds + 1;
        let chord = to.y - from.y;
        let Some(mut middle) = Point::corrected(&corrected, &chord) else { return };
        if middle.frame.positive != from.frame.positive {
            middle = middle.reversed();
        }
        let share = (middle.y - from.y).dot(&chord) / chord.norm_squared();
        if share > 0.0 && share < 1.0 {
            self.piece(from, &middle, depth - 1);
            self.piece(&middle, to, depth - 1);
        }
    }
}

/// Where the cubic on 0..1 with end values `f` (of one sign) and end slopes `d` comes closest to zero, if
/// it crosses it or comes nearer than `share` of its larger end.
fn approach_to_zero(f: [f64; 2], d: [f64; 2], share: f64) -> Option<f64> {
    let sign = if f[0] + f[1] < 0.0 { -1.0 } else { 1.0 };
    let [f0, f1, d0, d1] = [f[0] * sign, f[1] * sign, d[0] * sign, d[1] * sign];
    // A cubic lies between its four Bernstein coefficients.
    let level = share * f0.max(f1);
    if (f0 + d0 / 3.0).min(f1 - d1 / 3.0).min(f0.min(f1)) > level {
        return None;
    }
    // f = a x³ + b x² + d0 x + f0; extremes where 3a x² + 2b x + d0 = 0.
    let a = 2.0 * (f0 - f1) + d0 + d1;
    let b = 3.0 * (f1 - f0) - 2.0 * d0 - d1;
    let value = |x: f64| ((a * x + b) * x + d0) * x + f0;
    let discriminant = b * b - 3.0 * a * d0;
    if discriminant < 0.0 {
        return None;
    }
    let root = discriminant.sqrt();
    let q = -(b + b.signum() * root);
    [q / (3.0 * a), d0 / q]
        .into_iter()
        .filter(|x| x.is_finite() && *x > 0.0 && *x < 1.0)
        .filter(|x| value(*x) < level)
        .min_by(|x, y| value(*x).total_cmp(&value(*y)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::continuation::examples::Cubic;

    #[test]
    fn a_pair_inside_one_step_is_found() {
        // Both folds of the cubic between two points whose p-slopes have the same sign.
        let points = [Cubic.point(-1.2), Cubic.point(1.2)];
        let row = Vector::from([0.0, 1.0]);
        let found = brackets(&Cubic, &points, &row, &Settings::new(2), &mut Work::default());
        assert_eq!(found.len(), 2);
    }

    #[test]
    fn a_monotone_piece_has_none() {
        let points = [Cubic.point(1.5), Cubic.point(2.0), Cubic.point(3.0)];
        let row = Vector::from([0.0, 1.0]);
        assert!(brackets(&Cubic, &points, &row, &Settings::new(2), &mut Work::default()).is_empty());
    }

    #[test]
    fn the_cubic_test_sees_a_grazing_minimum() {
        assert!(approach_to_zero([1.0, 1.0], [-4.1, 4.1], 0.05).is_some());
        assert!(approach_to_zero([-1.0, -1.0], [4.1, -4.1], 0.05).is_some());
        assert_eq!(approach_to_zero([1.0, 1.0], [-1.0, 1.0], 0.05), None);
        assert_eq!(approach_to_zero([1.0, 1.0], [0.0, 0.0], 0.05), None);
    }
}
