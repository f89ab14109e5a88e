//! The gap shapes a user can choose.

use super::breaks::Breaks;
use super::formula::TypedGap;
use super::function::{ComplexDisc, Form, Gap, Jet, Wave};
use super::lanes::map_lanes;
use super::shapes::harmonics::sine_change;
use super::shapes::power_law::NEARLY_A_CONE;
use super::shapes::random_waves::RandomWavesError;
use super::shapes::{ExactSphere, Harmonics, MeasuredGap, PowerLaw, RandomWaves};
use crate::elementary::{self, sin_cos};
use crate::units::number::said;
use crate::units::{Quantity, UnitSystem};
use std::f64::consts::{PI, TAU};
use std::sync::Arc;
use wide::f64x4;

/// A gap shape with its parameters, in any consistent units. Cheap to clone.
#[derive(Debug, Clone, PartialEq)]
pub enum Shape {
    /// The paraboloid h = r²/(2R), eq. (20).
    Sphere {
        /// Combined radius of curvature R, a length.
        radius_of_curvature: f64,
    },
    /// The paraboloid with axisymmetric waves, h = r²/(2R) + A(1 − cos(2πr/λ)), eq. (23).
    WavySphere {
        /// Combined radius of curvature R, a length.
        radius_of_curvature: f64,
        /// Amplitude A of the wave, a length.
        amplitude: f64,
        /// Wavelength λ, a length.
        wavelength: f64,
    },
    /// The exact sphere, h = R − √(R² − r²).
    ExactSphere(ExactSphere),
    /// The cone h = c r, by its slope c.
    Cone {
        /// c, the cotangent of the half apex angle.
        slope: f64,
    },
    /// h = c rⁿ.
    PowerLaw(PowerLaw),
    /// A paraboloid with any waves.
    Harmonics(Arc<Harmonics>),
    /// A paraboloid with waves drawn from a power law.
    RandomWaves {
        /// The parameters from which they are drawn.
        spectrum: RandomWaves,
        /// The waves drawn.
        drawn: Arc<Harmonics>,
    },
    /// A formula in r.
    Formula(Arc<TypedGap>),
    /// A measured profile.
    Profile(Arc<MeasuredGap>),
}

impl Shape {
    /// The waves of `spectrum`.
    ///
    /// # Errors
    /// [`RandomWavesError`], naming the number that is out of range.
    pub fn random_waves(spectrum: RandomWaves) -> Result<Self, RandomWavesError> {
        Ok(Self::RandomWaves { spectrum, drawn: Arc::new(spectrum.harmonics()?) })
    }

