//! Makes a force curve that looks measured: a soft ball on a flat, in the form in which an instrument delivers it.
//!
//! ```sh
//! cargo run --example make_curve > presets/data/lens.csv
//! ```
//!
//! The truth is a JKR sphere (Proc. R. Soc. A 324, 301 (1971)) with R = 1 mm, E* = 1 `MPa` and γ = 50 mJ/m² behind a
//! load cell of 500 N/m, so that the position of the stage is Δ = δ + P/k. The stage moves evenly, jumps into contact
//! at Δ = 0, presses to 1 mN and pulls off. The instrument has its own zero (12.3 µm and 4 µN), a noise of 10 nm and 2
//! µN, and rounds to 1 nm and 0.1 µN; one sample in two hundred is off by 30 µN. All random numbers come from one seed,
//! so everyone gets the same file.

use pulloff_engine::gap::shapes::split_mix::SplitMix64;
use pulloff_engine::report::number::fixed;
use std::f64::consts::{PI, TAU};
use std::io::Write;

const RADIUS: f64 = 1e-3;
const MODULUS: f64 = 1e6;
const ADHESION: f64 = 0.05;
const STIFFNESS: f64 = 500.0;
/// The largest force, N.
const PRELOAD: f64 = 1e-3;
/// Rows of each branch.
const ROWS: u32 = 350;
const SEED: u64 = 20_261_122;

/// The position of the stage and the force at the contact radius `s`.
fn state(s: f64) -> (f64, f64) {
    let approach = s * s / RADIUS - (TAU * ADHESION * s / MODULUS).sqrt();
    let force =
        4.0 * MODULUS * s.powi(3) / (3.0 * RADIUS) - (8.0 * PI * ADHESION * MODULUS * s.powi(3)).sqrt();
    (approach + force / STIFFNESS, force)
}

/// The radius between `lo` and `hi` at which `is_beyond` becomes true.
fn bisect(mut lo: f64, mut hi: f64, is_beyond: impl Fn(f64) -> bool) -> f64 {
    for _ in 0..100 {
        let middle = 0.5 * (lo + hi);
        if is_beyond(middle) { hi = middle } else { lo = middle }
    }
    0.5 * (lo + hi)
}

/// The text of the file.
fn curve() -> String {
    // The position is smallest where it begins to rise again.
    let fold = bisect(1e-7, 1e-4, |s| state(s * (1.0 + 1e-6)).0 > state(s).0);
    let most = bisect(fold, 1e-3, |s| state(s).1 > PRELOAD);
    let (top, bottom) = (state(most).0, state(fold).0);
    let from = bottom - 0.5 * (top - bottom);
    let mut random = SplitMix64::new(SEED);
    let mut text = String::from(
        "# A soft ball on a flat: not measured but made by examples/make_curve.rs\n\
         # R = 1 mm, E* = 1 MPa, work of adhesion 50 mJ/m^2, load cell 500 N/m; noise 10 nm and 2 uN\n\
         position [um], force [uN], segment\n",
    );
    for segment in ["approach", "retraction"] {
        for i in 0..ROWS {
            let share = (f64::from(i) + 0.5) / f64::from(ROWS);
            let share = if segment == "approach" { share } else { 1.0 - share };
            let way = from + share * (top - from);
            let touches = if segment == "approach" { way >= 0.0 } else { way >= bottom };
            let force = if touches { state(bisect(fold, most, |s| state(s).0 > way)).1 } else { 0.0 };
            // The Box-Muller transform.
            let (u, v) = (1.0 - random.unit(), random.unit());
            let size = (-2.0 * u.ln()).sqrt();
            let kick = if random.unit() < 0.005 { 30.0 } else { 0.0 };
            let x = 1e6 * way + 12.3 + 0.01 * size * (TAU * v).cos();
            let p = 1e6 * force + 4.0 + 2.0 * size * (TAU * v).sin() + kick;
            text.extend([
                fixed(x, 3),
                ", ".to_owned(),
                fixed(p, 1),
                ", ".to_owned(),
                segment.to_owned(),
                "\n".to_owned(),
            ]);
        }
    }
    text
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    std::io::stdout().write_all(curve().as_bytes())?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use pulloff_engine::measured::{ColumnSpec, parse};

    const SHIPPED: &str = include_str!("../presets/data/lens.csv");

    #[test]
    fn the_shipped_file_is_the_one_made_here() {
        let read = |text: &str| parse(text.as_bytes(), &ColumnSpec::default()).unwrap();
        let (shipped, made) = (read(SHIPPED), read(&curve()));
        assert_eq!(shipped.segments, made.segments);
        // The last digit may differ where the machine's sine does.
        for (a, b) in shipped.columns.iter().zip(&made.columns) {
            assert!(a.values.iter().zip(&b.values).all(|(x, y)| (x - y).abs() < 1.1 * a.step));
        }
    }
}
