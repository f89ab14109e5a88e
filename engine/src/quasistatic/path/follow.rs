//! Following stable states to what ends them: a limit point, a touch, the turn; past corners of the gap; with the areas on the way.

use super::balance::{Balance, Held};
use super::course::{Course, End};
use super::error::PathError;
use super::event::Direction;
use super::point::{Point, Step};
use crate::annuli::ground::gauss;
use crate::annuli::{AnnuliError, Around, Crest, MOST_POINTS_IN_ALL, points};
use crate::problem::{ContactKind, Control};
use crate::quasistatic::energy::Losses;

/// Steps of a path at most.
const STEPS: usize = 200_000;

/// The first step of a stretch, the longest and the shortest, in the units of the arc length.
const FIRST: f64 = 0.02;
const LONGEST: f64 = 0.15;
const SHORTEST: f64 = 1e-9;

/// The way of a step is known where a state lies on it to this, in the units of the arc length: with it the balance of loops closes
/// within 1e-8 of their losses.
const ON_THE_WAY: f64 = 1e-7;

/// Nodes of an area on a step at a corner.
const NODES_AT_CORNERS: usize = 12;

/// With this share of the most points a step may ask for more.
const NEARLY: f64 = 0.8;

/// A gap that is nothing, in waves.
const ROUNDING: f64 = 1e-11;

/// Where a step is singular.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Side {
    Smooth,
    From,
    Towards,
}

impl Course<'_, '_> {
    /// Follows stable states from `held` to what ends them.
    pub(super) fn stretch(&mut self, held: &Held) -> Result<(End, Held), PathError> {
        let sense = self.record.direction.sense();
        let lost = PathError::Lost { control_value: held.control_value };
        let mut point = self.balance.point(held.clone(), sense).ok_or(lost)?;
        let (mut length, mut bend) = (FIRST, None);
        loop {
            self.counted(&point.held)?;
            if let Some((edge, way)) = self.corner_ahead(&point, length) {
                let (end, next) = self.past_corner(&point, edge, way)?;
                if let Some(end) = end {
                    return Ok((end, next.held));
                }
                (point, length, bend) = (next.rescaled(self.balance), FIRST, None);
                continue;
            }
            let step = Step::new(self.balance, &point).bent(bend.clone());
            let Some(next) = step.taken(length) else {
                length *= 0.5;
                if length < SHORTEST {
                    return Err(self.stopped(&point.held));
                }
                continue;
            };
            if self.crosses(&point, &next) || self.goes_back(&next) {
                // Faster than its tangent said, or on other equilibria: shorter steps see it coming.
                length *= 0.5;
                if length < SHORTEST {
                    return Err(self.stopped(&point.held));
                }
                continue;
            }
            let (length_taken, next, end) = self.ended(&step, &point, length, next)?;
            for extreme in self.extremes(&step, &point, (length_taken, &next)) {
                self.record(&extreme.held);
            }
            if self.setting.losses == Losses::Twice {
                self.record.area += self.area_of(&step, length_taken, &next, Side::Smooth);
            }
            self.record(&next.held);
            if let Some(end) = end {
                return Ok((end, next.held));
            }
            (point, bend) = step.left_at(length_taken, next);
            length = (1.5 * length).min(LONGEST);
        }
    }

    /// Where δ or P has an extreme on a step: the smallest force of a path is that of a state of it.
    fn extremes(&self, step: &Step<'_, '_>, from: &Point, (length, to): (f64, &Point)) -> Vec<Point> {
        let slopes = |point: &Point| self.balance.slopes(point);
        let [start, end] = [slopes(from), slopes(to)];
        // What is held has its extremes at the ends of stretches.
        let held = match self.balance.control {
            Control::Displacement => Some(0),
            Control::Force => Some(1),
            Control::Stiffness(_) => None,
        };
        let mut found: Vec<(f64, Point)> = (0..2)
            .filter(|of| Some(*of) != held && start[*of] * end[*of] < 0.0)
            .filter_map(|of| step.located((length, to), start[of], &mut |point| Some(slopes(point)[of])))
            .collect();
        found.sort_by(|a, b| a.0.total_cmp(&b.0));
        found.into_iter().map(|(_, point)| point).collect()
    }

