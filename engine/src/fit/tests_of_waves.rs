//! Known values from made loops on waves: the path of our own cycle, whose states are found here by the contact radius.

use super::tests::{E, Normal, W, close, no_points, preset, run};
use super::*;
use crate::case::Case;
use crate::measured::{Abscissa, Points, Segment};
use crate::preset::Preset;
use crate::preset::edge::CLOSING_ADHESION;
use crate::problem::Control;
use crate::problem::Turn;
use crate::progress::Unwatched;
use crate::quasistatic::path::{Direction, PathSetting, PathState};

const WAVES: &str = "shape='wavy-sphere'\nradius_of_curvature=1.0\namplitude=0.0025\nwavelength=0.05";

#[test]
fn a_wavy_sphere_is_found_through_its_snaps() {
    let mut truth = preset(WAVES, 1.0, 0.004, "");
    truth.path.start = crate::problem::Start::ContactRadius(0.6);
    let points = unloaded(&truth, 400);
    let fit = run(&preset(WAVES, 3.0, 0.0013, ""), &points, &[E, W]);
    assert!(fit.snaps >= 2, "{}", fit.snaps);
    close(&fit, &[1.0, 0.004], 1e-8);
    assert_eq!(fit.starts.len(), super::start::BEST);
    let fit = run(&preset(&WAVES.replace("0.0025", "0.003"), 1.2, 0.0035, ""), &points, &[E, W, "A"]);
    close(&fit, &[1.0, 0.004, 0.0025], 1e-8);
}

/// A record may begin in a valley while a crest further in reaches as far.
#[test]
fn a_record_that_begins_behind_a_crest_is_found() {
    const WAVES: &str = "shape='wavy-sphere'\nradius_of_curvature=1.0\namplitude=5e-4\nwavelength=0.015";
    let mut truth = preset(WAVES, 1.0, 5e-5, "");
    truth.path.start = crate::problem::Start::ContactRadius(0.12);
    let (mut points, mut normal) = (unloaded(&truth, 300), Normal::new(3));
    points.force.iter_mut().for_each(|force| *force += 1e-6 * normal.next());
    let fit = run(&preset(WAVES, 1.05, 4.8e-5, ""), &points, &[E, W]);
    assert_eq!(fit.verdict, Verdict::Describes, "{:?}", fit.reasons);
    close(&fit, &[1.0, 5e-5], 5e-3);
}

/// A record that ends on a wave, before the largest pull: its last rows look as if they were apart, its smallest force is not that
/// of the path, and where x is zero is not known.
#[test]
fn a_record_that_ends_on_a_wave_is_found_or_said_to_be_ambiguous() {
    let mut truth = preset(WAVES, 1.0, 0.004, "");
    truth.path.start = crate::problem::Start::ContactRadius(0.41);
    let whole = unloaded(&truth, 400);
    let found = |rows: std::ops::Range<usize>| {
        let mut normal = Normal::new(rows.start as u64 + 1);
        let part = |values: &[f64]| values[rows.clone()].iter().step_by(3).copied().collect::<Vec<f64>>();
        let (mut x, mut force) = (part(&whole.x), part(&whole.force));
        let n = x.len();
        for (x, force) in x.iter_mut().zip(&mut force) {
            *x += 0.05 + 1e-5 * normal.next();
            *force += 2e-5 * normal.next();
        }
        let points = over_approach(x, force, vec![Segment::Retraction; n]);
        run(&preset(WAVES, 1.0, 0.004, ""), &points, &[E, W, "data.offset"])
    };
    let fit = found(0..130);
    assert_eq!(fit.verdict, Verdict::Describes, "{:?}", fit.reasons);
    assert_eq!((fit.rows.fitted(), &*fit.preset.data.free_part), (fit.rows.contact(), "none"));
    close(&fit, &[1.0, 0.004, 0.05], 1e-2);
    // Few rows with one jump: it may be that of another wave.
    let fit = found(20..100);
    assert_eq!(fit.verdict, Verdict::NotDetermined, "{:?}", fit.reasons);
    assert!(fit.direction.is_some_and(|said| said.contains("describe the points as well")));
}

