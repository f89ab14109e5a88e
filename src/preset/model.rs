//! The preset: a problem, the basis it is solved in, and the path to follow.

use super::build::{Values, build, in_units};
use super::family;
use super::groups;
use super::invalid::Invalid;
use super::measured;
use super::schema::{
    AUTO, CHOOSERS, DISPLAY, END_OVER_START, FORMAT, Fallback, Kind, PARAMETERS, Parameter, Row, START_KEYS,
    SYSTEMS, parameter,
};
use super::shape;
use super::suggest::closest_key;
use super::text::quote;
use super::value::Value;
use crate::contact::shapes::Measured;
use crate::contact::{Control, Problem, Reduced, Shape, Start};
use crate::ritz::Grading;
use crate::units::{Quantity, UnitSystem, parse_quantity};
use std::path::Path;
use std::sync::Arc;

/// What a preset file says, complete and checked.
#[derive(Debug, Clone, PartialEq)]
pub struct Preset {
    /// One line that says what the preset shows.
    pub title: String,
    /// The units in which it is typed and shown; every number in it is in SI or in reduced units.
    pub units: UnitSystem,
    /// The bodies.
    pub material: Material,
    /// The gap between the undeformed bodies.
    pub gap: Shape,
    /// The functions in which the contact pressure is sought.
    pub basis: BasisSpec,
    /// Where to start, what to control, where to end.
    pub path: PathSpec,
}

/// The bodies and their adhesion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Material {
    /// E*, a stress.
    pub effective_modulus: f64,
    /// γ, the work of adhesion, a stress times a length.
    pub work_of_adhesion: f64,
    /// z₀, the range of action of the adhesion, a length; `None` leaves it to [`Preset::range_of_action`].
    pub range_of_action: Option<f64>,
}

/// z₀ in metres where an SI preset does not give it: a few atoms.
const RANGE_OF_ACTION: f64 = 0.3e-9;

/// The basis of the contact pressure.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BasisSpec {
    /// Ring elements of constant pressure.
    Rings {
        /// Their number N, from 4 to 2000; with edge grading to 400.
        rings: usize,
        /// How they are spaced.
        grading: Grading,
    },
    /// Eigenfunctions of the half-space operator.
    Spectral {
        /// Their number.
        functions: Functions,
    },
}

/// A number of eigenfunctions.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Functions {
    /// Enough for the waves in the largest contact.
    Auto,
    /// This many, from 4 to 4096.
    Count(usize),
}

/// The path through the equilibrium states.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PathSpec {
    /// What the loading device prescribes.
    pub control: Control,
    /// The state at which the path starts.
    pub start: Start,
    /// The contact radius at which the path ends; `None` leaves it to follow the start
    /// (see [`Preset::end_contact_radius`]).
    pub end_contact_radius: Option<f64>,
}

/// The key that says a start.
#[must_use]
pub fn start_key(start: Start) -> &'static str {
    match start {
        Start::ContactRadius(_) => START_KEYS[0],
        Start::Approach(_) => START_KEYS[1],
        Start::Force(_) => START_KEYS[2],
    }
}

impl Preset {
    /// The contact problem of this preset.
    #[must_use]
    pub fn problem(&self) -> Problem {
        Problem {
            effective_modulus: self.material.effective_modulus,
            work_of_adhesion: self.material.work_of_adhesion,
            shape: self.gap.clone(),
        }
    }

    /// The same in reduced units. A gap without a length of its own is reduced by the contact radius at the start, where
    /// that is given.
    #[must_use]
    pub fn reduced(&self) -> Reduced {
        let problem = self.problem();
        match (self.gap.length(), self.path.start) {
            (None, Start::ContactRadius(start)) => problem.reduced_by(start),
            _ => problem.reduced(),
        }
    }

    /// z₀, the range of action of the adhesion: the one the preset says, 0.3 nm in SI, none in reduced units.
    #[must_use]
    pub fn range_of_action(&self) -> Option<f64> {
        let usual = matches!(self.units, UnitSystem::Si(_)).then_some(RANGE_OF_ACTION);
        self.material.range_of_action.or(usual)
    }

