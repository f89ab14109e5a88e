//! Loops without adhesion: nothing is lost, and contacts, pressed everywhere, begin and merge without a jump.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a helper of a test fails the test by panicking")]

use crate::cycle::looped;
use crate::support::{random_gap, wavy};
use pulloff_engine::annuli::{Around, Contacts, Ground};
use pulloff_engine::gap::shapes::{Harmonic, Harmonics};
use pulloff_engine::gap::{Shape, formula::FormulaParameter, formula::TypedGap};
use pulloff_engine::problem::{ContactKind, Control, Turn};
use pulloff_engine::progress::Unwatched;
use pulloff_engine::quasistatic::path::{
    Balance, Direction, EventKind, Losses, Path, PathSetting, PathState, Warning, cycle_on,
};
use std::f64::consts::TAU;
use std::sync::Arc;

/// Without adhesion a cone h = cr pressed by δ takes P = 2δ²/(πc) on s = 2δ/(πc) (Sneddon 1965,
/// 10.1016/0020-7225(65)90019-4), and nothing is lost: its first contact is smaller than any seed.
#[test]
fn a_cone_without_adhesion_is_sneddons() {
    const SLOPE: f64 = 0.2;
    for (control, turn) in [(Control::Displacement, Turn::Approach(0.1)), (Control::Force, Turn::Force(0.05))]
    {
        let gap = Arc::new(Shape::Cone { slope: SLOPE });
        let found = looped(gap, 0.0, control, turn, Losses::Twice);
        let far = found.states.iter().filter(|state| state.contact_radius > 1e-3);
        let mut seen = 0;
        for state in far {
            let PathState { approach, force, contact_radius, .. } = *state;
            let off = [
                force / (approach * approach * 4.0 / (TAU * SLOPE)) - 1.0,
                contact_radius / (approach * 4.0 / (TAU * SLOPE)) - 1.0,
            ];
            assert!(off.iter().all(|off| off.abs() < 1e-8), "{state:?} {off:?}");
            seen += 1;
        }
        assert!(seen > 20, "{seen}");
        assert!(found.totals.dissipated.is_none_or(|lost| lost.abs() < 1e-12), "{:?}", found.totals);
    }
}

/// Without adhesion edges are held by the approach, whatever the device; what is told of a path is told of its force.
#[test]
fn a_warning_of_a_path_without_adhesion_names_the_value_of_its_device() {
    let found = looped(wavy(0.0025, 0.05), 0.0, Control::Force, Turn::Approach(0.14), Losses::Once);
    let at = found.warnings.iter().find_map(|warning| match warning {
        Warning::Digits { control_value, .. } => Some(*control_value),
        _ => None,
    });
    let at = at.unwrap();
    assert!(found.states.iter().any(|state| state.force.to_bits() == at.to_bits()), "{at}");
}

