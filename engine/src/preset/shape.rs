//! The values of `[gap]` → the gap's shape, and back: rows, values and the initial values of a new shape.

use super::family::{self, PARAMETER_KEYS, WAVE_KEYS, is_parameter, parameter_key, wave_key};
use super::given::GivenValues;
use super::invalid::Invalid;
use super::measured;
use super::model::Preset;
use super::resolve::told;
use super::rows::parameter;
use super::schema::{
    AUTO, COEFFICIENT, Key, Kind, LARGEST, NONE, Parameter, Row, START_KEYS, START_OVER_CURVATURE,
};
use super::value::Value;
use super::values::{Values, of_coefficient};
use crate::elementary::pow;
use crate::gap::{Gap, Shape};
use crate::gap::{formula::Formula, formula::FormulaParameter, formula::TypedError, formula::TypedGap};
use crate::gap::{formula::typed::MOST_PARAMETERS, formula::typed::RADIUS};
use crate::gap::{
    shapes::ExactSphere, shapes::Harmonic, shapes::Harmonics, shapes::MeasuredGap, shapes::PowerLaw,
    shapes::RandomWaves, shapes::Smoothing,
};
use crate::problem::Start;
use crate::text::closest;
use crate::units::number::{said, short};
use crate::units::{Quantity, Unit, UnitSystem};
use std::sync::Arc;

