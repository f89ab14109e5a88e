//! The transform of a paraboloid with waves.
//!
//! ```text
//! g(a)  = κa² + Σ A q a ∫₀^{π/2} sin(q a sin θ + φ) dθ
//! g'(a) = 2κa + Σ A q [∫ sin(q a sin θ + φ) dθ + q a ∫ cos(q a sin θ + φ) sin θ dθ]
//! ```
//!
//! One Gauss rule in θ serves all panels. On a panel a = c + d x the angle is that of its centre plus a part that
//! panels of one width share: with the addition theorems a panel takes one sine and cosine for each θ, not one for each
//! θ and x.

use super::chebyshev::ChebyshevRule;
use crate::elementary::{sin, sin_cos};
use crate::gap::Wave;
use crate::gap::panels::Span;
use crate::progress::{Progress, Stopped};
use gauss_quad::GaussLegendre;
use std::f64::consts::FRAC_PI_2;
use std::num::NonZeroUsize;
use std::sync::{Arc, OnceLock};
use wide::f64x4;

/// Nodes in x on a panel of half a wave.
pub const NODES: usize = 20;

/// Half of them: nodes are symmetric about 0.
const HALF: usize = NODES / 2;

/// Nodes in θ, on a quarter turn, for each radian of phase at its end, and for a gap without waves.
const PER_RADIAN: f64 = 1.0 / 3.0;
const MORE: f64 = 14.0;

/// Numbers of nodes are multiples of this, and rules of up to this many multiples are kept.
const GROUP: usize = 4;
const KEPT: usize = 256;

/// g and g' at the nodes of each of `spans`, which are panels in the radius itself.
///
/// # Errors
/// [`Stopped`].
pub fn transform(
    curvature: f64,
    waves: &[Wave],
    spans: &[Span],
    progress: &dyn Progress,
) -> Result<Vec<[[f64; NODES]; 2]>, Stopped> {
    let rule = ChebyshevRule::of(NODES);
    let mut samples: Vec<[[f64; NODES]; 2]> = spans
        .iter()
        .map(|span| {
            let radii: [f64; NODES] = std::array::from_fn(|j| span.radius(rule.nodes[j]));
            [radii.map(|a| curvature * a * a), radii.map(|a| 2.0 * curvature * a)]
        })
        .collect();
    let Some(farthest) = spans.last().map(|span| span.hi) else { return Ok(samples) };
    let steepest = waves.iter().fold(0.0_f64, |most, wave| most.max(wave.wavenumber));
    let theta = &*WaveAngles::of(PER_RADIAN * steepest * farthest + MORE);
    for wave in waves {
        let mut shared: Option<(f64, PhaseTable)> = None;
        for (span, samples) in spans.iter().zip(&mut samples) {
            progress.go_on()?;
            let [centre, half] = span.line();
            if shared.as_ref().is_none_or(|(width, _)| width.to_bits() != half.to_bits()) {
                shared = Some((half, PhaseTable::new(theta, wave.wavenumber * half)));
            }
            if let Some((_, shared)) = &shared {
                add(wave, theta, shared, [centre, half], samples);
            }
        }
    }
    Ok(samples)
}

/// g, ∫₀ᵃ g, and g', g'', g''' at one radius, without a table.
///
/// ```text
/// g''  = 2κ + Σ A q² [2 ∫ cos u sin θ dθ − q a ∫ sin u sin²θ dθ],      u = q a sin θ + φ
/// g''' = −Σ A q³ [3 ∫ sin u sin²θ dθ + q a ∫ cos u sin³θ dθ],          ∫g = κa³/3 + Σ A q a² ∫ sin u cos²θ dθ
/// ```
pub fn at(curvature: f64, waves: &[Wave], a: f64) -> ([f64; 2], [f64; 3]) {
    let mut whole = [curvature * a * a, curvature * a.powi(3) / 3.0];
    let mut slopes = [2.0 * curvature * a, 2.0 * curvature, 0.0];
    for wave in waves {
        let q = wave.wavenumber;
        let theta = &*WaveAngles::of(PER_RADIAN * q * a + MORE);
        let [sine_phase, cosine_phase] = wave.phase;
        let [mut s0, mut s2, mut c1, mut c3] = [0.0; 4];
        for (t, weight) in theta.sines.iter().zip(&theta.weights) {
            let (sine, cosine) = sin_cos(q * a * t);
            let (su, cu) =
                (sine * cosine_phase + cosine * sine_phase, cosine * cosine_phase - sine * sine_phase);
            s0 += weight * su;
            s2 += weight * su * t * t;
            c1 += weight * cu * t;
            c3 += weight * cu * t * t * t;
        }
        let (height, phase) = (wave.amplitude * q, q * a);
        whole[0] += height * a * s0;
        whole[1] += height * a * a * (s0 - s2);
        slopes[0] += height * (s0 + phase * c1);
        slopes[1] += height * q * (2.0 * c1 - phase * s2);
        slopes[2] -= height * q * q * (3.0 * s2 + phase * c3);
    }
    (whole, slopes)
}