/// Our own unloading of a preset under fixed grips, evenly spaced in the approach, with a free part.
fn unloaded(preset: &Preset, n: usize) -> Points {
    let case = Case::new(preset).unwrap();
    let curve = case.curve(&Unwatched).unwrap();
    let unloading = case.unload(&curve, &PathSetting::new(Control::Displacement), &Unwatched).unwrap();
    let stable = |delta: f64| {
        unloading.pieces().iter().find_map(|[outer, inner]| {
            let state = |s: f64| case.basis.equilibrium(&case.reduced, s).unwrap();
            let (mut lo, mut hi) = (*inner, *outer);
            if !(state(lo).approach..=state(hi).approach).contains(&delta) {
                return None;
            }
            for _ in 0..100 {
                let middle = 0.5 * (lo + hi);
                if state(middle).approach > delta { hi = middle } else { lo = middle }
            }
            Some(state(0.5 * (lo + hi)).force)
        })
    };
    let (top, bottom) = (curve.samples[0].approach, unloading.farthest().unwrap().approach);
    let bottom = bottom - 0.3 * (top - bottom);
    let x: Vec<f64> = (0..n).map(|i| top + (i as f64 + 0.5) / n as f64 * (bottom - top)).collect();
    let force = x.iter().map(|delta| stable(*delta).unwrap_or(0.0)).collect();
    over_approach(x, force, vec![Segment::Retraction; n])
}

/// Points over the approach, exact.
fn over_approach(x: Vec<f64>, force: Vec<f64>, segments: Vec<Segment>) -> Points {
    Points {
        abscissa: Abscissa::Approach,
        x,
        force,
        radius: None,
        steps: [1e-30; 3],
        segments: Some(segments),
        time: None,
        is_said: false,
        skipped: 0,
    }
}

/// Our own loop of a preset up to the control value `top`, `n` samples each way, evenly spaced in δ or in the way of
/// the device, both starting apart.
fn looped(preset: &Preset, top: f64, n: usize) -> Points {
    let control = preset.path.control;
    let case = Case::new(preset).unwrap();
    let cycle = case.cycle(Some(Turn::Control(top)), &PathSetting::new(control), &Unwatched).unwrap();
    assert!(cycle.states.iter().all(|state| state.contacts.len() == 1 && state.contacts[0][0] == 0.0));
    let radii = |same: &[PathState]| {
        let of = same.iter().map(|state| state.contact_radius);
        of.fold([f64::INFINITY, 0.0], |[lo, hi], s| [lo.min(s), f64::max(hi, s)])
    };
    let pieces: Vec<(Direction, [f64; 2])> = cycle
        .states
        .chunk_by(|a, b| (a.direction, a.piece) == (b.direction, b.piece))
        .map(|same| (same[0].direction, radii(same)))
        .collect();
    let state = |s: f64| {
        let at = case.basis.equilibrium(&case.reduced, s).unwrap();
        (control.value(at.approach, at.force), at.force)
    };
    let stable = |value: f64, direction: Direction| {
        let of = pieces.iter().filter(|piece| piece.0 == direction).find_map(|(_, [lo, hi])| {
            let (mut lo, mut hi) = (*lo, *hi);
            if !(state(lo).0..=state(hi).0).contains(&value) {
                return None;
            }
            for _ in 0..100 {
                let middle = 0.5 * (lo + hi);
                if state(middle).0 > value { hi = middle } else { lo = middle }
            }
            Some(state(0.5 * (lo + hi)).1)
        });
        of.unwrap_or(0.0)
    };
    let bottom = cycle.events.iter().map(|event| event.control_value).fold(0.0, f64::min) - 0.3 * top;
    let abscissa = if let Control::Stiffness(_) = control { Abscissa::Position } else { Abscissa::Approach };
    let mut points = no_points(abscissa);
    for (segment, direction) in
        [(Segment::Approach, Direction::Loading), (Segment::Retraction, Direction::Unloading)]
    {
        for i in 0..n {
            let value = bottom + (i as f64 + 0.5) / n as f64 * (top - bottom);
            points.x.push(value);
            points.force.push(stable(value, direction));
            points.segments.as_mut().unwrap().push(segment);
        }
    }
    points
}

#[test]
fn a_loop_on_waves_is_found_by_its_own_ways_up_and_back() {
    let points = looped(&preset(WAVES, 1.0, 0.004, ""), 0.09, 300);
    let found = run(&preset(WAVES, 3.0, 0.0013, ""), &points, &[E, W]);
    assert!(found.rows.contact() > 350 && found.snaps >= 3, "{:?} {}", found.rows, found.snaps);
    close(&found, &[1.0, 0.004], 1e-8);
    assert!(found.residuals.iter().any(|at| !at.datum.free && at.datum.segment == Segment::Approach));
    // The approach alone; each branch with a work of adhesion of its own.
    let asked = crate::measured::Asked { segment: Some(Segment::Approach), ..Default::default() };
    let free = vec![E.to_owned(), W.to_owned()];
    let alone = Options { free, asked, ..Options::default() };
    close(&fit(&preset(WAVES, 0.4, 0.01, ""), &points, &alone, &Unwatched).unwrap(), &[1.0, 0.004], 1e-8);
    let free = [E, W, CLOSING_ADHESION].map(str::to_owned).to_vec();
    let apart = Options { free, ..Options::default() };
    let found = fit(&preset(WAVES, 3.0, 0.0013, ""), &points, &apart, &Unwatched).unwrap();
    close(&found, &[1.0, 0.004, 0.004], 1e-8);
    assert!(found.warnings.iter().all(|warning| !warning.contains("quasi-static")));
}

