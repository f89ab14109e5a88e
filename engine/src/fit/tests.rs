//! Known values from made curves: closed forms of JKR's sphere and of the cone, and our own unloading of a wavy sphere.

use super::least_squares::Ending;
use super::mover::Mover;
use super::path::FitPath;
use super::reach::Reach;
use super::way::Way;
use super::*;
use crate::gap::shapes::split_mix::SplitMix64;
use crate::measured::Asked;
use crate::measured::{Abscissa, Instrument, Origin, Points, Segment};
use crate::preset::data::{BASELINE, DataSpec, OFFSET};
use crate::preset::{Preset, read};
use crate::progress::{Unwatched, until};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

pub(super) const E: &str = "material.effective_modulus";
pub(super) const W: &str = "material.work_of_adhesion";

/// Normal numbers of one seed.
pub(super) struct Normal(SplitMix64);

impl Normal {
    pub(super) fn new(seed: u64) -> Self {
        Self(SplitMix64::row(77, seed))
    }

    pub(super) fn next(&mut self) -> f64 {
        let (u, v) = (1.0 - self.0.unit(), self.0.unit());
        (-2.0 * u.ln()).sqrt() * (TAU * v).cos()
    }
}

/// No points yet, each of which will be of a branch.
pub(super) fn no_points(abscissa: Abscissa) -> Points {
    let (x, force, segments) = (Vec::new(), Vec::new(), Some(Vec::new()));
    Points {
        abscissa,
        x,
        force,
        radius: None,
        steps: [1e-30; 3],
        segments,
        time: None,
        is_said: false,
        skipped: 0,
    }
}

/// A loading device with a body: δ and P as functions of s.
pub(super) struct Body<'a> {
    pub(super) state: &'a dyn Fn(f64) -> (f64, f64),
    pub(super) compliance: f64,
    pub(super) most: f64,
}

impl Body<'_> {
    pub(super) fn way(&self, s: f64) -> f64 {
        let (delta, force) = (self.state)(s);
        delta + self.compliance * force
    }

    /// The radius at which the way is smallest: the pull-off.
    pub(super) fn fold(&self) -> f64 {
        let (mut lo, mut hi) = (1e-4 * self.most, self.most);
        for _ in 0..200 {
            let [a, b] = [lo + (hi - lo) / 3.0, hi - (hi - lo) / 3.0];
            if self.way(a) < self.way(b) { hi = b } else { lo = a }
        }
        lo
    }

    /// The stable radius of a way.
    pub(super) fn radius(&self, way: f64) -> Option<f64> {
        let fold = self.fold();
        if way < self.way(fold) {
            return None;
        }
        let (mut lo, mut hi) = (fold, self.most);
        for _ in 0..100 {
            let middle = 0.5 * (lo + hi);
            if self.way(middle) > way { hi = middle } else { lo = middle }
        }
        Some(0.5 * (lo + hi))
    }

    /// `n` samples of an approach to the radius `most` and of the retraction, evenly spaced in the way, both from
    /// equally far apart.
    pub(super) fn samples(&self, n: usize) -> Points {
        let (top, fold) = (self.way(self.most), self.way(self.fold()));
        let bottom = fold - 0.4 * (top - fold);
        let abscissa = if self.compliance > 0.0 { Abscissa::Position } else { Abscissa::Approach };
        let mut points = no_points(abscissa);
        for segment in [Segment::Approach, Segment::Retraction] {
            for i in 0..n / 2 {
                let share = (i as f64 + 0.5) / (n / 2) as f64;
                let share = if segment == Segment::Approach { share } else { 1.0 - share };
                let way = bottom + share * (top - bottom);
                let touches = segment == Segment::Retraction || way > 0.0;
                let force = self.radius(way).filter(|_| touches).map_or(0.0, |s| (self.state)(s).1);
                points.x.push(way);
                points.force.push(force);
                points.segments.as_mut().unwrap().push(segment);
            }
        }
        points
    }
}

pub(super) fn sphere(e: f64, w: f64, r: f64) -> impl Fn(f64) -> (f64, f64) {
    move |s| {
        let delta = s * s / r - (TAU * w * s / e).sqrt();
        (delta, 4.0 * e * s.powi(3) / (3.0 * r) - (8.0 * PI * w * e * s.powi(3)).sqrt())
    }
}

pub(super) fn preset(gap: &str, e: f64, w: f64, more: &str) -> Preset {
    let radius = if gap.contains("e-3") { 3e-4 } else { 0.3 };
    let text = format!(
        "[material]\neffective_modulus={e}\nwork_of_adhesion={w}\n[gap]\n{gap}\n[path]\nstart_contact_radius={radius}\n{more}"
    );
    read("test", &text).unwrap()
}

