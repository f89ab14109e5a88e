//! Records as instruments write them: loads that are held, radii with much noise, positions behind a spring.

use super::tests::{Body, E, Normal, W, no_points, preset, sphere};
use super::*;
use crate::measured::{Abscissa, Points, Segment};
use crate::preset::data::OFFSET;
use crate::progress::Unwatched;

const SPHERE: &str = "shape='sphere'\nradius_of_curvature=1.0";

fn found(points: &Points, free: &[&str], more: &str) -> Fit {
    let free = free.iter().map(|key| (*key).to_owned()).collect();
    fit(&preset(SPHERE, 1.5, 0.015, more), points, &Options { free, ..Options::default() }, &Unwatched)
        .unwrap()
}

/// How far the first values are off, in their errors.
fn off(fit: &Fit, truth: &[f64]) -> Vec<f64> {
    let off = fit.parameters.iter().zip(truth);
    off.map(|(of, truth)| (of.value - truth) / of.standard_error.unwrap()).collect()
}

/// How many of twelve records of 400 rows are refused, each of which stays 200 rows long at these rows.
fn refused(held: &[usize]) -> usize {
    let body = Body { state: &sphere(1.0, 0.02, 1.0), compliance: 0.0, most: 1.1 };
    let rows = body.samples(400);
    let mut refused = 0;
    for (seed, of_x) in (0..12).zip([0.0, 1e-3, 4e-3].into_iter().cycle()) {
        let mut normal = Normal::new(seed);
        let mut points = Points { segments: None, ..no_points(Abscissa::Approach) };
        for (i, (x, force)) in rows.x.iter().zip(&rows.force).enumerate() {
            for _ in 0..if held.contains(&i) { 200 } else { 1 } {
                points.x.push(x + of_x * normal.next());
                points.force.push(force + 1e-3 * normal.next());
            }
        }
        let fit = found(&points, &[E, W, OFFSET], "");
        assert_eq!(fit.turned, [false; 2], "{seed}");
        refused += usize::from(fit.verdict != Verdict::Describes);
        assert!(off(&fit, &[1.0, 0.02, 0.0]).iter().all(|z| z.abs() < 4.0), "{seed}: {:?}", fit.parameters);
    }
    refused
}

#[test]
fn what_is_held_is_neither_a_free_part_nor_a_misfit() {
    // Under the largest load, and apart at either end and at both. By chance one of a hundred is refused.
    for held in [&[199][..], &[0], &[399], &[0, 399]] {
        assert!(refused(held) <= 1, "{held:?}");
    }
}

#[test]
fn a_weak_correlation_of_the_noise_is_no_misfit() {
    let body = Body { state: &sphere(1.0, 0.02, 1.0), compliance: 0.0, most: 1.1 };
    let rows = body.samples(600);
    // By how much neighbours are correlated, and how many of sixteen are refused at most.
    for (share, most) in [(0.2, 5), (0.4, 2)] {
        let mut refused = 0;
        for seed in 0..16 {
            let (mut normal, mut last) = (Normal::new(seed), 0.0);
            let mut points = rows.clone();
            for force in &mut points.force {
                last = share * last + normal.next();
                *force += 5e-4 * last;
            }
            let fit = found(&points, &[E, W, OFFSET], "");
            refused += usize::from(fit.verdict != Verdict::Describes);
            assert!(
                off(&fit, &[1.0, 0.02, 0.0]).iter().all(|z| z.abs() < 4.0),
                "{seed}: {:?}",
                fit.parameters
            );
        }
        assert!(refused <= most, "{share}: {refused}");
    }
}

