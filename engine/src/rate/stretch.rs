//! One stretch of a pull, on which an edge goes one way: step by step to where it rests, the control stops or the bodies are apart.
//!
//! What ends a step (the end of a ramp, a rest, a break of the gap) and the least forces are found by solving the step
//! again with another length; the polynomial of a step is not used.

use super::caps::Caps;
use super::equation::{Equation, StretchMoment};
use super::error::RateError;
use super::law::Motion;
use super::radau::{NODES, STAGES, WEIGHTS, dot, interpolated};
use super::record::{Moment, Record};
use super::settings::PullSettings;
use super::step::{self, SolvedStep, landed};
use super::variation::Variation;
use crate::elementary::pow;
use crate::progress::{Progress, Stopped};

/// Why a stretch ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StretchEnd {
    /// The time is over.
    Time,
    /// The edge rests.
    Rest,
    /// The bodies are apart.
    Apart,
}

/// The error of a step grows with this power of its length.
const ORDER: f64 = 6.0;
/// A larger fall of the error tells nothing about the next step.
const MOST_GAIN: f64 = 1e6;
/// The safety factor of the next step, and the factors by which it changes at most.
const SAFETY: f64 = 0.9;
const CHANGE: [f64; 2] = [0.2, 4.0];
/// A step that Newton's method did not find is tried again with this share of its length.
const AGAIN: f64 = 0.4;
/// The first step, in units of ξ.
const FIRST: f64 = 1e-4;
/// Steps below this share of ξ do not move it.
const LEAST: f64 = 1e-15;
/// An edge slower than this, in φ, may be expected to stay so for a step of the cap divided by this.
const SLOW: f64 = 1e-3;
/// The energy that a step may miss, as a share of the tolerance: many steps add up.
const OF_ENERGY: f64 = 0.2;
/// A closing edge with a drive above this is pressed: it closes without bound.
const PRESSED: f64 = 1e12;
/// What is left of the contact at this speed, in reduced units, takes no time; under a dead load soon after no number is as
/// large as the speed.
const FASTEST: f64 = 1e150;
/// How often a step is shortened by what the previous one predicts.
const PREDICTIONS: usize = 3;
/// Steps between two calls of `progress`.
const ASKED: usize = 64;

/// One stretch.
pub struct MotionStretch<'a> {
    /// The equation of motion.
    pub equation: &'a Equation<'a>,
    /// The limit points, at which steps are capped.
    pub caps: &'a Caps<'a>,
    /// Tolerance and bounds.
    pub settings: &'a PullSettings,
    /// The time at which it ends; `None` for a ramp that goes on until the bodies are apart.
    pub until: Option<f64>,
    /// Whether the control turns the edge round, which then comes to rest.
    pub rests: bool,
    /// The energy relative to which the dissipation is known to the tolerance.
    pub energy: f64,
}

/// Where the integration is.
struct Here {
    xi: f64,
    y: f64,
    at: StretchMoment,
}

/// The lengths of steps, from their errors.
#[derive(Debug, Default)]
struct StepLengths {
    /// The length and the error of the previous step that was not cut.
    before: Option<[f64; 2]>,
}

impl StepLengths {
    /// By how much a step of this error, as a share of the tolerance, may be longer.
    fn factor(error: f64) -> f64 {
        if error > 0.0 { SAFETY * pow(error, -1.0 / ORDER) } else { CHANGE[1] }
    }

    /// The length after a step of the length `h` with this error. Where errors grow, they go on growing: K. Gustafsson, ACM
    /// Trans. Math. Softw. 20, 496 (1994), doi:10.1145/198429.198437.
    fn next(&mut self, h: f64, error: f64) -> f64 {
        let factor = Self::factor(error);
        let foreseen = self.before.filter(|[_, before]| *before > 0.0).map_or(factor, |[length, before]| {
            factor * h / length * pow((before / error).min(MOST_GAIN), 1.0 / ORDER)
        });
        self.before = Some([h, error]);
        h * factor.min(foreseen).clamp(CHANGE[0], CHANGE[1])
    }
}

