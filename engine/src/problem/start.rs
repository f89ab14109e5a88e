//! How the start of a path is given.

/// The state at which a path starts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Start {
    /// The equilibrium with this contact radius.
    ContactRadius(f64),
    /// The largest contact in equilibrium at this approach.
    Approach(f64),
    /// The largest contact that carries this force, a preload.
    Force(f64),
}

impl Start {
    /// Its number.
    #[must_use]
    pub fn value(self) -> f64 {
        match self {
            Self::ContactRadius(x) | Self::Approach(x) | Self::Force(x) => x,
        }
    }
}
