//! Guarded Newton on a limit point, or on a control value, inside its bracket.
//!
//! With the matrix M = (J; dᵀ) closed by a row d along the curve, v and w from
//!
//! ```text
//! M v = (0, 1),     Mᵀ w = c        φ = c·v,     φ_y[z] = −w_gᵀ g_yy[v, z]
//! ```
//!
//! v is a tangent of length about one, so φ is the slope of the control c along the curve and vanishes at its limit
//! points, where M, unlike (J; cᵀ), is regular (W. Govaerts, Numerical Methods for Bifurcations of Dynamical Equilibria,
//! SIAM 2000, doi:10.1137/1.9780898719543, ch. 3, on such test functions). Newton on (g, φ) converges quadratically; the
//! guard keeps it inside the bracket, which is halved otherwise.

use super::branch::{Point, Work, hermite};
use super::closed::Closed;
use super::corrector::{Constraint, correct, polish};
use super::events::Bracket;
use super::settings::Settings;
use super::system::{Linearization, System, Vector};

/// A located limit point of a control.
#[derive(Debug, Clone, PartialEq)]
pub struct LimitPoint<const N: usize> {
    /// The branch point before it.
    pub index: usize,
    /// The point.
    pub point: Point<N>,
    /// Length of the last correction: the error of the state.
    pub correction: f64,
    /// c·k there: positive for a minimum of the control along the branch, negative for a maximum, near
    /// zero where two limit points merge.
    pub bend: f64,
}

/// Locates the limit point of the control `row` inside `bracket`, to rounding.
///
/// `None` when not even halving finds it, which a smooth curve does not do.
pub fn limit_point<const N: usize>(
    system: &dyn System<N>,
    bracket: &Bracket<N>,
    row: &Vector<N>,
    settings: &Settings,
    work: &mut Work,
) -> Option<LimitPoint<N>> {
    let (mut from, mut to) = (bracket.from.clone(), bracket.to.clone());
    for _ in 0..settings.locate_rounds {
        let x = root_of_slope(&from, &to, row);
        if let Some((y, lin, correction)) = newton(system, &from, &to, x, row, settings, work) {
            let point = Point::new(y, &lin, &(to.y - from.y))?;
            let bend = row.dot(&point.frame.curvature);
            return Some(LimitPoint { index: bracket.index, point, correction, bend });
        }
        let middle = near(system, &from, &to, x.clamp(0.1, 0.9), settings, work)?;
        if (middle.slope(row) > 0.0) == (from.slope(row) > 0.0) {
            from = middle;
        } else {
            to = middle;
        }
    }
    None
}

/// The point between two neighbours at which the control `row` takes `value`, to rounding.
///
/// The control must differ from `value` in sign at the two; `None` when not even halving finds it.
pub fn control_value<const N: usize>(
    system: &dyn System<N>,
    from: &Point<N>,
    to: &Point<N>,
    row: &Vector<N>,
    value: f64,
    settings: &Settings,
    work: &mut Work,
) -> Option<Point<N>> {
    let (mut from, mut to) = (from.clone(), to.clone());
    let miss = |p: &Point<N>| row.dot(&p.y) - value;
    for _ in 0..settings.locate_rounds {
        let (a, b) = (miss(&from), miss(&to));
        if a == 0.0 {
            return Some(from);
        }
        if b == 0.0 {
            return Some(to);
        }
        let x = (a / (a - b)).clamp(0.02, 0.98);
        let plane = Constraint::Plane { row: *row, value };
        let chord = to.y - from.y;
        if let Ok(corrected) = correct(system, hermite(&from, &to, x), &plane, settings) {
            work.evaluations += corrected.rounds + 1;
            let share = (corrected.y - from.y).dot(&chord) / chord.norm_squared();
            if (0.0..=1.0).contains(&share) {
                work.evaluations += 1;
                return Point::corrected(&polish(system, corrected, &plane), &chord);
            }
        }
        let middle = near(system, &from, &to, x, settings, work)?;
        if (miss(&middle) > 0.0) == (a > 0.0) {
            from = middle;
        } else {
            to = middle;
        }
    }
    None
}

/// The point of the curve on the plane across the chord at share `x`.
pub fn between<const N: usize>(
    system: &dyn System<N>,
    from: &Point<N>,
    to: &Point<N>,
    x: f64,
    settings: &Settings,
    work: &mut Work,
) -> Option<Point<N>> {
    let guess = hermite(from, to, x);
    let chord = to.y - from.y;
    let plane = Constraint::Plane { row: chord, value: chord.dot(&guess) };
    let corrected = correct(system, guess, &plane, settings).ok()?;
    work.evaluations += corrected.rounds + 1;
    Point::corrected(&corrected, &chord)
}

