//! The largest pull of a disc on a paraboloid with waves of any phases: two bounds on the enhancement.
//!
//! The force of [`harmonics`](super::harmonics) is linear in the sine and the cosine of each phase. So at a contact
//! radius s no phases make it smaller than, with xᵢ = qᵢs,
//!
//! ```text
//! P(s) = 4E*s³/(3R) − √(8πγE*s³) − πE* Σ (Aᵢ/qᵢ) xᵢ √[(xᵢH₀(xᵢ) − H₁(xᵢ))² + (xᵢJ₀(xᵢ) − J₁(xᵢ))²]
//! ```
//!
//! Its minimum bounds the pull-off of one disc by Guduru's solution. For many waves under the disc, qs ≫ 1, the minimum
//! is that of a smooth sphere whose adhesive edge is 1 + Σ 1/(√π αᵢ) times as strong: Kesari and Lew's envelope with
//! all waves added up.
//!
//! P. R. Guduru, J. Mech. Phys. Solids 55, 445 (2007), doi:10.1016/j.jmps.2006.09.004; H. Kesari and A. J. Lew, J. Mech. Phys. Solids
//! 59, 2488 (2011).

use super::guduru::Guduru;
use super::jkr::Jkr;
use super::kesari_lew::KesariLew;
use super::struve::struve;
use crate::elementary::{cbrt, exp, ln};
use crate::root;
use std::f64::consts::{PI, TAU};

/// Radii at which the force is evaluated before its minimum is bracketed.
const RADII: i32 = 24;

/// A paraboloid with waves of unknown phases and the adhesion of `smooth`.
#[derive(Debug, Clone, PartialEq)]
pub struct WorstPhase {
    /// The sphere without waves.
    pub smooth: Jkr,
    /// Amplitude and wavelength of each wave.
    pub waves: Vec<(f64, f64)>,
}

impl WorstPhase {
    /// Σ 1/(√π αᵢ); infinite without adhesion.
    fn share(&self) -> f64 {
        let Jkr { effective_modulus, work_of_adhesion, radius_of_curvature } = self.smooth;
        let share = |(amplitude, wavelength): &(f64, f64)| {
            let amplitude = amplitude.abs();
            let wavelength = *wavelength;
            KesariLew {
                sphere: Guduru {
                    effective_modulus,
                    work_of_adhesion,
                    radius_of_curvature,
                    amplitude,
                    wavelength,
                },
            }
            .share()
        };
        self.waves.iter().map(share).sum()
    }

    /// Kesari and Lew's `P_off/P_c` with all waves in phase; for a single wave it equals [`KesariLew::pull_off_ratio`].
    pub fn kesari_lew(&self) -> f64 {
        (1.0 + self.share()).powi(2)
    }

    /// The smallest force of a disc at the contact radius `s` for any phases.
    pub fn force(&self, s: f64) -> f64 {
        let Jkr { effective_modulus: e, work_of_adhesion, radius_of_curvature } = self.smooth;
        let wave = |(amplitude, wavelength): &(f64, f64)| {
            let q = TAU / wavelength;
            let x = q * s;
            let (h0, h1) = struve(x);
            let [struve, bessel] = [x * h0 - h1, x * libm::j0(x) - libm::j1(x)];
            amplitude.abs() * s * (struve * struve + bessel * bessel).sqrt()
        };
        let waves: f64 = self.waves.iter().map(wave).sum();
        let cube = s.powi(3);
        4.0 * e * cube / (3.0 * radius_of_curvature)
            - (8.0 * PI * work_of_adhesion * e * cube).sqrt()
            - PI * e * waves
    }

    /// The largest `P_off/P_c` of one disc, for any phases, by Guduru's solution; `None` without adhesion.
    pub fn guduru(&self) -> Option<f64> {
        let critical = self.smooth.pull_off_force();
        let share = Some(self.share()).filter(|share| share.is_finite() && critical > 0.0)?;
        // Around where the smooth sphere lets go, and where the strongest edge does.
        let radius = self.smooth.pull_off_radius();
        let (lo, hi) = (ln(0.1 * radius), ln(3.0 * radius * cbrt((1.0 + share).powi(2))));
        let at = |k: i32| lo + (hi - lo) * f64::from(k) / f64::from(RADII);
        let force = |log: f64| self.force(exp(log));
        let least = (0..=RADII).min_by(|a, b| force(at(*a)).total_cmp(&force(at(*b))))?;
        Some(-force(root::least(at(least - 1), at(least + 1), force)) / critical)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gap::shapes::{Harmonic, Harmonics};
    use crate::theory::Disc;
    use crate::theory::harmonics::HarmonicDisc;

    const SMOOTH: Jkr = Jkr { effective_modulus: 1.0, work_of_adhesion: 0.004, radius_of_curvature: 1.0 };

    #[test]
    fn no_phases_pull_more_and_some_pull_as_much() {
        let waves = vec![(4e-4, 0.05), (2e-4, 0.03)];
        let worst = WorstPhase { smooth: SMOOTH, waves: waves.clone() };
        for s in [0.02, 0.1, 0.17, 0.3] {
            let mut least = f64::INFINITY;
            for turn in 0..40 * 40 {
                let phases = [turn % 40, turn / 40].map(|k| TAU * f64::from(k) / 40.0);
                let waves = waves.iter().zip(phases);
                let wave = |((amplitude, wavelength), phase): (&(f64, f64), f64)| Harmonic {
                    amplitude: *amplitude,
                    wavelength: *wavelength,
                    phase,
                };
                let gap = Harmonics::new(1.0, waves.map(wave).collect()).unwrap();
                let disc = HarmonicDisc { effective_modulus: 1.0, work_of_adhesion: 0.004, gap };
                least = least.min(disc.force(s));
            }
            let bound = worst.force(s);
            assert!(least >= bound && least - bound < 0.01 * bound.abs(), "{s}: {least} {bound}");
        }
    }

    #[test]
    fn both_bounds_agree_where_many_waves_are_under_the_disc_and_are_one_without() {
        let mut before = f64::INFINITY;
        for wavelength in [0.1, 0.03, 0.01, 0.003] {
            let waves = vec![(0.3 * (wavelength * 0.004_f64).sqrt(), wavelength)];
            let worst = WorstPhase { smooth: SMOOTH, waves };
            let off = (worst.guduru().unwrap() / worst.kesari_lew() - 1.0).abs();
            assert!(off < 0.5 * before, "{wavelength}: {off} after {before}");
            before = off;
        }
        assert!(before < 1e-3, "{before}");
        let none = WorstPhase { smooth: SMOOTH, waves: Vec::new() };
        assert!((none.guduru().unwrap() - 1.0).abs() < 1e-8 && (none.kesari_lew() - 1.0).abs() < 1e-15);
        let loose = WorstPhase { smooth: Jkr { work_of_adhesion: 0.0, ..SMOOTH }, waves: vec![(1e-3, 0.1)] };
        assert_eq!(loose.guduru(), None);
    }
}
