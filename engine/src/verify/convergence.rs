//! Hertz and JKR in rings at a given approach: the errors in contact radius and force, and their observed order.
//!
//! ```text
//!                uniform rings                        rings crowded towards the edge
//! JKR     s  0.16/N    P  1.4/N     order 1, 1      s  0.34/N²   P  9.4/N²    order 2, 2
//! Hertz   s  0.5/N     P  0.24/N²   order 1, 2      s  0.37/N    P  0.31/N²   order 1, 2
//! ```
//!
//! The order between N and 2N is log₂ of the ratio of their errors. Eqs. (21), (22) of the paper with their misprints
//! corrected; H. Hertz, doi:10.1515/crll.1882.92.156; K. L. Johnson, K. Kendall and A. D. Roberts,
//! doi:10.1098/rspa.1971.0141.

use super::cases::{smooth, sphere};
use super::row::{Group, VerifyRow};
use super::settings::{VerifyError, VerifySettings};
use crate::disc::Basis;
use crate::elementary::{ln, pow};
use crate::problem::Control;
use crate::progress::Unwatched;
use crate::ritz::{Grading, NewtonSettings, Rings, solve};
use crate::root;
use crate::theory::jkr::Jkr;

/// δ/R of the comparison.
const APPROACH: f64 = 0.1;

/// How an error falls with N: at most `constant`/N^`order`, with the observed order within `spread` of `order`.
#[derive(Debug, Clone, Copy)]
struct ConvergenceLaw {
    constant: f64,
    order: f64,
    spread: f64,
}

/// A sphere in rings of one kind.
#[derive(Debug, Clone, Copy)]
struct Study {
    title: &'static str,
    /// γ/(E*R).
    work_of_adhesion: f64,
    grading: Grading,
    radius: ConvergenceLaw,
    force: ConvergenceLaw,
}

const STUDIES: [Study; 4] = [
    Study {
        title: "Hertz at approach 0.1 R, uniform rings",
        work_of_adhesion: 0.0,
        grading: Grading::Uniform,
        radius: ConvergenceLaw { constant: 0.6, order: 1.0, spread: 0.1 },
        force: ConvergenceLaw { constant: 0.3, order: 2.0, spread: 0.2 },
    },
    Study {
        title: "JKR at approach 0.1 R, uniform rings",
        work_of_adhesion: 0.01,
        grading: Grading::Uniform,
        radius: ConvergenceLaw { constant: 0.2, order: 1.0, spread: 0.1 },
        force: ConvergenceLaw { constant: 1.7, order: 1.0, spread: 0.1 },
    },
    Study {
        title: "Hertz at approach 0.1 R, rings crowded towards the edge",
        work_of_adhesion: 0.0,
        grading: Grading::Edge,
        radius: ConvergenceLaw { constant: 0.45, order: 1.0, spread: 0.1 },
        force: ConvergenceLaw { constant: 0.4, order: 2.0, spread: 0.2 },
    },
    Study {
        title: "JKR at approach 0.1 R, rings crowded towards the edge",
        work_of_adhesion: 0.01,
        grading: Grading::Edge,
        radius: ConvergenceLaw { constant: 0.4, order: 2.0, spread: 0.1 },
        force: ConvergenceLaw { constant: 11.0, order: 2.0, spread: 0.1 },
    },
];

/// The contact radius of the smooth sphere at the approach `delta`, on its stable branch.
pub fn radius_at(exact: &Jkr, delta: f64) -> f64 {
    // Far beyond any approach used here.
    let far = 10.0 * exact.radius_of_curvature;
    root::sign_change(exact.fixed_grips_radius(), far, |s| exact.approach(s) - delta)
}

/// Both spheres on every kind of mesh, starting from a quarter of the rings in `settings`.
///
/// # Errors
/// [`VerifyError`] if a basis cannot be made.
pub fn groups(settings: &VerifySettings) -> Result<Vec<Group>, VerifyError> {
    STUDIES.iter().map(|study| group(study, settings.rings)).collect()
}

fn group(study: &Study, finest: usize) -> Result<Group, VerifyError> {
    let exact = smooth(study.work_of_adhesion);
    let radius = radius_at(&exact, APPROACH);
    let force = exact.force(radius);
    let problem = sphere(study.work_of_adhesion).reduced();
    let mut states = Vec::new();
    for rings in [finest / 4, finest / 2, finest] {
        let basis = Rings::shared_with(rings, study.grading, &Unwatched)?;
        let control = Control::Displacement;
        let solved = solve(&*basis, &problem, control, APPROACH, 3.0 * radius, NewtonSettings::default());
        let state = solved.map(|solved| [solved.evaluation.contact_radius, solved.evaluation.force]);
        states.push((basis.size() as f64, state.unwrap_or([f64::NAN; 2])));
    }
    let mut rows = Vec::new();
    for (k, (quantity, exact, law)) in
        [("contact radius", radius, study.radius), ("force", force, study.force)].into_iter().enumerate()
    {
        for (rings, state) in &states {
            let bound = law.constant * pow(*rings, -law.order);
            rows.push(VerifyRow::relative(format!("{quantity}, N = {rings}"), state[k], exact, bound));
        }
        for pair in states.windows(2) {
            let [(coarse, before), (fine, after)] = pair else { continue };
            let ratio = ((before[k] - exact) / (after[k] - exact)).abs();
            let observed = ln(ratio) / ln(fine / coarse);
            let what = format!("{quantity}, order N = {coarse} to {fine}");
            rows.push(VerifyRow::new(what, observed, law.order, 1.0, law.spread));
        }
    }
    Ok(Group { title: study.title.to_owned(), measure: "relative, orders absolute", rows })
}
