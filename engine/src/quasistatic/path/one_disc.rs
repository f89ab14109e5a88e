//! A path on the [`Lane`]: up to a touch, the turn or a limit point, and down until the bodies are apart.

use super::balance::{Balance, HeldEdges};
use super::course::{Course, CourseEnd, beyond};
use super::error::PathError;
use super::event::EventKind;
use super::lane::Lane;
use super::record::stop_of;
use super::setting::PathStop;
use crate::annuli::{Around, Contacts, GapMinimum, points};
use crate::disc::{Local, Place};
use crate::quasistatic::descent::stable_start;
use crate::quasistatic::jump::{self, EdgeDirection};
use crate::root::RootBracket;

/// A gap that counts as zero, in waves.
const TOUCHES: f64 = 1e-11;

impl Course<'_, '_> {
    /// The disc at a place, held at its own control value.
    fn disc(&self, at: &Local) -> Result<HeldEdges, PathError> {
        let contacts = Contacts::of_disc(at.contact_radius);
        let value = self.balance.control.value(at.approach, at.force);
        Ok(self.balance.held(&contacts, &points(self.balance.ground, &contacts), value)?)
    }

    /// Follows the disc `held` while the control goes up, to what ends its stable stretch; `None` where it is not on one.
    pub(super) fn rise(
        &mut self,
        lane: &Lane,
        held: &HeldEdges,
    ) -> Result<Option<(CourseEnd, HeldEdges)>, PathError> {
        let Lane { solution, monotone, .. } = lane;
        let Some(from) = stable_start(&**solution, monotone, held.state.contacts.disc) else {
            return Ok(None);
        };
        let stretch = &monotone.stretches[from.stretch];
        let turn = self.turn.and_then(|turn| lane.turns(turn, [from.place, stretch.outer]));
        let mut to = turn.unwrap_or(stretch.outer);
        let mut end = if turn.is_some() { CourseEnd::Turn } else { CourseEnd::Fold(from.stretch) };
        let at_end = self.disc(&solution.at(to))?;
        // What could touch may lie beyond the table.
        self.counted(&at_end)?;
        if let Some(crest) = self.balance.least_gap(&at_end)?.filter(|crest| crest.gap < 0.0) {
            let (place, crest) = self.touch_between(lane, [from.place, to], crest)?;
            (to, end) = (place, CourseEnd::Touch(crest));
        }
        let last = self.disc(&solution.at(to))?;
        self.counted(&last)?;
        self.record.along(lane, [from.place, to])?;
        if let Some(highest) = self.record.states.iter().max_by(|a, b| a.approach.total_cmp(&b.approach)) {
            self.within_reach(highest.approach, highest.force)?;
        }
        if matches!(end, CourseEnd::Fold(at) if at + 1 == monotone.stretches.len()) {
            // No limit point: the table ends.
            return Err(PathError::BeyondGap {
                radius: solution.reach(),
                approach: last.approach,
                force: last.force,
            });
        }
        Ok(Some((end, last)))
    }

    /// Where the gap outside first vanishes between two places, at the outer of which `crest` overlaps. Each crest is
    /// followed to its own touch; then the whole gap is searched for another that overlaps there.
    fn touch_between(
        &self,
        lane: &Lane,
        [from, mut to]: [Place; 2],
        mut crest: GapMinimum,
    ) -> Result<(Place, GapMinimum), PathError> {
        /// The most crests that may overlap one after the other.
        const CRESTS: usize = 8;
        for _ in 0..CRESTS {
            (to, crest) = self.touch_of(lane, [from, to], crest)?;
            let held = self.disc(&lane.solution.at(to))?;
            let rounding = -TOUCHES * self.balance.ground.wave;
            match self.balance.least_gap(&held)?.filter(|other| other.gap < rounding) {
                Some(other) => crest = other,
                None => break,
            }
        }
        Ok((to, crest))
    }

