//! The presets that come with the program: the paper's cases and one for every other gap, embedded from the `presets`
//! folder with their data.

use super::measured::{Files, SHIPPED_DATA, rows, words};
use super::profile::parse;
use crate::gap::shapes::ProfileRows;
use crate::text::quote;
use std::path::Path;

/// A preset or a data file that comes with the program.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Shipped {
    /// Its name.
    pub name: &'static str,
    /// Its whole text.
    pub text: &'static str,
}

/// The data that come with the program, for profiles.
pub static DATA: &[Shipped] =
    &[Shipped { name: "rough-sphere.csv", text: include_str!("../../presets/data/rough-sphere.csv") }];

/// The measured curves that come with the program.
pub static CURVES: &[Shipped] =
    &[Shipped { name: "lens.csv", text: include_str!("../../presets/data/lens.csv") }];

/// The shipped curve that `name` refers to, if it begins with [`SHIPPED_DATA`].
///
/// # Errors
/// Which curves there are, in words; `None` for a name without the prefix.
pub fn curve(name: &str) -> Option<Result<&'static str, String>> {
    let wanted = name.strip_prefix(SHIPPED_DATA)?;
    let found = CURVES.iter().find(|shipped| shipped.name == wanted);
    Some(found.map(|shipped| shipped.text).ok_or_else(|| {
        let known: Vec<String> = CURVES.iter().map(|data| format!("{SHIPPED_DATA}{}", data.name)).collect();
        format!("\"{}\" does not come with the program; there is {}", quote(name), known.join(", "))
    }))
}

/// The shipped data of this name.
pub fn data(name: &str) -> Option<&'static str> {
    DATA.iter().find(|shipped| shipped.name == name).map(|shipped| shipped.text)
}

/// The rows of the shipped data that `name` refers to.
fn shipped_rows(folder: Option<&Path>, name: &str) -> Result<ProfileRows, String> {
    let Some(wanted) = name.strip_prefix(SHIPPED_DATA) else { return (Files::NONE.rows)(folder, name) };
    let text = data(wanted).ok_or_else(|| {
        let known: Vec<String> = DATA.iter().map(|data| format!("{SHIPPED_DATA}{}", data.name)).collect();
        format!("\"{}\" does not come with the program; there is {}", quote(name), known.join(", "))
    })?;
    rows(folder, name, parse(text.as_bytes()).map_err(|error| words(&error))?)
}

/// The bytes of the shipped curve that `name` refers to.
fn shipped_points(folder: Option<&Path>, name: &str) -> Result<Vec<u8>, String> {
    curve(name)
        .unwrap_or_else(|| (Files::NONE.points)(folder, name).map(|_| ""))
        .map(|text| text.as_bytes().to_vec())
}

impl Files {
    /// The data that come with the program, and no other files.
    pub const SHIPPED: Self = Self { rows: shipped_rows, points: shipped_points };
}

/// The preset opened when none is named.
pub const DEFAULT: &str = "wavy-sphere";

/// The presets that come with the program, the default first.
pub static SHIPPED: &[Shipped] = &[
    Shipped { name: DEFAULT, text: include_str!("../../presets/wavy-sphere.toml") },
    Shipped { name: "fig-1-hertz", text: include_str!("../../presets/fig-1-hertz.toml") },
    Shipped { name: "fig-3-jkr", text: include_str!("../../presets/fig-3-jkr.toml") },
    Shipped { name: "fig-8", text: include_str!("../../presets/fig-8.toml") },
    Shipped { name: "fig-9", text: include_str!("../../presets/fig-9.toml") },
    Shipped { name: "fig-9-si", text: include_str!("../../presets/fig-9-si.toml") },
    Shipped { name: "fig-10-force", text: include_str!("../../presets/fig-10-force.toml") },
    Shipped { name: "fig-9-cycle", text: include_str!("../../presets/fig-9-cycle.toml") },
    Shipped { name: "fig-9-weak", text: include_str!("../../presets/fig-9-weak.toml") },
    Shipped { name: "exact-sphere", text: include_str!("../../presets/exact-sphere.toml") },
    Shipped { name: "cone", text: include_str!("../../presets/cone.toml") },
    Shipped { name: "power-law", text: include_str!("../../presets/power-law.toml") },
    Shipped { name: "harmonics", text: include_str!("../../presets/harmonics.toml") },
    Shipped { name: "crater", text: include_str!("../../presets/crater.toml") },
    Shipped { name: "random-waves", text: include_str!("../../presets/random-waves.toml") },
    Shipped { name: "formula", text: include_str!("../../presets/formula.toml") },
    Shipped { name: "profile", text: include_str!("../../presets/profile.toml") },
    Shipped { name: "lens", text: include_str!("../../presets/lens.toml") },
];

