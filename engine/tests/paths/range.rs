//! Adhesion with a range against closed forms, differences, and numbers from an independent prototype.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a helper of a test fails the test by panicking")]
#![allow(clippy::disallowed_methods, reason = "the judge needs no reproducible last digit")]

use pulloff_engine::Shape;
use pulloff_engine::disc::Table;
use pulloff_engine::gap::shapes::{ExactSphere, Harmonic, Harmonics, PowerLaw};
use pulloff_engine::problem::{Cohesion, Control, Problem, Start, Turn};
use pulloff_engine::progress::Unwatched;
use pulloff_engine::quasistatic::StartError;
use pulloff_engine::quasistatic::path::{
    Event, EventKind, Path, PathError, PathSetting, PathStop, ZoneStartError, cycle_in_zone, start_in_zone,
    unload_in_zone,
};
use pulloff_engine::zone::{Equilibria, ZoneAt, ZoneState};
use std::f64::consts::PI;
use std::sync::Arc;

fn table(shape: &Shape) -> Arc<Table> {
    let problem = Problem { effective_modulus: 1.0, work_of_adhesion: 1.0, shape: shape.clone() }.reduced();
    Arc::new(Table::new(Arc::clone(&problem.gap), 0.5, &Unwatched).unwrap())
}

const SPHERE: Shape = Shape::Sphere { radius_of_curvature: 1.0 };
const FIGURE_9: Shape = Shape::WavySphere { radius_of_curvature: 1.0, amplitude: 0.0025, wavelength: 0.05 };
const GAMMA: f64 = 0.025 / (2.0 * PI);

fn cohesion(gamma: f64, strength: f64) -> Cohesion {
    Cohesion { strength, range: gamma / strength }
}

fn equilibria(shape: &Shape, gamma: f64, strength: f64, reach: f64) -> Equilibria {
    let mut found = Equilibria::new(&table(shape), cohesion(gamma, strength), reach, &Unwatched).unwrap();
    found.grow(&|state| state.edge >= reach, &Unwatched).unwrap();
    found
}

/// σ₀ for Maugis' `λ_M` at R = 1.
fn strength(gamma: f64, maugis: f64) -> f64 {
    maugis / (9.0 / (2.0 * PI * gamma)).cbrt()
}

fn cycle(shape: &Shape, cohesion: Cohesion, turn: Turn, control: Control) -> Result<Path, PathError> {
    cycle_in_zone(&table(shape), cohesion, turn, &PathSetting::new(control), &Unwatched)
}

fn of_kind(path: &Path, kind: EventKind) -> Option<&Event> {
    path.events.iter().find(|event| event.kind == kind)
}

/// Checks every loss by energy and by area, to a share of the work done.
fn balanced(path: &Path, share: f64) {
    crate::zones::balanced(path, share, "");
}

/// On h = cr^n with 1 < n < 2 a zone without contact is in equilibrium at δ = cr^n − 4σ₀r/π − `h_c` with P = −πσ₀r². The
/// jump in lands where δ = −`h_c` again, the bodies part where δ is least, and the losses are ∫ P dδ up to there.
#[test]
fn a_zone_on_a_pointed_gap_jumps_in_and_off_where_it_should() {
    for (exponent, coefficient, strength, range) in [
        (1.4, 0.2278, 0.02018, 0.13588),
        (1.3, 1.1512, 0.13527, 0.07763),
        (1.05, 0.1, 0.06, 0.3),
        (1.6, 1.0, 0.01, 0.05),
    ] {
        let shape = Shape::PowerLaw(PowerLaw { factor: coefficient, exponent });
        let cohesion = Cohesion { strength, range };
        let table = Arc::new(Table::new(Arc::new(shape), 0.5, &Unwatched).unwrap());
        let setting = PathSetting::new(Control::Displacement);
        let path = cycle_in_zone(&table, cohesion, Turn::Approach(0.0), &setting, &Unwatched).unwrap();
        let slope = 4.0 * strength / PI;
        let lost = |c: f64| {
            let n = exponent;
            PI * strength * (n * coefficient * c.powf(n + 2.0) / (n + 2.0) - slope * c.powi(3) / 3.0)
        };
        let on = (slope / coefficient).powf(1.0 / (exponent - 1.0));
        let off = (slope / (exponent * coefficient)).powf(1.0 / (exponent - 1.0));
        for (kind, c, loss) in [(EventKind::JumpIn, on, lost(on)), (EventKind::SnapOff, off, -lost(off))] {
            let event = of_kind(&path, kind).unwrap();
            let at = event.after.as_ref().or(event.before.as_ref()).unwrap();
            let force = -PI * strength * c * c;
            assert!((at.force / force - 1.0).abs() < 1e-6, "{exponent} {kind:?}: {} {force}", at.force);
            let found = event.dissipated.unwrap();
            assert!((found / loss - 1.0).abs() < 1e-4, "{exponent} {kind:?}: {found:e} {loss:e}");
        }
    }
}

