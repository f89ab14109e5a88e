//! Presets in SI: values with units, refusals, what is written, and the reduced answers in any units.

#![allow(clippy::unwrap_used, reason = "a helper of a test fails the test by panicking")]

use pulloff::store::{read, read_with, shipped};
use pulloff_engine::case::Case;
use pulloff_engine::disc::TableError;
use pulloff_engine::gap::panels::Unresolved;
use pulloff_engine::gap::{Gap, Shape};
use pulloff_engine::preset::changes::changes;
use pulloff_engine::preset::{Preset, Value, write};
use pulloff_engine::problem::{Control, Printer, Units};
use pulloff_engine::progress::Unwatched;
use pulloff_engine::quasistatic::path::PathError;
use pulloff_engine::quasistatic::{CurveStop, PathStop};
use pulloff_engine::report::path::{EventReport, Extent};
use pulloff_engine::report::{Head, PathReport, TraceReport, json, path_table};
use pulloff_engine::units::number::said;
use pulloff_engine::units::{DisplayUnits, UnitSystem};

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
    let units = read("p", &format!("{WAVY}[display]\nlength = \"nm\"\n")).unwrap().units;
    assert_eq!(units.shown(pulloff_engine::units::Quantity::Length, 2e-9).to_string(), "2.0 nm");
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
    // Display units do not show which units the numbers are in, so SI is not assumed.
    let fig_9 = shipped::find("fig-9").unwrap().text;
    let said = fig_9.replace("format = 1", "format = 1\nunits = \"reduced\"");
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
        (WAVY, &["gap.wavelength=-3 um"], "gap.wavelength = -3.0 um is out of range"),
        (
            &reduced,
            &[],
            "p.toml:3: material.effective_modulus: the problem is in reduced units: expected a pure number, got 2.5 MPa, a stress",
        ),
        (
            fig_9,
            &["display.length=nm"],
            "display.length belongs to SI, and the unit system is reduced: numbers",
        ),
        (
            &said,
            &["display.length=nm"],
            "display.length belongs to SI, and the unit system is reduced: numbers",
        ),
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
    // A number that no text in the display unit reproduces is written in SI.
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
    // The file of the shipped profile is in µm; in an SI preset its rows are in metres.
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
    let reduced = PathReport::unload(&shipped_preset("fig-9"), Extent::default(), &Unwatched).unwrap();
    let si = PathReport::unload(&shipped_preset("fig-9-si"), Extent::default(), &Unwatched).unwrap();
    let (radius, modulus) = (5e-3, 40e3);
    let (force, energy) = (modulus * radius * radius, modulus * radius * radius * radius);
    assert_eq!((reduced.events.len(), si.events.len()), (8, 8));
    let near = |what: &str, si: f64, unit: f64, reduced: f64| {
        assert!((si / unit - reduced).abs() <= 1e-10 * reduced.abs(), "{what}: {} {reduced}", si / unit);
    };
    near(
        "smallest force",
        si.totals.largest_pull.as_ref().unwrap().force,
        force,
        reduced.totals.largest_pull.as_ref().unwrap().force,
    );
    near(
        "smallest approach",
        si.totals.farthest.as_ref().unwrap().approach,
        radius,
        reduced.totals.farthest.as_ref().unwrap().approach,
    );
    near("loss", si.totals.dissipated.unwrap(), energy, reduced.totals.dissipated.unwrap());
    for (a, b) in si.events.iter().zip(&reduced.events) {
        let wave = |event: &EventReport| event.before.as_ref().unwrap().wave;
        assert_eq!((a.kind, wave(a), a.admissible), (b.kind, wave(b), b.admissible));
        near("control", a.control, radius, b.control);
        assert_eq!(a.after.is_some(), b.after.is_some());
        for (a, b) in [(&a.before, &b.before), (&a.after, &b.after)] {
            let (Some(a), Some(b)) = (a, b) else { continue };
            near("delta", a.approach, radius, b.approach);
            near("P", a.force, force, b.force);
            near("s", a.contact_radius, radius, b.contact_radius);
        }
        near("lost", a.dissipated.unwrap(), energy, b.dissipated.unwrap());
    }
    let text = path_table::path(&si);
    for words in ["delta [um]", "P [uN]", "contact [um]", "lost [nJ]", "start: delta ", " um  P "] {
        assert!(text.contains(words), "{words} in\n{text}");
    }
    assert!(!path_table::path(&reduced).contains('['));
    let document: serde_json::Value = serde_json::from_str(&json(&si).unwrap()).unwrap();
    let units = &document["units"];
    assert_eq!(
        (&units["system"], &units["length"], &units["energy"]),
        (&"SI".into(), &"m".into(), &"J".into())
    );
    let document: serde_json::Value = serde_json::from_str(&json(&reduced).unwrap()).unwrap();
    let units = &document["units"];
    assert_eq!((&units["system"], &units["length"]), (&"reduced".into(), &serde_json::Value::Null));
    assert_eq!(shipped_preset("fig-9").units, UnitSystem::Reduced);
}