pub(super) const SPHERE: &str = "shape='sphere'\nradius_of_curvature=2.0";

pub(super) fn run(preset: &Preset, points: &Points, free: &[&str]) -> Fit {
    let free = free.iter().map(|key| (*key).to_owned()).collect();
    fit(preset, points, &Options { free, ..Options::default() }, &Unwatched).unwrap()
}

pub(super) fn close(fit: &Fit, truth: &[f64], within: f64) {
    for (fitted, truth) in fit.parameters.iter().zip(truth) {
        let off = (fitted.value - truth).abs() / truth.abs();
        assert!(off < within, "{} {} for {truth}: {off:e}", fitted.key, fitted.value);
    }
}

#[test]
fn a_sphere_is_found_from_values_three_times_off() {
    let body = Body { state: &sphere(1.3, 0.02, 2.0), compliance: 0.0, most: 1.6 };
    let points = body.samples(600);
    for (e, w) in [(3.9, 0.0066), (0.43, 0.06), (3.9, 0.06)] {
        let fit = run(&preset(SPHERE, e, w, ""), &points, &[E, W]);
        assert_eq!(fit.ending, Ending::Converged);
        close(&fit, &[1.3, 0.02], 1e-8);
        assert!(fit.direction.is_none() && fit.condition < 50.0, "{}", fit.condition);
        assert_eq!(fit.rows.all(), 600);
    }
    // With an offset, a baseline and a tilt of the instrument.
    let mut shifted = points.clone();
    for (x, p) in shifted.x.iter_mut().zip(&mut shifted.force) {
        *x += 0.7;
        *p += 0.01 + 0.002 * *x;
    }
    let fit =
        run(&preset(SPHERE, 3.9, 0.06, ""), &shifted, &[E, W, "data.offset", "data.baseline", "data.tilt"]);
    close(&fit, &[1.3, 0.02, 0.7, 0.01, 0.002], 1e-8);
}

#[test]
fn offset_and_baseline_are_numbers_of_the_file_whatever_its_signs() {
    let body = Body { state: &sphere(1.3, 0.02, 2.0), compliance: 0.0, most: 1.6 };
    let free = [E, W, "data.offset", "data.baseline", "data.tilt"];
    for signs in [[1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]] {
        let mut points = body.samples(600);
        for (x, p) in points.x.iter_mut().zip(&mut points.force) {
            *x = signs[0] * *x + 0.7;
            *p = signs[1] * *p + 0.01 + 0.002 * *x;
        }
        let fit = run(&preset(SPHERE, 3.9, 0.06, ""), &points, &free);
        assert_eq!(fit.turned, signs.map(|sign| sign < 0.0));
        close(&fit, &[1.3, 0.02, 0.7, 0.01, 0.002], 1e-7);
        let left = &fit.preset.data;
        let written = [left.offset, left.baseline, left.tilt].map(Option::unwrap);
        let Instrument { offset, baseline, tilt } = fit.instrument;
        assert!(
            written.iter().zip([offset, baseline, tilt]).all(|(a, b)| (a - b).abs() < 1e-15),
            "{written:?}"
        );
        // The same numbers, given, leave nothing to move.
        let again = run(&fit.preset, &points, &[E, W]);
        close(&again, &[1.3, 0.02], 1e-6);
    }
}

#[test]
fn a_cone_is_found() {
    let (e, w, c) = (1.3, 0.004, 0.3);
    let cone = move |s: f64| {
        let delta = FRAC_PI_2 * c * s - (TAU * w * s / e).sqrt();
        (delta, 2.0 * e * (delta * s - 0.5 * FRAC_PI_2 * c * s * s))
    };
    let points = Body { state: &cone, compliance: 0.0, most: 1.6 }.samples(400);
    let fit = run(&preset("shape='cone'\nslope=0.3", 3.9, 0.0013, ""), &points, &[E, W]);
    close(&fit, &[e, w], 1e-8);
}

/// One step outward may raise such a gap from that of the points to far beyond them.
#[test]
fn a_gap_as_steep_as_a_wall_is_found() {
    let (e, w, c, n) = (1.0, 0.001, 0.05, 80);
    // The integral of the sine to the power of n - 1, after Wallis.
    let wallis: f64 = (1..n / 2).map(|k| 2.0 * f64::from(k) / (2.0 * f64::from(k) + 1.0)).product();
    let g = f64::from(n) * c * wallis;
    let wall = move |s: f64| {
        let delta = g * s.powi(n) - (TAU * w * s / e).sqrt();
        (delta, 2.0 * e * (delta * s - g * s.powi(n + 1) / f64::from(n + 1)))
    };
    let points = Body { state: &wall, compliance: 0.0, most: 1.0 }.samples(200);
    let gap = "shape='power-law'\ncoefficient=0.05\nexponent=80.0";
    close(&run(&preset(gap, 1.4, 0.0006, ""), &points, &[E, W]), &[e, w], 1e-6);
}

