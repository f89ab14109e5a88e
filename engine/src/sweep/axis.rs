//! One axis of a sweep: a key of the preset and the values it takes.

use super::MOST_ROWS;
use super::document::{SpecEntry, SpecError, SpecSection};
use crate::elementary::{cos, ln, pow};
use crate::gap::shapes::split_mix::SplitMix64;
use crate::preset::called::key_called;
use crate::preset::schema::Parameter;
use crate::preset::{Invalid, Preset, Value, groups, model};
use crate::problem::Control;
use crate::report::number::exact;
use crate::text::quote;
use std::f64::consts::TAU;
use toml::de::DeValue;

/// A key and its values.
#[derive(Debug, Clone, PartialEq)]
pub struct SweepAxis {
    /// A dotted key that [`Preset::set`] takes.
    pub key: String,
    /// The values.
    pub points: AxisValues,
}

/// The values of an axis; every number is in the preset's units: SI, or reduced.
#[derive(Debug, Clone, PartialEq)]
pub enum AxisValues {
    /// Listed one by one.
    Values(Vec<Value>),
    /// With equal differences.
    Linear {
        /// The first.
        from: f64,
        /// The last.
        to: f64,
        /// How many.
        count: u64,
    },
    /// Whole numbers with equal differences.
    Whole {
        /// The first.
        from: i64,
        /// The difference.
        step: i64,
        /// How many.
        count: u64,
    },
    /// With equal factors.
    Logarithmic {
        /// The first, positive.
        from: f64,
        /// The last, positive.
        to: f64,
        /// How many.
        count: u64,
    },
    /// Drawn at random, one for each row.
    Drawn(Distribution),
}

/// The distribution that values are drawn from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Distribution {
    /// Between two ends, all values equally likely.
    Uniform([f64; 2]),
    /// Between two positive ends, all logarithms equally likely.
    LogUniform([f64; 2]),
    /// The normal distribution.
    Normal {
        /// Its mean.
        mean: f64,
        /// Its standard deviation, not negative.
        deviation: f64,
    },
    /// Whole numbers, both ends included, all equally likely.
    Integers([i64; 2]),
}

/// The kinds of values; an axis has exactly one.
const KINDS: [&str; 4] = ["values", "linear", "logarithmic", "distribution"];
/// The kinds of distributions.
const DISTRIBUTIONS: [&str; 4] = ["uniform", "log-uniform", "normal", "integers"];

impl SweepAxis {
    /// Reads `[[axis]]`; `preset` checks its values. With `fixed`, no axis may change which keys the preset has.
    ///
    /// # Errors
    /// [`SpecError`] with the line.
    pub fn read(section: &SpecSection<'_>, preset: &Preset, fixed: bool) -> Result<Self, SpecError> {
        section.only(&["key", "values", "linear", "logarithmic", "distribution"])?;
        let wanted = "a key of the preset, such as \"gap.amplitude\"";
        let entry = section.need("key", wanted)?;
        // Unknown keys are reported here, whatever the values are.
        let unknown = |unknown: Invalid| entry.fault(&format!("axis.key: {unknown}"));
        let key = &*key_called(preset, entry.text(wanted)?).map_err(unknown)?;
        if model::is_of_units(key) || ["format", "title"].contains(&key) {
            return Err(entry.fault(&format!("{key} is not a quantity of the problem: it cannot be swept")));
        }
        if let Err(invalid @ (Invalid::UnknownKey { .. } | Invalid::UnknownGroup { .. })) =
            preset.resolved(key, 0.0.into())
        {
            return Err(unknown(invalid));
        }
        let points = KeyReader { preset: Some(preset), key }.points(section, &entry)?;
        let axis = Self { key: key.to_owned(), points };
        if fixed {
            axis.check_applies(&entry, preset)?;
        }
        Ok(axis)
    }