impl GivenValues<'_> {
    /// The shape of the gap, for a path whose start is given by the key `start`. If a shape cannot be made, the reason
    /// is among the faults and a sphere stands in for it.
    pub(super) fn shape(&mut self, start: Option<&str>) -> Shape {
        let faults = self.faults.len();
        let shape = match self.text("gap.shape").as_str() {
            "wavy-sphere" => Shape::WavySphere {
                radius_of_curvature: self.radius(),
                amplitude: self.number("gap.amplitude"),
                wavelength: self.number("gap.wavelength"),
            },
            "exact-sphere" => Shape::ExactSphere(ExactSphere { radius: self.radius() }),
            "cone" => Shape::Cone { slope: self.number("gap.slope") },
            "power-law" => Shape::PowerLaw(PowerLaw {
                factor: self.number(COEFFICIENT),
                exponent: self.number("gap.exponent"),
            }),
            "harmonics" => self.harmonics(),
            "random-waves" => self.random_waves(faults),
            "formula" => self.formula(start),
            "profile" => self.profile(),
            // An unknown word has already been reported as a fault.
            _ => Shape::Sphere { radius_of_curvature: self.radius() },
        };
        self.strays(&shape);
        shape
    }

    fn radius(&mut self) -> f64 {
        self.number("gap.radius_of_curvature")
    }

    fn fault(&mut self, key: &str, cause: &impl ToString) -> Shape {
        self.faults.push(Invalid::Made { key: key.to_owned().into(), cause: cause.to_string() });
        Shape::Sphere { radius_of_curvature: f64::NAN }
    }

    fn harmonics(&mut self) -> Shape {
        if self.waves_given() == 0 {
            let allowed = "one or more tables [[gap.waves]] with amplitude and wavelength; without waves the gap is a sphere";
            self.faults
                .push(Invalid::Missing { key: family::WAVE_TABLE.into(), allowed: allowed.to_owned() });
        }
        let mut waves = Vec::new();
        while waves.len() < self.waves_given() {
            let number = waves.len() + 1;
            let [amplitude, wavelength, phase] = WAVE_KEYS.map(|name| self.number(&wave_key(number, name)));
            waves.push(Harmonic { amplitude, wavelength, phase });
            // It is enough to report one gap in the numbering.
            if amplitude.is_nan() && wavelength.is_nan() {
                break;
            }
        }
        match Harmonics::new(self.radius(), waves) {
            Ok(harmonics) => Shape::Harmonics(Arc::new(harmonics)),
            Err(error) => self.fault(family::WAVE_TABLE, &error),
        }
    }

    /// The highest number of a wave.
    fn waves_given(&self) -> usize {
        let number = |key: &Key| -> Option<usize> {
            family::below(key, family::WAVE_TABLE)?.split_once('.')?.0.parse().ok()
        };
        self.values.keys().filter_map(number).max().unwrap_or(0)
    }

    fn random_waves(&mut self, faults: usize) -> Shape {
        let spectrum = RandomWaves {
            radius_of_curvature: self.radius(),
            rms: self.number("gap.rms"),
            longest: self.number("gap.longest_wavelength"),
            shortest: self.number("gap.shortest_wavelength"),
            hurst: self.number("gap.hurst"),
            count: usize::try_from(self.integer("gap.count")).unwrap_or_default(),
            seed: u64::try_from(self.integer("gap.seed")).unwrap_or_default(),
        };
        match Shape::random_waves(spectrum) {
            Ok(shape) => shape,
            // What is missing or out of range has already been reported.
            Err(_) if self.faults.len() > faults || !self.all_fine() => {
                Shape::Sphere { radius_of_curvature: f64::NAN }
            }
            Err(error) => self.fault("gap.shortest_wavelength", &error.words(&self.units)),
        }
    }

    fn all_fine(&self) -> bool {
        self.values
            .iter()
            .all(|(key, value)| parameter(key).is_none_or(|row| row.check(value.clone()).is_ok()))
    }

    fn formula(&mut self, start: Option<&str>) -> Shape {
        let nothing = Shape::Sphere { radius_of_curvature: f64::NAN };
        let text = self.text("gap.formula");
        if text.is_empty() {
            return if self.values.contains_key("gap.formula") {
                self.fault("gap.formula", &"the formula is empty")
            } else {
                nothing
            };
        }
        let names = match Formula::parse(&text) {
            Ok(formula) if formula.parameters().len() > MOST_PARAMETERS => {
                return self.fault("gap.formula", &TypedError::TooMany(formula.parameters().len()));
            }
            Ok(formula) => formula.parameters().to_vec(),
            Err(error) => return self.fault("gap.formula", &error),
        };
        let parameters: Vec<FormulaParameter> = names.iter().map(|name| self.parameter(name)).collect();
        if parameters.iter().any(|p| p.value.is_nan()) {
            return nothing;
        }
        let radius = || parameters.iter().find(|p| p.name == RADIUS && p.value > 0.0).map(|p| p.value);
        let start = match start {
            None => radius().map(|radius| START_OVER_CURVATURE * radius),
            Some(key) if key == START_KEYS[0] => Some(self.number(key)).filter(|s| s.is_finite()),
            Some(_) => None,
        };
        match TypedGap::new(&text, parameters, start) {
            Ok(gap) => Shape::Formula(Arc::new(gap)),
            Err(error) => self.fault("gap.formula", &error.words(&self.units)),
        }
    }

    fn parameter(&mut self, name: &str) -> FormulaParameter {
        let key = parameter_key(name);
        let value = self.number(&key);
        let limit = |part| match self.values.get(&*format!("{key}.{part}")) {
            Some(Value::Number(x)) => Some(*x),
            _ => None,
        };
        let (min, max) = (limit("min"), limit("max"));
        let unit = match self.values.get(&*format!("{key}.unit")) {
            Some(Value::Text(unit)) => Some(unit.clone()),
            _ => None,
        };
        let parameter = FormulaParameter { name: name.to_owned(), value, min, max, unit };
        let row = bounded(&parameter);
        if !value.is_nan()
            && let Err(fault) = row.check(value.into())
        {
            self.faults.push(told_in_own(&row, &self.units, value, fault));
        }
        // In SI a bare number is in this unit, which must therefore be a known one.
        if let (Some(unit), UnitSystem::Si(_)) = (&parameter.unit, &self.units)
            && let Err(cause) = Unit::parse(unit, 0)
        {
            self.faults.push(Invalid::Units { key: format!("{key}.unit").into(), cause: cause.into() });
        }
        parameter
    }

    fn profile(&mut self) -> Shape {
        let smoothing = match self.value("gap.smoothing") {
            Some(Value::Number(cutoff)) => Smoothing::Cutoff(cutoff),
            Some(Value::Text(word)) if word == AUTO => Smoothing::Auto,
            _ => Smoothing::None,
        };
        let rows = match self.value("gap.file") {
            Some(Value::Profile(rows)) => rows,
            Some(Value::Text(name)) => match (self.files.rows)(None, &name) {
                Ok(rows) => Arc::new(rows),
                Err(cause) => return self.fault("gap.file", &cause),
            },
            _ => return Shape::Sphere { radius_of_curvature: f64::NAN },
        };
        let shown = measured::shown(&rows);
        match MeasuredGap::new(rows.held_in(&self.units), smoothing) {
            Ok(measured) => Shape::Profile(Arc::new(measured)),
            Err(error) => {
                let key = if error.is_of_smoothing() { "gap.smoothing" } else { "gap.file" };
                self.fault(key, &format!("{shown}: {}", error.words(&self.units)))
            }
        }
    }

    /// Parameters that the formula does not use are faults.
    fn strays(&mut self, shape: &Shape) {
        let Shape::Formula(typed) = shape else { return };
        let names = typed.formula().parameters();
        for key in self.values.keys() {
            let Some(name) = family::below(key, family::PARAMETER_TABLE) else { continue };
            let name = name.split_once('.').map_or(name, |(name, _)| name);
            if !names.iter().any(|known| known == name) {
                let meant = closest(name, names.iter().map(String::as_str));
                let meant = meant.map(|name| parameter_key(name).into());
                self.faults.push(Invalid::Unused { key: key.clone(), meant });
            }
        }
    }
}

