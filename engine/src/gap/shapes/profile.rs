//! A measured profile: a smooth even curve through its rows, or near them.
//!
//! Radii and gaps are lengths in one unit, the radii from the axis. With κ and c from the weighted least squares of
//! h ≈ c + κr²/2 over all rows,
//!
//! ```text
//! h(r) = κr²/2 + f(r) − f(0)
//! ```
//!
//! f is the even spline of the module [`spline`](super::spline) through what the paraboloid leaves, so that smoothing does
//! not flatten the body and a measured paraboloid stays one to its last row. h and two derivatives are continuous,
//! h'(0) = 0, and h''' jumps from knot to knot: where limit points are located with it, bracketing stands in.
//!
//! Every row is a knot as long as there are at most [`MOST_KNOTS`]. Of more, what the paraboloid leaves is averaged in cells
//! of equal width from the axis to the last row, and a knot lies in the middle of each. The mean is that of the straight
//! lines between the rows, so that it does not matter how many of them fall in a cell. So it is too where the cutoff
//! is long against the distance of the rows, since the equations of the spline lose a digit for each factor of 1.8 in their
//! ratio; cells of an eighth of the cutoff are then fine enough. The mean over a cell passes a wave of
//!
//! | cells | 1.66 | 4 | 8 |
//! |---|---|---|---|
//! | the share | 0.5 | 0.90 | 0.974 |
//!
//! Rows that do not begin at 0 are continued to the axis by the even parabola that the spline has there; h(0) = 0 then
//! holds by subtraction, whatever height the rows were measured from. From the mean of the last cell to the last row f is
//! straight, as the smoothest curve is. Beyond the last row nothing is known and nothing is extrapolated:
//! [`Gap::largest_radius`](crate::gap::Gap::largest_radius) says where, and jets beyond are NaN.
//!
//! The reference length is R = 1/κ, or the largest radius where κ is not positive. The feature length is the mean
//! distance of the crests of f as a random profile would have it, 2π √(∫f'²/∫f''²) (λ itself for a single wave), and
//! none where f is rounding, or bends over more than the profile is wide. M. S. Longuet-Higgins, Phil. Trans. R. Soc. A
//! 249, 321 (1957), doi:10.1098/rsta.1957.0002.
//!
//! | file | what lives there |
//! |---|---|
//! | `invalid` | what rows are held to, and why they are no profile |
//! | `curve` | the curve as a gap |
//! | `body` | rows made a curve |

mod body;
mod curve;
mod invalid;
#[cfg(test)]
mod tests;

use body::Body;
pub use curve::ProfileGap;
use invalid::check;
pub use invalid::{CLOSEST, Cells, FEWEST_ROWS, InvalidProfile, MOST_KNOTS};

/// How near the curve keeps to the rows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Smoothing {
    /// Through every row, or every mean of a cell.
    None,
    /// Waves of this length, in the unit of the radii, pass by half; shorter ones less, longer ones more.
    Cutoff(f64),
    /// The cutoff that generalized cross-validation finds: noise that differs from row to row at random goes.
    Auto,
}

impl ProfileGap {
    /// The profile of `gaps` at `radii ≥ 0`, ascending, both in one unit of length.
    ///
    /// # Errors
    /// [`InvalidProfile`] with the row or the number.
    pub fn new(radii: &[f64], gaps: &[f64], smoothing: Smoothing) -> Result<Self, InvalidProfile> {
        check(radii, gaps)?;
        let body = Body::new(radii, gaps);
        match smoothing {
            Smoothing::None if body.is_small() => body.curve(&body.rows(), None),
            Smoothing::None => body.curve(&body.cells(MOST_KNOTS)?, None),
            Smoothing::Cutoff(cutoff) => body.smoothed(cutoff / body.length, true),
            Smoothing::Auto => body.smoothed(body.found()?, false),
        }
    }

    /// The same in half as many cells, to see whether they are fine enough: `radii` and `gaps` are those it was made of.
    /// None where the rows are knots themselves, or there are no fewer cells.
    pub fn coarser(&self, radii: &[f64], gaps: &[f64]) -> Option<Self> {
        let half = Some(self.cells?.count / 2).filter(|half| *half >= FEWEST_ROWS)?;
        let body = Body::new(radii, gaps);
        let points = body.cells(half).ok()?;
        body.curve(&points, self.cutoff.map(|cutoff| cutoff / body.length)).ok()
    }
}
