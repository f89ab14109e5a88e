//! A pull: a programme of ramps and holds, carried out on one disc.
//!
//! At every moment the edge opens (G > γ), rests (`γ_a` ≤ G ≤ γ) or closes (G < `γ_a`). While it rests, δ and P move
//! along the straight line dP/dδ = 2E*s. On every way the work of the device is
//!
//! ```text
//! ∫ (dΠ/dc) dc = ΔΠ + γ (area lost) − γ_a (area gained) + dissipated,      Π: elastic, of bodies and device
//! ```
//!
//! where the left side and the dissipation are sums over the steps and the other terms are read from the table: the
//! balance.

use super::caps::{Caps, MotionFolds};
use super::equation::{Equation, HeldDisc, MovingEdge};
use super::error::RateError;
use super::law::Motion;
use super::record::{LeastForce, Moment, MomentSlopes, Record};
use super::settings::PullSettings;
use super::snaps::{Snap, Snaps};
use super::stretch::{MotionStretch, StretchEnd};
use crate::disc::{Panels, Table, TableError};
use crate::problem::{Control, Part};
use crate::progress::{Progress, Stopped};
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

/// A drive below this counts as equilibrium.
const EQUILIBRIUM: f64 = 1e-11;
/// The most changes between opening, rest and closing within one part of a programme.
const CHANGES: usize = 1000;
/// A time this near to the end of a part, as a share of its duration, is the end.
const OVER: f64 = 1e-13;
/// A drive along the equilibria below this many tolerances of the integrator is lost among its errors.
const RESOLVED: f64 = 100.0;
/// Forces that differ by no more than this share are one.
const ROUNDING: f64 = 1e-12;
/// How far beyond the start the table may have to reach, as this many factors of [`WIDER`].
const WIDENINGS: usize = 60;
const WIDER: f64 = 1.3;

/// What is pulled.
#[derive(Debug)]
pub struct Puller<'a> {
    /// The gap.
    pub table: &'a Table,
    /// The device.
    pub control: Control,
    /// The law and both works of adhesion.
    pub edge: MovingEdge,
    /// The contact radius at the start, in equilibrium under the work of adhesion that a closing edge gains.
    pub start: f64,
    /// The length of the gap's structure, where it is known.
    pub wave: Option<f64>,
    /// A least force counts as a peak of tension where the force rises by more than this after it; `None` means 1 % of
    /// the largest pull.
    pub rise: Option<f64>,
    /// The integrator.
    pub settings: PullSettings,
}

/// A pull, in reduced units.
#[derive(Debug, Clone, PartialEq)]
pub struct Pull {
    /// The first moment.
    pub start: Moment,
    /// The moment at which the edge first opens; `None` where it never does.
    pub pinned_until: Option<Moment>,
    /// The least force on the way. Under a dead load it is often that of the last contact, whose approach is −∞.
    pub peak: Moment,
    /// The least forces before which the force falls, and after which it rises, by more than the rise asked for.
    pub tension_peaks: Vec<Moment>,
    /// The snaps, in order.
    pub snaps: Vec<Snap>,
    /// The moment at which the bodies are apart; `None` where the programme ends before that.
    pub last_contact: Option<Moment>,
    /// All that the edge dissipated; `None` where a dead load keeps falling.
    pub dissipated: Option<f64>,
    /// What is missing in the balance of work and energy, relative to the work.
    pub balance: f64,
    /// Moments in order.
    pub moments: Vec<Moment>,
    /// How s, δ and P of the moments in contact change with the values, where that was asked for.
    pub moved: Vec<MomentSlopes>,
    /// If the edge closed, the largest contact it closed to, with its approach.
    pub closed_to: Option<[f64; 2]>,
    /// How far G still was from equilibrium at the end of each hold, as |G/γ − 1|.
    pub holds: Vec<f64>,
    /// Steps of the integrator.
    pub steps: usize,
    /// How many parts of the programme were begun: those after the last contact are not.
    pub begun: usize,
}

/// The state of a pull in progress.
struct Going<'a> {
    puller: &'a Puller<'a>,
    panels: Arc<Panels>,
    folds: [Option<MotionFolds>; 2],
    record: Record,
    snaps: Snaps,
    s: f64,
    t: f64,
    c: f64,
    /// γ (area lost) − `γ_a` (area gained).
    adhesion: f64,
    pinned_until: Option<Moment>,
    closed_to: Option<[f64; 2]>,
    is_apart: bool,
}

