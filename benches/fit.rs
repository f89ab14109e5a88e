//! The cost of measured curves: reading a million rows, fits of 2000 points on a sphere and through the snaps of a wavy
//! one, and 200 fits of a bootstrap.
//!
//! `cargo bench --bench fit`; the numbers serve to compare two versions on one machine.

#![allow(clippy::unwrap_used, reason = "a bench that cannot be set up must stop")]

use divan::Bencher;
use pulloff_engine::case::Case;
use pulloff_engine::fit::{Options, fit};
use pulloff_engine::gap::shapes::split_mix::SplitMix64;
use pulloff_engine::measured::{Abscissa, ColumnSpec, Points, Segment, parse};
use pulloff_engine::preset::{Preset, read};
use pulloff_engine::problem::Control;
use pulloff_engine::progress::Unwatched;
use pulloff_engine::quasistatic::path::PathSetting;
use std::fmt::Write;

/// The points of a fit.
const POINTS: usize = 2000;
/// The rows to read.
const ROWS: usize = 1_000_000;

fn main() {
    divan::main();
}

fn sphere() -> Preset {
    preset("shape='sphere'\nradius_of_curvature=1.0")
}

fn wavy() -> Preset {
    preset("shape='wavy-sphere'\nradius_of_curvature=1.0\namplitude=0.0025\nwavelength=0.05")
}

fn preset(gap: &str) -> Preset {
    let text = format!(
        "[material]\neffective_modulus=1.0\nwork_of_adhesion=0.004\n[gap]\n{gap}\n[path]\nstart_contact_radius=0.5\n"
    );
    read("bench", &text).unwrap()
}

/// The unloading of a preset under fixed grips with a free part, evenly spaced in the approach, with noise.
fn unloaded(preset: &Preset) -> Points {
    let case = Case::new(preset).unwrap();
    let curve = case.curve(&Unwatched).unwrap();
    let unloading = case.unload(&curve, &PathSetting::one_disc(Control::Displacement), &Unwatched).unwrap();
    let state = |s: f64| case.basis.equilibrium(&case.reduced, s).unwrap();
    let force = |delta: f64| {
        let piece = |[outer, inner]: &[f64; 2]| {
            let (mut lo, mut hi) = (*inner, *outer);
            if !(state(lo).approach..=state(hi).approach).contains(&delta) {
                return None;
            }
            for _ in 0..50 {
                let middle = 0.5 * (lo + hi);
                if state(middle).approach > delta { hi = middle } else { lo = middle }
            }
            Some(state(lo).force)
        };
        unloading.pieces().iter().find_map(piece).unwrap_or(0.0)
    };
    let (top, least) = (curve.samples[0].approach, unloading.farthest().unwrap().approach);
    let bottom = least - 0.3 * (top - least);
    let mut random = SplitMix64::new(1);
    let mut normal = move || (0..12).map(|_| random.unit()).sum::<f64>() - 6.0;
    let x: Vec<f64> = (0..POINTS).map(|i| top + (i as f64 + 0.5) / POINTS as f64 * (bottom - top)).collect();
    let force = x.iter().map(|delta| force(*delta) + 2e-4 * normal()).collect();
    let segments = Some(vec![Segment::Retraction; POINTS]);
    Points {
        abscissa: Abscissa::Approach,
        x,
        force,
        radius: None,
        steps: [1e-9; 3],
        segments,
        time: None,
        is_said: false,
        skipped: 0,
    }
}

fn fits(bencher: Bencher, preset: &Preset, bootstrap: Option<(usize, u64)>) {
    let points = unloaded(preset);
    let free = ["E*", "gamma", "data.offset"].map(str::to_owned).to_vec();
    let options = Options { free, bootstrap, ..Options::default() };
    let mut start = preset.clone();
    start.material.effective_modulus = 1.5;
    bencher.bench_local(|| fit(&start, &points, &options, &pulloff_engine::progress::Unwatched).unwrap());
}

#[divan::bench(max_time = 5)]
fn of_a_sphere(bencher: Bencher) {
    fits(bencher, &sphere(), None);
}

#[divan::bench(max_time = 10)]
fn of_a_wavy_sphere(bencher: Bencher) {
    fits(bencher, &wavy(), None);
}

#[divan::bench(sample_count = 1, sample_size = 1)]
fn bootstrap_of_a_sphere(bencher: Bencher) {
    fits(bencher, &sphere(), Some((200, 1)));
}

#[divan::bench(sample_count = 1, sample_size = 1)]
fn bootstrap_of_a_wavy_sphere(bencher: Bencher) {
    fits(bencher, &wavy(), Some((200, 1)));
}

/// Three columns as an instrument writes them.
#[divan::bench(max_time = 10)]
fn a_million_rows(bencher: Bencher) {
    let mut text = "delta [um],force [uN],segment\n".to_owned();
    for i in 0..ROWS {
        let x = i as f64 * 1e-3;
        let branch = if 2 * i < ROWS { "approach" } else { "retract" };
        writeln!(text, "{x:.4},{:.5},{branch}", 0.3 * x.sin()).unwrap();
    }
    bencher.bench_local(|| parse(text.as_bytes(), &ColumnSpec::default()).unwrap());
}
