//! Values → preset: defaults, required keys, and the checks that span several keys.
//!
//! Every preset is made here, whether it comes from a file, from `--set` or from a key press on the screen.

use super::given::GivenValues;
use super::invalid::Invalid;
use super::measured::Files;
use super::model::{BasisSpec, Material, PathSpec, Preset};
use super::resolve::{resolved, shown, system};
use super::schema::{RADIUS_OVER_CURVATURE, START_KEYS, START_OVER_CURVATURE, TURN_KEYS};
use super::shape;
use super::values::Values;
use crate::gap::Gap;
use crate::problem::Turn;
use crate::problem::{Adhesion, Begin, ContactKind, Start};
use crate::units::Quantity;

/// The preset that these values make.
///
/// # Errors
/// Everything that is wrong, at least one fault.
pub fn build(values: &Values, files: Files) -> Result<Preset, Vec<Invalid>> {
    let mut faults = Vec::new();
    let units = system(values, &mut faults);
    let values = &resolved(values, &units, &mut faults);
    let mut given = GivenValues { values, units: units.clone(), files, faults };
    given.check_each();
    given.check_choices();
    let mut given_of = |keys: [&'static str; 3], does| {
        let those: Vec<_> = keys.into_iter().filter(|key| values.contains_key(*key)).collect();
        if let [first, second, ..] = those[..] {
            given.faults.push(Invalid::Rivals { first: first.into(), second: second.into(), does });
        }
        those
    };
    let (starts, turns) =
        (given_of(START_KEYS, "where the path starts"), given_of(TURN_KEYS, "where the path turns round"));
    let gap = given.shape(starts.first().copied());
    let start = match starts.first() {
        Some(&key) if key == START_KEYS[1] => Start::Approach(given.number(key)),
        Some(&key) if key == START_KEYS[2] => Start::Force(given.number(key)),
        Some(&key) => Start::ContactRadius(given.number(key)),
        None => Start::ContactRadius(match gap.radius_of_curvature() {
            Some(radius) => START_OVER_CURVATURE * radius,
            None => given.required(START_KEYS[0]),
        }),
    };
    let turn = turns.first().map(|&key| {
        let value = given.number(key);
        match key {
            key if key == TURN_KEYS[0] => Turn::Approach(value),
            key if key == TURN_KEYS[1] => Turn::Force(value),
            _ => Turn::Radius(value),
        }
    });
    let mut control = given.control("path.control");
    let edge = given.edge();
    let data = given.data(&mut control, gap.radius_of_curvature());
    let (adhesion, work_of_adhesion) = given.adhesion();
    let (end, range) = ("path.end_contact_radius", "material.range_of_action");
    let preset = Preset {
        title: given.text("title"),
        units,
        material: Material {
            effective_modulus: given.number("material.effective_modulus"),
            work_of_adhesion,
            range_of_action: values.contains_key(range).then(|| given.number(range)),
            adhesion,
        },
        gap,
        basis: given.basis(),
        path: PathSpec {
            control,
            start,
            end_contact_radius: values.contains_key(end).then(|| given.number(end)),
            begin: if given.text("path.begin") == Begin::Apart.name() { Begin::Apart } else { Begin::Disc },
            contact: if given.text("path.contact") == ContactKind::OneDisc.name() {
                ContactKind::OneDisc
            } else {
                ContactKind::Rings
            },
            turn,
        },
        edge,
        data,
        files,
    };
    let mut faults = given.collapsed();
    if faults.is_empty() {
        faults = across(&preset);
    }
    if faults.is_empty() { Ok(preset) } else { Err(faults) }
}

impl Preset {
    /// Checks every value and every pair of values; for a preset made in code.
    ///
    /// # Errors
    /// Everything that is wrong with it.
    pub fn check(&self) -> Result<(), Vec<Invalid>> {
        build(&self.keyed(), self.files).map(|_| ())
    }
}