    /// Whether an edge goes against the control: of stable edges that adhere none does, for they ease each other.
    fn goes_back(&self, at: &Point) -> bool {
        /// A part of the tangent that is nothing.
        const NOTHING: f64 = 1e-9;
        let sense = self.record.direction.sense();
        at.tangent.rows(0, at.held.excess.len()).iter().any(|part| part * sense < -NOTHING)
    }

    /// Whether an edge meets a corner of the gap between two points, one that it has not just left.
    fn crosses(&self, from: &Point, to: &Point) -> bool {
        let margin = 1e-7 * self.balance.ground.wave;
        let edges = from.contacts().edges().into_iter().zip(to.contacts().edges());
        edges.into_iter().any(|(a, b)| {
            let (lo, hi) = (a.radius.min(b.radius), a.radius.max(b.radius));
            self.balance
                .ground
                .stops()
                .iter()
                .any(|stop| *stop > lo && *stop < hi && (stop - a.radius).abs() > margin)
        })
    }

    /// The edge that meets a corner of the gap within a step of this length, and how far it is, in waves.
    fn corner_ahead(&self, point: &Point, length: f64) -> Option<(usize, f64)> {
        /// An edge that has just left a corner is not led back to it, nor beyond what a step is.
        const LEFT: f64 = 1e-7;
        let ground = self.balance.ground;
        let (wave, corners) = (ground.wave, ground.stops());
        let edges = point.contacts().edges();
        let moving = edges.iter().enumerate().filter(|(_, edge)| !self.balance.is_pinned(edge.radius));
        let ahead = moving.filter_map(|(i, edge)| {
            let speed = point.tangent[i];
            let outward = edge.sign * speed > 0.0;
            let margin = LEFT * wave;
            let corner = if outward {
                corners.iter().find(|r| **r > edge.radius + margin)?
            } else {
                corners.iter().rev().find(|r| **r < edge.radius - margin)?
            };
            let way = (corner - edge.radius).abs() / point.scales.edges[i];
            (way <= 1.2 * (speed.abs() * length).max(2e-3)).then_some((i, way, way / speed.abs()))
        });
        ahead.min_by(|a, b| a.2.total_cmp(&b.2)).map(|(i, way, _)| (i, way))
    }

    /// Leads an edge to a corner of the gap and a little beyond, by its own way: where the contact covers a corner κ goes like the root of
    /// the distance from it.
    fn past_corner(
        &mut self,
        from: &Point,
        edge: usize,
        way: f64,
    ) -> Result<(Option<End>, Point), PathError> {
        /// How far beyond, in waves.
        const BEYOND_CORNER: f64 = 1e-3;
        let lost = || PathError::Lost { control_value: from.held.control_value };
        let sense = self.record.direction.sense();
        let step = Step::of_edge(self.balance, from, edge);
        let (mut at, mut target) = (None, way);
        for _ in 0..20 {
            at = step.to(target, &step.line(target).map(|x| x.clamp(-0.2, 0.2)));
            if at.is_some() {
                break;
            }
            target *= 0.5;
        }
        let (next, _) = at.ok_or_else(lost)?;
        let (length, corner, end) = self.ended(&step, from, target, next)?;
        if self.setting.losses == Losses::Twice {
            self.record.area += self.area_of(&step, length, &corner, Side::Towards);
        }
        self.record(&corner.held);
        if end.is_some() || target < way {
            return Ok((end, corner));
        }
        let corner = corner.rescaled(self.balance);
        let step = Step::of_edge(self.balance, &corner, edge);
        let (mut beyond, mut length) = (None, BEYOND_CORNER);
        for _ in 0..20 {
            beyond = step.to(length, &step.line(length).map(|x| x.clamp(-0.02, 0.02)));
            if beyond.is_some() {
                break;
            }
            length *= 0.5;
        }
        let (next, _) = beyond.ok_or_else(lost)?;
        let forth = (next.held.control_value - corner.held.control_value) * sense;
        if forth <= 0.0 || Balance::least_eigenvalue(&next.held) <= 0.0 {
            // The limit point sits on the corner.
            let edges = next.held.excess.len();
            let null = next.tangent.rows(0, edges).into_owned();
            return Ok((Some(End::Limit(null)), corner));
        }
        let (length, next, end) = self.ended(&step, &corner, length, next)?;
        if self.setting.losses == Losses::Twice {
            self.record.area += self.area_of(&step, length, &next, Side::From);
        }
        self.record(&next.held);
        Ok((end, next))
    }

