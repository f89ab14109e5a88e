//! Values set, refused and read back by key.

use super::*;
use crate::gap::{shapes::ExactSphere, shapes::PowerLaw, shapes::RandomWaves};
use crate::measured::PointsFile;
use crate::preset::edge::EdgeSpec;
use crate::preset::fixtures::{any_gap, wavy};
use crate::preset::rows::parameter;
use crate::preset::schema::{ADHESION, Applies, FORMAT, Fallback, Kind, LIQUID_KEYS, PARAMETERS};
use crate::preset::value::Value;
use crate::problem::{Adhesion, StatedCohesion};

/// A value for a key that differs from the one in [`wavy`].
fn another(key: &str) -> Value {
    match key {
        "format" => FORMAT.into(),
        "title" => "t".into(),
        "units" => "SI".into(),
        "display.length" => "nm".into(),
        "display.force" => "pN".into(),
        "display.stress" => "MPa".into(),
        "display.adhesion" | "display.stiffness" => "mN/m".into(),
        "display.energy" => "eV".into(),
        "gap.shape" => "sphere".into(),
        "basis.kind" => "exact".into(),
        "basis.rings" => 77.into(),
        "basis.grading" => "edge".into(),
        "path.control" => Control::Force.into(),
        "path.begin" => "apart".into(),
        "path.contact" => "one-disc".into(),
        "path.end_contact_radius" => 0.003.into(),
        "path.turn_approach" => 0.1.into(),
        "path.turn_force" => 0.05.into(),
        "path.turn_contact_radius" => 0.3.into(),
        "gap.exponent" => 2.5.into(),
        "gap.shortest_wavelength" => 0.03.into(),
        "gap.count" | "gap.seed" => 9.into(),
        "gap.formula" => "r^2/R".into(),
        "gap.file" => {
            Value::Profile(Arc::new(crate::fixtures::load(None, "shipped:rough-sphere.csv").unwrap()))
        }
        "data.file" => Value::Points(Arc::new(points())),
        "data.columns" => "x=1,force=2".into(),
        "data.free" => "E*,gamma".into(),
        "data.uncertain" => "gap.radius_of_curvature=1%".into(),
        "data.segment" => "approach".into(),
        "data.free_part" => "x=-1..2".into(),
        "data.signs" => "x=-,force=+".into(),
        "data.skip" => 2.into(),
        "data.settings" => "preset".into(),
        "material.closing_work_of_adhesion" => 0.002.into(),
        "path.steps" => "to 0.1 at 0.01; hold 2; apart at 1e-3".into(),
        "material.adhesion" => "dugdale".into(),
        _ => Value::Number(0.75),
    }
}

/// Numbers without a header.
fn points() -> PointsFile {
    let rows: Vec<String> = (0..10).map(|i| format!("{i} {}", i * i)).collect();
    PointsFile::new("points.txt".to_owned(), None, rows.join("\n").into_bytes().into())
}

/// Every key of the table.
const FIELDS: &[&str] = &[
    "format",
    "title",
    "units",
    "material.effective_modulus",
    "material.work_of_adhesion",
    "material.closing_work_of_adhesion",
    "material.range_of_action",
    "material.adhesion",
    "material.cohesive_strength",
    "material.cohesive_range",
    "material.surface_tension",
    "material.kelvin_radius",
    "material.contact_angle",
    "gap.shape",
    "gap.radius_of_curvature",
    "gap.amplitude",
    "gap.wavelength",
    "gap.slope",
    "gap.coefficient",
    "gap.exponent",
    "gap.rms",
    "gap.longest_wavelength",
    "gap.shortest_wavelength",
    "gap.hurst",
    "gap.count",
    "gap.seed",
    "gap.formula",
    "gap.file",
    "gap.smoothing",
    "basis.kind",
    "basis.rings",
    "basis.grading",
    "edge.reference_speed",
    "edge.exponent",
    "edge.closing_speed",
    "edge.closing_exponent",
    "edge.highest_ratio",
    "edge.relaxation_time",
    "path.control",
    "path.control.stiffness",
    "path.start_contact_radius",
    "path.start_approach",
    "path.start_force",
    "path.end_contact_radius",
    "path.begin",
    "path.contact",
    "path.rate",
    "path.steps",
    "path.turn_approach",
    "path.turn_force",
    "path.turn_contact_radius",
    "data.file",
    "data.columns",
    "data.free",
    "data.uncertain",
    "data.segment",
    "data.free_part",
    "data.signs",
    "data.skip",
    "data.settings",
    "data.offset",
    "data.baseline",
    "data.tare",
    "data.tilt",
    "display.length",
    "display.force",
    "display.stress",
    "display.adhesion",
    "display.energy",
    "display.stiffness",
];