#[test]
fn a_spring_is_part_of_the_way_and_can_be_fitted() {
    let body = Body { state: &sphere(1.3, 0.02, 2.0), compliance: 1.0 / 0.8, most: 1.6 };
    let points = body.samples(600);
    let fit = run(&preset(SPHERE, 3.9, 0.0066, "control={stiffness=0.8}"), &points, &[E, W]);
    close(&fit, &[1.3, 0.02], 1e-8);
    let told = fit.notes.iter().find(|note| note.starts_with("with k 10 % larger: E* −")).unwrap();
    assert!(told.contains("; with k 10 % smaller: E* +"), "{told}");
    // Beside an approach it plays no part.
    let rigid = Body { compliance: 0.0, ..body }.samples(600);
    let fit = run(&preset(SPHERE, 3.9, 0.0066, "control={stiffness=0.8}"), &rigid, &[E, W]);
    assert!(!fit.notes.iter().any(|note| note.contains("with k")), "{:?}", fit.notes);
    let fit = run(&preset(SPHERE, 1.5, 0.015, "control={stiffness=0.9}"), &points, &[E, W, "k"]);
    close(&fit, &[1.3, 0.02, 0.8], 1e-8);
    // A stiffness held at a wrong value shows in χ², where the noise is known.
    let mut noisy = points;
    let mut normal = Normal::new(1);
    noisy.force.iter_mut().for_each(|p| *p += 5e-4 * normal.next());
    let right = run(&preset(SPHERE, 3.9, 0.0066, "control={stiffness=0.8}"), &noisy, &[E, W]);
    let wrong = run(&preset(SPHERE, 3.9, 0.0066, "control={stiffness=0.88}"), &noisy, &[E, W]);
    assert!((0.7..1.2).contains(&right.chi_squared), "{}", right.chi_squared);
    assert!(wrong.chi_squared > 3.0, "{}", wrong.chi_squared);
    assert_eq!((right.verdict, &right.reasons[..]), (Verdict::Describes, &[][..]));
    assert_eq!(wrong.verdict, Verdict::DoesNotDescribe);
    let kinds: Vec<&str> = wrong.reasons.iter().map(|reason| reason.kind).collect();
    // Two works of adhesion are no remedy for a wrong spring.
    let apart = wrong.reasons.iter().find(|reason| reason.kind == "branches");
    assert!(kinds[0] != "branches" && apart.is_none_or(|apart| apart.sentence.contains("Even with that")));
    assert!(["bins", "scatter", "runs"].iter().all(|kind| kinds.contains(kind)), "{:?}", wrong.reasons);
}

#[test]
fn what_cannot_be_told_apart_is_refused_and_named() {
    let body = Body { state: &sphere(1.3, 0.02, 2.0), compliance: 0.0, most: 1.6 };
    let mut points = body.samples(600);
    let mut normal = Normal::new(1);
    points.force.iter_mut().for_each(|p| *p += 5e-4 * normal.next());
    let fit = run(&preset(SPHERE, 1.3, 0.02, ""), &points, &["R", E, W]);
    assert!(fit.condition > 1e3 && fit.parameters.iter().all(|fitted| fitted.standard_error.is_none()));
    assert_eq!(
        fit.direction.unwrap(),
        "R +10 %, E* −4.7 %, γ −9.1 % together move the curve by less than its noise: fix one of them (only γ·R and \
         E*·√R can be found)"
            .replace("w ", "γ ")
    );
    // With the radius measured, P, δ and s are all there together.
    let truth = sphere(1.3, 0.02, 2.0);
    let radii: Vec<f64> = (0..200).map(|i| 1.6 - 0.005 * f64::from(i)).collect();
    let (x, force): (Vec<f64>, Vec<f64>) = radii.iter().map(|s| truth(*s)).unzip();
    let segments = Some(vec![Segment::Retraction; 200]);
    let three = Points {
        abscissa: Abscissa::Approach,
        x,
        force,
        radius: Some(radii),
        steps: [1e-30; 3],
        segments,
        time: None,
        is_said: false,
        skipped: 0,
    };
    let fit = run(&preset(&SPHERE.replace("2.0", "1.5"), 3.9, 0.007, ""), &three, &["R", E, W]);
    close(&fit, &[2.0, 1.3, 0.02], 1e-7);
    assert!(fit.direction.is_none());
    // P over s alone gives E*/R and γ E*.
    let two = Points { abscissa: Abscissa::Radius, x: three.radius.clone().unwrap(), radius: None, ..three };
    close(&run(&preset(SPHERE, 3.9, 0.007, ""), &two, &[E, W]), &[1.3, 0.02], 1e-8);
    let fit = run(&preset(SPHERE, 1.3, 0.02, ""), &two, &["R", E, W]);
    assert!(fit.direction.unwrap().starts_with("R +10 %, E* +10 %, γ −9.1 % together"));
}

