//! The law of stability on the waves of Fig. 9 against Guduru's closed form (doi:10.1016/j.jmps.2006.09.004). At the
//! limit points of the closed form the law must give the work of adhesion of the problem, and under force a ninth of
//! the value under displacement; its cusps are the extrema of √s g' there.

use super::cases::PaperFigure;
use super::row::{Group, VerifyRow};
use crate::disc::{Table, TableError};
use crate::problem::Control;
use crate::progress::Unwatched;
use crate::root;
use crate::stability::Law;
use crate::stability::law::adhesion_of;
use crate::theory::Exact;
use crate::theory::unloading::{INWARD_REACH, limit_points};
use std::f64::consts::{FRAC_PI_2, TAU};

/// Rounding of the table and of the closed form.
const BOUND: f64 = 1e-10;

/// How many of the innermost cusps are compared.
const CUSPS: usize = 4;

/// The law on the waves of `figure`.
///
/// # Errors
/// The gap cannot be tabulated.
pub fn group(figure: &PaperFigure) -> Result<Group, TableError> {
    let problem = figure.problem.reduced();
    let panels = Table::new(problem.gap.clone(), figure.start, &Unwatched)?.up_to(figure.start)?;
    let law = |control| Law { panels: panels.clone(), control };
    let exact = Exact::of(&figure.problem);
    let gamma = figure.problem.work_of_adhesion;
    let points = |control| {
        let found = limit_points(&*exact, control, figure.start, INWARD_REACH * figure.start);
        found.into_iter().map(|limit| limit.state.contact_radius).collect::<Vec<f64>>()
    };
    let mut rows: Vec<VerifyRow> = figure
        .controls()
        .into_iter()
        .map(|control| {
            let law = law(control);
            let radii = points(control);
            let what = format!("{control}: {} limit points, worst", radii.len());
            let pairs = radii.iter().map(|s| (law.critical(*s).unwrap_or(f64::NAN), gamma));
            VerifyRow::worst(what, pairs, gamma, BOUND)
        })
        .collect();
    let grips = law(Control::Displacement);
    let ninth =
        points(Control::Force).into_iter().map(|s| (grips.critical(s).unwrap_or(f64::NAN), 9.0 * gamma));
    rows.push(VerifyRow::worst("nine times that under displacement", ninth, gamma, 9.0 * BOUND));
    let (cusps, _) = grips.cusps([0.0, figure.start]);
    let wave = exact.wave().unwrap_or(figure.start);
    for (number, cusp) in cusps.iter().take(CUSPS).enumerate() {
        let law = |s: f64| s.sqrt() * exact.transform(s).slope;
        let s = cusp.contact_radius;
        let highest = root::least(s - 0.1 * wave, s + 0.1 * wave, |s| -law(s));
        let adhesion = TAU * law(highest).powi(2) / FRAC_PI_2;
        let name = format!("cusp {}", number + 1);
        rows.push(VerifyRow::relative(
            format!("gamma' of {name}"),
            TAU * adhesion_of(cusp.value),
            adhesion,
            BOUND,
        ));
        // F is flat at its top, so half the digits are lost.
        rows.push(VerifyRow::relative(format!("contact radius of {name}"), s, highest, 1e-6));
    }
    let title = format!("{}, the law of stability, exact", figure.name);
    Ok(Group { title, measure: "relative", rows })
}
