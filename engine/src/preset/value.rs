//! One parameter's value, and its check against the parameter's row.

use super::data;
use super::invalid::Invalid;
use super::schema::{AUTO, Fallback, Kind, LARGEST, NONE, Parameter, SMALLEST};
use crate::gap::shapes::ProfileRows;
use crate::measured::PointsFile;
use crate::problem::Control;
use crate::text::closest;
use crate::text::{is_unsafe, quote};
use crate::units::parse_quantity;
use std::borrow::Cow;
use std::fmt;
use std::sync::Arc;
use toml::de::DeValue;

/// The value of one parameter.
#[derive(Debug, Clone, PartialEq)]
pub enum Value {
    /// A real number.
    Number(f64),
    /// A whole number.
    Integer(i64),
    /// Text or a choice.
    Text(String),
    /// What the loading device prescribes.
    Control(Control),
    /// A number with its unit, or the stiffness of a control with its own unit, as typed: it is read in the preset's
    /// units.
    Typed(String),
    /// The rows of a measured profile, with the name of their file.
    Profile(Arc<ProfileRows>),
    /// The file of a measured curve.
    Points(Arc<PointsFile>),
}

impl Value {
    /// Whether it is the word that removes a value.
    pub(in crate::preset) fn is_none(&self) -> bool {
        matches!(self, Self::Text(word) if word == NONE)
    }

    /// As TOML; numbers keep every digit.
    pub fn to_toml(&self) -> String {
        match self {
            Self::Number(x) => format!("{x:?}"),
            Self::Integer(n) => n.to_string(),
            Self::Text(text) | Self::Typed(text) => toml::Value::String(text.clone()).to_string(),
            Self::Profile(rows) => toml::Value::String(rows.name.clone()).to_string(),
            Self::Points(source) => toml::Value::String(source.name.clone()).to_string(),
            Self::Control(Control::Stiffness(k)) => format!("{{ stiffness = {k:?} }}"),
            Self::Control(other) => format!("\"{other}\""),
        }
    }

    /// What a TOML value is, or a few words on why it cannot be a value here.
    ///
    /// # Errors
    /// What was found instead.
    pub fn from_toml(value: &DeValue<'_>) -> Result<Self, String> {
        match value {
            DeValue::String(text) => Ok(Self::Text(text.to_string())),
            DeValue::Integer(n) => match i64::from_str_radix(n.as_str(), n.radix()) {
                Ok(n) => Ok(Self::Integer(n)),
                Err(_) => Err(format!("the number {}", quote(n.as_str()))),
            },
            DeValue::Float(x) => match real(x.as_str()) {
                Some(x) => Ok(Self::Number(x)),
                None => Err(format!("the number {}", quote(x.as_str()))),
            },
            DeValue::Boolean(b) => Err(format!("the boolean {b}")),
            DeValue::Datetime(_) => Err("a date".to_owned()),
            DeValue::Array(_) => Err("an array".to_owned()),
            DeValue::Table(_) => Err("a table".to_owned()),
        }
    }

    /// What it is, for a message about its type.
    fn described(&self) -> String {
        match self {
            Self::Number(x) => format!("the number {x:?}"),
            Self::Integer(n) => format!("the number {n}"),
            Self::Text(text) | Self::Typed(text) => format!("the text \"{}\"", quote(text)),
            Self::Profile(rows) => format!("the file \"{}\"", quote(&rows.name)),
            Self::Points(source) => format!("the file \"{}\"", quote(&source.name)),
            Self::Control(control) => format!("the control {control}"),
        }
    }
}

/// The number that a text is; `None` also where only 0 is small enough for it.
fn real(text: &str) -> Option<f64> {
    let x: f64 = text.parse().ok()?;
    let digits = text.split(['e', 'E']).next().unwrap_or(text);
    (x != 0.0 || !digits.contains(|c| matches!(c, '1'..='9'))).then_some(x)
}

