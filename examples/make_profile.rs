//! Makes a profile that looks measured: a rough sphere, in the form in which an instrument would deliver it.
//!
//! ```sh
//! cargo run --example make_profile > presets/data/rough-sphere.csv
//! ```
//!
//! The true gap is a paraboloid of R = 1 mm with 60 waves between 150 µm and 6 µm, rms 60 nm and Hurst exponent 0.8,
//! sampled every 0.2 µm out to 240 µm. The instrument adds a noise of 2 nm and a height of its own, and rounds: radii
//! to 0.01 µm, heights to 0.1 nm, which is finer than its noise. All random numbers come from one seed, so everyone
//! gets the same file.

use pulloff_engine::gap::Gap;
use pulloff_engine::gap::shapes::random_waves::RandomWavesError;
use pulloff_engine::gap::shapes::split_mix::SplitMix64;
use pulloff_engine::gap::{shapes::Harmonics, shapes::RandomWaves};
use pulloff_engine::report::number::fixed;
use std::io::Write;

/// Rows of the file.
const ROWS: u32 = 1201;
/// The spacing of the rows, in µm.
const SPACING: f64 = 0.2;
/// Standard deviation of the noise, in nm.
const NOISE: f64 = 2.0;
/// The height that the instrument gives the apex, in nm.
const HEIGHT: f64 = 37.0;

/// The gap without the noise, in µm.
fn truth() -> Result<Harmonics, RandomWavesError> {
    RandomWaves {
        radius_of_curvature: 1000.0,
        rms: 0.06,
        longest: 150.0,
        shortest: 6.0,
        hurst: 0.8,
        count: 60,
        seed: 20_261_121,
    }
    .harmonics()
}

/// The text of the file.
fn profile() -> Result<String, RandomWavesError> {
    let gap = truth()?;
    let mut random = SplitMix64::new(1);
    let mut text = String::from(
        "# Rough sphere, R = 1 mm: not measured but made by examples/make_profile.rs\n\
         # 60 waves from 150 um to 6 um, rms 60 nm, Hurst exponent 0.8; noise 2 nm\n\
         r [um], h [nm]\n",
    );
    for i in 0..ROWS {
        let r = SPACING * f64::from(i);
        // The sum of two uniform numbers has the variance 1/6.
        let noise = NOISE * 6.0_f64.sqrt() * (random.unit() + random.unit() - 1.0);
        let h = 1000.0 * gap.jet(r).value + HEIGHT + noise;
        text.extend([fixed(r, 2), ", ".to_owned(), fixed(h, 1), "\n".to_owned()]);
    }
    Ok(text)
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    std::io::stdout().write_all(profile()?.as_bytes())?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use pulloff_engine::gap::{shapes::ProfileGap, shapes::Smoothing};
    use pulloff_engine::preset::profile::parse;

    const SHIPPED: &str = include_str!("../presets/data/rough-sphere.csv");

    #[test]
    fn the_shipped_file_is_the_one_made_here() {
        let (shipped, made) =
            (parse(SHIPPED.as_bytes()).unwrap(), parse(profile().unwrap().as_bytes()).unwrap());
        assert_eq!((&shipped.radii, &shipped.units), (&made.radii, &made.units));
        // The last digit may differ where the machine's sine does.
        assert!(shipped.gaps.iter().zip(&made.gaps).all(|(a, b)| (a - b).abs() < 0.11));
        assert!(SHIPPED.len() < 60_000);
    }

    #[test]
    fn reading_and_smoothing_bring_the_truth_back() {
        let (columns, _) = parse(SHIPPED.as_bytes()).unwrap().in_one_unit().unwrap();
        let profile = ProfileGap::new(&columns.radii, &columns.gaps, Smoothing::Auto).unwrap();
        assert!((profile.removed() / 2e-3 - 1.0).abs() < 0.1, "{}", profile.removed());
        let truth = truth().unwrap();
        // Up to the height of the apex: the phases of the waves give the true tip a slope, which the even curve rounds off.
        let errors: Vec<f64> = (0..2400)
            .map(|i| 0.1 * f64::from(i))
            .map(|r| profile.jet(r).value - truth.jet(r).value)
            .collect();
        let mean = errors.iter().sum::<f64>() / 2400.0;
        let rms = (errors.iter().map(|e| (e - mean).powi(2)).sum::<f64>() / 2400.0).sqrt();
        assert!(mean.abs() < 6e-3 && rms < 1e-3, "{mean} {rms}");
    }
}
