//! Presets in reduced units, and the tables of the paper's wavy spheres.

use pulloff_engine::gap::Shape;
use pulloff_engine::preset::{BasisSpec, Material, PathSpec, Preset};
use pulloff_engine::problem::{Adhesion, ContactKind, Control, Problem, Start};
use serde_json::Value;

/// A preset with this E* and γ, whose path starts with a disc.
pub fn reduced(
    [effective_modulus, work_of_adhesion]: [f64; 2],
    gap: Shape,
    basis: BasisSpec,
    (control, start, contact): (Control, Start, ContactKind),
) -> Preset {
    let adhesion = Adhesion::ShortRange;
    let material = Material { effective_modulus, work_of_adhesion, range_of_action: None, adhesion };
    let preset = Preset::new(material, gap, start);
    let path = PathSpec { control, contact, ..preset.path };
    Preset { basis, path, files: pulloff::store::FILES, ..preset }
}

/// A table of `tests/data` with its problem.
pub fn reference(text: &str) -> (Value, Problem) {
    let data: Value = serde_json::from_str(text).unwrap();
    let number = |value: &Value| value.as_f64().unwrap();
    let profile = &data["case"]["profile"];
    let problem = Problem {
        effective_modulus: 1.0,
        work_of_adhesion: number(&data["case"]["w"]),
        shape: Shape::WavySphere {
            radius_of_curvature: number(&profile["R"]),
            amplitude: number(&profile["A"]),
            wavelength: number(&profile["lambda"]),
        },
    };
    (data, problem)
}