/// Gauss's nodes in θ on (0, π/2): the half of a rule on (0, π), about whose middle everything is symmetric.
struct WaveAngles {
    /// sin θ.
    sines: Vec<f64>,
    /// The weights of ∫ dθ.
    weights: Vec<f64>,
}

impl WaveAngles {
    /// The rule of at least this many nodes: one of a few sizes, each made once if it is small enough to be kept.
    fn of(nodes: f64) -> Arc<Self> {
        static RULES: [OnceLock<Arc<WaveAngles>>; KEPT] = [const { OnceLock::new() }; KEPT];
        // Positive and at most a few thousand.
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let groups = (nodes / GROUP as f64).ceil() as usize;
        let make = || Arc::new(Self::new(groups * GROUP));
        RULES.get(groups).map_or_else(make, |kept| Arc::clone(kept.get_or_init(make)))
    }

    fn new(nodes: usize) -> Self {
        let rule = GaussLegendre::new(NonZeroUsize::new(2 * nodes).unwrap_or(NonZeroUsize::MIN));
        let half = || rule.iter().take(nodes);
        Self {
            sines: half().map(|(x, _)| sin(FRAC_PI_2 * (1.0 + x))).collect(),
            weights: half().map(|(_, weight)| FRAC_PI_2 * weight).collect(),
        }
    }
}

/// The cosine and sine of q d x sin θ for the first half of the nodes in x, for each θ.
struct PhaseTable {
    cosines: Vec<[f64; HALF]>,
    sines: Vec<[f64; HALF]>,
}

impl PhaseTable {
    fn new(theta: &WaveAngles, width: f64) -> Self {
        let rule = ChebyshevRule::of(NODES);
        let angles: Vec<f64> = theta
            .sines
            .iter()
            .flat_map(|sine| rule.nodes[..HALF].iter().map(move |x| width * x * sine))
            .collect();
        let (sines, cosines) = sines_and_cosines(&angles);
        let rows = |flat: &[f64]| flat.as_chunks::<HALF>().0.to_vec();
        Self { cosines: rows(&cosines), sines: rows(&sines) }
    }
}

/// The sines and cosines of `angles`, whose number is even.
fn sines_and_cosines(angles: &[f64]) -> (Vec<f64>, Vec<f64>) {
    let (mut sines, mut cosines) = (vec![0.0; angles.len()], vec![0.0; angles.len()]);
    crate::gap::lanes::map_lanes(angles, [&mut sines, &mut cosines], |angle: f64x4| {
        let (sin, cos) = angle.sin_cos();
        [sin, cos]
    });
    (sines, cosines)
}

/// Adds what one wave gives on one panel.
fn add(
    wave: &Wave,
    theta: &WaveAngles,
    shared: &PhaseTable,
    [centre, half]: [f64; 2],
    samples: &mut [[f64; NODES]; 2],
) {
    let q = wave.wavenumber;
    let angles: Vec<f64> = theta.sines.iter().map(|sine| q * centre * sine).collect();
    let (sines, cosines) = sines_and_cosines(&angles);
    let [phase_sin, phase_cos] = wave.phase;
    // Even and odd parts in x of ∫ sin(…) dθ and of ∫ cos(…) sin θ dθ.
    let [mut even, mut odd, mut slope_even, mut slope_odd] = [[0.0; HALF]; 4];
    for m in 0..theta.sines.len() {
        let weight = theta.weights[m];
        let sin = weight * (sines[m] * phase_cos + cosines[m] * phase_sin);
        let cos = weight * (cosines[m] * phase_cos - sines[m] * phase_sin);
        let (steep_sin, steep_cos) = (theta.sines[m] * sin, theta.sines[m] * cos);
        let (c, s) = (&shared.cosines[m], &shared.sines[m]);
        for j in 0..HALF {
            even[j] += sin * c[j];
            odd[j] += cos * s[j];
            slope_even[j] += steep_cos * c[j];
            slope_odd[j] -= steep_sin * s[j];
        }
    }
    let nodes = &ChebyshevRule::of(NODES).nodes;
    let size = wave.amplitude * q;
    for j in 0..HALF {
        for (at, sign) in [(j, 1.0), (NODES - 1 - j, -1.0)] {
            let a = centre + half * nodes[at];
            let value = even[j] + sign * odd[j];
            samples[0][at] += size * a * value;
            samples[1][at] += size * (value + q * a * (slope_even[j] + sign * slope_odd[j]));
        }
    }
}
