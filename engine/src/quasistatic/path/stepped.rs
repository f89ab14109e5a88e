//! One step along equilibria, past corners of the gap, and what ends it: a limit point of the control, or a touch.
//!
//! Where a contact covers a corner of the gap, κ varies as the square root of the distance from it. Arc length is no
//! measure there, but the motion of the edge is: by it the edge is led to the corner and slightly beyond.

use super::balance::Balance;
use super::error::PathError;
use super::point::{PathPoint, PathStep};
use crate::annuli::{Around, Contacts, GapMinimum};

/// The shortest step, in the units of the arc length.
const SHORTEST: f64 = 1e-9;

/// An edge this near to a corner, in waves, stands on it.
const ON: f64 = 1e-7;

/// How far beyond a corner the first state lies, in waves.
const BEYOND: f64 = 1e-3;

/// A step is led to a corner that lies within this many times its length, or within this many waves.
const AHEAD: f64 = 1.2;
const NEAREST: f64 = 2e-3;

/// How many times a step at a corner may be halved.
const HALVINGS: usize = 20;

/// A gap that counts as zero, in waves.
pub const ROUNDING: f64 = 1e-11;

/// A gap below zero by this many waves at the start of a step is no rounding.
const MISSED: f64 = 1e-6;

/// The most crests that may touch one after the other within a step.
const CRESTS: usize = 8;

/// If the least slope of the control within a step is below this share of the slopes at its ends, the slope may change
/// its sign there twice. Such places are examined in steps no shorter than this length.
const GRAZING: f64 = 0.05;
const LONG: f64 = 2e-3;

/// Where a step is singular.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SingularSide {
    /// Nowhere.
    Smooth,
    /// At its start, on a corner of the gap.
    From,
    /// At its end, on a corner of the gap or on the way there.
    Towards,
}

/// A step that was taken.
pub struct TakenStep<'a, 'b> {
    /// The step itself.
    pub step: PathStep<'a, 'b>,
    /// Its length, in its own measure.
    pub length: f64,
    /// Where it ends.
    pub end: PathPoint,
    /// Where it is singular.
    pub side: SingularSide,
}

impl<'b> Balance<'b> {
    /// The step from `from`, which the curve has reached through the points of `past`. It has the length asked for
    /// unless a bound makes it shorter; `None` where even the shortest breaks a bound. `fits` says whether it may end
    /// at a point.
    pub fn step<'a>(
        &'a self,
        from: &'a PathPoint,
        mut length: f64,
        past: &[PathPoint],
        fits: &dyn Fn(&PathPoint) -> bool,
    ) -> Option<TakenStep<'a, 'b>> {
        if let Some((edge, way, side)) = self.corner_ahead(from, length) {
            return self.led(from, edge, way, side);
        }
        let step = PathStep::new(self, from).after(past);
        length = step.foreseen(length);
        // An edge may have moved faster than its tangent said, or onto other equilibria: shorter steps see that
        // coming.
        let taken = |length: f64| step.taken(length).filter(|end| !self.crosses(from, end) && fits(end));
        while length >= SHORTEST {
            if let Some(end) = taken(length) {
                let nearer = Some(length).filter(|length| *length > LONG);
                let nearer = nearer.and_then(|length| step.grazes(length, &end));
                if let Some((length, end)) = nearer.and_then(|length| Some((length, taken(length)?))) {
                    return Some(TakenStep { step, length, end, side: SingularSide::Smooth });
                }
                return Some(TakenStep { step, length, end, side: SingularSide::Smooth });
            }
            length *= 0.5;
        }
        None
    }

    /// The step on which one edge goes the distance `way`, in waves, to a corner or from it.
    fn led<'a>(
        &'a self,
        from: &'a PathPoint,
        edge: usize,
        way: f64,
        side: SingularSide,
    ) -> Option<TakenStep<'a, 'b>> {
        let step = PathStep::of_edge(self, from, edge);
        let most = if side == SingularSide::From { 0.02 } else { 0.2 };
        let mut lengths = std::iter::successors(Some(way), |length| Some(0.5 * length)).take(HALVINGS);
        let (length, end) = lengths.find_map(|length| {
            let guess = step.line(length).map(|x| x.clamp(-most, most));
            step.to(length, &guess).map(|(end, _)| (length, end))
        })?;
        Some(TakenStep { step, length, end, side })
    }

    /// The edge that stands on a corner of the gap.
    pub fn on_corner(&self, contacts: &Contacts) -> Option<usize> {
        let (corners, margin) = (self.ground.stops(), ON * self.ground.wave);
        let is_on =
            |radius: f64| !self.is_pinned(radius) && corners.iter().any(|r| (r - radius).abs() <= margin);
        contacts.edges().iter().position(|edge| is_on(edge.radius))
    }

    /// The step away from a corner on which an edge of `from` stands; `None` where none does, or there is no state beyond.
    pub fn beyond_corner<'a>(&'a self, from: &'a PathPoint) -> Option<TakenStep<'a, 'b>> {
        self.led(from, self.on_corner(from.contacts())?, BEYOND, SingularSide::From)
    }

    /// The edge that stands on a corner of the gap or meets one within a step of this length, and how far it is led, in waves.
    fn corner_ahead(&self, point: &PathPoint, length: f64) -> Option<(usize, f64, SingularSide)> {
        let ground = self.ground;
        let corners = ground.stops();
        if corners.is_empty() {
            return None;
        }
        if let Some(edge) = self.on_corner(point.contacts()) {
            return Some((edge, BEYOND, SingularSide::From));
        }
        let edges = point.contacts().edges();
        let moving = edges.iter().enumerate().filter(|(_, edge)| !self.is_pinned(edge.radius));
        let ahead = moving.filter_map(|(i, edge)| {
            let speed = point.tangent[i];
            let corner = if edge.sign * speed > 0.0 {
                corners.iter().find(|r| **r > edge.radius)?
            } else {
                corners.iter().rev().find(|r| **r < edge.radius)?
            };
            let way = (corner - edge.radius).abs() / point.scales.edges[i];
            let near = way <= AHEAD * (speed.abs() * length).max(NEAREST);
            near.then_some((i, way, way / speed.abs()))
        });
        ahead.min_by(|a, b| a.2.total_cmp(&b.2)).map(|(i, way, _)| (i, way, SingularSide::Towards))
    }

    /// Whether an edge meets a corner of the gap between two points, other than one on which it stands at first.
    fn crosses(&self, from: &PathPoint, to: &PathPoint) -> bool {
        let (corners, margin) = (self.ground.stops(), ON * self.ground.wave);
        let edges = from.contacts().edges().into_iter().zip(to.contacts().edges());
        edges.into_iter().any(|(a, b)| {
            let (lo, hi) = (a.radius.min(b.radius), a.radius.max(b.radius));
            corners.iter().any(|r| *r > lo && *r < hi && (r - a.radius).abs() > margin)
        })
    }

    /// The least gap near a crest, at a point; `reach` is half the width in which the crest is followed.
    fn near(&self, point: &PathPoint, crest: GapMinimum, reach: f64) -> GapMinimum {
        let around = Around::new(self.ground, &point.held.state, point.held.approach);
        if crest.radius > 0.0 {
            around.minimum([(crest.radius - reach).max(0.0), crest.radius + reach])
        } else {
            GapMinimum { radius: 0.0, gap: around.gap(0.0) }
        }
    }
}

