//! The gaps, one file each: formula, units, source, and derivatives as exact as the gap itself.
//!
//! | file | h(r) |
//! |---|---|
//! | [`exact_sphere`] | R − √(R² − r²), known up to R |
//! | [`power_law`] | c rⁿ; n = 1 is the cone |
//! | [`harmonics`] | r²/(2R) and any sum of cosines |
//! | [`random_waves`] | r²/(2R) and cosines drawn from a power law with a seed |
//! | [`profile`] | a curve through measured rows, by the spline of [`spline`] |
//! | [`measured`] | the same with the file and the rows it came from |
//! | [`split_mix`] | the random numbers used for all this, the same on every machine |

pub mod exact_sphere;
pub mod harmonics;
pub mod measured;
pub mod power_law;
pub mod profile;
pub mod random_waves;
pub mod spline;
pub mod split_mix;

pub use exact_sphere::ExactSphere;
pub use harmonics::{Harmonic, Harmonics};
pub use measured::{MeasuredGap, ProfileRows};
pub use power_law::PowerLaw;
pub use profile::{ProfileGap, Smoothing};
pub use random_waves::RandomWaves;

#[cfg(test)]
mod fixtures;