#[test]
fn the_table_is_total() {
    // Destructured without `..`: a new field stops this test from compiling until it has a row below.
    let Preset { title: _, units: _, material, gap, basis, path, edge, data, files: _ } = wavy();
    let EdgeSpec {
        closing_work_of_adhesion: _,
        reference_speed: _,
        exponent: _,
        closing_speed: _,
        closing_exponent: _,
        highest_ratio: _,
        relaxation_time: _,
        rate: _,
        steps: _,
    } = edge;
    let DataSpec {
        source: _,
        columns: _,
        offset: _,
        baseline: _,
        tare: _,
        tilt: _,
        segment: _,
        free: _,
        uncertain: _,
        is_alone: _,
        free_part: _,
        apart: _,
        turned: _,
        skip: _,
    } = data;
    let Material { effective_modulus: _, work_of_adhesion: _, range_of_action: _, adhesion: _ } = material;
    match basis {
        BasisSpec::Rings { rings: _, grading: _ } | BasisSpec::Exact => {}
    }
    let PathSpec { control: _, start: _, end_contact_radius: _, begin: _, contact: _, turn: _ } = path;
    match gap {
        Shape::Sphere { radius_of_curvature: _ }
        | Shape::WavySphere { radius_of_curvature: _, amplitude: _, wavelength: _ }
        | Shape::ExactSphere(ExactSphere { radius: _ })
        | Shape::Cone { slope: _ }
        | Shape::PowerLaw(PowerLaw { factor: _, exponent: _ })
        | Shape::Harmonics(_)
        | Shape::RandomWaves {
            spectrum:
                RandomWaves {
                    radius_of_curvature: _,
                    rms: _,
                    longest: _,
                    shortest: _,
                    hurst: _,
                    count: _,
                    seed: _,
                },
            drawn: _,
        }
        | Shape::Formula(_)
        | Shape::Profile(_) => {}
    }
    assert_eq!(PARAMETERS.iter().map(|row| &row.key).collect::<Vec<_>>(), FIELDS);
}

#[test]
fn every_row_can_be_read_back_after_it_has_been_set() {
    for row in PARAMETERS {
        let mut preset = wavy();
        let value = another(&row.key);
        if let Applies::With { key: "gap.shape", words } = row.applies {
            preset.set("gap.shape", words[0].into()).unwrap();
        }
        if row.fits("units", "SI") && !row.fits("units", "reduced") {
            preset.set("units", "SI".into()).unwrap();
        }
        // Ring elements do not support a range.
        if row.key == ADHESION || matches!(row.applies, Applies::With { key: ADHESION, .. }) {
            preset.set("basis.kind", "exact".into()).unwrap();
        }
        if let Applies::With { key: ADHESION, words: ["capillary"] } = row.applies {
            let liquid =
                [(ADHESION, "capillary".into()), (LIQUID_KEYS[0], 0.5.into()), (LIQUID_KEYS[1], 0.1.into())];
            preset.set_all(liquid).unwrap();
        } else {
            preset.set("material.range_of_action", 0.1.into()).unwrap();
        }
        preset.set(&row.key, value.clone()).unwrap();
        assert_eq!(preset.get(&row.key), Some(value), "{}", row.key);
        assert_eq!(
            preset.reset(&row.key).is_err(),
            row.fallback == Fallback::Required && row.fits("gap.shape", preset.gap.name()),
            "{}",
            row.key
        );
    }
}

#[test]
fn the_table_knows_every_shape() {
    let parameter = parameter("gap.shape").unwrap();
    let Kind::Choice(words) = parameter.kind else { unreachable!("the shape is a choice") };
    let gaps: Vec<&str> = (0..9).map(|which| any_gap(which, 1.0, 0.1, 0.1, 2.0).name()).collect();
    assert_eq!(gaps, words);
}

#[test]
fn every_shape_can_be_chosen_and_left() {
    let Kind::Choice(words) = parameter("gap.shape").unwrap().kind else { unreachable!("a choice") };
    for word in words {
        let mut preset = wavy();
        preset.set("gap.shape", (*word).into()).unwrap();
        assert_eq!((preset.gap.name(), preset.check()), (*word, Ok(())));
        for (row, value) in preset.values() {
            preset.set(&row.key, value).unwrap();
        }
        preset.set("gap.shape", "wavy-sphere".into()).unwrap();
        assert!(preset.gap.wave().is_some(), "{word}");
    }
}

