//! What the arcs of a path run along: equilibria over the contact radius, or over the edge of the zone where adhesion has a range.
//!
//! All in reduced units.

pub use super::mover::Mover;
use super::pulled::{TrackState, Trail, is_pulled};
use super::reach::{Eye, Reach};
use crate::case;
use crate::disc::{Basis, ExactBasis, Local, Place, Solution, Table};
use crate::gap::Gap;
use crate::measured::Abscissa;
use crate::preset::Preset;
use crate::problem::{Adhesion, Cohesion, Control, Groups, Printer, Reduced, StatedCohesion};
use crate::progress::{Unwatched, until};
use crate::quasistatic::path::{PathError, Zones};
use crate::quasistatic::places::places;
use crate::quasistatic::{Curve, Detail, Monotone, Sample};
use crate::root;
use crate::zone::ZoneState;
use crate::zone::equilibria::about;
use std::sync::Arc;

/// Contact radii begin at this share of the outermost.
const INNERMOST: f64 = 1e-3;
/// How far beyond the points the path goes.
const MARGIN: f64 = 1.15;
/// Halvings of the outermost edge of a zone.
const HALVINGS: usize = 40;
/// Zones that are computed for a path. Those within reach of points take a few thousand; a fit that strays far beyond them
/// would look for many more.
const QUESTIONS: usize = 40_000;

/// Beyond this `λ_M` the zone is so thin that the pull-off force is that without a zone to 0.0007 of it, and no fit
/// goes there.
pub(super) const LARGEST_MAUGIS: f64 = 15.0;
/// Beyond this one a fit counts as having run to its end.
pub(super) const END_MAUGIS: f64 = 0.8 * LARGEST_MAUGIS;

/// Maugis' `λ_M` of a preset.
pub(super) fn maugis(preset: &Preset) -> Option<f64> {
    Groups::of(&preset.problem(), None, preset.cohesion()).maugis
}

/// What arcs run along.
#[derive(Debug, Clone)]
pub(super) enum Track {
    /// Adhesion at the edge of contact alone.
    Edge(Box<Curve>),
    /// Adhesion with a range.
    Zone {
        zones: Arc<Zones>,
        monotone: Arc<Monotone>,
        ends: [f64; 2],
        law: Cohesion,
        /// Whether its range, not its tension, stays as it is when γ changes.
        holds_range: bool,
    },
    /// A pull at a rate.
    Pull(Arc<Trail>),
}

impl Track {
    /// The track of a preset, reaching as far as the points, with its stretches under `held` known; `None` where there
    /// is none.
    pub(super) fn new(
        preset: &Preset,
        reduced: Reduced,
        eye: &Eye,
        reach: &Reach,
        held: Control,
    ) -> Option<Self> {
        let units = reduced.units;
        let table = case::table(&preset.gap, &reduced, 1.0, &Printer::reduced(), &Unwatched).ok()?;
        if let Some(law) = preset.cohesion() {
            let law = law.reduced_by(units.length, units.pressure);
            let holds_range =
                !matches!(preset.material.adhesion, Adhesion::Dugdale(StatedCohesion::Strength(_)));
            let radius = preset.gap.radius_of_curvature().map(|radius| radius / units.length);
            return Self::in_zone(&table, (law, holds_range, radius), eye, reach, held);
        }
        if is_pulled(preset) {
            let trail = Trail::of(preset, &reduced, &table, (eye, reach), held)?;
            return Some(Self::Pull(Arc::new(trail)));
        }
        let wave = preset.gap.feature_length().map(|length| length / units.length);
        let outermost = match reach.radius {
            Some(radius) => (radius / units.length).min(reduced.largest_contact()),
            None => outermost(&reduced, &ExactBasis::new(Arc::clone(&table), 1e-3), (reach, eye, wave))?,
        };
        let basis: Arc<dyn Basis> = Arc::new(ExactBasis::new(Arc::clone(&table), outermost));
        let ends = [outermost, INNERMOST * outermost];
        let mut curve = Curve::new(reduced, basis, table, ends, Detail::Drawn, &Unwatched).ok()??;
        curve.hold(held);
        Some(Self::Edge(Box::new(curve)))
    }