    /// The name used in preset files.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Sphere { .. } => "sphere",
            Self::WavySphere { .. } => "wavy-sphere",
            Self::ExactSphere(_) => "exact-sphere",
            Self::Cone { .. } => "cone",
            Self::PowerLaw(_) => "power-law",
            Self::Harmonics(_) => "harmonics",
            Self::RandomWaves { .. } => "random-waves",
            Self::Formula(_) => "formula",
            Self::Profile(_) => "profile",
        }
    }

    /// R, where the shape has one: of the sphere, of the paraboloid the shape is built on, the parameter `R` of a
    /// formula, or of the paraboloid nearest to a profile.
    pub fn radius_of_curvature(&self) -> Option<f64> {
        match self {
            Self::Sphere { radius_of_curvature } | Self::WavySphere { radius_of_curvature, .. } => {
                Some(*radius_of_curvature)
            }
            Self::ExactSphere(sphere) => Some(sphere.radius),
            Self::Harmonics(waves) => Some(waves.radius_of_curvature()),
            Self::RandomWaves { spectrum, .. } => Some(spectrum.radius_of_curvature),
            Self::Formula(typed) => typed.radius_of_curvature(),
            Self::Profile(measured) => measured.profile().radius_of_curvature(),
            Self::Cone { .. } | Self::PowerLaw(_) => None,
        }
    }

    /// The length by which the problem is reduced: R; otherwise the radius where h = r/2, as for a
    /// paraboloid, h(R) = R/2; otherwise the extent of a profile. A cone has none.
    pub fn length(&self) -> Option<f64> {
        self.radius_of_curvature().or_else(|| match self {
            Self::PowerLaw(law) if law.exponent >= NEARLY_A_CONE => Some(law.reference_length()),
            Self::Formula(typed) => typed.length(),
            Self::Profile(measured) => measured.profile().largest_radius(),
            _ => None,
        })
    }

    /// Amplitude A and wavelength λ, where the shape has a single wave: the paper's wavy sphere.
    pub fn wave(&self) -> Option<(f64, f64)> {
        match *self {
            Self::WavySphere { amplitude, wavelength, .. } => Some((amplitude, wavelength)),
            _ => None,
        }
    }

    /// Amplitude and wavelength of each wave, where the shape is a paraboloid with waves.
    pub fn waves(&self) -> Vec<(f64, f64)> {
        match self {
            Self::WavySphere { amplitude, wavelength, .. } => vec![(*amplitude, *wavelength)],
            Self::Harmonics(waves) | Self::RandomWaves { drawn: waves, .. } => {
                waves.waves().iter().map(|wave| (wave.amplitude, wave.wavelength)).collect()
            }
            _ => Vec::new(),
        }
    }

    /// The largest slope within a contact of this radius, if it is not small beside 1; of a gap with waves, near the edge.
    /// A paraboloid is as steep as its contact is large beside R, which is told where paths are.
    pub fn steep_slope(&self, contact_radius: f64) -> Option<f64> {
        const RADII: usize = 512;
        const PER_WAVE: f64 = 16.0;
        const STEEP: f64 = 1.0;
        if matches!(self, Self::Sphere { .. }) {
            return None;
        }
        let near = self.feature_length().map_or(f64::INFINITY, |wave| RADII as f64 / PER_WAVE * wave);
        let width = near.min(contact_radius);
        let radii = (0..RADII).map(|i| contact_radius - width * i as f64 / RADII as f64);
        let steepest = radii.map(|r| self.jet(r).first.abs()).fold(0.0, f64::max);
        // Of the other shapes the waves tell how fine they are.
        let is_formula = matches!(self, Self::Formula(_));
        let steepest =
            if is_formula { self.steepest_within(contact_radius, steepest.max(STEEP)) } else { steepest };
        (steepest > STEEP).then_some(steepest)
    }

    /// The largest slope within this radius, if it is larger than `known`: radii are divided where the bound on the slope exceeds
    /// what is known, so that no feature is too narrow. Without bounds, `known`.
    fn steepest_within(&self, contact_radius: f64, known: f64) -> f64 {
        /// It is found to this factor, unless more than so many intervals would have to be examined.
        const FACTOR: f64 = 1.2;
        const MOST: usize = 1 << 13;
        let mut steepest = known;
        let mut open = vec![[0.0, contact_radius]];
        let mut examined = 0;
        while !open.is_empty() && examined < MOST {
            examined += open.len();
            let mut halves = Vec::new();
            for [lo, hi] in open {
                let (middle, radius) = (0.5 * (lo + hi), 0.5 * (hi - lo));
                let disc = ComplexDisc { centre: middle, radius, branch: middle };
                let Some(bound) = self.slope_bound(disc) else { return known };
                let here = self.jet(middle).first.abs();
                steepest = if here.is_finite() { steepest.max(here) } else { steepest };
                if (bound > FACTOR * steepest || bound.is_nan()) && lo < middle && middle < hi {
                    halves.extend([[lo, middle], [middle, hi]]);
                }
            }
            open = halves;
        }
        steepest
    }

    /// What was changed in the gap without the user asking for it, in words, with numbers as `units` show them.
    pub fn notes(&self, units: &UnitSystem) -> Vec<String> {
        match self {
            Self::Formula(typed) => {
                let flat = || "the formula has no r, the radius: the gap is flat".to_owned();
                let mut notes: Vec<String> = (!typed.formula().has_radius()).then(flat).into_iter().collect();
                notes.extend(typed.shift().filter(|_| notes.is_empty()).map(|shift| {
                    format!(
                        "the formula is {} on the axis: this is subtracted, since the gap is zero there",
                        said(units, Quantity::Length, shift)
                    )
                }));
                notes
            }
            Self::Profile(measured) => {
                let rows = measured.rows();
                let mut notes = rows.notes.clone();
                // The presets that use data shipped with the program already say so.
                let unit = rows.unit.as_ref().filter(|_| *units == UnitSystem::Reduced && !rows.is_shipped());
                notes.extend(unit.map(|unit| {
                    format!(
                        "{}: names {} as the unit of its radii, which is the unit of all lengths here: the \
                         preset is in reduced units; units = \"SI\" converts them",
                        rows.name,
                        unit.ascii()
                    )
                }));
                notes
            }
            _ => Vec::new(),
        }
    }

    /// What else is worth knowing about the gap, in the same form.
    pub fn remarks(&self, units: &UnitSystem) -> Vec<String> {
        match self {
            Self::Profile(measured) => measured.profile().remarks(units),
            _ => Vec::new(),
        }
    }

    /// The gap, unless it is one of the paper's two, which are computed here.
    fn other(&self) -> Option<ShapeGap<'_>> {
        Some(match self {
            Self::Sphere { .. } | Self::WavySphere { .. } => return None,
            Self::ExactSphere(gap) => ShapeGap::Ref(gap),
            Self::Cone { slope } => ShapeGap::Cone(PowerLaw::cone(*slope)),
            Self::PowerLaw(gap) => ShapeGap::Ref(gap),
            Self::Harmonics(gap) | Self::RandomWaves { drawn: gap, .. } => ShapeGap::Ref(&**gap),
            Self::Formula(typed) => ShapeGap::Ref(typed.gap()),
            Self::Profile(measured) => ShapeGap::Ref(measured.profile()),
        })
    }

    /// R of the paper's two gaps.
    fn paraboloid(&self) -> f64 {
        self.radius_of_curvature().unwrap_or(f64::NAN)
    }
}