#[test]
fn slopes_and_energy_are_those_of_differences() {
    for strength in [0.5, 1.0, 4.0] {
        let of = equilibria(&FIGURE_9, GAMMA, strength, 0.5);
        for c in [0.02, 0.07, 0.11, 0.2, 0.333, 0.4711] {
            let state = |c: f64| of.zone.state(c, None).unwrap();
            let d = 3e-4 * c;
            let [far, near, at, next, last] = [-2.0, -1.0, 0.0, 1.0, 2.0].map(|k| state(c + k * d));
            let by =
                |f: fn(&ZoneState) -> f64| (8.0 * (f(&next) - f(&near)) - (f(&last) - f(&far))) / (12.0 * d);
            let [approach, force, energy] = [by(|s| s.approach), by(|s| s.force), by(|s| s.energy)];
            assert!((approach - at.slopes[0]).abs() < 1e-6, "{strength} {c}: {approach} {at:?}");
            assert!((force - at.slopes[1]).abs() < 1e-6, "{strength} {c}: {force} {at:?}");
            assert!((energy - at.force * approach).abs() < 1e-8, "{strength} {c}: {energy} {at:?}");
        }
    }
}

#[test]
fn the_panels_give_the_states_back() {
    for strength in [0.5, 1.0, 16.0] {
        let of = equilibria(&FIGURE_9, GAMMA, strength, 0.5);
        let solution = of.solution();
        for k in 1..200 {
            let c = 0.0025 * f64::from(k);
            let (at, exact) = (solution.place(c).unwrap(), of.zone.state(c, None).unwrap());
            let found = solution.at(at);
            assert!((found.approach - exact.approach).abs() < 1e-11, "{strength} {c}");
            assert!((found.force - exact.force).abs() < 1e-11, "{strength} {c}");
            assert!((solution.energy(at) - exact.energy).abs() < 1e-12, "{strength} {c}");
            let contact = solution.edges(at).contact_radius;
            assert!((contact - exact.contact_radius).abs() < 1e-6 * c, "{strength} {c}");
        }
    }
}

#[test]
fn gap_and_pressure_are_those_of_the_law() {
    let of = equilibria(&FIGURE_9, GAMMA, 1.0, 0.5);
    for c in [0.03, 0.2, 0.41] {
        let state = of.zone.state(c, None).unwrap();
        let at = ZoneAt::from(state);
        let at_edge = of.zone.gap_at(at, c) / of.zone.cohesion.range;
        assert!((at_edge - 1.0).abs() < 1e-8, "{c} {at_edge}");
        assert!(of.zone.gap_at(at, at.contact_radius * (1.0 + 1e-9)).abs() < 1e-9);
        // The force is the integral of the pressure: r = s sin x resolves the root at s.
        let inside: f64 = (0..20_000)
            .map(|k| {
                let x = 0.5 * PI * (f64::from(k) + 0.5) / 20_000.0;
                let r = at.contact_radius * x.sin();
                of.zone.pressure_at(at, r) * 2.0 * PI * r * at.contact_radius * x.cos() * 0.5 * PI / 20_000.0
            })
            .sum();
        let free = -PI * of.zone.cohesion.strength * (c - at.contact_radius) * (c + at.contact_radius);
        assert!(
            (inside + free - state.force).abs() < 1e-6 * state.force.abs(),
            "{c}: {inside} {free} {state:?}"
        );
    }
}