    fn in_zone(
        table: &Arc<Table>,
        (law, holds_range, radius): (Cohesion, bool, Option<f64>),
        eye: &Eye,
        reach: &Reach,
        held: Control,
    ) -> Option<Self> {
        if radius.is_some_and(|radius| law.maugis(radius, 1.0) > LARGEST_MAUGIS) {
            return None;
        }
        let length = eye.units.length;
        let wanted = reach.radius.map(|radius| radius / length);
        let enough = |state: &ZoneState| {
            if let Some(edge) = wanted {
                return state.edge >= edge;
            }
            // Beyond the pull-off both rise.
            let rises = state.slopes.iter().all(|slope| *slope > 0.0);
            rises && eye.is_enough([state.contact_radius, state.approach, state.force], reach)
        };
        let about = about(law, wanted.unwrap_or(0.1));
        let zones = Zones::grown(table, law, about, &enough, &until(QUESTIONS)).ok()?;
        let solution = Arc::clone(&zones.solution);
        let end = solution.reach();
        let outermost = match wanted {
            Some(edge) if edge <= end => edge,
            Some(_) => return None,
            None => {
                let is_enough = |c: f64| {
                    let place = solution.place(c)?;
                    let Local { approach, force, slopes, .. } = solution.at(place);
                    let rises = slopes.iter().all(|slope| *slope > 0.0);
                    let s = solution.edges(place).contact_radius;
                    Some(rises && eye.is_enough([s, approach, force], reach))
                };
                if !is_enough(end)? {
                    return None;
                }
                let [_, enough] = root::halved(solution.begin(), end, |c| !is_enough(c).unwrap_or(false));
                (MARGIN * enough).min(end)
            }
        };
        let monotone = Arc::new(Monotone::of(&*solution, held));
        let ends = [outermost, (INNERMOST * outermost).max(solution.begin())];
        Some(Self::Zone { zones: Arc::new(zones), monotone, ends, law, holds_range })
    }

    /// The equilibria; a pull has none.
    pub(super) fn solution(&self) -> Option<&dyn Solution> {
        match self {
            Self::Edge(curve) => Some(&*curve.solution),
            Self::Zone { zones, .. } => Some(&*zones.solution),
            Self::Pull(_) => None,
        }
    }

    /// The stretches of the control that is held; a pull has none.
    pub(super) fn monotone(&self, held: Control) -> Option<Arc<Monotone>> {
        match self {
            Self::Edge(curve) => Some(curve.monotone(held)),
            Self::Zone { monotone, .. } => Some(Arc::clone(monotone)),
            Self::Pull(_) => None,
        }
    }

    /// The step of the logarithm of a value over which the derivatives of paths are taken: what is integrated is known
    /// to fewer digits.
    pub(super) fn step(&self) -> f64 {
        const OF_EQUILIBRIA: f64 = 1e-5;
        const OF_PULLS: f64 = 3e-4;
        if matches!(self, Self::Pull(_)) { OF_PULLS } else { OF_EQUILIBRIA }
    }

    /// Its outer and its inner end.
    pub(super) fn ends(&self) -> [f64; 2] {
        match self {
            Self::Edge(curve) => [curve.outermost(), curve.innermost()],
            Self::Zone { ends, .. } => *ends,
            Self::Pull(trail) => trail.ends(),
        }
    }

    /// Makes it reach this many times as far; false where it cannot.
    pub(super) fn longer(&mut self, by: f64) -> bool {
        match self {
            Self::Edge(curve) => curve.reach(by * curve.solution.reach()),
            // It ends where a panel does, some way beyond the points.
            Self::Zone { .. } | Self::Pull(_) => false,
        }
    }

