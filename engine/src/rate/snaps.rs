//! The snaps of a pull: stretches in which the edge is ten times as fast as at its slowest since the last snap, and
//! crosses unstable equilibria. Where it crosses none it follows the equilibria, however much its speed along them
//! changes.
//!
//! An edge that runs past a place where there was an equilibrium before is slow there too, but it rests only where it
//! is about as slow as along the equilibria; in between, the snap goes on.

use super::law::Motion;
use super::record::Moment;
use crate::elementary::{exp, ln};

/// A snap is this many times as fast.
const FASTER: f64 = 10.0;

/// Below this share of the speed along the equilibria an edge rests: after a snap it comes to them to rounding, and
/// becomes that slow. Where its speeds are not resolved they are less than that for long.
const RESTS: [f64; 2] = [0.1, 0.5];

/// An edge that has run does not rest above this many times the speed along the equilibria.
const RUNS: f64 = 100.0;

/// A motion of the edge below this share of the radius does not count.
const NO_WAY: f64 = 1e-6;

/// A stretch of the pull in which the edge ran.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Snap {
    /// s where it began.
    pub from: f64,
    /// s where it ended.
    pub to: f64,
    /// The largest speed of the edge in it, in units of v₀.
    pub top_speed: f64,
    /// What it dissipated.
    pub dissipated: f64,
}

/// A place between two moments: s, and what is dissipated.
type SnapMark = [f64; 2];

/// A snap that has begun.
#[derive(Debug)]
struct BegunSnap {
    from: SnapMark,
    top: f64,
    /// The slowest moment after the top, and its speed.
    low: (Moment, f64),
    /// The slowest speed before it.
    least: f64,
}

/// What a stretch leaves to one of the same motion at the same rate, which goes on with it.
#[derive(Debug, Clone, Copy)]
struct SnapStretch {
    motion: Motion,
    rate: f64,
    /// The speed along the equilibria where it began.
    level: f64,
    /// The slowest speed since the last snap, and whether it is one of the equilibria.
    least: f64,
    is_settled: bool,
}

/// The snaps of a pull so far.
#[derive(Debug, Default)]
pub struct Snaps {
    found: Vec<Snap>,
    /// The one that has not ended with its stretch, and where equilibria are not stable.
    run: Option<(BegunSnap, Vec<[f64; 2]>)>,
    /// The last stretch.
    before: Option<SnapStretch>,
}

impl Snaps {
    /// The snaps, after the last stretch. The run in which the bodies come apart is not one of them.
    pub fn end(mut self, is_apart: bool, last: Option<&Moment>) -> Vec<Snap> {
        if let (Some((running, unstable)), Some(last), false) = (self.run.take(), last, is_apart) {
            self.push(running.ended([last.contact_radius, last.dissipated]), &unstable);
        }
        self.found
    }

    /// Adds those among the moments of a stretch of one motion at this rate of the control. At its beginning the edge would
    /// go at the speed `level` if it followed the equilibria; at held control that is 0. Between the radii `unstable`,
    /// equilibria are not stable. The speed is not `resolved` where the drive along the equilibria is less than the
    /// integrator resolves.
    pub fn add(
        &mut self,
        moments: &[Moment],
        motion: Motion,
        (rate, level, resolved): (f64, f64, bool),
        unstable: &[[f64; 2]],
    ) {
        let rests = RESTS[usize::from(!resolved)];
        let known = self
            .before
            .filter(|before| before.motion == motion && before.rate.total_cmp(&rate).is_eq() && rate != 0.0);
        let level = known.map_or(level, |before| before.level);
        let slow = if level > 0.0 { RUNS * level } else { f64::INFINITY };
        let level = level.max(f64::MIN_POSITIVE);
        let (mut least, mut is_settled) =
            known.map_or((level, false), |before| (before.least, before.is_settled));
        // Another rate does not end a snap as long as the edge is fast for it too; an edge that rests or turns round does.
        let goes_on = |(running, _): &(BegunSnap, Vec<[f64; 2]>)| {
            let [before, now] = [running.low.0.speed, moments.get(1).map_or(0.0, |at| at.speed)];
            before * now > 0.0 && now.abs() > FASTER * running.least.max(level)
        };
        let mut run = match self.run.take() {
            Some(known) if goes_on(&known) => {
                least = known.0.least.max(rests * level);
                Some(known.0)
            }
            Some((ended, unstable)) => {
                let at = moments.first().unwrap_or(&ended.low.0);
                self.push(ended.ended([at.contact_radius, at.dissipated]), &unstable);
                None
            }
            None => None,
        };
        for (i, pair) in moments.windows(2).enumerate() {
            let [a, b] = [&pair[0], &pair[1]];
            let speed = if resolved { b.speed.abs() } else { mean_speed(a, b) };
            let begun = |from, least| BegunSnap { from, top: top(moments, i + 1), low: (*b, speed), least };
            let Some(running) = &mut run else {
                if speed > FASTER * least {
                    run = Some(begun(crossing(a, b, FASTER * least), least));
                    continue;
                }
                // The edge is slow at first because it starts from rest.
                is_settled |= speed >= level || speed < a.speed.abs();
                least = if is_settled { least.min(speed).max(rests * level) } else { least };
                continue;
            };
            if b.speed.abs() > running.top {
                (running.top, running.low) = (top(moments, i + 1), (*b, speed));
            }
            if speed < running.low.1 {
                running.low = (*b, speed);
            }
            let (at, low) = running.low;
            if speed <= FASTER * least {
                let ended = running.ended(crossing(a, b, FASTER * least));
                self.push(ended, unstable);
                (run, least, is_settled) = (None, speed.max(rests * level), true);
            } else if low <= slow && FASTER * low < running.top && speed > FASTER * low {
                let ended = running.ended([at.contact_radius, at.dissipated]);
                self.push(ended, unstable);
                least = low.max(rests * level);
                run = Some(begun(crossing(a, b, FASTER * low), least));
            }
        }
        self.before = Some(SnapStretch { motion, rate, level, least, is_settled });
        self.run = run.map(|run| (run, unstable.to_vec()));
    }