/// The sphere of the trials, with noise in P of 0.5 % of its range.
pub(super) fn noisy(seed: u64, outliers: bool) -> Points {
    let body = Body { state: &sphere(1.0, 0.02, 1.0), compliance: 0.0, most: 1.1 };
    let mut points = body.samples(600);
    let range = 1.05;
    let mut normal = Normal::new(seed);
    for p in &mut points.force {
        let kick = if outliers && normal.0.unit() < 0.01 { 20.0 * 0.005 * range } else { 0.0 };
        *p += 0.005 * range * normal.next() + kick * normal.next().signum();
    }
    points
}

#[test]
fn a_long_free_part_does_not_hide_which_way_the_columns_run() {
    const ROWS: u32 = 400;
    let state = sphere(1.0, 0.02, 1.0);
    let body = Body { state: &state, compliance: 0.0, most: 0.45 };
    let (top, last) = (state(body.most).0, body.way(body.fold()));
    for (k, share) in [(0, 0.5), (1, 0.15), (2, 0.1), (3, 0.08)] {
        let turned = [k & 1 == 1, k & 2 == 2];
        let signs = turned.map(|turned| if turned { -1.0 } else { 1.0 });
        let mut normal = Normal::new(k);
        let rows = (0..ROWS).map(|i| top + (f64::from(i) + 0.5) / f64::from(ROWS) * (last - top) / share);
        let (x, force): (Vec<f64>, Vec<f64>) = rows
            .map(|x| {
                let force = if x < last { 0.0 } else { body.radius(x).map_or(0.0, |s| state(s).1) };
                (signs[0] * x, signs[1] * (force + 3e-5 * normal.next()))
            })
            .unzip();
        let points = Points {
            abscissa: Abscissa::Approach,
            x,
            force,
            radius: None,
            steps: [1e-30; 3],
            segments: None,
            time: None,
            is_said: false,
            skipped: 0,
        };
        let found = points.branches(&Asked::default()).unwrap();
        let contact = found.list[0].attached.len() as f64;
        assert_eq!((found.turned, found.or), (turned, None), "{share}");
        assert!((contact - share * f64::from(ROWS)).abs() < 4.0, "{share}: {contact}");
    }
}

/// The shares of 95 % intervals that contain the truth, and the mean errors in σ.
fn coverage(seeds: std::ops::Range<u64>, outliers: bool) -> [[f64; 2]; 2] {
    let count = (seeds.end - seeds.start) as f64;
    // The starts are tested elsewhere; here one is near.
    let start = preset("shape='sphere'\nradius_of_curvature=1.0", 1.1, 0.018, "");
    let free = [E, W, "data.offset"].map(str::to_owned).to_vec();
    // A single row that is off can begin a fit at the wrong end.
    let options = Options { free, scan: outliers, ..Options::default() };
    let mut found = [[0.0; 2]; 2];
    let mut flagged = 0;
    for seed in seeds {
        let fit = fit(&start, &noisy(seed, outliers), &options, &Unwatched).unwrap();
        flagged += usize::from(fit.verdict != Verdict::Describes);
        for (j, truth) in [1.0, 0.02].into_iter().enumerate() {
            let off = (fit.parameters[j].value - truth) / fit.parameters[j].standard_error.unwrap();
            found[j][0] += f64::from(u8::from(off.abs() <= 1.96)) / count;
            found[j][1] += off / count;
            assert!(off.abs() < 6.0, "seed {seed}: {off} {:?} {:?}", fit.notes, fit.rows);
        }
    }
    println!("{flagged} of {count} right fits are flagged");
    assert!(flagged as f64 <= f64::max(2.0, 0.02 * count), "{flagged} of {count} right fits are flagged");
    found
}

#[test]
fn intervals_hold_the_truth_as_often_as_they_say() {
    for [share, bias] in coverage(0..60, false) {
        assert!(share >= 0.88 && bias.abs() < 0.45, "{share} {bias}");
    }
    for [share, bias] in coverage(0..20, true) {
        assert!(share >= 0.84 && bias.abs() < 0.65, "{share} {bias}");
    }
}