    /// The state at `along`; `None` beyond what is known.
    pub(super) fn state(&self, along: f64) -> Option<TrackState> {
        if let Self::Pull(trail) = self {
            return Some(trail.state(along));
        }
        let solution = self.solution()?;
        // The outermost radius may be rounded beyond what is known.
        Some(self.state_at(solution, solution.place(along.min(solution.reach()))?, along))
    }

    fn state_at(&self, solution: &dyn Solution, place: Place, along: f64) -> TrackState {
        let local = solution.at(place);
        let [delta, force] = local.slopes.map(|slope| slope / local.stretch);
        match self {
            Self::Edge(_) | Self::Pull(_) => {
                TrackState { along, at: [along, local.approach, local.force], slopes: [1.0, delta, force] }
            }
            Self::Zone { zones, .. } => {
                let s = solution.edges(place).contact_radius;
                let slope = if s > 0.0 { zones.contact_slope(place) } else { 0.0 };
                TrackState { along, at: [s, local.approach, local.force], slopes: [slope, delta, force] }
            }
        }
    }

    /// States to draw it with, running inward, as far as it is connected.
    pub(super) fn drawn(&self) -> Vec<TrackState> {
        match self {
            Self::Pull(trail) => trail.states().to_vec(),
            Self::Edge(curve) => {
                let of = |sample: &Sample| {
                    let Sample { contact_radius: s, approach, force, slopes } = *sample;
                    let slopes = [1.0, slopes.approach, slopes.force];
                    // On the outer side of a corner of the gap there are none.
                    let known = slopes.iter().all(|slope| slope.is_finite());
                    let own = TrackState { along: s, at: [s, approach, force], slopes };
                    if known { own } else { self.state(s).unwrap_or(own) }
                };
                curve.samples.iter().map(of).collect()
            }
            Self::Zone { zones, ends: [outer, inner], .. } => {
                let solution = &*zones.solution;
                let mut panel = None;
                let joined = |place: &Place| {
                    let is_joined =
                        panel.is_none_or(|outer| outer == place.panel || solution.is_joined(place.panel));
                    panel = Some(place.panel);
                    is_joined
                };
                let places = places(solution, *outer, *inner, Detail::Drawn);
                let connected = places.into_iter().take_while(joined);
                let states = connected.map(|place| self.state_at(solution, place, solution.radius(place)));
                states.filter(|state| state.slopes.iter().all(|slope| slope.is_finite())).collect()
            }
        }
    }

    /// The error of a state that is not one disc in one zone.
    pub(super) fn fault(&self, along: f64) -> Option<PathError> {
        let Self::Zone { zones, .. } = self else { return None };
        let place = zones.solution.place(along)?;
        zones.fault(place, &Unwatched).unwrap_or_else(Some)
    }

    /// How s, δ and P change per unit of the logarithm of a value, with what runs along held; `None` where there is no
    /// closed form.
    pub(super) fn moves(&self, mover: Mover, along: f64) -> Option<[f64; 3]> {
        let (zones, law, holds_range) = match self {
            Self::Edge(_) => return None,
            Self::Pull(trail) => return trail.moves(mover, along),
            Self::Zone { zones, law, holds_range, .. } => (zones, law, holds_range),
        };
        let solution = &*zones.solution;
        let place = solution.place(along.min(solution.reach()))?;
        let [by_strength, by_range] = zones.moves(place);
        let of = |strength: f64, range: f64| -> [f64; 3] {
            std::array::from_fn(|k| {
                strength * law.strength * by_strength[k] + range * law.range * by_range[k]
            })
        };
        Some(match mover {
            // P is E* times a function of σ₀/E*.
            Mover::Modulus => {
                let [s, delta, force] = of(-1.0, 0.0);
                [s, delta, force + solution.at(place).force]
            }
            Mover::Adhesion if *holds_range => of(1.0, 0.0),
            Mover::Adhesion => of(0.0, 1.0),
            Mover::Strength => of(1.0, -1.0),
            Mover::Extent => of(-1.0, 1.0),
            Mover::Stiffness | Mover::Range | Mover::Speed | Mover::Exponent | Mover::Start => return None,
        })
    }
}

