//! The theory drawn over a curve, computed with it.

use pulloff_engine::case::Case;
use pulloff_engine::gap::Shape;
use pulloff_engine::progress::Progress;
use pulloff_engine::quasistatic::Curve;
use pulloff_engine::theory::guduru::Guduru;
use pulloff_engine::theory::kesari_lew::{EnvelopeSide, KesariLew};
use pulloff_engine::theory::{Disc, Exact};

/// The number of points of a smooth curve, enough for its difference from a wavy one to show the waves.
const SMOOTH_POINTS: u32 = 1000;
/// Theory extends beyond both ends of the curve, as far as a chart shows it: outward to this many times the start,
/// inward to this share of the end.
const BEYOND: [f64; 2] = [1.1, 0.1];
/// The number of states of the exact solution beyond each end of the curve.
const BEYOND_POINTS: u32 = 16;

/// δ, P and s of one state, in the user's units.
pub type TheoryState = [f64; 3];

/// Theory over the radii of a curve and a little beyond, in the user's units.
#[derive(Debug, Clone)]
pub struct Theory {
    /// The smooth sphere of the same curvature and adhesion; empty without a radius of curvature.
    pub smooth: Vec<TheoryState>,
    /// Its name: Hertz or JKR; without a sphere, what is missing.
    pub smooth_name: &'static str,
    /// The exact solution of the gap, with as many points as the curve.
    pub exact: Vec<TheoryState>,
    pub exact_name: &'static str,
    /// The envelope of small waves; only for wavy spheres with adhesion.
    pub envelope: Option<Envelope>,
}

/// The envelope of Kesari and Lew.
#[derive(Debug, Clone)]
pub struct Envelope {
    /// The side along which a disc peels.
    pub unloading: Vec<TheoryState>,
    /// The side along which it grows.
    pub loading: Vec<TheoryState>,
    /// The peak of the pull, `P_off/P_c`.
    pub peak: f64,
    /// n = s/λ at the peak: with n ≥ 5 the peak is good to 2 %, with n ≥ 20 to 0.2 %.
    pub waves: f64,
}

impl Theory {
    /// The theory of `case` from beyond its start to beyond its end; `None` if `progress` asked to stop.
    pub fn of(case: &Case, curve: &Curve, progress: &dyn Progress) -> Option<Self> {
        let units = case.units();
        let (start, end) = (case.start * units.length, case.end * units.length);
        let [from, to] = [BEYOND[0] * start, BEYOND[1] * end];
        let smooth: Vec<f64> = (0..=SMOOTH_POINTS)
            .map(|i| {
                // Even in √s: the curve behaves like √s towards the axis.
                let x = f64::from(i) / f64::from(SMOOTH_POINTS);
                (from.sqrt() + (to.sqrt() - from.sqrt()) * x).powi(2)
            })
            .collect();
        let steps = |from: f64, to: f64| {
            (0..BEYOND_POINTS).map(move |i| from + (to - from) * f64::from(i) / f64::from(BEYOND_POINTS))
        };
        let own = curve.samples.iter().map(|at| at.contact_radius * units.length);
        let inward = steps(0.0, end - to).map(|less| end - less).skip(1);
        let fine: Vec<f64> = steps(from, start).chain(own).chain(inward).chain([to]).collect();
        let (jkr, exact) = (case.smooth(), Exact::of(&case.problem));
        // The exact solutions hold for adhesion without a range.
        let (fine, envelope) =
            if case.cohesion.is_some() { (Vec::new(), None) } else { (fine, envelope(case, &smooth)) };
        Some(Self {
            smooth: jkr.map_or_else(|| Some(Vec::new()), |jkr| along(&jkr, &smooth, progress))?,
            smooth_name: jkr.as_ref().map_or("no radius", Disc::name),
            exact: along(&*exact, &fine, progress)?,
            exact_name: exact.name(),
            envelope,
        })
    }
}

/// The states at these radii; `None` if `progress` asked to stop.
fn along(disc: &dyn Disc, radii: &[f64], progress: &dyn Progress) -> Option<Vec<TheoryState>> {
    // Without its energy, a state costs one transform of the gap.
    let place = |&s: &f64| {
        let state = disc.equilibrium(s, 0.0);
        (!progress.stop()).then_some([state.approach, state.force, s])
    };
    radii.iter().map(place).collect()
}

fn envelope(case: &Case, radii: &[f64]) -> Option<Envelope> {
    let Shape::WavySphere { radius_of_curvature, amplitude, wavelength } = case.problem.shape else {
        return None;
    };
    let (effective_modulus, work_of_adhesion) =
        (case.problem.effective_modulus, case.problem.work_of_adhesion);
    if amplitude <= 0.0 || work_of_adhesion <= 0.0 {
        return None;
    }
    let envelope = KesariLew {
        sphere: Guduru { effective_modulus, work_of_adhesion, radius_of_curvature, amplitude, wavelength },
    };
    let side = |side| {
        radii
            .iter()
            .map(|&s| {
                let (approach, force) = envelope.envelope(side, s);
                [approach, force, s]
            })
            .collect()
    };
    Some(Envelope {
        unloading: side(EnvelopeSide::Unloading),
        loading: side(EnvelopeSide::Loading),
        peak: envelope.pull_off_ratio(),
        waves: envelope.waves(),
    })
}
