//! A manual walk through rings: to the next limit point or touch, let it run, turn round.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a helper of a test fails the test by panicking")]
#![allow(
    clippy::disallowed_methods,
    reason = "tests judge by functions that share nothing with what they judge"
)]

use crate::support::{random_gap, wavy};
use pulloff_engine::annuli::{Contacts, Ground, points};
use pulloff_engine::disc::{ExactBasis, Table};
use pulloff_engine::gap::formula::TypedGap;
use pulloff_engine::gap::shapes::{Harmonic, Harmonics};
use pulloff_engine::gap::{Gap, Shape};
use pulloff_engine::problem::Turn;
use pulloff_engine::problem::{ContactKind, Control, Problem, Reduced};
use pulloff_engine::progress::Unwatched;
use pulloff_engine::quasistatic::path::{Balance, EventKind, Losses, Path, PathSetting, PathStep, cycle};
use pulloff_engine::quasistatic::walk::{Arrival, At, Reached, Walk, WalkEnd, Walked, edges};
use pulloff_engine::quasistatic::{Curve, StatePoint};
use std::f64::consts::TAU;
use std::sync::Arc;

pub const STEPS: usize = 5000;

fn reduced(gap: Arc<dyn Gap>, gamma: f64) -> Reduced {
    let shape = Shape::WavySphere { radius_of_curvature: 1.0, amplitude: 0.0, wavelength: 0.05 };
    let problem = Problem { effective_modulus: 1.0, work_of_adhesion: gamma, shape }.reduced();
    Reduced { gap, ..problem }
}

pub fn curve(gap: Arc<dyn Gap>, gamma: f64, end: f64) -> Curve {
    let problem = reduced(gap, gamma);
    let basis = Arc::new(ExactBasis::of(&problem, end).unwrap());
    Curve::of(problem, basis, end, 0.002).unwrap()
}

/// A walker driven by keys.
pub struct Walker<'a> {
    pub curve: &'a Curve,
    pub control: Control,
    pub at: Option<(StatePoint, At)>,
    pub inward: bool,
    pub range: [f64; 2],
}

impl Walker<'_> {
    pub fn asked(
        &mut self,
        what: impl Fn(&Walk<'_>, &mut dyn FnMut(Reached) -> bool) -> Walked,
    ) -> (Walked, Vec<Reached>) {
        let walk = Walk {
            curve: self.curve,
            range: self.range,
            control: self.control,
            from: self.at.as_ref().map(|(point, _)| point),
            at: self.at.as_ref().map_or(At::Nothing, |(_, at)| *at),
            inward: self.inward,
            length: 0.02,
        };
        let mut made = Vec::new();
        let end = what(&walk, &mut |reached| {
            made.push(reached);
            true
        });
        if let Some(last) = made.last() {
            let at = match last.arrival {
                Arrival::Limit(_) => At::Limit,
                Arrival::Touch(radius) if self.at.is_some() => At::Touch(radius),
                _ => At::Nothing,
            };
            self.at = Some((last.point.clone(), at));
        }
        (end, made)
    }

    pub fn contacts(&self) -> Vec<[f64; 2]> {
        let (point, _) = self.at.as_ref().unwrap();
        edges::contacts(&self.curve.equilibrium.scales, point).intervals()
    }
}

fn near(ours: &[[f64; 2]], theirs: &[[f64; 2]]) -> f64 {
    assert_eq!(ours.len(), theirs.len(), "{ours:?} {theirs:?}");
    ours.iter().flatten().zip(theirs.iter().flatten()).fold(0.0, |most, (a, b)| f64::max(most, (a - b).abs()))
}