#[test]
#[ignore = "a thousand fits, some minutes without optimization"]
fn a_thousand_intervals_hold_the_truth_as_often_as_they_say() {
    for [share, bias] in coverage(0..1000, false) {
        println!("{share} of 1000 intervals hold the truth, mean error {bias} sigma");
        assert!((0.93..=0.97).contains(&share) && bias.abs() < 0.1, "{share} {bias}");
    }
    for [share, bias] in coverage(0..1000, true) {
        println!("with outliers {share}, mean error {bias} sigma");
        assert!(bias.abs() <= 0.2, "{share} {bias}");
    }
}

/// Fits of the sphere of the trials with noise of the force, 1e-3 and a share of it: how many are not described, how
/// many find that the noise grows, and the root mean square of what E* and γ are off, in errors.
fn of_growing_noise(seeds: u64, share: f64) -> [f64; 4] {
    let body = Body { state: &sphere(1.0, 0.02, 1.0), compliance: 0.0, most: 1.1 };
    let start = preset("shape='sphere'\nradius_of_curvature=1.0", 1.1, 0.018, "");
    let free = [E, W, "data.offset"].map(str::to_owned).to_vec();
    let options = Options { free, scan: false, ..Options::default() };
    let mut found = [0.0; 4];
    for seed in 0..seeds {
        let mut points = body.samples(600);
        let mut normal = Normal::new(seed);
        points.force.iter_mut().for_each(|p| *p += 1e-3_f64.hypot(share * *p) * normal.next());
        let fit = fit(&start, &points, &options, &Unwatched).unwrap();
        found[0] += f64::from(u8::from(fit.verdict != Verdict::Describes));
        found[1] += f64::from(u8::from(fit.noise.share > 0.0));
        for (j, truth) in [1.0, 0.02].into_iter().enumerate() {
            let off = (fit.parameters[j].value - truth) / fit.parameters[j].standard_error.unwrap();
            found[2 + j] += off * off / seeds as f64;
        }
    }
    [found[0], found[1], found[2].sqrt(), found[3].sqrt()]
}

#[test]
fn noise_that_grows_with_the_force_weighs_the_points() {
    let [refused, grows, e, w] = of_growing_noise(24, 0.03);
    assert!(refused <= 1.0 && grows >= 24.0, "{refused} {grows}");
    assert!((0.7..1.3).contains(&e) && (0.7..1.3).contains(&w), "{e} {w}");
    let [refused, grows, e, w] = of_growing_noise(24, 0.0);
    assert!(refused <= 1.0 && grows == 0.0, "{refused} {grows}");
    assert!((0.7..1.3).contains(&e) && (0.7..1.3).contains(&w), "{e} {w}");
}

#[test]
fn a_share_of_the_force_can_be_given() {
    let start = preset("shape='sphere'\nradius_of_curvature=1.0", 1.1, 0.018, "");
    let options = |share| Options {
        free: [E, W].map(str::to_owned).to_vec(),
        asked: Asked { share, ..Asked::default() },
        ..Options::default()
    };
    let [own, given] =
        [None, Some(0.05)].map(|share| fit(&start, &noisy(2, false), &options(share), &Unwatched).unwrap());
    assert!(own.noise.share <= 0.0 && (given.noise.share - 0.05).abs() < 1e-15);
    let chi = [&own, &given].map(|fit| fit.chi_squared_of[0].unwrap());
    assert!(chi[1] < 0.5 * chi[0], "{chi:?}");
}

/// A retraction of the sphere E = 1, W = 0.02, R = 1 that ends in contact, with radii `step` apart and normal noise of x, P and s.
fn in_contact(seed: u64, step: f64, noise: [f64; 3]) -> Points {
    let state = sphere(1.0, 0.02, 1.0);
    let mut points = no_points(Abscissa::Approach);
    let (mut normal, mut radii) = (Normal::new(seed), Vec::new());
    for i in 0..200 {
        let s = 1.1 - step * f64::from(i);
        let (x, force) = state(s);
        points.x.push(x + noise[0] * normal.next());
        points.force.push(force + noise[1] * normal.next());
        radii.push(s + noise[2] * normal.next());
        points.segments.as_mut().unwrap().push(Segment::Retraction);
    }
    points.radius = Some(radii);
    points
}