#[test]
fn without_adhesion_the_loop_is_that_of_the_table() {
    let found = looped(wavy(0.0025, 0.05), 0.0, Control::Displacement, Turn::Approach(0.1), Losses::Twice);
    let expected = [
        ("touch", 0.048_792_8, 0.001_283_086_94, 0.000_009_797_7, 0.005_795_5),
        ("touch", 0.098_054_6, 0.006_747_625_40, 0.000_537_020_6, 0.010_248_1),
        ("touch", 0.147_522_7, 0.017_055_500_40, 0.002_552_256_4, 0.013_855_6),
        ("touch", 0.197_099_4, 0.032_358_291_69, 0.007_090_533_8, 0.017_336_6),
        ("touch", 0.246_742_0, 0.052_700_045_61, 0.015_189_096_2, 0.021_657_0),
        ("merge", 0.026_302_5, 0.063_172_127_64, 0.020_299_472_4, 0.071_637_5),
        ("merge", 0.075_502_0, 0.069_930_361_28, 0.023_701_383_3, 0.120_577_4),
        ("touch", 0.296_428_9, 0.078_094_923_22, 0.027_880_887_1, 0.123_522_3),
        ("merge", 0.125_386_6, 0.079_783_254_20, 0.028_848_303_5, 0.169_422_3),
        ("merge", 0.175_369_5, 0.095_343_532_88, 0.038_109_438_6, 0.218_373_5),
    ];
    let up: Vec<_> = found.events.iter().take_while(|event| event.kind != EventKind::Turn).skip(1).collect();
    assert_eq!(up.len(), expected.len());
    for (event, (kind, radius, delta, force, disc)) in up.iter().zip(expected) {
        assert_eq!(event.kind.name(), kind);
        let after = event.after.as_ref().unwrap();
        assert!((event.radius.unwrap() - radius).abs() < 2e-7, "{radius}");
        assert!((after.approach - delta).abs() < 1e-10 * 0.1 + 5e-12, "{kind} {delta} {}", after.approach);
        assert!((after.force - force).abs() < 6e-11, "{kind} {delta}");
        assert!((after.contacts[0][1] - disc).abs() < 6e-8, "{kind} {delta}");
    }
    let turn = &found.events[up.len() + 1];
    let at = turn.after.as_ref().unwrap();
    assert!((at.force - 0.040_940_284_4).abs() < 6e-11 && (at.energy - 1.612_489_038e-3).abs() < 6e-13);
    // The way back.
    let down: Vec<_> = found.events[up.len() + 2..].iter().map(|event| event.kind.name()).collect();
    let mirrored: Vec<_> = up
        .iter()
        .rev()
        .map(|event| if event.kind == EventKind::Merge { "split" } else { "vanish" })
        .chain(["last-contact"])
        .collect();
    assert_eq!(down, mirrored);
}

#[test]
fn without_adhesion_solving_afresh_finds_the_same() {
    for number in 0..10_u64 {
        let mut random = fastrand::Rng::with_seed(number);
        let (gap, name) = random_gap(&mut random);
        let approach = 0.02 + 0.03 * random.f64();
        let ground = Ground::of(Arc::clone(&gap), 0.7).unwrap();
        let control = [Control::Displacement, Control::Force, Control::Stiffness(0.3)][random.usize(0..3)];
        let setting = PathSetting { losses: Losses::Once, ..PathSetting::new(control) };
        let found = match cycle_on(&ground, 0.0, Turn::Approach(approach), &setting, &Unwatched) {
            Ok(found) => found,
            Err(error) => panic!("{number} {name}: {error}"),
        };
        is_the_one_solution(&ground, &found, &format!("{number} {name}"));
    }
}

/// Contacts pressed everywhere, gaps open everywhere else: without adhesion there is only one such solution.
fn is_the_one_solution(ground: &Ground, found: &Path, name: &str) {
    let balance = Balance {
        ground,
        work_of_adhesion: 0.0,
        control: Control::Displacement,
        contact: ContactKind::Rings,
        progress: &Unwatched,
        lane: None,
        pinned: None,
    };
    let back: Vec<_> = found.states.iter().filter(|state| state.direction == Direction::Unloading).collect();
    for k in 0..20 {
        let state = back[k * (back.len() - 1) / 19];
        let disc = state.contacts.first().filter(|first| first[0] <= 0.0).map_or(0.0, |first| first[1]);
        let rings = state.contacts.iter().copied().filter(|ring| ring[0] > 0.0).collect();
        let held = balance.solve(&Contacts { disc, rings }, state.approach).unwrap();
        assert!((held.force - state.force).abs() < 1e-12, "{name}");
        let around = Around::new(ground, &held.state, held.approach);
        for [lo, hi] in held.state.contacts.intervals() {
            for i in 1..40 {
                let r = lo + (hi - lo) * f64::from(i) / 40.0;
                assert!(around.pressure(r) > -1e-8, "{name} {r} {}", around.pressure(r));
            }
        }
        assert!(balance.least_gap(&held).unwrap().is_none_or(|crest| crest.gap > -1e-10), "{name}");
    }
}