/// Walks the loop with n and x; returns the largest differences of edges, δ and P, and of losses in relative terms.
fn walks(curve: &Curve, control: Control, found: &Path) -> [f64; 4] {
    let mut walker = Walker { curve, control, at: None, inward: false, range: [curve.outermost(), 0.0] };
    let (end, made) = walker.asked(|walk, emit| walk.first_touch(emit));
    assert_eq!(end, Ok(WalkEnd::Done));
    assert_eq!(made.len(), 1);
    let mut worst =
        [near(&walker.contacts(), &found.events[0].after.as_ref().unwrap().contacts), 0.0, 0.0, 0.0];
    for event in &found.events[1..] {
        if event.kind == EventKind::Turn {
            walker.inward = true;
            continue;
        }
        let (end, made) = walker.asked(|walk, emit| walk.steps(STEPS, true, emit));
        let touches = event.kind == EventKind::Touch;
        assert_eq!(
            end,
            Ok(if touches { WalkEnd::AtTouch } else { WalkEnd::AtLimit }),
            "{event:?} {:?}",
            made.last()
        );
        let before = event.before.as_ref().unwrap();
        worst[0] = worst[0].max(near(&walker.contacts(), &before.contacts));
        let state = made.last().unwrap().state;
        worst[1] = worst[1].max((state.approach - before.approach).abs());
        worst[2] = worst[2].max((state.force - before.force).abs());
        let (end, made) = walker.asked(|walk, emit| walk.jump(emit));
        assert_eq!(end, Ok(WalkEnd::Done), "{event:?}");
        let Arrival::Jump(jump) = &made[0].arrival else { panic!("{:?}", made[0].arrival) };
        assert_eq!(jump.after.is_some(), event.after.is_some());
        if let Some(after) = &event.after {
            worst[0] = worst[0].max(near(&walker.contacts(), &after.contacts));
            worst[1] = worst[1].max((made[0].state.approach - after.approach).abs());
            worst[2] = worst[2].max((made[0].state.force - after.force).abs());
            assert!(made[0].stability.under(control), "{event:?}");
        }
        if let (Some(ours), Some(theirs)) = (jump.dissipated, event.dissipated) {
            worst[3] = worst[3].max((ours / theirs - 1.0).abs());
        }
    }
    worst
}

fn looped(gap: &Arc<dyn Gap>, gamma: f64, control: Control, turn: Turn) -> Path {
    let table = Arc::new(Table::new(Arc::clone(gap), 0.3, &Unwatched).unwrap());
    let setting = PathSetting { losses: Losses::Once, ..PathSetting::new(control) };
    cycle(&table, gamma, turn, &setting, &pulloff_engine::progress::Unwatched).unwrap()
}

/// Compares a walk with the events of another program, by way of the loop, which is compared with them.
fn reproduces(gamma: f64, reference: &str) {
    let gap = wavy(0.0025, 0.05);
    let found = looped(&gap, gamma, Control::Displacement, Turn::Approach(0.14));
    let expected = crate::support::reference(reference);
    let expected: Vec<_> = expected["events"].as_array().unwrap().iter().collect();
    assert_eq!(found.events.len(), expected.len());
    let curve = curve(gap, gamma, 0.6);
    let worst = walks(&curve, Control::Displacement, &found);
    println!("{worst:?}");
    assert!(worst[..3].iter().all(|error| *error < 1e-10) && worst[3] < 1e-8, "{worst:?}");
    // The last jump of loading, with the other program's own numbers.
    let jumps = |event: &&serde_json::Value| event["kind"] == "touch" || event["kind"] == "snap-in";
    let last = expected.iter().rposition(jumps).unwrap();
    let (delta, force, contacts) = crate::support::numbers(&expected[last]["before"]);
    let before = found.events[last].before.as_ref().unwrap();
    assert!((before.approach - delta).abs() < 1e-10 && (before.force - force).abs() < 1e-10);
    assert!(near(&before.contacts, &contacts) < 1e-10);
}

#[test]
fn by_hand_the_loop_of_figure_9_is_walked() {
    reproduces(0.025 / TAU, "fig9-cycle");
}

#[test]
fn by_hand_the_rings_of_weak_adhesion_are_walked() {
    reproduces(1e-4, "fig9-weak");
}

