//! What a test does with the control, part by part.

/// A part of a programme.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Part {
    /// The control goes to a value at a rate, which is positive.
    Ramp {
        /// The value: an approach, a force, or the position of the device.
        to: f64,
        /// The rate, in the unit of the value over time.
        rate: f64,
    },
    /// The control goes down at a rate until the bodies are apart.
    Apart {
        /// The rate.
        rate: f64,
    },
    /// The control is held for a time.
    Hold {
        /// The time.
        time: f64,
    },
}

impl Part {
    /// The same with control values `value` times and times `time` times as large.
    #[must_use]
    pub fn in_units(self, value: f64, time: f64) -> Self {
        match self {
            Self::Ramp { to, rate } => Self::Ramp { to: to * value, rate: rate * value / time },
            Self::Apart { rate } => Self::Apart { rate: rate * value / time },
            Self::Hold { time: held } => Self::Hold { time: held * time },
        }
    }
}