/// How far beyond the start, or beyond the length of the gap, a falling gap without an end is followed.
const FAR: f64 = 1e12;
/// The radii at which a gap is checked for falling: this many in even steps, and this many per decade.
const FALL_STEPS: u32 = 4096;
const FALLS_A_DECADE: i32 = 20;
/// The decades below the start, or below the length of the gap.
const FALL_DECADES: i32 = 6;

/// Reports that no disc of contact lies around the axis, for a gap that falls outward from the axis at every radius
/// where it is known: an upside-down formula, or the profile of a hollow.
pub(super) fn falls_throughout(preset: &Preset) -> Option<Invalid> {
    let gap = &preset.gap;
    let (key, larger) = match gap {
        Shape::Formula(_) => ("gap.formula", "as r^2/(2*R) does"),
        Shape::Profile(_) => ("gap.file", "as that of a rounded tip does"),
        // The paraboloid below their waves rises.
        _ => return None,
    };
    let near = match preset.path.start {
        Start::ContactRadius(s) => s,
        Start::Approach(_) | Start::Force(_) => gap.reference_length(),
    };
    let known = gap.largest_radius();
    let end = known.unwrap_or(FAR * gap.length().map_or(near, |length| length.max(near)));
    let even = (1..=FALL_STEPS).map(|i| f64::from(i) / f64::from(FALL_STEPS) * near.min(end));
    let decades = (-FALL_DECADES * FALLS_A_DECADE..)
        .map(|i| near * pow(10f64, f64::from(i) / f64::from(FALLS_A_DECADE)))
        .take_while(|r| *r < end);
    // A formula may stop being finite far out, and where it ends may not be known.
    let throughout = even
        .chain(decades)
        .map(|r| gap.jet(r).first)
        .take_while(|slope| !slope.is_nan())
        .all(|slope| slope < 0.0);
    throughout.then(|| Invalid::Made {
        key: key.into(),
        cause: format!(
            "the gap falls from the axis outward{}: no disc of contact lies around the axis; h(r) must rise, {larger}",
            known.map_or_else(
                || " at every radius".to_owned(),
                |end| format!(" at every radius up to {}, where it ends", said(&preset.units, Quantity::Length, end))
            )
        ),
    })
}

/// The row of a parameter, with its range and unit.
fn bounded(given: &FormulaParameter) -> Parameter {
    let mut row = family::parameter(&given.name);
    if given.min.is_some() || given.max.is_some() {
        row.kind = Kind::Between { min: given.min.unwrap_or(-LARGEST), max: given.max.unwrap_or(LARGEST) };
    }
    if let Some(unit) = &given.unit {
        row.dimension = unit.clone().into();
        row.unit = Unit::parse(unit, 0).ok();
        row.quantity = row.unit.as_ref().and_then(measured_in).unwrap_or(Quantity::Number);
    }
    row
}

/// The row of one end of a parameter's range, or of its unit; a range has the unit of the parameter.
fn limit(given: &FormulaParameter, part: &str) -> Option<Parameter> {
    let Parameter { unit, quantity, .. } = bounded(given);
    let row = family::limit(&given.name, part)?;
    Some(if row.kind == Kind::Finite { Parameter { quantity, unit, ..row } } else { row })
}