/// The eigenvalues of J under each control at a walked state agree with its slopes.
#[test]
fn stability_is_that_of_the_eigenvalues() {
    let gamma = 1e-4;
    let curve = curve(wavy(0.0025, 0.05), gamma, 0.4);
    let ground = Ground::of(wavy(0.0025, 0.05), 0.7).unwrap();
    let range = [0.4, 0.0];
    let mut walker = Walker { curve: &curve, control: Control::Displacement, at: None, inward: false, range };
    let _ = walker.asked(|walk, emit| walk.first_touch(emit));
    let (mut seen, mut unstable, mut ends) = (0, 0, Vec::new());
    for _ in 0..40 {
        let (end, made) = walker.asked(|walk, emit| walk.steps(STEPS, true, emit));
        for reached in made.iter().filter(|reached| edges::has_rings(&reached.point)) {
            let contacts = edges::contacts(&curve.equilibrium.scales, &reached.point);
            for control in [Control::Displacement, Control::Stiffness(0.2), Control::Force] {
                let balance = Balance {
                    ground: &ground,
                    work_of_adhesion: gamma,
                    contact: ContactKind::Rings,
                    control,
                    progress: &Unwatched,
                    lane: None,
                    pinned: None,
                };
                let points = points(&ground, &contacts);
                let value = control.value(reached.state.approach, reached.state.force);
                let held = balance.held(&contacts, &points, value).unwrap();
                assert!(held.excess.amax() < 1e-8 * gamma.sqrt());
                let lowest = Balance::least_eigenvalue(&held);
                if lowest.abs() > 1e-4 * held.jacobian.amax() {
                    assert_eq!(
                        reached.stability.under(control),
                        lowest > 0.0,
                        "{control} {lowest} {reached:?}"
                    );
                    seen += 1;
                    unstable += usize::from(lowest < 0.0);
                }
            }
        }
        match end {
            // At a touch let it run; at a limit point go on along the branch, which is then unstable.
            Ok(WalkEnd::AtTouch) => {
                let _ = walker.asked(|walk, emit| walk.jump(emit));
            }
            Ok(WalkEnd::AtLimit) => {}
            end => {
                ends.push(end);
                break;
            }
        }
    }
    println!("{seen} states, {unstable} unstable, {ends:?}");
    assert!(seen > 100 && unstable > 10, "{seen} {unstable}");
    assert!(matches!(ends[0], Ok(WalkEnd::EdgesMeet(_) | WalkEnd::Vanishes(_))), "{ends:?}");
}

#[test]
fn past_a_touch_states_without_the_ring_are_not_admissible() {
    let curve = curve(wavy(0.0025, 0.05), 1e-4, 0.4);
    let mut walker =
        Walker { curve: &curve, control: Control::Displacement, at: None, inward: false, range: [0.4, 0.0] };
    let _ = walker.asked(|walk, emit| walk.first_touch(emit));
    loop {
        let (end, made) = walker.asked(|walk, emit| walk.steps(STEPS, true, emit));
        let last = made.last().unwrap();
        if end == Ok(WalkEnd::AtTouch) {
            let Arrival::Touch(radius) = last.arrival else { panic!("{last:?}") };
            assert!(
                radius > last.state.contact_radius && last.admissibility.nearest.unwrap().gap.abs() < 1e-12
            );
            break;
        }
        assert_eq!(end, Ok(WalkEnd::AtLimit));
        let _ = walker.asked(|walk, emit| walk.jump(emit));
    }
    let (end, made) = walker.asked(|walk, emit| walk.steps(3, false, emit));
    assert_eq!(end, Ok(WalkEnd::Done));
    for reached in &made {
        assert!(!edges::has_rings(&reached.point) && !reached.admissibility.holds, "{reached:?}");
        assert!(reached.admissibility.overlapping().is_some());
    }
    // Back at the touch and turned round, nothing is missed: the gap opens.
    walker.inward = true;
    let (_, made) = walker.asked(|walk, emit| walk.steps(12, false, emit));
    assert!(made.last().unwrap().admissibility.holds);
}

#[test]
fn the_edges_follow_a_changed_problem_or_say_that_they_do_not() {
    let curve_at = |gamma: f64| curve(wavy(0.0025, 0.05), gamma, 0.4);
    let old = curve_at(1e-4);
    let mut walker =
        Walker { curve: &old, control: Control::Displacement, at: None, inward: false, range: [0.4, 0.0] };
    let _ = walker.asked(|walk, emit| walk.first_touch(emit));
    while walker.contacts().len() < 2 {
        let _ = walker.asked(|walk, emit| walk.steps(STEPS, true, emit));
        let _ = walker.asked(|walk, emit| walk.jump(emit));
    }
    let (contacts, point) = (walker.contacts(), walker.at.clone().unwrap().0);
    let rings = edges::contacts(&old.equilibrium.scales, &point);
    let delta = edges::device(&old.equilibrium.scales, &point)[0];
    for (gamma, follows) in [(1.02e-4, true), (4e-3, false)] {
        let new = curve_at(gamma);
        let mut walker = Walker {
            curve: &new,
            ..Walker {
                curve: &new,
                control: Control::Displacement,
                at: None,
                inward: false,
                range: [0.4, 0.0],
            }
        };
        let (end, made) = walker.asked(|walk, emit| walk.solve_rings(delta, &rings, emit));
        assert_eq!(end == Ok(WalkEnd::Done), follows, "{end:?}");
        if follows {
            assert!((made[0].state.approach - delta).abs() < 1e-15);
            let moved = near(&walker.contacts(), &contacts);
            assert!(moved > 1e-6 && moved < 2e-3, "{moved}");
        }
    }
}

