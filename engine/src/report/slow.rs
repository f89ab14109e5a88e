//! The largest pull of slow pulls as a function of their rate, in closed form: the quasi-static value and its
//! first-order correction.
//!
//! ```text
//! P = P* − E*s*T* (V s*/(T* v₀))ⁿ,    T* = √(2πγs*/E*)
//! ```
//!
//! At a smooth minimum of P the edge passes the state of the smallest force at the speed V s*/T* of its equilibria,
//! and at this speed it costs γ (V s*/(T* v₀))ⁿ more. This holds for any gap, under fixed grips or a spring.

use super::pull::{PullError, law};
use crate::case::Case;
use crate::elementary::pow;
use crate::preset::Preset;
use crate::problem::Control;
use crate::progress::Progress;
use crate::quasistatic::Detail;
use crate::quasistatic::path::{Event, EventKind, Losses, PathSetting};
use std::f64::consts::TAU;

/// The law of a preset; numbers in its units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SlowPulls {
    /// P*, the smallest force of the unloading of one disc.
    pub force: f64,
    /// What the first order takes off it at the rate 1, and n; `None` where P* is at a limit point of the control, or
    /// under a dead load.
    first: Option<[f64; 2]>,
}

impl SlowPulls {
    /// The law of `preset`, whose rates are those of the controlled quantity; `None` where its path has no state.
    ///
    /// # Errors
    /// [`PullError`].
    pub fn of(preset: &Preset, progress: &dyn Progress) -> Result<Option<Self>, PullError> {
        let case = Case::prepare(preset, progress)?;
        let (law, speed) = law(preset)?;
        let curve = case.curve_in(Detail::Borders, progress)?;
        let (losses, detail) = (Losses::Once, Detail::Borders);
        let setting =
            PathSetting { losses, detail, closing: case.closing, ..PathSetting::one_disc(case.control) };
        let path = case.unload(&curve, &setting, progress)?;
        let Some(at) = path.largest_pull() else { return Ok(None) };
        let units = case.units();
        let leaves = |event: &Event| {
            let is_here = |radius: f64| radius.to_bits() == at.contact_radius.to_bits();
            event.kind != EventKind::Depin
                && event.before.as_ref().is_some_and(|before| is_here(before.contact_radius))
        };
        let is_smooth = case.control != Control::Force && !path.events.iter().any(leaves);
        let s = at.contact_radius;
        let stretch = (TAU * case.reduced.work_of_adhesion * s).sqrt();
        // In reduced units a rate is divided by v₀.
        let first = s * stretch * pow(s / (stretch * speed), law.exponent) * units.force;
        Ok(Some(Self { force: at.force * units.force, first: is_smooth.then_some([first, law.exponent]) }))
    }

    /// P at a rate, to the first order.
    pub fn at(&self, rate: f64) -> Option<f64> {
        self.first.map(|[first, exponent]| self.force - first * pow(rate, exponent))
    }
}
