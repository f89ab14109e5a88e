//! Presets in SI: values with units, what is refused, what is written, and the reduced answers in any units.

#![allow(clippy::unwrap_used, reason = "a helper of a test fails the test by panicking")]

use pulloff::case::Case;
use pulloff::contact::{Control, Gap, Shape};
use pulloff::preset::{Preset, Value, read, read_with, shipped, write};
use pulloff::report::{UnloadReport, json, table};
use pulloff::units::UnitSystem;

const WAVY: &str = "units = \"SI\"
[material]
effective_modulus = \"2.5 MPa\"
work_of_adhesion = \"30 mJ/m^2\"
[gap]
shape = \"wavy-sphere\"
radius_of_curvature = 1e-3
amplitude = \"0.125 um\"
wavelength = \"3*pi/2 um\"
[path]
control = { stiffness = \"5 N/m\" }
start_contact_radius = \"1/10 mm\"
";

fn shipped_preset(name: &str) -> Preset {
    read(name, shipped::find(name).unwrap().text).unwrap()
}

fn number(preset: &Preset, key: &str) -> f64 {
    let value = preset.get(key);
    let number = value.as_ref().and_then(|value| if let Value::Number(x) = value { Some(*x) } else { None });
    number.unwrap()
}

fn mistake(text: &str, sets: &[&str]) -> String {
    read_with("p.toml", text, sets).unwrap_err().to_string()
}

#[test]
fn texts_have_their_unit_and_bare_numbers_are_si() {
    let preset = read("p", WAVY).unwrap();
    for (key, expected) in [
        ("material.effective_modulus", 2.5e6),
        ("material.work_of_adhesion", 30e-3),
        ("gap.radius_of_curvature", 1e-3),
        ("gap.amplitude", 0.125e-6),
        ("gap.wavelength", 1.5 * std::f64::consts::PI / 1e6),
        ("path.control.stiffness", 5.0),
        ("path.start_contact_radius", 0.1e-3),
    ] {
        let got = number(&preset, key);
        assert!((got - expected).abs() <= 2.0 * f64::EPSILON * expected, "{key} = {got}");
    }
    let sets = ["gap.amplitude=1e-7", "gap.wavelength=20 µm", "path.control=stiffness=80mN/m"];
    let preset = read_with("p", WAVY, &sets).unwrap();
    assert_eq!(preset.gap.wave(), Some((1e-7, 20e-6)));
    assert_eq!(preset.path.control, Control::Stiffness(80e-3));
    // A table of display units alone says that the preset is in SI.
    let text = format!("{}[display]\nlength = \"nm\"\n", WAVY.replace("units = \"SI\"\n", ""));
    let units = read("p", &text).unwrap().units;
    assert_eq!(units.shown(pulloff::units::Quantity::Length, 2e-9).to_string(), "2.0 nm");
}

#[test]
fn beside_a_unit_on_the_screen_a_bare_number_counts_in_it() {
    let mut preset = read("p", WAVY).unwrap();
    for (key, text, expected) in [
        ("gap.wavelength", "20", 20e-6),
        ("gap.wavelength", "2*5", 10e-6),
        ("gap.wavelength", "30 nm", 30e-9),
        ("material.work_of_adhesion", "50", 50e-3),
        ("path.control.stiffness", "7", 7.0),
    ] {
        let row = preset.row(key).unwrap();
        let value = preset.typed(&row, text).unwrap();
        preset.set(key, value).unwrap();
        let got = number(&preset, key);
        assert!((got - expected).abs() <= 2.0 * f64::EPSILON * expected, "{key} = {got}");
    }
}

#[test]
fn what_has_another_dimension_or_no_units_is_refused() {
    let reduced = WAVY.replace("\"SI\"", "\"reduced\"");
    let fig_9 = shipped::find("fig-9").unwrap().text.replace("format = 1", "format = 1\nunits = \"reduced\"");
    for (text, sets, words) in [
        (
            WAVY,
            &["gap.wavelength=3 N"][..],
            "--set gap.wavelength=3 N: gap.wavelength: expected a length such as um, got 3 N, a force",
        ),
        (
            WAVY,
            &["path.control=stiffness=3 kPa"],
            "path.control: expected a force per length such as N/m, got 3 kPa, a stress",
        ),
        (WAVY, &["gap.wavelength=3 furlong"], "unknown unit furlong"),
        (WAVY, &["display.length=kPa"], "display.length: expected a length such as um, got kPa, a stress"),
        (WAVY, &["gap.wavelength=-3 um"], "gap.wavelength = -3e-6 is out of range"),
        (
            &reduced,
            &[],
            "p.toml:3: material.effective_modulus: the problem is in reduced units: expected a pure number, got 2.5 MPa, a stress",
        ),
        (&fig_9, &["display.length=nm"], "display.length belongs to SI, and the unit system is reduced"),
    ] {
        let message = mistake(text, sets);
        assert!(message.contains(words), "{sets:?}: {message}");
    }
    let mut preset = shipped_preset("fig-9");
    preset.assign("gap.wavelength", "1/20").unwrap();
    assert!(preset.assign("gap.wavelength", "1 um").is_err());
    assert_eq!(number(&preset, "gap.wavelength").to_bits(), 0.05f64.to_bits());
}

#[test]
fn what_is_written_reads_back_and_keeps_units_where_they_are_exact() {
    for preset in [read("p", WAVY).unwrap(), shipped_preset("fig-9-si")] {
        let text = write(&preset);
        assert_eq!(read("p", &text).unwrap(), preset, "{text}");
        assert!(text.contains("\nunits = \"SI\"") && text.contains("\namplitude = \""), "{text}");
        assert!(text.contains("\n[display]\nlength = \"um\""), "{text}");
    }
    // A number that no text in the display unit gives back is written as SI.
    let mut preset = read("p", WAVY).unwrap();
    let mut plain = 0;
    for i in 1..200 {
        preset.set("gap.amplitude", (1e-7 / f64::from(i)).into()).unwrap();
        let text = write(&preset);
        plain += usize::from(!text.contains("\namplitude = \""));
        assert_eq!(read("p", &text).unwrap(), preset);
    }
    assert!(plain > 0, "some numbers have no exact text in µm");
}

#[test]
fn formulas_and_profiles_have_units_too() {
    let formula = "units = \"SI\"
[material]
effective_modulus = \"2.5 MPa\"
work_of_adhesion = \"30 mJ/m^2\"
[gap]
shape = \"formula\"
formula = \"r^2/(2*R) + A*(1 - cos(2*pi*r/lambda))\"
[gap.parameters]
R = \"1 mm\"
A = { value = \"0.125 um\", min = 0, max = \"1 um\", unit = \"um\" }
lambda = \"50 um\"
[path]
start_contact_radius = \"0.1 mm\"
";
    let typed = read("p", formula).unwrap();
    let known = Shape::WavySphere { radius_of_curvature: 1e-3, amplitude: 0.125e-6, wavelength: 50e-6 };
    for r in [1e-6, 3e-5, 9e-5] {
        let (a, b) = (typed.gap.jet(r).value, known.jet(r).value);
        assert!((a - b).abs() < 1e-12 * b, "{a} {b}");
    }
    assert_eq!(read("p", &write(&typed)).unwrap(), typed);
    assert!(mistake(formula, &["gap.parameters.A=1 kPa"]).contains("expected a length"));
    // The file of the shipped profile is in µm: in an SI preset its rows are metres.
    let measured = shipped_preset("profile");
    let sets = ["units=SI", "path.start_contact_radius=100 um", "path.end_contact_radius=1 um"];
    let si = read_with("profile", shipped::find("profile").unwrap().text, &sets).unwrap();
    for r in [10.0, 50.0, 100.0] {
        let (a, b) = (si.gap.jet(r * 1e-6).value * 1e6, measured.gap.jet(r).value);
        assert!((a - b).abs() < 1e-9 * b.abs(), "{a} {b}");
    }
    assert_eq!(read("p", &write(&si)).unwrap(), si);
}

#[test]
fn figure_9_in_si_gives_the_reduced_answers() {
    let reduced = UnloadReport::compute(&shipped_preset("fig-9")).unwrap();
    let si = UnloadReport::compute(&shipped_preset("fig-9-si")).unwrap();
    let (radius, modulus) = (5e-3, 40e3);
    let (force, energy) = (modulus * radius * radius, modulus * radius * radius * radius);
    assert_eq!((reduced.events.len(), si.events.len()), (8, 8));
    let near = |what: &str, si: f64, unit: f64, reduced: f64| {
        assert!((si / unit - reduced).abs() <= 1e-10 * reduced.abs(), "{what}: {} {reduced}", si / unit);
    };
    near("smallest force", si.min_force, force, reduced.min_force);
    near("smallest approach", si.min_approach, radius, reduced.min_approach);
    near("loss", si.total_dissipated, energy, reduced.total_dissipated);
    for (a, b) in si.events.iter().zip(&reduced.events) {
        assert_eq!((a.kind, a.before.wave, a.admissible), (b.kind, b.before.wave, b.admissible));
        near("control", a.control_value, radius, b.control_value);
        assert_eq!(a.after.is_some(), b.after.is_some());
        for (a, b) in [(Some(a.before), Some(b.before)), (a.after, b.after)] {
            let (Some(a), Some(b)) = (a, b) else { continue };
            near("delta", a.approach, radius, b.approach);
            near("P", a.force, force, b.force);
            near("s", a.contact_radius, radius, b.contact_radius);
        }
        near("lost", a.dissipated.unwrap(), energy, b.dissipated.unwrap());
    }
    let text = table::unload(&si);
    for words in ["delta [um]", "P [uN]", "s [um]", "lost [nJ]", "start: delta ", " um  P "] {
        assert!(text.contains(words), "{words} in\n{text}");
    }
    assert!(!table::unload(&reduced).contains('['));
    let document: serde_json::Value = serde_json::from_str(&json(&si).unwrap()).unwrap();
    let units = &document["problem"]["units"];
    assert_eq!(
        (&units["system"], &units["length"], &units["energy"]),
        (&"SI".into(), &"m".into(), &"J".into())
    );
    let document: serde_json::Value = serde_json::from_str(&json(&reduced).unwrap()).unwrap();
    let units = &document["problem"]["units"];
    assert_eq!((&units["system"], &units["length"]), (&"reduced".into(), &serde_json::Value::Null));
    assert_eq!(shipped_preset("fig-9").units, UnitSystem::Reduced);
}

/// Soft and large: the adhesion acts at the edge. Hard and small: it reaches beyond, and that is said.
#[test]
fn tabor_is_known_in_si_and_warned_of_where_the_method_does_not_hold() {
    let case = |sets: &[&str]| Case::new(&read_with("p", WAVY, sets).unwrap()).unwrap();
    let soft = case(&[]);
    // (1e-3 · 0.03²/(2.5e6² · 2.7e-29))^{1/3}.
    let mu: f64 = 1e-3 * 0.03 * 0.03 / (2.5e6 * 2.5e6 * 2.7e-29);
    assert!((soft.tabor.unwrap() / mu.cbrt() - 1.0).abs() < 1e-12);
    assert!(soft.warnings(soft.start).iter().all(|warning| !warning.contains("Tabor")));
    let far = case(&["material.range_of_action=1 mm"]);
    assert!(
        far.warnings(far.start).iter().any(|warning| warning.starts_with("Tabor's mu = 0.00")),
        "{far:?}"
    );
    assert_eq!(Case::new(&shipped_preset("fig-9")).unwrap().tabor, None);
}
