//! Whole loops against those of another program, and what holds for every loop.

use pulloff_engine::annuli::Ground;
use pulloff_engine::contact::{Control, Gap, Problem, Shape};
use pulloff_engine::quasistatic::cycle::{Areas, Cycle, CycleState, EVEN, EventKind, Setting, Turn, cycle};
use serde_json::Value;
use std::f64::consts::TAU;
use std::sync::Arc;

fn wavy(amplitude: f64, wavelength: f64) -> Arc<dyn Gap> {
    let shape = Shape::WavySphere { radius_of_curvature: 1.0, amplitude, wavelength };
    Problem { effective_modulus: 1.0, work_of_adhesion: 0.0, shape }.reduced().gap
}

fn looped(gap: Arc<dyn Gap>, gamma: f64, control: Control, turn: Turn, areas: Areas) -> Cycle {
    let ground = Ground::of(gap, 0.7).unwrap();
    let setting = Setting { control, turn, areas, mobility: EVEN };
    cycle(&ground, gamma, &setting, &|_| true).unwrap()
}

fn reference(name: &str) -> Value {
    let path = format!("{}/tests/data/{name}.json", env!("CARGO_MANIFEST_DIR"));
    serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap()
}

fn numbers(state: &Value) -> (f64, f64, Vec<[f64; 2]>) {
    let number = |key: &str| state[key].as_f64().unwrap();
    let rings = state["annuli"].as_array().unwrap().iter();
    let rings = rings.map(|ring| [ring[0].as_f64().unwrap(), ring[1].as_f64().unwrap()]);
    let disc = Some([0.0, number("disc")]).filter(|disc| disc[1] > 0.0);
    (number("delta"), number("P"), disc.into_iter().chain(rings).collect())
}

/// Holds the events of a loop to a reference, `tolerance` of each range; losses to `losses` of themselves.
fn agrees(found: &Cycle, reference: &Value, tolerance: f64, losses: f64) {
    let events = reference["events"].as_array().unwrap();
    let name = |kind: EventKind| kind.name().replace("first-touch", "first touch");
    let kinds: Vec<String> = found.events.iter().map(|event| name(event.kind)).collect();
    let expected: Vec<&str> = events.iter().map(|event| event["kind"].as_str().unwrap()).collect();
    assert_eq!(kinds, expected);
    let states: Vec<_> = events
        .iter()
        .flat_map(|event| [&event["before"], &event["after"]])
        .filter(|state| !state.is_null())
        .map(numbers)
        .collect();
    let range = |of: &dyn Fn(&(f64, f64, Vec<[f64; 2]>)) -> f64| {
        let (lo, hi) = states
            .iter()
            .map(of)
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi): (f64, f64), x| (lo.min(x), hi.max(x)));
        hi - lo
    };
    let (approach, force) = (range(&|state| state.0), range(&|state| state.1));
    let radius = range(&|state| state.2.last().map_or(0.0, |last| last[1]));
    let mut worst = [0.0_f64; 4];
    for (event, expected) in found.events.iter().zip(events) {
        for (state, expected) in [(&event.before, &expected["before"]), (&event.after, &expected["after"])] {
            let Some(state) = state else {
                assert!(expected.is_null());
                continue;
            };
            let (delta, p, contacts) = numbers(expected);
            worst[0] = worst[0].max((state.approach - delta).abs() / approach);
            worst[1] = worst[1].max((state.force - p).abs() / force);
            assert_eq!(state.contacts.len(), contacts.len());
            for (ours, theirs) in state.contacts.iter().flatten().zip(contacts.iter().flatten()) {
                worst[2] = worst[2].max((ours - theirs).abs() / radius);
            }
        }
        let lost = expected["lost"].as_f64().unwrap();
        let error = (event.dissipated.unwrap() - lost).abs();
        worst[3] = worst[3].max(if lost == 0.0 { error } else { error / lost });
    }
    println!(
        "worst: approach {:.1e} force {:.1e} edges {:.1e} losses {:.1e}",
        worst[0], worst[1], worst[2], worst[3]
    );
    assert!(worst[..3].iter().all(|error| *error < tolerance) && worst[3] < losses, "{worst:?}");
    let sum = reference["checks"]["sum_of_losses"].as_f64().unwrap();
    assert!((found.totals.dissipated.unwrap() / sum - 1.0).abs() < losses);
    let by_work = found.totals.work_of_loading + found.totals.work_of_unloading.unwrap();
    assert!((by_work / sum - 1.0).abs() < losses);
}

#[test]
fn the_loop_of_figure_9_is_that_of_another_program() {
    let turn = Turn::Control(0.14);
    let found = looped(wavy(0.0025, 0.05), 0.025 / TAU, Control::Displacement, turn, Areas::Yes);
    agrees(&found, &reference("fig9-cycle"), 1e-9, 1e-8);
    assert!(found.totals.balance.unwrap() < 1e-8 && found.warnings.is_empty(), "{:?}", found.totals);
}

#[test]
fn weak_adhesion_takes_the_rings_of_another_program() {
    let turn = Turn::Approach(0.14);
    let found = looped(wavy(0.0025, 0.05), 1e-4, Control::Displacement, turn, Areas::Yes);
    agrees(&found, &reference("fig9-weak"), 1e-9, 1e-8);
    assert!(found.totals.balance.unwrap() < 1e-8 && found.warnings.is_empty(), "{:?}", found.totals);
    let rings = found.states.iter().map(|state: &CycleState| state.contacts.len()).max();
    assert_eq!(rings, Some(2));
}