#[test]
fn a_tare_that_no_rows_show_is_found_or_in_the_errors() {
    const SEEDS: u64 = 12;
    const TARE: f64 = 6e-3;
    let start = preset("shape='sphere'\nradius_of_curvature=1.0", 1.1, 0.018, "");
    for (has_radii, free) in [(true, &[E, W, OFFSET][..]), (false, &[E, W, OFFSET]), (false, &[E, W])] {
        let (mut squares, mut refused) = (0.0, 0);
        for seed in 0..SEEDS {
            let mut points = in_contact(seed, 0.003, [3e-4, 1e-3, 2e-3]);
            points.force.iter_mut().for_each(|force| *force += TARE);
            points.radius = points.radius.filter(|_| has_radii);
            let fit = run(&start, &points, free);
            refused += usize::from(fit.verdict != Verdict::Describes);
            let of = |key: &str| fit.parameters.iter().find(|fitted| fitted.key == key).unwrap();
            let off = |key: &str, truth| (of(key).value - truth) / of(key).standard_error.unwrap();
            assert!(off(BASELINE, TARE).abs() < 4.0 && off(E, 1.0).abs() < 4.0);
            squares += off(W, 0.02).powi(2) / SEEDS as f64;
            if seed == 0 {
                // Its preset lies on the points, and a second fit counts what was known of the tare once.
                let found = of(BASELINE);
                let DataSpec { baseline, tare, .. } = fit.preset.data;
                assert_eq!((baseline, tare), (None, Some(found.value)));
                let again = run(&fit.preset, &points, free);
                let same = again.parameters.iter().find(|fitted| fitted.key == BASELINE).unwrap();
                let by = (same.value - found.value).abs() / found.standard_error.unwrap();
                assert!(by < 0.01, "{by}: {found:?} {same:?}");
                // One that is given comes before it, and is held.
                let mut given = fit.preset.clone();
                given.data.baseline = Some(TARE);
                let held = run(&given, &points, free);
                assert!(held.parameters.iter().all(|fitted| fitted.key != BASELINE));
                assert_eq!(held.preset.data.baseline, Some(TARE));
            }
        }
        assert!((0.3..2.0).contains(&squares) && refused <= 1, "{has_radii} {free:?}: {squares} {refused}");
    }
}

/// Without rows apart nothing tells the noise of x beforehand: the slope of the curve does.
#[test]
fn noise_of_an_approach_is_seen_where_the_curve_is_steep() {
    const SEEDS: u64 = 12;
    const NOISE: f64 = 4e-3;
    let start = preset("shape='sphere'\nradius_of_curvature=1.0", 1.1, 0.018, "");
    let mut squares = 0.0;
    for seed in 0..SEEDS {
        let mut points = in_contact(seed, 0.0043, [NOISE, 1e-3, 2e-3]);
        points.radius = None;
        let fit = run(&start, &points, &[E, W, OFFSET]);
        let ratio = fit.noise.sigma[0] / NOISE;
        assert!(fit.noise.from[0] == Origin::Neighbours && (0.7..1.4).contains(&ratio), "{ratio}");
        squares += ((fit.parameters[0].value - 1.0) / fit.parameters[0].standard_error.unwrap()).powi(2);
    }
    assert!((0.3..2.0).contains(&(squares / SEEDS as f64)), "{squares}");
    let mut points = in_contact(1, 0.0043, [0.0, 1e-3, 0.0]);
    points.radius = None;
    assert_eq!(run(&start, &points, &[E, W, OFFSET]).noise.from[0], Origin::Assumed);
}

#[test]
fn noise_of_an_approach_beside_radii_is_that_of_its_rows() {
    const SEEDS: u64 = 24;
    let start = preset("shape='sphere'\nradius_of_curvature=1.0", 1.1, 0.018, "");
    let noise = [3e-3, 1e-2, 2e-3];
    let mut squares = [0.0; 2];
    let mut refused = 0;
    for seed in 0..SEEDS {
        let points = in_contact(seed, 0.003, noise);
        let asked = Asked { turned: Some([false; 2]), ..Asked::default() };
        let options = Options { free: [E, W].map(str::to_owned).to_vec(), asked, ..Options::default() };
        let fit = fit(&start, &points, &options, &Unwatched).unwrap();
        assert_eq!(fit.noise.from[0], Origin::Neighbours);
        for (axis, truth) in noise.into_iter().enumerate() {
            let ratio = fit.noise.sigma[axis] / truth;
            assert!((0.6..1.5).contains(&ratio), "{axis}: {ratio}");
        }
        refused += usize::from(fit.verdict != Verdict::Describes);
        for (j, truth) in [1.0, 0.02].into_iter().enumerate() {
            let off = (fit.parameters[j].value - truth) / fit.parameters[j].standard_error.unwrap();
            squares[j] += off * off / SEEDS as f64;
        }
    }
    assert!(refused <= 1 && squares.iter().all(|z| (0.5..1.7).contains(z)), "{refused} {squares:?}");
}