    /// Reads an axis in the [`canonical`](Self::canonical) form; its values were checked earlier.
    ///
    /// # Errors
    /// [`SpecError`] if it has another form.
    pub fn of_canonical(section: &SpecSection<'_>) -> Result<Self, SpecError> {
        let entry = section.need("key", "a key")?;
        let key = entry.text("a key")?;
        Ok(Self { key: key.to_owned(), points: KeyReader { preset: None, key }.points(section, &entry)? })
    }

    fn check_applies(&self, entry: &SpecEntry<'_>, preset: &Preset) -> Result<(), SpecError> {
        let Some(first) = self.first() else { return Ok(()) };
        match preset.clone().set(&self.key, first) {
            Err(invalid @ (Invalid::OtherChoice { .. } | Invalid::Unused { .. })) => {
                Err(entry.fault(&invalid.to_string()))
            }
            _ => Ok(()),
        }
    }

    /// Its first value, or a likely one if the values are drawn.
    pub fn first(&self) -> Option<Value> {
        match &self.points {
            AxisValues::Drawn(Distribution::Normal { mean, .. }) => Some((*mean).into()),
            AxisValues::Drawn(Distribution::Uniform([a, _]) | Distribution::LogUniform([a, _])) => {
                Some((*a).into())
            }
            AxisValues::Drawn(Distribution::Integers([a, _])) => Some((*a).into()),
            _ => self.value(0),
        }
    }

    /// Whether all its values are numbers, so that they have a place on an axis.
    pub fn is_numeric(&self) -> bool {
        match &self.points {
            AxisValues::Values(values) => {
                values.iter().all(|value| matches!(value, Value::Number(_) | Value::Integer(_)))
            }
            _ => true,
        }
    }

    /// How many values it has; `None` if they are drawn.
    pub fn count(&self) -> Option<u64> {
        match &self.points {
            AxisValues::Values(values) => Some(values.len() as u64),
            AxisValues::Linear { count, .. }
            | AxisValues::Whole { count, .. }
            | AxisValues::Logarithmic { count, .. } => Some(*count),
            AxisValues::Drawn(_) => None,
        }
    }

    /// The value at `index`, which is below the count; `None` if the values are drawn.
    pub fn value(&self, index: u64) -> Option<Value> {
        let last = |count: u64| index > 0 && index + 1 >= count;
        let share = |count: u64| index as f64 / (count.max(2) - 1) as f64;
        match &self.points {
            AxisValues::Values(values) => values.get(usize::try_from(index).ok()?).cloned(),
            // The last value is the one that was typed, to the bit.
            AxisValues::Linear { to, count, .. } | AxisValues::Logarithmic { to, count, .. }
                if last(*count) =>
            {
                Some((*to).into())
            }
            AxisValues::Linear { from, to, count } => Some((from + (to - from) * share(*count)).into()),
            // Computed in software, so that it is the same on every machine; without the last digit, so that a decade is one.
            AxisValues::Logarithmic { from, to, count } => {
                let x = from * pow(to / from, share(*count));
                Some(format!("{x:.14e}").parse().unwrap_or(x).into())
            }
            AxisValues::Whole { from, step, .. } => {
                let steps = i64::try_from(index).ok()?;
                Some(steps.checked_mul(*step).and_then(|way| from.checked_add(way))?.into())
            }
            AxisValues::Drawn(_) => None,
        }
    }

