//! One disc under a device, with an edge that has a speed: the equation of motion of one stretch.
//!
//! ```text
//! K = g(s) − δ      T = √(2πγs)      κ = K/T = √(G/γ)      c: δ, P or Δ = δ + P/k, moved at the rate ċ
//! ∂δ/∂s at held c = 0, K/s, 2K/(k + 2s)          ∂δ/∂c at held s = 1, 1/2s, k/(k + 2s)
//! T dκ/dt = (g' − κT/2s − δ_s) ṡ − δ_c ċ
//! ```
//!
//! It is integrated over a mixture ξ of the way of the edge and of time, in which its right-hand side is bounded and
//! smooth through every snap and every rest:
//!
//! ```text
//! ξ = y + (t − t₀)/L_t,    s = s₀ ± L_s y,    dy/dξ = φ = (v/L_s)/(v/L_s + 1/L_t) ∈ [0, 1)
//! ```
//!
//! As a function of s, dt/ds = 1/v grows with the control that is left: integrated along the way of the edge, every
//! error dies out, on stable and unstable stretches alike. Reduced units: E* = 1, v₀ = 1.

use super::law::{EdgeLaw, Motion, MotionLaw};
use crate::disc::Panels;
use crate::problem::Control;
use std::f64::consts::TAU;

/// The law of a moving edge and what its motion costs or gains: γ where the edge opens, `γ_a` where it closes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MovingEdge {
    /// The law.
    pub law: EdgeLaw,
    /// γ, over E* times the unit of length.
    pub opening: f64,
    /// `γ_a` ≤ γ.
    pub closing: f64,
}

impl MovingEdge {
    /// The adhesion of a motion.
    pub fn adhesion(&self, motion: Motion) -> f64 {
        match motion {
            Motion::Opening => self.opening,
            Motion::Closing => self.closing,
        }
    }
}

/// A disc whose bodies are held by a device.
#[derive(Debug, Clone, Copy, Default)]
pub struct HeldDisc {
    /// s.
    pub contact_radius: f64,
    /// δ.
    pub approach: f64,
    /// P.
    pub force: f64,
    /// K = g − δ, not negative where the edge is not pressed.
    pub opening: f64,
    /// ∂δ/∂s at held c.
    pub by_radius: f64,
    /// ∂δ/∂c at held s.
    pub by_control: f64,
    /// g'.
    pub slope: f64,
    /// ∫₀ˢ g.
    pub area: f64,
}

impl HeldDisc {
    /// The disc of the radius `s` at the control value `c`.
    pub fn new(panels: &Panels, control: Control, s: f64, c: f64) -> Self {
        let [values] = panels.values_at(&[s]);
        Self::of(values, control, s, c)
    }

    /// The same from g, ∫g and g' at its radius.
    fn of([value, area, slope]: [f64; 3], control: Control, s: f64, c: f64) -> Self {
        let approach = match control {
            Control::Displacement => c,
            Control::Force => (0.5 * c + area) / s,
            Control::Stiffness(k) => (k * c + 2.0 * area) / (k + 2.0 * s),
        };
        let opening = value - approach;
        let [by_radius, by_control] = match control {
            Control::Displacement => [0.0, 1.0],
            Control::Force => [opening / s, 0.5 / s],
            Control::Stiffness(k) => [2.0 * opening / (k + 2.0 * s), k / (k + 2.0 * s)],
        };
        let force = if control == Control::Force { c } else { 2.0 * (approach * s - area) };
        Self { contact_radius: s, approach, force, opening, by_radius, by_control, slope, area }
    }

    /// The control value at which the disc of the radius `s` is in equilibrium under the adhesion γ.
    pub fn equilibrium(panels: &Panels, control: Control, gamma: f64, s: f64) -> f64 {
        let [value, area] = panels.value_and_area(panels.place(s));
        let approach = value - (TAU * gamma * s).sqrt();
        control.value(approach, 2.0 * (approach * s - area))
    }

    /// G.
    pub fn energy_release_rate(&self) -> f64 {
        self.opening * self.opening / (TAU * self.contact_radius)
    }

    /// The elastic potential of bodies and device: U, U − Pδ, or U + P²/2k without adhesion.
    pub fn potential(&self, panels: &Panels, control: Control) -> f64 {
        let (s, delta, p) = (self.contact_radius, self.approach, self.force);
        let square = panels.square(panels.place(s));
        let elastic = delta * delta * s - 2.0 * delta * self.area + square;
        match control {
            Control::Displacement => elastic,
            Control::Force => elastic - p * delta,
            Control::Stiffness(k) => elastic + 0.5 * p * p / k,
        }
    }
}

/// A moment of a stretch, with what the integrator needs there.
#[derive(Debug, Clone, Copy, Default)]
pub struct StretchMoment {
    /// t.
    pub time: f64,
    /// c.
    pub control: f64,
    /// The disc.
    pub held: HeldDisc,
    /// What drives the edge: G/γ − 1 or `γ_a`/G − 1.
    pub drive: f64,
    /// Its derivative by y at held ξ.
    pub drive_by_y: f64,
    /// Its derivative by time.
    pub drive_rate: f64,
    /// v, not negative except by rounding.
    pub speed: f64,
    /// φ.
    pub phi: f64,
    /// Its derivative by y.
    pub phi_by_y: f64,
    /// dP/dt.
    pub force_rate: f64,
    /// What is dissipated per unit of y.
    pub loss: f64,
    /// The work of the device per unit of the rest of ξ.
    pub done: f64,
}

impl StretchMoment {
    /// What is dissipated per unit of ξ.
    pub fn dissipation(&self) -> f64 {
        self.loss * self.phi
    }

