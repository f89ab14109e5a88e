//! The rounds of Newton-Raphson from a contact radius three times too large, at a given approach on the smooth sphere.
//!
//! The paper reports 5 to 6; rows pass from 4 to 6, down to 90 % of the smallest approach. At fixed grips s =
//! `s_c/3^{2/3}` gives the exact smallest approach: K. L. Johnson, K. Kendall and A. D. Roberts,
//! doi:10.1098/rspa.1971.0141.

use super::cases::{smooth, sphere};
use super::convergence::radius_at;
use super::row::{Group, VerifyRow};
use super::settings::{VerifyError, VerifySettings, exact as exact_basis};
use crate::disc::Basis;
use crate::problem::Control;
use crate::ritz::{NewtonSettings, Rings, solve};
use std::sync::Arc;

/// γ/(E*R).
const WORK_OF_ADHESION: f64 = 0.01;

/// What the paper reports, and how far from it a row still passes.
const ROUNDS: (f64, f64) = (5.0, 1.0);

/// The rounds at several approaches, in both bases.
///
/// # Errors
/// [`VerifyError`] if a basis cannot be made.
pub fn group(settings: &VerifySettings) -> Result<Group, VerifyError> {
    let (problem, exact) = (sphere(WORK_OF_ADHESION), smooth(WORK_OF_ADHESION));
    let smallest = exact.approach(exact.fixed_grips_radius());
    let rings: Arc<dyn Basis> = Rings::shared(settings.rings)?;
    let exact_basis = exact_basis(&problem, 0.5)?;
    let problem = problem.reduced();
    let mut rows = Vec::new();
    for (name, basis) in [("exact", exact_basis), ("rings", rings)] {
        for (place, delta) in [("0.9 delta_min", 0.9 * smallest), ("0", 0.0), ("0.1 R", 0.1), ("0.5 R", 0.5)]
        {
            let from = 3.0 * radius_at(&exact, delta);
            let control = Control::Displacement;
            let solved = solve(&*basis, &problem, control, delta, from, NewtonSettings::default());
            // At most 40 rounds.
            let rounds = solved.map_or(f64::NAN, |solved| solved.rounds as f64);
            rows.push(VerifyRow::new(format!("{name}: delta = {place}"), rounds, ROUNDS.0, 1.0, ROUNDS.1));
        }
    }
    let title = "Newton-Raphson from three times the contact radius, JKR sphere".to_owned();
    Ok(Group { title, measure: "in rounds; the paper reports 5 to 6", rows })
}