/// A gap that is computed in its own file.
enum ShapeGap<'a> {
    Ref(&'a dyn Gap),
    Cone(PowerLaw),
}

impl ShapeGap<'_> {
    fn gap(&self) -> &dyn Gap {
        match self {
            Self::Ref(gap) => *gap,
            Self::Cone(cone) => cone,
        }
    }
}

impl Gap for Shape {
    fn jet(&self, r: f64) -> Jet {
        if let Some(other) = self.other() {
            return other.gap().jet(r);
        }
        let radius = self.paraboloid();
        let mut jet =
            Jet { value: r * r / (2.0 * radius), first: r / radius, second: 1.0 / radius, third: 0.0 };
        if let Some((amplitude, wavelength)) = self.wave() {
            let q = TAU / wavelength;
            let (sin, cos) = sin_cos(q * r);
            // 1 − cos x = 2 sin²(x/2) keeps its digits near the axis, where h matters as a difference.
            let half = elementary::sin(0.5 * q * r);
            jet.value += 2.0 * amplitude * half * half;
            jet.first += amplitude * q * sin;
            jet.second += amplitude * q * q * cos;
            jet.third -= amplitude * q * q * q * sin;
        }
        jet
    }

    fn values(&self, s: f64, nodes: &[f64], values: &mut [f64]) {
        if let Some(other) = self.other() {
            return other.gap().values(s, nodes, values);
        }
        let curvature = 1.0 / self.paraboloid();
        let (amplitude, wavelength) = self.wave().unwrap_or((0.0, f64::INFINITY));
        let half = f64x4::splat(PI / wavelength);
        map_lanes(nodes, [values], |x| {
            let r = x * f64x4::splat(s);
            let sin = (half * r).sin();
            [r * r * f64x4::splat(0.5 * curvature) + sin * sin * f64x4::splat(2.0 * amplitude)]
        });
    }

