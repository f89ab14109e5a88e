//! The inside of the walker's state, computed by a worker: pressure, gap and potential, for the views that show them.

use super::background::{Background, Tell, Want, Watcher};
use super::curve::CurveData;
use super::model::Model;
use super::view::View;
use pulloff_engine::annuli::Contacts;
use pulloff_engine::problem::{Control, Units};
use pulloff_engine::quasistatic::admissible::Judge;
use pulloff_engine::quasistatic::jump::EdgeDirection;
use pulloff_engine::quasistatic::{Landscape, Profile, State};
use pulloff_engine::theory::Exact;
use pulloff_engine::zone::ZoneAt;
use std::f64::consts::FRAC_PI_2;
use std::sync::Arc;

/// Number of points of the exact pressure.
const EXACT_POINTS: u32 = 200;
/// How many waves the landscape extends inward and outward of the edge: the neighbouring states and what lies between.
const WAVES: [f64; 2] = [2.2, 1.2];
/// Without waves, these shares of the radius.
const SHARES: [f64; 2] = [0.95, 0.6];

/// What is wanted of a state.
#[derive(Debug, Clone)]
pub struct Ask {
    /// The curve of the problem that the state solves, with the control whose potential is wanted.
    pub curve: Arc<CurveData>,
    pub state: State,
    /// Its contacts, reduced, if there is more than a disc.
    pub rings: Option<Contacts>,
    /// The outer edge of its zone (reduced), if adhesion has a range.
    pub zone: Option<f64>,
    /// Whether the exact pressure is wanted as well.
    pub exact: bool,
    /// The direction in which the barrier is wanted; `None` at a limit point, where no barrier holds the edge.
    pub barrier: Option<EdgeDirection>,
}

impl Ask {
    /// Whether both requests have the same answer.
    pub fn is_like(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.curve.setting, &other.curve.setting)
            && (self.state, self.exact, self.barrier) == (other.state, other.exact, other.barrier)
            && (&self.rings, self.zone) == (&other.rings, other.zone)
    }

    fn control(&self) -> Control {
        self.curve.case.control
    }
}

/// The inside of one state, reduced.
#[derive(Debug, Clone)]
pub struct StateInside {
    /// Factors to the user's units.
    pub units: Units,
    /// λ, if the gap has a single wave.
    pub wave: Option<f64>,
    /// Pressure and gap across the radius.
    pub profile: Profile,
    /// The exact (r, p), if requested.
    pub exact: Vec<(f64, f64)>,
    /// The potential over the contact radius; `None` off the curve.
    pub landscape: Option<Landscape>,
    /// The energy barrier in the walking direction.
    pub barrier: Option<f64>,
}

impl StateInside {
    /// Computes what `ask` wants.
    pub fn of(ask: &Ask) -> Self {
        let case = &ask.curve.case;
        let State { contact_radius: s, approach, .. } = ask.state;
        // A landscape applies to one disc under one law.
        let is_alone = ask.rings.is_none() && ask.curve.along.is_none();
        let landscape = if is_alone { landscape(ask) } else { None };
        let rings = ask.rings.as_ref();
        let rings =
            rings.and_then(|contacts| Profile::of_contacts(&case.reduced, &case.table, contacts, approach));
        let judge = Judge::new(&case.reduced, &case.table);
        let zone = case.cohesion.zip(ask.zone).and_then(|(cohesion, edge)| {
            Profile::of_zone(
                &case.reduced,
                &case.table,
                cohesion,
                ZoneAt { edge, contact_radius: s, approach },
            )
        });
        Self {
            units: *case.units(),
            wave: case.reduced.gap.wavelength(),
            profile: rings
                .or(zone)
                .unwrap_or_else(|| Profile::of(&case.reduced, case.basis.as_ref(), &judge, s, approach)),
            exact: if ask.exact && is_alone { exact_pressure(ask) } else { Vec::new() },
            barrier: landscape.as_ref().zip(ask.barrier).and_then(|(landscape, run)| landscape.barrier(run)),
            landscape,
        }
    }
}

impl Background for StateInside {
    type Key = Ask;
    const NAME: &'static str = "profile";

    /// For the walker's state, if a view shows it. The answer to an older question is accepted too: a run shows the
    /// states it passes.
    fn wanted(model: &Model) -> Want<Ask> {
        let is_shown = model.shown_views().into_iter().any(View::is_state);
        let node = model.walker().filter(|node| is_shown && !node.is_apart());
        let (Some(node), Some(curve)) = (node, &model.curve) else { return Want::Not };
        let run = if model.inward { EdgeDirection::Inward } else { EdgeDirection::Outward };
        Want::Now(Ask {
            curve: Arc::clone(curve),
            state: node.state,
            rings: node.has_rings().then(|| node.contacts()),
            zone: node.on_path.and_then(|at| curve.zone(at)),
            exact: model.overlays.exact,
            barrier: (!node.is_limit(curve.case.control)).then_some(run),
        })
    }

    fn is_same(asked: &Ask, wanted: &Ask) -> bool {
        asked.is_like(wanted)
    }

    fn compute(ask: &Ask, _: Watcher<'_>, _: Tell<'_, Self>) -> Option<Self> {
        Some(Self::of(ask))
    }

    /// It is short and cannot be given up.
    fn says(model: &Model) -> Option<String> {
        model.results.under_way::<Self>().map(|_| "computing the state".to_owned())
    }
}

impl Model {
    /// The inside of the walker's state, or of the previous one while the new one is computed.
    pub fn shown_profile(&self) -> Option<&StateInside> {
        self.results.shown()
    }
}

fn landscape(ask: &Ask) -> Option<Landscape> {
    let (curve, control, s) = (&ask.curve.base.curve, ask.control(), ask.state.contact_radius);
    let wave = ask.curve.case.reduced.gap.feature_length();
    let [inward, outward] = wave
        .map_or(SHARES.map(|share| share * s), |wave| WAVES.map(|waves| (waves * wave).min(SHARES[0] * s)));
    let value = control.value(ask.state.approach, ask.state.force);
    Landscape::of(curve, control, value, s, [s - inward, s + outward])
}

/// The exact (r, p) in the problem's own units, made reduced; the points are denser towards the edge.
fn exact_pressure(ask: &Ask) -> Vec<(f64, f64)> {
    let case = &ask.curve.case;
    let (exact, units) = (Exact::of(&case.problem), case.units());
    let s = ask.state.contact_radius;
    // r = s sin θ, the last point just inside the edge.
    let radii: Vec<f64> =
        (0..EXACT_POINTS).map(|i| s * (FRAC_PI_2 * f64::from(i) / f64::from(EXACT_POINTS)).sin()).collect();
    let shown: Vec<f64> = radii.iter().map(|r| r * units.length).collect();
    let pressures = exact.pressures(s * units.length, &shown);
    radii.into_iter().zip(pressures.iter().map(|p| p / units.pressure)).collect()
}
