//! Values that are given with an error.

use super::least_squares::Ending;
use super::tests::{Body, E, Normal, SPHERE, W, preset, sphere};
use super::*;
use crate::measured::Points;
use crate::preset::{Preset, data, read, write};
use crate::progress::Unwatched;

const STIFFNESS: &str = "path.control.stiffness";

fn noisy() -> Points {
    let mut points = Body { state: &sphere(1.3, 0.02, 2.0), compliance: 1.0 / 0.8, most: 1.6 }.samples(600);
    let mut normal = Normal::new(3);
    points.force.iter_mut().for_each(|p| *p += 2e-3 * normal.next());
    points
}

fn start(k: f64, uncertain: &str) -> Preset {
    let more = format!("control={{stiffness={k}}}\n[data]\nuncertain='{uncertain}'");
    preset(SPHERE, 1.5, 0.015, &more)
}

fn found(preset: &Preset, points: &Points) -> Result<Fit, FitError> {
    let free = [E, W].map(str::to_owned).to_vec();
    fit(preset, points, &Options { free, ..Options::default() }, &Unwatched)
}

/// How far a value is off, and its error, as shares.
fn off(fit: &Fit, key: &str, truth: f64) -> [f64; 2] {
    let fitted = fit.parameters.iter().find(|fitted| fitted.key == key).unwrap();
    [(fitted.value - truth).abs() / truth, fitted.standard_error.unwrap() / truth]
}

#[test]
fn the_error_of_a_spring_is_in_those_of_the_values() {
    let points = noisy();
    let held = found(&start(0.8, ""), &points).unwrap();
    let known = found(&start(0.8, "k=10%"), &points).unwrap();
    assert_eq!((known.ending, known.verdict), (Ending::Converged, Verdict::Describes));
    for (key, truth) in [(E, 1.3), (W, 0.02)] {
        let ([_, of_held], [is_off, of_known]) = (off(&held, key, truth), off(&known, key, truth));
        assert!(is_off < 3.0 * of_known && of_known > 1.1 * of_held, "{key}: {of_held} {of_known}");
    }
    // The given error of a tenth is smaller than the one from the points, and the fit reports what it was given.
    let [given] = &known.priors[..] else { panic!("{:?}", known.priors) };
    assert_eq!((&*given.key, given.value), (STIFFNESS, 0.8));
    assert!((given.standard_error - 0.08).abs() < 1e-15);
    assert!(given.shares.iter().all(|share| (0.0..=1.0).contains(share)), "{:?}", given.shares);
    // As sharp as with a spring that is held, and as wide as with one that is free.
    let [_, sharp] = off(&found(&start(0.8, "k=1e-6%"), &points).unwrap(), E, 1.3);
    let [_, of_held] = off(&held, E, 1.3);
    assert!((sharp / of_held - 1.0).abs() < 1e-3, "{sharp} {of_held}");
    // Off by a fifth, the points pull it back.
    let wrong = found(&start(0.96, "k=20%"), &points).unwrap();
    let [is_off, error] = off(&wrong, STIFFNESS, 0.8);
    assert!(wrong.verdict == Verdict::Describes && is_off < 3.0 * error, "{is_off} {error}");
}

#[test]
fn the_points_count_once_however_often_they_are_fitted() {
    let points = noisy();
    let first = found(&start(0.9, "k=0.05"), &points).unwrap();
    assert_ne!(first.preset.get(STIFFNESS), start(0.9, "").get(STIFFNESS));
    assert_eq!(first.preset.data.uncertain, "path.control.stiffness=0.9+-0.05");
    // By way of its text.
    let again = found(&read("again", &write(&first.preset)).unwrap(), &points).unwrap();
    for (a, b) in first.parameters.iter().zip(&again.parameters) {
        assert!((a.value / b.value - 1.0).abs() < 1e-6, "{a:?} {b:?}");
        assert!((a.standard_error.unwrap() / b.standard_error.unwrap() - 1.0).abs() < 1e-4, "{a:?} {b:?}");
    }
    assert_eq!(first.preset.data.uncertain, again.preset.data.uncertain);
}

#[test]
fn a_table_says_the_same_as_a_text() {
    let of = |data: &str| {
        let preset = preset(SPHERE, 1.3, 0.02, &format!("control={{stiffness=0.8}}\n{data}"));
        preset.data.uncertain
    };
    let text = of("[data]\nuncertain='path.control.stiffness=10 %,gap.radius_of_curvature=0.1'");
    let quoted = of("[data.uncertain]\n\"path.control.stiffness\"='10 %'\n\"gap.radius_of_curvature\"=0.1");
    let plain = of("[data.uncertain]\npath.control.stiffness='10 %'\ngap.radius_of_curvature=0.1");
    let sorted = |text: &str| {
        let mut parts: Vec<String> = text.split(',').map(str::to_owned).collect();
        parts.sort();
        parts
    };
    assert_eq!(sorted(&text), sorted(&quoted));
    assert_eq!(sorted(&text), sorted(&plain));
}

#[test]
fn what_cannot_be_given_is_refused_with_its_reason() {
    let points = noisy();
    for (uncertain, why) in [
        ("k", "expected KEY=ERROR"),
        ("stifness=10%", "is not a key of this preset"),
        ("k=10%,path.control.stiffness=5%", "is given twice"),
        ("k=0", "is out of range: it must be a number from 1e-30"),
        ("k=-3%", "must be above 0"),
        ("k=101%", "at most that value"),
        ("k=x%", "expected a number before %"),
        ("k=NaN", "k=NaN"),
        ("k=1 um", "k=1 um"),
        ("path.end_contact_radius=1%", "is not a positive number of the bodies"),
        ("data.offset=10%", "must be above 0"),
    ] {
        let error = found(&start(0.8, uncertain), &points).unwrap_err().to_string();
        assert!(error.starts_with("uncertain value") && error.contains(why), "{uncertain}: {error}");
    }
    // Nothing is asked for: nothing is refused, and the key stays.
    let mut other = start(0.8, "k=10%");
    other.set(data::UNCERTAIN, "".into()).unwrap();
    assert_eq!(other, start(0.8, ""));
}