impl fmt::Display for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(x) => write!(f, "{x:?}"),
            Self::Integer(n) => write!(f, "{n}"),
            Self::Text(text) | Self::Typed(text) => f.write_str(text),
            Self::Profile(rows) => f.write_str(&rows.name),
            Self::Points(source) => f.write_str(&source.name),
            Self::Control(control) => write!(f, "{control}"),
        }
    }
}

impl Value {
    /// Its number, if it is a real one.
    pub fn as_number(&self) -> Option<f64> {
        if let Self::Number(x) = self { Some(*x) } else { None }
    }
}

impl From<f64> for Value {
    fn from(x: f64) -> Self {
        Self::Number(x)
    }
}

impl From<i64> for Value {
    fn from(n: i64) -> Self {
        Self::Integer(n)
    }
}

impl From<&str> for Value {
    fn from(text: &str) -> Self {
        Self::Text(text.to_owned())
    }
}

impl From<Control> for Value {
    fn from(control: Control) -> Self {
        Self::Control(control)
    }
}

impl Parameter {
    /// Whether `value` is the word that removes this row's value.
    pub(super) fn takes_away(&self, value: &Value) -> bool {
        value.is_none() && self.is_optional()
    }

    /// The value in this row's own type, if the row accepts it: whole numbers are numbers, and the words `displacement`
    /// and `force` are controls. The name of a file is a text until the file is read.
    ///
    /// # Errors
    /// The value has another type or is out of the row's range.
    pub fn check(&self, value: Value) -> Result<Value, Invalid> {
        match (self.kind, value) {
            (
                Kind::Positive | Kind::NonNegative | Kind::Finite | Kind::Between { .. } | Kind::Smoothing,
                Value::Number(x),
            ) => self.check_number(x),
            (
                Kind::Positive | Kind::NonNegative | Kind::Finite | Kind::Between { .. } | Kind::Smoothing,
                Value::Integer(n),
            ) => self.check_number(n as f64),
            (Kind::Integer { min, max }, Value::Integer(n)) => match n {
                n if (min..=max).contains(&n) => Ok(Value::Integer(n)),
                found if self.key == "format" => Err(Invalid::Format { found }),
                n => Err(self.out_of_range(&n.to_string())),
            },
            (Kind::Smoothing, Value::Text(word)) if word == AUTO || word == NONE => Ok(Value::Text(word)),
            (Kind::File, Value::Profile(rows)) => Ok(Value::Profile(rows)),
            (Kind::Points, Value::Points(source)) => Ok(Value::Points(source)),
            (Kind::File | Kind::Points, Value::Text(name)) => Ok(Value::Text(name)),
            // The rows that are apart may be none at all.
            (Kind::Text { .. }, Value::Text(word))
                if word == NONE
                    && matches!(self.fallback, Fallback::Text(""))
                    && self.key != data::FREE_PART =>
            {
                Ok(Value::Text(String::new()))
            }
            (Kind::Text { max_chars }, Value::Text(text)) => {
                if text.chars().nth(max_chars).is_some() {
                    Err(self.out_of_range(&format!("\"{}\"", quote(&text))))
                } else if text.chars().any(is_unsafe) {
                    Err(Invalid::Unprintable { key: self.key.clone(), value: quote(&text) })
                } else {
                    Ok(Value::Text(text))
                }
            }
            (Kind::Choice(words), Value::Text(word)) => {
                if words.contains(&word.as_str()) {
                    Ok(Value::Text(word))
                } else {
                    Err(self.no_choice(&word, words))
                }
            }
            (Kind::Control, Value::Control(Control::Stiffness(k))) => {
                if k.is_finite() && (SMALLEST..=LARGEST).contains(&k) {
                    Ok(Value::Control(Control::Stiffness(k)))
                } else {
                    Err(self.out_of_range(&format!("{{ stiffness = {k:?} }}")))
                }
            }
            (Kind::Control, Value::Control(control)) => Ok(Value::Control(control)),
            (Kind::Control, Value::Typed(text)) => Ok(Value::Typed(text)),
            (_, Value::Text(word)) if word == NONE && self.is_optional() => Ok(Value::Text(word)),
            (kind, Value::Text(text) | Value::Typed(text)) if kind.is_number() => self.check_typed(text),
            (Kind::Control, Value::Text(word)) => match word.as_str() {
                "displacement" => Ok(Value::Control(Control::Displacement)),
                "force" => Ok(Value::Control(Control::Force)),
                _ => Err(self.no_choice(&word, &["displacement", "force"])),
            },
            (_, other) => Err(self.wrong_type(other.described())),
        }
    }

