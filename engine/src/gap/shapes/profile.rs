//! A measured profile: a smooth even curve through its rows, or near them.
//!
//! Radii and gaps are lengths in one unit, the radii from the axis. With κ and c from the weighted least squares of
//! h ≈ c + κr²/2 over all rows,
//!
//! ```text
//! h(r) = κr²/2 + f(r) − f(0)
//! ```
//!
//! f is the even spline of the module [`spline`](super::spline) through what the paraboloid leaves. Smoothing therefore
//! does not flatten the body, and a measured paraboloid remains one up to its last row. h and two derivatives are
//! continuous, h'(0) = 0, and h''' jumps at the knots: where limit points are located with h''', bracketing takes over.
//!
//! Every row is a knot as long as there are at most [`MOST_KNOTS`]. If there are more, what the paraboloid leaves is
//! averaged in cells of equal width from the axis to the last row, and a knot lies in the middle of each. The mean is
//! taken over the straight lines between the rows, so that it does not matter how many rows fall in a cell. Rows are
//! also averaged where the cutoff is long compared with their spacing, since the equations of the spline lose a digit
//! for each factor of 1.8 in that ratio; cells of an eighth of the cutoff are then fine enough. The mean over a cell
//! passes a wave of
//!
//! | cells | 1.66 | 4 | 8 |
//! |---|---|---|---|
//! | the share | 0.5 | 0.90 | 0.974 |
//!
//! Rows that do not begin at 0 are continued to the axis by the even parabola that the spline has there; h(0) = 0 then
//! holds by subtraction, whatever height the rows were measured from. From the middle of the last cell to the last row
//! f is straight, as the smoothest curve is. Beyond the last row nothing is known and nothing is extrapolated:
//! [`Gap::largest_radius`](crate::gap::Gap::largest_radius) gives that radius, and jets beyond it are NaN.
//!
//! The reference length is R = 1/κ, or the largest radius where κ is not positive. The feature length is the mean
//! distance between the crests of f if f were a random profile, 2π √(∫f'²/∫f''²) (λ itself for a single wave). There is
//! none where f is only rounding, or where that length exceeds the width of the profile. M. S. Longuet-Higgins, Phil.
//! Trans. R. Soc. A 249, 321 (1957), doi:10.1098/rsta.1957.0002.
//!
//! | file | what lives there |
//! |---|---|
//! | `invalid` | what rows must satisfy, and why rows are no profile |
//! | `curve` | the curve as a gap |
//! | `body` | rows turned into a curve |

mod body;
mod curve;
mod invalid;
#[cfg(test)]
mod tests;

use body::Body;
pub use curve::ProfileGap;
use invalid::check;
pub use invalid::{CLOSEST, Cells, FEWEST_ROWS, InvalidProfile, MOST_KNOTS};

/// How closely the curve follows the rows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Smoothing {
    /// Through every row, or through the mean of every cell.
    None,
    /// Waves of this length, in the unit of the radii, pass by half; shorter ones less, longer ones more.
    Cutoff(f64),
    /// The cutoff that generalized cross-validation finds: noise that varies at random from row to row is removed.
    Auto,
}

impl ProfileGap {
    /// The profile of `gaps` at `radii ≥ 0`, ascending, both in one unit of length.
    ///
    /// # Errors
    /// [`InvalidProfile`], naming the row or the number.
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

    /// The same in half as many cells, to see whether the cells are fine enough; `radii` and `gaps` are those it was
    /// made from. None where the rows are knots themselves, or where fewer cells are not possible.
    pub fn coarser(&self, radii: &[f64], gaps: &[f64]) -> Option<Self> {
        let half = Some(self.cells?.count / 2).filter(|half| *half >= FEWEST_ROWS)?;
        let body = Body::new(radii, gaps);
        let points = body.cells(half).ok()?;
        body.curve(&points, self.cutoff.map(|cutoff| cutoff / body.length)).ok()
    }
}