impl PathStep<'_, '_> {
    /// Where on the step up to `end` the slope of the control is least, if it may change its sign there and back; from
    /// the cubic that has the control and its slope at both ends.
    fn grazes(&self, length: f64, end: &PathPoint) -> Option<f64> {
        let last = end.tangent.len() - 1;
        let [first, second] = [self.line(1.0)[last], self.rate_of(end)[last]];
        let mean = self.offset(end)[last] / length;
        let sign = first.signum();
        let bend = sign * (3.0 * (first + second) - 6.0 * mean);
        let fall = sign * (4.0 * first + 2.0 * second - 6.0 * mean);
        let at = 0.5 * fall / bend;
        let least = sign * first - 0.5 * fall * at;
        let may = first * second > 0.0 && bend > 0.0 && at > 0.0 && at < 1.0;
        (may && least < GRAZING * first.abs().max(second.abs())).then_some(at * length)
    }
}

impl TakenStep<'_, '_> {
    /// Ends the step where the control turns on it; returns whether it does.
    ///
    /// # Errors
    /// [`PathError::Lost`].
    pub fn to_limit(&mut self) -> Result<bool, PathError> {
        let slope = |point: &PathPoint| point.along_control();
        let at_start = slope(self.step.from());
        if at_start * slope(&self.end) > 0.0 {
            return Ok(false);
        }
        self.to_root(at_start, &mut |point| Some(slope(point)))?;
        Ok(true)
    }

    /// Ends the step where `measure` vanishes, which is `at_start` at its start and of the other sign at its end.
    ///
    /// # Errors
    /// [`PathError::Lost`].
    pub fn to_root(
        &mut self,
        at_start: f64,
        measure: &mut dyn FnMut(&PathPoint) -> Option<f64>,
    ) -> Result<(), PathError> {
        let lost = PathError::Lost { control_value: self.step.from().held.control_value };
        (self.length, self.end) =
            self.step.located((self.length, &self.end), at_start, measure).ok_or(lost)?;
        Ok(())
    }

    /// Ends the step where the first crest touches on it. Where a walk goes on `past` touches, a crest that touches or overlaps at the
    /// start is left out.
    ///
    /// # Errors
    /// [`PathError::Lost`].
    pub fn to_touch(&mut self, past: bool) -> Result<Option<GapMinimum>, PathError> {
        let (balance, from) = (self.step.balance(), self.step.from());
        let wave = balance.ground.wave;
        let at_start = |crest: GapMinimum| balance.near(from, crest, wave / 14.0);
        let mut touched = None;
        // Finds the crest that touches first: each is followed to its own touch. What is left there of the previous
        // overlap is rounding.
        let mut overlap = 0.0;
        for _ in 0..CRESTS {
            let crest = if past {
                let mut crests = balance.crests(&self.end.held)?;
                crests.retain(|crest| crest.gap < overlap && at_start(*crest).gap > ROUNDING * wave);
                crests.into_iter().min_by(|a, b| a.gap.total_cmp(&b.gap))
            } else {
                balance.least_gap(&self.end.held)?.filter(|crest| crest.gap < overlap)
            };
            let Some(crest) = crest else { break };
            overlap = -ROUNDING * wave;
            let mut at = at_start(crest);
            let first = at.gap;
            if first < -MISSED * wave {
                // An earlier step went past the touch: nothing that is found here is right.
                return Err(PathError::Lost { control_value: from.held.control_value });
            }
            if first.is_nan() || first <= 0.0 {
                // Rounding: the start of the step touches.
                (self.length, self.end) = (0.0, from.clone());
                return Ok(Some(at));
            }
            self.to_root(first, &mut |point| {
                at = balance.near(point, at, wave / 28.0);
                Some(at.gap)
            })?;
            touched = Some(at);
        }
        Ok(touched)
    }
}
