//! What the axes are divided by.

use super::parts::Axis;
use crate::contact::Gap;
use crate::explorer::{Axes, CurveData, View};

/// The divisors of the axes; without adhesion there is no `P_c`, without waves no λ, and those axes stay raw.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scale {
    /// `P_c`.
    pub force: Option<f64>,
    /// λ.
    pub wave: Option<f64>,
    /// E*.
    pub modulus: Option<f64>,
}

impl Scale {
    /// The divisors for `curve`.
    pub fn of(curve: &CurveData, axes: Axes) -> Self {
        if axes == Axes::Raw {
            return Self { force: None, wave: None, modulus: None };
        }
        let problem = &curve.setting.case.problem;
        Self {
            force: Some(curve.sweep.critical_force).filter(|force| *force > 0.0),
            wave: problem.shape.feature_length(),
            modulus: Some(problem.effective_modulus),
        }
    }

    /// The place of δ, P and s (in the user's units) in a view of the curve.
    pub fn place(self, view: View, [approach, force, radius]: [f64; 3]) -> (f64, f64) {
        let force = force / self.force.unwrap_or(1.0);
        let radius = self.radius(radius);
        match view {
            View::RadiusForce => (force, radius),
            View::RadiusApproach => (approach, radius),
            _ => (approach, force),
        }
    }

    /// A radius on its axis.
    pub fn radius(self, r: f64) -> f64 {
        r / self.wave.unwrap_or(1.0)
    }

    /// A pressure on its axis.
    pub fn pressure(self, p: f64) -> f64 {
        p / self.modulus.unwrap_or(1.0)
    }

    /// The axes of a view of the curve: x, then y.
    pub fn axes(self, view: View) -> [Axis; 2] {
        match view {
            View::RadiusForce => [self.force_axis(), self.radius_axis("s")],
            View::RadiusApproach => [length("δ"), self.radius_axis("s")],
            _ => [length("δ"), self.force_axis()],
        }
    }

    /// The axis of a radius of this name.
    pub fn radius_axis(self, name: &str) -> Axis {
        match self.wave {
            Some(_) => Axis { symbol: format!("{name}/λ"), unit: "" },
            None => length(name),
        }
    }

    /// The axis of the pressure.
    pub fn pressure_axis(self) -> Axis {
        match self.modulus {
            Some(_) => Axis { symbol: "p/E*".to_owned(), unit: "" },
            None => Axis { symbol: "p".to_owned(), unit: "stress" },
        }
    }

    fn force_axis(self) -> Axis {
        match self.force {
            Some(_) => Axis { symbol: "P/Pc".to_owned(), unit: "" },
            None => Axis { symbol: "P".to_owned(), unit: "force" },
        }
    }
}

/// The axis of a length of this name.
pub fn length(name: &str) -> Axis {
    Axis { symbol: name.to_owned(), unit: "length" }
}