    /// The values in the canonical form of the spec.
    pub fn canonical(&self) -> String {
        let spaced = |word: &str, from: f64, to: f64, count: u64| {
            format!("{word} = {{ from = {}, to = {}, count = {count} }}", exact(from), exact(to))
        };
        let range = |word: &str, a: &str, b: &str| format!("distribution = {{ {word} = [{a}, {b}] }}");
        match &self.points {
            AxisValues::Values(values) => {
                let values: Vec<String> = values.iter().map(Value::to_toml).collect();
                format!("values = [{}]", values.join(", "))
            }
            AxisValues::Linear { from, to, count } => spaced("linear", *from, *to, *count),
            AxisValues::Logarithmic { from, to, count } => spaced("logarithmic", *from, *to, *count),
            AxisValues::Whole { from, step, count } => {
                let to =
                    from.saturating_add(step.saturating_mul(i64::try_from(*count - 1).unwrap_or(i64::MAX)));
                format!("linear = {{ from = {from}, to = {to}, count = {count} }}")
            }
            AxisValues::Drawn(Distribution::Uniform([a, b])) => range("uniform", &exact(*a), &exact(*b)),
            AxisValues::Drawn(Distribution::LogUniform([a, b])) => {
                range("log-uniform", &exact(*a), &exact(*b))
            }
            AxisValues::Drawn(Distribution::Integers([a, b])) => {
                range("integers", &a.to_string(), &b.to_string())
            }
            AxisValues::Drawn(Distribution::Normal { mean, deviation }) => {
                let (mean, deviation) = (exact(*mean), exact(*deviation));
                format!("distribution = {{ normal = {{ mean = {mean}, deviation = {deviation} }} }}")
            }
        }
    }
}

impl Distribution {
    /// The next value from `random`; every draw takes two numbers.
    pub fn draw(&self, random: &mut SplitMix64) -> Value {
        let (bits, other) = (random.clone().bits(), [random.unit(), random.unit()]);
        let [u, v] = other;
        match *self {
            Self::Uniform([a, b]) => (a + (b - a) * u).into(),
            Self::LogUniform([a, b]) => (a * pow(b / a, u)).into(),
            // The Box-Muller transform; 1 − u is never 0.
            Self::Normal { mean, deviation } => {
                let radius = (-2.0 * ln(1.0 - u)).sqrt();
                (mean + deviation * radius * cos(TAU * v)).into()
            }
            Self::Integers([a, b]) => {
                let span = (i128::from(b) - i128::from(a) + 1).unsigned_abs();
                // A whole number below the span: the upper half of its product with 64 random bits.
                let above = i128::try_from((u128::from(bits) * span) >> 64).unwrap_or_default();
                i64::try_from(i128::from(a) + above).unwrap_or(b).into()
            }
        }
    }
}

/// Whether an axis over `axis` overrides, in every row, the value that an assignment gives to `key`.
pub fn overrides(axis: &str, key: &str) -> bool {
    // A group that changes more than the axis keeps the rest of what it does.
    groups::are_rivals(axis, key) && (!groups::changed(key).contains(&axis) || groups::changed(key) == [axis])
}

/// Reads the values of one key.
struct KeyReader<'a> {
    /// Checks the values; without it they are taken as they stand.
    preset: Option<&'a Preset>,
    key: &'a str,
}

