//! Exact solutions, independent of the Ritz code: used by the tests and by the screen alike.
//!
//! For any gap with a connected contact disc they all follow from one function, the Abel transform g of the gap; they
//! differ in how they obtain it.
//!
//! | file | what lives there |
//! |---|---|
//! | [`hertz`] | a smooth sphere without adhesion, eq. (21) |
//! | [`jkr`] | a smooth sphere with adhesion, eq. (22) with its misprints corrected |
//! | [`disc`] | δ, P, U, their slopes and the pressure of one connected disc, from the transform of its gap |
//! | [`sneddon`] | any gap: the transform by quadrature |
//! | [`sphere`] | the sphere itself: the transform in closed form |
//! | [`power_law`] | c rⁿ, the cone included: the transform in closed form |
//! | [`harmonics`] | a paraboloid with any sum of waves: the transform in closed form |
//! | [`guduru`] | the wavy sphere: the transform in closed form |
//! | [`struve`] | the functions H₀, H₁ of that closed form |
//! | [`kesari_lew`] | the wavy sphere with many small waves: envelope and pull-off |
//! | [`worst_phase`] | waves of unknown phases: bounds on the pull-off |
//! | [`maugis`] | a sphere whose adhesion has a range, in closed form |
//! | [`onset`] | the smallest waves on which a crest can snap at all |
//! | [`exact`] | the best of these for a problem |
//! | [`unloading`] | the quasi-static path of an exact disc: limit points, landings, losses |
//! | [`quadrature`] | integrals to rounding: Gauss-Legendre panels that halve where they must |
//!
//! Any consistent units.

pub mod disc;
pub mod exact;
pub mod guduru;
pub mod harmonics;
pub mod hertz;
pub mod jkr;
pub mod kesari_lew;
pub mod maugis;
pub mod onset;
pub mod power_law;
pub mod quadrature;
pub mod sneddon;
pub mod sphere;
pub mod struve;
pub mod unloading;
pub mod worst_phase;

pub use disc::{Disc, ExactEquilibrium};
pub use exact::Exact;
