//! What happens on a path, and its states.

use super::balance::HeldEdges;
use crate::disc::{Edges, Local, Place, Solution};
use crate::problem::Control;
use crate::quasistatic::energy::{self, Losses};
use crate::quasistatic::{Stability, State};
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// Which way the control goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Direction {
    /// Up.
    Loading,
    /// Down.
    Unloading,
}

impl Direction {
    /// 1 or −1.
    pub fn sense(self) -> f64 {
        match self {
            Self::Loading => 1.0,
            Self::Unloading => -1.0,
        }
    }

    /// Its name in results.
    pub fn name(self) -> &'static str {
        match self {
            Self::Loading => "loading",
            Self::Unloading => "unloading",
        }
    }
}

/// One state of a path, in reduced units.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PathState {
    /// The outermost edge of contact, a length; 0 where a zone holds the bodies without contact.
    #[serde(with = "crate::exact")]
    pub contact_radius: f64,
    /// c, the outer edge of the zone of adhesion with a range, a length; `None` for adhesion without one.
    #[serde(with = "crate::exact")]
    pub zone: Option<f64>,
    /// δ, a length.
    #[serde(with = "crate::exact")]
    pub approach: f64,
    /// P, a force.
    #[serde(with = "crate::exact")]
    pub force: f64,
    /// U, an energy: elastic, minus γ times the contact area; on the way up, minus what that area gained in closing.
    #[serde(with = "crate::exact")]
    pub energy: f64,
    /// Contacts as [inner, outer], lengths, from the axis outward; a disc is [0, s].
    #[serde(with = "crate::exact")]
    pub contacts: Vec<[f64; 2]>,
    /// The contact area, a length squared.
    #[serde(with = "crate::exact")]
    pub contact_area: f64,
    /// dP/dδ while all edges are held, a force over a length: 2E*s for a disc.
    #[serde(with = "crate::exact")]
    pub held_stiffness: f64,
    /// Whether the device can hold it: not at a limit point, from which edges run.
    pub stable: bool,
    /// dδ/ds and dP/ds along the equilibria of one disc, or with respect to the outer edge of its zone; only where the
    /// state was found on them and no edge is on a corner.
    pub slopes: Option<Stability>,
    /// c: δ, P or Δ.
    #[serde(with = "crate::exact")]
    pub control_value: f64,
    /// Which way the control goes.
    pub direction: Direction,
    /// The stable stretch it lies on, counted from 0.
    pub piece: usize,
}

impl PathState {
    /// The state of edges that are held.
    pub fn new(held: &HeldEdges, gamma: f64, direction: Direction, piece: usize) -> Self {
        let contacts = &held.state.contacts;
        Self {
            contact_radius: contacts.outermost(),
            zone: None,
            approach: held.approach,
            force: held.force,
            energy: held.state.energy(held.approach, gamma),
            contacts: contacts.intervals(),
            contact_area: contacts.area(),
            held_stiffness: held.state.force[1],
            stable: true,
            slopes: None,
            control_value: held.control_value,
            direction,
            piece,
        }
    }

    /// The state of one disc at a place of its equilibria, under a device.
    pub fn of_disc(solution: &dyn Solution, place: Place, control: Control, direction: Direction) -> Self {
        let at = solution.at(place);
        let Local { approach, force, .. } = at;
        let Edges { contact_radius: s, zone } = solution.edges(place);
        Self {
            contact_radius: s,
            zone,
            approach,
            force,
            energy: solution.energy(place),
            contacts: if s > 0.0 || zone.is_none() { vec![[0.0, s]] } else { Vec::new() },
            contact_area: PI * s * s,
            held_stiffness: 2.0 * s,
            stable: true,
            slopes: Some(at.stability())
                .filter(|slopes| slopes.approach.is_finite() && slopes.force.is_finite()),
            control_value: control.value(approach, force),
            direction,
            piece: 0,
        }
    }

    /// The potential of bodies and device, relative to bodies apart at the same control value; under a dead load,
    /// U − Pδ.
    pub fn potential(&self, control: Control) -> f64 {
        energy::potential(control, self.force, &self.state())
    }

    /// What a jump from here to `after` dissipates; `None` for a last contact under a dead load.
    pub fn loss(&self, control: Control, after: Option<&Self>) -> Option<f64> {
        energy::loss(control, &self.state(), after.map(Self::state).as_ref())
    }

    /// The number of rings of contact.
    pub fn rings(&self) -> usize {
        self.contacts.iter().filter(|[inner, _]| *inner > 0.0).count()
    }

    /// Its outermost edge, δ, P and U.
    pub fn state(&self) -> State {
        State {
            contact_radius: self.contact_radius,
            approach: self.approach,
            force: self.force,
            energy: self.energy,
        }
    }
}

