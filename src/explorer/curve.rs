//! The background curve: everything the screen shows of a preset, computed whole.

use super::history::Setting;
use crate::case::{Case, CaseError};
use crate::contact::{Control, Groups};
use crate::preset::Preset;
use crate::quasistatic::{Curve, Limit, Unloading};
use crate::report::UnloadReport;
use std::sync::Arc;

/// One point of the curve in the user's units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CurvePoint {
    /// δ.
    pub approach: f64,
    /// P.
    pub force: f64,
    /// s.
    pub contact_radius: f64,
    /// Stable under the chosen control.
    pub stable: bool,
}

/// What the screen shows of a preset.
#[derive(Debug, Clone)]
pub struct CurveData {
    /// The problem, shared with the nodes walked on it.
    pub setting: Arc<Setting>,
    /// The curve between start and end, reduced.
    pub curve: Curve,
    /// The curve in the user's units.
    pub points: Vec<CurvePoint>,
    /// The limit points under the chosen control, reduced, from the start inward.
    pub limits: Vec<Limit>,
    /// The limit points of the other controls in the user's units, with their control.
    pub other_limits: Vec<(Control, CurvePoint)>,
    /// The quasi-static path, reduced, or why there is none.
    pub unloading: Result<Unloading, String>,
    /// The same as a document.
    pub report: Option<UnloadReport>,
    /// The smooth sphere over the same radii: (δ, P, s); empty without adhesion or waves to differ from.
    pub smooth: Vec<CurvePoint>,
    /// The dimensionless groups.
    pub groups: Groups,
    /// Decimal digits the basis can be trusted for at the start.
    pub digits: f64,
    /// `P_c`; 0 without adhesion.
    pub critical_force: f64,
    /// What to be careful about.
    pub warnings: Vec<String>,
}

/// Points of the reference curve of the smooth sphere.
const SMOOTH_POINTS: u32 = 200;

impl CurveData {
    /// Computes `preset`; `go_on` is asked between points.
    ///
    /// # Errors
    /// [`CaseError`], [`CaseError::Cancelled`] among them.
    pub fn compute(preset: &Preset, go_on: impl FnMut() -> bool) -> Result<Self, CaseError> {
        let case = Case::new(preset)?;
        let curve = case.sweep(go_on)?;
        let units = *case.units();
        let shown = |point: &crate::continuation::Point, control: Control| {
            let [delta, force, s] = curve.equilibrium.quantities(&point.y);
            CurvePoint {
                approach: delta * units.length,
                force: force * units.force,
                contact_radius: s * units.length,
                stable: curve.equilibrium.stability(point).under(control),
            }
        };
        let points = curve.branch.points.iter().map(|p| shown(p, case.control)).collect();
        let limits = curve.limit_points(case.control);
        let other_limits = [Control::Displacement, Control::Force]
            .into_iter()
            .filter(|control| *control != case.control)
            .flat_map(|control| curve.limit_points(control))
            .map(|limit| (limit.control, shown(&limit.point, limit.control)))
            .collect();
        // The unloading may extend its curve to find a landing; the one on the screen ends where asked.
        let mut path = curve.clone();
        let unloading = case.unload(&mut path, case.control).map_err(|e| e.to_string());
        let report = unloading.as_ref().ok().map(|u| UnloadReport::new(preset, &case, u));
        let smooth = smooth(&case);
        let warnings = case.warnings(curve.outermost());
        let setting =
            Arc::new(Setting { preset: preset.clone(), equilibrium: curve.equilibrium.clone(), case });
        let case = &setting.case;
        Ok(Self {
            digits: case.basis.trusted_digits(&case.reduced, case.start),
            groups: Groups::of(&case.problem),
            critical_force: case.smooth().pull_off_force(),
            setting: Arc::clone(&setting),
            curve,
            points,
            limits,
            other_limits,
            unloading,
            report,
            smooth,
            warnings,
        })
    }
}

/// The smooth sphere of the same curvature and adhesion over the radii of `case`.
fn smooth(case: &Case) -> Vec<CurvePoint> {
    let jkr = case.smooth();
    let units = case.units();
    let (from, to) = (case.start * units.length, case.end * units.length);
    (0..=SMOOTH_POINTS)
        .map(|i| {
            // Even in √s: the curve behaves like √s towards the axis.
            let x = f64::from(i) / f64::from(SMOOTH_POINTS);
            let s = (from.sqrt() + (to.sqrt() - from.sqrt()) * x).powi(2);
            CurvePoint {
                approach: jkr.approach(s),
                force: jkr.force(s),
                contact_radius: s,
                stable: s >= jkr.fixed_grips_radius(),
            }
        })
        .collect()
}