#[test]
fn a_formula_keeps_its_parameters_and_begins_new_ones_with_1() {
    let mut preset = wavy();
    preset.set("gap.shape", "formula".into()).unwrap();
    preset.set("gap.parameters.lambda", 0.1.into()).unwrap();
    preset.set("gap.formula", "r^2/(2*R) + B*(1 - cos(2*pi*r/lambda))".into()).unwrap();
    let value = |preset: &Preset, name| preset.get(&format!("gap.parameters.{name}"));
    assert_eq!(value(&preset, "lambda"), Some(0.1.into()));
    assert_eq!((value(&preset, "A"), value(&preset, "B")), (None, Some(1.0.into())));
    preset.set("gap.parameters.B.max", 2.0.into()).unwrap();
    let large = preset.set("gap.parameters.B", 3.0.into()).unwrap_err().to_string();
    assert!(large.starts_with("gap.parameters.B = 3.0 is out of range: it must be a number from"), "{large}");
    let unknown = preset.set("gap.parameters.lamda", 1.0.into()).unwrap_err().to_string();
    assert!(unknown.ends_with("did you mean gap.parameters.lambda?"), "{unknown}");
    let broken = preset.set("gap.formula", "r^2/(2*R".into()).unwrap_err().to_string();
    assert!(broken.starts_with("gap.formula: column "), "{broken}");
    // Among the rows, ranges have no knob.
    let knobs: Vec<String> = preset.knobs().map(|row| row.key.to_string()).collect();
    assert!(
        knobs.contains(&"gap.parameters.B".to_owned()) && !knobs.contains(&"gap.parameters.B.max".to_owned())
    );
}

#[test]
fn a_start_replaces_another() {
    let mut preset = wavy();
    preset.set("path.start_force", 0.01.into()).unwrap();
    assert_eq!(preset.path.start, Start::Force(0.01));
    assert_eq!(preset.get("path.start_contact_radius"), None);
    preset.reset("path.start_force").unwrap();
    assert_eq!(preset.path.start, Start::ContactRadius(0.5));
}

#[test]
fn a_stiffness_makes_the_device_a_spring_and_goes_with_it() {
    let mut preset = wavy();
    preset.set("path.control.stiffness", 0.15.into()).unwrap();
    assert_eq!(preset.path.control, Control::Stiffness(0.15));
    preset.set("path.control", "force".into()).unwrap();
    assert_eq!(preset.path.control, Control::Force);
    assert_eq!(preset.get("path.control.stiffness"), None);
}

#[test]
fn a_rate_of_a_length_is_none_of_a_force() {
    let mut preset = crate::preset::read("si", include_str!("../../../../presets/fig-9-si.toml")).unwrap();
    let mut set = |assignments: &[(&str, &str)]| {
        let all: Vec<_> =
            assignments.iter().map(|(key, text)| ((*key).to_owned().into(), (*text).to_owned())).collect();
        preset.assign_all(&all).unwrap();
        preset.edge.rate
    };
    assert_eq!(set(&[("edge.exponent", "0.5"), ("edge.reference_speed", "1 um/s")]), None);
    let of_a_length = Some(2e-6);
    assert_eq!(set(&[("path.control", "displacement"), ("path.rate", "2 um/s")]), of_a_length);
    assert_eq!(set(&[("path.control", "stiffness=5 N/m")]), of_a_length);
    // Both together are read in either order.
    assert_eq!(set(&[("path.control", "force")]), None);
    assert_eq!(set(&[("path.rate", "3 uN/s")]), Some(3e-6));
    assert_eq!(set(&[("path.control.stiffness", "5 N/m")]), None);
    assert_eq!(set(&[("path.control", "force"), ("path.rate", "4 uN/s")]), Some(4e-6));
    assert_eq!(set(&[("path.rate", "3e-6"), ("path.control", "displacement")]), Some(3e-6));
    assert_eq!(set(&[("path.rate", "4 uN/s"), ("path.control", "force")]), Some(4e-6));
    let numbers = [("path.rate", 5e-6.into()), ("path.control.stiffness", 5.0.into())];
    preset.set_all(numbers).unwrap();
    assert_eq!(preset.edge.rate, Some(5e-6));
    // In reduced units a number has no unit to lose.
    let mut preset = wavy();
    preset.assign("path.rate", "0.5").unwrap();
    preset.assign("path.control", "force").unwrap();
    assert_eq!(preset.edge.rate, Some(0.5));
}