/// Soft and large: the adhesion acts at the edge. Hard and small: it reaches beyond, and a warning says so.
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

const POWER: &str = "units = \"SI\"
[material]
effective_modulus = \"40 kPa\"
work_of_adhesion = \"50 mJ/m^2\"
[gap]
shape = \"power-law\"
coefficient = \"2e3 m^-1\"
exponent = 2
[path]
start_contact_radius = \"1 mm\"
";

#[test]
fn the_coefficient_of_a_power_law_has_the_dimension_its_exponent_gives() {
    for (exponent, coefficient, expected) in [
        ("2", "2e3", 2e3),
        ("2", "2 1/mm", 2e3),
        ("2", "2/mm", 2e3),
        ("2", "2e-3 um^-1", 2e3),
        ("3", "3 1/mm^2", 3e6),
        ("3", "(1+2) mm⁻²", 3e6),
        ("4", "1/2/mm^3", 0.5e9),
        ("1", "0.1", 0.1),
        ("2.5", "7", 7.0),
    ] {
        let sets = [format!("gap.exponent={exponent}"), format!("gap.coefficient={coefficient}")];
        let preset = read_with("p", POWER, &sets).unwrap();
        let got = number(&preset, "gap.coefficient");
        assert!((got - expected).abs() <= 4.0 * f64::EPSILON * expected, "{sets:?}: {got}");
        assert_eq!(read("p", &write(&preset)).unwrap(), preset, "{sets:?}");
    }
    for (exponent, coefficient, words) in [
        ("1", "90 deg", "gap.coefficient: expected a pure number, got 90 deg, an angle"),
        ("2", "2 um", "gap.coefficient: expected an inverse length such as m^-1, got 2 um, a length"),
        ("3", "2 1/um", "expected an inverse area such as m^-2, got 2 1/um, an inverse length"),
        (
            "5",
            "2 um^-3",
            "expected an inverse power of a length such as m^-4, got 2 um^-3, an inverse volume",
        ),
        ("1", "2 um", "expected a pure number, got 2 um, a length"),
        ("2.5", "2 um^-1", "with n = 2.5 it is a length to the power -1.5, for which there is no unit"),
        ("20", "2 um^-9", "with n = 20.0 it is a length to the power -19, for which there is no unit"),
        ("2", "2 furlong^-1", "unknown unit furlong"),
        ("2", "-2 um^-1", "gap.coefficient = -2.0 um^-1 is out of range"),
    ] {
        let sets = [format!("gap.exponent={exponent}"), format!("gap.coefficient={coefficient}")];
        let message = read_with("p", POWER, &sets).unwrap_err().to_string();
        assert!(message.contains(words), "{sets:?}: {message}");
    }
    let reduced = mistake(&POWER.replace("units = \"SI\"\n", ""), &[]);
    assert!(reduced.contains("the problem is in reduced units"), "{reduced}");
}

#[test]
fn the_coefficient_is_shown_and_typed_in_its_unit() {
    let mut preset = read("p", POWER).unwrap();
    for (key, text, shown, expected) in [
        ("gap.coefficient", "0.001", "0.001 um^-1", 1e3),
        ("gap.exponent", "4", "1e-15 um^-3", 1e3),
        ("gap.coefficient", "2e-12", "2e-12 um^-3", 2e6),
        ("gap.coefficient", "5 1/mm^3", "5e-9 um^-3", 5e9),
        ("gap.exponent", "1.5", "5e9", 5e9),
        ("gap.coefficient", "3", "3", 3.0),
    ] {
        let row = preset.row(key).unwrap();
        let value = preset.typed(&row, text).unwrap();
        preset.set(key, value).unwrap();
        let got = number(&preset, "gap.coefficient");
        assert!((got - expected).abs() <= 4.0 * f64::EPSILON * expected, "{key} = {text}: {got}");
        let quantity = preset.row("gap.coefficient").unwrap().quantity;
        assert_eq!(said(&preset.units, quantity, got), shown);
    }
    let text = write(&read("p", POWER).unwrap());
    assert!(text.contains("coefficient = \"0.002 um^-1\""), "{text}");
    // The same body in reduced units: c r² with r in units of 1/c.
    let si = PathReport::unload(&read("p", POWER).unwrap(), Extent::default(), &Unwatched).unwrap();
    let sphere = POWER
        .replace("power-law", "sphere")
        .replace("coefficient = \"2e3 m^-1\"\nexponent = 2", "radius_of_curvature = \"0.25 mm\"");
    let same = PathReport::unload(&read("p", &sphere).unwrap(), Extent::default(), &Unwatched).unwrap();
    assert!(
        (si.totals.largest_pull.as_ref().unwrap().force - same.totals.largest_pull.as_ref().unwrap().force)
            .abs()
            <= 1e-9 * same.totals.largest_pull.as_ref().unwrap().force.abs()
    );
}