/// What happened.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum EventKind {
    /// The bodies, out of range of each other before, come within range and jump into a zone.
    JumpIn,
    /// The bodies, without contact before, touch and jump into contact; in a zone they may touch without a jump.
    FirstTouch,
    /// A crest outside the contacts touches; with adhesion edges run then.
    Touch,
    /// Two contacts become one without a jump.
    Merge,
    /// Edges run outward from a limit point of the control.
    SnapIn,
    /// Edges run inward from a limit point of the control.
    Snap,
    /// The contact ends: the bodies come apart, or a zone alone holds them.
    LastContact,
    /// The zone ends, with its contact where it has one: the bodies come apart.
    SnapOff,
    /// One contact becomes two without a jump.
    Split,
    /// A contact shrinks to nothing without a jump.
    Vanish,
    /// The control turns round.
    Turn,
    /// An edge that was held since the control turned round begins to move: its G has come to γ.
    Depin,
}

impl EventKind {
    /// All of them.
    pub const ALL: [Self; 12] = [
        Self::JumpIn,
        Self::FirstTouch,
        Self::Touch,
        Self::Merge,
        Self::SnapIn,
        Self::Snap,
        Self::LastContact,
        Self::SnapOff,
        Self::Split,
        Self::Vanish,
        Self::Turn,
        Self::Depin,
    ];

    /// Its name in results.
    pub fn name(self) -> &'static str {
        match self {
            Self::JumpIn => "jump-in",
            Self::FirstTouch => "first-touch",
            Self::Touch => "touch",
            Self::Merge => "merge",
            Self::SnapIn => "snap-in",
            Self::Snap => "snap",
            Self::LastContact => "last-contact",
            Self::SnapOff => "snap-off",
            Self::Split => "split",
            Self::Vanish => "vanish",
            Self::Turn => "turn",
            Self::Depin => "depin",
        }
    }

    /// Whether it begins at a limit point of the control, from which edges run.
    pub fn begins_at_limit(self) -> bool {
        matches!(self, Self::SnapIn | Self::Snap | Self::LastContact | Self::SnapOff)
    }
}

/// What a jump passed on its way. Neither its order nor its radii mean much: both depend on how fast edges move.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum PassedKind {
    /// A crest touched.
    Touch,
    /// A gap closed.
    Merge,
    /// A contact vanished.
    Vanish,
}

impl PassedKind {
    /// Its name in results.
    pub fn name(self) -> &'static str {
        match self {
            Self::Touch => "touch",
            Self::Merge => "merge",
            Self::Vanish => "vanish",
        }
    }
}

/// Something a jump passed.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Passed {
    /// What.
    pub kind: PassedKind,
    /// Where, a length.
    #[serde(with = "crate::exact")]
    pub radius: f64,
}

/// One event of a path.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Event {
    /// What happened.
    pub kind: EventKind,
    /// Which way the control went.
    pub direction: Direction,
    /// c: δ, P or Δ.
    #[serde(with = "crate::exact")]
    pub control_value: f64,
    /// Where a crest touched, contacts merged or split, one vanished, or an edge began to move, a length.
    #[serde(with = "crate::exact")]
    pub radius: Option<f64>,
    /// The state before; `None` while the bodies were apart.
    pub before: Option<PathState>,
    /// The state after; `None` where they came apart.
    pub after: Option<PathState>,
    /// The energy lost, by the drop of the potential; `None` for a last contact under a dead load.
    #[serde(with = "crate::exact")]
    pub dissipated: Option<f64>,
    /// The same from the work left over at the edges on their way; `None` where it was not asked for.
    #[serde(with = "crate::exact")]
    pub dissipated_by_area: Option<f64>,
    /// What the jump passed.
    pub passed: Vec<Passed>,
}

impl Event {
    /// Whether the bodies, held by contact or a zone before, are apart after it.
    pub fn separates(&self) -> bool {
        matches!(self.kind, EventKind::LastContact | EventKind::SnapOff) && self.after.is_none()
    }

    /// The jump of one disc at a limit point, at a held control, to where its edge lands; the last contact if it lands
    /// nowhere.
    pub fn of_disc(
        solution: &dyn Solution,
        control: Control,
        before: Place,
        landing: Option<Place>,
        losses: Losses,
    ) -> Self {
        let outward = landing.is_some_and(|to| (to.panel, to.x) > (before.panel, before.x));
        let direction = if outward { Direction::Loading } else { Direction::Unloading };
        let state = |place| PathState::of_disc(solution, place, control, direction);
        let (old, after) = (PathState { stable: false, ..state(before) }, landing.map(state));
        Self {
            kind: match (&after, outward) {
                (None, _) if old.zone.is_some() => EventKind::SnapOff,
                (None, _) => EventKind::LastContact,
                (Some(after), true) if old.contacts.is_empty() && !after.contacts.is_empty() => {
                    EventKind::FirstTouch
                }
                (Some(after), false) if after.contacts.is_empty() && !old.contacts.is_empty() => {
                    EventKind::LastContact
                }
                (Some(_), true) => EventKind::SnapIn,
                (Some(_), false) => EventKind::Snap,
            },
            direction,
            control_value: old.control_value,
            radius: None,
            dissipated: old.loss(control, after.as_ref()),
            dissipated_by_area: match losses {
                Losses::Once => None,
                Losses::Twice => energy::area(solution, control, before, landing),
            },
            before: Some(old),
            after,
            passed: Vec::new(),
        }
    }
}
