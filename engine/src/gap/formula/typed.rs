//! A gap as a user types it: the formula's text, its parameters, and what follows from both.

use super::gap::FormulaGap;
use super::survey::NoGap;
use super::{BindError, Formula, FormulaError};
use crate::units::UnitSystem;
use thiserror::Error;

/// The most parameters of one formula.
pub const MOST_PARAMETERS: usize = 64;

/// The parameter that is taken as the radius of curvature.
pub const RADIUS: &str = "R";

/// How far the length of a gap without a radius of curvature is looked for, relative to the first radius asked for.
const DECADES: i32 = 12;

/// A parameter of a formula with its value.
#[derive(Debug, Clone, PartialEq)]
pub struct FormulaParameter {
    /// Its name in the formula.
    pub name: String,
    /// Its value, in the units of the formula.
    pub value: f64,
    /// The smallest value that makes sense to the author of the formula.
    pub min: Option<f64>,
    /// The largest value that makes sense to the author of the formula.
    pub max: Option<f64>,
    /// The unit beside it in its file; the value here is in SI or in reduced units.
    pub unit: Option<String>,
}

/// A formula with its parameters, as a gap. Two are equal when the formula and the parameters are: the rest follows.
#[derive(Debug, Clone)]
pub struct TypedGap {
    formula: Formula,
    parameters: Vec<FormulaParameter>,
    gap: FormulaGap,
    length: Option<f64>,
}

