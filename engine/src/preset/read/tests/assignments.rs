//! Assignments laid over a file.

use super::{WAVY, edited, messages, set};
use crate::gap::Shape;
use crate::preset::model::BasisSpec;
use crate::preset::{Value, read, read_with};
use crate::problem::{Control, Start};
use crate::ritz::Grading;

#[test]
fn assignments_are_laid_over_the_file_in_order() {
    assert_eq!(set(&["basis.rings=400"]).basis, BasisSpec::Rings { rings: 400, grading: Grading::Uniform });
    assert_eq!(
        set(&["basis.rings=400", "basis.rings = 50"]).basis,
        BasisSpec::Rings { rings: 50, grading: Grading::Uniform }
    );
    assert_eq!(set(&["title=a = b"]).title, "a = b");
    for spring in [
        "path.control=stiffness=0.15",
        "path.control.stiffness=0.15",
        "path.control={stiffness=0.15}",
        "path={control={stiffness=0.15}}",
    ] {
        assert_eq!(set(&[spring]).path.control, Control::Stiffness(0.15), "{spring}");
    }
    assert_eq!(set(&["path.control.stiffness=1", "path.control=force"]).path.control, Control::Force);
    assert_eq!(set(&["path.start_force=0.02"]).path.start, Start::Force(0.02));
    assert_eq!(set(&["path.start_force=0.02", "path.start_approach=1"]).path.start, Start::Approach(1.0));
    assert_eq!(set(&["gap.shape=sphere"]).gap, Shape::Sphere { radius_of_curvature: 1.0 });
}

#[test]
fn angles_are_taken_in_the_unit_of_their_key() {
    let bridge = "units='SI'\n[gap]\nshape='sphere'\nradius_of_curvature=1e-6\n[material]\neffective_modulus=1e10\n\
                  adhesion='capillary'\nsurface_tension=0.072\nkelvin_radius=1.5e-9\n[path]\nstart_force=0.0";
    let angle = |text: &str| read_with("b.toml", bridge, &[&format!("material.contact_angle={text}")]);
    let degrees = |text: &str| match angle(text).unwrap().get("material.contact_angle") {
        Some(Value::Number(degrees)) => degrees,
        other => panic!("{other:?}"),
    };
    for text in ["60", "60 deg", "60 °", "60deg"] {
        assert_eq!(degrees(text).to_bits(), 60_f64.to_bits(), "{text}");
    }
    assert!((degrees("350 mrad") - 0.35_f64.to_degrees()).abs() < 1e-12);
    assert!(["95 deg", "20 nm", "60 deg^2", "60 rad/rad"].iter().all(|text| angle(text).is_err()));
    let refused = read_with("b.toml", bridge, &["material.kelvin_radius=1 deg"]).unwrap_err().to_string();
    assert!(refused.contains("expected a length such as um, got 1 deg, an angle"), "{refused}");
    let formula = "[gap]\nshape='formula'\nformula='r^2*sin(th)'\n[gap.parameters]\nth={value='30 deg', min='0 deg', max='90 deg'}\n\
                   [material]\neffective_modulus=1.0\nwork_of_adhesion=0.01\n[path]\nstart_contact_radius=0.3";
    assert_eq!(
        read("f.toml", formula).unwrap().get("gap.parameters.th.max"),
        Some(std::f64::consts::FRAC_PI_2.into())
    );
    // A slope is no angle; a phase is one.
    let refused = messages(WAVY, &["gap.shape=cone", "gap.slope=10 deg"]);
    assert!(
        refused[0].ends_with("reduced units: expected a pure number, got 10 deg, an angle"),
        "{refused:?}"
    );
    let waves = set(&[
        "gap.shape=harmonics",
        "gap.waves.1.amplitude=1e-3",
        "gap.waves.1.wavelength=0.1",
        "gap.waves.1.phase=90 deg",
    ]);
    assert_eq!(waves.get("gap.waves.1.phase"), Some(std::f64::consts::FRAC_PI_2.into()));
}