    /// The contact radius at which the path ends, given that it starts at `start_contact_radius`:
    /// the one the preset says, or a fixed fraction of the start.
    #[must_use]
    pub fn end_contact_radius(&self, start_contact_radius: f64) -> f64 {
        self.path.end_contact_radius.unwrap_or(END_OVER_START * start_contact_radius)
    }

    /// The value of a dotted key; `None` if the key is unknown, does not apply to this preset or is left
    /// to follow from others.
    #[must_use]
    pub fn get(&self, key: &str) -> Option<Value> {
        let Self { title, units, material, gap, basis, path } = self;
        Some(match key {
            "format" => FORMAT.into(),
            "title" => title.as_str().into(),
            // Reduced units are what a preset has when it says nothing.
            "units" => match units {
                UnitSystem::Reduced => return None,
                UnitSystem::Si(_) => SYSTEMS[1].into(),
            },
            key if key.starts_with("display.") => {
                let (_, quantity) = DISPLAY.iter().find(|(known, _)| *known == key)?;
                units.unit(*quantity)?.ascii().as_str().into()
            }
            "material.effective_modulus" => material.effective_modulus.into(),
            "material.work_of_adhesion" => material.work_of_adhesion.into(),
            "material.range_of_action" => material.range_of_action?.into(),
            key if key.starts_with("gap.") => return shape::get(gap, key),
            "basis.kind" => match basis {
                BasisSpec::Rings { .. } => "rings".into(),
                BasisSpec::Spectral { .. } => "spectral".into(),
            },
            "basis.rings" | "basis.functions" => match (key, *basis) {
                ("basis.rings", BasisSpec::Rings { rings: n, .. })
                | ("basis.functions", BasisSpec::Spectral { functions: Functions::Count(n) }) => {
                    i64::try_from(n).ok()?.into()
                }
                ("basis.functions", BasisSpec::Spectral { functions: Functions::Auto }) => AUTO.into(),
                _ => return None,
            },
            "basis.grading" => match basis {
                BasisSpec::Rings { grading, .. } => grading.name().into(),
                BasisSpec::Spectral { .. } => return None,
            },
            key if groups::row(key).is_some() => return groups::get(self, key),
            "path.control" => path.control.into(),
            "path.control.stiffness" => match path.control {
                Control::Stiffness(k) => k.into(),
                Control::Displacement | Control::Force => return None,
            },
            "path.end_contact_radius" => path.end_contact_radius?.into(),
            key if key == start_key(path.start) => path.start.value().into(),
            _ => return None,
        })
    }

    /// The rows of this preset, in the order in which files and screens show them: those of the table, and those
    /// that it makes itself.
    pub fn rows(&self) -> impl Iterator<Item = Row> {
        let after = PARAMETERS.iter().rposition(|row| row.table() == Some("gap")).map_or(0, |last| last + 1);
        let (before, rest) = PARAMETERS.split_at(after);
        let own = shape::rows(&self.gap).into_iter().map(Row::Owned);
        before.iter().map(Row::Borrowed).chain(own).chain(rest.iter().map(Row::Borrowed))
    }

    /// The row of a key: with the range that this preset gives it, where it does.
    #[must_use]
    pub fn row(&self, key: &str) -> Option<Row> {
        self.rows()
            .find(|row| row.key == key)
            .or_else(|| parameter(key))
            .or_else(|| groups::row(key).map(Row::Borrowed))
    }

    /// The rows that are turned and typed on a screen: all but the format, the units, the ranges of parameters, and the waves
    /// after the first [`WAVE_KNOBS`](family::WAVE_KNOBS).
    pub fn knobs(&self) -> impl Iterator<Item = Row> {
        self.rows().filter(|row| {
            row.key != "format"
                && !is_of_units(&row.key)
                && !shape::is_range(&row.key)
                && family::has_knob(&row.key)
        })
    }

    /// The rows that have a value in this preset, in the order of [`rows`](Self::rows), with their values.
    #[must_use]
    pub fn values(&self) -> Vec<(Row, Value)> {
        self.rows().filter_map(|row| self.get(&row.key).map(|value| (row, value))).collect()
    }