#[test]
fn outliers_side_by_side_are_missed_and_single_ones_are_not() {
    let body = Body { state: &sphere(1.0, 0.02, 1.0), compliance: 0.0, most: 1.1 };
    let with = |off: &dyn Fn(usize) -> bool| {
        let (mut points, mut normal) = (body.samples(400), Normal::new(5));
        for (i, force) in points.force.iter_mut().enumerate() {
            *force += 5e-4 * normal.next() + if off(i) { 0.02 } else { 0.0 };
        }
        found(&points, &[E, W, OFFSET], "")
    };
    let single = with(&|i| i % 20 == 0);
    assert_eq!(single.verdict, Verdict::Describes, "{:?}", single.reasons);
    let without = single.chi_squared_without_outliers.unwrap();
    assert!(single.chi_squared > 10.0 && (0.7..1.3).contains(&without), "{} {without}", single.chi_squared);
    let together = with(&|i| (230..242).contains(&i));
    assert_eq!(together.verdict, Verdict::DoesNotDescribe);
    assert!(together.reasons.iter().any(|reason| reason.kind == "missed"), "{:?}", together.reasons);
}

#[test]
fn the_last_row_of_a_retraction_may_be_apart() {
    let body = Body { state: &sphere(1.0, 0.02, 1.0), compliance: 0.0, most: 1.1 };
    let (mut points, mut normal) = (body.samples(400), Normal::new(8));
    points.force.iter_mut().for_each(|force| *force += 5e-4 * normal.next());
    // Up to the first row behind the jump of the retraction.
    let jump = (201..400).find(|i| points.force[*i] - points.force[i - 1] > 0.01).unwrap();
    let cut = Points {
        x: points.x[..=jump].to_vec(),
        force: points.force[..=jump].to_vec(),
        segments: points.segments.as_ref().map(|of| of[..=jump].to_vec()),
        ..points.clone()
    };
    let fit = found(&cut, &[E, W, OFFSET], "");
    assert_eq!((fit.verdict, fit.outliers), (Verdict::Describes, 0), "{:?}", fit.reasons);
    assert_eq!(fit.residuals.last().map(|row| row.datum.free), Some(true));
}

#[test]
fn one_or_two_rows_behind_the_jump_of_a_retraction_alone_are_left_out() {
    let body = Body { state: &sphere(1.0, 0.02, 1.0), compliance: 0.0, most: 1.1 };
    let points = body.samples(400);
    // The rows before it rise by up to 0.01.
    let jump = (201..400).find(|i| points.force[*i] - points.force[i - 1] > 0.03).unwrap();
    for seed in 0..6 {
        for behind in 0..3 {
            let mut normal = Normal::new(seed);
            let rows = 200..jump + behind;
            let retraction = Points {
                x: points.x[rows.clone()].to_vec(),
                force: points.force[rows.clone()].iter().map(|force| force + 5e-4 * normal.next()).collect(),
                segments: points.segments.as_ref().map(|of| of[rows].to_vec()),
                ..points.clone()
            };
            let fit = found(&retraction, &[E, W, OFFSET], "");
            let what = format!("{seed}, {behind}: {:?} {:?}", fit.reasons, fit.parameters);
            assert_eq!(fit.verdict, Verdict::Describes, "{what}");
            assert_eq!((fit.rows.retraction.free, fit.rows.retraction.jump), (0, behind), "{what}");
            assert!(off(&fit, &[1.0, 0.02, 0.0]).iter().all(|z| z.abs() < 4.0), "{what}");
        }
    }
}

#[test]
fn a_curve_that_bends_within_the_noise_of_the_radius_has_no_bias() {
    const SEEDS: u64 = 8;
    let state = sphere(1.0, 0.02, 1.0);
    let (mut squares, mut described) = ([0.0; 2], 0);
    for seed in 0..SEEDS {
        let mut normal = Normal::new(seed);
        let mut points = no_points(Abscissa::Radius);
        for i in 0..3000 {
            let s = 0.74 - 0.53 * f64::from(i) / 3000.0;
            points.x.push(s + 0.01 * normal.next());
            points.force.push(state(s).1 + 4e-4 * normal.next());
            points.segments.as_mut().unwrap().push(Segment::Retraction);
        }
        let fit = found(&points, &[E, W], "");
        assert!(fit.notes.iter().any(|note| note.contains("bends within the noise")), "{:?}", fit.notes);
        described += usize::from(fit.verdict == Verdict::Describes);
        for (square, z) in squares.iter_mut().zip(off(&fit, &[1.0, 0.02])) {
            *square += z * z / SEEDS as f64;
        }
    }
    // Without it 5 are described, and the mean squares are above 3.
    assert!(described >= 7 && squares.iter().all(|square| *square < 2.8), "{described} {squares:?}");
}