#[test]
fn none_takes_an_optional_value_away() {
    let text = WAVY.replace("[path]", "[path]\nrate = 2.0");
    let rated = read("w.toml", &text).unwrap();
    assert_eq!(rated.get("path.rate"), Some(2.0.into()));
    let mut preset = read_with("w.toml", &text, &["path.rate=none"]).unwrap();
    assert_eq!(preset.get("path.rate"), None);
    // The other start given stays: none is no rival.
    assert_eq!(
        read_with("w.toml", &text, &["path.start_approach=none"]).unwrap().path.start,
        rated.path.start
    );
    for value in ["3", "none", "none"] {
        preset.assign("path.rate", value).unwrap();
    }
    assert_eq!(preset.get("path.rate"), None);
    let spring = set(&["path.control.stiffness=2", "path.control.stiffness=none"]);
    assert_eq!(spring.path.control, Control::Displacement);
    for key in ["gap.amplitude", "groups.amplitude_over_wavelength", "basis.rings"] {
        assert!(preset.assign(key, "none").is_err(), "{key}");
        assert!(read_with("w.toml", &text, &[&format!("{key}=none")]).is_err(), "{key}");
    }
}

#[test]
fn a_basis_drops_and_brings_its_keys() {
    assert_eq!(set(&["basis.kind=exact"]).basis, BasisSpec::Exact);
    let text = WAVY.replace("\"rings\"\nrings = 200", "\"exact\"");
    assert_eq!(read("w.toml", &text).unwrap().basis, BasisSpec::Exact);
    assert_eq!(
        read_with("w.toml", &text, &["basis.kind=rings", "basis.rings=9"]).unwrap().basis,
        BasisSpec::Rings { rings: 9, grading: Grading::Uniform }
    );
    for (old, new, expected) in [
        (
            "\"rings\"",
            "\"exact\"",
            "w.toml:13: basis.rings belongs to basis.kind = rings, and the basis is exact",
        ),
        (
            "\"rings\"",
            "\"exat\"",
            "w.toml:12: basis.kind = \"exat\" is not known: it must be \"exact\" or \"rings\"; did you mean exact?",
        ),
    ] {
        assert_eq!(edited(old, new), expected);
    }
}

#[test]
fn an_assignment_repairs_a_wrong_line() {
    let text = WAVY.replace("= 200", "= 1");
    assert_eq!(
        read_with("w.toml", &text, &["basis.rings=9"]).unwrap().basis,
        BasisSpec::Rings { rings: 9, grading: Grading::Uniform }
    );
}