#[test]
fn the_largest_pull_of_a_sphere_goes_from_dmt_to_jkr() {
    for gamma in [0.01, 1e-3, 1e-4, 1e-5] {
        for (maugis, expected) in [
            (0.05, 1.98144),
            (0.1, 1.95059),
            (0.2, 1.88047),
            (0.5, 1.71825),
            (1.0, 1.60073),
            (2.0, 1.53460),
            (5.0, 1.50635),
            (10.0, 1.50162),
            (20.0, 1.50041),
        ] {
            let cohesion = cohesion(gamma, strength(gamma, maugis));
            let path = cycle(&SPHERE, cohesion, Turn::Force(gamma), Control::Force).unwrap();
            let pull = -path.largest_pull().unwrap().force / (PI * gamma);
            assert!((pull - expected).abs() < 6e-6, "{maugis}: {pull} {expected}");
            assert!((cohesion.maugis(1.0, 1.0) / maugis - 1.0).abs() < 1e-12);
            // The zone and the contact begin at the same time, at zero force, where only rounding decides whether P
            // falls.
            let kinds: Vec<_> = path.events.iter().map(|event| event.kind).collect();
            assert_eq!(kinds, [EventKind::JumpIn, EventKind::Turn, EventKind::SnapOff], "{gamma} {maugis}");
            balanced(&path, 1e-9);
        }
    }
}

#[test]
fn contact_begins_and_ends_where_the_closed_forms_say() {
    let gamma = 1e-3;
    let path = |maugis: f64| {
        let cohesion = cohesion(gamma, strength(gamma, maugis));
        let path = cycle(&SPHERE, cohesion, Turn::Approach(0.05), Control::Displacement).unwrap();
        balanced(&path, 1e-9);
        path
    };
    // (9/32)^{1/3} and (9π/(16(π − 1)))^{1/3}.
    let (lands, leaves) = ((9.0_f64 / 32.0).cbrt(), (9.0 * PI / (16.0 * (PI - 1.0))).cbrt());
    for (maugis, jumps_into_contact) in [(lands - 1e-3, false), (lands + 1e-3, true)] {
        let path = path(maugis);
        let first = of_kind(&path, EventKind::JumpIn).unwrap();
        assert_eq!(!first.after.as_ref().unwrap().contacts.is_empty(), jumps_into_contact, "{maugis}");
        assert_eq!(of_kind(&path, EventKind::FirstTouch).is_some(), !jumps_into_contact, "{maugis}");
    }
    for (maugis, from_contact) in [(leaves - 1e-3, false), (leaves + 1e-3, true)] {
        let path = path(maugis);
        let last = of_kind(&path, EventKind::SnapOff).unwrap();
        assert_eq!(!last.before.as_ref().unwrap().contacts.is_empty(), from_contact, "{maugis}");
        assert_eq!(of_kind(&path, EventKind::LastContact).is_some(), !from_contact, "{maugis}");
        assert!(path.last_contact().is_some() && path.separation() == Some(last));
    }
}

/// Where contact begins within a zone δ runs on smoothly: that is no limit point, and the slope is that of c/R − 4σ₀/(πE*).
#[test]
fn the_beginning_of_contact_within_a_zone_is_no_limit_point() {
    for (strength, gamma) in [(0.02, 1e-3), (0.05, 2e-3), (0.2, 1e-3)] {
        let of = equilibria(&SPHERE, gamma, strength, 0.5);
        let solution = of.solution();
        let touches = solution.touches();
        assert!(!touches.is_empty(), "{strength}");
        for place in touches {
            let local = solution.at(*place);
            let slope = local.slopes[0] / local.stretch;
            let expected = local.contact_radius - 4.0 * strength / PI;
            assert!((slope - expected).abs() < 1e-4 * expected.abs(), "{strength} {slope} {expected}");
        }
    }
}