/// The way of the control in one part.
#[derive(Clone, Copy)]
struct PartWay {
    rate: f64,
    until: Option<f64>,
    duration: f64,
}

impl Puller<'_> {
    /// Carries out a programme.
    ///
    /// # Errors
    /// [`RateError`].
    pub fn pull(&self, programme: &[Part], progress: &dyn Progress) -> Result<Pull, RateError> {
        if self.edge.closing <= 0.0 {
            return Err(RateError::NoAdhesion);
        }
        let panels = self.panels(programme, progress)?;
        let s = self.start;
        let c = HeldDisc::equilibrium(&panels, self.control, self.edge.closing, s);
        let mut going = Going {
            puller: self,
            panels,
            folds: [None, None],
            record: Record::default(),
            snaps: Snaps::default(),
            s,
            t: 0.0,
            c,
            adhesion: 0.0,
            pinned_until: None,
            closed_to: None,
            is_apart: false,
        };
        let start = going.resting(0.0);
        let elastic = HeldDisc::new(&going.panels, self.control, s, c).potential(&going.panels, self.control);
        going.record.add(start, 0.0);
        let (mut holds, mut begun) = (Vec::new(), 0);
        for part in programme {
            begun += 1;
            going.part(*part, progress)?;
            if going.is_apart {
                break;
            }
            if let Part::Hold { .. } = part {
                let held = HeldDisc::new(&going.panels, self.control, going.s, going.c);
                let ratio = held.energy_release_rate() / self.edge.opening;
                let below = (self.edge.closing / self.edge.opening - ratio).max(0.0);
                holds.push((ratio - 1.0).max(below));
            }
        }
        if !matches!(programme, [Part::Apart { .. }]) {
            going.record.moved.clear();
        }
        Ok(going.finished(start, elastic, (holds, begun)))
    }

    /// The table as far as the contact can grow.
    fn panels(&self, programme: &[Part], progress: &dyn Progress) -> Result<Arc<Panels>, RateError> {
        let up_to = |reach: f64| {
            self.table.up_to_while(reach, 0, progress).map_err(|error| match error {
                TableError::Stopped(Stopped) => RateError::Stopped(Stopped),
                TableError::TooFine(refused) => RateError::Beyond { radius: refused.radius },
            })
        };
        let highest = programme.iter().filter_map(|part| match part {
            Part::Ramp { to, .. } => Some(*to),
            Part::Apart { .. } | Part::Hold { .. } => None,
        });
        let highest = highest.fold(f64::NEG_INFINITY, f64::max);
        let mut reach = self.start;
        for _ in 0..WIDENINGS {
            let panels = up_to(reach)?;
            if HeldDisc::equilibrium(&panels, self.control, self.edge.closing, reach) >= highest {
                return Ok(panels);
            }
            let end = self.table.end();
            if reach >= end {
                return Err(RateError::Beyond { radius: end });
            }
            reach = (WIDER * reach).min(end);
        }
        Err(RateError::Beyond { radius: reach })
    }
}

