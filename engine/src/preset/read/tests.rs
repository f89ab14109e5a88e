//! What a preset file and its assignments may contain, and how each mistake is reported.

mod assignments;
mod families;
mod hostile;
mod mistakes;

use super::*;
use crate::gap::Shape;
use crate::preset::model::BasisSpec;
use crate::problem::{Control, Start};

const WAVY: &str = r#"format = 1
title = "Wavy sphere, A/λ = 0.05"
[material]
effective_modulus = 1.0
work_of_adhesion = 0.003978873577297384
[gap]
shape = "wavy-sphere"
radius_of_curvature = 1.0
amplitude = 0.0025
wavelength = 0.05
[basis]
kind = "rings"
rings = 200
[path]
control = "displacement"
start_contact_radius = 0.5
end_contact_radius = 0.002
"#;

fn messages(text: &str, assignments: &[&str]) -> Vec<String> {
    read_with("w.toml", text, assignments).unwrap_err().mistakes.iter().map(ToString::to_string).collect()
}

/// The one mistake in the file with `old` replaced by `new`.
fn edited(old: &str, new: &str) -> String {
    assert!(WAVY.contains(old), "{old}");
    let all = messages(&WAVY.replacen(old, new, 1), &[]);
    assert_eq!(all.len(), 1, "{all:?}");
    all[0].clone()
}

fn set(assignments: &[&str]) -> Preset {
    read_with("w.toml", WAVY, assignments).unwrap()
}

#[test]
fn the_contract_reads() {
    let preset = read("w.toml", WAVY).unwrap();
    assert_eq!(preset.title, "Wavy sphere, A/λ = 0.05");
    assert_eq!(
        preset.gap,
        Shape::WavySphere { radius_of_curvature: 1.0, amplitude: 0.0025, wavelength: 0.05 }
    );
    assert_eq!(preset.path.start, Start::ContactRadius(0.5));
    assert_eq!(preset.path.end_contact_radius, Some(0.002));
    let spring = WAVY.replace("\"displacement\"", "{ stiffness = 0.15 }");
    assert_eq!(read("w.toml", &spring).unwrap().path.control, Control::Stiffness(0.15));
    let dotted = WAVY.replace("control = \"displacement\"", "control.stiffness = 2");
    assert_eq!(read("w.toml", &dotted).unwrap().path.control, Control::Stiffness(2.0));
    assert_eq!(read("w.toml", &WAVY.replace('\n', "\r\n")).unwrap(), preset);
    assert_eq!(read("w.toml", &format!("\u{feff}{WAVY}")).unwrap(), preset);
}

#[test]
fn material_and_gap_are_enough() {
    let end = WAVY.find("[basis]").unwrap();
    let preset = read("w.toml", &WAVY[..end]).unwrap();
    assert_eq!(preset.basis, BasisSpec::Exact);
    assert_eq!(preset.path.start, Start::ContactRadius(0.5));
}
