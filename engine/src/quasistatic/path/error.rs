//! Why there is no path, and what is to be known about one; both in words.

use crate::annuli::AnnuliError;
use crate::disc::TableError;
use crate::problem::Printer;
use crate::progress::Stopped;
use crate::zone::FaultKind;
use std::fmt;

/// Why there is no path. All numbers are reduced.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{}", self.words(&Printer::reduced()))]
pub enum PathError {
    /// The control turns before the bodies touch.
    TurnBeforeTouch {
        /// Where it was to turn: a control value, or an approach.
        turn: f64,
        /// The first touch.
        touch: f64,
    },
    /// A dead load below zero without adhesion.
    NoTension {
        /// The load.
        load: f64,
    },
    /// The start is unstable and nothing outward is stable.
    UnstableStart {
        /// s of the start, a length.
        contact_radius: f64,
        /// The largest radius searched, a length.
        searched: f64,
        /// Whether the gap is smaller there than on the axis.
        falls: bool,
    },
    /// The turn lies beyond what is known of the gap.
    BeyondGap {
        /// How far the gap is known, a length.
        radius: f64,
        /// The largest approach reached.
        approach: f64,
        /// The force there.
        force: f64,
    },
    /// The turning radius lies beyond what is known of the gap.
    RadiusBeyondGap {
        /// The radius asked for.
        radius: f64,
        /// How far the gap is known, a length.
        known: f64,
    },
    /// More contacts, or points on them, than a state may have.
    TooMany {
        /// What there are too many of.
        error: AnnuliError,
        /// The approach reached.
        approach: f64,
    },
    /// The gap is nowhere least.
    NeverTouches {
        /// How far it was searched, a length.
        searched: f64,
    },
    /// The turn is no number, or is none of this kind.
    BadTurn(f64),
    /// A state of adhesion with a range is not one disc in one zone.
    BeyondZone {
        /// What else there is; `None` where one disc in one zone has no equilibrium.
        kind: Option<FaultKind>,
        /// Where, a length: the edge of the zone where it has no equilibrium.
        radius: f64,
        /// δ.
        approach: f64,
        /// P.
        force: f64,
    },
    /// The table ends before what may come within range.
    Unseen {
        /// How far it must be known, a length.
        radius: f64,
    },
    /// A state could not be computed.
    State(#[from] AnnuliError),
    /// Edges ran without landing.
    NoLanding {
        /// c.
        control_value: f64,
        /// How many steps were taken.
        steps: usize,
    },
    /// The curve was lost.
    Lost {
        /// c.
        control_value: f64,
    },
    /// More steps than there may be.
    TooLong {
        /// How many there may be.
        steps: usize,
        /// c.
        control_value: f64,
    },
    /// The table of the gap could not be made.
    Table(TableError),
    /// It was no longer wanted.
    Stopped(#[from] Stopped),
}

impl PathError {
    /// Whether another value would do, of the turn, the load or the gap; else the computation itself failed.
    pub fn is_of_values(&self) -> bool {
        !matches!(
            self,
            Self::State(_)
                | Self::NoLanding { .. }
                | Self::Lost { .. }
                | Self::TooLong { .. }
                | Self::Stopped(_)
        )
    }

    /// What is wrong, in words.
    pub fn words(&self, printer: &Printer) -> String {
        let at = |x| printer.control_value(x);
        let length = |x| printer.length(x);
        let force = |x| printer.force(x);
        match *self {
            Self::TurnBeforeTouch { turn, touch } => {
                let (turn, touch) = (at(turn), at(touch));
                format!("the loop would turn at {turn}, before the bodies touch: turn above {touch}")
            }
            Self::NoTension { load } => {
                let (load, none) = (force(load), force(0.0));
                format!(
                    "without adhesion a dead load of {load} carries no contact: turn at a force above {none}"
                )
            }
            Self::UnstableStart { contact_radius, searched, falls } => {
                let (start, searched) = (length(contact_radius), length(searched));
                let under = printer.under_control();
                let why = if falls {
                    "; the gap is smaller there than on the axis: a gap has the opposite sign of a body's height"
                } else {
                    ""
                };
                format!(
                    "the start state (contact radius {start}) is unstable{under}, and there is no stable state \
                     further out, up to the contact radius {searched}{why}"
                )
            }
            Self::BeyondGap { radius, approach, force: load } => {
                let (radius, approach, load) = (length(radius), length(approach), force(load));
                format!(
                    "the contact grew to r = {radius}, where the known gap ends, at the approach {approach} and the \
                     force {load}: turn earlier"
                )
            }
            Self::RadiusBeyondGap { radius, known } => {
                let (radius, known) = (length(radius), length(known));
                format!(
                    "a turn at the radius {radius} lies beyond the gap, which is known up to r = {known}: turn below that"
                )
            }
            Self::TooMany { ref error, approach } => {
                format!("{error}, at the approach {}: turn earlier", length(approach))
            }
            Self::BeyondZone { kind, radius, approach, force } => {
                beyond_zone(kind, radius, [approach, force], printer)
            }
            Self::Unseen { radius } => format!("the gap is not known up to r = {}", length(radius)),
            Self::NeverTouches { searched } => {
                let searched = length(searched);
                format!("the gap has no minimum up to r = {searched}: the bodies never touch")
            }
            Self::BadTurn(turn) => format!("{turn} is not a valid turn"),
            Self::State(ref error) => error.words(printer),
            Self::NoLanding { control_value, steps } => {
                let value = at(control_value);
                format!("at the control value {value} the edges did not land within {steps} steps")
            }
            Self::Lost { control_value } => {
                let value = at(control_value);
                format!("the equilibria could not be followed beyond the control value {value}")
            }
            Self::TooLong { steps, control_value } => {
                let value = at(control_value);
                format!(
                    "the loop takes more than {steps} steps: it reached the control value {value}; turn earlier"
                )
            }
            Self::Table(ref error) => error.words(printer),
            Self::Stopped(stopped) => stopped.to_string(),
        }
    }
}

/// What ends a path of one disc in one zone at a state δ, P.
pub(super) fn beyond_zone(
    kind: Option<FaultKind>,
    radius: f64,
    [approach, force]: [f64; 2],
    printer: &Printer,
) -> String {
    let (radius, approach, force) = (printer.length(radius), printer.length(approach), printer.force(force));
    let what = kind.map_or_else(
        || format!("no zone that ends at r = {radius} or slightly beyond holds one disc of contact"),
        |kind| kind.words(&radius),
    );
    format!(
        "at the approach {approach} and the force {force} {what}: adhesion with a range is computed only for one \
         disc of contact in one zone; a larger material.cohesive_strength, or a flatter gap, keeps it so"
    )
}

impl From<TableError> for PathError {
    fn from(error: TableError) -> Self {
        match error {
            TableError::Stopped(Stopped) => Self::Stopped(Stopped),
            error @ TableError::TooFine(_) => Self::Table(error),
        }
    }
}

/// What should be known about a path besides its numbers.
#[derive(Debug, Clone, PartialEq)]
pub enum Warning {
    /// Some state had fewer than nine digits: breaks of the gap lie inside a ring, or it takes more points than there
    /// may be.
    Digits {
        /// The fewest decimal digits of the edges of any state.
        digits: f64,
        /// The control value there.
        control_value: f64,
    },
    /// Energy and areas do not agree.
    Balance {
        /// |Π − Σ areas + Σ losses| over the losses or the work of loading, whichever is more.
        share: f64,
    },
    /// The losses of a jump by energy and by area do not agree.
    Area {
        /// The number of the event, from 1 as tables count.
        event: usize,
        /// Their difference over the loss.
        share: f64,
    },
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.words(&Printer::reduced()))
    }
}

impl Warning {
    /// The warning in words.
    pub fn words(&self, printer: &Printer) -> String {
        match *self {
            Self::Digits { digits, control_value } => {
                let value = printer.control_value(control_value);
                format!("at the control value {value} edges are known to only {digits:.1} digits")
            }
            Self::Balance { share } => format!(
                "energies and areas differ by {share:.1e} of the losses or the work of loading, whichever is larger"
            ),
            Self::Area { event, share } => {
                format!(
                    "the losses of event {event} by area and by energy differ by a fraction of {share:.1e}"
                )
            }
        }
    }
}
