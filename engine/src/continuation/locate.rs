//! Guarded Newton on a limit point, or on a control value, inside its bracket.
//!
//! With the matrix M = (J; dᵀ) closed by a row d along the curve, v and w from
//!
//! ```text
//! M v = (0, 1),     Mᵀ w = c        φ = c·v,     φ_y[z] = −w_gᵀ J_v z
//! ```
//!
//! v is a tangent of length about one, so φ is the slope of the control c along the curve and vanishes at its limit
//! points, where M, unlike (J; cᵀ), is regular (W. Govaerts, Numerical Methods for Bifurcations of Dynamical Equilibria,
//! SIAM 2000, doi:10.1137/1.9780898719543, ch. 3, on such test functions). Newton on (g, φ) converges quadratically; the
//! guard keeps it inside the bracket, which is halved otherwise.

use super::branch::{Point, hermite};
use super::convergence::{Convergence, NewtonFailure};
use super::corrector::Constraint;
use super::events::Bracket;
use super::system::Vector;
use super::tracer::Tracer;

/// A located limit point of a control.
#[derive(Debug, Clone, PartialEq)]
pub struct LimitPoint {
    /// The branch point before it.
    pub index: usize,
    /// The point.
    pub point: Point,
    /// Length of the last correction: the error of the state.
    pub correction: f64,
    /// c·k there: positive for a minimum of the control along the branch, negative for a maximum, near
    /// zero where two limit points merge.
    pub bend: f64,
}

impl Tracer<'_> {
    /// Locates the limit point of the control `row` (n numbers) inside `bracket`, to rounding.
    ///
    /// # Errors
    /// The last failure when even halving does not find it, which does not happen on a smooth curve.
    pub fn limit_point(&mut self, bracket: &Bracket, row: &Vector) -> Result<LimitPoint, NewtonFailure> {
        let Bracket { index, from, to } = bracket;
        self.guarded(
            [from, to],
            row,
            root_of_slope,
            |p| p.slope(row),
            |tracer, from, to, x| {
                let course = tracer.turn(from, to, x, row)?;
                let singular = NewtonFailure::Singular { round: course.round() };
                let point = tracer.point(0, (to.y() - from.y()).column(0)).ok_or(singular)?;
                let bend = row.dot(&point.curvature());
                Ok(LimitPoint { index: *index, point, correction: course.correction(), bend })
            },
        )
    }

    /// The point between two neighbours at which the control `row` (n numbers) takes `value`, to rounding.
    ///
    /// # Errors
    /// The last failure when even halving does not find it, as where the control does not pass `value` between the two.
    pub fn control_value(
        &mut self,
        ends: [&Point; 2],
        row: &Vector,
        value: f64,
    ) -> Result<Point, NewtonFailure> {
        let miss = |p: &Point| row.dot(&p.y()) - value;
        let share = |from: &Point, to: &Point, _: &Vector| miss(from) / (miss(from) - miss(to));
        self.guarded(ends, row, share, miss, |tracer, from, to, x| {
            let (plane, chord) = (Constraint::Plane { row: row.column(0), value }, to.y() - from.y());
            tracer.y = hermite(from, to, x.clamp(0.02, 0.98));
            let round = tracer.correct(plane)?;
            let share = (&tracer.y - from.y()).dot(&chord) / chord.norm_squared();
            if !(0.0..=1.0).contains(&share) {
                return Err(NewtonFailure::Left { round, correction: tracer.correction.norm() });
            }
            tracer.polish(plane);
            tracer.point(round, chord.column(0)).ok_or(NewtonFailure::Singular { round })
        })
    }

    /// What `find` finds between two points, starting from a guess at a share of the piece; where that fails, the
    /// search goes on in the part of the piece in which `side` changes sign.
    fn guarded<T>(
        &mut self,
        [from, to]: [&Point; 2],
        row: &Vector,
        guess: impl Fn(&Point, &Point, &Vector) -> f64,
        side: impl Fn(&Point) -> f64,
        mut find: impl FnMut(&mut Self, &Point, &Point, f64) -> Result<T, NewtonFailure>,
    ) -> Result<T, NewtonFailure> {
        self.check(&[from, to], Some(row))?;
        let (mut from, mut to) = (from.clone(), to.clone());
        let mut rounds = 0;
        loop {
            let x = guess(&from, &to, row);
            match find(self, &from, &to, x) {
                Err(failure) if rounds >= self.settings.locate_rounds => return Err(failure),
                Err(_) => {}
                found => return found,
            }
            rounds += 1;
            let middle = self.near(&from, &to, x.clamp(0.1, 0.9))?;
            if (side(&middle) > 0.0) == (side(&from) > 0.0) {
                from = middle;
            } else {
                to = middle;
            }
        }
    }

    /// A point of the curve inside the piece, on the plane across the chord at share `x` if one can be found there,
    /// otherwise nearer to an end.
    ///
    /// The interpolation is best near the ends. Under weak adhesion its error in the middle of a long piece can exceed
    /// the whole adhesion term, and the equations are not defined there.
    fn near(&mut self, from: &Point, to: &Point, x: f64) -> Result<Point, NewtonFailure> {
        let chord = to.y() - from.y();
        let mut last = NewtonFailure::Undefined { round: 0 };
        for share in [1.0, 0.5, 0.2, 0.05, 0.01] {
            for x in [x * share, 1.0 - (1.0 - x) * share] {
                self.y = hermite(from, to, x);
                let found =
                    self.correct(Constraint::Plane { row: chord.column(0), value: chord.dot(&self.y) });
                let point = found.and_then(|round| {
                    self.point(round, chord.column(0)).ok_or(NewtonFailure::Singular { round })
                });
                match point {
                    Ok(point) => return Ok(point),
                    Err(failure) => last = failure,
                }
            }
        }
        Err(last)
    }

    /// Newton on (g, φ) from the Hermite point at share `x`, guarded by the bracket.
    fn turn(&mut self, from: &Point, to: &Point, x: f64, row: &Vector) -> Result<Convergence, NewtonFailure> {
        let chord = to.y() - from.y();
        let length = chord.norm();
        let [mut v, mut w] = [(); 2].map(|()| Vector::zeros(chord.len()));
        self.y = hermite(from, to, x);
        let mut along = from.tangent() * (1.0 - x) + to.tangent() * x;
        let mut convergence = Convergence::new(self.settings.location(length));
        loop {
            let round = convergence.round();
            self.linearize(round)?;
            if convergence.is_reached(self.at.relative_residual())? {
                return Ok(convergence);
            }
            let singular = NewtonFailure::Singular { round };
            along.normalize_mut();
            let Self { system, y, at, algebra, work, row: gradient, .. } = self;
            algebra.closed.factor(&at.jacobian, along.column(0)).ok_or(singular)?;
            algebra.closed.null_vector(&mut algebra.right, &mut v);
            algebra.closed.solve_transposed(row, &mut algebra.right, &mut w);
            let undefined = NewtonFailure::Undefined { round };
            algebra.second.find(*system, y, at, &v, &mut work.evaluations).ok_or(undefined)?;
            for (gradient, column) in gradient.iter_mut().zip(algebra.second.along.column_iter()) {
                *gradient = -column.iter().zip(w.iter()).map(|(x, w)| x * w).sum::<f64>();
            }
            let correction = self.newton(row.dot(&v)).ok_or(singular)?;
            convergence.corrected(correction)?;
            self.y += &self.correction;
            let share = (&self.y - from.y()).dot(&chord) / (length * length);
            if !(0.0..=1.0).contains(&share) {
                return Err(NewtonFailure::Left { round, correction });
            }
            along.copy_from(&v);
        }
    }
}

