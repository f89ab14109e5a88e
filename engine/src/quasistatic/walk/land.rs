//! Where edges land when they run at held control, with the rings that they make on the way.

use super::arrival::{Ahead, Arrival, Emit, Reached, WalkEnd, WalkFailure, Walked};
use super::edges;
use super::walker::{At, Walk};
use crate::annuli::{AnnuliError, Contacts, Ground};
use crate::problem::Control;
use crate::progress::Unwatched;
use crate::quasistatic::path::course::Course;
use crate::quasistatic::path::{Balance, Direction, HeldEdges, PassedKind, PathError, PathSetting};
use crate::quasistatic::{Event, EventKind, State, StatePoint};

/// A jump, and where it lands.
pub(super) struct Jumped {
    pub ground: Ground,
    /// None where the bodies come apart.
    pub held: Option<HeldEdges>,
    /// None without adhesion, where nothing runs and nothing is lost.
    pub event: Option<Event>,
    after: Option<State>,
}

impl Jumped {
    fn of(balance: &Balance<'_>, held: Option<HeldEdges>, event: Option<Event>) -> Self {
        let after = held.as_ref().map(|held| edges::state(held, balance.work_of_adhesion));
        Self { ground: balance.ground.clone(), held, event, after }
    }

    /// Whether a crest touched on the way.
    pub fn has_touched(&self) -> bool {
        let passed = self.event.iter().flat_map(|event| &event.passed);
        passed.into_iter().any(|passed| passed.kind == PassedKind::Touch)
    }

    /// Where it lands, and what it costs.
    pub fn ahead(&self) -> Ahead {
        let dissipated = self.event.as_ref().map_or(Some(0.0), |event| event.dissipated);
        Ahead { after: self.after, dissipated }
    }
}

