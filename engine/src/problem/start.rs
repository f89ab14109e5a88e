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
    /// Its value.
    pub fn value(self) -> f64 {
        match self {
            Self::ContactRadius(x) | Self::Approach(x) | Self::Force(x) => x,
        }
    }
}

/// Where a walk along the equilibrium states begins.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Begin {
    /// With the disc at which the path starts, which is then pulled off.
    #[default]
    Disc,
    /// With the bodies apart: at first touch and the state it jumps to, which is then pressed on.
    Apart,
}

impl Begin {
    /// The names, in the order of the variants.
    pub const NAMES: [&'static str; 2] = ["disc", "apart"];

    /// Its name.
    pub fn name(self) -> &'static str {
        Self::NAMES[usize::from(self == Self::Apart)]
    }
}
