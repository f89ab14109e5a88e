//! Any number of edges as a walk keeps them.
//!
//! Unknowns y = (δ/δ₀, P/P₀, e₁/s₀, e₂/s₀, …), the edges from the axis outward, with the unit tangent dy/dℓ along
//! their equilibria and its derivative. A disc alone has the unknowns of [`Equilibrium`]. The number of edges is odd
//! exactly where there is a disc.

use crate::annuli::{Around, Contacts, Ground, points};
use crate::continuation::{ColumnView, Columns, Vector};
use crate::disc::Table;
use crate::elementary::sin;
use crate::gap::wave_index;
use crate::problem::Control;
use crate::progress::Unwatched;
use crate::quasistatic::admissible::{Admissibility, Crest, Judge};
use crate::quasistatic::equilibrium::{Equilibrium, Scales};
use crate::quasistatic::path::{self, Balance, HeldEdges, PathStep};
use crate::quasistatic::{Stability, State, StatePoint, Stiffness};
use nalgebra::DVector;
use std::f64::consts::PI;

/// δ and P stand before the edges.
const BEFORE: usize = 2;

/// The distance between the two tangents from which the bend of a curve is found, in the units of its arc length.
const BESIDE: f64 = 1e-3;

/// The largest slope of the approach along the curve that remains at a located limit point.
const ROUNDING: f64 = 1e-9;

/// A pressure counts as negative below minus this share of the largest.
const PRESSED: f64 = 1e-7;

/// Whether a point has more contacts than a disc.
pub fn has_rings(point: &StatePoint) -> bool {
    point.y().len() > BEFORE + 1
}

/// The contacts of a point, lengths.
pub fn contacts(scales: &Scales, point: &StatePoint) -> Contacts {
    let y = point.y();
    let radii: Vec<f64> = y.iter().skip(BEFORE).map(|e| e * scales.contact_radius).collect();
    of_edges(&radii)
}

/// The contacts of these edges.
fn of_edges(radii: &[f64]) -> Contacts {
    let disc = if radii.len() % 2 == 1 { Contacts::of_disc(1.0) } else { Contacts::default() };
    disc.with_edges(radii)
}

/// δ and P of a point.
pub fn device(scales: &Scales, point: &StatePoint) -> [f64; 2] {
    [point.y()[0] * scales.approach, point.y()[1] * scales.force]
}

/// The change of a control that goes with a change of the unknowns.
pub(super) fn of_control(control: Control, scales: &Scales, change: &ColumnView<'_>) -> f64 {
    control.value(change[0] * scales.approach, change[1] * scales.force)
}

/// The slopes that decide the stability of a state with rings: where all eigenvalues of J at a held approach are
/// positive, a device of stiffness k holds it when dP/dδ > −k; where one is not, no device does.
pub fn stability(lowest: f64, stiffness: &Stiffness) -> Stability {
    if lowest > 0.0 {
        Stability { approach: 1.0, force: stiffness.tangent }
    } else {
        Stability { approach: -1.0, force: -1.0 }
    }
}

/// The edges of a point at its value of the control of `balance`; `None` where there is no state.
pub(super) fn held(balance: &Balance<'_>, scales: &Scales, point: &StatePoint) -> Option<HeldEdges> {
    let contacts = contacts(scales, point);
    let [delta, force] = device(scales, point);
    balance.held(&contacts, &points(balance.ground, &contacts), balance.control.value(delta, force)).ok()
}

/// A point of the equilibria where the walk left off at `point`, with the tangent on the same side.
pub(super) fn resumed(balance: &Balance<'_>, scales: &Scales, point: &StatePoint) -> Option<path::PathPoint> {
    let held = held(balance, scales, point)?;
    let (along, edges) = (point.tangent(), held.state.contacts.edges());
    let control = of_control(balance.control, scales, &along);
    balance.point_along(held, &|units| {
        DVector::from_fn(edges.len() + 1, |i, _| match edges.get(i) {
            Some(edge) => edge.sign * along[BEFORE + i] * scales.contact_radius / units.edges[i],
            None => control / units.control,
        })
    })
}

/// The point of edges in equilibrium with the tangent along which the contacts shrink; `None` where the curve is
/// singular.
pub(super) fn shrinking(balance: &Balance<'_>, held: HeldEdges) -> Option<path::PathPoint> {
    let edges = held.state.contacts.edges();
    balance.point_along(held, &|units| {
        let by_edge = |i: usize| edges.get(i).map_or(0.0, |edge| -edge.radius * units.edges[i]);
        DVector::from_fn(edges.len() + 1, |i, _| by_edge(i))
    })
}

/// How the contacts grow along the tangent of a point, every edge counted outward from its contact, in the scale of
/// radii.
pub(super) fn growth(point: &StatePoint) -> DVector<f64> {
    let along = point.tangent();
    let signs = of_edges(&point.y().as_slice()[BEFORE..]).edges();
    DVector::from_fn(signs.len(), |i, _| signs[i].sign * along[BEFORE + i])
}

/// The derivatives of the unknowns along the equilibria, scaled to unit length, and their length per unit of arc
/// length before that.
pub(super) fn direction(balance: &Balance<'_>, scales: &Scales, point: &path::PathPoint) -> (Vector, f64) {
    let [delta, force] = balance.slopes(point);
    let edges = point.contacts().edges();
    let edges = edges.iter().zip(&point.scales.edges).zip(&point.tangent);
    let edges = edges.map(|((edge, unit), along)| edge.sign * along * unit / scales.contact_radius);
    let along: Vec<f64> = [delta / scales.approach, force / scales.force].into_iter().chain(edges).collect();
    let along = Vector::from(along);
    let speed = along.norm();
    (along.map(|x| x / speed), speed)
}

