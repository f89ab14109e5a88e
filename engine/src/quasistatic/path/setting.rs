//! What is asked of a path, and what it returns.

use super::balance::HeldEdges;
use super::error::{Warning, beyond_zone};
use super::event::{Direction, Event, EventKind, PathState};
use super::jump::{EVEN, Mobility};
use crate::problem::{ContactKind, Control, Printer, Turn};
use crate::quasistatic::State;
use crate::quasistatic::curve::CurveStop;
use crate::quasistatic::energy::Losses;
use crate::quasistatic::places::Detail;
use crate::zone::FaultKind;

/// The value by which a turn is measured, for edges at a control value.
pub(super) fn measure(turn: Turn, held: &HeldEdges, control: Control) -> f64 {
    match turn {
        Turn::Approach(_) => held.approach,
        Turn::Force(_) => held.force,
        Turn::Radius(_) => held.state.contacts.outermost(),
        Turn::Control(_) => control.value(held.approach, held.force),
    }
}

/// What is asked of a path.
#[derive(Clone, Copy)]
pub struct PathSetting<'a> {
    /// The device.
    pub control: Control,
    /// Which contacts are followed.
    pub contact: ContactKind,
    /// `γ_a`, what a closing edge gains, where that is less than γ, the cost of an opening edge; `None` where both are
    /// the same.
    pub closing: Option<f64>,
    /// Whether losses are computed twice.
    pub losses: Losses,
    /// How many states of one disc are recorded.
    pub detail: Detail,
    /// How fast edges move at a radius; no landing depends on it.
    pub mobility: Mobility<'a>,
}

impl PathSetting<'static> {
    /// Contact in rings wherever it appears, losses computed twice, enough states to draw.
    #[must_use]
    pub fn new(control: Control) -> Self {
        let (contact, losses, detail) = (ContactKind::Rings, Losses::Twice, Detail::Drawn);
        Self { control, contact, closing: None, losses, detail, mobility: EVEN }
    }

    /// The same for one disc alone.
    #[must_use]
    pub fn one_disc(control: Control) -> Self {
        Self { contact: ContactKind::OneDisc, ..Self::new(control) }
    }
}

impl PathSetting<'_> {
    /// What a closing edge gains where an opening one costs `gamma`; `None` where that is not less.
    pub fn closing_below(&self, gamma: f64) -> Option<f64> {
        self.closing.filter(|closing| *closing < gamma)
    }
}

/// Where the control turned round.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TurnReached {
    /// What was asked for.
    pub asked: Turn,
    /// The value in the state there: more than asked for where loading jumped over it.
    pub reached: f64,
}

/// A state that was asked for, but from which the edge first ran outward.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AskedState {
    /// The state.
    pub state: State,
    /// Why it ran.
    pub why: WhyNot,
}

/// Why a path does not start from the state asked for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum WhyNot {
    /// It is unstable. Whether the potential falls all the way to the start: if not, the edge does not run there by itself.
    Unstable {
        /// Whether it falls.
        falls: bool,
    },
    /// A crest outside it would overlap at this radius, a length.
    Overlaps(f64),
    /// Without adhesion the bodies would pull at each other at this radius, a length.
    Pulls(f64),
}

/// Why a path ended.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error("{}", self.words(&Printer::reduced()))]
pub enum PathStop {
    /// The bodies came apart.
    Apart,
    /// The end contact radius was reached in a stable state.
    End,
    /// The curve ends before that.
    Curve(CurveStop),
    /// The next state of adhesion with a range is not one disc in one zone: where, and δ and P there, as in
    /// [`PathError::BeyondZone`](super::PathError::BeyondZone).
    BeyondZone {
        /// What else there is.
        kind: Option<FaultKind>,
        /// Where, a length.
        radius: f64,
        /// δ.
        approach: f64,
        /// P.
        force: f64,
    },
}

impl PathStop {
    /// Why, in words.
    pub fn words(&self, printer: &Printer) -> String {
        match self {
            Self::Apart => "the bodies are apart".to_owned(),
            Self::End => "the end contact radius was reached in a stable state".to_owned(),
            Self::Curve(stop) => format!("the curve ends: {}", stop.words(printer)),
            Self::BeyondZone { kind, radius, approach, force } => {
                beyond_zone(*kind, *radius, [*approach, *force], printer)
            }
        }
    }
}

/// The sums of a path. `None` where a dead load leaves no bound, where the sum was not asked for, and where the way
/// was not followed to its end.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Totals {
    /// All losses.
    pub dissipated: Option<f64>,
    /// The same by area.
    pub dissipated_by_area: Option<f64>,
    /// The losses up to the last contact, without it.
    pub dissipated_before_last_contact: f64,
    /// The work done by the device on the way up, its own elastic energy counted with the bodies; `None` for an
    /// unloading alone.
    pub work_of_loading: Option<f64>,
    /// The same on the way down.
    pub work_of_unloading: Option<f64>,
    /// The loss because closing gains less than opening costs.
    pub dead_band: Option<DeadBand>,
    /// |Π(last) − Π(first) − Σ areas + Σ losses| over the losses or the work of loading, whichever is more, from the start to before
    /// the last contact.
    pub balance: Option<f64>,
}