#[test]
fn what_another_spring_would_give_is_known_whatever_the_noise() {
    let body = Body { state: &sphere(1.0, 0.02, 1.0), compliance: 1.0 / 0.6, most: 1.1 };
    for seed in 0..12 {
        let mut normal = Normal::new(seed);
        let mut points = body.samples(400);
        points.force.iter_mut().for_each(|p| *p += 5e-4 * normal.next());
        let fit = found(&points, &[E, W, OFFSET], "control={stiffness=0.6}");
        let told = fit.notes.iter().find(|note| note.starts_with("with k 10 % larger: E* ")).unwrap();
        assert!(told.contains("; with k 10 % smaller: E* "), "{seed}: {told}");
    }
}

/// A drift of the force that one branch hides moves its values as the note of a fit without it says.
#[test]
fn what_a_drift_of_the_force_would_do_to_one_branch_is_told() {
    let body = Body { state: &sphere(1.0, 0.02, 1.0), compliance: 0.0, most: 1.1 };
    let mut normal = Normal::new(3);
    let mut both = body.samples(400);
    both.force.iter_mut().for_each(|p| *p += 1e-3 * normal.next());
    let starts = "a force that drifts by 1 % of its range over the rows would change the values by E* ±";
    let told = |points: &Points| {
        let fit = found(points, &[E, W, OFFSET], "");
        let note = fit.notes.iter().find_map(|note| note.strip_prefix(starts)).map(str::to_owned);
        (fit.parameters[0].value, note)
    };
    assert_eq!(told(&both).1, None);
    let mut one = both.clone();
    for column in [&mut one.x, &mut one.force] {
        column.drain(..200);
    }
    one.segments.as_mut().unwrap().drain(..200);
    let (e, note) = told(&one);
    let note = note.unwrap();
    let per_cent: f64 = note.split(" %").next().unwrap().parse().unwrap();
    let range = |of: &[f64]| {
        of.iter().fold(f64::NEG_INFINITY, |a, b| a.max(*b)) - of.iter().fold(f64::INFINITY, |a, b| a.min(*b))
    };
    assert!(note.contains(" %, γ ∓"), "{note}");
    let drift = 0.01 * range(&one.force) / 200.0;
    one.force.iter_mut().enumerate().for_each(|(i, p)| *p += drift * i as f64);
    let drifted = told(&one).0;
    assert!((100.0 * (drifted / e - 1.0).abs() - per_cent).abs() < 0.15, "{e} {drifted} {note}");
}

/// The force of a Hertzian contact grows from nothing: rows that touch already do not count as apart.
#[test]
fn the_first_rows_of_a_hertzian_contact_are_not_the_free_part() {
    const SEEDS: u64 = 12;
    let (mut described, mut square) = (0, 0.0);
    for seed in 0..SEEDS {
        let mut normal = Normal::new(seed);
        let mut points = no_points(Abscissa::Approach);
        for segment in [Segment::Approach, Segment::Retraction] {
            for i in 0..200 {
                let row = if segment == Segment::Approach { i } else { 199 - i };
                let delta = -0.01 + 0.03 * f64::from(row) / 199.0;
                let force = 4.0 / 3.0 * delta.max(0.0).powf(1.5);
                points.x.push(delta + 2.4e-5 * normal.next());
                points.force.push(force + 7.5e-6 * normal.next());
                points.segments.as_mut().unwrap().push(segment);
            }
        }
        let start = preset(SPHERE, 3.0, 0.0, "");
        let free = [E, OFFSET].map(str::to_owned).to_vec();
        let fit = fit(&start, &points, &Options { free, ..Options::default() }, &Unwatched).unwrap();
        described += u64::from(fit.verdict == Verdict::Describes);
        square += off(&fit, &[1.0, 0.0]).iter().map(|z| z * z).sum::<f64>() / (2 * SEEDS) as f64;
    }
    assert!(described + 1 >= SEEDS && square < 2.0, "{described} {square}");
}