#[test]
fn a_shape_drops_and_brings_its_keys() {
    let mut preset = wavy();
    preset.set("gap.shape", "sphere".into()).unwrap();
    assert_eq!(preset.gap, Shape::Sphere { radius_of_curvature: 1.0 });
    let wave = preset.set("gap.amplitude", 0.1.into()).unwrap_err();
    assert_eq!(wave.to_string(), "gap.amplitude belongs to gap.shape = wavy-sphere, and the gap is a sphere");
    preset.set("gap.shape", "wavy-sphere".into()).unwrap();
    assert_eq!(preset, wavy());
}

#[test]
fn a_basis_drops_the_keys_of_the_other() {
    let mut preset = wavy();
    preset.set("basis.kind", "exact".into()).unwrap();
    assert_eq!(preset.basis, BasisSpec::Exact);
    assert_eq!(preset.get("basis.rings"), None);
    let few = preset.set("basis.rings", 48.into()).unwrap_err();
    assert_eq!(few.to_string(), "basis.rings belongs to basis.kind = rings, and the basis is exact");
    preset.set("basis.kind", "rings".into()).unwrap();
    assert_eq!(preset, wavy());
}

#[test]
fn adhesion_without_a_range_has_none() {
    for key in ["material.cohesive_range", "material.cohesive_strength"] {
        let mut exact = wavy();
        exact.set("basis.kind", "exact".into()).unwrap();
        let mut preset = exact.clone();
        preset.assign("material.adhesion", "dugdale").unwrap_err();
        preset.assign(key, "0.01").unwrap();
        assert!(matches!(preset.material.adhesion, Adhesion::Dugdale(_)));
        preset.assign(key, "none").unwrap();
        assert_eq!(preset, exact);
        // With the range of action, one range remains.
        for (key, text) in [("material.range_of_action", "0.001"), (key, "0.01"), (key, "none")] {
            preset.assign(key, text).unwrap();
        }
        assert_eq!(preset.material.adhesion, Adhesion::Dugdale(StatedCohesion::Action));
    }
}

#[test]
fn none_takes_a_text_away_too() {
    let mut preset = wavy();
    preset.assign("data.columns", "approach=1,force=2").unwrap();
    for (key, text) in [("data.columns", "none"), ("data.free", "none"), ("data.free_part", "none")] {
        preset.assign(key, text).unwrap();
    }
    let data = &preset.data;
    assert_eq!([&*data.columns, &*data.free, &*data.free_part], ["", "", "none"]);
}

#[test]
fn graded_rings_have_a_bound_of_their_own() {
    let mut preset = wavy();
    preset.set("basis.grading", "edge".into()).unwrap();
    preset.set("basis.rings", 400.into()).unwrap();
    assert_eq!(preset.basis, BasisSpec::Rings { rings: 400, grading: Grading::Edge });
    let many = preset.set("basis.rings", 401.into()).unwrap_err();
    let words = "basis.rings = 401 is out of range: with basis.grading = \"edge\" it must be from 4 to 400";
    assert_eq!(many.to_string(), words);
    preset.reset("basis.grading").unwrap();
    preset.set("basis.rings", 401.into()).unwrap();
    assert_eq!(preset.set("basis.grading", "edge".into()).unwrap_err().to_string(), words);
    preset.set("basis.kind", "exact".into()).unwrap();
    assert_eq!(preset.get("basis.grading"), None);
}

#[test]
fn a_refused_value_changes_nothing() {
    for (key, value, words) in [
        ("gap.amplitude", Value::Number(f64::NAN), "out of range"),
        ("path.end_contact_radius", Value::Number(0.5), "not below path.start_contact_radius"),
        ("path.start_contact_radius", Value::Number(0.001), "not below path.start_contact_radius"),
        ("path.start_contact_radius", Value::Number(11.0), "at most 10 x the radius of curvature"),
        ("gap.radius_of_curvature", Value::Number(0.01), "at most 10 x the radius of curvature"),
        ("gap.lambda", Value::Number(0.1), "did you mean gap.wavelength?"),
    ] {
        let mut preset = wavy();
        let message = preset.set(key, value).unwrap_err().to_string();
        assert!(message.contains(words), "{message}");
        assert_eq!(preset, wavy());
    }
}

#[test]
fn a_preset_made_in_code_is_checked() {
    let mut preset = wavy();
    preset.material.effective_modulus = f64::INFINITY;
    preset.basis = BasisSpec::Rings { rings: 3, grading: Grading::Uniform };
    assert_eq!(preset.check().unwrap_err().len(), 2);
}