/// Where the cubic of the slope of `row` between two points vanishes, as a share of the piece.
fn root_of_slope(from: &Point, to: &Point, row: &Vector) -> f64 {
    let length = (to.y() - from.y()).norm();
    let (f0, f1) = (from.slope(row), to.slope(row));
    let (d0, d1) = (length * row.dot(&from.curvature()), length * row.dot(&to.curvature()));
    let a = 2.0 * (f0 - f1) + d0 + d1;
    let b = 3.0 * (f1 - f0) - 2.0 * d0 - d1;
    let (mut lo, mut hi) = (0.0, 1.0);
    // Halving cannot leave the bracket; a millionth of the piece is far below the error of the cubic.
    for _ in 0..20 {
        let x = 0.5 * (lo + hi);
        let value = ((a * x + b) * x + d0) * x + f0;
        if (value > 0.0) == (f0 > 0.0) { lo = x } else { hi = x }
    }
    0.5 * (lo + hi)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::continuation::Settings;
    use crate::continuation::fixtures::Cubic;

    #[test]
    fn the_folds_of_the_cubic_to_rounding() {
        let row = Vector::from_vec(vec![0.0, 1.0]);
        for (a, b, u, p) in [(-1.4, -0.7, -1.0, 2.0), (0.5, 1.9, 1.0, -2.0), (0.999_999, 1.9, 1.0, -2.0)] {
            let bracket = Bracket { index: 0, from: Cubic.point(a), to: Cubic.point(b) };
            let mut tracer = Tracer::new(&Cubic, Settings::new(2));
            let found = tracer.limit_point(&bracket, &row).unwrap();
            assert!((found.point.y()[0] - u).abs() < 1e-13, "{}", found.point.y()[0] - u);
            assert!((found.point.y()[1] - p).abs() < 1e-13);
            assert_eq!(found.bend > 0.0, p < 0.0);
            assert!(tracer.work.evaluations <= 20, "{:?}", tracer.work);
        }
    }

    #[test]
    fn a_control_value_inside_its_bracket() {
        let row = Vector::from_vec(vec![0.0, 1.0]);
        let ends = [&Cubic.point(1.2), &Cubic.point(2.5)];
        let found = Tracer::new(&Cubic, Settings::new(2)).control_value(ends, &row, 3.0).unwrap();
        assert!((Cubic::p(found.y()[0]) - 3.0).abs() < 1e-9);
    }
}
