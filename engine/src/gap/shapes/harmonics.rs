//! A paraboloid with any number of axisymmetric waves.
//!
//! ```text
//! h    = r²/(2R) + Σ Aᵢ [cos φᵢ − cos(qᵢr + φᵢ)],   qᵢ = 2π/λᵢ
//! h'   = r/R     + Σ Aᵢ qᵢ  sin(qᵢr + φᵢ)
//! h''  = 1/R     + Σ Aᵢ qᵢ² cos(qᵢr + φᵢ)
//! h''' =         − Σ Aᵢ qᵢ³ sin(qᵢr + φᵢ)
//! ```
//!
//! so that h(0) = 0, and a term of phase 0 is the A(1 − cos qr) of the paper's eq. (23). A phase that is not a multiple
//! of π gives the gap a slope on the axis, Aq sin φ: the tip is then a blunt cone. R, A and λ are lengths, φ is an
//! angle in radians.
//!
//! With α = qr/2, cos φ − cos(2α + φ) = 2 sin α sin(α + φ), which keeps its digits near the axis. Everything else
//! follows from the sine and cosine of α by the addition theorems: one call for each wave.
//!
//! The feature length is the shortest wavelength with an amplitude. The exact solution is
//! [`theory::harmonics`](crate::theory::harmonics).

use crate::elementary::{sin_cos, sinh};
use crate::gap::lanes::map_lanes;
use crate::gap::{Breaks, ComplexDisc, Gap, Jet, Parity};
use crate::gap::{function::Form, function::Wave};
use std::f64::consts::TAU;
use wide::f64x4;

/// The largest number of waves of one gap.
pub const MOST_WAVES: usize = 1000;

/// A wave is even where the sine of its phase is below this: that of a rounded π k, for k up to some thousands.
const PHASE_ROUNDING: f64 = 1e-12;

/// One wave.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Harmonic {
    /// A, a length.
    pub amplitude: f64,
    /// λ, positive, a length.
    pub wavelength: f64,
    /// φ, in radians.
    pub phase: f64,
}

/// A wave as it is summed.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Term {
    amplitude: f64,
    wavenumber: f64,
    phase_sin: f64,
    phase_cos: f64,
}

impl Term {
    /// Sine and cosine of α = qr/2 and of α + φ, at four radii.
    fn half_way(&self, r: f64x4) -> [f64x4; 4] {
        let (sin, cos) = (r * (0.5 * self.wavenumber)).sin_cos();
        let shifted_sin = sin * self.phase_cos + cos * self.phase_sin;
        [sin, cos, shifted_sin, cos * self.phase_cos - sin * self.phase_sin]
    }
}

/// h = r²/(2R) + Σ Aᵢ [cos φᵢ − cos(qᵢr + φᵢ)].
#[derive(Debug, Clone, PartialEq)]
pub struct Harmonics {
    radius_of_curvature: f64,
    waves: Vec<Harmonic>,
    terms: Vec<Term>,
}

/// More waves than [`MOST_WAVES`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("{0} waves are too many: at most {MOST_WAVES} are summed")]
pub struct TooManyWaves(pub usize);

impl Harmonics {
    /// The paraboloid of radius `radius_of_curvature > 0` with `waves`.
    ///
    /// # Errors
    /// [`TooManyWaves`].
    pub fn new(radius_of_curvature: f64, waves: Vec<Harmonic>) -> Result<Self, TooManyWaves> {
        if waves.len() > MOST_WAVES {
            return Err(TooManyWaves(waves.len()));
        }
        let term = |wave: &Harmonic| {
            let (phase_sin, phase_cos) = sin_cos(wave.phase);
            Term { amplitude: wave.amplitude, wavenumber: TAU / wave.wavelength, phase_sin, phase_cos }
        };
        // A wave without amplitude costs nothing.
        let terms = waves.iter().filter(|wave| wave.amplitude != 0.0).map(term).collect();
        Ok(Self { radius_of_curvature, waves, terms })
    }

    /// R.
    pub fn radius_of_curvature(&self) -> f64 {
        self.radius_of_curvature
    }

    /// The waves as given.
    pub fn waves(&self) -> &[Harmonic] {
        &self.waves
    }
}