impl KeyReader<'_> {
    /// The values of the axis in `section`, whose key is `named`.
    fn points(&self, section: &SpecSection<'_>, named: &SpecEntry<'_>) -> Result<AxisValues, SpecError> {
        let given: Vec<SpecEntry<'_>> = KINDS.iter().filter_map(|kind| section.get(kind)).collect();
        let [points] = &given[..] else {
            let what = format!("the axis {} must have exactly one of {}", self.key, KINDS.join(", "));
            return Err(given.get(1).unwrap_or(named).fault(&what));
        };
        match points.name.rsplit('.').next() {
            Some("values") => self.values(points),
            Some("linear") => self.linear(points),
            Some("logarithmic") => self.logarithmic(points),
            _ => Ok(AxisValues::Drawn(self.distribution(points)?)),
        }
    }

    fn values(&self, entry: &SpecEntry<'_>) -> Result<AxisValues, SpecError> {
        let values = entry.array("an array of values")?;
        if values.is_empty() {
            return Err(entry.fault(&format!("{} of the axis {} is empty", entry.name, self.key)));
        }
        Ok(AxisValues::Values(values.iter().map(|value| self.value(value)).collect::<Result<_, _>>()?))
    }

    /// One value, in the units of the preset.
    fn value(&self, entry: &SpecEntry<'_>) -> Result<Value, SpecError> {
        let of_toml = || {
            Value::from_toml(entry.value).map_err(|found| {
                entry.fault(&format!("{}: {} is {found}; write a number or a string", entry.name, self.key))
            })
        };
        let Some(preset) = self.preset else {
            return if let DeValue::Table(_) = entry.value { Self::stiffness(entry) } else { of_toml() };
        };
        let read =
            |row: &Parameter, text: &str| preset.read(row, text).map_err(|e| entry.fault(&e.to_string()));
        let value = match (entry.value, preset.row(self.key)) {
            (DeValue::String(text), Some(row)) => read(&row, text)?,
            (_, Some(row)) if row.kind.is_number() => match of_toml()? {
                Value::Number(x) => read(&row, &exact(x))?,
                Value::Integer(n) => read(&row, &n.to_string())?,
                other => other,
            },
            _ => of_toml()?,
        };
        preset.resolved(self.key, value).map_err(|e| entry.fault(&e.to_string()))
    }

    /// `{ stiffness = k }`, as in the canonical form.
    fn stiffness(entry: &SpecEntry<'_>) -> Result<Value, SpecError> {
        let allowed = "{ stiffness = k }";
        let stiffness = entry.section(allowed)?.need("stiffness", "a number")?;
        match Value::from_toml(stiffness.value) {
            Ok(Value::Number(k)) => Ok(Control::Stiffness(k).into()),
            _ => Err(entry.fault(&format!("{} must be {allowed}", entry.name))),
        }
    }

    fn number(&self, entry: &SpecEntry<'_>) -> Result<f64, SpecError> {
        match self.value(entry)? {
            Value::Number(x) => Ok(x),
            Value::Control(Control::Stiffness(_)) => Err(entry.fault(&format!(
                "{}: sweep path.control.stiffness instead, whose values are numbers",
                entry.name
            ))),
            other => {
                Err(entry.fault(&format!("{}: {} = {other} is not a real number", entry.name, self.key)))
            }
        }
    }

    fn integer(&self, entry: &SpecEntry<'_>) -> Result<i64, SpecError> {
        match (entry.value, self.value(entry)?) {
            (DeValue::Integer(n), _) if i64::from_str_radix(n.as_str(), n.radix()).is_ok() => {
                Ok(i64::from_str_radix(n.as_str(), n.radix()).unwrap_or_default())
            }
            (_, Value::Integer(n)) => Ok(n),
            (_, other) => Err(entry.fault(&format!("{}: {other} is not a whole number", entry.name))),
        }
    }

    /// `{ from, to, count }`.
    fn spaced<'a>(entry: &SpecEntry<'a>) -> Result<([SpecEntry<'a>; 2], u64), SpecError> {
        let section = entry.section("{ from = a, to = b, count = n }")?;
        section.only(&["from", "to", "count"])?;
        let [from, to] = [section.need("from", "the first value")?, section.need("to", "the last value")?];
        let count = section.need("count", "the number of values")?.count(2..=MOST_ROWS)?;
        Ok(([from, to], count))
    }

    fn linear(&self, entry: &SpecEntry<'_>) -> Result<AxisValues, SpecError> {
        let ([from, to], count) = Self::spaced(entry)?;
        if let Value::Integer(first) = self.value(&from)? {
            let (last, steps) = (self.integer(&to)?, i128::from(count) - 1);
            let way = i128::from(last) - i128::from(first);
            if way % steps != 0 {
                let what = format!(
                    "{} takes whole numbers: {count} values in equal steps from {first} to {last} are not whole",
                    self.key
                );
                return Err(entry.fault(&what));
            }
            let step = i64::try_from(way / steps).map_err(|_| to.fault("the steps are too large"))?;
            return Ok(AxisValues::Whole { from: first, step, count });
        }
        Ok(AxisValues::Linear { from: self.number(&from)?, to: self.number(&to)?, count })
    }

    fn logarithmic(&self, entry: &SpecEntry<'_>) -> Result<AxisValues, SpecError> {
        let ([from, to], count) = Self::spaced(entry)?;
        let [first, last] = [self.number(&from)?, self.number(&to)?];
        self.above_zero(&from, first)?;
        self.above_zero(&to, last)?;
        Ok(AxisValues::Logarithmic { from: first, to: last, count })
    }

    fn above_zero(&self, entry: &SpecEntry<'_>, x: f64) -> Result<(), SpecError> {
        if x > 0.0 {
            return Ok(());
        }
        let what = format!(
            "{} = {} is out of range: {} must be above 0 to have a logarithm",
            entry.name,
            exact(x),
            self.key
        );
        Err(entry.fault(&what))
    }

    fn distribution(&self, entry: &SpecEntry<'_>) -> Result<Distribution, SpecError> {
        let allowed = "one of { uniform = [a, b] }, { log-uniform = [a, b] }, { normal = { mean = m, deviation = d } }, \
                       { integers = [a, b] }";
        let section = entry.section(allowed)?;
        section.only(&DISTRIBUTIONS)?;
        let given: Vec<SpecEntry<'_>> = DISTRIBUTIONS.iter().filter_map(|kind| section.get(kind)).collect();
        let [given] = &given[..] else {
            return Err(entry.fault(&format!("{} must be {allowed}", entry.name)));
        };
        match given.name.rsplit('.').next() {
            Some("uniform") => Ok(Distribution::Uniform(self.range(given)?)),
            Some("log-uniform") => {
                let range = self.range(given)?;
                self.above_zero(given, range[0])?;
                Ok(Distribution::LogUniform(range))
            }
            Some("integers") => {
                let [a, b] = given.pair()?;
                let [from, to] = [self.integer(&a)?, self.integer(&b)?];
                if from > to {
                    return Err(given.fault(&format!("{}: {from} is above {to}", given.name)));
                }
                let one = Value::Number(1.0);
                if self.preset.is_some_and(|preset| preset.with_unit(self.key, &one) != one) {
                    let what = format!(
                        "{}: {} has a unit: list its values, or draw them as uniform",
                        given.name, self.key
                    );
                    return Err(given.fault(&what));
                }
                Ok(Distribution::Integers([from, to]))
            }
            _ => self.normal(given),
        }
    }

    fn range(&self, entry: &SpecEntry<'_>) -> Result<[f64; 2], SpecError> {
        let [a, b] = entry.pair()?;
        let [from, to] = [self.number(&a)?, self.number(&b)?];
        if from < to {
            return Ok([from, to]);
        }
        Err(entry.fault(&format!("{}: {} is not below {}", entry.name, exact(from), exact(to))))
    }

    fn normal(&self, entry: &SpecEntry<'_>) -> Result<Distribution, SpecError> {
        let section = entry.section("{ mean = m, deviation = d }")?;
        section.only(&["mean", "deviation"])?;
        let mean = self.number(&section.need("mean", "a value of the key")?)?;
        let deviation = section.need("deviation", "above 0")?;
        // Not a value of the key itself: the key's range may lie far from 0.
        let bare = match Value::from_toml(deviation.value) {
            Ok(Value::Number(x)) => Some(x),
            Ok(Value::Integer(n)) => Some(n as f64),
            _ => None,
        };
        let own = self.preset.and_then(|preset| preset.row(self.key).map(|row| (row, &preset.units)));
        let share = deviation.value.as_str().and_then(|text| text.trim().strip_suffix('%'));
        let x = match (bare, share.map(|share| share.trim().parse::<f64>())) {
            (Some(x), _) => own.map_or(x, |(row, units)| row.in_own_unit(units, x)),
            (_, Some(Ok(share))) => 0.01 * share * mean.abs(),
            _ => self.number(&deviation)?,
        };
        if !(x > 0.0 && x.is_finite()) {
            let what =
                format!("{} = {} is out of range: it must be above 0", deviation.name, quote(&exact(x)));
            return Err(deviation.fault(&what));
        }
        Ok(Distribution::Normal { mean, deviation: x })
    }
}
