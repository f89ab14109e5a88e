//! The cost of a typed formula against the closed form of the same gap, and the cost of reading one.
//!
//! `cargo bench --bench formula`; the numbers serve to compare two versions on one machine.

#![allow(clippy::unwrap_used, reason = "a bench that cannot be set up must stop")]

use divan::counter::ItemsCount;
use divan::{Bencher, black_box};
use pulloff_engine::gap::{Gap, Shape};
use pulloff_engine::gap::{formula::Bound, formula::Formula};
use pulloff_engine::units::parse_quantity;

const WAVY: &str = "r^2/(2*R) + A*(1 - cos(2*pi*r/lambda))";
/// The number of radii in a batch.
const RADII: usize = 1600;

fn main() {
    divan::main();
}

fn shape() -> Shape {
    Shape::WavySphere { radius_of_curvature: 1.0, amplitude: 0.0025, wavelength: 0.05 }
}

fn wavy() -> Bound {
    bind(WAVY)
}

fn bind(text: &str) -> Bound {
    let formula = Formula::parse(text).unwrap();
    let values = [("R", 1.0), ("A", 0.0025), ("lambda", 0.05)];
    let has = |name: &&(&str, f64)| formula.parameters().iter().any(|known| known == name.0);
    let values: Vec<(&str, f64)> = values.iter().filter(has).copied().collect();
    formula.bind(&values).unwrap()
}

fn radii() -> Vec<f64> {
    (0..RADII).map(|i| 0.4 * (i as f64 + 0.5) / RADII as f64).collect()
}

#[divan::bench]
fn closed_form_single(bencher: Bencher) {
    let shape = shape();
    bencher.bench_local(|| shape.jet(black_box(0.3)));
}

#[divan::bench]
fn formula_single(bencher: Bencher) {
    let bound = wavy();
    bencher.bench_local(|| bound.jet(black_box(0.3)));
}

#[divan::bench]
fn closed_form_values(bencher: Bencher) {
    let (shape, radii) = (shape(), radii());
    let mut values = vec![0.0; RADII];
    bencher.counter(ItemsCount::new(RADII)).bench_local(|| {
        for (value, &r) in values.iter_mut().zip(&radii) {
            *value = shape.jet(r).value;
        }
        black_box(values[RADII - 1])
    });
}

#[divan::bench]
fn formula_values(bencher: Bencher) {
    let (bound, radii) = (wavy(), radii());
    let mut values = vec![0.0; RADII];
    bencher.counter(ItemsCount::new(RADII)).bench_local(|| {
        bound.values(1.0, &radii, &mut values);
        black_box(values[RADII - 1])
    });
}

fn derivatives(bencher: Bencher, bound: &Bound) {
    let radii = radii();
    let mut found = [(); 3].map(|()| vec![0.0; RADII]);
    bencher.counter(ItemsCount::new(RADII)).bench_local(|| {
        let [first, second, third] = &mut found;
        bound.derivatives(1.0, &radii, [first, second, third]);
        black_box(found[2][RADII - 1])
    });
}

#[divan::bench]
fn closed_form_derivatives(bencher: Bencher) {
    let (shape, radii) = (shape(), radii());
    let mut found = [(); 3].map(|()| vec![0.0; RADII]);
    bencher.counter(ItemsCount::new(RADII)).bench_local(|| {
        for (i, &r) in radii.iter().enumerate() {
            let jet = shape.jet(r);
            (found[0][i], found[1][i], found[2][i]) = (jet.first, jet.second, jet.third);
        }
        black_box(found[2][RADII - 1])
    });
}

#[divan::bench]
fn formula_derivatives(bencher: Bencher) {
    derivatives(bencher, &wavy());
}

/// Functions other than sine and cosine.
#[divan::bench(args = ["r^2/2", "exp(-r^2)", "(1 + r^2)^0.5 - 1", "sqrt(1 + r^2) - 1", "max(r - 0.1, 0)^1.5", "tanh(r/A)"])]
fn other_derivatives(bencher: Bencher, text: &str) {
    derivatives(bencher, &bind(text));
}

#[divan::bench]
fn parse_and_bind() -> Bound {
    wavy()
}

/// Finds where the formula is finite, its breaks and its wavelength.
#[divan::bench(args = [WAVY, "sqrt(4 - r^2)", "max(0.0008 - abs(r - 0.3), 0)", "abs(sin(100*r))", "r^1.5"])]
fn survey(bencher: Bencher, text: &str) {
    let bound = bind(text);
    bencher.bench_local(|| bound.clone().over(black_box(0.4)).unwrap());
}

#[divan::bench]
fn quantity() -> f64 {
    parse_quantity(black_box("3*pi/2 um")).unwrap().number
}
