//! No jump of the walk loses negative energy, whatever is controlled and in whichever direction it runs: on random wavy
//! spheres with weak adhesion and without adhesion.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a helper of a test fails the test by panicking")]

use crate::support::presets::reduced;
use pulloff::explorer::walk::{Action, Request, WalkOutcome, walk};
use pulloff::explorer::{CurveData, NodeKind, Staged};
use pulloff_engine::gap::Shape;
use pulloff_engine::preset::{BasisSpec, Preset};
use pulloff_engine::problem::{ContactKind, Control, Start};
use pulloff_engine::quasistatic::Extremum;
use pulloff_engine::quasistatic::walk::At;
use std::sync::Arc;

const START: f64 = 0.45;

fn preset(amplitude: f64, wavelength: f64, work_of_adhesion: f64, control: Control) -> Preset {
    let gap = Shape::WavySphere { radius_of_curvature: 1.0, amplitude, wavelength };
    let start = Start::ContactRadius(START);
    reduced([1.0, work_of_adhesion], gap, BasisSpec::Exact, (control, start, ContactKind::Rings))
}

/// The outcomes of the jumps from every limit point of a problem: how many land or pull off, inward and outward, and
/// how many are refused because the potential rises.
fn jumps(preset: &Preset) -> [usize; 3] {
    let curve = Arc::new(CurveData::compute(preset, &Staged::unwatched()).unwrap());
    let mut counts = [0; 3];
    for limit in &curve.limits {
        let inward = limit.turn == Extremum::Minimum;
        let request = Request {
            id: 0,
            action: Action::Jump,
            curve: Arc::clone(&curve),
            from: curve.base.curve.equilibrium.explicit(limit.contact_radius),
            on_path: None,
            at: At::Limit,
            control: curve.case.control,
            inward,
            length: 0.1,
            pace: None,
        };
        let mut event = None;
        let outcome = walk(&request, &mut |made| {
            let NodeKind::Jump(found) = made.kind else { panic!("{:?}", made.kind) };
            event = Some(found);
            true
        });
        match (event, outcome) {
            (Some(event), WalkOutcome::Done) => {
                let size = event.before.as_ref().unwrap().energy.abs();
                for lost in [event.dissipated, event.dissipated_by_area].into_iter().flatten() {
                    assert!(lost >= -1e-9 * size, "{lost}: {event:?} {preset:?}");
                }
                counts[usize::from(!inward)] += 1;
            }
            (None, WalkOutcome::Stopped(reason)) => {
                assert!(!inward, "{reason}: {preset:?}");
                counts[2] += usize::from(reason.contains("the potential rises"));
            }
            other => panic!("{other:?}"),
        }
    }
    counts
}

#[test]
fn no_jump_loses_negative_energy() {
    let mut random = fastrand::Rng::with_seed(20_261_121);
    let mut between = |lo: f64, hi: f64| (lo.ln() + (hi / lo).ln() * random.f64()).exp();
    let mut all = [0; 3];
    for problem in 0..4 {
        let wavelength = between(0.05, 0.15);
        let amplitude = wavelength * wavelength / between(0.8, 8.0);
        let gamma = if problem == 0 { 0.0 } else { between(1e-6, 5e-3) };
        let stiffness = between(1e-2, 1e1);
        for control in [Control::Displacement, Control::Force, Control::Stiffness(stiffness)] {
            let found = jumps(&preset(amplitude, wavelength, gamma, control));
            all = std::array::from_fn(|i| all[i] + found[i]);
        }
    }
    // All three outcomes occur.
    println!("inward, outward, refused: {all:?}");
    assert!(all.iter().all(|count| *count > 0), "{all:?}");
}

/// γ = 1e-4, A = 0.008, λ = 0.1: run outward from s = 0.3695, the edge would land at s = 0.4105 with more energy.
#[test]
fn a_jump_to_more_energy_is_refused() {
    let [inward, _, refused] = jumps(&preset(0.008, 0.1, 1e-4, Control::Displacement));
    assert!(inward > 0 && refused > 0);
}