    /// The work of the device per unit of ξ.
    pub fn work(&self) -> f64 {
        self.done * (1.0 - self.phi)
    }
}

/// The equation of motion of one stretch.
#[derive(Debug, Clone, Copy)]
pub struct Equation<'a> {
    /// The gap, as its table has it.
    pub panels: &'a Panels,
    /// The device.
    pub control: Control,
    /// Whether the edge opens or closes.
    pub motion: Motion,
    /// The law of the motion.
    pub branch: MotionLaw,
    /// γ or `γ_a`.
    pub adhesion: f64,
    /// s₀, the radius where it begins.
    pub radius: f64,
    /// t where it begins, in units of the length over v₀.
    pub time: f64,
    /// c there.
    pub value: f64,
    /// dc/dt.
    pub rate: f64,
    /// `L_t`; `L_s` is s₀.
    pub unit_of_time: f64,
}

impl<'a> Equation<'a> {
    /// The motion of the edge `edge` from s₀, t₀, c₀ while the control changes at `rate`; `duration` counts where the
    /// control is held.
    pub fn new(
        panels: &'a Panels,
        control: Control,
        edge: &MovingEdge,
        motion: Motion,
        [radius, time, value]: [f64; 3],
        rate: f64,
        duration: f64,
    ) -> Self {
        let adhesion = edge.adhesion(motion);
        let held = HeldDisc::new(panels, control, radius, value);
        let unit_of_control = (TAU * adhesion * radius).sqrt() / held.by_control;
        let unit_of_time = if rate == 0.0 { duration } else { unit_of_control / rate.abs() };
        let branch = edge.law.of(motion);
        Self { panels, control, motion, branch, adhesion, radius, time, value, rate, unit_of_time }
    }

    /// The moment at ξ and y; `None` where the disc would have no radius there, or one beyond the table.
    pub fn at(&self, xi: f64, y: f64) -> Option<StretchMoment> {
        let mut moment = [StretchMoment::default()];
        self.fill(&[xi], &[y], &mut moment).map(|()| moment[0])
    }

    /// Several moments at once, into `all`.
    pub fn fill<const N: usize>(
        &self,
        xi: &[f64; N],
        y: &[f64; N],
        all: &mut [StretchMoment; N],
    ) -> Option<()> {
        let (sense, reach) = (self.motion.sense(), self.panels.reach());
        let radii = y.map(|y| self.radius + sense * self.radius * y);
        if !radii.iter().all(|s| *s > 0.0 && *s <= reach) {
            return None;
        }
        let values = self.panels.values_at(&radii);
        for (i, at) in all.iter_mut().enumerate() {
            self.moment([xi[i], y[i]], radii[i], values[i], at)?;
        }
        Some(())
    }

    /// The moment at ξ and y, where the radius is s and g, ∫g and g' are `values`.
    fn moment(&self, [xi, y]: [f64; 2], s: f64, values: [f64; 3], into: &mut StretchMoment) -> Option<()> {
        let (sense, ls, lt) = (self.motion.sense(), self.radius, self.unit_of_time);
        let passed = lt * (xi - y);
        let control = self.value + self.rate * passed;
        let held = HeldDisc::of(values, self.control, s, control);
        let root = (TAU * self.adhesion * s).sqrt();
        let over_root = 1.0 / root;
        let kappa = held.opening * over_root;
        let kappa_by_s = (held.slope - held.by_radius) * over_root - 0.5 * kappa / s;
        let kappa_by_c = -held.by_control * over_root;
        let [drive, by_kappa] = match self.motion {
            // (K − T)(K + T)/T²: what is left near equilibrium keeps its digits.
            Motion::Opening => [(held.opening - root) * (kappa + 1.0) * over_root, 2.0 * kappa],
            // An edge that is pressed closes without bound.
            Motion::Closing if kappa <= 0.0 => return None,
            Motion::Closing => {
                let inverse = 1.0 / (kappa * kappa);
                [(root - held.opening) * (1.0 + kappa) * over_root * inverse, -2.0 * inverse / kappa]
            }
        };
        let [speed, speed_by_drive] = self.branch.speed(drive);
        let (along, in_time) = (speed / ls, 1.0 / lt);
        let over_whole = 1.0 / (along.abs() + in_time);
        let phi = along * over_whole;
        let drive_by_y = by_kappa * (kappa_by_s * sense * ls - kappa_by_c * self.rate * lt);
        let phi_by_y = in_time * over_whole * over_whole / ls * speed_by_drive * drive_by_y;
        let drive_rate = by_kappa * (kappa_by_s * sense * speed + kappa_by_c * self.rate);
        let force_by_s = 2.0 * (s * held.by_radius - held.opening);
        let force_rate = force_by_s * sense * speed + 2.0 * s * held.by_control * self.rate;
        let gain = (held.opening - root) * (held.opening + root);
        let done = match self.control {
            Control::Force => -held.approach,
            Control::Displacement | Control::Stiffness(_) => held.force,
        };
        *into = StretchMoment {
            time: self.time + passed,
            control,
            held,
            drive,
            drive_by_y,
            drive_rate,
            speed,
            phi,
            phi_by_y,
            force_rate,
            // (G − γ) 2πs ds, of which 2πs is in the gain.
            loss: -sense * gain * ls,
            done: done * self.rate * lt,
        };
        Some(())
    }

    /// The drive at the speed v/v₀ that belongs to φ, with its derivative.
    pub fn drive_of(&self, phi: f64) -> [f64; 2] {
        let unit = self.radius / self.unit_of_time;
        let rest = (1.0 - phi.abs()).max(f64::MIN_POSITIVE);
        let [drive, slope] = self.branch.drive(unit * phi / rest);
        [drive, slope * unit / (rest * rest)]
    }
}