    /// Gives a key another value.
    ///
    /// A start replaces another start; `path.control.stiffness` makes the device a spring; a `gap.shape` drops
    /// the keys of the old shape, and takes for its waves the proportions of the paper's Fig. 9; a `gap.formula` keeps the
    /// parameters it has in common with the old one, its others begin with 1; a `basis.kind` drops the keys of the old
    /// basis, and takes the defaults of its own. A group (see [`groups`]) changes what it follows from. A `gap.file` is read here, relative to the folder of the one before.
    ///
    /// # Errors
    /// The key is unknown, or the preset would no longer be valid; it is left as it was.
    pub fn set(&mut self, key: &str, value: Value) -> Result<(), Invalid> {
        self.set_all([(key, value)])
    }

    /// Gives several keys other values at once: the whole is checked when all are laid down, choices first, and groups
    /// are made last in their order, as assignments on the command line are.
    ///
    /// # Errors
    /// As [`set`](Self::set).
    pub fn set_all<'a>(
        &mut self,
        changes: impl IntoIterator<Item = (&'a str, Value)>,
    ) -> Result<(), Invalid> {
        let (mut plain, mut grouped) = (Vec::new(), Vec::new());
        for (key, value) in changes {
            let row = self.row(key).ok_or_else(|| self.unknown_key(key))?;
            let value = row.check(self.located(&row, value)?)?;
            let list = if groups::row(key).is_some() { &mut grouped } else { &mut plain };
            list.push((row, value));
        }
        plain.sort_by_key(|(row, _)| !CHOOSERS.contains(&&*row.key));
        let mut changed = self.clone();
        if !plain.is_empty() {
            let mut values = self.keyed();
            for (row, value) in plain {
                self.lay(&mut values, &row, value);
            }
            changed = build(&values).map_err(|mut all| all.swap_remove(0))?;
        }
        for (row, value) in grouped {
            changed.set_group(&row, value)?;
        }
        *self = changed;
        Ok(())
    }

    /// Lays a value over the others, with what it drops and begins.
    fn lay(&self, values: &mut Values, row: &Parameter, value: Value) {
        if CHOOSERS.contains(&&*row.key) {
            values.retain(|key, _| {
                parameter(key).is_some_and(|other| other.fits(&row.key, &value.to_string()))
            });
        }
        match &*row.key {
            "gap.shape" => {
                let radius = self.gap.length().unwrap_or_else(|| self.reduced().units.length);
                shape::begin(values, &value.to_string(), radius, self.gap.wave());
            }
            key if START_KEYS.contains(&key) => values.retain(|key, _| !START_KEYS.contains(&&**key)),
            _ => {}
        }
        put(values, row, value);
        if row.key == "gap.formula" {
            shape::fit_parameters(values, |_| false);
        }
    }

    /// A value of a key as this preset would keep it: in the range of its row, a text with a unit read in the preset's
    /// units. What other keys say to it is not asked.
    ///
    /// # Errors
    /// The key is unknown, or does not take the value.
    pub fn resolved(&self, key: &str, value: Value) -> Result<Value, Invalid> {
        let row = self.row(key).ok_or_else(|| self.unknown_key(key))?;
        let Value::Typed(text) = row.check(value.clone())? else { return row.check(value) };
        let cause = |cause| Invalid::Units { key: row.key.clone(), cause };
        let x = if groups::row(key).is_some() {
            parse_quantity(&text).and_then(|typed| typed.in_si(Quantity::Number, None))
        } else {
            in_units(&self.keyed(), &self.units, key, &text)
        };
        let x = x.map_err(cause)?;
        row.check(if row.kind == Kind::Control { Control::Stiffness(x).into() } else { x.into() })
    }

    fn set_group(&mut self, row: &Parameter, value: Value) -> Result<(), Invalid> {
        let x = match value {
            Value::Number(x) => x,
            other => {
                let text = other.to_string();
                let cause = |cause| Invalid::Units { key: row.key.clone(), cause };
                parse_quantity(&text).and_then(|typed| typed.in_si(Quantity::Number, None)).map_err(cause)?
            }
        };
        let mut changed = self.clone();
        for (key, value) in groups::changes(self, row, x)? {
            changed.set(&key, value)?;
        }
        *self = changed;
        Ok(())
    }

