//! The path of a disc that is pulled at a rate: force over approach or contact radius, along the combined motion of
//! device and edge.
//!
//! ```text
//! q = ∫ (V/L_c dt + |ds|/s₀)     ds/dt = −v     dδ/dt = δ_s ds/dt + δ_c dc/dt     dP/dt = 2s dδ/dt + 2Kv     K = √(2πsG)
//! ```
//!
//! with `L_c` the way of the control and `δ_s`, `δ_c` the derivatives of δ at held control and at held radius. Both the
//! rest at the start, where the edge does not move, and the snaps, where the control does not, are smooth in q. Between
//! the moments of the integrator the path is a cubic. What runs along it is the largest q minus q, so that it runs
//! inward like the other paths. Reduced units.

use super::mover::Mover;
use super::reach::{Eye, Reach};
use crate::case;
use crate::disc::{Basis, ExactBasis, Table};
use crate::elementary::pow;
use crate::preset::Preset;
use crate::problem::{Control, Part, Printer, Reduced, Start};
use crate::progress::Unwatched;
use crate::rate::variation::{ADHESION, EXPONENT, MomentSlopes, RATE, START, STIFFNESS};
use crate::rate::{EdgeLaw, Moment, MovingEdge, PullSettings, Puller};
use std::f64::consts::TAU;
use std::sync::Arc;

/// The error of a step of the integrator as a share of the noise, and its smallest and largest value as a share of the
/// radius.
const OF_NOISE: f64 = 1e-3;
const TOLERANCE: [f64; 2] = [1e-8, 1e-5];
/// G of an edge that follows the device exceeds γ by at least this share: a slower pull is quasi-static to a share that no
/// points show, and rounding would make its speeds uncertain. Nor does it by more than this many times: of a faster pull no
/// points show γ, and the steps become many.
const EXCESS: [f64; 2] = [1e-8, 1e6];
/// A pull begins at most this many ranges of x beyond the points. One that begins further off has nothing to do with them,
/// and goes over thousands of waves.
const FAR: f64 = 10.0;
/// The number of states that the polynomial for a derivative goes through.
const AROUND: usize = 4;
/// Moments nearer to each other than this share of the whole way count as one.
const ONE: f64 = 1e-9;

/// One state of what the arcs of a path run along: s, δ and P, with their derivatives with respect to what runs along.
#[derive(Debug, Clone, Copy)]
pub(super) struct TrackState {
    /// The contact radius, or the edge of the zone.
    pub(super) along: f64,
    pub(super) at: [f64; 3],
    pub(super) slopes: [f64; 3],
}

/// The states of a pull, from its start to the last contact, and how each moves with the values.
#[derive(Debug, Clone)]
pub(super) struct Trail {
    states: Vec<TrackState>,
    moved: Vec<MomentSlopes>,
    held: Control,
}

/// Whether `preset` is fitted to a pull: its edge has a law, its device a rate, and the start is a contact radius.
pub(super) fn is_pulled(preset: &Preset) -> bool {
    preset.edge.rate.is_some()
        && preset.edge.has_law()
        && matches!(preset.path.start, Start::ContactRadius(_))
}

/// What pulls the disc of `preset` from the contact radius at which it starts, and its rate, in reduced units; `None` where
/// the preset has no pull, or one that is too fast.
fn puller<'a>(
    preset: &Preset,
    reduced: &Reduced,
    table: &'a Table,
    held: Control,
    tolerance: f64,
) -> Option<(Puller<'a>, f64)> {
    let units = reduced.units;
    let Start::ContactRadius(start) = preset.path.start else { return None };
    let edge = &preset.edge;
    let (rate, exponent) = (edge.rate?, edge.exponent?);
    let closing_speed =
        edge.closing_speed.zip(edge.reference_speed).map(|(closing, opening)| closing / opening);
    let [value, time] = unit_of(preset, reduced, held)?;
    let rate = rate / value * time;
    let [slowest, fastest] = EXCESS.map(|excess| pow(excess, 1.0 / exponent));
    let opening = reduced.work_of_adhesion;
    let closing = edge.closing_work_of_adhesion.map(|gamma| gamma / units.work_of_adhesion);
    let puller = Puller {
        table,
        control: held,
        edge: MovingEdge {
            law: EdgeLaw::symmetric(exponent).with_closing(closing_speed, edge.closing_exponent),
            opening,
            closing: closing.filter(|closing| *closing < opening).unwrap_or(opening),
        },
        start: (start / units.length).min(reduced.largest_contact()),
        wave: reduced.gap.feature_length(),
        rise: None,
        settings: PullSettings { tolerance, derivatives: true, ..PullSettings::default() },
    };
    (rate <= fastest).then(|| (puller, rate.max(slowest)))
}

/// The units of the control and of time; `None` where the edge has no law.
fn unit_of(preset: &Preset, reduced: &Reduced, held: Control) -> Option<[f64; 2]> {
    let units = reduced.units;
    let value = if held == Control::Force { units.force } else { units.length };
    Some([value, units.length / preset.edge.reference_speed?])
}