/// The checks that span several keys.
fn across(preset: &Preset) -> Vec<Invalid> {
    let radius = preset.gap.radius_of_curvature();
    let known = preset.gap.largest_radius();
    let mut faults = Vec::new();
    let length = |x| shown(&preset.units, Quantity::Length, x);
    faults.extend(shape::falls_throughout(preset));
    faults.extend(preset.edge.faults(preset));
    let Material { adhesion, work_of_adhesion, .. } = preset.material;
    if adhesion != Adhesion::ShortRange && preset.cohesion().is_none() {
        let needs = if work_of_adhesion > 0.0 {
            "material.cohesive_strength or material.cohesive_range, either of which selects it too, or \
             material.range_of_action"
        } else {
            "a material.work_of_adhesion above 0"
        };
        faults.push(Invalid::Rangeless { word: adhesion.name(), needs });
    }
    if adhesion != Adhesion::ShortRange && preset.basis != BasisSpec::Exact {
        let needs = "basis.kind = \"exact\": ring elements have no range";
        faults.push(Invalid::Rangeless { word: adhesion.name(), needs });
    }
    let end = preset.path.end_contact_radius;
    let start = match preset.path.start {
        Start::ContactRadius(s) => Some(s),
        Start::Approach(_) | Start::Force(_) => None,
    };
    let turn = match preset.path.turn {
        Some(Turn::Radius(radius)) => Some(radius),
        _ => None,
    };
    for (key, value) in [(START_KEYS[0], start), ("path.end_contact_radius", end), (TURN_KEYS[2], turn)] {
        let Some(value) = value else { continue };
        if let Some(radius) = radius.filter(|radius| value > RADIUS_OVER_CURVATURE * radius) {
            let (value, radius) = (length(value), length(radius));
            faults.push(Invalid::Wide { key: key.into(), value, radius });
        } else if let Some(largest) = known.filter(|largest| value >= *largest) {
            let (value, largest) = (length(value), length(largest));
            faults.push(Invalid::Beyond { key: key.into(), value, largest });
        }
    }
    if let BasisSpec::Rings { rings, grading } = preset.basis
        && !grading.ring_range().contains(&rings)
    {
        faults.push(Invalid::Rings { key: "basis.rings".into(), rings, grading });
    }
    if let (Some(start), Some(end)) = (start, end)
        && end >= start
    {
        let (end, start) = (length(end), length(start));
        faults.push(Invalid::EndBeyondStart { key: "path.end_contact_radius".into(), end, start });
    }
    faults
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::preset::value::Value;
    use crate::problem::Control;
    use crate::ritz::Grading;

    fn values(pairs: &[(&'static str, Value)]) -> Values {
        pairs.iter().map(|(key, value)| ((*key).into(), value.clone())).collect()
    }

    #[test]
    fn defaults_are_the_documented_ones() {
        let preset = build(
            &values(&[
                ("material.effective_modulus", 2.0.into()),
                ("material.work_of_adhesion", 0.0.into()),
                ("gap.shape", "sphere".into()),
                ("gap.radius_of_curvature", 3.0.into()),
            ]),
            Files::NONE,
        )
        .unwrap();
        assert_eq!(preset.basis, BasisSpec::Exact);
        assert_eq!(preset.path.control, Control::Displacement);
        assert_eq!(preset.path.start, Start::ContactRadius(1.5));
        assert_eq!(preset.path.end_contact_radius, None);
    }

    #[test]
    fn a_count_alone_says_which_basis_is_meant() {
        let sphere = [
            ("material.effective_modulus", 2.0.into()),
            ("material.work_of_adhesion", 0.0.into()),
            ("gap.shape", "sphere".into()),
            ("gap.radius_of_curvature", 3.0.into()),
        ];
        let with = |key, value: Value| {
            build(&values(&[&sphere[..], &[(key, value)]].concat()), Files::NONE).map(|p| p.basis)
        };
        let rings = |rings| BasisSpec::Rings { rings, grading: Grading::Uniform };
        assert_eq!(with("basis.rings", 70.into()), Ok(rings(70)));
        assert_eq!(with("basis.kind", "rings".into()), Ok(rings(200)));
        assert_eq!(with("basis.kind", "exact".into()), Ok(BasisSpec::Exact));
    }

    #[test]
    fn all_that_is_wrong_is_said() {
        let faults = build(
            &values(&[
                ("gap.shape", "sphere".into()),
                ("gap.amplitude", 1.0.into()),
                ("path.start_force", 1.0.into()),
                ("path.start_approach", 1.0.into()),
            ]),
            Files::NONE,
        )
        .unwrap_err();
        let lines: Vec<_> = faults.iter().map(ToString::to_string).collect();
        assert_eq!(
            lines,
            [
                "gap.amplitude belongs to gap.shape = wavy-sphere, and the gap is a sphere",
                "path.start_force and path.start_approach both set where the path starts: give exactly one",
                "gap.radius_of_curvature is missing: it must be a number from 1e-30 to 1e30",
                "the table [material] is missing: it needs effective_modulus, work_of_adhesion",
            ]
        );
    }
}