/// The shipped preset of this name.
pub fn find(name: &str) -> Option<&'static Shipped> {
    SHIPPED.iter().find(|shipped| shipped.name == name)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gap::Shape;
    use crate::preset::model::{BasisSpec, Preset, is_of_units};
    use crate::preset::read_in;
    use crate::preset::schema::Row;
    use crate::preset::shape::is_range;
    use crate::problem::{Control, Groups, Start};
    use crate::ritz::Grading;
    use std::collections::BTreeSet;

    /// How many ranges its parameters have.
    fn ranges(preset: &Preset) -> usize {
        let keys = preset.values().into_iter().filter(|(row, _)| is_range(&row.key));
        keys.count()
    }

    fn load(name: &str) -> Preset {
        read_in(Files::SHIPPED, None, name, find(name).unwrap().text, &[] as &[&str]).unwrap()
    }

    #[test]
    fn every_file_of_the_folder_is_shipped_and_says_what_to_look_at() {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/presets");
        let files: BTreeSet<_> = std::fs::read_dir(folder)
            .unwrap()
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            // The profiles that presets name are in a folder of their own.
            .filter(|name| name != "data")
            .collect();
        let names: BTreeSet<_> = SHIPPED.iter().map(|shipped| format!("{}.toml", shipped.name)).collect();
        assert_eq!(files, names);
        for shipped in SHIPPED {
            let preset = load(shipped.name);
            assert!(shipped.text.starts_with("# ") && !preset.title.is_empty());
            // The paper's figures use the paper's discretization, the others the exact one.
            let turns = preset.path.turn.is_some();
            let basis = if shipped.name.starts_with("fig-") && !turns {
                BasisSpec::Rings { rings: 200, grading: Grading::Uniform }
            } else {
                BasisSpec::Exact
            };
            assert_eq!(preset.basis, basis);
            assert!(preset.path.end_contact_radius.is_some());
            // Complete: every key that applies is in the file.
            for (row, _) in preset.values().into_iter().filter(|(row, _)| !is_range(&row.key)) {
                assert!(
                    shipped.text.contains(&format!("\n{} = ", row.name())),
                    "{} {}",
                    shipped.name,
                    row.key
                );
            }
            // Of the rows that apply here, two of three starts, the turns, the stiffness, the range of action and the
            // keys of a measured curve may be missing.
            let data = preset
                .rows()
                .filter(|row| row.table() == Some("data") && preset.get(&row.key).is_none())
                .count();
            let kind = preset.get("basis.kind").unwrap().to_string();
            let is_spring = matches!(preset.path.control, Control::Stiffness(_));
            let fits = |row: &Row| row.fits("gap.shape", preset.gap.name()) && row.fits("basis.kind", &kind);
            // The knobs leave out the format, the units and their display, and which contacts are followed.
            let units = preset
                .values()
                .iter()
                .filter(|(row, _)| matches!(&*row.key, "format" | "path.contact") || is_of_units(&row.key))
                .count();
            assert_eq!(
                preset.values().len() + 7 + data - usize::from(turns) - usize::from(is_spring),
                ranges(&preset) + preset.knobs().filter(fits).count() + units
            );
        }
    }

    #[test]
    fn they_are_the_cases_of_the_paper() {
        let adhesion = |name| Groups::of(&load(name).problem(), None, None).adhesion.unwrap();
        for (name, expected) in [
            ("fig-1-hertz", 0.0),
            ("fig-3-jkr", 0.05),
            ("fig-8", 0.05),
            ("fig-9", 0.025),
            ("fig-10-force", 0.025),
        ] {
            assert!((adhesion(name) - expected).abs() < 1e-16, "{name}");
        }
        let fig9 = load("fig-9");
        assert_eq!(
            fig9.gap,
            Shape::WavySphere { radius_of_curvature: 1.0, amplitude: 0.0025, wavelength: 0.05 }
        );
        assert_eq!(fig9.path.start, Start::ContactRadius(0.5));
        let mut force = load("fig-10-force");
        assert_eq!(force.path.control, Control::Force);
        (force.path.control, force.title) = (Control::Displacement, fig9.title.clone());
        assert_eq!(force, fig9);
        let mut default = load(DEFAULT);
        assert_eq!(default.path.start, Start::ContactRadius(0.41));
        (default.path.start, default.title, default.basis) =
            (fig9.path.start, fig9.title.clone(), fig9.basis);
        assert_eq!(default, fig9);
        assert_eq!(
            load("fig-8").gap,
            Shape::WavySphere { radius_of_curvature: 1.0, amplitude: 0.001, wavelength: 0.1 }
        );
    }
}