/// The value of the control at which the edge of `preset` comes to rest behind the turn, where the control went up to `turn`
/// at `rate` and stayed there for the time `hold`; `None` where that cannot be followed. `length` is that by which a gap without one of its own is reduced.
pub(super) fn rest_behind(preset: &Preset, length: f64, turn: f64, [rate, hold]: [f64; 2]) -> Option<f64> {
    /// The approach is followed from the first of these shares of the contact radius from which it can be: what was before is
    /// forgotten. On waves a closing edge may touch ahead until shortly before the turn.
    const FROM: [f64; 6] = [0.3, 0.5, 0.7, 0.85, 0.93, 0.97];
    let reduced = preset.problem().reduced_by(preset.gap.length().unwrap_or(length));
    let held = preset.path.control.in_units(reduced.units.stiffness);
    let table = case::table(&preset.gap, &reduced, 1.0, &Printer::reduced(), &Unwatched).ok()?;
    let (puller, away) = puller(preset, &reduced, &table, held, TOLERANCE[1])?;
    let [value, time] = unit_of(preset, &reduced, held)?;
    let up = Part::Ramp { to: turn, rate }.in_units(1.0 / value, 1.0 / time);
    let hold = (hold > 0.0).then(|| Part::Hold { time: hold / time });
    let programme: Vec<Part> =
        [Some(up), hold, Some(Part::Apart { rate: away })].into_iter().flatten().collect();
    let settings = PullSettings { derivatives: false, ..puller.settings };
    let from = |share: f64| {
        Puller { start: share * puller.start, settings, ..puller }.pull(&programme, &Unwatched).ok()
    };
    let pull = FROM.into_iter().find_map(from)?;
    let largest = pull.moments.iter().max_by(|a, b| a.contact_radius.total_cmp(&b.contact_radius))?;
    // An edge that only opens rests at the turn.
    Some(if largest.time > pull.start.time { largest.control * value } else { turn })
}

impl Trail {
    /// The pull of `preset` until the bodies are apart; `None` where there is none, or where it cannot be followed.
    pub(super) fn of(
        preset: &Preset,
        reduced: &Reduced,
        table: &Arc<Table>,
        (eye, reach): (&Eye, &Reach),
        held: Control,
    ) -> Option<Self> {
        let tolerance = (OF_NOISE * reach.noise).clamp(TOLERANCE[0], TOLERANCE[1]);
        let (puller, rate) = puller(preset, reduced, table, held, tolerance)?;
        let start = puller.start;
        let is_far = |at: [f64; 3]| eye.x(at) - reach.turn[0] > FAR * reach.length;
        // The transform of a growing gap is at least the gap itself. If half of the gap is already far beyond the points, no table
        // is made: it would reach as far as the start, over any number of waves.
        let least = 0.5 * reduced.gap.jet(start).value - (TAU * reduced.work_of_adhesion * start).sqrt();
        if is_far([start, least, 0.0]) {
            return None;
        }
        let begun = ExactBasis::new(Arc::clone(table), start).equilibrium(reduced, start)?;
        if is_far([start, begun.approach, begun.force]) {
            return None;
        }
        let pull = puller.pull(&[Part::Apart { rate }], &Unwatched).ok()?;
        let last = pull.moments.iter().rfind(|moment| moment.contact_radius > 0.0)?;
        let (first, way) = (pull.start, (pull.start.control - last.control).abs());
        let q = |moment: &Moment| {
            (first.control - moment.control) / way
                + (first.contact_radius - moment.contact_radius) / first.contact_radius
        };
        let end = q(last);
        let mut states: Vec<TrackState> = Vec::new();
        let mut moved = Vec::new();
        for (moment, by) in pull.moments.iter().zip(&pull.moved) {
            let along = end - q(moment);
            if states.last().is_none_or(|before| before.along - along > ONE * end) {
                states.push(state(moment, along, held, [rate, rate / way, first.contact_radius]));
                moved.push(*by);
            }
        }
        let is_known = states.iter().all(|state| state.at.iter().chain(&state.slopes).all(|x| x.is_finite()));
        (states.len() >= AROUND && is_known).then_some(Self { states, moved, held })
    }

    /// Its states, running inward.
    pub(super) fn states(&self) -> &[TrackState] {
        &self.states
    }

    /// What runs along, at its start and at its end.
    pub(super) fn ends(&self) -> [f64; 2] {
        [self.states[0].along, self.states[self.states.len() - 1].along]
    }

    /// The state at `along`, or at the nearer end if `along` lies beyond it.
    pub(super) fn state(&self, along: f64) -> TrackState {
        let states = &self.states;
        let [outer, inner] = self.ends();
        let along = along.clamp(inner, outer);
        let at = states.partition_point(|state| state.along >= along).clamp(1, states.len() - 1);
        let [a, b] = [&states[at], &states[at - 1]];
        let way = b.along - a.along;
        let t = (along - a.along) / way;
        let cubic = |k: usize| {
            let (there, from, to) = (b.at[k] - a.at[k], way * a.slopes[k], way * b.slopes[k]);
            let value =
                a.at[k] + t * (1.0 - t) * ((1.0 - t) * from - t * to) + t * t * (3.0 - 2.0 * t) * there;
            let slope =
                (1.0 - t) * (1.0 - 3.0 * t) * from + t * (3.0 * t - 2.0) * to + 6.0 * t * (1.0 - t) * there;
            [value, slope / way]
        };
        let found = [0, 1, 2].map(cubic);
        TrackState { along, at: found.map(|[value, _]| value), slopes: found.map(|[_, slope]| slope) }
    }
}

