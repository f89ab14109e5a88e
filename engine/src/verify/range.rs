//! Adhesion with a range on the smooth sphere, against the closed forms of Maugis, which share no code with it.
//!
//! D. Maugis, J. Colloid Interface Sci. 150, 243 (1992), doi:10.1016/0021-9797(92)90285-T.

use super::cases::sphere;
use super::row::{Group, VerifyRow};
use crate::disc::Table;
use crate::problem::{Cohesion, Control, Turn};
use crate::progress::Unwatched;
use crate::quasistatic::path::{PathSetting, cycle_in_zone};
use crate::theory::maugis::Maugis;
use crate::zone::Equilibria;
use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::Arc;

/// `λ_M` from a long range to a short one.
const PARAMETERS: [f64; 9] = [0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0];

/// γ/(E*R).
const WORK: f64 = 0.01;

/// Angles at which states are compared.
const ANGLES: u32 = 12;

/// States whose zones reach out to at most this many R are compared.
const FARTHEST: f64 = 4.0;

/// The bound for a state, and for the largest pull, which a path finds on its panels.
const BOUND: f64 = 1e-10;

/// States of one zone, and the largest pull of a whole loop under a dead load.
pub fn group() -> Group {
    let problem = sphere(WORK).reduced();
    let rows = Table::new(Arc::clone(&problem.gap), 0.5, &Unwatched).map_or_else(
        |_| vec![VerifyRow::relative("the table", f64::NAN, 1.0, BOUND)],
        |table| {
            let table = Arc::new(table);
            PARAMETERS.into_iter().flat_map(|parameter| of(&table, parameter)).collect()
        },
    );
    Group { title: "Adhesion with a range: a sphere against Maugis".to_owned(), measure: "relative", rows }
}

fn of(table: &Arc<Table>, parameter: f64) -> [VerifyRow; 2] {
    let exact = Maugis::of(parameter, WORK);
    let law = Cohesion { strength: exact.strength, range: WORK / exact.strength };
    let angles = (1..ANGLES).map(|k| FRAC_PI_2 * f64::from(k) / f64::from(ANGLES));
    // Farther out a force is the difference of much larger ones.
    let angles = angles.filter(|angle| exact.edge(*angle) <= FARTHEST);
    let furthest = angles.clone().map(|angle| exact.edge(angle)).fold(0.0, f64::max);
    let found = Equilibria::new(table, law, furthest, &Unwatched).ok();
    let forces = angles.filter_map(|angle| {
        let c = exact.edge(angle);
        let state = found.as_ref()?.zone.state(c, None)?;
        Some((state.force, exact.state(angle)[2]))
    });
    let force = VerifyRow::worst(format!("lambda_M {parameter}: worst force"), forces, PI * WORK, BOUND);
    let path = cycle_in_zone(table, law, Turn::Force(WORK), &PathSetting::new(Control::Force), &Unwatched);
    let pull = path.ok().and_then(|path| Some(-path.largest_pull()?.force / (PI * WORK)));
    let pull = pull.unwrap_or(f64::NAN);
    [
        force,
        VerifyRow::relative(
            format!("lambda_M {parameter}: P/(pi gamma R)"),
            pull,
            exact.largest_pull(),
            BOUND,
        ),
    ]
}