/// A loop up to the approach `top` whose edge is pinned between the works of adhesion of two presets, by the states of
/// its path and the equilibria between them, `n` samples each way; and the contact radius at its turn.
fn banded(works: [f64; 2], top: f64, n: usize) -> (Points, f64) {
    let mut truth = preset(WAVES, 1.0, works[1], "");
    truth.set_all([("material.closing_work_of_adhesion", works[0].into())]).unwrap();
    let case = Case::new(&truth).unwrap();
    let cycle = case.cycle(Some(Turn::Control(top)), &case.setting(), &Unwatched).unwrap();
    assert!(cycle.states.iter().all(|state| state.contacts.len() == 1 && state.contacts[0][0] == 0.0));
    let least = cycle.states.iter().map(|state| state.approach).fold(0.0, f64::min);
    let ways = [(Segment::Approach, Direction::Loading), (Segment::Retraction, Direction::Unloading)];
    let (mut x, mut force, mut segments) = (Vec::new(), Vec::new(), Vec::new());
    for ((segment, direction), work) in ways.into_iter().zip(works) {
        let case = Case::new(&preset(WAVES, 1.0, work, "")).unwrap();
        let states: Vec<&PathState> =
            cycle.states.iter().filter(|state| state.direction == direction).collect();
        let between = |at: f64, [a, b]: [&PathState; 2]| {
            let share = (at - a.approach) / (b.approach - a.approach);
            if !(0.0..=1.0).contains(&share) || a.piece != b.piece {
                return None;
            }
            if (a.contact_radius - b.contact_radius).abs() < 1e-9 {
                return Some(a.force + share * (b.force - a.force));
            }
            let state = |s: f64| case.basis.equilibrium(&case.reduced, s).unwrap();
            let [mut lo, mut hi] =
                [a.contact_radius.min(b.contact_radius), a.contact_radius.max(b.contact_radius)];
            for _ in 0..60 {
                let middle = 0.5 * (lo + hi);
                if state(middle).approach > at { hi = middle } else { lo = middle }
            }
            Some(state(hi).force)
        };
        for i in 0..n {
            let at = 1.3 * least + (i as f64 + 0.5) / n as f64 * (top - 1.3 * least);
            x.push(at);
            force.push(states.windows(2).find_map(|pair| between(at, [pair[0], pair[1]])).unwrap_or(0.0));
            segments.push(segment);
        }
    }
    let turned = cycle.states.iter().max_by(|a, b| a.approach.total_cmp(&b.approach)).unwrap();
    (over_approach(x, force, segments), turned.contact_radius)
}

#[test]
fn an_edge_is_pinned_on_waves_between_two_works_of_adhesion() {
    let free = [E, W, CLOSING_ADHESION].map(str::to_owned).to_vec();
    let options = Options { free, ..Options::default() }.without_intervals();
    for top in [0.09, 0.12] {
        let (mut points, radius) = banded([0.002, 0.004], top, 300);
        let mut noise = Normal::new(7);
        points.force.iter_mut().for_each(|force| *force += 3e-5 * noise.next());
        let found = fit(&preset(WAVES, 1.2, 0.0013, ""), &points, &options, &Unwatched).unwrap();
        assert_eq!(found.verdict, Verdict::Describes, "{top}: {:?}", found.reasons);
        close(&found, &[1.0, 0.004, 0.002, radius], 0.01);
    }
}

#[test]
fn a_row_that_changes_its_side_of_a_snap_keeps_no_value_off() {
    let (mut points, _) = banded([0.001, 0.004], 0.05, 300);
    let mut noise = Normal::new(7);
    points.force.iter_mut().for_each(|force| *force += 3e-5 * noise.next());
    let free = [E, W, CLOSING_ADHESION].map(str::to_owned).to_vec();
    let options = Options { free, ..Options::default() }.without_intervals();
    let found = fit(&preset(WAVES, 1.2, 0.0013, ""), &points, &options, &Unwatched).unwrap();
    for (fitted, truth) in found.parameters.iter().zip([1.0, 0.004, 0.001]) {
        let error = fitted.standard_error.unwrap();
        assert!((fitted.value - truth).abs() < 3.0 * error, "{fitted:?}");
    }
}