#[test]
fn what_a_radius_without_an_approach_leaves_open_is_said() {
    let state = sphere(1.0, 0.02, 1.0);
    let mut points = no_points(Abscissa::Radius);
    let mut normal = Normal::new(5);
    for i in 0..200 {
        let s = 1.1 - 0.003 * f64::from(i);
        points.x.push(s + 1e-3 * normal.next());
        points.force.push(state(s).1 + 0.03 + 1e-3 * normal.next());
        points.segments.as_mut().unwrap().push(Segment::Retraction);
    }
    let mut start = preset("shape='sphere'\nradius_of_curvature=1.0", 1.1, 0.018, "");
    let fit_of = |start: &Preset| run(start, &points, &[E, W]);
    let found = fit_of(&start);
    assert!(found.known_together().iter().any(|said| said.contains("the points show E*/R and γE*")));
    let said = |fit: &Fit, what: &str| fit.notes.iter().any(|note| note.contains(what));
    assert!(said(&found, "data.baseline is fitted too") && !said(&found, "the baseline is held"));
    // A baseline that is given is held.
    start.set("data.baseline", crate::preset::Value::Number(0.03)).unwrap();
    let held = fit_of(&start);
    assert!(said(&held, "the baseline is held as given") && (held.instrument.baseline - 0.03).abs() < 1e-15);
    assert!(held.parameters.len() == 2 && held.verdict == Verdict::Describes, "{:?}", held.reasons);
}

#[test]
fn a_parameter_of_a_formula_can_be_fitted() {
    let body = Body { state: &sphere(1.3, 0.02, 2.0), compliance: 0.0, most: 1.6 };
    let of = |radius: f64, more: f64| {
        let gap = "shape='formula'\nformula='r^2/(2*R) + a*r^4'\n[gap.parameters]";
        preset(&format!("{gap}\nR={radius}\na={more}"), 1.4, 0.02, "")
    };
    let found = run(&of(2.5, 0.0), &body.samples(600), &[E, "gap.parameters.R"]);
    close(&found, &[1.3, 2.0], 1e-5);
    assert!(!found.known_together().iter().any(|said| said.contains("not fitted")));
    let free = vec!["gap.parameters.a".to_owned()];
    let options = Options { free, ..Options::default() };
    let refused = fit(&of(2.0, -1e-4), &body.samples(60), &options, &Unwatched);
    assert!(matches!(refused, Err(FitError::Key { why, .. }) if why.contains("starts below 0")));
}

#[test]
fn order_and_units_change_nothing() {
    let points = noisy(5, true);
    let start = preset("shape='sphere'\nradius_of_curvature=1.0", 1.4, 0.015, "");
    let free = [E, W, "data.offset"];
    let right = run(&start, &points, &free);
    let order = |order: &[usize]| Points {
        x: order.iter().map(|i| points.x[*i]).collect(),
        force: order.iter().map(|i| points.force[*i]).collect(),
        segments: points.segments.as_ref().map(|of| order.iter().map(|i| of[*i]).collect()),
        ..points.clone()
    };
    let back: Vec<usize> = (0..600).rev().collect();
    let mut mixed = back.clone();
    let mut random = SplitMix64::new(2);
    for i in (1..600).rev() {
        mixed.swap(i, usize::try_from(random.bits() % (i as u64 + 1)).unwrap());
    }
    let same = |fit: &Fit| {
        for (a, b) in fit.parameters.iter().zip(&right.parameters) {
            let [error, other] = [a, b].map(|of| of.standard_error.unwrap());
            assert!((a.value - b.value).abs() < 1e-8 * other, "{} {} {}", a.key, a.value, b.value);
            assert!((error / other - 1.0).abs() < 1e-6);
        }
    };
    same(&run(&start, &order(&back), &free));
    let sigma = right.noise.sigma;
    let asked = Asked { sigma: [Some(sigma[0]), Some(sigma[1]), None], ..Asked::default() };
    let free = free.map(str::to_owned).to_vec();
    let options = Options { free, asked, ..Options::default() };
    same(&fit(&start, &order(&mixed), &options, &Unwatched).unwrap());
    // Lengths scaled by 1e-3 and forces by 1e-6: E* stays, γ becomes a thousandth.
    let scaled = Points {
        x: points.x.iter().map(|x| 1e-3 * x).collect(),
        force: points.force.iter().map(|p| 1e-6 * p).collect(),
        ..points.clone()
    };
    let small = preset("shape='sphere'\nradius_of_curvature=1.0e-3", 1.4, 1.5e-5, "");
    let fit = run(&small, &scaled, &[E, W]);
    let plain = run(&start, &points, &[E, W]);
    for (j, factor) in [(0, 1.0), (1, 1e-3)] {
        assert!((fit.parameters[j].value / plain.parameters[j].value / factor - 1.0).abs() < 1e-9);
    }
}