impl Gap for Harmonics {
    fn jet(&self, r: f64) -> Jet {
        let radius = self.radius_of_curvature;
        let mut jet =
            Jet { value: r * r / (2.0 * radius), first: r / radius, second: 1.0 / radius, third: 0.0 };
        for &Term { amplitude, wavenumber: q, phase_sin, phase_cos } in &self.terms {
            let (sin, cos) = sin_cos(0.5 * q * r);
            let (shifted_sin, shifted_cos) =
                (sin * phase_cos + cos * phase_sin, cos * phase_cos - sin * phase_sin);
            let slope = amplitude * q * (sin * shifted_cos + cos * shifted_sin);
            jet.value += 2.0 * amplitude * sin * shifted_sin;
            jet.first += slope;
            jet.second += amplitude * q * q * (cos * shifted_cos - sin * shifted_sin);
            jet.third -= slope * q * q;
        }
        jet
    }

    fn values(&self, s: f64, nodes: &[f64], values: &mut [f64]) {
        map_lanes(nodes, [values], |x| {
            let r = x * s;
            let mut value = r * r / (2.0 * self.radius_of_curvature);
            for term in &self.terms {
                let [sin, _, shifted_sin, _] = term.half_way(r);
                value += sin * shifted_sin * (2.0 * term.amplitude);
            }
            [value]
        });
    }

    fn derivatives(&self, s: f64, nodes: &[f64], derivatives: [&mut [f64]; 3]) {
        map_lanes(nodes, derivatives, |x| {
            let r = x * s;
            let mut first = r / self.radius_of_curvature;
            let mut second = f64x4::splat(1.0 / self.radius_of_curvature);
            let mut third = f64x4::ZERO;
            for term in &self.terms {
                let q = term.wavenumber;
                let [sin, cos, shifted_sin, shifted_cos] = term.half_way(r);
                let slope = (sin * shifted_cos + cos * shifted_sin) * (term.amplitude * q);
                first += slope;
                second += (cos * shifted_cos - sin * shifted_sin) * (term.amplitude * q * q);
                third -= slope * (q * q);
            }
            [first, second, third]
        });
    }

    fn feature_length(&self) -> Option<f64> {
        let shortest = |shortest: Option<f64>, wave: &Harmonic| {
            Some(shortest.map_or(wave.wavelength, |other| other.min(wave.wavelength)))
        };
        self.waves.iter().filter(|wave| wave.amplitude != 0.0).fold(None, shortest)
    }

    fn breaks(&self) -> Breaks<'_> {
        // The sine of a rounded multiple of π counts as zero.
        let slope = |term: &Term| term.phase_sin.abs() > PHASE_ROUNDING;
        let axis = if self.terms.iter().any(slope) { Parity::Odd } else { Parity::Even };
        Breaks { axis, ..Breaks::default() }
    }

    fn form(&self) -> Form {
        let wave = |term: &Term| Wave {
            amplitude: term.amplitude,
            wavenumber: term.wavenumber,
            phase: [term.phase_sin, term.phase_cos],
        };
        let waves = self.terms.iter().map(wave).collect();
        Form::Waves { curvature: 1.0 / self.radius_of_curvature, waves }
    }

    fn slope_bound(&self, ComplexDisc { centre, radius, .. }: ComplexDisc) -> Option<f64> {
        let wave = |&Term { amplitude, wavenumber: q, phase_sin, phase_cos }: &Term| {
            let (sin, cos) = sin_cos(q * centre);
            let (shifted_sin, shifted_cos) =
                (sin * phase_cos + cos * phase_sin, cos * phase_cos - sin * phase_sin);
            (amplitude * q).abs() * sine_change(shifted_sin, shifted_cos, q * radius)
        };
        let change = radius / self.radius_of_curvature + self.terms.iter().map(wave).sum::<f64>();
        Some(self.jet(centre).first.abs() + change)
    }

    fn reference_length(&self) -> f64 {
        self.radius_of_curvature
    }
}

/// How far the sine can be from its value at the centre x of a complex disc of this radius, w within it, from the sine
/// and cosine at x: sin (x + w) − sin x = sin x (cos w − 1) + cos x sin w.
pub fn sine_change(sin: f64, cos: f64, radius: f64) -> f64 {
    let half = sinh(0.5 * radius);
    let change = 2.0 * sin.abs() * half * half + cos.abs() * sinh(radius);
    // NaN is zero times an overflow.
    if change.is_nan() { f64::INFINITY } else { change }
}