/// The last row in contact lies beside the fold. As if that were known to σ of x, the mean square would be 1.5, and two
/// of these records off by more than three errors.
#[test]
fn a_fold_is_known_no_better_than_to_the_next_row() {
    const SEEDS: u64 = 40;
    let (w, k) = (0.002, 2.0);
    let body = Body { state: &sphere(1.0, w, 1.0), compliance: 1.0 / k, most: 1.1 };
    let rows = body.samples(402);
    let pull_off = rows.force.iter().copied().fold(0.0, f64::min);
    let (mut described, mut square) = (0, 0.0);
    for seed in 0..SEEDS {
        let mut normal = Normal::new(seed);
        let mut points = rows.clone();
        points.force.iter_mut().for_each(|p| *p += 0.15 * pull_off * normal.next());
        let start = preset(SPHERE, 1.5, 0.7 * w, &format!("control={{stiffness={k}}}"));
        let free = [E, W, OFFSET].map(str::to_owned).to_vec();
        let fit = fit(&start, &points, &Options { free, ..Options::default() }, &Unwatched).unwrap();
        if fit.verdict == Verdict::Describes {
            let z = off(&fit, &[1.0, w, 0.0]);
            assert!(z.iter().all(|z| z.abs() < 3.0), "{seed}: {z:?}");
            (described, square) = (described + 1, square + z[1] * z[1]);
        }
    }
    assert!(described > 35 && square < 0.8 * f64::from(described), "{described}: {square}");
}

/// Neither the noise of so few rows nor their sizes tell a slope from a constant: their order does.
#[test]
fn few_rows_apart_with_a_slope_speak_against_the_fit() {
    let whole = Body { state: &sphere(1.3, 0.02, 1.0), compliance: 0.0, most: 1.2 }.samples(200);
    let is_constant = |slope: f64| {
        let (mut points, mut normal, mut apart) = (no_points(Abscissa::Approach), Normal::new(5), 0);
        for (x, force) in whole.x.iter().zip(&whole.force).skip(100) {
            let is_apart = force.abs() < 1e-300;
            apart += usize::from(is_apart);
            if apart <= 12 {
                let drift = if is_apart { slope * apart as f64 } else { 0.0 };
                points.x.push(*x);
                points.force.push(force + drift + 1e-4 * normal.next());
                points.segments.as_mut().unwrap().push(Segment::Retraction);
            }
        }
        let fit = found(&points, &[E, W, OFFSET], "");
        assert!((8..20).contains(&fit.rows.retraction.free), "{:?}", fit.rows);
        fit.reasons.iter().all(|reason| reason.kind != "drift")
    };
    assert!(is_constant(0.0));
    assert!(!is_constant(1e-3));
}

/// A robust fit goes through the other rows, and their noise alone speaks for it.
#[test]
fn outliers_in_more_than_one_row_of_five_speak_against_the_fit() {
    let whole = Body { state: &sphere(1.3, 0.02, 1.0), compliance: 0.0, most: 1.2 }.samples(200);
    let kinds = |one_in: usize| -> Vec<&str> {
        let (mut points, mut normal) = (whole.clone(), Normal::new(6));
        for (i, force) in points.force.iter_mut().enumerate() {
            let side = if (i / one_in).is_multiple_of(2) { 1.0 } else { -1.0 };
            let is_off = i % one_in == 0 && *force != 0.0;
            *force += if is_off { 0.03 * side } else { 0.0 } + 1e-4 * normal.next();
        }
        found(&points, &[E, W, OFFSET], "").reasons.iter().map(|reason| reason.kind).collect()
    };
    assert_eq!(kinds(10), Vec::<&str>::new());
    assert_eq!(kinds(4), ["outliers"]);
}