/// A point of the curve inside the piece, at share `x` if it can be had, nearer to an end otherwise.
///
/// The interpolation is best near the ends. Under weak adhesion its error in the middle of a long piece can exceed
/// the whole adhesion term, and the equations are not defined there.
fn near<const N: usize>(
    system: &dyn System<N>,
    from: &Point<N>,
    to: &Point<N>,
    x: f64,
    settings: &Settings,
    work: &mut Work,
) -> Option<Point<N>> {
    [1.0, 0.5, 0.2, 0.05, 0.01]
        .into_iter()
        .flat_map(|share| [x * share, 1.0 - (1.0 - x) * share])
        .find_map(|x| between(system, from, to, x, settings, work))
}

/// Where the cubic of the slope of `row` between two points vanishes, as a share of the piece.
fn root_of_slope<const N: usize>(from: &Point<N>, to: &Point<N>, row: &Vector<N>) -> f64 {
    let length = (to.y - from.y).norm();
    let (f0, f1) = (from.slope(row), to.slope(row));
    let (d0, d1) = (length * row.dot(&from.frame.curvature), length * row.dot(&to.frame.curvature));
    let a = 2.0 * (f0 - f1) + d0 + d1;
    let b = 3.0 * (f1 - f0) - 2.0 * d0 - d1;
    let (mut lo, mut hi) = (0.0, 1.0);
    // Halving cannot leave the bracket; a millionth of the piece is far below what the cubic is off.
    for _ in 0..20 {
        let x = 0.5 * (lo + hi);
        let value = ((a * x + b) * x + d0) * x + f0;
        if (value > 0.0) == (f0 > 0.0) { lo = x } else { hi = x }
    }
    0.5 * (lo + hi)
}

/// Newton on (g, ψ) from the Hermite point at share `x`, guarded by the bracket.
fn newton<const N: usize>(
    system: &dyn System<N>,
    from: &Point<N>,
    to: &Point<N>,
    x: f64,
    row: &Vector<N>,
    settings: &Settings,
    work: &mut Work,
) -> Option<(Vector<N>, Linearization<N>, f64)> {
    let chord = to.y - from.y;
    let length = chord.norm();
    let mut y = hermite(from, to, x);
    let mut along = (from.frame.tangent * (1.0 - x) + to.frame.tangent * x).normalize();
    let mut last = f64::INFINITY;
    for _ in 0..settings.rounds {
        let lin = system.linearize(&y).filter(Linearization::is_finite)?;
        work.evaluations += 1;
        let closed = Closed::new(&lin.jacobian, &along)?;
        let v = closed.null_vector();
        let gradient = -lin.contracted(&closed.solve_transposed(row), &v);
        let mut right = -lin.residual;
        right[N - 1] = -row.dot(&v);
        let correction = Closed::new(&lin.jacobian, &gradient)?.solve(&right);
        let moved = correction.norm();
        if moved.is_nan() || moved > length {
            return None;
        }
        y += correction;
        let share = (y - from.y).dot(&chord) / (length * length);
        if !(0.0..=1.0).contains(&share) {
            return None;
        }
        // Converged when a correction no longer matters, or stopped shrinking at the rounding level.
        let small = settings.tolerance.sqrt() * 1e-3;
        if moved <= 1e-14
            || (moved <= small && moved >= 0.1 * last)
            || (moved * moved <= 1e-16 && moved < small)
        {
            let lin = system.linearize(&y).filter(Linearization::is_finite)?;
            return (lin.relative_residual() <= settings.tolerance).then_some((y, lin, moved));
        }
        last = moved;
        along = v.normalize();
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::continuation::examples::Cubic;

    #[test]
    fn the_folds_of_the_cubic_to_rounding() {
        let row = Vector::from([0.0, 1.0]);
        for (a, b, u, p) in [(-1.4, -0.7, -1.0, 2.0), (0.5, 1.9, 1.0, -2.0), (0.999_999, 1.9, 1.0, -2.0)] {
            let bracket = Bracket { index: 0, from: Cubic.point(a), to: Cubic.point(b) };
            let mut work = Work::default();
            let found = limit_point(&Cubic, &bracket, &row, &Settings::new(2), &mut work).unwrap();
            assert!((found.point.y[0] - u).abs() < 1e-13, "{}", found.point.y[0] - u);
            assert!((found.point.y[1] - p).abs() < 1e-13);
            assert_eq!(found.bend > 0.0, p < 0.0);
            assert!(work.evaluations <= 20, "{work:?}");
        }
    }

    #[test]
    fn a_control_value_inside_its_bracket() {
        let row = Vector::from([0.0, 1.0]);
        let (from, to) = (Cubic.point(1.2), Cubic.point(2.5));
        let found =
            control_value(&Cubic, &from, &to, &row, 3.0, &Settings::new(2), &mut Work::default()).unwrap();
        assert!((Cubic::p(found.y[0]) - 3.0).abs() < 1e-9);
    }
}