    fn derivatives(&self, s: f64, nodes: &[f64], derivatives: [&mut [f64]; 3]) {
        if let Some(other) = self.other() {
            return other.gap().derivatives(s, nodes, derivatives);
        }
        let (s, curvature) = (f64x4::splat(s), f64x4::splat(1.0 / self.paraboloid()));
        let Some((amplitude, wavelength)) = self.wave() else {
            return map_lanes(nodes, derivatives, |x| [s * x * curvature, curvature, f64x4::ZERO]);
        };
        let q = TAU / wavelength;
        let [first, second, third] =
            [amplitude * q, amplitude * q * q, -amplitude * q * q * q].map(f64x4::splat);
        let q = f64x4::splat(q);
        map_lanes(nodes, derivatives, |x| {
            let r = s * x;
            let (sin, cos) = (q * r).sin_cos();
            [r * curvature + first * sin, curvature + second * cos, third * sin]
        });
    }

    fn feature_length(&self) -> Option<f64> {
        if let Some(other) = self.other() {
            return other.gap().feature_length();
        }
        self.wavelength()
    }

    fn wavelength(&self) -> Option<f64> {
        // A wave without amplitude is no feature: mesh and steps need not resolve it.
        self.wave().filter(|(amplitude, _)| *amplitude > 0.0).map(|(_, wavelength)| wavelength)
    }

