//! The speed of an edge as a function of the energy that it is offered.
//!
//! ```text
//! opening, G > γ     v = v₀ (G/γ − 1)^{1/n}           G = γ [1 + (v/v₀)ⁿ]
//! closing, G < γ_a   v = v_a (γ_a/G − 1)^{1/m}        G = γ_a / [1 + (v/v_a)ᵐ]
//! ```
//!
//! Between the two the edge rests. Closing is the reciprocal of opening: a closing law linear in G would let a fast
//! approach run into overlap, because G grows again where the edge is pressed. Speeds are in units of v₀ here.
//!
//! A. N. Gent and J. Schultz, J. Adhesion 3, 281 (1972), doi:10.1080/00218467208072199; D. Maugis and M. Barquins, J. Phys. D 11, 1989
//! (1978), doi:10.1088/0022-3727/11/14/011, for opening.

use crate::elementary::{exp2, log2};

/// Which way an edge goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Motion {
    /// Inward: the bodies come apart.
    Opening,
    /// Outward: they close.
    Closing,
}

impl Motion {
    /// The sign of ds/dt.
    pub fn sense(self) -> f64 {
        match self {
            Self::Opening => -1.0,
            Self::Closing => 1.0,
        }
    }
}

/// The law of the edge; speeds in units of v₀.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EdgeLaw {
    /// n.
    pub exponent: f64,
    /// `v_a/v₀`.
    pub closing_speed: f64,
    /// m.
    pub closing_exponent: f64,
}

impl EdgeLaw {
    /// The law by which an edge closes as it opens.
    #[must_use]
    pub fn symmetric(exponent: f64) -> Self {
        Self { exponent, closing_speed: 1.0, closing_exponent: exponent }
    }

    /// The same with another `v_a/v₀` and another m, where they are given.
    #[must_use]
    pub fn with_closing(self, speed: Option<f64>, exponent: Option<f64>) -> Self {
        Self {
            closing_speed: speed.unwrap_or(self.closing_speed),
            closing_exponent: exponent.unwrap_or(self.closing_exponent),
            ..self
        }
    }

    /// The reference speed and the exponent of a motion.
    pub fn of(self, motion: Motion) -> MotionLaw {
        match motion {
            Motion::Opening => MotionLaw { speed: 1.0, exponent: self.exponent },
            Motion::Closing => MotionLaw { speed: self.closing_speed, exponent: self.closing_exponent },
        }
    }
}

/// The law of one motion, in terms of its drive: G/γ − 1 where the edge opens, `γ_a`/G − 1 where it closes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MotionLaw {
    /// v₀ or `v_a`.
    pub speed: f64,
    /// n or m.
    pub exponent: f64,
}

impl MotionLaw {
    /// The speed at a drive, and its derivative; odd in the drive, so that a rest is a simple root.
    pub fn speed(self, drive: f64) -> [f64; 2] {
        // Above n = 1 the slope has no bound at rest.
        let size = drive.abs().max(f64::MIN_POSITIVE);
        let inverse = 1.0 / self.exponent;
        let slope = power(size, inverse - 1.0);
        [self.speed * drive * slope, self.speed * inverse * slope]
    }

    /// The drive at a speed, and its derivative; the inverse of [`MotionLaw::speed`].
    pub fn drive(self, speed: f64) -> [f64; 2] {
        let over = speed / self.speed;
        let size = power(over.abs(), self.exponent);
        [size.copysign(over), self.exponent * size / over.abs().max(f64::MIN_POSITIVE) / self.speed]
    }
}

/// xᵖ for x ≥ 0, by roots and products where those suffice. Each step of a pull asks for ten or more of these, and `pow`, which
/// rounds better by a digit, takes more than twice as long.
#[expect(clippy::float_cmp, reason = "the exponents that people choose, as they are written")]
fn power(x: f64, p: f64) -> f64 {
    if p == 0.0 {
        1.0
    } else if p == 1.0 {
        x
    } else if p == 0.5 {
        x.sqrt()
    } else if p == 0.25 {
        x.sqrt().sqrt()
    } else if p == 3.0 {
        x * x * x
    } else {
        exp2(p * log2(x))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn drive_and_speed_are_inverse_and_their_derivatives_are_right() {
        for exponent in [0.1, 0.25, 0.5, 0.7, 1.0, 1.6] {
            let law = EdgeLaw { exponent, closing_speed: 3.0, closing_exponent: 0.5 * exponent };
            for branch in [law.of(Motion::Opening), law.of(Motion::Closing)] {
                for drive in [-2.0, -0.3, 0.02, 0.7, 40.0] {
                    let [speed, slope] = branch.speed(drive);
                    let [back, back_slope] = branch.drive(speed);
                    assert!((back / drive - 1.0).abs() < 1e-12, "{exponent} {drive}: {back}");
                    assert!((slope * back_slope - 1.0).abs() < 1e-12, "{exponent} {drive}");
                    let step = 1e-6 * drive.abs();
                    let difference =
                        (branch.speed(drive + step)[0] - branch.speed(drive - step)[0]) / (2.0 * step);
                    assert!((difference / slope - 1.0).abs() < 1e-8, "{exponent} {drive}");
                }
            }
        }
    }
}