impl MotionStretch<'_> {
    /// Follows the edge and records it.
    ///
    /// # Errors
    /// [`RateError`].
    pub fn follow(
        &self,
        record: &mut Record,
        progress: &dyn Progress,
    ) -> Result<(StretchMoment, StretchEnd), RateError> {
        let begin =
            self.equation.at(0.0, 0.0).ok_or(RateError::Lost { contact_radius: self.equation.radius })?;
        let mut here = Here { xi: 0.0, y: 0.0, at: begin };
        record.began(self.equation.motion, &here.at);
        let mut variation = self.settings.derivatives.then(|| Variation::new(self.equation, &begin.held));
        if let Some(variation) = &variation {
            // This moment, and the rest before it.
            let of = |moment: &Moment| variation.resting(moment);
            let resting: Vec<_> = record.moments.iter().skip(record.moved.len()).map(of).collect();
            record.moved.extend(resting);
        }
        let mut h = FIRST;
        let mut last: Option<Box<SolvedStep>> = None;
        let mut lengths = StepLengths::default();
        for count in 0..self.settings.steps {
            if count % ASKED == 0 && progress.stop() {
                return Err(RateError::Stopped(Stopped));
            }
            self.onto_break(&mut here);
            let rest = 1.0 - here.y;
            if self.equation.motion == Motion::Opening {
                if rest <= self.settings.gone || here.at.speed > FASTEST {
                    return Ok((here.at, StretchEnd::Apart));
                }
                h = h.min(self.settings.of_rest * rest);
            }
            let cap = self.caps.at(here.at.held.contact_radius) / self.equation.radius;
            h = h.min(cap / here.at.phi.abs().max(SLOW));
            if h < LEAST * here.xi.max(1e-3) {
                return Err(self.stuck(&here));
            }
            h = Self::within(cap, &here, h, last.as_deref());
            let Some(step) = self.step(&here, h, last.as_deref()) else {
                h *= AGAIN;
                continue;
            };
            let error = self.error(&here, &step, record.dissipated);
            let advance = (step.y - here.y).abs();
            if error > 1.0 || advance > cap {
                let shorter = if advance > cap { SAFETY * cap / advance } else { 1.0 };
                h *= StepLengths::factor(error).min(shorter).clamp(CHANGE[0], SAFETY);
                continue;
            }
            let Some((step, end)) = self.cut(&here, step) else {
                // The way to a break of the gap is as steep as a square root: shorter steps come near.
                h *= AGAIN;
                continue;
            };
            record.step(&here.at, &step, &|h| self.step(&here, h, Some(&step)));
            if let Some(variation) = &mut variation {
                record.moved.extend(variation.step(&step));
            }
            here = Here { xi: here.xi + step.length, y: step.y, at: *step.end() };
            if let Some(end) = end {
                return Ok((here.at, end));
            }
            // A step that was cut says nothing about the next one.
            if step.length >= h {
                h = lengths.next(h, error);
            }
            last = Some(step);
        }
        Err(RateError::TooManySteps {
            steps: self.settings.steps,
            contact_radius: here.at.held.contact_radius,
        })
    }

    /// Why no step from here is short enough.
    fn stuck(&self, here: &Here) -> RateError {
        let contact_radius = here.at.held.contact_radius;
        if self.equation.motion == Motion::Closing && here.at.drive > PRESSED {
            RateError::Pressed { contact_radius }
        } else {
            RateError::Lost { contact_radius }
        }
    }

    /// The error of a step from here as a share of the tolerance: that of the radius or of the energies, with `dissipated`
    /// before it, whichever is larger.
    fn error(&self, here: &Here, step: &SolvedStep, dissipated: f64) -> f64 {
        let sums = [
            step.error_of(StretchMoment::dissipation, &here.at),
            step.error_of(StretchMoment::work, &here.at),
        ];
        let lost = sums.map(f64::abs).into_iter().fold(0.0, f64::max) / (self.energy + dissipated);
        (step.error.abs() / self.tolerance(here)).max(lost / (OF_ENERGY * self.settings.tolerance))
    }

    /// Moves an edge that is next to a break of the gap onto it.
    fn onto_break(&self, here: &mut Here) {
        /// This near to it, as a share of the radius.
        const NEXT_TO: f64 = 1e-15;
        let s = here.at.held.contact_radius;
        let Some(at_break) = self.caps.next_break(self.equation.motion, s) else { return };
        let way = self.equation.motion.sense() * (at_break - s);
        if way > 0.0 && way <= 10.0 * NEXT_TO * s {
            // Slightly beyond it, on the other side.
            let y = here.y + (way + NEXT_TO * s) / self.equation.radius;
            if let Some(at) = self.equation.at(here.xi, y) {
                (here.y, here.at) = (y, at);
            }
        }
    }

    /// The stages that the previous step predicts for one of the length `h` from here.
    fn predicted(here: &Here, h: f64, last: Option<&SolvedStep>) -> [f64; STAGES] {
        match last {
            Some(last) => {
                let ahead = |c: f64| (here.xi - last.from + c * h) / last.length;
                NODES.map(|c| interpolated(&last.slopes, ahead(c)).clamp(0.0, 0.999))
            }
            None => [here.at.phi; STAGES],
        }
    }

    /// The length `h`, or less where the previous step predicts that the edge would go further than the cap: most steps
    /// end there, and one that goes too far is solved in vain.
    fn within(cap: f64, here: &Here, mut h: f64, last: Option<&SolvedStep>) -> f64 {
        for _ in 0..PREDICTIONS {
            let advance = h * dot(&WEIGHTS[STAGES - 1], &Self::predicted(here, h, last));
            if advance <= cap {
                break;
            }
            h *= (SAFETY * cap / advance).max(AGAIN);
        }
        h
    }

    /// The step of the length `h` from here.
    fn step(&self, here: &Here, h: f64, last: Option<&SolvedStep>) -> Option<Box<SolvedStep>> {
        let guess = Self::predicted(here, h, last);
        let tolerance = self.tolerance(here);
        step::solve(self.equation, [here.xi, here.y], &here.at, h, guess, tolerance, self.settings)
    }

    /// The error of a step, in units of the radius at which the stretch begins: a share of the radius here. What a dead load or a soft
    /// spring loses grows as 1/s.
    fn tolerance(&self, here: &Here) -> f64 {
        let share = if self.equation.motion == Motion::Opening { 1.0 - here.y } else { 1.0 };
        self.settings.tolerance * share.max(self.settings.gone)
    }

    /// The step as far as the first of what ends it; `None` where its end is not found.
    fn cut(&self, here: &Here, step: Box<SolvedStep>) -> Option<(Box<SolvedStep>, Option<StretchEnd>)> {
        let at_break = self.caps.next_break(self.equation.motion, here.at.held.contact_radius);
        let sense = self.equation.motion.sense();
        let past_break = |at: &StretchMoment| at_break.map_or(-1.0, |s| sense * (at.held.contact_radius - s));
        let past_time = |at: &StretchMoment| self.until.map_or(-1.0, |until| at.time - until);
        let past_rest = |at: &StretchMoment| if self.rests { -at.drive } else { -1.0 };
        let (mut first, mut ended) = (step, None);
        let ends = [None, Some(StretchEnd::Time), Some(StretchEnd::Rest)];
        let pasts: [&dyn Fn(&StretchMoment) -> f64; 3] = [&past_break, &past_time, &past_rest];
        for (past, end) in pasts.into_iter().zip(ends) {
            if past(first.end()) >= 0.0 {
                // Shorter steps begin from the stages of the whole one.
                let (longest, whole) = (first.length, *first);
                let again = |h: f64| self.step(here, h, Some(&whole));
                first = landed(&again, [0.0, longest], past(&here.at), first, past)?;
                ended = end;
            }
        }
        Some((first, ended))
    }
}