    fn push(&mut self, snap: Snap, unstable: &[[f64; 2]]) {
        let crosses =
            |[inner, outer]: &[f64; 2]| *inner < snap.from.max(snap.to) && *outer > snap.from.min(snap.to);
        if (snap.from - snap.to).abs() > NO_WAY * snap.from && unstable.iter().any(crosses) {
            self.found.push(snap);
        }
    }
}

impl BegunSnap {
    fn ended(&self, to: SnapMark) -> Snap {
        Snap { from: self.from[0], to: to[0], top_speed: self.top, dissipated: to[1] - self.from[1] }
    }
}

/// The speed at a moment, or, if it is larger than at the moments beside it, the largest between these: that of a
/// parabola of its logarithm over the contact radius.
fn top(moments: &[Moment], at: usize) -> f64 {
    let here = moments[at].speed.abs();
    let Some([before, _, after]) =
        at.checked_sub(1).and_then(|first| moments.get(first..at + 2)?.first_chunk::<3>())
    else {
        return here;
    };
    let beside = [before, after].map(|moment| {
        let way = moment.contact_radius - moments[at].contact_radius;
        (way, ln(moment.speed.abs() / here) / way)
    });
    let [(x, slope), (other, other_slope)] = beside;
    // ln v = ln v₀ + b x + a x² through the three.
    let a = (slope - other_slope) / (x - other);
    let b = slope - a * x;
    let rise = -b * b / (4.0 * a);
    let is_top = slope * x <= 0.0 && other_slope * other <= 0.0 && a < 0.0 && rise.is_finite();
    if is_top { here * exp(rise) } else { here }
}

/// The mean speed from the moment `a` to `b`: where a slow edge follows the equilibria, its speed at a moment is only known to
/// the tolerance of the integrator, and can be nothing. In a snap of a slow pull nothing is left of the time between two
/// moments: there it is the speed at `b`.
fn mean_speed(a: &Moment, b: &Moment) -> f64 {
    /// Times are known to rounding: shorter ones than this share give no speed.
    const RESOLVED: f64 = 1e-6;
    let time = b.time - a.time;
    if time > RESOLVED * b.time { (b.contact_radius - a.contact_radius).abs() / time } else { b.speed.abs() }
}

/// Where between two moments the speed is `speed`.
fn crossing(a: &Moment, b: &Moment, speed: f64) -> SnapMark {
    let [from, to, at] = [a.speed.abs(), b.speed.abs(), speed].map(|v| ln(v.max(f64::MIN_POSITIVE)));
    let share = (at - from) / (to - from);
    let share = if share.is_finite() { share.clamp(0.0, 1.0) } else { 1.0 };
    let between = |a: f64, b: f64| a + share * (b - a);
    [between(a.contact_radius, b.contact_radius), between(a.dissipated, b.dissipated)]
}
