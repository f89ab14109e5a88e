//! Following stable states to what ends them: a limit point, a touch, the turn; with the areas on the way.

use super::balance::{Balance, HeldEdges};
use super::course::{Course, CourseEnd};
use super::error::PathError;
use super::event::Direction;
use super::point::{GROWTH, PathPoint, PathStep};
use super::stepped::{SingularSide, TakenStep};
use crate::annuli::ground::gauss;
use crate::annuli::{AnnuliError, MOST_POINTS_IN_ALL, points};
use crate::problem::{ContactKind, Control};
use crate::quasistatic::energy::Losses;

/// The most steps of a path.
const STEPS: usize = 200_000;

/// The first step of a stretch, in the units of the arc length.
pub const FIRST: f64 = 0.02;

/// The longest step of many, in the units of the arc length.
pub const LONGEST: f64 = 0.15;

/// The number of past points from which a step is predicted.
const PAST: usize = 2;

/// The way of a step is known once a state lies on it to this accuracy, in the units of the arc length: the balance of
/// loops then closes within 1e-8 of their losses.
const ON_THE_WAY: f64 = 1e-7;

/// Nodes for an area on a step at a corner.
const NODES_AT_CORNERS: usize = 12;

/// Above this share of the most points, a step that fails is taken to need more.
const NEARLY: f64 = 0.8;

/// The length of the step after one of this length from `before`, which is kept in `past` for its prediction.
pub(super) fn next_length(
    past: &mut Vec<PathPoint>,
    before: PathPoint,
    length: f64,
    side: SingularSide,
) -> f64 {
    if side != SingularSide::Smooth {
        past.clear();
        return FIRST;
    }
    past.push(before);
    past.drain(..past.len().saturating_sub(PAST));
    (GROWTH * length).min(LONGEST)
}

impl Course<'_, '_> {
    /// Follows stable states from `held` to what ends them.
    pub(super) fn stretch(&mut self, held: &HeldEdges) -> Result<(CourseEnd, HeldEdges), PathError> {
        let (balance, sense) = (self.balance, self.record.direction.sense());
        let lost = PathError::Lost { control_value: held.control_value };
        let mut point = balance.point(held.clone(), sense).ok_or(lost)?;
        let (mut length, mut past) = (FIRST, Vec::new());
        loop {
            self.counted(&point.held)?;
            let taken = balance.step(&point, length, &past, &|next| !self.goes_back(&point, next));
            let mut taken = taken.ok_or_else(|| self.stopped(&point.held))?;
            let to_held = &taken.end.held;
            let forth = (to_held.control_value - point.held.control_value) * sense > 0.0;
            if taken.side == SingularSide::From && !(forth && Balance::least_eigenvalue(to_held) > 0.0) {
                // The limit point sits on the corner.
                return Ok((CourseEnd::Limit(taken.end.along_edges()), point.held));
            }
            length = taken.length;
            let end = self.ended(&mut taken)?;
            let TakenStep { step, length: taken, end: next, side } = taken;
            if side == SingularSide::Smooth {
                for extreme in self.extremes(&step, &point, (taken, &next)) {
                    self.record(&extreme.held);
                }
            }
            if self.setting.losses == Losses::Twice {
                self.record.area += self.area_of(&step, taken, &next, side);
            }
            self.record(&next.held);
            if let Some(end) = end {
                return Ok((end, next.held));
            }
            let before = std::mem::replace(&mut point, next.rescaled(balance));
            length = next_length(&mut past, before, length, side);
        }
    }

    /// Where δ or P has an extreme on a step, so that the smallest force of a path is that of one of its states.
    fn extremes(
        &self,
        step: &PathStep<'_, '_>,
        from: &PathPoint,
        (length, to): (f64, &PathPoint),
    ) -> Vec<PathPoint> {
        let slopes = |point: &PathPoint| self.balance.slopes(point);
        let [start, end] = [slopes(from), slopes(to)];
        // The controlled quantity has its extremes at the ends of stretches.
        let held = match self.balance.control {
            Control::Displacement => Some(0),
            Control::Force => Some(1),
            Control::Stiffness(_) => None,
        };
        let mut found: Vec<(f64, PathPoint)> = (0..2)
            .filter(|of| Some(*of) != held && start[*of] * end[*of] < 0.0)
            .filter_map(|of| step.located((length, to), start[of], &mut |point| Some(slopes(point)[of])))
            .collect();
        found.sort_by(|a, b| a.0.total_cmp(&b.0));
        found.into_iter().map(|(_, point)| point).collect()
    }