/// A point of the equilibria as a walk keeps it.
pub(super) fn kept(balance: &Balance<'_>, scales: &Scales, point: &path::PathPoint) -> StatePoint {
    let edges = point.contacts().edges();
    let n = BEFORE + edges.len();
    let before = [point.held.approach / scales.approach, point.held.force / scales.force];
    let y: Vec<f64> =
        before.into_iter().chain(edges.iter().map(|edge| edge.radius / scales.contact_radius)).collect();
    let (tangent, speed) = direction(balance, scales, point);
    let step = PathStep::new(balance, point);
    let beside = [BESIDE, -BESIDE].into_iter().find_map(|h| Some((h, step.to(h, &step.line(h))?.0)));
    let bend: Vec<f64> = match beside {
        Some((h, beside)) => {
            let (there, _) = direction(balance, scales, &beside);
            there.iter().zip(&tangent).map(|(there, here)| (there - here) / (h * speed)).collect()
        }
        None => vec![0.0; n],
    };
    let columns = [y, tangent.iter().copied().collect(), bend].concat();
    let mut kept = StatePoint::of(Columns::from_vec(columns), Balance::is_positive(point));
    kept.rounds = point.rounds;
    kept
}

/// What is known about a state with rings.
#[derive(Debug)]
pub struct Judged {
    /// δ, P, U and the outermost edge.
    pub state: State,
    /// The slopes that decide the stability.
    pub stability: Stability,
    /// dP/dδ and dA/dδ.
    pub stiffness: Stiffness,
    /// Whether the bodies stay apart.
    pub admissibility: Admissibility,
    /// Decimal digits of the edges.
    pub digits: f64,
}

/// δ, P, U and the outermost edge of edges in equilibrium.
pub(super) fn state(held: &HeldEdges, gamma: f64) -> State {
    let (approach, force) = (held.approach, held.force);
    let contact_radius = held.state.contacts.outermost();
    State { contact_radius, approach, force, energy: held.state.energy(approach, gamma) }
}

/// What is known about `point`, whose edges are `held` at its approach.
pub fn judged(equilibrium: &Equilibrium, ground: &Ground, point: &StatePoint, held: &HeldEdges) -> Judged {
    let (scales, gamma) = (&equilibrium.scales, equilibrium.problem.work_of_adhesion);
    let contacts = &held.state.contacts;
    let along = point.tangent();
    let [delta, force] = [along[0] * scales.approach, along[1] * scales.force];
    let edges = contacts.edges();
    let area: f64 = edges
        .iter()
        .zip(along.iter().skip(BEFORE))
        .map(|(edge, e)| 2.0 * PI * edge.radius * edge.sign * e * scales.contact_radius)
        .sum();
    let per_approach = |slope: f64| {
        let ratio = slope / delta;
        if along[0].abs() <= ROUNDING { f64::INFINITY.copysign(ratio) } else { ratio }
    };
    let stiffness = Stiffness {
        contact: held.state.force[1],
        tangent: per_approach(force),
        area_slope: per_approach(area),
    };
    Judged {
        state: state(held, gamma),
        stability: stability(Balance::least_eigenvalue(held), &stiffness),
        stiffness,
        admissibility: admissibility(equilibrium, ground, held),
        digits: held.state.digits,
    }
}

fn admissibility(equilibrium: &Equilibrium, ground: &Ground, held: &HeldEdges) -> Admissibility {
    /// A touch that has just been located does not overlap yet: its gap may be this far below zero, in waves.
    const TOUCHES: f64 = 1e-11;
    let around = Around::new(ground, &held.state, held.approach);
    let crests = around.crests(ground.can_touch_up_to(held.approach), &Unwatched).unwrap_or_default();
    let nearest = crests.into_iter().min_by(|a, b| a.gap.total_cmp(&b.gap)).map(|crest| Crest {
        radius: crest.radius,
        gap: crest.gap,
        wave: wave_index(crest.radius, ground.gap.wavelength()),
    });
    let apart = nearest.is_none_or(|crest| crest.gap >= -TOUCHES * ground.wave);
    let least_pressure =
        if equilibrium.problem.work_of_adhesion > 0.0 { None } else { least_pressure(ground, &around, held) };
    let pulls = least_pressure.is_some_and(|(_, least, most)| least < -PRESSED * most);
    let table: &std::sync::Arc<Table> = &equilibrium.table;
    Admissibility {
        nearest,
        least_pressure: least_pressure.map(|(radius, least, _)| (radius, least)),
        holds: apart && !pulls,
        known_to: Judge::new(&equilibrium.problem, table).unknown_beyond(held.state.contacts.outermost()),
    }
}

/// The radius of the least pressure in the contacts, that pressure, and the largest one.
fn least_pressure(ground: &Ground, around: &Around<'_>, held: &HeldEdges) -> Option<(f64, f64, f64)> {
    const PER_WAVE: f64 = 16.0;
    const FEWEST: f64 = 40.0;
    let mut least: Option<(f64, f64)> = None;
    let mut most = 0.0_f64;
    for [a, b] in held.state.contacts.intervals() {
        let count = (PER_WAVE * (b - a) / ground.wave).max(FEWEST).ceil();
        for at in std::iter::successors(Some(0.5), |k| Some(k + 1.0)).take_while(|k| *k < count) {
            // Dense towards the edges; a disc has only one.
            let share = if a > 0.0 { sin(0.5 * PI * at / count).powi(2) } else { sin(0.5 * PI * at / count) };
            let radius = a + (b - a) * share;
            let p = around.pressure(radius);
            most = most.max(p.abs());
            if least.is_none_or(|(_, least)| p < least) {
                least = Some((radius, p));
            }
        }
    }
    least.map(|(radius, least)| (radius, least, most))
}
