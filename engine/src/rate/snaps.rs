//! The snaps of a pull: stretches in which the edge is ten times as fast as at its slowest since the last snap, and
//! crosses unstable equilibria. Where it crosses none it follows the equilibria, however much its speed along them
//! changes.
//!
//! An edge that runs past a place where there was an equilibrium before is slow there too, but it rests only where it
//! is about as slow as along the equilibria; in between, the snap goes on.

use super::record::Moment;
use crate::elementary::ln;

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
struct BegunSnap {
    from: SnapMark,
    top: f64,
    /// The slowest moment after the top, and its speed.
    low: (Moment, f64),
}

/// The snaps among the moments of one stretch. At its beginning the edge would go at the speed `level` if it followed
/// the equilibria; at held control that is 0. The run in which the bodies come apart is not a snap. Between the radii
/// `unstable`, equilibria are not stable. The speed is not `resolved` where the drive along the
/// equilibria is less than the integrator resolves.
pub fn snaps(
    moments: &[Moment],
    (level, resolved): (f64, bool),
    ends_apart: bool,
    unstable: &[[f64; 2]],
) -> Vec<Snap> {
    let rests = RESTS[usize::from(!resolved)];
    let mut found = Vec::new();
    let slow = if level > 0.0 { RUNS * level } else { f64::INFINITY };
    let level = level.max(f64::MIN_POSITIVE);
    let (mut least, mut is_settled) = (level, false);
    let mut run: Option<BegunSnap> = None;
    for pair in moments.windows(2) {
        let [a, b] = [&pair[0], &pair[1]];
        let speed = if resolved { b.speed.abs() } else { mean_speed(a, b) };
        let Some(running) = &mut run else {
            if speed > FASTER * least {
                let from = crossing(a, b, FASTER * least);
                run = Some(BegunSnap { from, top: b.speed.abs(), low: (*b, speed) });
                continue;
            }
            // The edge is slow at first because it starts from rest.
            is_settled |= speed >= level || speed < a.speed.abs();
            least = if is_settled { least.min(speed).max(rests * level) } else { least };
            continue;
        };
        if b.speed.abs() > running.top {
            (running.top, running.low) = (b.speed.abs(), (*b, speed));
        }
        if speed < running.low.1 {
            running.low = (*b, speed);
        }
        let (at, low) = running.low;
        if speed <= FASTER * least {
            found.push(running.ended(crossing(a, b, FASTER * least)));
            (run, least, is_settled) = (None, speed.max(rests * level), true);
        } else if low <= slow && FASTER * low < running.top && speed > FASTER * low {
            found.push(running.ended([at.contact_radius, at.dissipated]));
            least = low.max(rests * level);
            let from = crossing(a, b, FASTER * low);
            run = Some(BegunSnap { from, top: b.speed.abs(), low: (*b, speed) });
        }
    }
    if let (Some(running), Some(last)) = (run.filter(|_| !ends_apart), moments.last()) {
        found.push(running.ended([last.contact_radius, last.dissipated]));
    }
    found.retain(|snap| {
        (snap.from - snap.to).abs() > NO_WAY * snap.from
            && unstable
                .iter()
                .any(|[inner, outer]| *inner < snap.from.max(snap.to) && *outer > snap.from.min(snap.to))
    });
    found
}

impl BegunSnap {
    fn ended(&self, to: SnapMark) -> Snap {
        Snap { from: self.from[0], to: to[0], top_speed: self.top, dissipated: to[1] - self.from[1] }
    }
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