/// Why a text and its parameters are no gap.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum TypedError {
    /// The text is no formula.
    #[error(transparent)]
    Formula(#[from] FormulaError),
    /// The parameters do not fit it.
    #[error(transparent)]
    Bind(#[from] BindError),
    /// More than [`MOST_PARAMETERS`].
    #[error("the formula has {0} parameters, more than {MOST_PARAMETERS}")]
    TooMany(usize),
    /// It is not finite where it must be, or jumps.
    #[error(transparent)]
    NoGap(#[from] NoGap),
}

impl TypedError {
    /// What is wrong, with lengths as `units` show them.
    pub fn words(&self, units: &UnitSystem) -> String {
        match self {
            Self::NoGap(cause) => cause.words(units),
            other => other.to_string(),
        }
    }
}

impl PartialEq for TypedGap {
    fn eq(&self, other: &Self) -> bool {
        (&self.formula, &self.parameters) == (&other.formula, &other.parameters)
    }
}

impl TypedGap {
    /// The gap of the formula `text`. Up to the radius `start` it must be finite, and its waves are looked for there;
    /// without a `start`, up to its own length. Beyond that, it is known as far as it stays finite.
    ///
    /// # Errors
    /// What is wrong with the text or the parameters, or the first radius where the gap is not finite.
    pub fn new(
        text: &str,
        parameters: Vec<FormulaParameter>,
        start: Option<f64>,
    ) -> Result<Self, TypedError> {
        let formula = Formula::parse(text)?;
        if formula.parameters().len() > MOST_PARAMETERS {
            return Err(TypedError::TooMany(formula.parameters().len()));
        }
        let values: Vec<(&str, f64)> = parameters.iter().map(|p| (p.name.as_str(), p.value)).collect();
        let bound = formula.bind(&values)?;
        let radius = parameters.iter().find(|p| p.name == RADIUS && p.value > 0.0).map(|p| p.value);
        let length = radius.or_else(|| half_slope(|r| bound.jet(r).value, start.unwrap_or(1.0)));
        let needed = start.or(length).unwrap_or(1.0);
        Ok(Self { gap: bound.from_axis(needed, start.is_some())?, formula, parameters, length })
    }

    /// The formula.
    pub fn formula(&self) -> &Formula {
        &self.formula
    }

    /// Its parameters, in the order in which the formula names them.
    pub fn parameters(&self) -> &[FormulaParameter] {
        &self.parameters
    }

    /// The formula as a gap.
    pub fn gap(&self) -> &FormulaGap {
        &self.gap
    }

    /// The value of the formula on the axis, which is subtracted because a gap is zero there; `None` where it is no
    /// more than the rounding of the gap's own values.
    pub fn shift(&self) -> Option<f64> {
        let bound = self.gap.bound();
        let size = bound.jet(self.length.unwrap_or(1.0)).value.abs();
        Some(bound.offset()).filter(|offset| offset.abs() > f64::EPSILON * size)
    }

    /// The value of the parameter `R`, where there is one and it is positive.
    pub fn radius_of_curvature(&self) -> Option<f64> {
        self.parameters.iter().find(|p| p.name == RADIUS && p.value > 0.0).map(|p| p.value)
    }

    /// The length by which the problem is reduced: `R`, otherwise the radius where h = r/2, as for a paraboloid, h(R) =
    /// R/2.
    pub fn length(&self) -> Option<f64> {
        self.length
    }
}

/// The smallest radius with h = r/2, searched around the radius `near` in factors of two.
fn half_slope(h: impl Fn(f64) -> f64, near: f64) -> Option<f64> {
    let steep = |r: f64| h(r) >= 0.5 * r;
    let radii = (-4 * DECADES..=4 * DECADES).map(|k| near * 2f64.powi(k));
    let mut before = None;
    for r in radii {
        if steep(r) {
            // A gap that is steep from the first radius on is a cone, which has no length of its own.
            let (mut low, mut high) = (before?, r);
            for _ in 0..60 {
                let middle = 0.5 * (low + high);
                if steep(middle) { high = middle } else { low = middle }
            }
            return Some(high);
        }
        before = Some(r);
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gap::Gap;

    fn given(name: &str, value: f64) -> FormulaParameter {
        FormulaParameter { name: name.to_owned(), value, min: None, max: None, unit: None }
    }

    fn typed(text: &str, parameters: &[(&str, f64)], start: Option<f64>) -> Result<TypedGap, TypedError> {
        TypedGap::new(text, parameters.iter().map(|(name, value)| given(name, *value)).collect(), start)
    }

    #[test]
    fn the_length_is_r_or_where_the_gap_is_half_the_radius() {
        let gap = typed("r^2/(2*R)", &[("R", 3.0)], Some(0.5)).unwrap();
        assert_eq!((gap.radius_of_curvature(), gap.length()), (Some(3.0), Some(3.0)));
        let gap = typed("r^2/(2*a)", &[("a", 3e-3)], Some(1e-4)).unwrap();
        assert_eq!(gap.radius_of_curvature(), None);
        assert!((gap.length().unwrap() / 3e-3 - 1.0).abs() < 1e-12);
        for cone in ["0.1*r", "2*r"] {
            assert_eq!(typed(cone, &[], Some(0.5)).unwrap().length(), None, "{cone}");
        }
    }

    #[test]
    fn a_gap_is_known_as_far_as_it_is_finite() {
        let text = "R - sqrt(R^2 - r^2)";
        let gap = typed(text, &[("R", 1.0)], Some(0.5)).unwrap();
        let known = gap.gap().largest_radius().unwrap();
        assert!((known - 1.0).abs() < 1e-6 && gap.gap().jet(0.999).value.is_finite());
        assert!(gap.gap().jet(1.1).value.is_nan());
        let short = typed(text, &[("R", 0.4)], Some(0.5)).unwrap_err();
        assert!(short.to_string().starts_with("the formula is not finite at r = 0.4"), "{short}");
        assert_eq!(typed("r^2", &[], Some(0.5)).unwrap().gap().largest_radius(), None);
    }

    #[test]
    fn many_parameters_are_refused() {
        let names: Vec<String> = (0..=MOST_PARAMETERS).map(|i| format!("a{i}")).collect();
        let error = typed(&names.join("+"), &[], None).unwrap_err();
        assert_eq!(error.to_string(), "the formula has 65 parameters, more than 64");
    }
}