/// The contact radius of the outermost equilibrium of `preset` at x, in the user's units: where the edge is when a
/// retraction begins there.
pub(super) fn begins(preset: &Preset, abscissa: Abscissa, x: f64, length: f64) -> Option<f64> {
    if abscissa == Abscissa::Radius {
        return Some(x);
    }
    let reduced = preset.problem().reduced_by(preset.gap.length().unwrap_or(length));
    let compliance = match (abscissa, preset.path.control) {
        (Abscissa::Position, Control::Stiffness(k)) => 1.0 / k,
        _ => 0.0,
    };
    let eye = Eye { units: reduced.units, abscissa, compliance };
    let table = case::table(&preset.gap, &reduced, 1.0, &Printer::reduced(), &Unwatched).ok()?;
    let basis = ExactBasis::new(table, 1e-3);
    let reach = Reach {
        most: [x, f64::NEG_INFINITY, f64::NEG_INFINITY],
        turn: [x, 0.0],
        radius: None,
        length,
        noise: 0.0,
    };
    let wave = preset.gap.feature_length().map(|length| length / reduced.units.length);
    let mut hi = outermost(&reduced, &basis, (&reach, &eye, wave))?;
    let mut lo = 0.5 * hi;
    for _ in 0..HALVINGS {
        let middle = 0.5 * (lo + hi);
        let at = basis.equilibrium(&reduced, middle)?;
        if eye.x([middle, at.approach, at.force]) > x { hi = middle } else { lo = middle }
    }
    Some(hi * reduced.units.length)
}

/// The reduced radius from which the curve reaches beyond all points, where the waves of the gap have the length `wave`.
fn outermost(
    reduced: &Reduced,
    basis: &ExactBasis,
    (reach, eye, wave): (&Reach, &Eye, Option<f64>),
) -> Option<f64> {
    const FIRST: f64 = 1e-7;
    const GROWTH: f64 = 1.5;
    /// Where the gap is this many ranges of x high, the contact has nothing to do with the points: the modulus is far too small,
    /// and the table would go over thousands of waves.
    const FAR: f64 = 1e3;
    let largest = reduced.largest_contact();
    let highest = FAR * reach.length / eye.units.length;
    let mut s = FIRST;
    let mut before = [f64::INFINITY; 2];
    for _ in 0..120 {
        if s >= largest {
            return Some(largest);
        }
        let at = basis.equilibrium(reduced, s)?;
        let state = [s, at.approach, at.force];
        let here = [eye.x(state), at.force * eye.units.force];
        // Small contacts have an approach and a force near zero too: only beyond the pull-off do both rise.
        let rises = here[0] > before[0] && here[1] > before[1];
        if rises && eye.is_enough(state, reach) {
            let enough = |s: f64| {
                let at = basis.equilibrium(reduced, s)?;
                Some(eye.is_enough([s, at.approach, at.force], reach))
            };
            let last = wave.map_or(s, |wave| beyond_crests(s, wave, largest, &enough));
            return Some((MARGIN * last).min(largest));
        }
        // Not sooner: on a steep gap the step that reaches the points may go far beyond them.
        if reduced.gap.jet(s).value > highest {
            return None;
        }
        before = here;
        s *= GROWTH;
    }
    None
}

/// The last radius from `s` on that does not reach as far as the points: a crest may reach further than the valleys after
/// it, where the record may begin.
fn beyond_crests(s: f64, wave: f64, largest: f64, is_enough: &dyn Fn(f64) -> Option<bool>) -> f64 {
    /// The number of radii in a wave, that of waves without such a radius after which there is none, and that of all.
    const PER_WAVE: f64 = 12.0;
    const WAVES: f64 = 4.0;
    const MOST: usize = 20_000;
    let (mut last, mut at) = (s, s);
    for _ in 0..MOST {
        at += wave / PER_WAVE;
        if at > (last + WAVES * wave).min(largest) {
            break;
        }
        match is_enough(at) {
            Some(true) => {}
            Some(false) => last = at,
            None => break,
        }
    }
    last
}