#[test]
fn figure_9_jumps_and_loses_as_the_prototype() {
    for (strength, losses, pull) in
        [(2.0, 1.18691e-3, -1.48001), (1.0, 1.15620e-3, -1.47803), (0.5, 1.01985e-3, -1.42198)]
    {
        let path =
            cycle(&FIGURE_9, cohesion(GAMMA, strength), Turn::Approach(0.02), Control::Displacement).unwrap();
        let turn = path.events.iter().position(|event| event.kind == EventKind::Turn).unwrap();
        let jumps = |events: &[Event]| events.iter().filter(|event| event.dissipated != Some(0.0)).count();
        assert_eq!([jumps(&path.events[..turn]), jumps(&path.events[turn..])], [2, 4], "{strength}");
        let total = path.totals.dissipated.unwrap();
        assert!((total / losses - 1.0).abs() < 6e-6, "{strength}: {total}");
        let least = path.largest_pull().unwrap().force / (1.5 * PI * GAMMA);
        assert!((least - pull).abs() < 6e-6, "{strength}: {least}");
        balanced(&path, 1e-9);
    }
}

#[test]
fn figure_9_comes_to_the_short_range_limit() {
    let unload = |strength: f64| {
        let setting = PathSetting::new(Control::Displacement);
        let path = unload_in_zone(&table(&FIGURE_9), cohesion(GAMMA, strength), 0.41, &setting, &Unwatched);
        path.unwrap()
    };
    for (strength, losses, tolerance) in [
        (8.0, 7.92048e-4, 1e-5),
        (2.0, 7.9168e-4, 1e-4),
        (1.0, 7.853e-4, 1e-4),
        (0.7, 7.630e-4, 1e-4),
        (0.5, 6.702e-4, 1e-4),
    ] {
        let path = unload(strength);
        assert_eq!(path.events.len(), 6, "{strength}");
        let total = path.totals.dissipated.unwrap();
        assert!((total / losses - 1.0).abs() < tolerance, "{strength}: {total}");
        balanced(&path, 1e-9);
    }
    // In the limit −P_min/P_c is 1.4796729 and the first snap is at the radius of the limit point; both are approached
    // with order 2 in 1/σ₀.
    let pull = |strength: f64| unload(strength).largest_pull().unwrap().force / (1.5 * PI * GAMMA);
    let snap = |strength: f64| unload(strength).events[0].before.as_ref().unwrap().contact_radius;
    for f in [&pull as &dyn Fn(f64) -> f64, &snap] {
        let [a, b, c] = [16.0, 32.0, 64.0].map(f);
        let order = ((a - b) / (b - c)).log2();
        assert!((order - 2.0).abs() < 0.03, "{order}");
    }
    assert!((pull(16.0) + 1.479_672_9).abs() < 1e-5);
}

#[test]
fn what_one_zone_does_not_hold_is_refused_by_name() {
    let of =
        |strength| cycle(&FIGURE_9, cohesion(GAMMA, strength), Turn::Approach(0.02), Control::Displacement);
    assert!(of(0.5).is_ok());
    // Followed up to the last jump, which would land on two contacts in one zone.
    let path = of(0.4).unwrap();
    assert!(matches!(path.stop, PathStop::BeyondZone { .. }), "{}", path.stop);
    assert!(path.totals.dissipated.is_none() && path.events.len() == 6, "{path:?}");
    balanced(&path, 1e-9);
    // Here the jump from apart does, or one soon after it.
    let error = of(0.3).unwrap_err();
    assert!(matches!(error, PathError::BeyondZone { .. }), "{error}");
    for strength in [0.1, 0.02] {
        let path = of(strength).unwrap();
        assert!(matches!(path.stop, PathStop::BeyondZone { .. }) && path.turn.is_none(), "{}", path.stop);
        balanced(&path, 1e-9);
    }
    // Next to the axis there is a lower crest: nothing can be followed.
    let dimple = Shape::Harmonics(Arc::new(
        Harmonics::new(1.0, vec![Harmonic { amplitude: 0.01, wavelength: 0.2, phase: 3.0 }]).unwrap(),
    ));
    let error = cycle(&dimple, cohesion(GAMMA, 1.0), Turn::Approach(0.02), Control::Displacement);
    assert!(matches!(error, Err(PathError::BeyondZone { .. })), "{error:?}");
}