    /// Gives a key the value of a text, as an assignment on the command line does: in SI a bare number is SI.
    ///
    /// # Errors
    /// As [`Parameter::parse`] and [`Preset::set`].
    pub fn assign(&mut self, key: &str, text: &str) -> Result<(), Invalid> {
        let row = self.row(key).ok_or_else(|| self.unknown_key(key))?;
        let value = row.parse(text)?;
        self.set(key, value)
    }

    /// The value of a row as a person types it beside its unit: in SI a bare number counts in the unit shown there.
    ///
    /// # Errors
    /// As [`Parameter::parse`].
    pub fn typed(&self, row: &Parameter, text: &str) -> Result<Value, Invalid> {
        let quantity = if row.kind == Kind::Control { Quantity::ForcePerLength } else { row.quantity };
        let (Some(unit), true) =
            (self.units.unit(quantity), row.kind.is_number() || row.kind == Kind::Control)
        else {
            return row.parse(text);
        };
        let number = text.trim();
        let number = if row.kind == Kind::Control {
            number.strip_prefix("stiffness=").unwrap_or(number)
        } else {
            number
        };
        match parse_quantity(number) {
            Ok(value) if value.unit.is_none() => row.parse(&format!("{number} {}", unit.ascii())),
            _ => row.parse(text),
        }
    }

    /// Lets an optional key follow from others again, or takes its default.
    ///
    /// # Errors
    /// The key is unknown or required.
    pub fn reset(&mut self, key: &str) -> Result<(), Invalid> {
        let row = self.row(key).ok_or_else(|| self.unknown_key(key))?;
        let mut values = self.keyed();
        let parent = row.table().filter(|_| row.is_part());
        values.remove(parent.unwrap_or(&row.key));
        if let (Fallback::Text(word), true) = (row.fallback, CHOOSERS.contains(&&*row.key)) {
            values.retain(|key, _| parameter(key).is_some_and(|other| other.fits(&row.key, word)));
        }
        *self = build(&values).map_err(|mut all| all.swap_remove(0))?;
        Ok(())
    }

    /// The same preset for a file in `folder`: the name of a profile's file becomes relative to it where the file lies in
    /// it or below, else absolute.
    #[must_use]
    pub fn placed_in(&self, folder: &Path) -> Self {
        let mut preset = self.clone();
        if let Shape::Profile(measured) = &self.gap {
            let rows = measured.rows();
            let own = rows.folder.as_deref().unwrap_or(Path::new("."));
            let is_same = std::path::absolute(own).ok() == std::path::absolute(folder).ok();
            let stays = rows.name.starts_with(measured::SHIPPED_DATA)
                || (is_same && Path::new(&rows.name).is_relative());
            if let (false, Ok(path), Ok(folder)) =
                (stays, std::path::absolute(own.join(&rows.name)), std::path::absolute(folder))
                && let Some(name) = path.strip_prefix(folder).unwrap_or(&path).to_str()
                && !name.starts_with(measured::SHIPPED_DATA)
            {
                let moved = Measured::clone(measured).named(name.to_owned());
                preset.gap = Shape::Profile(Arc::new(moved));
            }
        }
        preset
    }

    /// Checks every value and every pair of values; for a preset made in code.
    ///
    /// # Errors
    /// All that is wrong with it.
    pub fn check(&self) -> Result<(), Vec<Invalid>> {
        build(&self.keyed()).map(|_| ())
    }

    /// A value as it is to be checked: the name of a file stands for its rows, read from the folder of those before.
    fn located(&self, row: &Parameter, value: Value) -> Result<Value, Invalid> {
        match (value, &self.gap) {
            (Value::Text(name), Shape::Profile(measured)) if row.kind == Kind::File => {
                let cause = |cause| Invalid::Gap { key: row.key.clone(), cause };
                let rows = measured::load(measured.rows().folder.as_deref(), &name).map_err(cause)?;
                Ok(Value::Profile(Arc::new(rows)))
            }
            (value, _) => Ok(value),
        }
    }

    fn unknown_key(&self, key: &str) -> Invalid {
        let rows: Vec<Row> = self.rows().chain(groups::GROUPS.iter().map(Row::Borrowed)).collect();
        let meant = closest_key(key, rows.iter().map(|row| (&*row.key, &*row.label)));
        Invalid::UnknownKey { key: quote(key), meant: meant.map(|key| key.to_owned().into()) }
    }

