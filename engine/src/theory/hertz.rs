//! Hertz: a smooth sphere without adhesion, eq. (21).
//!
//! H. Hertz, J. reine angew. Math. 92, 156 (1881), doi:10.1515/crll.1882.92.156.

use crate::elementary::pow;

/// The contact radius s = √(Rδ) at the approach `delta ≥ 0`.
pub fn contact_radius(radius_of_curvature: f64, delta: f64) -> f64 {
    (radius_of_curvature * delta).sqrt()
}

/// The force P = (4/3) E* √R δ^{3/2} at the approach `delta ≥ 0`.
pub fn force(modulus: f64, radius_of_curvature: f64, delta: f64) -> f64 {
    4.0 / 3.0 * modulus * radius_of_curvature.sqrt() * pow(delta, 1.5)
}