/// A value beyond the range of its parameter, reported in the parameter's own unit.
fn told_in_own(row: &Parameter, units: &UnitSystem, x: f64, fault: Invalid) -> Invalid {
    let (Invalid::Range { key, .. }, Some(unit), Kind::Between { min, max }) =
        (&fault, row.own_unit_in(units), row.kind)
    else {
        return told(units, Some(row.quantity), &x.into(), fault);
    };
    let number = |x: f64| if x.abs() == LARGEST { format!("{x:?}") } else { short(unit.from_si(x), 12) };
    let value = format!("{} {}", number(x), unit.ascii());
    let allowed = format!("a number from {} to {} (in {})", number(min), number(max), unit.ascii());
    Invalid::Range { key: key.clone(), value, allowed }
}

/// A row of the table in the form that this shape gives it.
pub(super) fn own(shape: &Shape, row: &'static Parameter) -> Row {
    match shape {
        Shape::PowerLaw(law) if row.key == COEFFICIENT => Row::Owned(Parameter {
            quantity: of_coefficient(law.exponent).unwrap_or(Quantity::Number),
            ..row.clone()
        }),
        _ => Row::Borrowed(row),
    }
}

/// The quantity that is measured in a unit, if the program knows it.
fn measured_in(unit: &Unit) -> Option<Quantity> {
    let dimension = unit.dimension();
    Quantity::ALL.into_iter().find(|quantity| quantity.dimension() == dimension)
}

/// The rows that a shape adds itself.
pub(super) fn rows(shape: &Shape) -> Vec<Parameter> {
    match shape {
        Shape::Formula(typed) => typed
            .parameters()
            .iter()
            .flat_map(|given| {
                let limits = PARAMETER_KEYS.iter().filter_map(|part| limit(given, part));
                std::iter::once(bounded(given)).chain(limits)
            })
            .collect(),
        Shape::Harmonics(waves) => (1..=waves.waves().len())
            .flat_map(|number| WAVE_KEYS.iter().filter_map(move |name| family::wave(number, name)))
            .collect(),
        _ => Vec::new(),
    }
}

/// The value of a key of the table `[gap]`.
pub(super) fn get(shape: &Shape, key: &str) -> Option<Value> {
    if key == "gap.shape" {
        return Some(shape.name().into());
    }
    Some(match (shape, family::below(key, "gap")?) {
        (Shape::Formula(_) | Shape::Profile(_), "radius_of_curvature") => return None,
        (_, "radius_of_curvature") => shape.radius_of_curvature()?.into(),
        (_, "amplitude") => shape.wave()?.0.into(),
        (_, "wavelength") => shape.wave()?.1.into(),
        (Shape::Cone { slope }, "slope") => (*slope).into(),
        (Shape::PowerLaw(law), "coefficient") => law.factor.into(),
        (Shape::PowerLaw(law), "exponent") => law.exponent.into(),
        (Shape::RandomWaves { spectrum, .. }, "rms") => spectrum.rms.into(),
        (Shape::RandomWaves { spectrum, .. }, "longest_wavelength") => spectrum.longest.into(),
        (Shape::RandomWaves { spectrum, .. }, "shortest_wavelength") => spectrum.shortest.into(),
        (Shape::RandomWaves { spectrum, .. }, "hurst") => spectrum.hurst.into(),
        (Shape::RandomWaves { spectrum, .. }, "count") => i64::try_from(spectrum.count).ok()?.into(),
        (Shape::RandomWaves { spectrum, .. }, "seed") => i64::try_from(spectrum.seed).ok()?.into(),
        (Shape::Formula(typed), "formula") => typed.formula().to_string().as_str().into(),
        (Shape::Formula(typed), _) => return parameter_value(typed, key),
        (Shape::Harmonics(waves), _) => return wave_value(waves, key),
        (Shape::Profile(measured), "file") => Value::Profile(Arc::clone(measured.rows())),
        (Shape::Profile(measured), "smoothing") => match measured.smoothing() {
            Smoothing::None => NONE.into(),
            Smoothing::Auto => AUTO.into(),
            Smoothing::Cutoff(cutoff) => cutoff.into(),
        },
        _ => return None,
    })
}

fn parameter_value(typed: &TypedGap, key: &str) -> Option<Value> {
    let rest = family::below(key, family::PARAMETER_TABLE)?;
    let (name, part) = rest.split_once('.').map_or((rest, None), |(name, part)| (name, Some(part)));
    let given = typed.parameters().iter().find(|given| given.name == name)?;
    match part {
        None => Some(given.value.into()),
        Some("min") => given.min.map(Value::from),
        Some("max") => given.max.map(Value::from),
        Some("unit") => given.unit.as_deref().map(Value::from),
        Some(_) => None,
    }
}

