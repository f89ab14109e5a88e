//! What a loop is asked for, and what it answers.

use super::balance::Held;
use super::error::Warning;
use super::event::{Event, PathState};
use super::jump::Mobility;
use crate::problem::{Control, Turn};

/// What the turn is measured by, of edges at a control value.
pub(super) fn measure(turn: Turn, held: &Held, control: Control) -> f64 {
    match turn {
        Turn::Approach(_) => held.approach,
        Turn::Force(_) => held.force,
        Turn::Radius(_) => held.state.contacts.outermost(),
        Turn::Control(_) => control.value(held.approach, held.force),
    }
}

/// Whether losses are computed by area as well.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Areas {
    /// By energy alone.
    No,
    /// Twice; the balance is checked.
    Yes,
}

/// What a loop is asked for.
#[derive(Clone, Copy)]
pub struct Setting<'a> {
    /// The device.
    pub control: Control,
    /// Where it turns round.
    pub turn: Turn,
    /// Whether losses are computed twice.
    pub areas: Areas,
    /// How fast edges move at a radius: nothing that lasts depends on it.
    pub mobility: Mobility<'a>,
}

/// Where the control turned round.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TurnReached {
    /// What was asked for.
    pub asked: Turn,
    /// What the state there has of it: more than asked for where loading jumped over it.
    pub reached: f64,
}

/// The sums of a loop; `None` where a dead load leaves no bound, or what was not asked for.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Totals {
    /// All losses.
    pub dissipated: Option<f64>,
    /// The same by area.
    pub dissipated_by_area: Option<f64>,
    /// The losses up to the pull-off, without it.
    pub dissipated_before_pull_off: f64,
    /// The work done by the device on the way up, its own elastic energy counted with the bodies.
    pub work_of_loading: f64,
    /// The same on the way down.
    pub work_of_unloading: Option<f64>,
    /// |Π(last) − Σ areas + Σ losses| over the losses or the work of loading, whichever is more, from the first touch to before the
    /// pull-off.
    pub balance: Option<f64>,
}

/// A whole loop, in reduced units.
#[derive(Debug, Clone, PartialEq)]
pub struct Path {
    /// What was controlled.
    pub control: Control,
    /// Where it turned.
    pub turn: TurnReached,
    /// The events in order.
    pub events: Vec<Event>,
    /// Stable states in order, dense enough to be drawn: those before and after events among them.
    pub states: Vec<PathState>,
    /// The sums.
    pub totals: Totals,
    /// What is to be known about it.
    pub warnings: Vec<Warning>,
}
