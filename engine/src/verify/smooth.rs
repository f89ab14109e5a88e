//! Hertz and JKR in the exact basis.
//!
//! At a given contact radius, so that only the basis is compared:
//!
//! ```text
//! δ = s²/R − √(2πγs/E*),   P = 4E*s³/(3R) − √(8πγE*s³),   U = E*∫₀^s (δ − a²/R)² da − πγs²
//! ```
//!
//! Eqs. (21), (22) of the paper with their misprints corrected; H. Hertz, doi:10.1515/crll.1882.92.156; K. L. Johnson,
//! K. Kendall and A. D. Roberts, doi:10.1098/rspa.1971.0141.

use super::cases::{smooth, sphere};
use super::row::{Group, VerifyRow};
use super::settings::{VerifyError, exact as exact_basis};

use crate::theory::Disc;

/// s/R of the comparison.
const RADIUS: f64 = 0.3;

/// γ/(E*R) without adhesion and with it.
const WORKS: [(&str, f64); 2] = [("Hertz", 0.0), ("JKR", 0.01)];

/// Rounding, with a margin for the sums.
const BOUND: f64 = 1e-12;

/// δ, P and U of the smooth sphere without adhesion and with it.
///
/// # Errors
/// [`VerifyError`] if the basis cannot be made.
pub fn group() -> Result<Group, VerifyError> {
    let mut rows = Vec::new();
    for (theory, gamma) in WORKS {
        let (problem, exact) = (sphere(gamma), smooth(gamma).curve(&[RADIUS]));
        let basis = exact_basis(&problem, RADIUS)?;
        let problem = problem.reduced();
        let ours = basis.equilibrium(&problem, RADIUS);
        let energy = ours.map(|e| e.energy);
        for exact in exact {
            for (quantity, ours, exact) in [
                ("approach", ours.map(|e| e.approach), exact.approach),
                ("force", ours.map(|e| e.force), exact.force),
                ("energy", energy, exact.energy),
            ] {
                let what = format!("{theory}: {quantity}");
                rows.push(VerifyRow::relative(what, ours.unwrap_or(f64::NAN), exact, BOUND));
            }
        }
    }
    let title = "Smooth sphere at s = 0.3 R, exact basis".to_owned();
    Ok(Group { title, measure: "relative", rows })
}