fn wave_value(waves: &Harmonics, key: &str) -> Option<Value> {
    let (number, name) = family::below(key, family::WAVE_TABLE)?.split_once('.')?;
    let wave = waves.waves().get(number.parse::<usize>().ok()?.checked_sub(1)?)?;
    match name {
        "amplitude" => Some(wave.amplitude.into()),
        "wavelength" => Some(wave.wavelength.into()),
        "phase" => Some(wave.phase.into()),
        _ => None,
    }
}

/// Removes from `values` the parameters that a newly chosen formula does not have, unless `keep` says that they stay.
/// Returns the names that it has without a value, each with the most similar one of those removed and its value.
pub(super) fn fit_parameters(values: &mut Values, keep: impl Fn(&str) -> bool) -> Vec<Unvalued> {
    let Some(Value::Text(text)) = values.get("gap.formula") else { return Vec::new() };
    let Ok(formula) = Formula::parse(text) else { return Vec::new() };
    let names = formula.parameters();
    let mut gone = Vec::new();
    values.retain(|key, value| {
        let Some(rest) = family::below(key, family::PARAMETER_TABLE) else { return true };
        let name = rest.split('.').next().unwrap_or(rest);
        let stays = names.iter().any(|known| known == name) || keep(key);
        if !stays && rest == name {
            gone.push((name.to_owned(), value.clone()));
        }
        stays
    });
    let missing = names.iter().filter(|name| !values.contains_key(&*parameter_key(name)));
    missing
        .map(|name| {
            let alike = closest(name, gone.iter().map(|(name, _)| name.as_str()));
            let alike = alike.and_then(|alike| gone.iter().find(|(name, _)| name == alike).cloned());
            Unvalued { name: name.clone(), alike }
        })
        .collect()
}

/// A parameter without a value.
pub(super) struct Unvalued {
    /// Its name.
    pub(super) name: String,
    /// The parameter of the previous formula that it may be a misspelling of, with its value.
    pub(super) alike: Option<(String, Value)>,
}

/// What a shape chosen on the screen begins with where `values` lack it: a body of the radius `radius`, with the waves
/// of the paper's Fig. 9, or with `wave`, the amplitude and wavelength of the previous shape.
pub(super) fn begin(values: &mut Values, word: &str, radius: f64, wave: Option<(f64, f64)>) {
    let (amplitude, wavelength) = wave.unwrap_or((0.0025 * radius, 0.05 * radius));
    let lengths = [
        ("gap.radius_of_curvature", 1.0),
        ("gap.rms", 0.001),
        ("gap.longest_wavelength", 0.1),
        ("gap.shortest_wavelength", 0.02),
    ];
    let mut starts: Vec<(Key, Value)> =
        lengths.iter().map(|(key, over)| ((*key).into(), Value::Number(over * radius))).collect();
    starts.extend([
        ("gap.amplitude".into(), Value::Number(amplitude)),
        ("gap.wavelength".into(), Value::Number(wavelength)),
        ("gap.slope".into(), Value::Number(0.1)),
        (COEFFICIENT.into(), Value::Number(0.5 / radius)),
        ("gap.exponent".into(), Value::Number(2.0)),
        ("gap.file".into(), "shipped:rough-sphere.csv".into()),
        ("gap.smoothing".into(), AUTO.into()),
        ("gap.formula".into(), "r^2/(2*R) + A*(1 - cos(2*pi*r/lambda))".into()),
        ("gap.parameters.R".into(), Value::Number(radius)),
        ("gap.parameters.A".into(), Value::Number(amplitude)),
        ("gap.parameters.lambda".into(), Value::Number(wavelength)),
        ("gap.waves.1.amplitude".into(), Value::Number(amplitude)),
        ("gap.waves.1.wavelength".into(), Value::Number(wavelength)),
    ]);
    for (key, value) in starts {
        if parameter(&key).is_some_and(|row| row.fits("gap.shape", word)) {
            values.entry(key).or_insert(value);
        }
    }
}

/// Whether a key may be left out of a list of knobs: the range and the unit of a parameter.
pub fn is_range(key: &str) -> bool {
    key.rsplit_once('.').is_some_and(|(parent, part)| is_parameter(parent) && PARAMETER_KEYS.contains(&part))
}