#[test]
fn an_error_that_a_snap_makes_too_small_is_told() {
    let (mut points, _) = banded([0.001, 0.004], 0.07, 300);
    let mut noise = Normal::new(0);
    points.force.iter_mut().for_each(|force| *force += 6e-5 * noise.next());
    let free = [E, W, CLOSING_ADHESION].map(str::to_owned).to_vec();
    let options = Options { free, ..Options::default() };
    let found = fit(&preset(WAVES, 1.2, 0.0013, ""), &points, &options, &Unwatched).unwrap();
    assert!(
        found.warnings.iter().any(|text| text.contains("closing_work_of_adhesion is")),
        "{:?}",
        found.warnings
    );
    let [lo, hi] = found.parameters[2].bootstrap.unwrap().interval;
    assert!((lo..=hi).contains(&0.001), "{lo} {hi}");
}

#[test]
fn a_loop_on_waves_under_a_spring_is_found() {
    let spring = |k: f64| format!("control={{stiffness={k}}}");
    let points = looped(&preset(WAVES, 1.0, 0.004, &spring(1.5)), 0.09, 300);
    let found = run(&preset(WAVES, 3.0, 0.0013, &spring(1.5)), &points, &[E, W]);
    assert!(found.snaps >= 2, "{}", found.snaps);
    close(&found, &[1.0, 0.004], 1e-8);
}

#[test]
fn loading_with_rings_of_contact_is_left_out_and_told() {
    let truth = preset(WAVES, 1.0, 1e-4, "");
    let case = Case::new(&truth).unwrap();
    let turn = Some(Turn::Approach(0.105));
    let cycle = case.cycle(turn, &PathSetting::new(Control::Displacement), &Unwatched).unwrap();
    assert!(cycle.states.iter().any(|state| state.contacts.len() > 1));
    let mut points = no_points(Abscissa::Approach);
    let mut add = |x: f64, force: f64, segment: Segment| {
        points.x.push(x);
        points.force.push(force);
        points.segments.as_mut().unwrap().push(segment);
    };
    for i in (1..40).rev() {
        add(-0.001 * f64::from(i), 0.0, Segment::Approach);
    }
    for state in &cycle.states {
        let is_loading = state.direction == Direction::Loading;
        let segment = if is_loading { Segment::Approach } else { Segment::Retraction };
        add(state.approach, state.force, segment);
    }
    for i in 9..40 {
        add(-0.001 * f64::from(i), 0.0, Segment::Retraction);
    }
    let found = run(&preset(WAVES, 1.4, 0.7e-4, ""), &points, &[E, W]);
    assert!(
        found.notes.iter().any(|note| note.contains("rings of contact are not fitted")),
        "{:?}",
        found.notes
    );
    close(&found, &[1.0, 1e-4], 1e-6);
    let asked = crate::measured::Asked { segment: Some(Segment::Approach), ..Default::default() };
    let options = Options { free: vec![E.to_owned()], asked, scan: false, ..Options::default() };
    let refused = fit(&truth, &points, &options, &Unwatched).unwrap_err().to_string();
    assert!(refused.contains("rings of contact") && refused.contains("a crest outside touches"), "{refused}");
}

#[test]
fn the_retraction_alone_is_found_from_three_times_off_with_its_offset_and_its_amplitude() {
    let mut points = looped(&preset(WAVES, 1.0, 0.004, ""), 0.12, 300);
    for x in &mut points.x {
        *x += 0.03;
    }
    let asked = crate::measured::Asked { segment: Some(Segment::Retraction), ..Default::default() };
    let free = [E, W, "data.offset"].map(str::to_owned).to_vec();
    let options = Options { free, asked, ..Options::default() };
    let start = preset(WAVES, 3.0, 0.0013, "");
    let found = fit(&start, &points, &options, &Unwatched).unwrap();
    close(&found, &[1.0, 0.004, 0.03], 1e-8);
    let free = [E, W, "data.offset", "A"].map(str::to_owned).to_vec();
    let found = fit(&start, &points, &Options { free, ..Options::default() }, &Unwatched).unwrap();
    assert_eq!(found.ending, super::least_squares::Ending::Converged);
    close(&found, &[1.0, 0.004, 0.03, 0.0025], 1e-8);
}