    fn breaks(&self) -> Breaks<'_> {
        match self.other() {
            None => Breaks::default(),
            Some(ShapeGap::Ref(gap)) => gap.breaks(),
            Some(ShapeGap::Cone(_)) => PowerLaw::CONE_BREAKS,
        }
    }

    fn form(&self) -> Form {
        if let Some(other) = self.other() {
            return other.gap().form();
        }
        let radius = self.paraboloid();
        let Some((amplitude, wavelength)) = self.wave() else {
            return Form::Power { factor: 0.5 / radius, exponent: 2.0 };
        };
        let wave = Wave { amplitude, wavenumber: TAU / wavelength, phase: [0.0, 1.0] };
        let waves = if amplitude == 0.0 { Vec::new() } else { vec![wave] };
        Form::Waves { curvature: 1.0 / radius, waves }
    }

    fn slope_bound(&self, disc: ComplexDisc) -> Option<f64> {
        if let Some(other) = self.other() {
            return other.gap().slope_bound(disc);
        }
        let ComplexDisc { centre, radius, .. } = disc;
        let wave = self.wave().map_or(0.0, |(amplitude, wavelength)| {
            let q = TAU / wavelength;
            let (sin, cos) = sin_cos(q * centre);
            (amplitude * q).abs() * sine_change(sin, cos, q * radius)
        });
        Some(self.jet(centre).first.abs() + radius / self.paraboloid() + wave)
    }

    fn breaks_up_to(&self, to: f64) -> Vec<f64> {
        self.other().map_or_else(Vec::new, |other| other.gap().breaks_up_to(to))
    }

    fn uncertified(&self) -> Option<&'static str> {
        self.other()?.gap().uncertified()
    }

    fn reference_length(&self) -> f64 {
        self.length().unwrap_or(1.0)
    }

    fn largest_radius(&self) -> Option<f64> {
        self.other()?.gap().largest_radius()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gap::fixtures::{Complex, largest_on};
    use crate::gap::function::Scaled;
    use crate::gap::{shapes::Harmonic, shapes::ProfileGap, shapes::Smoothing};

    #[test]
    fn derivatives_agree_with_central_differences() {
        let shapes = [
            Shape::Sphere { radius_of_curvature: 1.7 },
            Shape::WavySphere { radius_of_curvature: 0.8, amplitude: 0.003, wavelength: 0.07 },
        ];
        for shape in shapes {
            for i in 1..40 {
                let r = 0.013 * f64::from(i);
                let e = 1e-6;
                let (lo, at, hi) = (shape.jet(r - e), shape.jet(r), shape.jet(r + e));
                for (difference, exact) in [
                    (hi.value - lo.value, at.first),
                    (hi.first - lo.first, at.second),
                    (hi.second - lo.second, at.third),
                ] {
                    let slope = difference / (2.0 * e);
                    assert!(
                        (slope - exact).abs() <= 1e-5 * (1.0 + exact.abs()),
                        "{shape:?} r={r}: {slope} {exact}"
                    );
                }
            }
        }
    }

    #[test]
    fn many_radii_at_once_are_the_same_as_one_by_one() {
        let nodes: Vec<f64> = (0..23).map(|i| f64::from(i) / 22.0).collect();
        let wave = Shape::WavySphere { radius_of_curvature: 0.8, amplitude: 0.003, wavelength: 0.07 };
        for shape in [Shape::Sphere { radius_of_curvature: 1.7 }, wave] {
            // The same in another unit of length.
            let gap = Scaled::new(shape.clone(), 0.3);
            let s = 4.1;
            let mut found = [(); 4].map(|()| vec![f64::NAN; nodes.len()]);
            let [value, first, second, third] = &mut found;
            gap.values(s, &nodes, value);
            gap.derivatives(s, &nodes, [first, second, third]);
            let jets: Vec<Jet> = nodes.iter().map(|x| gap.jet(s * x)).collect();
            let columns = [|j: &Jet| j.value, |j: &Jet| j.first, |j: &Jet| j.second, |j: &Jet| j.third];
            for (k, (column, found)) in columns.iter().zip(&found).enumerate() {
                let size = jets.iter().map(|jet| column(jet).abs()).fold(0.0, f64::max);
                for ((jet, found), x) in jets.iter().zip(found).zip(&nodes) {
                    let off = (column(jet) - found).abs();
                    // At a phase of 110 a wave has lost two digits of its argument either way.
                    assert!(off <= 1e-13 * size, "{gap:?} x={x} derivative {k}: off by {off:e}");
                }
            }
            // Near the axis the gap keeps its digits.
            let (value, exact) = (found[0][1], jets[1].value);
            assert!((value / exact - 1.0).abs() < 1e-13, "{gap:?}: {value} {exact}");
        }
    }

    #[test]
    fn a_wave_without_amplitude_is_no_feature() {
        let flat = Shape::WavySphere { radius_of_curvature: 1.0, amplitude: 0.0, wavelength: 0.1 };
        assert_eq!(flat.feature_length(), None);
        assert_eq!(flat.jet(0.3), Shape::Sphere { radius_of_curvature: 1.0 }.jet(0.3));
    }

    /// h' at a complex radius, for the piece that holds at a real one.
    type Slope<'a> = Box<dyn Fn(Complex, f64) -> Complex + 'a>;

    #[test]
    fn slopes_on_discs_stay_within_their_bounds() {
        let wave = |amplitude, wavelength, phase| Harmonic { amplitude, wavelength, phase };
        let waves = vec![wave(0.003, 0.07, 0.0), wave(-0.001, 0.2, 1.1)];
        let rows: Vec<f64> = (0..40).map(|i| f64::from(i) / 20.0).collect();
        let heights: Vec<f64> = rows.iter().map(|r| 0.5 * r * r + 0.01 * (9.0 * r).cos()).collect();
        let profile = ProfileGap::new(&rows, &heights, Smoothing::None).unwrap();
        let spline = profile.clone();
        let sine = |z: Complex, Harmonic { amplitude, wavelength, phase }: Harmonic| {
            let q = TAU / wavelength;
            (z * q + phase).sin() * (amplitude * q)
        };
        let examples: Vec<(Box<dyn Gap>, Slope)> = vec![
            (Box::new(Shape::Sphere { radius_of_curvature: 1.7 }), Box::new(|z, _| z * (1.0 / 1.7))),
            (
                Box::new(Shape::WavySphere { radius_of_curvature: 0.8, amplitude: 0.003, wavelength: 0.07 }),
                Box::new(|z, _| z * 1.25 + sine(z, waves[0])),
            ),
            (
                Box::new(Harmonics::new(0.8, waves.clone()).unwrap()),
                Box::new(|z, _| z * 1.25 + sine(z, waves[0]) + sine(z, waves[1])),
            ),
            (Box::new(Shape::Cone { slope: 0.3 }), Box::new(|_, _| Complex(0.3, 0.0))),
            (Box::new(PowerLaw { factor: 0.4, exponent: 2.7 }), Box::new(|z, _| z.power(1.7) * (0.4 * 2.7))),
            (Box::new(PowerLaw { factor: 0.4, exponent: 4.0 }), Box::new(|z, _| z * z * z * 1.6)),
            (Box::new(ExactSphere { radius: 1.7 }), Box::new(|z, _| z / (-(z * z) + 1.7 * 1.7).power(0.5))),
            (
                Box::new(profile),
                Box::new(|z, branch| {
                    let jet = spline.jet(branch);
                    let t = z + -branch;
                    t * t * (0.5 * jet.third) + t * jet.second + jet.first
                }),
            ),
        ];
        let mut random = fastrand::Rng::with_seed(2);
        for (gap, slope) in &examples {
            let mut looked_at = 0;
            for _ in 0..300 {
                let (centre, branch) = (1.5 * random.f64(), 1.5 * random.f64());
                let radius = 10f64.powf(-4.0 + 4.0 * random.f64());
                let most = gap.slope_bound(ComplexDisc { centre, radius, branch }).unwrap();
                looked_at += i32::from(most.is_finite());
                let largest = largest_on(centre, radius, |z| slope(z, branch));
                assert!(
                    largest <= most * (1.0 + 1e-12) || most.is_infinite(),
                    "{gap:?} {centre} {radius}: {largest} {most}"
                );
                // A small disc is little more than its centre.
                if radius < 1e-3 && most.is_finite() {
                    assert!(most <= 1.01 * largest + 0.01, "{gap:?} {centre} {radius}: {largest} {most}");
                }
            }
            assert!(looked_at > 200, "{gap:?}");
        }
    }

    #[test]
    fn another_unit_of_length_keeps_breaks_and_bounds() {
        let text = "r^2/2 + 0.01*abs(r - 0.3) + max(r - 0.7, 0)^2";
        let plain = TypedGap::new(text, Vec::new(), Some(1.0)).unwrap();
        let shape = Shape::Formula(Arc::new(plain.clone()));
        for length in [0.3, 1.7e-6, 12.1] {
            let scaled = Scaled::new(shape.clone(), length);
            let breaks = scaled.breaks_up_to(1.0 / length);
            assert_eq!(breaks.len(), 2);
            for (found, exact) in breaks.iter().zip([0.3, 0.7]) {
                assert!(length * found >= exact && length * found.next_down() < exact, "{found} {exact}");
            }
            let disc = ComplexDisc { centre: 0.5, radius: 0.1, branch: 0.4 };
            let [centre, radius, branch] = [0.5, 0.1, 0.4].map(|r| r / length);
            let (ours, exact) =
                (scaled.slope_bound(ComplexDisc { centre, radius, branch }), plain.gap().slope_bound(disc));
            assert!((ours.unwrap() / exact.unwrap() - 1.0).abs() < 1e-14);
            assert_eq!(scaled.uncertified(), None);
        }
        // Beyond the range searched at first.
        assert_eq!(shape.breaks_up_to(100.0), [0.3, 0.7]);
    }
}