#[test]
fn profile_and_bootstrap_agree_with_the_errors_and_the_best_so_far_is_kept() {
    let start = preset("shape='sphere'\nradius_of_curvature=1.0", 1.4, 0.015, "");
    let free = vec![E.to_owned(), W.to_owned()];
    let options = Options { free, profile: true, bootstrap: Some((60, 1)), ..Options::default() };
    let points = noisy(3, false);
    let found = fit(&start, &points, &options, &Unwatched).unwrap();
    for fitted in &found.parameters[..2] {
        let error = fitted.standard_error.unwrap();
        let [lo, hi] = fitted.profile.unwrap();
        assert!(
            ((fitted.value - lo) / error / 1.96 - 1.0).abs() < 0.35,
            "{lo} {} {hi} {error}",
            fitted.value
        );
        assert!(((hi - fitted.value) / error / 1.96 - 1.0).abs() < 0.35);
        let bootstrap = fitted.bootstrap.unwrap();
        assert!((0.6..1.6).contains(&(bootstrap.error / error)), "{} {error}", bootstrap.error);
    }
    let again = fit(&start, &points, &options, &Unwatched).unwrap();
    assert_eq!(found.parameters, again.parameters);
    let stopped = fit(&start, &points, &options, &until(39));
    assert_eq!(stopped.unwrap().ending, Ending::Cancelled);
}

#[test]
fn a_range_of_the_adhesion_moves_the_curve_as_maugis_says() {
    // With E* = 9π/8, γ = R = 1 the pull-off force of JKR is at s = 1, and λ³ = 9 σ₀³/(2π E*²).
    let e = 9.0 * PI / 8.0;
    let preset = read(
        "sphere",
        &format!(
            "format = 1\nunits = \"reduced\"\n[material]\neffective_modulus = {e:e}\nwork_of_adhesion = 1\n[gap]\nshape = \"sphere\"\n\
             radius_of_curvature = 1\n[path]\ncontrol = \"displacement\"\nstart_contact_radius = 2\n"
        ),
    )
    .unwrap();
    let reach = Reach { most: [1.0, 1.0, 2.0], turn: [1.0, 1.0], radius: Some(2.0), length: 1.0, noise: 0.0 };
    let path = FitPath::new(&preset, Abscissa::Approach, &reach, Way::Down).unwrap();
    let (at, _) = path.at(1.0).unwrap();
    assert!((at[1] / (-1.5 * PI) - 1.0).abs() < 1e-12, "{at:?}");
    let [delta, force, _] = path.moves(Mover::Range, 1.0, at).unwrap();
    // P/(πγR) = −1.5 − 0.1638/λ² + …, by the equations of Maugis (1992) at λ = 20 to 100.
    let lambda = (9.0 / (TAU * e * e)).cbrt();
    assert!((force * lambda * lambda / PI + 0.1638).abs() < 5e-5, "{force}");
    // The whole equations at a small range, with the same contact radius.
    let tension = 1e4;
    let edge = |psi: f64| {
        let (sin, cos) = psi.sin_cos();
        let c = 1.0 / cos;
        let far = c * c / PI * (psi + sin * cos - 2.0 * psi * cos * cos);
        far + 4.0 * tension * c / (PI * e) * (psi * sin - 2.0 * (0.5 * psi).sin().powi(2)) - 1.0 / tension
    };
    let (mut lo, mut hi) = (1e-6, 1e-2);
    for _ in 0..100 {
        let middle = 0.5 * (lo + hi);
        if edge(middle) > 0.0 { hi = middle } else { lo = middle }
    }
    let whole = 1.0 - 2.0 * tension / e * lo.tan();
    assert!(((whole - at[0]) * tension * tension / delta - 1.0).abs() < 1e-2, "{whole} {at:?} {delta}");
}

#[test]
fn residuals_name_the_range_where_it_is_too_small_to_be_followed() {
    let mut lens = crate::preset::read_shipped("lens").unwrap();
    lens.set("material.adhesion", "dugdale".into()).unwrap();
    for (strength, is_followed) in [(1e5, true), (1e12, false)] {
        lens.set("material.cohesive_strength", strength.into()).unwrap();
        let found = residuals::residuals_own(&lens);
        assert_eq!(matches!(found, Err(FitError::SmallRange(..))), !is_followed, "{:?}", found.err());
    }
}