#[test]
fn a_parameter_takes_a_value_in_any_unit_of_its_dimension() {
    let text = "units = \"SI\"
[material]
effective_modulus = \"40 kPa\"
work_of_adhesion = \"50 mJ/m^2\"
[gap]
shape = \"formula\"
formula = \"k*r^2 + A*(1 - cos(2*pi*r/lambda)) + 0*B\"
[gap.parameters]
k = { value = \"1/2/mm\", unit = \"m^-1\" }
A = 1e-6
lambda = { value = \"50 um\", min = \"0.01 mm\", max = \"100 um\", unit = \"nm\" }
B = { value = \"3 mm^2\", unit = \"m^2\" }
[path]
start_contact_radius = \"1 mm\"
";
    let preset = read("p", text).unwrap();
    for (key, expected) in [
        ("gap.parameters.k", 500.0),
        ("gap.parameters.A", 1e-6),
        ("gap.parameters.lambda", 50e-6),
        ("gap.parameters.lambda.min", 10e-6),
        ("gap.parameters.lambda.max", 100e-6),
        ("gap.parameters.B", 3e-6),
    ] {
        let got = number(&preset, key);
        assert!((got - expected).abs() <= 2.0 * f64::EPSILON * expected, "{key} = {got}");
    }
    assert_eq!(read("p", &write(&preset)).unwrap(), preset, "{}", write(&preset));
    // On the screen and in a file, in its own unit; in a document, in SI.
    let row = preset.row("gap.parameters.lambda").unwrap();
    assert_eq!(row.shown(&preset.units, 50e-6).text("50000", true), "50000 nm");
    assert_eq!(preset.typed(&row, "20"), Ok(Value::Typed("20 nm".to_owned())));
    let line = "lambda = { value = 50000.0, min = 10000.0, max = 100000.0, unit = \"nm\" }";
    assert!(write(&preset).contains(line), "{}", write(&preset));
    let case = Case::new(&preset).unwrap();
    let document = json(&Head::new("path", &preset, &case)).unwrap();
    let document: serde_json::Value = serde_json::from_str(&document).unwrap();
    let parameters = &document["problem"]["preset"]["gap"]["parameters"];
    assert_eq!((&parameters["lambda"]["unit"], &parameters["lambda"]["value"]), (&"m".into(), &5e-5.into()));
    assert_eq!((&parameters["k"]["unit"], &parameters["B"]["unit"]), (&"m^-1".into(), &"m^2".into()));
    // A bare number next to a unit is in that unit, wherever it comes from.
    let near =
        |preset: &Preset, key: &str, x: f64| assert!((number(preset, key) / x - 1.0).abs() < 1e-15, "{key}");
    let set = ["gap.parameters.lambda=6e4", "gap.parameters.lambda.max=2e5", "gap.parameters.A=2e-6"];
    let bare = read_with("p", text, &set).unwrap();
    near(&bare, "gap.parameters.lambda", 6e-5);
    near(&bare, "gap.parameters.lambda.max", 2e-4);
    near(&bare, "gap.parameters.A", 2e-6);
    let mut typed = preset.clone();
    typed.assign("gap.parameters.lambda", "7e4").unwrap();
    near(&typed, "gap.parameters.lambda", 7e-5);
    // Assignments that lead from one preset to the other state their unit, so that every digit is kept.
    typed.set("gap.parameters.lambda", (1e-4 / 3.0).into()).unwrap();
    let mut back = preset.clone();
    for (key, text) in changes(&preset, &typed).unwrap() {
        back.assign(&key, &text).unwrap();
    }
    assert_eq!(back, typed);
    assert_eq!(read("p", &write(&typed)).unwrap(), typed, "{}", write(&typed));
    // In reduced units the unit is only a remark; the change to SI makes it a unit, and the change back removes it.
    let mut plain =
        read_with("f", shipped::find("formula").unwrap().text, &["gap.parameters.lambda.unit=mm"]).unwrap();
    assert_eq!(number(&plain, "gap.parameters.lambda").to_bits(), 0.05_f64.to_bits());
    plain.assign("units", "SI").unwrap();
    assert_eq!(number(&plain, "gap.parameters.lambda").to_bits(), 5e-5_f64.to_bits());
    plain.assign("units", "reduced").unwrap();
    assert_eq!(plain.get("gap.parameters.lambda.unit"), None);
    for (set, words) in [
        (
            "gap.parameters.lambda=50 mN",
            "expected a length such as nm, the unit of the parameter, got 50 mN, a force",
        ),
        (
            "gap.parameters.lambda.max=1 m^2",
            "expected a length such as nm, the unit of the parameter, got 1 m^2, an area",
        ),
        (
            "gap.parameters.B=3 mm",
            "expected an area such as m^2, the unit of the parameter, got 3 mm, a length",
        ),
        ("gap.parameters.k=3 mm", "expected an inverse length such as m^-1"),
        (
            "gap.parameters.lambda=0.2 mm",
            "= 200000 nm is out of range: it must be a number from 10000 to 100000 (in nm)",
        ),
        ("gap.parameters.lambda=200000", "= 200000 nm is out of range"),
        ("gap.parameters.A.unit=furlong", "gap.parameters.A.unit: column 1: unknown unit furlong"),
    ] {
        let message = mistake(text, &[set]);
        assert!(message.contains(words), "{set}: {message}");
    }
}

/// The message when a preset cannot be computed.
fn refusal(preset: &Preset) -> String {
    let unloaded =
        Case::new(preset).and_then(|case| case.unload(&case.curve(&Unwatched)?, &case.setting(), &Unwatched));
    unloaded.unwrap_err().to_string()
}

#[test]
fn numbers_in_words_have_their_unit_in_si_and_none_in_reduced_units() {
    let [si, reduced] = ["fig-9-si", "fig-9"].map(|name| shipped::find(name).unwrap().text);
    // Refused before anything is computed.
    for (sets, words, bare) in [
        (
            ["path.start_contact_radius=60 mm", "path.start_contact_radius=12"],
            "path.start_contact_radius = 60000.0 um is out of range: it must be at most 10 x the radius of curvature \
             5000.0 um",
            "path.start_contact_radius = 12.0 is out of range: it must be at most 10 x the radius of curvature 1.0",
        ),
        (
            ["path.end_contact_radius=3 mm", "path.end_contact_radius=0.6"],
            "path.end_contact_radius = 3000.0 um is not below path.start_contact_radius = 2500.0 um",
            "path.end_contact_radius = 0.6 is not below path.start_contact_radius = 0.5",
        ),
    ] {
        let message = mistake(si, &sets[..1]);
        assert!(message.ends_with(words), "{message}");
        let message = mistake(reduced, &sets[1..]);
        assert!(message.ends_with(bare), "{message}");
    }
    // Refused by the computation.
    for (sets, parts, bare) in [
        (
            ["path.start_force=-1 N", "path.start_force=-5"],
            ["no contact has the force -1e6 uN; the smallest on the curve is -", " uN"],
            "no contact has the force -5; the smallest on the curve is -",
        ),
        (
            ["path.start_approach=-1 mm", "path.start_approach=-0.2"],
            ["no contact has the approach -1000 um; the smallest on the curve is -", " um"],
            "no contact has the approach -0.2; the smallest on the curve is -",
        ),
    ] {
        let fast = ["basis.kind=exact", "path.start_contact_radius=1"];
        let with = |text, set| read_with("p", text, &[fast[0], set]).unwrap();
        let message = refusal(&with(si, sets[0]));
        assert!(message.starts_with(parts[0]) && message.ends_with(parts[1]), "{message}");
        let message = refusal(&with(reduced, sets[1]));
        assert!(message.starts_with(bare) && message.ends_with(|c: char| c.is_ascii_digit()), "{message}");
    }
}

/// The lines that two computations of one problem report, in SI and in reduced units.
fn both(si: &[&str], reduced: &[&str], lines: impl Fn(&Preset) -> Vec<String>) -> [Vec<String>; 2] {
    let of =
        |name: &str, sets: &[&str]| lines(&read_with(name, shipped::find(name).unwrap().text, sets).unwrap());
    [of("fig-9-si", si), of("fig-9", reduced)]
}

#[test]
fn the_lines_of_a_document_have_units_in_si_and_none_in_reduced_units() {
    let traced = |preset: &Preset| {
        let report = TraceReport::compute(preset, &Unwatched).unwrap();
        [report.warnings, report.notes, vec![report.stop]].concat()
    };
    let unloaded = |preset: &Preset| {
        let report = PathReport::unload(preset, Extent::default(), &Unwatched).unwrap();
        let note = report.start_note.into_iter().collect();
        [report.warnings, report.notes, note, vec![report.stop]].concat()
    };
    // Adhesion so weak that crests touch, none at all, and a start that is unstable.
    let weak = ["material.work_of_adhesion=20 mJ/m^2", "basis.kind=exact"];
    let same = ["material.work_of_adhesion=1e-4", "basis.kind=exact"];
    let none = ["material.work_of_adhesion=0", "basis.kind=exact", "path.contact=one-disc"];
    let starts = (["path.start_contact_radius=2.4 mm"], ["path.start_contact_radius=0.48"]);
    for (lines, word) in [
        (both(&weak, &same, traced), "s = "),
        (both(&none, &none, unloaded), "s = "),
        (both(&starts.0, &starts.1, unloaded), "contact radius "),
    ] {
        let [si, reduced] = &lines;
        assert_eq!(si.len(), reduced.len(), "{lines:?}");
        let told = |lines: &[String]| lines.iter().find(|line| line.contains(word)).cloned();
        let (si, bare) = (told(si).unwrap(), told(reduced).unwrap());
        // In reduced units every number with a decimal point is a length here, and each has its unit in SI.
        let lengths = bare.split_whitespace().filter(|piece| piece.contains('.')).count();
        assert!(lengths >= 2 && si.matches(" um").count() == lengths, "{si}\n{bare}");
        assert!(!bare.contains(" um"), "{bare}");
        assert!(reduced.iter().all(|line| !line.contains(" um")), "{reduced:?}");
    }
}

#[test]
fn what_stops_a_curve_and_what_a_gap_cannot_be_is_told_in_units() {
    let si = UnitSystem::Si(DisplayUnits::default());
    let stop = PathStop::Curve(CurveStop::NoEquilibrium(2e-5));
    let units = Units { length: 2.0, stiffness: 5.0, ..Units::REDUCED };
    let printer = Printer::new(&units, &si);
    let words = stop.words(&printer);
    assert!(words.contains("below the contact radius 40 um (a finer"), "{words}");
    assert!(stop.to_string().contains("below the contact radius 2e-5 (a finer"), "{stop}");
    let unstable = PathError::UnstableStart { contact_radius: 2e-5, searched: 1e-3, falls: false };
    // A gap too fine for a table beyond the start, found while a path is followed.
    let fine = Unresolved { radius: 1e-5, largest: 2e-3, panels: 20_000.0 };
    let words = PathError::Table(TableError::TooFine(fine)).words(&printer);
    assert!(words.contains("at r = 20 um (it must be up to r = 4000 um)"), "{words}");
    let words = unstable.words(&printer.under(Control::Stiffness(1.0)));
    assert!(words.contains("(contact radius 40 um)") && words.contains("stiffness=5 N/m control"), "{words}");
    assert!(words.ends_with("up to the contact radius 2000 um"), "{words}");

    let base = "units = \"SI\"\n[material]\neffective_modulus = 4e4\nwork_of_adhesion = 0.05\n[path]\n\
                start_contact_radius = \"1 mm\"\n[gap]\n";
    let mistake = |gap: &str| mistake(&format!("{base}{gap}"), &[]);
    let formula = mistake("shape = \"formula\"\nformula = \"sqrt(5e-4 - r)\"");
    assert!(formula.contains("not finite at r = 500 um (it must be up to r = 1000 um"), "{formula}");
    let waves = mistake(
        "shape = \"random-waves\"\nradius_of_curvature = 0.005\nrms = 0\nlongest_wavelength = \"1 um\"\n\
         shortest_wavelength = \"2 um\"",
    );
    assert!(waves.contains("the shortest wavelength 2 um must be below the longest, 1 um"), "{waves}");
    let cutoff = mistake("shape = \"profile\"\nfile = \"shipped:rough-sphere.csv\"\nsmoothing = \"1 m\"");
    assert!(
        cutoff.contains("the cutoff 1e6 um is out of range: it must be positive and at most "),
        "{cutoff}"
    );
    assert!(cutoff.contains(" um, "), "{cutoff}");

    let shifted = format!("{base}shape = \"formula\"\nformula = \"r^2/0.01 + 2e-6\"");
    let case = Case::new(&read("p", &shifted).unwrap()).unwrap();
    let warnings = case.warnings(case.start);
    assert!(warnings.iter().any(|w| w.starts_with("the formula is 2 um on the axis")), "{warnings:?}");
}