    /// The value that a user typed: a TOML value, or a bare word; a control also as `stiffness=0.15` or `0.15`.
    ///
    /// # Errors
    /// The text is not a value of this row.
    pub fn parse(&self, text: &str) -> Result<Value, Invalid> {
        let text = text.trim();
        let bare = || Value::Text(text.to_owned());
        if let (Kind::Control, Ok(control)) = (self.kind, text.parse::<Control>()) {
            return self.check(Value::Control(control));
        }
        // A bare number is the stiffness of the device.
        if let (Kind::Control, Ok(stiffness)) = (self.kind, text.parse()) {
            return self.check(Value::Control(Control::Stiffness(stiffness)));
        }
        let stiffness = text.strip_prefix("stiffness=").unwrap_or(text);
        if let (Kind::Control, Ok(typed)) = (self.kind, parse_quantity(stiffness)) {
            let number = Value::Control(Control::Stiffness(typed.number));
            return self.check(typed.unit.map_or(number, |_| Value::Typed(stiffness.to_owned())));
        }
        if text.parse::<f64>().is_ok() && real(text).is_none() && self.kind.is_number() {
            return Err(self.out_of_range(text));
        }
        let value = match (self.kind, DeValue::parse(text)) {
            // Text that happens to look like a number is still text.
            (Kind::Text { .. } | Kind::File | Kind::Points, Ok(value)) => match value.get_ref() {
                DeValue::String(inner) => Value::Text(inner.to_string()),
                _ => bare(),
            },
            (_, Ok(value)) => Value::from_toml(value.get_ref()).map_err(|found| self.wrong_type(found))?,
            // Habits from Fortran and C that TOML does not share: .5, 5., +1e-3.
            (
                Kind::Positive | Kind::NonNegative | Kind::Finite | Kind::Between { .. } | Kind::Smoothing,
                Err(_),
            ) => real(text).map_or_else(bare, Value::Number),
            (_, Err(_)) => bare(),
        };
        self.check(value)
    }

    pub(super) fn wrong_type(&self, found: String) -> Invalid {
        Invalid::Type { key: self.key.clone(), found, allowed: self.allowed() }
    }

    /// A text that stands for a number: an expression becomes one at once, while a unit waits for the units of the
    /// preset.
    fn check_typed(&self, text: String) -> Result<Value, Invalid> {
        match parse_quantity(&text) {
            Ok(value) if value.unit.is_none() => self.check_number(value.number),
            Ok(_) => Ok(Value::Typed(text)),
            Err(cause) => Err(self.wrong_type(format!("{}: {cause}", Value::Text(text).described()))),
        }
    }

    fn check_number(&self, x: f64) -> Result<Value, Invalid> {
        let size = SMALLEST..=LARGEST;
        let fine = match self.kind {
            Kind::Positive | Kind::Smoothing => size.contains(&x),
            Kind::Between { min, max } => (min..=max).contains(&x),
            Kind::NonNegative => x == 0.0 || size.contains(&x),
            _ => x.abs() <= LARGEST,
        };
        // −0 becomes 0: nobody means that sign.
        if fine { Ok(Value::Number(x + 0.0)) } else { Err(self.out_of_range(&format!("{x:?}"))) }
    }

    fn out_of_range(&self, value: &str) -> Invalid {
        Invalid::Range { key: self.key.clone(), value: value.to_owned(), allowed: self.allowed() }
    }

