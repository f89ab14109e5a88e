//! How far an edge may go in one step, so that it never passes a limit point unseen.
//!
//! On both sides of a snap an implicit method finds a slow edge. A step over the whole snap would lose it without a
//! sign, because the error estimate would be content. Every limit point is known, and with it how far around it a
//! speed V rounds it off:
//!
//! ```text
//! X = √(2d/c''),     d = [V √(2/c'') (T_c/2)^{1/n}]^{2n/(2+n)},     T_c = T/δ_c
//! ```
//!
//! with c'' = d²c/ds² of the equilibrium curve there. Close to a limit point dx/dt = −(x² + t)^{1/n} in these units.

use super::equation::{HeldDisc, MovingEdge};
use super::law::Motion;
use super::settings::PullSettings;
use crate::disc::solution::ExactSolution;
use crate::disc::{Panels, Solution};
use crate::elementary::pow;
use crate::gap::panels::Variable;
use crate::problem::Control;
use crate::quasistatic::Monotone;
use crate::quasistatic::monotone::Limit;
use std::f64::consts::TAU;
use std::sync::Arc;

/// A limit point that a slow edge reaches.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fold {
    /// The limit point.
    pub limit: Limit,
    /// c'' on the curve, with respect to the contact radius; not finite at a corner.
    pub bend: f64,
    /// `T_c`.
    pub unit: f64,
}

impl Fold {
    fn new(panels: &Panels, limit: Limit, gamma: f64) -> Self {
        let s = limit.contact_radius;
        let [slope, second, _] = panels.slopes(limit.place);
        let root = (TAU * gamma * s).sqrt();
        // T' = T/2s, T'' = −T/4s².
        let [first, bend] = [slope - 0.5 * root / s, second + 0.25 * root / (s * s)];
        let by_root = 2.0 * first - root / s;
        let bend = match limit.control {
            Control::Displacement => bend,
            Control::Force => 2.0 * s * bend + by_root,
            Control::Stiffness(k) => bend * (1.0 + 2.0 * s / k) + by_root / k,
        };
        let unit = root / HeldDisc::new(panels, limit.control, s, 0.0).by_control;
        Self { limit, bend: if limit.corner { f64::INFINITY } else { bend.abs() }, unit }
    }

    /// d: at a rate V the control is late by this much, up to a number of the law.
    pub fn delay(&self, rate: f64, exponent: f64) -> f64 {
        let way = rate.abs() * (2.0 / self.bend).sqrt() * pow(0.5 * self.unit, 1.0 / exponent);
        pow(way, 2.0 * exponent / (2.0 + exponent))
    }
}

/// The limit points of one motion, ascending.
#[derive(Debug, Clone)]
pub struct MotionFolds {
    /// The limit points, from the axis outward.
    pub list: Vec<Fold>,
    /// Where the control is monotone.
    pub monotone: Monotone,
}

impl MotionFolds {
    /// The limit points of the equilibria under the adhesion of a motion.
    pub fn new(panels: &Arc<Panels>, edge: &MovingEdge, motion: Motion, control: Control) -> Self {
        let gamma = edge.adhesion(motion);
        let solution = ExactSolution::new(Arc::clone(panels), gamma);
        let monotone = Monotone::of(&solution, control);
        let list = monotone.limits.iter().map(|limit| Fold::new(panels, *limit, gamma)).collect();
        Self { list, monotone }
    }

    /// The radii between which equilibria are not stable.
    pub fn unstable(&self) -> Vec<[f64; 2]> {
        self.monotone.stretches.iter().filter(|at| !at.rising).map(|at| at.radii).collect()
    }

    /// dc/ds of the equilibria at a radius.
    pub fn slope(&self, panels: &Arc<Panels>, gamma: f64, s: f64) -> f64 {
        let solution = ExactSolution::new(Arc::clone(panels), gamma);
        let Some(place) = solution.place(s) else { return f64::NAN };
        let slopes = solution.at(place).stability();
        self.monotone.control.value(slopes.approach, slopes.force)
    }
}

/// How far an edge may go from a radius in one step.
#[derive(Debug, Clone)]
pub struct Caps<'a> {
    panels: &'a Panels,
    /// Limit points, ascending, each with the way that an edge may always go near it.
    folds: Vec<[f64; 2]>,
    /// Radii at which a step ends: breaks of the gap, ascending.
    breaks: Vec<f64>,
    /// The longest way of a step on a gap with waves.
    widest: Option<f64>,
    settings: PullSettings,
}

impl<'a> Caps<'a> {
    /// The caps of a motion at a rate of the control; `wave` is the length of the gap's structure, where it is known.
    pub fn new(
        panels: &'a Panels,
        folds: &MotionFolds,
        rate: f64,
        exponent: f64,
        wave: Option<f64>,
        settings: PullSettings,
    ) -> Self {
        /// The least way that an edge may always go, as a share of its radius.
        const LEAST: f64 = 1e-8;
        let rounding = |fold: &Fold| {
            let s = fold.limit.contact_radius;
            let way = (2.0 * fold.delay(rate, exponent) / fold.bend).sqrt();
            [s, (settings.of_rounding * way).max(LEAST * s)]
        };
        let is_break = |span: &crate::gap::panels::Span| matches!(span.variable, Variable::Root { base } if base.total_cmp(&span.lo).is_eq() && base > 0.0);
        Self {
            panels,
            folds: folds.list.iter().map(rounding).collect(),
            breaks: panels
                .list()
                .iter()
                .filter(|panel| is_break(&panel.span))
                .map(|panel| panel.span.lo)
                .collect(),
            widest: wave.map(|wave| settings.of_wave * wave),
            settings,
        }
    }

    /// How far the edge may go from the radius `s`.
    pub fn at(&self, s: f64) -> f64 {
        let span = &self.panels.list()[self.panels.place(s).panel].span;
        let usual = self.widest.unwrap_or(self.settings.of_panel * (span.hi - span.lo));
        let near = self.folds.partition_point(|[fold, _]| *fold < s);
        let around = &self.folds[near.saturating_sub(1)..(near + 1).min(self.folds.len())];
        let ways = around.iter().map(|[fold, least]| least.max(self.settings.of_distance * (s - fold).abs()));
        ways.fold(usual, f64::min)
    }

    /// The next break from the radius `s` on.
    pub fn next_break(&self, motion: Motion, s: f64) -> Option<f64> {
        /// A radius this near to a break, as a share of itself, is on it.
        const ON: f64 = 1e-11;
        match motion {
            Motion::Opening => {
                let inner = self.breaks.partition_point(|at| *at < s * (1.0 - ON));
                inner.checked_sub(1).map(|at| self.breaks[at])
            }
            Motion::Closing => self.breaks.iter().copied().find(|at| *at > s * (1.0 + ON)),
        }
    }
}
