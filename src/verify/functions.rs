//! Fig. 9 at its largest contact by the number n of eigenfunctions: error beyond any order once they resolve the waves.
//!
//! Force and approach are sums over n + 16 nodes and converge first; the energy needs the coefficients themselves, the
//! more of them the larger 2πs/λ = 63 is. Exact: P. R. Guduru, doi:10.1016/j.jmps.2006.09.004.

use super::cases::fig_9;
use super::row::{Group, Row};
use crate::ritz::{Basis, BasisError, Spectral};
use crate::theory::Exact;

/// n, and the bounds of force and energy. Below 40 functions the waves are not resolved, and the energy is not told: a bound
/// of some percent would pass for agreement.
const NUMBERS: [(usize, f64, Option<f64>); 6] = [
    (16, 1e-5, None),
    (24, 1e-10, None),
    (32, 1e-12, None),
    (40, 1e-12, Some(2e-9)),
    (48, 1e-12, Some(1e-12)),
    (64, 1e-12, Some(1e-12)),
];

/// P and U at the start of Fig. 9.
///
/// # Errors
/// [`BasisError`] when a basis cannot be made.
pub fn group() -> Result<Group, BasisError> {
    let figure = fig_9();
    let s = figure.start;
    let exact = Exact::of(&figure.problem);
    let (force, energy) = (exact.force(s), exact.energy(s));
    let problem = figure.problem.reduced();
    let mut rows = Vec::new();
    for (n, of_force, of_energy) in NUMBERS {
        let basis = Spectral::new(n)?;
        let ours = basis.equilibrium(&problem, s).map(|e| (e.force, basis.energy(&problem, s, e.approach)));
        let (our_force, our_energy) = ours.unwrap_or((f64::NAN, f64::NAN));
        rows.push(Row::relative(format!("force, n = {n}"), our_force, force, of_force));
        rows.extend(
            of_energy.map(|bound| Row::relative(format!("energy, n = {n}"), our_energy, energy, bound)),
        );
    }
    let title = "Fig. 9 at s = 0.5 R by the number of eigenfunctions".to_owned();
    Ok(Group { title, measure: "relative", rows })
}