#[cfg(test)]
mod tests {
    use super::super::fixtures::check_derivatives;
    use super::*;
    use crate::gap::Shape;

    fn wave(amplitude: f64, wavelength: f64, phase: f64) -> Harmonic {
        Harmonic { amplitude, wavelength, phase }
    }

    #[test]
    fn derivatives_agree_with_central_differences() {
        let waves = vec![wave(0.003, 0.07, 0.0), wave(-0.001, 0.2, 1.1), wave(0.02, 1.3, -2.0)];
        let gap = Harmonics::new(0.8, waves).unwrap();
        for i in 1..40 {
            check_derivatives(&gap, 0.013 * f64::from(i), 0.07);
        }
    }

    #[test]
    fn one_wave_of_phase_zero_is_the_wavy_sphere() {
        let gap = Harmonics::new(0.8, vec![wave(0.003, 0.07, 0.0)]).unwrap();
        let paper = Shape::WavySphere { radius_of_curvature: 0.8, amplitude: 0.003, wavelength: 0.07 };
        for i in 0..50 {
            let r = 0.011 * f64::from(i);
            let (a, b) = (gap.jet(r), paper.jet(r));
            let q = TAU / 0.07;
            for (a, b, size) in [
                (a.value, b.value, 0.2),
                (a.first, b.first, 1.0),
                (a.second, b.second, 0.003 * q * q),
                (a.third, b.third, 0.003 * q * q * q),
            ] {
                assert!((a - b).abs() <= 1e-14 * size, "{r}: {a} {b}");
            }
        }
        assert_eq!((gap.feature_length(), gap.reference_length()), (Some(0.07), 0.8));
    }

    #[test]
    fn phases_keep_the_axis_and_its_digits() {
        let gap = Harmonics::new(1.0, vec![wave(0.01, 0.1, 0.7)]).unwrap();
        let q = TAU / 0.1;
        assert!(gap.jet(0.0).value.abs() < f64::MIN_POSITIVE);
        let r = 1e-12;
        let slope = 0.01 * q * 0.7_f64.sin();
        assert!((gap.jet(r).value / (slope * r) - 1.0).abs() < 1e-9);
    }

    #[test]
    fn many_radii_at_once_are_those_one_by_one() {
        let waves = vec![wave(0.003, 0.07, 0.3), wave(-0.001, 0.2, 1.1), wave(2e-5, 0.003, -2.0)];
        let gap = Harmonics::new(0.8, waves).unwrap();
        let nodes: Vec<f64> = (0..101).map(|i| 0.013 * f64::from(i)).collect();
        let [mut values, mut first, mut second, mut third] = [const { [0.0; 101] }; 4];
        gap.values(1.5, &nodes, &mut values);
        gap.derivatives(1.5, &nodes, [&mut first, &mut second, &mut third]);
        let q = TAU / 0.003;
        for (i, x) in nodes.iter().enumerate() {
            let jet = gap.jet(1.5 * x);
            for (lane, alone, size) in [
                (values[i], jet.value, 1.0),
                (first[i], jet.first, 1.0),
                (second[i], jet.second, q),
                (third[i], jet.third, q * q),
            ] {
                assert!((lane - alone).abs() <= 1e-14 * size, "{x}: {lane} {alone}");
            }
        }
    }

    #[test]
    fn only_waves_with_an_amplitude_count() {
        let none = Harmonics::new(2.0, vec![wave(0.0, 0.01, 0.3)]).unwrap();
        assert_eq!(none.feature_length(), None);
        assert_eq!(none.jet(0.3), Shape::Sphere { radius_of_curvature: 2.0 }.jet(0.3));
        let some =
            Harmonics::new(2.0, vec![wave(0.0, 0.01, 0.0), wave(1e-3, 0.3, 0.0), wave(-1e-3, 0.2, 0.0)]);
        assert_eq!(some.unwrap().feature_length(), Some(0.2));
        assert_eq!(Harmonics::new(1.0, vec![wave(0.0, 1.0, 0.0); 1001]), Err(TooManyWaves(1001)));
    }
}