#[test]
fn of_several_ends_the_nearest_to_all_rows_counts() {
    let points = Body { state: &sphere(1.3, 0.02, 1.0), compliance: 0.0, most: 1.2 }.samples(300);
    let preset = preset(SPHERE, 1.3, 0.02, "");
    let options = Options { free: [E, W].map(str::to_owned).to_vec(), ..Options::default() };
    let branches = points.branches(&options.asked).unwrap();
    let problem = pose::posed(&preset, &branches, &options, &mut Vec::new()).unwrap();
    let truth: Vec<f64> = problem.parameters.iter().map(|of| of.inner(of.start)).collect();
    let beside: Vec<f64> = truth.iter().map(|u| u + 0.05).collect();
    let end = |u: &[f64]| solve::solve(&problem, u, false, 0, &Unwatched).unwrap();
    let from = |u: &[f64], others: &[Vec<f64>]| {
        let found = settled::nearest(&problem, end(u), others, false, &Unwatched).0;
        found.minimum.parameters
    };
    let is_at_truth = |u: &[f64]| u.iter().zip(&truth).take(2).all(|(a, b)| (a - b).abs() < 1e-3);
    assert!(!is_at_truth(&from(&beside, &[])), "no round is made");
    assert!(is_at_truth(&from(&beside, std::slice::from_ref(&truth))));
    assert!(is_at_truth(&from(&truth, &[])));
}

/// P over s of an edge that moves as √t with this law of G over γ, by its speed over the slowest; rows in the order of time.
fn moving_edge(seed: u64, times: bool, law: &dyn Fn(f64) -> f64) -> Points {
    let mut normal = Normal::new(seed);
    let mut points = Points { segments: None, ..no_points(Abscissa::Radius) };
    let mut clock = Vec::new();
    for i in 1..=120 {
        let t = f64::from(i) / 120.0;
        let s = 0.8 * t.sqrt();
        let adhesion = 0.02 * law(1.0 / t.sqrt());
        points.x.push(s + 3e-4 * normal.next());
        points.force.push(sphere(1.0, adhesion, 1.0)(s).1 + 3e-4 * normal.next());
        clock.push(t);
    }
    points.time = times.then_some(clock);
    points
}

#[test]
fn an_approach_over_the_radius_shows_that_its_edge_is_fast() {
    let kinds = |points: &Points| -> Vec<&str> {
        found(points, &[E, W], "").reasons.iter().map(|reason| reason.kind).collect()
    };
    for seed in 0..6 {
        // A closing edge gains less the faster it is; without times, an opening one may be listed from its end.
        let closing = |v: f64| 1.0 / (1.0 + 0.4 * v.sqrt());
        let opening = |v: f64| 1.0 + 0.4 * v.sqrt();
        assert!(kinds(&moving_edge(seed, true, &closing)).contains(&"rate"), "{seed}");
        assert!(kinds(&moving_edge(seed, false, &opening)).contains(&"rate"), "{seed}");
        // An edge at rest is nothing else; at most the points do not tell it from a fast one.
        let at_rest = found(&moving_edge(seed, true, &|_| 1.0), &[E, W], "");
        assert!(at_rest.reasons.iter().all(|reason| reason.kind == "speed"), "{seed}: {:?}", at_rest.reasons);
        let said = at_rest.verdict.sentence_for(&at_rest.reasons);
        assert_eq!(said.contains("do NOT show whether"), !at_rest.reasons.is_empty(), "{said}");
    }
}

#[test]
fn a_small_disc_may_pull_more_as_it_grows() {
    // All radii are near that of the pull-off under a dead load, and P falls over most of them.
    let state = sphere(1.0, 0.02, 1.0);
    let largest = (9.0 * std::f64::consts::PI * 0.02 / 8.0_f64).cbrt();
    for seed in 0..6 {
        let mut normal = Normal::new(seed);
        let mut points = Points { segments: None, ..no_points(Abscissa::Radius) };
        for i in 0..60 {
            let s = largest * (1.0 - 0.014 * f64::from(i));
            points.x.push(s + 2e-4 * normal.next());
            points.force.push(state(s).1 + 2e-4 * normal.next());
        }
        let fit = found(&points, &[E, W], "");
        assert_eq!(fit.turned, [false; 2], "{seed}");
        assert!(off(&fit, &[1.0, 0.02]).iter().all(|z| z.abs() < 4.0), "{seed}: {:?}", fit.parameters);
    }
}