    /// Whether an edge moves back at the end of a step. Stable edges that adhere never do, because they ease each other.
    /// Beyond a limit point the control itself moves back, and with it the edges that the instability hardly moves:
    /// by no more than they had moved with the control before.
    fn goes_back(&self, from: &PathPoint, to: &PathPoint) -> bool {
        /// A part of the tangent that counts as zero.
        const NOTHING: f64 = 1e-9;
        /// How much the motion of an edge with the control may change within a step.
        const CHANGES: f64 = 2.0;
        let sense = self.record.direction.sense();
        let back = -to.along_control() / from.along_control();
        let back = if back.is_finite() { CHANGES * back.max(0.0) } else { 0.0 };
        let (before, after) = (from.along_edges(), to.along_edges());
        before
            .iter()
            .zip(&after)
            .any(|(before, after)| sense * after < -NOTHING - back * (sense * before).max(0.0))
    }

    /// Counts a step, and asks whether to go on.
    pub(super) fn counted(&mut self, held: &HeldEdges) -> Result<(), PathError> {
        self.steps += 1;
        if self.steps > STEPS {
            return Err(PathError::TooLong { steps: STEPS, control_value: held.control_value });
        }
        self.within_reach(held.approach, held.force)?;
        self.balance.progress.report(self.share(held));
        Ok(self.balance.progress.go_on()?)
    }

    /// Checks that all that could touch at an approach lies within the table, unless the gap ends with it.
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
    pub(super) fn stopped(&self, held: &HeldEdges) -> PathError {
        let (radius, known) = (held.state.contacts.outermost(), self.balance.ground.reach());
        let count = points(self.balance.ground, &held.state.contacts).count();
        if known - radius < 1e-3 * self.balance.ground.wave {
            PathError::BeyondGap { radius: known, approach: held.approach, force: held.force }
        } else if count as f64 > NEARLY * MOST_POINTS_IN_ALL as f64 {
            let error = AnnuliError::TooManyPoints { points: count, most: MOST_POINTS_IN_ALL };
            PathError::TooMany { error, approach: held.approach }
        } else {
            self.lost(held)
        }
    }

    /// How much of the path is done, roughly.
    fn share(&self, held: &HeldEdges) -> f64 {
        let share = self.turn.map_or(0.0, |turn| self.measure(held) / turn.value());
        let share = if share.is_finite() { share.clamp(0.0, 1.0) } else { 0.5 };
        match self.record.direction {
            Direction::Loading => 0.5 * share,
            Direction::Unloading => 1.0 - 0.5 * share,
        }
    }

    /// The first event on a step, which then ends there.
    fn ended(&self, taken: &mut TakenStep<'_, '_>) -> Result<Option<CourseEnd>, PathError> {
        let from = taken.step.from();
        let mut end = taken.to_limit()?.then(|| CourseEnd::Limit(taken.end.along_edges()));
        if self.record.direction == Direction::Unloading {
            let mut over =
                |point: &PathPoint| self.balance.nearest_to_moving(&point.held).map(|(_, over)| over);
            if over(&taken.end).is_some_and(|over| over > 0.0) {
                let lost = PathError::Lost { control_value: from.held.control_value };
                let at_start = over(from).ok_or(lost)?;
                if at_start >= 0.0 {
                    (taken.length, taken.end) = (0.0, from.clone());
                } else {
                    taken.to_root(at_start, &mut over)?;
                }
                end = Some(CourseEnd::Free);
            }
            return Ok(end);
        }
        end = taken.to_touch(false)?.map(CourseEnd::Touch).or(end);
        if let Some(turn) = self.turn.filter(|_| self.has_turned(&taken.end.held)) {
            let left = |point: &PathPoint| self.measure(&point.held) - turn.value();
            taken.to_root(left(from), &mut |point| Some(left(point)))?;
            end = Some(CourseEnd::Turn);
        }
        Ok(end)
    }

    /// ∫ (dΠ/dc) dc over a step; at a corner, in the square root of the distance from it.
    fn area_of(&self, step: &PathStep<'_, '_>, length: f64, next: &PathPoint, side: SingularSide) -> f64 {
        /// The last Newton step at the places of an area: their errors enter as products.
        const NEAR: f64 = 1e-9;
        if length <= 0.0 {
            return 0.0;
        }
        let by_force = self.setting.control == Control::Force;
        if side == SingularSide::Smooth {
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
                if side == SingularSide::From { [u * u, 2.0 * u] } else { [u * (2.0 - u), 2.0 * (1.0 - u)] };
            let Some((point, rate)) = step.within(length * share, &(&offset * share), NEAR) else {
                return f64::NAN;
            };
            let slope = if by_force { -point.held.approach } else { point.held.force };
            sum += 0.5 * length * weight * stretch * slope * rate[n] * step.unit();
        }
        sum
    }
}