    /// Counts a step, and asks whether to go on.
    pub(super) fn counted(&mut self, held: &Held) -> Result<(), PathError> {
        self.steps += 1;
        if self.steps > STEPS {
            return Err(PathError::TooLong { steps: STEPS, control_value: held.control_value });
        }
        self.within_reach(held.approach, held.force)?;
        self.balance.progress.report(self.share(held));
        if self.balance.progress.stop() { Err(PathError::Cancelled) } else { Ok(()) }
    }

    /// Whether all that could touch at an approach lies within the table, where the gap goes on.
    pub(super) fn within_reach(&self, approach: f64, force: f64) -> Result<(), PathError> {
        let ground = self.balance.ground;
        let ends = ground.reach() >= ground.table.end() * (1.0 - 1e-9);
        if ends
            || self.balance.contact == ContactKind::OneDisc
            || ground.can_touch_up_to(approach) < ground.reach()
        {
            return Ok(());
        }
        Err(PathError::BeyondGap { radius: ground.reach(), approach, force })
    }

    /// Why no further step could be taken.
    pub(super) fn stopped(&self, held: &Held) -> PathError {
        let (radius, known) = (held.state.contacts.outermost(), self.balance.ground.reach());
        let count = points(self.balance.ground, &held.state.contacts).count();
        if known - radius < 1e-3 * self.balance.ground.wave {
            PathError::BeyondGap { radius: known, approach: held.approach, force: held.force }
        } else if count as f64 > NEARLY * MOST_POINTS_IN_ALL as f64 {
            let error = AnnuliError::TooManyPoints { points: count, most: MOST_POINTS_IN_ALL };
            PathError::TooMany { error, approach: held.approach }
        } else {
            PathError::Lost { control_value: held.control_value }
        }
    }

    /// How much of the path is done, roughly.
    fn share(&self, held: &Held) -> f64 {
        let share = self.turn.map_or(0.0, |turn| self.measure(held) / turn.value());
        let share = if share.is_finite() { share.clamp(0.0, 1.0) } else { 0.5 };
        match self.record.direction {
            Direction::Loading => 0.5 * share,
            Direction::Unloading => 1.0 - 0.5 * share,
        }
    }

    /// The first event on a step, which then ends there.
    fn ended(
        &self,
        step: &Step<'_, '_>,
        from: &Point,
        mut length: f64,
        mut next: Point,
    ) -> Result<(f64, Point, Option<End>), PathError> {
        let sense = self.record.direction.sense();
        let lost = || PathError::Lost { control_value: from.held.control_value };
        let mut end = None;
        if next.along_control() * sense <= 0.0 {
            let mut slope = |point: &Point| Some(point.along_control() * sense);
            (length, next) =
                step.located((length, &next), from.along_control() * sense, &mut slope).ok_or_else(lost)?;
            let edges = next.held.excess.len();
            end = Some(End::Limit(next.tangent.rows(0, edges).into_owned()));
        }
        if self.record.direction == Direction::Unloading {
            let mut over = |point: &Point| self.balance.nearest_to_moving(&point.held).map(|(_, over)| over);
            if over(&next).is_some_and(|over| over > 0.0) {
                let at_start = over(from).ok_or_else(lost)?;
                if at_start >= 0.0 {
                    return Ok((0.0, from.clone(), Some(End::Free)));
                }
                (length, next) = step.located((length, &next), at_start, &mut over).ok_or_else(lost)?;
                end = Some(End::Free);
            }
            return Ok((length, next, end));
        }
        let crest;
        (length, next, crest) = self.touching(step, from, length, next)?;
        end = crest.map(End::Touch).or(end);
        if let Some(turn) = self.turn.filter(|_| self.has_turned(&next.held)) {
            let mut left = |point: &Point| Some(self.measure(&point.held) - turn.value());
            let at_start = self.measure(&from.held) - turn.value();
            (length, next) = step.located((length, &next), at_start, &mut left).ok_or_else(lost)?;
            end = Some(End::Turn);
        }
        Ok((length, next, end))
    }

