//! What the axes are divided by.
//!
//! | quantity | reduced axes | in its unit instead |
//! |---|---|---|
//! | force | P_c | without adhesion |
//! | radii | λ, else as other lengths | |
//! | other lengths | R, where the preset has no units | in an SI preset |
//! | pressure | E* | |

use super::parts::Axis;
use crate::explorer::{Axes, CurveData, View};
use pulloff_engine::gap::Gap;
use pulloff_engine::problem::Control;
use pulloff_engine::units::{Quantity, UnitSystem};

/// The divisors of the axes; an axis without one (no adhesion, no single wave) stays raw.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scale<'a> {
    /// `P_c`.
    pub force: Option<f64>,
    /// λ.
    pub wave: Option<f64>,
    /// R, for a preset without units.
    pub curvature: Option<f64>,
    pub modulus: Option<f64>,
    /// 1/k of the device, in the user's units; 0 without a spring.
    pub compliance: f64,
    /// The units in which the other axes are shown.
    pub units: &'a UnitSystem,
}

impl<'a> Scale<'a> {
    /// The divisors for `curve`.
    pub fn of(curve: &'a CurveData, axes: Axes) -> Self {
        let units = &curve.setting.preset.units;
        let compliance = match curve.setting.preset.path.control {
            Control::Stiffness(k) => 1.0 / k,
            Control::Displacement | Control::Force => 0.0,
        };
        if axes == Axes::Raw {
            return Self { compliance, ..Self::raw(units) };
        }
        let problem = &curve.case.problem;
        Self {
            force: Some(curve.base.critical_force).filter(|force| *force > 0.0),
            wave: problem.shape.wavelength(),
            curvature: problem.shape.radius_of_curvature().filter(|_| *units == UnitSystem::Reduced),
            modulus: Some(problem.effective_modulus),
            compliance,
            units,
        }
    }

    /// The divisors for another curve on the same axes: the same, because an axis has one unit; only the device is its own.
    #[must_use]
    pub fn of_other(self, curve: &CurveData, axes: Axes) -> Self {
        Self { compliance: Scale::of(curve, axes).compliance, ..self }
    }

    /// The divisors of the axes of `view` that are not those of another curve's own values, in words.
    pub fn unlike(&self, curve: &CurveData, axes: Axes, view: View) -> Option<&'static str> {
        let own = Scale::of(curve, axes);
        let differ =
            |a: Option<f64>, b: Option<f64>| a.zip(b).is_some_and(|(a, b)| (a - b).abs() > 1e-12 * a.abs());
        let has_radius = matches!(view, View::ForceRadius | View::RadiusApproach);
        let force = view.is_of_force() && differ(self.force, own.force);
        match (force, has_radius && differ(self.wave, own.wave)) {
            (false, false) => None,
            (true, false) => Some("Pc"),
            (false, true) => Some("λ"),
            (true, true) => Some("Pc and λ"),
        }
    }

    /// No divisors.
    pub fn raw(units: &'a UnitSystem) -> Self {
        Self { force: None, wave: None, curvature: None, modulus: None, compliance: 0.0, units }
    }

    /// The position of δ, P and s (in the user's units) in a view of the curve.
    pub fn place(self, view: View, [approach, force, radius]: [f64; 3]) -> (f64, f64) {
        let position = self.length(approach + self.compliance * force);
        let approach = self.length(approach);
        let force = self.force(force);
        let radius = self.radius(radius);
        match view {
            View::ForcePosition => (position, force),
            View::ForceRadius => (radius, force),
            View::RadiusApproach => (approach, radius),
            _ => (approach, force),
        }
    }

    /// A radius on its axis.
    pub fn radius(self, r: f64) -> f64 {
        self.wave.map_or_else(|| self.length(r), |wave| r / wave)
    }

    /// Any other length on its axis.
    pub fn length(self, x: f64) -> f64 {
        self.curvature.map_or_else(|| self.shown(Quantity::Length, x), |curvature| x / curvature)
    }

    /// A pressure on its axis.
    pub fn pressure(self, p: f64) -> f64 {
        self.modulus.map_or_else(|| self.shown(Quantity::Stress, p), |modulus| p / modulus)
    }

    /// The axes of a view of the curve: x, then y.
    pub fn axes(self, view: View) -> [Axis; 2] {
        match view {
            View::ForcePosition => [self.length_axis("Δ"), self.force_axis()],
            View::ForceRadius => [self.radius_axis("s"), self.force_axis()],
            View::RadiusApproach => [self.length_axis("δ"), self.radius_axis("s")],
            _ => [self.length_axis("δ"), self.force_axis()],
        }
    }

    /// The axes of δ, P and s.
    pub fn state_axes(self) -> [Axis; 3] {
        [self.length_axis("δ"), self.force_axis(), self.radius_axis("s")]
    }

    /// The axis of a radius with this name.
    pub fn radius_axis(self, name: &str) -> Axis {
        match self.wave {
            Some(_) => Axis::pure(format!("{name}/λ")),
            None => self.length_axis(name),
        }
    }

    /// The axis of the pressure.
    pub fn pressure_axis(self) -> Axis {
        match self.modulus {
            Some(_) => Axis::pure("p/E*".to_owned()),
            None => self.axis("p", "stress", Quantity::Stress),
        }
    }

    /// A force on its axis.
    pub fn force(self, p: f64) -> f64 {
        self.force.map_or_else(|| self.shown(Quantity::Force, p), |critical| p / critical)
    }

    /// The axis of the force.
    pub fn force_axis(self) -> Axis {
        match self.force {
            Some(_) => Axis::pure("P/Pc".to_owned()),
            None => self.axis("P", "force", Quantity::Force),
        }
    }

    /// The axis of another length with this name.
    pub fn length_axis(self, name: &str) -> Axis {
        match self.curvature {
            Some(_) => Axis::pure(format!("{name}/R")),
            None => self.axis(name, "length", Quantity::Length),
        }
    }

    /// The axis of a quantity without a divisor.
    pub fn axis(self, symbol: &str, unit: &'static str, quantity: Quantity) -> Axis {
        let shown = self.units.unit(quantity).map_or_else(String::new, ToString::to_string);
        Axis { unit, shown, ..Axis::pure(symbol.to_owned()) }
    }

    /// A value on an axis without a divisor.
    pub fn shown(self, quantity: Quantity, x: f64) -> f64 {
        self.units.shown(quantity, x).number
    }
}