#[test]
fn without_adhesion_corners_are_passed() {
    for (broken, approach) in
        [("0.05*max(r-0.1,0)", 0.02), ("3*max(r-0.06,0)^2", 0.02), ("0.02*max(r-0.07,0)", 0.012)]
    {
        let text = format!("r^2/2+0.0025*(1-cos(2*pi*r/0.05))+{broken}");
        let gap = TypedGap::new(&text, Vec::<FormulaParameter>::new(), Some(0.6)).unwrap();
        let ground = Ground::of(Arc::new(Shape::Formula(Arc::new(gap))), 0.5).unwrap();
        let turn = Turn::Approach(approach);
        let setting = PathSetting { losses: Losses::Once, ..PathSetting::new(Control::Displacement) };
        let found = cycle_on(&ground, 0.0, turn, &setting, &Unwatched)
            .unwrap_or_else(|error| panic!("{text}: {error}"));
        assert!(found.events.iter().any(|event| event.kind == EventKind::Touch), "{text}");
        is_the_one_solution(&ground, &found, &text);
    }
}

/// A dimple with a corner at the axis never closes, however narrow; contacts beside it merge all the same.
#[test]
fn contacts_merge_beside_a_dimple_that_never_closes() {
    let wave = |amplitude, wavelength, phase| Harmonic { amplitude, wavelength, phase };
    let waves = vec![wave(0.0022, 0.2, -2.874), wave(0.0004, 0.237, 0.759), wave(0.0119, 0.235, 0.0)];
    let gap = Shape::Harmonics(Arc::new(Harmonics::new(1.0, waves).unwrap()));
    let ground = Ground::of(Arc::new(gap), 0.5).unwrap();
    let setting = PathSetting { losses: Losses::Once, ..PathSetting::new(Control::Displacement) };
    let found = cycle_on(&ground, 0.0, Turn::Approach(0.1), &setting, &Unwatched).unwrap();
    let merge = found.events.iter().find(|event| event.kind == EventKind::Merge).unwrap();
    let [inner, _] = merge.after.as_ref().unwrap().contacts[0];
    assert!(inner > 0.0 && inner < 1e-5, "{merge:?}");
    is_the_one_solution(&ground, &found, "dimple");
}

/// Where a new contact begins the outermost edge leaps: a turn by its radius is at the touch. A turn by the force just
/// beyond it is at that force, not where the new contact was first computed.
#[test]
fn a_turn_may_lie_at_a_touch_and_just_beyond_it() {
    let turned = |turn| looped(wavy(0.0025, 0.05), 0.0, Control::Displacement, turn, Losses::Once);
    let all = turned(Turn::Approach(0.03));
    let touch = all.events.iter().rfind(|event| event.kind == EventKind::Touch).unwrap();
    let (at, crest) = (touch.after.as_ref().unwrap(), touch.radius.unwrap());
    let edge = at.contacts.last().unwrap()[1];
    let by_radius = turned(Turn::Radius(0.5 * (edge + crest))).turn.unwrap();
    assert!((by_radius.reached / crest - 1.0).abs() < 1e-5, "{by_radius:?} {crest}");
    for beyond in [1e-7, 1e-6, 1e-5, 1e-4] {
        let force = at.force * (1.0 + beyond);
        let by_force = turned(Turn::Force(force)).turn.unwrap();
        assert!((by_force.reached / force - 1.0).abs() < 1e-12, "{by_force:?} {force}");
    }
}

/// A crest that touches close to the disc merges with it soon after: both are told, and the loop goes on.
#[test]
fn a_ring_that_merges_at_once_is_told() {
    for amplitude in [0.001_29, 0.001_295, 0.0013, 0.001_305, 0.001_31, 0.001_32, 0.001_325] {
        let found =
            looped(wavy(amplitude, 0.1), 0.0, Control::Displacement, Turn::Approach(0.06), Losses::Once);
        let of = |kind| found.events.iter().filter(|event| event.kind == kind).count();
        assert_eq!(of(EventKind::Touch), of(EventKind::Merge), "{amplitude}");
        for pair in found.states.windows(2).filter(|pair| pair[0].piece == pair[1].piece) {
            assert_eq!(pair[0].contacts.len(), pair[1].contacts.len(), "{amplitude} {pair:?}");
        }
    }
}
