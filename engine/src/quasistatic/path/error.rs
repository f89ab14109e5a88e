//! Why there is no path.

use crate::annuli::AnnuliError;
use crate::disc::TableError;
use crate::problem::Control;
use crate::progress::Stopped;
use crate::zone::FaultKind;

/// Why there is no path. All numbers are in reduced units.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum PathError {
    /// The control turns before the bodies touch.
    #[error("the control turns at {turn}, before the bodies touch at {touch}: turn above that")]
    TurnBeforeTouch {
        /// Where it was to turn: a control value, or an approach.
        turn: f64,
        /// The first touch.
        touch: f64,
    },
    /// A dead load below zero without adhesion.
    #[error("without adhesion a dead load of {load} carries no contact: a load above 0 does")]
    NoTension {
        /// The load.
        load: f64,
    },
    /// The start is unstable and nothing outward is stable.
    #[error(
        "the start state (contact radius {contact_radius}) is unstable and no stable state lies outward up to {searched}"
    )]
    UnstableStart {
        /// s of the start, a length.
        contact_radius: f64,
        /// The largest radius searched, a length.
        searched: f64,
    },
    /// The turn lies beyond what is known of the gap.
    #[error(
        "the contact reached r = {radius} at the approach {approach} and the force {force}, up to where the gap is known: turn before"
    )]
    BeyondGap {
        /// How far the gap is known, a length.
        radius: f64,
        /// The largest approach reached.
        approach: f64,
        /// The force there.
        force: f64,
    },
    /// The turning radius lies beyond what is known of the gap.
    #[error("the gap is known up to r = {known}: a turn at the radius {radius} lies beyond")]
    RadiusBeyondGap {
        /// The radius asked for.
        radius: f64,
        /// How far the gap is known, a length.
        known: f64,
    },
    /// More contacts, or points on them, than a state may have.
    #[error("{error}, at the approach {approach}: turn before")]
    TooMany {
        /// Of what.
        error: AnnuliError,
        /// The approach reached.
        approach: f64,
    },
    /// The gap is nowhere least.
    #[error("the gap has no least value up to r = {searched}: the bodies never touch")]
    NeverTouches {
        /// How far it was searched, a length.
        searched: f64,
    },
    /// The turn is no number, or is none of this kind.
    #[error("a turn at {0} is none")]
    BadTurn(f64),
    /// A state of adhesion with a range is not one disc in one zone.
    #[error("at the approach {approach} and the force {force} {}", beyond_zone(*kind, &radius.to_string()))]
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
    #[error("what lies up to r = {radius} is not known")]
    Unseen {
        /// How far it must be known, a length.
        radius: f64,
    },
    /// A state could not be computed.
    #[error(transparent)]
    State(#[from] AnnuliError),
    /// Edges ran without landing.
    #[error("at the control value {control_value} the edges did not land after {steps} steps")]
    NoLanding {
        /// c.
        control_value: f64,
        /// How many steps were taken.
        steps: usize,
    },
    /// The curve was lost.
    #[error("the equilibria could not be followed beyond the control value {control_value}")]
    Lost {
        /// c.
        control_value: f64,
    },
    /// More steps than there may be.
    #[error("the loop takes more than {steps} steps: it reached the control value {control_value}")]
    TooLong {
        /// How many there may be.
        steps: usize,
        /// c.
        control_value: f64,
    },
    /// The table of the gap could not be made.
    #[error(transparent)]
    Table(TableError),
    /// It was no longer wanted.
    #[error(transparent)]
    Stopped(#[from] Stopped),
}

/// What ends a path of one disc in one zone.
pub(super) fn beyond_zone(kind: Option<FaultKind>, radius: &str) -> String {
    let what = kind.map_or_else(
        || format!("no zone that ends at r = {radius} or a little beyond holds one disc of contact"),
        |kind| kind.words(radius),
    );
    format!(
        "{what}: adhesion with a range is computed for one disc of contact in one zone alone; a larger \
         material.cohesive_strength, or less of a gap, keeps it so"
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

/// What is to be known about a path beyond its numbers.
#[derive(Debug, Clone, PartialEq)]
pub enum Warning {
    /// Some state had fewer digits than nine: breaks of the gap lie inside a ring, or it takes more points than there may be.
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
    /// A jump's loss by energy and by area do not agree.
    Area {
        /// The number of the event, from 1 as tables count.
        event: usize,
        /// Their difference over the loss.
        share: f64,
    },
}

impl std::fmt::Display for Warning {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Digits { digits, control_value } => {
                write!(f, "at the control value {control_value} edges are known to {digits:.1} digits only")
            }
            Self::Balance { share } => {
                write!(
                    f,
                    "energies and areas differ by {share:.1e} of the losses or the work of loading, whichever is more"
                )
            }
            Self::Area { event, share } => {
                write!(
                    f,
                    "the loss of event {event} by area differs by {share:.1e} of it from that by energy"
                )
            }
        }
    }
}

/// The control value from which a device must be counted, for messages.
pub fn quantity(control: Control) -> &'static str {
    match control {
        Control::Displacement => "approach",
        Control::Force => "force",
        Control::Stiffness(_) => "displacement of the device",
    }
}
