//! Where a control turns along a branch: sign changes of its slope, and pairs hidden inside one step.
//!
//! The slope of the control c is φ = c·t with dφ/dℓ = c·k. Between two points
//!
//! 1. a sign change of φ brackets a limit point;
//! 2. equal signs can hide a pair. The cubic through both values and slopes is examined: where its
//!    extreme comes close to zero, the curve is solved there and both halves are judged anew.

use super::branch::{Point, hermite};
use super::corrector::Constraint;
use super::system::{SizeError, Vector};
use super::tracer::Tracer;

/// Two neighbouring points between which the slope of a control changes its sign.
#[derive(Debug, Clone, PartialEq)]
pub struct Bracket {
    /// The index of the branch point before it.
    pub index: usize,
    /// The point before.
    pub from: Point,
    /// The point after.
    pub to: Point,
}

impl Tracer<'_> {
    /// All sign changes of the slope of `row` (n numbers) along `points`, in order.
    ///
    /// # Errors
    /// When the sizes do not agree.
    pub fn brackets(&mut self, points: &[Point], row: &Vector) -> Result<Vec<Bracket>, SizeError> {
        let mut found = Vec::new();
        for (index, pair) in points.windows(2).enumerate() {
            let [from, to] = pair else { continue };
            self.check(&[from, to], Some(row))?;
            self.piece(from, to, row, self.settings.grazing_depth, &mut |from, to| {
                found.push(Bracket { index, from: from.clone(), to: to.clone() });
            });
        }
        Ok(found)
    }

    fn piece(
        &mut self,
        from: &Point,
        to: &Point,
        row: &Vector,
        depth: usize,
        found: &mut dyn FnMut(&Point, &Point),
    ) {
        let (f0, f1) = (from.slope(row), to.slope(row));
        // A slope of exactly zero belongs to the piece that ends with it, so that it counts once.
        if (f0 > 0.0) != (f1 > 0.0) && f0 != 0.0 {
            return found(from, to);
        }
        let chord = to.y() - from.y();
        let length = chord.norm();
        if depth == 0 || length < self.settings.grazing_shortest {
            return;
        }
        let slopes = [from, to].map(|p| length * row.dot(&p.curvature()));
        let Some(x) = approach_to_zero([f0, f1], slopes, self.settings.grazing) else { return };
        self.y = hermite(from, to, x);
        let across = from.tangent() * (1.0 - x) + to.tangent() * x;
        let plane = Constraint::Plane { row: across.column(0), value: across.dot(&self.y) };
        let Ok(rounds) = self.correct(plane) else { return };
        let Some(mut middle) = self.point(rounds, chord.column(0)) else { return };
        if middle.positive != from.positive {
            middle = middle.reversed();
        }
        let share = (middle.y() - from.y()).dot(&chord) / chord.norm_squared();
        if share > 0.0 && share < 1.0 {
            self.piece(from, &middle, row, depth - 1, found);
            self.piece(&middle, to, row, depth - 1, found);
        }
    }
}

/// Where the cubic on 0..1 with end values `f` (of one sign) and end slopes `d` comes closest to zero, if it crosses
/// zero or comes nearer to it than `share` of its larger end.
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
    use crate::continuation::Settings;
    use crate::continuation::fixtures::Cubic;

    #[test]
    fn a_pair_inside_one_step_is_found() {
        // Both folds of the cubic between two points whose p-slopes have the same sign.
        let points = [Cubic.point(-1.2), Cubic.point(1.2)];
        let row = Vector::from_vec(vec![0.0, 1.0]);
        let found = Tracer::new(&Cubic, Settings::new(2)).brackets(&points, &row).unwrap();
        assert_eq!(found.len(), 2);
    }

    #[test]
    fn a_monotone_piece_has_none() {
        let points = [Cubic.point(1.5), Cubic.point(2.0), Cubic.point(3.0)];
        let row = Vector::from_vec(vec![0.0, 1.0]);
        assert!(Tracer::new(&Cubic, Settings::new(2)).brackets(&points, &row).unwrap().is_empty());
    }

    #[test]
    fn the_cubic_test_sees_a_grazing_minimum() {
        assert!(approach_to_zero([1.0, 1.0], [-4.1, 4.1], 0.05).is_some());
        assert!(approach_to_zero([-1.0, -1.0], [4.1, -4.1], 0.05).is_some());
        assert_eq!(approach_to_zero([1.0, 1.0], [-1.0, 1.0], 0.05), None);
        assert_eq!(approach_to_zero([1.0, 1.0], [0.0, 0.0], 0.05), None);
    }
}
