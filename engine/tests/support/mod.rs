//! Gaps and reference values for the tests of loops and walks.

#![allow(dead_code, reason = "each test uses some of them")]
#![allow(clippy::unwrap_used, reason = "a helper of a test fails the test by panicking")]
#![allow(clippy::disallowed_methods, reason = "a random gap needs no reproducible last digit")]

use pulloff_engine::gap::shapes::random_waves::RandomWaves;
use pulloff_engine::gap::{Gap, Shape};
use pulloff_engine::gap::{shapes::Harmonic, shapes::Harmonics};
use pulloff_engine::problem::Problem;
use serde_json::Value;
use std::f64::consts::TAU;
use std::sync::Arc;

pub fn wavy(amplitude: f64, wavelength: f64) -> Arc<dyn Gap> {
    let shape = Shape::WavySphere { radius_of_curvature: 1.0, amplitude, wavelength };
    Problem { effective_modulus: 1.0, work_of_adhesion: 0.0, shape }.reduced().gap
}

pub fn reference(name: &str) -> Value {
    let path = format!("{}/tests/data/{name}.json", env!("CARGO_MANIFEST_DIR"));
    serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap()
}

/// δ, P and the contacts.
pub type Numbers = (f64, f64, Vec<[f64; 2]>);

pub fn numbers(state: &Value) -> Numbers {
    let number = |key: &str| state[key].as_f64().unwrap();
    let rings = state["annuli"].as_array().unwrap().iter();
    let rings = rings.map(|ring| [ring[0].as_f64().unwrap(), ring[1].as_f64().unwrap()]);
    let disc = Some([0.0, number("disc")]).filter(|disc| disc[1] > 0.0);
    (number("delta"), number("P"), disc.into_iter().chain(rings).collect())
}

/// A random gap with one wave that has a phase, with two waves, or with many.
pub fn random_gap(random: &mut fastrand::Rng) -> (Arc<dyn Gap>, String) {
    let between = |random: &mut fastrand::Rng, lo: f64, hi: f64| lo * (hi / lo).powf(random.f64());
    let kind = random.usize(0..4);
    if kind == 3 {
        let spectrum = RandomWaves {
            radius_of_curvature: 1.0,
            rms: between(random, 3e-4, 2e-3),
            longest: 0.2,
            shortest: 0.05,
            hurst: 0.8,
            count: 6,
            seed: random.u64(..),
        };
        return (Arc::new(Shape::random_waves(spectrum).unwrap()), format!("{spectrum:?}"));
    }
    let waves: Vec<Harmonic> = (0..=usize::from(kind > 0))
        .map(|_| {
            let wavelength = between(random, 0.04, 0.15);
            // λ²/A from 0.7 to 15: from rough to hardly wavy.
            let amplitude = wavelength * wavelength / between(random, 0.7, 15.0);
            let phase = if random.bool() { 0.0 } else { TAU * random.f64() };
            Harmonic { amplitude, wavelength, phase }
        })
        .collect();
    let name = format!("{waves:?}");
    (Arc::new(Harmonics::new(1.0, waves).unwrap()), name)
}