impl Going<'_> {
    fn held(&self) -> HeldDisc {
        HeldDisc::new(&self.panels, self.puller.control, self.s, self.c)
    }

    /// The moment here, with an edge at rest.
    fn resting(&self, dissipated: f64) -> Moment {
        let held = self.held();
        Moment {
            time: self.t,
            control: self.c,
            contact_radius: self.s,
            approach: held.approach,
            force: held.force,
            speed: 0.0,
            energy_release_rate: held.energy_release_rate(),
            dissipated,
        }
    }

    fn part(&mut self, part: Part, progress: &dyn Progress) -> Result<(), RateError> {
        let way = match part {
            Part::Ramp { to, rate } => {
                let duration = (to - self.c).abs() / rate;
                PartWay { rate: rate.copysign(to - self.c), until: Some(self.t + duration), duration }
            }
            Part::Apart { rate } => PartWay { rate: -rate, until: None, duration: 0.0 },
            Part::Hold { time } => PartWay { rate: 0.0, until: Some(self.t + time), duration: time },
        };
        for _ in 0..CHANGES {
            if self.is_apart || way.until.is_some_and(|until| until - self.t <= OVER * way.duration) {
                return Ok(());
            }
            match self.motion(way) {
                Some(motion) => self.moves(motion, way, progress)?,
                None => self.rests(way),
            }
        }
        Err(RateError::Lost { contact_radius: self.s })
    }

    /// Which way the edge goes; `None` where it rests.
    fn motion(&self, way: PartWay) -> Option<Motion> {
        let MovingEdge { opening, closing, .. } = self.puller.edge;
        let offered = self.held().opening;
        let over = |gamma: f64| {
            let root = (TAU * gamma * self.s).sqrt();
            (offered - root) * (offered + root) / (root * root)
        };
        let (opens, closes) = (over(opening), -over(closing));
        let begins = |drive: f64, towards: bool| drive > EQUILIBRIUM || drive.abs() <= EQUILIBRIUM && towards;
        if begins(opens, way.rate < 0.0) {
            Some(Motion::Opening)
        } else if begins(closes, way.rate > 0.0) {
            Some(Motion::Closing)
        } else {
            None
        }
    }

    fn moves(&mut self, motion: Motion, way: PartWay, progress: &dyn Progress) -> Result<(), RateError> {
        let Puller { control, edge, wave, settings, .. } = self.puller;
        let slot = usize::from(motion == Motion::Closing);
        let panels = Arc::clone(&self.panels);
        let folds = self.folds[slot].get_or_insert_with(|| MotionFolds::new(&panels, edge, motion, *control));
        let left = way.until.map_or(0.0, |until| until - self.t);
        let equation =
            Equation::new(&panels, *control, edge, motion, [self.s, self.t, self.c], way.rate, left);
        let caps = Caps::new(&panels, folds, way.rate, equation.branch.exponent, *wave, *settings);
        let unstable = folds.unstable();
        // On unstable equilibria, where a turn may leave the edge, the size of the slope counts.
        let level = (way.rate / folds.slope(&panels, edge.adhesion(motion), self.s)).abs();
        let rests = way.rate * motion.sense() <= 0.0 && (motion == Motion::Closing || way.rate >= 0.0);
        let adhesion = edge.adhesion(motion) * PI * self.s * self.s;
        let energy = adhesion + self.held().potential(&panels, *control).abs();
        let stretch =
            MotionStretch { equation: &equation, caps: &caps, settings, until: way.until, rests, energy };
        if motion == Motion::Opening && self.pinned_until.is_none() {
            self.pinned_until = Some(self.resting(self.record.dissipated));
        }
        let first = self.record.moments.len();
        let (at, end) = stretch.follow(&mut self.record, progress)?;
        let [drive, _] = equation.branch.drive(level);
        let resolved = level <= 0.0 || drive >= RESOLVED * settings.tolerance;
        self.snaps.add(&self.record.moments[first..], motion, (way.rate, level, resolved), &unstable);
        let s = at.held.contact_radius;
        self.adhesion += edge.adhesion(motion) * PI * (self.s - s) * (self.s + s);
        if motion == Motion::Closing && self.closed_to.is_none_or(|[largest, _]| s > largest) {
            self.closed_to = Some([s, at.held.approach]);
        }
        (self.s, self.t, self.c) = (s, at.time, at.control);
        if let (StretchEnd::Time, Some(until)) = (end, way.until) {
            self.t = until;
        }
        self.is_apart = end == StretchEnd::Apart;
        Ok(())
    }

    /// Moves the control while the edge rests: to where the edge begins to move, or to the end of the part.
    fn rests(&mut self, way: PartWay) {
        let MovingEdge { opening, closing, .. } = self.puller.edge;
        let control = self.puller.control;
        let before = self.held();
        let energy = before.potential(&self.panels, control);
        let gamma = if way.rate < 0.0 { opening } else { closing };
        let begins = HeldDisc::equilibrium(&self.panels, control, gamma, self.s);
        let waits = if way.rate == 0.0 { f64::INFINITY } else { ((begins - self.c) / way.rate).max(0.0) };
        let left = way.until.map_or(f64::INFINITY, |until| until - self.t);
        let force_rate = 2.0 * self.s * before.by_control * way.rate;
        self.record.add(self.resting(self.record.dissipated), force_rate);
        if waits <= left {
            (self.t, self.c) = (self.t + waits, begins);
        } else {
            (self.t, self.c) = (self.t + left, self.c + way.rate * left);
        }
        let done = self.held().potential(&self.panels, control) - energy;
        self.record.work += done;
        self.record.work_size += done.abs();
        self.record.add(self.resting(self.record.dissipated), force_rate);
    }

    fn finished(mut self, start: Moment, elastic: f64, (holds, begun): (Vec<f64>, usize)) -> Pull {
        let control = self.puller.control;
        let last = self.held();
        let stored = last.potential(&self.panels, control);
        let missing = self.record.work - (stored - elastic) - self.adhesion - self.record.dissipated;
        // A dead load does its work as it falls.
        let fallen = match control {
            Control::Force => last.force * last.approach - start.force * start.approach,
            Control::Displacement | Control::Stiffness(_) => 0.0,
        };
        let balance = missing.abs() / (self.record.work_size + fallen.abs()).max(f64::MIN_POSITIVE);
        let mut dissipated = Some(self.record.dissipated);
        let mut last_contact = None;
        if self.is_apart {
            // The rest at held control: all that is stored, less what it costs to part the rest of the area.
            let rest = stored - self.puller.edge.opening * PI * self.s * self.s;
            dissipated = (control != Control::Force).then_some(self.record.dissipated + rest);
            let before = self.record.moments.last().copied().unwrap_or(start);
            let n = self.puller.edge.law.exponent;
            // The speed grows as s^{−1/n}, under a dead load still faster.
            let time = before.time + self.s / before.speed.abs() * n / (n + 1.0);
            let apart = Moment {
                time,
                contact_radius: 0.0,
                // A dead load keeps falling.
                approach: if control == Control::Force { f64::NEG_INFINITY } else { before.approach },
                force: if control == Control::Force { before.force } else { 0.0 },
                dissipated: dissipated.unwrap_or(before.dissipated),
                ..before
            };
            last_contact = Some(apart);
            if control != Control::Force {
                self.record.add(apart, 0.0);
            }
        }
        let snaps = self.snaps.end(self.is_apart, self.record.moments.last());
        let least = |a: Moment, b: &Moment| if b.force < a.force { *b } else { a };
        let peak = self.record.moments.iter().fold(start, least);
        let peak = self.record.least.iter().map(|least| &least.at).fold(peak, least);
        // A dead load is largest where the bodies come apart, not where the integrator stopped short of it.
        let is_peak = |apart: &Moment| apart.force - peak.force <= ROUNDING * peak.force.abs();
        let peak = last_contact.filter(is_peak).unwrap_or(peak);
        Pull {
            start,
            pinned_until: self.pinned_until,
            peak,
            tension_peaks: peaks(&self.record, self.puller.rise.unwrap_or(0.01 * peak.force.abs())),
            snaps,
            last_contact,
            dissipated,
            balance,
            moments: self.record.moments,
            moved: self.record.moved,
            closed_to: self.closed_to,
            holds,
            steps: self.record.steps,
            begun,
        }
    }
}

/// The least forces with a fall of more than `rise` before and a rise of more than that after: a dip that is shallower on
/// either side is part of its neighbour.
fn peaks(record: &Record, rise: f64) -> Vec<Moment> {
    let mut found = Vec::new();
    let mut candidate: Option<Moment> = None;
    let first = record.least.first().map_or(0.0, |least| least.at.time);
    let before = record.moments.iter().take_while(|moment| moment.time <= first);
    let mut highest = before.map(|moment| moment.force).fold(f64::NEG_INFINITY, f64::max);
    for LeastForce { at, then } in &record.least {
        // What dips while the edge closes is no tension.
        let is_tension = at.speed >= 0.0;
        candidate = match candidate {
            None if !is_tension || highest - at.force <= rise => {
                highest = highest.max(*then);
                continue;
            }
            Some(known) if !is_tension || known.force < at.force => Some(known),
            _ => Some(*at),
        };
        if let Some(lowest) = candidate.filter(|lowest| then - lowest.force > rise) {
            found.push(lowest);
            (candidate, highest) = (None, *then);
        }
    }
    found
}