    fn keyed(&self) -> Values {
        self.values()
            .into_iter()
            .filter(|(row, _)| !row.is_part())
            .map(|(row, v)| (row.key.clone(), v))
            .collect()
    }
}

/// Whether a key says units, not the problem.
#[must_use]
pub fn is_of_units(key: &str) -> bool {
    key == CHOOSERS[2] || DISPLAY.iter().any(|(known, _)| *known == key)
}

/// Stores a checked value; a part of a value becomes the whole.
pub(super) fn put(values: &mut Values, row: &Parameter, value: Value) {
    match (&*row.key, value) {
        ("path.control.stiffness", Value::Number(k)) => {
            values.insert("path.control".into(), Control::Stiffness(k).into());
        }
        ("path.control.stiffness", Value::Typed(text)) => {
            values.insert("path.control".into(), Value::Typed(text));
        }
        (_, value) => {
            values.insert(row.key.clone(), value);
        }
    }
}

/// The error for a key without a row.
pub(super) fn unknown_key(key: &str) -> Invalid {
    let meant = closest_key(key, PARAMETERS.iter().map(|row| (&*row.key, &*row.label)));
    Invalid::UnknownKey { key: quote(key), meant: meant.map(Into::into) }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::contact::Gap;
    use crate::contact::formula::{FormulaParameter, TypedGap};
    use crate::contact::shapes::{ExactSphere, Harmonic, Harmonics, PowerLaw, RandomWaves, Smoothing};
    use crate::preset::schema::{Applies, START_OVER_CURVATURE};
    use proptest::prelude::*;

    pub fn wavy() -> Preset {
        Preset {
            title: "a wave".to_owned(),
            units: UnitSystem::Reduced,
            material: Material { effective_modulus: 1.0, work_of_adhesion: 0.004, range_of_action: None },
            gap: Shape::WavySphere { radius_of_curvature: 1.0, amplitude: 0.0025, wavelength: 0.05 },
            basis: BasisSpec::Rings { rings: 200, grading: Grading::Uniform },
            path: PathSpec {
                control: Control::Displacement,
                start: Start::ContactRadius(0.5),
                end_contact_radius: Some(0.002),
            },
        }
    }

    /// Any valid preset.
    pub fn any_preset() -> impl Strategy<Value = Preset> {
        let positive = || (-29.0..29.0f64).prop_map(|e| 10f64.powf(e));
        let finite =
            || prop_oneof![Just(0.0), (-1e9..1e9f64), (-29.0..29.0f64).prop_map(|e| -(10f64.powf(e)))];
        let gap = (0..9u8, positive(), prop_oneof![Just(0.0), positive()], positive(), 1.0..100.0f64)
            .prop_map(|(which, radius, amplitude, wavelength, x)| {
                any_gap(which, radius.clamp(1e-20, 1e29), amplitude, wavelength, x)
            });
        let basis = prop_oneof![
            (4usize..=2000).prop_map(|rings| BasisSpec::Rings { rings, grading: Grading::Uniform }),
            (4usize..=400).prop_map(|rings| BasisSpec::Rings { rings, grading: Grading::Edge }),
            (4usize..=4096).prop_map(|n| BasisSpec::Spectral { functions: Functions::Count(n) }),
            Just(BasisSpec::Spectral { functions: Functions::Auto }),
        ];
        let control = prop_oneof![
            Just(Control::Displacement),
            Just(Control::Force),
            positive().prop_map(Control::Stiffness)
        ];
        (
            ("[ -~γλ\u{e9}\"'\\\\]{0,40}", positive(), prop_oneof![Just(0.0), positive()], gap, basis),
            (control, 0..3u8, 0.001..10.0f64, finite(), proptest::option::of(0.0001..0.99f64)),
        )
            .prop_map(|((title, e, gamma, gap, basis), (control, which, over, x, end))| {
                // Within what is known of the gap.
                let known = gap.largest_radius().map_or(f64::INFINITY, |known| 0.99 * known);
                let radius = gap.radius_of_curvature().unwrap_or(1.0).min(known / over);
                let start = match which {
                    0 => Start::ContactRadius(over * radius),
                    1 => Start::Approach(x),
                    _ => Start::Force(x),
                };
                Preset {
                    title,
                    units: UnitSystem::Reduced,
                    material: Material {
                        effective_modulus: e,
                        work_of_adhesion: gamma,
                        range_of_action: None,
                    },
                    gap,
                    basis,
                    path: PathSpec { control, start, end_contact_radius: end.map(|f| f * over * radius) },
                }
            })
    }

    fn any_gap(which: u8, radius: f64, amplitude: f64, wavelength: f64, x: f64) -> Shape {
        let harmonic = |phase| Harmonic { amplitude, wavelength, phase };
        let parameter = |name: &str, value, min, max| FormulaParameter {
            name: name.to_owned(),
            value,
            min,
            max,
            unit: min.map(|_| "\"µm\"".to_owned()),
        };
        match which {
            0 => Shape::Sphere { radius_of_curvature: radius },
            1 => Shape::WavySphere { radius_of_curvature: radius, amplitude, wavelength },
            2 => Shape::ExactSphere(ExactSphere { radius }),
            3 => Shape::Cone { slope: wavelength },
            4 => Shape::PowerLaw(PowerLaw { factor: wavelength, exponent: x }),
            5 => Shape::Harmonics(Arc::new(
                Harmonics::new(radius, [0.0, x, -x].map(harmonic)[..which as usize % 4].to_vec()).unwrap(),
            )),
            6 => Shape::random_waves(RandomWaves {
                radius_of_curvature: radius,
                rms: amplitude,
                longest: wavelength,
                shortest: wavelength / (1.0 + x),
                hurst: x / 100.0,
                count: 7,
                seed: x.to_bits() >> 1,
            })
            .unwrap(),
            7 => {
                let parameters =
                    vec![parameter("R", radius, None, None), parameter("k", x, Some(1.0), Some(100.0))];
                let start = Some(START_OVER_CURVATURE * radius);
                Shape::Formula(Arc::new(TypedGap::new("r^2/(2*R)*(1 + k)", parameters, start).unwrap()))
            }
            _ => {
                let rows = Arc::new(measured::load(None, "shipped:rough-sphere.csv").unwrap());
                Shape::Profile(Arc::new(Measured::new(rows, Smoothing::Cutoff(x)).unwrap()))
            }
        }
    }

    /// A value for a key that it does not have in [`wavy`].
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
            "basis.kind" => "spectral".into(),
            "basis.rings" | "basis.functions" => 77.into(),
            "basis.grading" => "edge".into(),
            "path.control" => Control::Force.into(),
            "path.end_contact_radius" => 0.003.into(),
            "gap.exponent" => 2.5.into(),
            "gap.shortest_wavelength" => 0.03.into(),
            "gap.count" | "gap.seed" => 9.into(),
            "gap.formula" => "r^2/R".into(),
            "gap.file" => Value::Profile(Arc::new(measured::load(None, "shipped:rough-sphere.csv").unwrap())),
            _ => Value::Number(0.75),
        }
    }

    #[test]
    fn the_table_is_total() {
        // Taken apart without `..`: a new field stops this test from compiling until it has a row below.
        let Preset { title: _, units: _, material, gap, basis, path } = wavy();
        let Material { effective_modulus: _, work_of_adhesion: _, range_of_action: _ } = material;
        match basis {
            BasisSpec::Rings { rings: _, grading: _ } | BasisSpec::Spectral { functions: _ } => {}
        }
        let PathSpec { control: _, start: _, end_contact_radius: _ } = path;
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
        let fields = [
            "format",
            "title",
            "units",
            "material.effective_modulus",
            "material.work_of_adhesion",
            "material.range_of_action",
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
            "basis.functions",
            "path.control",
            "path.control.stiffness",
            "path.start_contact_radius",
            "path.start_approach",
            "path.start_force",
            "path.end_contact_radius",
            "display.length",
            "display.force",
            "display.stress",
            "display.adhesion",
            "display.energy",
            "display.stiffness",
        ];
        assert_eq!(PARAMETERS.iter().map(|row| &row.key).collect::<Vec<_>>(), fields);

        // Every row can be read back after it was set.
        for row in PARAMETERS {
            let mut preset = wavy();
            let value = another(&row.key);
            if let Applies::With { key: "gap.shape", words } = row.applies {
                preset.set("gap.shape", words[0].into()).unwrap();
            }
            if row.fits("units", "SI") && !row.fits("units", "reduced") {
                preset.set("units", "SI".into()).unwrap();
            }
            if row.key == "basis.functions" {
                preset.set("basis.kind", "spectral".into()).unwrap();
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
        assert!(
            large.starts_with("gap.parameters.B = 3.0 is out of range: it must be a number from"),
            "{large}"
        );
        let unknown = preset.set("gap.parameters.lamda", 1.0.into()).unwrap_err().to_string();
        assert!(unknown.ends_with("did you mean gap.parameters.lambda?"), "{unknown}");
        let broken = preset.set("gap.formula", "r^2/(2*R".into()).unwrap_err().to_string();
        assert!(broken.starts_with("gap.formula: column "), "{broken}");
        // Of the rows, ranges have no knob.
        let knobs: Vec<String> = preset.knobs().map(|row| row.key.to_string()).collect();
        assert!(
            knobs.contains(&"gap.parameters.B".to_owned())
                && !knobs.contains(&"gap.parameters.B.max".to_owned())
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
    fn a_shape_drops_and_brings_its_keys() {
        let mut preset = wavy();
        preset.set("gap.shape", "sphere".into()).unwrap();
        assert_eq!(preset.gap, Shape::Sphere { radius_of_curvature: 1.0 });
        let wave = preset.set("gap.amplitude", 0.1.into()).unwrap_err();
        assert_eq!(wave.to_string(), "gap.amplitude belongs to wavy-sphere, and the gap is a sphere");
        preset.set("gap.shape", "wavy-sphere".into()).unwrap();
        assert_eq!(preset, wavy());
    }

    #[test]
    fn a_basis_drops_the_keys_of_the_other() {
        let mut preset = wavy();
        let few = preset.set("basis.functions", 48.into()).unwrap_err();
        assert_eq!(few.to_string(), "basis.functions belongs to spectral, and the basis is rings");
        preset.set("basis.kind", "spectral".into()).unwrap();
        assert_eq!(preset.basis, BasisSpec::Spectral { functions: Functions::Auto });
        assert_eq!(preset.get("basis.rings"), None);
        preset.set("basis.functions", 48.into()).unwrap();
        preset.set("basis.functions", "auto".into()).unwrap();
        preset.set("basis.kind", "rings".into()).unwrap();
        assert_eq!(preset, wavy());
    }

    #[test]
    fn graded_rings_have_a_bound_of_their_own() {
        let mut preset = wavy();
        preset.set("basis.grading", "edge".into()).unwrap();
        preset.set("basis.rings", 400.into()).unwrap();
        assert_eq!(preset.basis, BasisSpec::Rings { rings: 400, grading: Grading::Edge });
        let many = preset.set("basis.rings", 401.into()).unwrap_err();
        let words =
            "basis.rings = 401 is out of range: with basis.grading = \"edge\" it must be from 4 to 400";
        assert_eq!(many.to_string(), words);
        preset.reset("basis.grading").unwrap();
        preset.set("basis.rings", 401.into()).unwrap();
        assert_eq!(preset.set("basis.grading", "edge".into()).unwrap_err().to_string(), words);
        preset.set("basis.kind", "spectral".into()).unwrap();
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
    fn the_end_follows_the_start_unless_said() {
        let mut preset = wavy();
        assert!((preset.end_contact_radius(0.5) - 0.002).abs() < 1e-18);
        preset.reset("path.end_contact_radius").unwrap();
        assert!((preset.end_contact_radius(0.25) - 0.001).abs() < 1e-18);
    }

    #[test]
    fn a_preset_made_in_code_is_checked() {
        let mut preset = wavy();
        preset.material.effective_modulus = f64::INFINITY;
        preset.basis = BasisSpec::Rings { rings: 3, grading: Grading::Uniform };
        assert_eq!(preset.check().unwrap_err().len(), 2);
    }
}
