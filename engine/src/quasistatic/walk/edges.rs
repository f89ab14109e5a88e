//! Any number of edges as a system of equations for the continuation.
//!
//! Unknowns y = (δ/δ₀, P/P₀, e₁/s₀, e₂/s₀, …), the edges from the axis outward, and the equations
//!
//! ```text
//! κ_i − √γ = 0 at every edge,        P − P(e, δ) = 0
//! ```
//!
//! A disc alone has the unknowns of [`Equilibrium`]. Whether there is a disc follows from the number of edges, which it makes odd.

use crate::annuli::{Around, Contacts, Ground, Resolution, Wanted, points};
use crate::continuation::{Linearization, System, Vector};
use crate::disc::Table;
use crate::elementary::sin;
use crate::gap::{Gap, wave_index};
use crate::problem::{ContactKind, Control};
use crate::progress::Unwatched;
use crate::quasistatic::admissible::{Admissibility, Crest, Judge};
use crate::quasistatic::equilibrium::{Equilibrium, Scales};
use crate::quasistatic::path::balance::keeps_widths;
use crate::quasistatic::path::{Balance, Held};
use crate::quasistatic::{Point, Stability, State, Stiffness};
use std::f64::consts::PI;

/// δ and P stand before the edges.
const BEFORE: usize = 2;

/// What an iterate must leave of every width.
const LEFT: f64 = 0.2;

/// A slope of the approach along the curve that a located limit point leaves.
const ROUNDING: f64 = 1e-9;

/// A pressure counts as negative below this share of the largest.
const PRESSED: f64 = 1e-7;

/// Whether a point is one of more than a disc.
pub fn has_rings(point: &Point) -> bool {
    point.y().len() > BEFORE + 1
}

/// The contacts of a point, lengths.
pub fn contacts(scales: &Scales, point: &Point) -> Contacts {
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
pub fn device(scales: &Scales, point: &Point) -> [f64; 2] {
    [point.y()[0] * scales.approach, point.y()[1] * scales.force]
}

/// The slopes that decide the stability of a state with rings: where all eigenvalues of J at a held approach are positive, a device of
/// stiffness k holds it when dP/dδ > −k; where one is not, none does.
pub fn stability(lowest: f64, stiffness: &Stiffness) -> Stability {
    if lowest > 0.0 {
        Stability { approach: 1.0, force: stiffness.tangent }
    } else {
        Stability { approach: -1.0, force: -1.0 }
    }
}

/// The equations of the edges of contacts that are near to `base`.
#[derive(Debug)]
pub struct Edges<'a> {
    /// The gap.
    pub ground: &'a Ground,
    /// γ.
    pub work_of_adhesion: f64,
    /// The units of the unknowns.
    pub scales: Scales,
    base: Contacts,
    points: Resolution,
}

impl<'a> Edges<'a> {
    /// Near `base`, whose points on the rings are held.
    pub fn near(ground: &'a Ground, equilibrium: &Equilibrium, base: Contacts) -> Self {
        let points = points(ground, &base);
        let work_of_adhesion = equilibrium.problem.work_of_adhesion;
        Self { ground, work_of_adhesion, scales: equilibrium.scales, base, points }
    }

    /// The row of a control: row · y is the controlled quantity.
    pub fn control_row(&self, control: Control) -> Vector {
        let mut row = Vector::zeros(self.unknowns());
        let Scales { approach, force, .. } = self.scales;
        match control {
            Control::Displacement => row[0] = approach,
            Control::Force => row[1] = force,
            Control::Stiffness(k) => (row[0], row[1]) = (approach, force / k),
        }
        row
    }

    /// The point of edges in equilibrium, its tangent such that the contacts shrink; `None` where the curve is singular.
    pub fn point(&self, held: &Held) -> Option<Point> {
        let Scales { approach, force, contact_radius } = self.scales;
        let edges = held.state.contacts.edges();
        let radii = edges.iter().map(|edge| edge.radius / contact_radius);
        let y = [held.approach / approach, held.force / force].into_iter().chain(radii);
        let y = Vector::from_iterator(self.unknowns(), y);
        let mut at = Linearization::new(self.unknowns());
        self.linearize(&y, &mut at)?;
        let inward = [0.0, 0.0].into_iter().chain(edges.iter().map(|edge| -edge.sign * edge.radius));
        Point::new(self, &y, &at, &Vector::from_iterator(self.unknowns(), inward))
    }