    fn no_choice(&self, word: &str, words: &[&'static str]) -> Invalid {
        let meant = closest(word, words.iter().copied());
        // The borrow of `words` is shorter than its words' own.
        let meant = meant.and_then(|w| words.iter().copied().find(|known| *known == w)).map(Cow::Borrowed);
        Invalid::Choice { key: self.key.clone(), value: quote(word), allowed: self.allowed(), meant }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::preset::rows::parameter;

    fn parse(key: &str, text: &str) -> Result<Value, Invalid> {
        parameter(key).unwrap().parse(text)
    }

    #[test]
    fn typed_text_becomes_a_value_of_the_row() {
        assert_eq!(parse("gap.amplitude", "0"), Ok(0.0.into()));
        assert_eq!(parse("gap.amplitude", " 2.5e-3 "), Ok(2.5e-3.into()));
        assert_eq!(parse("gap.amplitude", ".5"), Ok(0.5.into()));
        assert_eq!(parse("gap.amplitude", "0.0e5"), Ok(0.0.into()));
        for text in ["1e-400", ".1e-400"] {
            assert!(parse("gap.amplitude", text).unwrap_err().to_string().contains(text));
        }
        assert_eq!(parse("path.start_force", "-0.0"), Ok(0.0.into()));
        assert_eq!(parse("basis.rings", "400"), Ok(400.into()));
        assert_eq!(parse("gap.shape", "sphere"), Ok("sphere".into()));
        assert_eq!(parse("gap.shape", "\"sphere\""), Ok("sphere".into()));
        assert_eq!(parse("title", "12"), Ok("12".into()));
        assert_eq!(parse("title", "Fig. 9, γ"), Ok("Fig. 9, γ".into()));
        assert_eq!(parse("path.control", "force"), Ok(Control::Force.into()));
        assert_eq!(parse("path.control", "stiffness=0.15"), Ok(Control::Stiffness(0.15).into()));
        assert_eq!(parse("path.rate", "none"), Ok("none".into()));
        assert_eq!(parse("path.control", " 15 "), Ok(Control::Stiffness(15.0).into()));
    }

    #[test]
    fn what_a_row_does_not_take_is_refused_with_the_reason() {
        for (key, text, words) in [
            (
                "gap.amplitude",
                "-1",
                "gap.amplitude = -1.0 is out of range: it must be 0 or a number from 1e-30",
            ),
            ("gap.wavelength", "0", "out of range"),
            ("gap.wavelength", "1e999", "out of range"),
            ("gap.wavelength", "nan", "out of range"),
            ("gap.wavelength", "inf", "out of range"),
            ("gap.wavelength", "1e-31", "out of range"),
            ("path.start_approach", "-inf", "out of range"),
            ("gap.wavelength", "1 2", "must be a number"),
            ("gap.wavelength", "none", "must be a number"),
            ("gap.wavelength", "1\nx = 2", "must be a number"),
            ("gap.wavelength", "", "must be a number"),
            ("gap.wavelength", "true", "not the boolean true"),
            ("basis.rings", "3", "from 4 to 2000"),
            ("basis.rings", "200.0", "whole number"),
            ("basis.rings", "99999999999999999999", "whole number"),
            ("gap.shape", "wavy_sphere", "did you mean wavy-sphere?"),
            ("path.control", "stiffness=-1", "stiffness = k"),
            ("path.control", "stiffness=1e99", "out of range"),
            ("path.control", "-0.15", "out of range"),
            ("path.control", "nan", "out of range"),
            ("path.control", "forse", "did you mean force?"),
            ("format", "2", "this version reads format 1"),
            ("title", "a\u{202e}b", "control or invisible"),
        ] {
            let message = parse(key, text).unwrap_err().to_string();
            assert!(message.contains(words), "{key}={text:?}: {message}");
            assert!(!message.chars().any(is_unsafe), "{message:?}");
        }
    }
}
