//! Contact on a disc and on rings around it, in equilibrium or not.
//!
//! With X(a) = ∫_a^∞ p r/√(r² − a²) dr, the bodies touch on the disc exactly where X = ½E*(δ − g), whatever the rings
//! do: the disc drops out, and only the pressures of the rings are unknown.
//!
//! ```text
//! Σ_rings ∫ p r' (M − N) dr' = F(r)                M = K(k)/(r + r'),  k = 2√(rr')/(r + r'),   N = ∫₀^s da/√((r² − a²)(r'² − a²))
//! F(r) = ½E* ∫_s^r (δ − g)/√(r² − a²) da           s = 0:  F = ¼πE*(δ − h),  N = 0
//! κ_s = −√(2/(πE*s)) [½E*(δ − g(s)) − ∫ p r'/√(r'² − s²) dr']            κ = K_I/√(2E*) with its sign, G = κ² where κ ≥ 0
//! P = 2E* ∫₀^s (δ − g) + 4 ∫ p r' arccos(s/r') dr'
//! U = E* ∫₀^s (δ − g)² + (4/E*) ∫ p r' F dr' − γ·area
//! ```
//!
//! Equilibrium is κ = √γ at every edge. On a ring p r dr/dt is a cosine series in the angle t, r = c − d cos t; a
//! ring's own block is exact for such sums. Everything is linear in δ, so force and intensities are polynomials in δ,
//! and all derivatives with respect to the edges are exact. Reduced units, E* = 1. A gap trapped between contacts holds
//! no gas.
//!
//! I. N. Sneddon, Int. J. Eng. Sci. 3, 47 (1965), for one disc; W. D. Collins, Proc. Edinburgh Math. Soc. 13, 235
//! (1963), for annuli by Abel transforms; J. J. Kalker's variational principle for their equilibrium.
//!
//! | file | what lives there |
//! |---|---|
//! | [`contacts`] | a disc and rings, their edges |
//! | [`ground`] | what is needed from a gap: its table, its lengths, sums under the disc |
//! | [`state`] | pressures, force, energy, intensities |
//! | `rates` | their derivatives with respect to the edges |
//! | [`around`] | the gap outside the contacts, the pressure in them |
//! | [`elliptic`] | complete elliptic integrals, four at a time |
//! | `kernel` | blocks of the equations |
//! | `nodes`, `rule`, `graded` | points on a ring |
//! | `cholesky` | the solver |

pub mod around;
mod cholesky;
pub mod contacts;
pub mod elliptic;
mod graded;
pub mod ground;
mod kernel;
mod nodes;
mod rates;
mod rule;
pub mod state;

#[cfg(test)]
mod tests;

pub use around::{Around, GapMinimum};
pub use contacts::Contacts;
pub use contacts::ContactsError;
pub use contacts::Edge;
pub use contacts::MOST_CONTACTS;
pub use ground::Ground;
pub use rule::MOST_POINTS;
pub use state::{
    AnnuliError, AnnuliState, MOST_POINTS_IN_ALL, Resolution, Wanted, points, points_on_the_way,
};
