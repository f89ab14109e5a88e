//! What is kept of a pull: its moments, sums and least forces.

use super::equation::StretchMoment;
use super::law::Motion;
use super::radau::{NODES, STAGES};
use super::step::SolvedStep;
use crate::root::RootBracket;

/// One moment of a pull, in reduced units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Moment {
    /// t, in units of the length over v₀.
    pub time: f64,
    /// c: δ, P or Δ.
    pub control: f64,
    /// s.
    pub contact_radius: f64,
    /// δ.
    pub approach: f64,
    /// P.
    pub force: f64,
    /// −ds/dt, in units of v₀: positive where the edge opens.
    pub speed: f64,
    /// G.
    pub energy_release_rate: f64,
    /// What the edge has dissipated so far.
    pub dissipated: f64,
}

/// The number of values by which a pull is varied: γ, n, V, k and s₀.
pub const VALUES: usize = 5;

/// How s, δ and P of a moment change with the logarithm of each value, up to a shift along the path.
pub type MomentSlopes = [[f64; 3]; VALUES];

/// A least force of a pull, and what the force rises to before the next one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LeastForce {
    /// Where it is.
    pub at: Moment,
    /// The largest force after it.
    pub then: f64,
}

/// A least force is found within this share of a step; the force itself to its square.
const NEAR: f64 = 1e-9;

/// What is kept on the way.
#[derive(Debug, Clone, Default)]
pub struct Record {
    /// The moments, in order.
    pub moments: Vec<Moment>,
    /// How they change with the values, where that is asked for.
    pub moved: Vec<MomentSlopes>,
    /// The least forces.
    pub least: Vec<LeastForce>,
    /// What the edge has dissipated, over E* times the unit of length cubed.
    pub dissipated: f64,
    /// The work of the device, in the same unit.
    pub work: f64,
    /// The sum of the sizes of its parts.
    pub work_size: f64,
    /// Steps of the integrator.
    pub steps: usize,
    motion: Option<Motion>,
    force_rate: f64,
}

impl Record {
    /// A moment of a moving edge, when `dissipated` is lost.
    fn moment(&self, at: &StretchMoment, dissipated: f64) -> Moment {
        let sense = self.motion.map_or(0.0, Motion::sense);
        Moment {
            time: at.time,
            control: at.control,
            contact_radius: at.held.contact_radius,
            approach: at.held.approach,
            force: at.held.force,
            speed: -sense * at.speed,
            energy_release_rate: at.held.energy_release_rate(),
            dissipated,
        }
    }

    /// Adds a moment; `force_rate` is dP/dt from it on.
    pub fn add(&mut self, moment: Moment, force_rate: f64) {
        if self.force_rate < 0.0 && force_rate >= 0.0 {
            self.least.push(LeastForce { at: moment, then: moment.force });
        }
        self.force_rate = force_rate;
        self.risen(moment.force);
        self.keep(moment);
    }

    /// Keeps a moment. Time never goes back, even where a step is shorter than the rounding of the time.
    fn keep(&mut self, moment: Moment) {
        let before = self.moments.last().map_or(f64::NEG_INFINITY, |last| last.time);
        self.moments.push(Moment { time: moment.time.max(before), ..moment });
    }

    fn risen(&mut self, force: f64) {
        if let Some(least) = self.least.last_mut() {
            least.then = least.then.max(force);
        }
    }

    /// Begins a stretch of a motion.
    pub fn began(&mut self, motion: Motion, at: &StretchMoment) {
        self.motion = Some(motion);
        self.add(self.moment(at, self.dissipated), at.force_rate);
    }

    /// Adds a step from `start`; `again` solves it with another length.
    pub fn step(
        &mut self,
        start: &StretchMoment,
        step: &SolvedStep,
        again: &dyn Fn(f64) -> Option<Box<SolvedStep>>,
    ) {
        self.steps += 1;
        let (lost, done) = (step.sums(StretchMoment::dissipation), step.sums(StretchMoment::work));
        let mut before = (0.0, start.force_rate);
        for (i, node) in step.nodes.iter().enumerate() {
            if before.1 < 0.0 && node.force_rate >= 0.0 {
                // The stages say between which of them it is; the place itself is the end of a step of its own.
                let [from, to] =
                    [before, (NODES[i], node.force_rate)].map(|(c, rate)| [step.length * c, rate]);
                let mut last = None;
                let rate_after = |h: f64| Some(last.insert(again(h)?).end().force_rate);
                let is_found = RootBracket::new(from, to)
                    .is_some_and(|mut bracket| bracket.find(NEAR * step.length, rate_after).is_some());
                let found = last.filter(|_| is_found);
                let at = found.as_ref().map_or(*node, |found| *found.end());
                let lost = found.map_or(lost[i], |found| found.sums(StretchMoment::dissipation)[STAGES - 1]);
                let at = self.moment(&at, self.dissipated + lost);
                self.least.push(LeastForce { at, then: at.force });
            }
            before = (NODES[i], node.force_rate);
            self.force_rate = node.force_rate;
            self.risen(node.held.force);
            self.keep(self.moment(node, self.dissipated + lost[i]));
        }
        self.dissipated += lost[STAGES - 1];
        self.work += done[STAGES - 1];
        self.work_size += done[STAGES - 1].abs();
    }
}