/// What a loop loses besides its jumps, where a closing edge gains `γ_a` < γ.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DeadBand {
    /// The area that closed, all of which opens again.
    pub area: f64,
    /// (γ − `γ_a`) times that area.
    pub lost: f64,
}

/// A whole path, in reduced units.
#[derive(Debug, Clone, PartialEq)]
pub struct Path {
    /// What was controlled.
    pub control: Control,
    /// Which contacts were followed.
    pub contact: ContactKind,
    /// The state asked for, if the path starts at another one further out.
    pub asked: Option<AskedState>,
    /// Where it turned; `None` for an unloading alone.
    pub turn: Option<TurnReached>,
    /// The events in order.
    pub events: Vec<Event>,
    /// Stable states in order, dense enough for what was asked for: those before and after events, and where δ or P has an extreme.
    pub states: Vec<PathState>,
    /// Why it ended.
    pub stop: PathStop,
    /// The sums.
    pub totals: Totals,
    /// What should be known about it.
    pub warnings: Vec<Warning>,
}

impl Path {
    /// Whether it was followed to its end, as far as one disc in one zone is concerned.
    pub fn is_whole(&self) -> bool {
        !matches!(self.stop, PathStop::BeyondZone { .. })
    }

    /// The first state in contact.
    pub fn start(&self) -> Option<&PathState> {
        self.states.first()
    }

    /// The state of the smallest force: the largest pull, or, where nothing pulls, the last contact, which leaves without
    /// a force. `None` where the path ends before that, pressed together.
    pub fn largest_pull(&self) -> Option<&PathState> {
        self.least(|state| state.force).filter(|state| state.force <= 0.0)
    }

    /// Whether an unloading pulls most where it starts, so that it would pull more from a larger contact.
    pub fn pulls_most_at_start(&self) -> bool {
        let most = self.largest_pull().filter(|most| most.force < 0.0 && self.turn.is_none());
        most.zip(self.start()).is_some_and(|(most, start)| std::ptr::eq(most, start))
    }

    /// The state of the smallest approach.
    pub fn farthest(&self) -> Option<&PathState> {
        self.least(|state| state.approach)
    }

    /// The first state in which a number is smallest. Contact that shrinks to nothing ends in none of the states.
    fn least(&self, of: impl Fn(&PathState) -> f64) -> Option<&PathState> {
        let last = self.last_contact().and_then(|event| event.before.as_ref());
        self.states.iter().chain(last).min_by(|a, b| of(a).total_cmp(&of(b)))
    }

    /// How the contact ended: the bodies came apart with it, or a zone alone went on holding them.
    pub fn last_contact(&self) -> Option<&Event> {
        let held = |state: &Option<PathState>| state.as_ref().is_some_and(|state| !state.contacts.is_empty());
        let ends = |event: &&Event| match event.kind {
            EventKind::LastContact => true,
            EventKind::SnapOff => held(&event.before),
            _ => false,
        };
        let last = self.events.iter().rev().find(ends)?;
        self.separation().is_some().then_some(last)
    }

    /// How the bodies came apart.
    pub fn separation(&self) -> Option<&Event> {
        self.events.last().filter(|event| event.separates())
    }

    /// The losses that are defined.
    pub fn losses(&self) -> f64 {
        self.events.iter().filter_map(|event| event.dissipated).fold(0.0, |sum, loss| sum + loss)
    }

    /// The contact radii of its stable stretches as [outer, inner], from outside inward and each radius once.
    pub fn pieces(&self) -> Vec<[f64; 2]> {
        self.pieces_on(&[Direction::Loading, Direction::Unloading])
    }

    /// The same for one direction, or both.
    pub fn pieces_on(&self, ways: &[Direction]) -> Vec<[f64; 2]> {
        let mut pieces: Vec<[f64; 2]> = (self.states.chunk_by(|a, b| a.piece == b.piece))
            .filter(|piece| piece.iter().any(|state| ways.contains(&state.direction)))
            .filter_map(|piece| Some([piece.first()?.contact_radius, piece.last()?.contact_radius]))
            .map(|[from, to]| [from.max(to), from.min(to)])
            .collect();
        pieces.sort_by(|a, b| b[0].total_cmp(&a[0]));
        pieces.dedup_by(|next, before| {
            let joins = next[0] > before[1];
            if joins {
                before[1] = before[1].min(next[1]);
            }
            joins
        });
        pieces
    }
}
