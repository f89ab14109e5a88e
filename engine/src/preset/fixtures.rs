//! Presets for the tests of this layer: a typical one, and arbitrary ones.

use super::model::{BasisSpec, Material, PathSpec, Preset};
use super::schema::START_OVER_CURVATURE;
use crate::fixtures::FILES;
use crate::gap::{Gap, Shape};
use crate::gap::{formula::FormulaParameter, formula::TypedGap};
use crate::gap::{
    shapes::ExactSphere, shapes::Harmonic, shapes::Harmonics, shapes::MeasuredGap, shapes::PowerLaw,
    shapes::RandomWaves, shapes::Smoothing,
};
use crate::problem::{Adhesion, Control, Start};
use crate::ritz::Grading;
use proptest::prelude::*;
use std::sync::Arc;

/// A material whose adhesion has no range.
fn material(effective_modulus: f64, work_of_adhesion: f64) -> Material {
    let adhesion = Adhesion::ShortRange;
    Material { effective_modulus, work_of_adhesion, range_of_action: None, adhesion }
}

/// The wavy sphere of the paper's Fig. 9.
pub fn wavy() -> Preset {
    let gap = Shape::WavySphere { radius_of_curvature: 1.0, amplitude: 0.0025, wavelength: 0.05 };
    let preset = Preset::new(material(1.0, 0.004), gap, Start::ContactRadius(0.5));
    Preset {
        title: "a wave".to_owned(),
        basis: BasisSpec::Rings { rings: 200, grading: Grading::Uniform },
        path: PathSpec { end_contact_radius: Some(0.002), ..preset.path },
        files: FILES,
        ..preset
    }
}

/// Any valid preset.
pub fn any_preset() -> impl Strategy<Value = Preset> {
    let positive = || (-29.0..29.0f64).prop_map(|e| 10f64.powf(e));
    let finite = || prop_oneof![Just(0.0), (-1e9..1e9f64), (-29.0..29.0f64).prop_map(|e| -(10f64.powf(e)))];
    let gap = (0..9u8, positive(), prop_oneof![Just(0.0), positive()], positive(), 1.0..100.0f64).prop_map(
        |(which, radius, amplitude, wavelength, x)| {
            any_gap(which, radius.clamp(1e-20, 1e29), amplitude, wavelength, x)
        },
    );
    let basis = prop_oneof![
        (4usize..=2000).prop_map(|rings| BasisSpec::Rings { rings, grading: Grading::Uniform }),
        (4usize..=400).prop_map(|rings| BasisSpec::Rings { rings, grading: Grading::Edge }),
        Just(BasisSpec::Exact),
    ];
    let control = prop_oneof![
        Just(Control::Displacement),
        Just(Control::Force),
        positive().prop_map(Control::Stiffness)
    ];
    (
        ("[ -~γλ\u{e9}\"'\\\\]{0,40}", positive(), prop_oneof![Just(0.0), positive()], gap, basis),
        (control, 0..3u8, 0.001..10.0f64, finite(), proptest::option::of(0.0001..0.99f64)),
    )
        .prop_map(|((title, e, gamma, gap, basis), (control, which, over, x, end))| {
            // Within the known range of the gap.
            let known = gap.largest_radius().map_or(f64::INFINITY, |known| 0.99 * known);
            let radius = gap.radius_of_curvature().unwrap_or(1.0).min(known / over);
            let start = match which {
                0 => Start::ContactRadius(over * radius),
                1 => Start::Approach(x),
                _ => Start::Force(x),
            };
            let preset = Preset::new(material(e, gamma), gap, start);
            let end_contact_radius = end.map(|f| f * over * radius);
            let path = PathSpec { control, end_contact_radius, ..preset.path };
            Preset { title, basis, path, files: FILES, ..preset }
        })
}

/// A gap with the shape number `which`, in the order of the table.
pub fn any_gap(which: u8, radius: f64, amplitude: f64, wavelength: f64, x: f64) -> Shape {
    let harmonic = |phase| Harmonic { amplitude, wavelength, phase };
    let parameter = |name: &str, value, min, max| FormulaParameter {
        name: name.to_owned(),
        value,
        min,
        max,
        unit: min.map(|_| "\"µm\"".to_owned()),
    };
    match which {
        0 => Shape::Sphere { radius_of_curvature: radius },
        1 => Shape::WavySphere { radius_of_curvature: radius, amplitude, wavelength },
        2 => Shape::ExactSphere(ExactSphere { radius }),
        3 => Shape::Cone { slope: wavelength },
        4 => Shape::PowerLaw(PowerLaw { factor: wavelength, exponent: x }),
        5 => Shape::Harmonics(Arc::new(
            Harmonics::new(radius, [0.0, x, -x].map(harmonic)[..which as usize % 4].to_vec()).unwrap(),
        )),
        6 => Shape::random_waves(RandomWaves {
            radius_of_curvature: radius,
            rms: amplitude,
            longest: wavelength,
            shortest: wavelength / (1.0 + x),
            hurst: x / 100.0,
            count: 7,
            seed: x.to_bits() >> 1,
        })
        .unwrap(),
        7 => {
            let parameters =
                vec![parameter("R", radius, None, None), parameter("k", x, Some(1.0), Some(100.0))];
            let start = Some(START_OVER_CURVATURE * radius);
            Shape::Formula(Arc::new(TypedGap::new("r^2/(2*R)*(1 + k)", parameters, start).unwrap()))
        }
        _ => {
            let rows = Arc::new(crate::fixtures::load(None, "shipped:rough-sphere.csv").unwrap());
            Shape::Profile(Arc::new(MeasuredGap::new(rows, Smoothing::Cutoff(x)).unwrap()))
        }
    }
}