impl Trail {
    /// How s, δ and P at `along` change per unit of the logarithm of a value, up to a shift along the path; `None`
    /// where that is not known.
    pub(super) fn moves(&self, mover: Mover, along: f64) -> Option<[f64; 3]> {
        let states = &self.states;
        let at = states.partition_point(|state| state.along >= along);
        let first = at.saturating_sub(AROUND / 2).min(states.len() - AROUND);
        let around = first..first + AROUND;
        let along = along.clamp(states[states.len() - 1].along, states[0].along);
        let of = |value: usize| {
            let mut sum = [0.0; 3];
            for i in around.clone() {
                let share = |j: usize| (along - states[j].along) / (states[i].along - states[j].along);
                let weight: f64 = around.clone().filter(|j| *j != i).map(share).product();
                sum.iter_mut().zip(self.moved[i][value]).for_each(|(sum, x)| *sum += weight * x);
            }
            sum
        };
        let moved = match mover {
            Mover::Adhesion => of(ADHESION),
            Mover::Speed => of(RATE).map(|x| -x),
            Mover::Exponent => of(EXPONENT),
            Mover::Start => of(START),
            Mover::Stiffness => of(STIFFNESS),
            // γ, k and the rate of a force are in units of E*, and so is P.
            Mover::Modulus => {
                let (adhesion, stiffness, rate) = (of(ADHESION), of(STIFFNESS), of(RATE));
                let is_force = f64::from(u8::from(self.held == Control::Force));
                let force = self.state(along).at[2];
                let own = |k: usize| if k == 2 { force } else { 0.0 };
                std::array::from_fn(|k| own(k) - adhesion[k] - stiffness[k] - is_force * rate[k])
            }
            Mover::Strength | Mover::Extent | Mover::Range => return None,
        };
        moved.iter().all(|x| x.is_finite()).then_some(moved)
    }
}

/// A moment as a state; `rate` is that of the control, `by_control` its share of dq/dt, and `radius` the unit of s in q.
fn state(moment: &Moment, along: f64, held: Control, [rate, by_control, radius]: [f64; 3]) -> TrackState {
    let Moment { contact_radius: s, approach, force, speed: v, .. } = *moment;
    let opening = (TAU * s * moment.energy_release_rate).sqrt();
    let [by_radius, by_value] = match held {
        Control::Displacement => [0.0, 1.0],
        Control::Force => [opening / s, 0.5 / s],
        Control::Stiffness(k) => [2.0 * opening / (k + 2.0 * s), k / (k + 2.0 * s)],
    };
    let delta = -by_radius * v - by_value * rate;
    let rates = [-v, delta, 2.0 * (s * delta + opening * v)];
    let whole = by_control + v / radius;
    TrackState { along, at: [s, approach, force], slopes: rates.map(|x| -x / whole) }
}

#[cfg(test)]
mod tests {
    use crate::fit::path::FitPath;
    use crate::fit::reach::Reach;
    use crate::fit::tests::preset;
    use crate::fit::way::Way;
    use crate::measured::Abscissa;
    use crate::problem::Start;

    /// How many corners the path of a pull of the wavy sphere has, with points within 0.1 of x = 0.
    fn corners(start: f64, speed: f64, exponent: f64) -> Option<usize> {
        const WAVES: &str = "shape='wavy-sphere'\nradius_of_curvature=1.0\namplitude=0.0025\nwavelength=0.05";
        let edge = format!("rate=1e-3\n[edge]\nreference_speed={speed:e}\nexponent={exponent}");
        let mut preset = preset(WAVES, 1.0, 4e-3, &edge);
        preset.path.start = Start::ContactRadius(start);
        let reach = Reach { most: [0.1; 3], turn: [0.0; 2], radius: None, length: 0.1, noise: 1e-3 };
        let path = FitPath::new(&preset, Abscissa::Approach, &reach, Way::Down);
        path.map(|path| path.vertices.len())
    }

    #[test]
    fn a_fit_loses_no_time_with_pulls_far_from_any_points() {
        let usual = corners(0.5, 1e-2, 0.5).unwrap();
        // G exceeds the work of adhesion by a share of 1e-11: without a bound the integrator takes hundreds of thousands of
        // steps.
        let slow = corners(0.5, 3e3, 1.6).unwrap();
        assert!(slow < 10 * usual, "{slow} {usual}");
        assert_eq!(corners(0.5, 1e-15, 0.9), None, "G is 1e10 times the work of adhesion");
        assert!(corners(0.9, 1e-2, 0.5).is_some());
        assert_eq!(corners(40.0, 1e-2, 0.5), None, "the points are within 0.1, the pull begins at 1600");
    }
}
