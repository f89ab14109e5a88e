//! What happens on a loop, and its states.

use super::balance::Held;
use crate::problem::Control;
use crate::quasistatic::{energy, equilibrium};

/// Which way the control goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
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

/// One state of a loop, in reduced units.
#[derive(Debug, Clone, PartialEq)]
pub struct PathState {
    /// The outermost edge, a length.
    pub contact_radius: f64,
    /// δ, a length.
    pub approach: f64,
    /// P, a force.
    pub force: f64,
    /// U, an energy: elastic, less γ times the contact area.
    pub energy: f64,
    /// Contacts as [inner, outer], lengths, from the axis outward; a disc is [0, s].
    pub contacts: Vec<[f64; 2]>,
    /// The contact area, a length squared.
    pub contact_area: f64,
    /// c: δ, P or Δ.
    pub control_value: f64,
    /// Which way the control goes.
    pub direction: Direction,
    /// The stable stretch it lies on, counted from 0.
    pub piece: usize,
}

impl PathState {
    /// The state of edges that are held.
    pub fn new(held: &Held, gamma: f64, direction: Direction, piece: usize) -> Self {
        let contacts = &held.state.contacts;
        Self {
            contact_radius: contacts.outermost(),
            approach: held.approach,
            force: held.force,
            energy: held.state.energy(held.approach, gamma),
            contacts: contacts.intervals(),
            contact_area: contacts.area(),
            control_value: held.control_value,
            direction,
            piece,
        }
    }

    /// The potential of bodies and device, that of bodies apart being 0 at the same control value; of a dead load U − Pδ.
    pub fn potential(&self, control: Control) -> f64 {
        energy::potential(control, self.force, &self.plain())
    }

    /// What a jump from here to `after` dissipates; `None` for a pull-off under a dead load.
    pub fn loss(&self, control: Control, after: Option<&Self>) -> Option<f64> {
        energy::loss(control, &self.plain(), after.map(Self::plain).as_ref())
    }

    fn plain(&self) -> equilibrium::State {
        equilibrium::State {
            contact_radius: self.contact_radius,
            approach: self.approach,
            force: self.force,
            energy: self.energy,
        }
    }
}

/// What happened.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum EventKind {
    /// The bodies, apart before, touch and jump into contact.
    FirstTouch,
    /// A crest outside the contacts touches.
    Touch,
    /// Edges ran outward from a limit point of loading.
    Advance,
    /// The control turned round.
    Turn,
    /// Edges ran inward from a limit point of unloading.
    Recede,
    /// The bodies came apart.
    PullOff,
    /// Two contacts became one without a jump.
    Merge,
    /// One contact became two without a jump.
    Split,
    /// A contact shrank to nothing without a jump.
    Vanish,
}

impl EventKind {
    /// Its name in results.
    pub fn name(self) -> &'static str {
        match self {
            Self::FirstTouch => "first-touch",
            Self::Touch => "touch",
            Self::Advance => "advance",
            Self::Turn => "turn",
            Self::Recede => "recede",
            Self::PullOff => "pull-off",
            Self::Merge => "merge",
            Self::Split => "split",
            Self::Vanish => "vanish",
        }
    }
}

/// What a jump passed on its way; neither its order nor its radii mean much, both depend on how fast edges move.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PassedKind {
    /// A crest touched.
    Touch,
    /// A gap closed.
    Merge,
    /// A contact went.
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
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Passed {
    /// What.
    pub kind: PassedKind,
    /// Where, a length.
    pub radius: f64,
}

/// One event of a loop.
#[derive(Debug, Clone, PartialEq)]
pub struct Event {
    /// What happened.
    pub kind: EventKind,
    /// Which way the control went.
    pub direction: Direction,
    /// c: δ, P or Δ.
    pub control_value: f64,
    /// Where a crest touched, contacts merged or split or one vanished, a length.
    pub radius: Option<f64>,
    /// The state before; `None` while the bodies were apart.
    pub before: Option<PathState>,
    /// The state after; `None` where they came apart.
    pub after: Option<PathState>,
    /// The energy lost, by the drop of the potential; `None` for a pull-off under a dead load.
    pub dissipated: Option<f64>,
    /// The same by the work that the edges leave over on their way; `None` where it was not asked for.
    pub dissipated_by_area: Option<f64>,
    /// What the jump passed.
    pub passed: Vec<Passed>,
}