#[test]
fn a_key_may_be_given_by_its_last_part_or_its_symbol() {
    let whole = set(&["material.work_of_adhesion=0.5", "gap.amplitude=0.003"]);
    assert_eq!(set(&["gamma=0.5", "A=0.003"]), whole);
    assert_eq!(set(&["γ=0.5", "amplitude=0.003"]), whole);
    // The gap that an assignment before chose decides; where it is not complete, its name does.
    assert_eq!(set(&["shape=sphere", "R=2"]), set(&["gap.shape=sphere", "gap.radius_of_curvature=2"]));
    let power = ["gap.shape=power-law", "gap.coefficient=1", "gap.exponent=3"];
    assert_eq!(set(&["shape=power-law", "c=1", power[2]]), set(&power));
    // Of two exponents, that of a table that is used.
    assert_eq!(set(&["shape=power-law", "c=1", "exponent=3"]), set(&power));
    // A wave has no exponent, but its edge may have one.
    assert!(messages(WAVY, &["exponent=3"])[0].contains("edge.exponent"));
    let both = ["shape=power-law", "edge.reference_speed=1", "exponent=3"];
    assert!(
        messages(WAVY, &both).concat().contains("exponent is short for several: gap.exponent, edge.exponent")
    );
    // The symbol of an exponent is that of the gap or of the edge, whichever the preset has.
    assert_eq!(set(&["shape=power-law", "c=1", "n=3"]), set(&power));
    assert_eq!(set(&["n=0.5"]), set(&["edge.exponent=0.5"]));
    assert_eq!(set(&["edge.exponent=0.3", "n=0.5", "m=0.4"]), set(&["n=0.5", "edge.closing_exponent=0.4"]));
    let both = [&power[..], &["edge.exponent=0.5", "n=2"]].concat();
    assert!(messages(WAVY, &both)[0].ends_with("n is short for several: gap.exponent, edge.exponent"));
    assert_eq!(
        set(&["gap.shape=formula", "gap.formula=r^2/(2*n)", "n=2"]),
        set(&["gap.shape=formula", "gap.formula=r^2/(2*n)", "gap.parameters.n=2"])
    );
    // A formula names its parameters before they have values.
    let formula = ["gap.shape=formula", "gap.formula=r^2/(2*R) + B*r^4", "gap.parameters.R=1"];
    let of = |last: &'static str| set(&[&formula[..], &[last]].concat());
    assert_eq!(of("B=2"), of("gap.parameters.B=2"));
    // Whatever the order.
    assert_eq!(set(&["B=2", formula[1], formula[2], formula[0]]), of("B=2"));
    assert_eq!(set(&["gamma'=0.04"]), set(&["groups.adhesion=0.04"]));
    // The unit of a stiffness on the screen is no value.
    assert_eq!(set(&["stiffness=3"]), set(&["path.control.stiffness=3"]));
    // What the file lacks may follow.
    let lacking = "[material]\neffective_modulus=1\n[gap]\nshape='sphere'\nradius_of_curvature=1";
    assert!(
        (read_with("w.toml", lacking, &["gamma=0.5"]).unwrap().material.work_of_adhesion - 0.5).abs() < 1e-15
    );
    let waves = "[material]\neffective_modulus=1\nwork_of_adhesion=0\n[gap]\nshape='harmonics'\nradius_of_curvature=1\n\
        waves=[{amplitude=1e-3,wavelength=0.1},{amplitude=1e-3,wavelength=0.2}]\n[path]\nstart_contact_radius=0.5";
    let lines = messages(waves, &["amplitude=2e-3"]);
    let expected = "is short for several: gap.waves.1.amplitude, gap.waves.2.amplitude";
    assert!(lines[0].ends_with(expected), "{lines:?}");
}

#[test]
fn a_wrong_assignment_is_named() {
    for (assignment, expected) in [
        ("gap.amplitude=-1", "--set gap.amplitude=-1: gap.amplitude = -1.0 is out of range"),
        ("gap.amplitude", "--set gap.amplitude: an assignment is KEY=VALUE"),
        (
            "gap.wavelenght=1",
            "--set gap.wavelenght=1: unknown key gap.wavelenght; did you mean gap.wavelength?",
        ),
        ("gap=1", "--set gap=1: gap is a table, not \"1\"; set one of its keys, such as gap.shape"),
        ("=1", "--set =1: nothing stands before the =; an assignment is KEY=VALUE"),
        (
            "path.start_contact_radius=0.001",
            "--set path.start_contact_radius=0.001: path.end_contact_radius = 0.002 is not below",
        ),
        (
            "gap.radius_of_curvature=0.01",
            "--set gap.radius_of_curvature=0.01: path.start_contact_radius = 0.5 is out of range",
        ),
        ("format=3", "--set format=3: format = 3 is not known"),
    ] {
        let lines = messages(WAVY, &[assignment]);
        assert!(lines[0].starts_with(expected), "{lines:?}\n{expected}");
    }
    let lines = messages(WAVY, &["gap.shape=sphere", "gap.amplitude=1"]);
    assert_eq!(
        lines,
        ["--set gap.amplitude=1: gap.amplitude belongs to gap.shape = wavy-sphere, and the gap is a sphere"]
    );
    let sphere =
        "[material]\neffective_modulus=1\nwork_of_adhesion=0\n[gap]\nshape='sphere'\nradius_of_curvature=1";
    let lines = messages(sphere, &["gap.shape=wavy-sphere"]);
    assert!(lines[0].starts_with("w.toml:4: gap.amplitude is missing"), "{lines:?}");
}
