//! Where a loop of loading and unloading turns round.

use super::Control;

/// Where the control turns round.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Turn {
    /// At the first stable state with at least this approach, a length.
    Approach(f64),
    /// With at least this force.
    Force(f64),
    /// With an outermost edge of at least this radius, a length.
    Radius(f64),
    /// At this control value: an approach, a force, or the position of the device.
    Control(f64),
}

impl Turn {
    /// Its value.
    pub fn value(self) -> f64 {
        match self {
            Self::Approach(x) | Self::Force(x) | Self::Radius(x) | Self::Control(x) => x,
        }
    }

    /// Whether it is a value of what `control` prescribes.
    pub fn is_prescribed(self, control: Control) -> bool {
        match self {
            Self::Control(_) => true,
            Self::Approach(_) => control == Control::Displacement,
            Self::Force(_) => control == Control::Force,
            Self::Radius(_) => false,
        }
    }

    /// The same turn with lengths `length` times and forces `force` times as large.
    #[must_use]
    pub fn in_units(self, length: f64, force: f64, control: Control) -> Self {
        match self {
            Self::Approach(x) => Self::Approach(x * length),
            Self::Force(x) => Self::Force(x * force),
            Self::Radius(x) => Self::Radius(x * length),
            Self::Control(x) => Self::Control(x * if control == Control::Force { force } else { length }),
        }
    }
}

/// Which contacts a path follows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ContactKind {
    /// A disc and rings, wherever they appear.
    #[default]
    Rings,
    /// A single disc, through states in which the bodies would overlap.
    OneDisc,
}

impl ContactKind {
    /// The names, in the order of the variants.
    pub const NAMES: [&'static str; 2] = ["rings", "one-disc"];

    /// Its name.
    pub fn name(self) -> &'static str {
        Self::NAMES[usize::from(self == Self::OneDisc)]
    }
}