    /// The edges of a point, held at its value of `control`, with what goes with them; `None` where there is no state.
    pub fn held(&self, point: &Point, control: Control) -> Option<Held> {
        let contacts = contacts(&self.scales, point);
        let [delta, force] = device(&self.scales, point);
        let work_of_adhesion = self.work_of_adhesion;
        let balance = Balance {
            ground: self.ground,
            work_of_adhesion,
            control,
            contact: ContactKind::Rings,
            progress: &Unwatched,
            lane: None,
            pinned: None,
        };
        balance.held(&contacts, &points(self.ground, &contacts), control.value(delta, force)).ok()
    }
}

impl System for Edges<'_> {
    fn unknowns(&self) -> usize {
        BEFORE + self.base.edge_count()
    }

    fn linearize(&self, y: &Vector, at: &mut Linearization) -> Option<()> {
        let Scales { approach: d0, force: p0, contact_radius: s0 } = self.scales;
        let radii: Vec<f64> = y.iter().skip(BEFORE).map(|e| e * s0).collect();
        let contacts = self.base.with_edges(&radii);
        if !keeps_widths(&self.base, &contacts, LEFT) {
            return None;
        }
        let (delta, force) = (y[0] * d0, y[1] * p0);
        let state = self.ground.state_with(&contacts, &self.points, Wanted::Rates).ok()?;
        let jacobian = state.jacobian(delta, self.ground.slope(contacts.disc));
        let edges = contacts.edges();
        let kappa = state.intensities(delta);
        let (root, last) = (self.work_of_adhesion.sqrt(), edges.len());
        at.jacobian.fill(0.0);
        for (i, [constant, slope]) in state.intensity.iter().enumerate() {
            at.residual[i] = kappa[i] - root;
            // The parts that cancel.
            at.scale[i] = constant.abs() + (slope * delta).abs() + root;
            at.jacobian[(i, 0)] = slope * d0;
            for (j, edge) in edges.iter().enumerate() {
                at.jacobian[(i, BEFORE + j)] = jacobian[(i, j)] * edge.sign * s0;
            }
        }
        let [p, slope] = state.force;
        at.residual[last] = (force - p - slope * delta) / p0;
        at.scale[last] = (p.abs() + (slope * delta).abs() + force.abs()).max(f64::MIN_POSITIVE) / p0;
        at.jacobian[(last, 0)] = -slope * d0 / p0;
        at.jacobian[(last, 1)] = 1.0;
        for (j, edge) in edges.iter().enumerate() {
            let by_edge = 4.0 * PI * edge.radius * kappa[j] * state.intensity[j][1] * edge.sign;
            at.jacobian[(last, BEFORE + j)] = -by_edge * s0 / p0;
        }
        at.kept.clear();
        Some(())
    }
}

/// What is to be known of a state with rings.
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

/// What is to be known of `point`, whose edges are `held` at its approach.
pub fn judged(equilibrium: &Equilibrium, ground: &Ground, point: &Point, held: &Held) -> Judged {
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
        state: State {
            contact_radius: contacts.outermost(),
            approach: held.approach,
            force: held.force,
            energy: held.state.energy(held.approach, gamma),
        },
        stability: stability(Balance::least_eigenvalue(held), &stiffness),
        stiffness,
        admissibility: admissibility(equilibrium, ground, held),
        digits: held.state.digits,
    }
}

fn admissibility(equilibrium: &Equilibrium, ground: &Ground, held: &Held) -> Admissibility {
    /// A touch that has just been located is none yet, in waves.
    const TOUCHES: f64 = 1e-11;
    let around = Around::new(ground, &held.state, held.approach);
    let crests = around.crests(ground.can_touch_up_to(held.approach));
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

/// The least pressure in the contacts, its radius and the largest.
fn least_pressure(ground: &Ground, around: &Around<'_>, held: &Held) -> Option<(f64, f64, f64)> {
    const PER_WAVE: f64 = 16.0;
    const FEWEST: f64 = 40.0;
    let mut least: Option<(f64, f64)> = None;
    let mut most = 0.0_f64;
    for [a, b] in held.state.contacts.intervals() {
        let count = (PER_WAVE * (b - a) / ground.wave).max(FEWEST).ceil();
        for at in std::iter::successors(Some(0.5), |k| Some(k + 1.0)).take_while(|k| *k < count) {
            // Dense towards the edges; a disc has one.
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