#[test]
fn corners_of_the_gap_are_passed_by_hand() {
    let text = "r^2/2+0.0025*(1-cos(2*pi*r/0.05))+0.05*max(r-0.1,0)";
    let gap = Shape::Formula(Arc::new(TypedGap::new(text, Vec::new(), Some(0.6)).unwrap()));
    let gap: Arc<dyn Gap> = Arc::new(gap);
    let found = looped(&gap, 1e-4, Control::Displacement, Turn::Approach(0.03));
    let worst = walks(&curve(gap, 1e-4, 0.3), Control::Displacement, &found);
    println!("{worst:?}");
    assert!(worst[..3].iter().all(|error| *error < 1e-9) && worst[3] < 1e-7, "{worst:?}");
}

/// Near a cusp under force: a step from beyond both limit points ends at the first one, although a longer step would
/// pass both.
#[test]
fn of_two_limit_points_within_a_step_the_first_is_met() {
    let wave = Harmonic {
        amplitude: 2.902_120_838_197_131_4e-4,
        wavelength: 0.049_264_039_446_009_815,
        phase: 0.115_150_946_176_080_95,
    };
    let gap: Arc<dyn Gap> = Arc::new(Harmonics::new(1.0, vec![wave]).unwrap());
    let gamma = 4.409_940_577_548_066e-5;
    let curve = curve(Arc::clone(&gap), gamma, 0.3);
    let mut radii: Vec<f64> =
        curve.limit_points(Control::Force).iter().map(|limit| limit.contact_radius).collect();
    radii.sort_by(f64::total_cmp);
    let width = |pair: &&[f64]| pair[1] - pair[0];
    let pair = radii.windows(2).min_by(|a, b| width(a).total_cmp(&width(b))).unwrap();
    let ground = Ground::of(gap, 0.4).unwrap();
    let balance = Balance {
        ground: &ground,
        work_of_adhesion: gamma,
        control: Control::Force,
        contact: ContactKind::OneDisc,
        progress: &Unwatched,
        lane: None,
        pinned: None,
    };
    let mut passed = 0;
    for share in [0.2, 0.5, 1.0, 2.0] {
        let away = share * width(&pair);
        let start = curve.equilibrium.explicit(pair[1] + away).unwrap();
        let [_, force, s] = curve.equilibrium.quantities(start.y());
        let contacts = Contacts::of_disc(s);
        let held = balance.held(&contacts, &points(&ground, &contacts), force).unwrap();
        let from = balance.point(held, -1.0).unwrap();
        let way = (2.0 * away + width(&pair)) / from.scales.edges[0];
        let length = way / from.tangent[0].abs();
        let ends = PathStep::new(&balance, &from).taken(length);
        let mut taken = balance.step(&from, length, &[], &|_| true).unwrap();
        passed += usize::from(ends.is_some_and(|end| end.along_control() * from.along_control() > 0.0));
        assert!(taken.to_limit().unwrap(), "{share}");
        let met = taken.end.contacts().disc;
        assert!((met - pair[1]).abs() < 1e-9, "{share}: {met} {pair:?}");
    }
    assert!(passed > 0, "{pair:?}");
}

fn random(numbers: std::ops::Range<u64>) {
    let mut failures = Vec::new();
    for number in numbers {
        let mut random = fastrand::Rng::with_seed(number);
        let (gap, name) = random_gap(&mut random);
        let gamma = 1e-5 * 500.0_f64.powf(random.f64());
        let control =
            [Control::Displacement, Control::Force, Control::Stiffness(0.03 * 100.0_f64.powf(random.f64()))]
                [random.usize(0..3)];
        let turn = Turn::Approach(0.01 + 0.07 * random.f64());
        let found = looped(&gap, gamma, control, turn);
        let reach = found.states.iter().map(|state| state.contact_radius).fold(0.0, f64::max);
        let curve = curve(gap, gamma, 1.1 * reach);
        let name = format!("{number}: {name} γ {gamma:e} {control} to {turn:?}");
        println!("{name}");
        let worst = walks(&curve, control, &found);
        println!("{worst:?}");
        if worst[0] > 1e-8 || worst[3] > 1e-6 {
            failures.push(format!("{name}: {worst:?}"));
        }
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

#[test]
fn some_random_loops_are_walked() {
    random(0..4);
}

#[test]
#[ignore = "a minute"]
fn more_random_loops_are_walked() {
    random(4..40);
}