/// The gap r⁸ is so flat that its zone is 10⁻⁸ of the contact: even where s and c are known to only half of their
/// digits, the slopes keep all of theirs.
#[test]
fn the_slopes_of_a_thin_zone_have_all_their_digits() {
    let shape = Shape::PowerLaw(PowerLaw { factor: 1.0, exponent: 8.0 });
    let of = equilibria(&shape, 3.94e-18, 1.148e-4, 0.2);
    for edge in [0.005, 0.02, 0.04, 0.1] {
        // For a smooth function the sixth differences over a thousandth of c are below rounding.
        let states = [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0]
            .map(|k| of.zone.state(edge * (1.0 + 1e-3 * k), None).unwrap());
        assert!(states[3].share > 0.999_999, "{:?}", states[3]);
        for part in 0..2 {
            let weights = [1.0, -6.0, 15.0, -20.0, 15.0, -6.0, 1.0];
            let sixth: f64 =
                weights.iter().zip(&states).map(|(weight, state)| weight * state.slopes[part]).sum();
            let size = states[3].slopes[part].abs();
            assert!(sixth.abs() < 1e-13 * size, "{edge}, part {part}: {sixth} of {size}");
        }
    }
}

#[test]
fn a_start_without_contact_says_why_there_is_none() {
    let law = cohesion(GAMMA, strength(GAMMA, 1.0));
    let start = |shape: &Shape, approach| {
        start_in_zone(&table(shape), law, Start::Approach(approach), &Unwatched).map_err(
            |error| match error {
                ZoneStartError::Start(error) => error,
                ZoneStartError::Path(error) => panic!("{error}"),
            },
        )
    };
    let found = start(&SPHERE, 0.01).unwrap();
    let of = equilibria(&SPHERE, GAMMA, law.strength, 0.4);
    let states: Vec<ZoneState> =
        (1..=4000).filter_map(|k| of.zone.state(1e-4 * f64::from(k), None)).collect();
    let contact: Vec<&ZoneState> = states.iter().filter(|state| state.contact_radius > 0.0).collect();
    let at = contact.iter().rev().find(|state| state.approach <= 0.01).unwrap();
    assert!((at.contact_radius - found).abs() < 2e-4, "{found} {at:?}");
    // No contact exists with the bodies so far apart.
    let least = contact.iter().map(|state| state.approach).fold(f64::INFINITY, f64::min);
    let Err(StartError::OutOfReach { name: "approach", smallest, .. }) = start(&SPHERE, -1.0) else {
        panic!()
    };
    assert!(smallest <= least && smallest > least - 1e-6, "{smallest} {least}");
    // The known part of the gap ends before that.
    let known = start(&Shape::ExactSphere(ExactSphere { radius: 1.0 }), 50.0);
    assert!(matches!(known, Err(StartError::NotKnown { known: 1.0, .. })), "{known:?}");
}

/// The median of what each of some runs takes, in seconds.
fn median(runs: usize, mut run: impl FnMut()) -> f64 {
    let mut times: Vec<f64> = (0..runs)
        .map(|_| {
            let begun = std::time::Instant::now();
            run();
            begun.elapsed().as_secs_f64()
        })
        .collect();
    times.sort_by(f64::total_cmp);
    times[runs / 2]
}

/// `cargo test --release -p pulloff-engine --test paths range::times -- --ignored --nocapture`
#[test]
#[ignore = "only prints"]
fn times() {
    let of = equilibria(&FIGURE_9, GAMMA, 1.0, 0.36);
    let edges: Vec<f64> = (1..=1000).map(|k| 0.00036 * f64::from(k)).collect();
    let mut near = None;
    let all = median(21, || {
        for c in &edges {
            near = of.zone.state(*c, near).map(|state| state.share).filter(|share| *share > 0.0);
        }
    });
    println!("a state: {:.1} us", 1e3 * all);
    for strength in [0.45, 1.0, 4.0] {
        for control in [Control::Displacement, Control::Force, Control::Stiffness(0.3)] {
            let table = table(&FIGURE_9);
            let once = || {
                let law = cohesion(GAMMA, strength);
                cycle_in_zone(&table, law, Turn::Approach(0.02), &PathSetting::new(control), &Unwatched)
                    .unwrap();
            };
            println!("the loop of Fig. 9 at sigma0 = {strength}, {control}: {:.1} ms", 1e3 * median(9, once));
        }
    }
}