    /// The first crest that touches on a step, which then ends there.
    pub(super) fn touching(
        &self,
        step: &Step<'_, '_>,
        from: &Point,
        mut length: f64,
        mut next: Point,
    ) -> Result<(f64, Point, Option<Crest>), PathError> {
        let lost = || PathError::Lost { control_value: from.held.control_value };
        let mut touched = None;
        let ground = self.balance.ground;
        // The crest that touches first: each is brought to its own touch. What is left there of the one before is rounding.
        let mut overlap = 0.0;
        for _ in 0..8 {
            let crest = self.balance.least_gap(&next.held).filter(|crest| crest.gap < overlap);
            let Some(crest) = crest else { break };
            overlap = -ROUNDING * ground.wave;
            let mut at = crest;
            let mut reach = ground.wave / 14.0;
            let mut gap = |point: &Point| {
                let around = Around::new(ground, &point.held.state, point.held.approach);
                at = if crest.radius > 0.0 {
                    around.minimum([(at.radius - reach).max(0.0), at.radius + reach])
                } else {
                    Crest { radius: 0.0, gap: around.gap(0.0) }
                };
                reach = ground.wave / 28.0;
                Some(at.gap)
            };
            let at_start = gap(from).unwrap_or(f64::NAN);
            if at_start.is_nan() || at_start <= 0.0 {
                // Rounding: the start of the step touches.
                return Ok((0.0, from.clone(), Some(at)));
            }
            (length, next) = step.located((length, &next), at_start, &mut gap).ok_or_else(lost)?;
            touched = Some(at);
        }
        Ok((length, next, touched))
    }

    /// ∫ (dΠ/dc) dc over a step, in the root of the distance from a corner.
    fn area_of(&self, step: &Step<'_, '_>, length: f64, next: &Point, side: Side) -> f64 {
        /// What is left of an area's places: their errors enter as products.
        const NEAR: f64 = 1e-9;
        if length <= 0.0 {
            return 0.0;
        }
        let by_force = self.setting.control == Control::Force;
        if side == Side::Smooth {
            return step.way(length, next, by_force, ON_THE_WAY).map_or(f64::NAN, |way| {
                gauss(way.degree()).iter().fold(0.0, |sum, [x, weight]| {
                    let (value, rate) = way.at(0.5 * length * (1.0 + x));
                    let n = value.len() - 2;
                    sum + 0.5 * length * weight * value[n + 1] * rate[n] * step.unit()
                })
            });
        }
        let offset = step.offset(next);
        let n = offset.len() - 1;
        let mut sum = 0.0;
        for [x, weight] in gauss(NODES_AT_CORNERS) {
            let u = 0.5 * (1.0 + x);
            let [share, stretch] =
                if side == Side::From { [u * u, 2.0 * u] } else { [u * (2.0 - u), 2.0 * (1.0 - u)] };
            let Some((point, rate)) = step.within(length * share, &(&offset * share), NEAR) else {
                return f64::NAN;
            };
            let slope = if by_force { -point.held.approach } else { point.held.force };
            sum += 0.5 * length * weight * stretch * slope * rate[n] * step.unit();
        }
        sum
    }
}