impl Walk<'_> {
    /// The state of a disc, with what is known about it.
    pub(super) fn of_disc(&self, arrival: Arrival, point: StatePoint) -> Reached {
        let equilibrium = self.equilibrium();
        let (state, stiffness) = equilibrium.state_and_stiffness(&point);
        Reached {
            arrival,
            stability: equilibrium.stability(&point),
            stiffness,
            admissibility: equilibrium.admissibility(&point, &Unwatched),
            digits: equilibrium.basis.trusted_digits(&equilibrium.problem, state.contact_radius),
            state,
            point,
            on_path: None,
        }
    }

    /// The state of a point with rings, with what is known about it.
    pub(super) fn of_rings(&self, ground: &Ground, arrival: Arrival, point: StatePoint) -> Option<Reached> {
        let equilibrium = self.equilibrium();
        let balance = self.balance(ground, Control::Displacement);
        let held = edges::held(&balance, &equilibrium.scales, &point)?;
        let judged = edges::judged(equilibrium, ground, &point, &held);
        let edges::Judged { state, stability, stiffness, admissibility, digits } = judged;
        Some(Reached { arrival, point, state, stability, stiffness, admissibility, digits, on_path: None })
    }

    /// The landed edges as a state: one disc, or more.
    pub(super) fn landed(
        &self,
        balance: &Balance<'_>,
        arrival: Arrival,
        held: HeldEdges,
    ) -> Result<Reached, WalkFailure> {
        let missing = WalkFailure::NoEquilibrium("at the landing");
        let (contacts, scales) = (&held.state.contacts, &self.equilibrium().scales);
        if contacts.rings.is_empty() {
            let point = self.equilibrium().explicit(contacts.disc).ok_or(missing)?;
            return Ok(self.of_disc(arrival, point));
        }
        let point = edges::shrinking(balance, held).ok_or(missing.clone())?;
        self.of_rings(balance.ground, arrival, edges::kept(balance, scales, &point)).ok_or(missing)
    }

    /// The balance of edges that run. Without adhesion a ring begins with no width, a little further on.
    pub(super) fn running<'a>(&self, ground: &'a Ground) -> Balance<'a> {
        let adheres = self.equilibrium().problem.work_of_adhesion > 0.0;
        self.balance(ground, if adheres { self.control } else { Control::Displacement })
    }

    /// What `run` finds on as much of the gap as it needs.
    fn ran<T>(
        &self,
        [radius, delta]: [f64; 2],
        run: &dyn Fn(&Ground) -> Result<T, PathError>,
        jumped: &dyn Fn(&T) -> Option<&Jumped>,
    ) -> Result<T, WalkFailure> {
        let after = |found: &T| jumped(found).and_then(|jumped| jumped.after);
        let highest = |found: &T| after(found).map_or(f64::NEG_INFINITY, |after| after.approach);
        self.on_ground(radius, delta, run, &highest).map_err(|error| match error {
            PathError::BeyondGap { .. } | PathError::State(AnnuliError::BeyondGap { .. }) => {
                WalkFailure::NothingOutward
            }
            PathError::NeverTouches { .. } => WalkFailure::NeverTouches,
            error => WalkFailure::Edges(error.to_string()),
        })
    }

    /// Lets the edges run: from a touch, with a ring; from a limit point, to the side on which the control cannot
    /// follow; from any other unstable state, in the direction of the walk.
    pub(super) fn try_rings(&self) -> Result<Jumped, WalkFailure> {
        let from = self.begun("jump")?;
        let scales = &self.equilibrium().scales;
        let [delta, _] = edges::device(scales, from);
        let radius = edges::contacts(scales, from).outermost();
        let found = self.ran([radius, delta], &|ground| self.jumped(ground, from), &Option::as_ref)?;
        found.ok_or(WalkFailure::Stable)
    }

    /// The same on the gap as far as `ground` goes; `None` where nothing runs.
    fn jumped(&self, ground: &Ground, from: &StatePoint) -> Result<Option<Jumped>, PathError> {
        let scales = &self.equilibrium().scales;
        let (balance, contacts) = (self.running(ground), edges::contacts(scales, from));
        let lost = PathError::Lost { control_value: f64::NAN };
        let before = edges::held(&balance, scales, from).ok_or(lost)?;
        let setting = PathSetting::new(balance.control);
        let (kind, direction, start, radius) = if let At::Touch(radius) = self.at {
            let direction = Direction::Loading;
            if balance.work_of_adhesion == 0.0 {
                let mut course = Course::new(&balance, &setting, direction);
                let held = course.begun(&contacts, radius, before.approach)?;
                return Ok(Some(Jumped::of(&balance, Some(held), None)));
            }
            let start = balance.seeded(&contacts, radius, before.control_value)?;
            (EventKind::Touch, direction, start, Some(radius))
        } else {
            let (null, outward) = if self.at == At::Limit {
                // Beyond a maximum of the control there is no state nearby with a larger contact; beyond a minimum,
                // none with a smaller one. On a corner of the gap there is no bend, but a slope on the side towards
                // the axis: stored tangents run inward.
                let on_corner = balance.on_corner(&contacts).is_some();
                let bend = if on_corner { from.tangent() } else { from.curvature() };
                (edges::growth(from), edges::of_control(balance.control, scales, &bend) < 0.0)
            } else {
                let least = Balance::least_eigenvalue(&before);
                if least > 0.0 || least.is_nan() {
                    return Ok(None);
                }
                (Balance::softest(&before), !self.inward)
            };
            let (kind, direction) = if outward {
                (EventKind::SnapIn, Direction::Loading)
            } else {
                (EventKind::Snap, Direction::Unloading)
            };
            (kind, direction, balance.kicked(&contacts, &null, direction.sense()), None)
        };
        let mut course = Course::new(&balance, &setting, direction);
        let held = course.jump(kind, &before, start, radius)?;
        Ok(Some(Jumped::of(&balance, held, course.record.events.pop())))
    }

    /// The first touch of bodies that were apart, and the state it jumps to: where a walk that starts apart begins.
    ///
    /// # Errors
    /// [`WalkFailure`] where the gap has no least value, or the edges do not land.
    pub fn first_touch(&self, emit: &mut Emit<'_>) -> Walked {
        let first = |ground: &Ground| {
            let balance = self.running(ground);
            let setting = PathSetting::new(balance.control);
            let mut course = Course::new(&balance, &setting, Direction::Loading);
            let (crest, value) = course.first_crest()?;
            let held = if balance.work_of_adhesion > 0.0 {
                course.first_touch(crest, value)?
            } else {
                course.begun(&Contacts::default(), crest.radius, crest.gap)?
            };
            Ok((crest, Jumped::of(&balance, Some(held), None)))
        };
        let (crest, jumped) = self.ran([self.range[0], 0.0], &first, &|(_, jumped)| Some(jumped))?;
        let held = jumped.held.ok_or(WalkFailure::NoEquilibrium("after the first touch"))?;
        emit(self.landed(&self.running(&jumped.ground), Arrival::Touch(crest.radius), held)?);
        Ok(WalkEnd::Done)
    }
}