    /// Where the gap at one crest vanishes between two places.
    fn touch_of(
        &self,
        lane: &Lane,
        [from, to]: [Place; 2],
        crest: GapMinimum,
    ) -> Result<(Place, GapMinimum), PathError> {
        /// How far around its last place the crest is looked for, as a share of the gap's own length there.
        const NEAR: f64 = 1.0 / 14.0;
        let (solution, ground) = (&lane.solution, self.balance.ground);
        let [lo, hi] = [from, to].map(|place| solution.radius(place));
        let on = |s: f64| solution.place(s).unwrap_or(to);
        let (mut best, mut failed) = (crest, None);
        let mut gap = |s: f64| {
            let held = self.disc(&solution.at(on(s))).map_err(|error| failed = Some(error)).ok()?;
            let around = Around::new(ground, &held.state, held.approach);
            let near = NEAR * ground.length_at(best.radius);
            let found =
                around.minimum([(best.radius - near).max(s), (best.radius + near).min(ground.reach())]);
            if found.gap <= 0.0 {
                best = found;
            }
            (!self.balance.progress.stop()).then_some(found.gap)
        };
        let bracket = gap(lo).and_then(|below| RootBracket::new([lo, below], [hi, crest.gap]));
        let touch = bracket.and_then(|mut bracket| {
            bracket.close(4.0 * f64::EPSILON * hi, &mut gap)?;
            Some(bracket.end(false))
        });
        if let Some(error) = failed {
            return Err(error);
        }
        self.balance.progress.go_on()?;
        // If the first place already touches, it is the first touch.
        Ok((on(touch.unwrap_or(lo)), best))
    }

    /// Runs from the limit point at the outer end of a stretch to where the edge lands, with what touches on the way.
    pub(super) fn advance(
        &mut self,
        lane: &Lane,
        before: &HeldEdges,
        stretch: usize,
    ) -> Result<HeldEdges, PathError> {
        let value = lane.monotone.stretches[stretch].values[1];
        let landing =
            jump::run(&*lane.solution, &lane.monotone, stretch, value, EdgeDirection::Outward).ok().flatten();
        let ends = PathError::BeyondGap {
            radius: lane.solution.reach(),
            approach: before.approach,
            force: before.force,
        };
        let landed = self.disc(&lane.solution.at(landing.ok_or(ends)?.place))?;
        let mut passed = Vec::new();
        let value = before.control_value;
        // Contact is gained only once: what would have touched before the landing is in it, or touches there too.
        let landed = match self.balance.touched(&landed, value, &mut passed)? {
            Some(start) => self
                .balance
                .run(start, value, 1.0, self.setting.mobility, &mut passed)
                .map_err(|error| beyond(error, before.approach, before.force))?,
            None => Some(landed),
        };
        let landed = landed.ok_or(PathError::Lost { control_value: value })?;
        self.jumped(EventKind::SnapIn, Some(before), Some(&landed), None, passed);
        Ok(landed)
    }

    /// The way down of the disc `held`; `None` where it is on no stable stretch.
    pub(super) fn descend(&mut self, lane: &Lane, held: &HeldEdges) -> Result<Option<PathStop>, PathError> {
        let from = stable_start(&*lane.solution, &lane.monotone, held.state.contacts.disc);
        let Some(from) = from else { return Ok(None) };
        let descent = self.record.descend(lane, from, self.end)?;
        Ok(Some(stop_of(&descent)))
    }
}

impl Balance<'_> {
    /// The lane on which these contacts are followed, if they are one disc.
    pub(super) fn lane_of(&self, contacts: &Contacts) -> Option<&Lane> {
        self.lane.filter(|_| contacts.is_disc())
    }

    /// The disc to which a disc runs at the control value; `None` where it vanishes.
    ///
    /// # Errors
    /// Where the table ends before that.
    pub(super) fn disc_run(
        &self,
        lane: &Lane,
        disc: &Contacts,
        value: f64,
        run: EdgeDirection,
    ) -> Result<Option<HeldEdges>, PathError> {
        let held = |contacts: &Contacts| self.held(contacts, &points(self.ground, contacts), value);
        match (lane.landing(disc.disc, value, run), run) {
            (Some(s), _) => Ok(Some(held(&Contacts::of_disc(s))?)),
            (None, EdgeDirection::Inward) => Ok(None),
            (None, EdgeDirection::Outward) => {
                let HeldEdges { approach, force, .. } = held(disc)?;
                Err(PathError::BeyondGap { radius: self.ground.reach(), approach, force })
            }
        }
    }
}
