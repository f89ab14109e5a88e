//! The law of stability of one disc, exact for any gap and any device.
//!
//! ```text
//! F(s) = W_k(s) g'(s),     γ_k(s) = (2E*/π) F²   where g' > 0, else 0
//! state s is stable  ⇔  γ < γ_k(s),    a limit point  ⇔  γ = γ_k(s)
//! ```
//!
//! One curve answers for every work of adhesion: the line of constant γ cuts it at all limit points. At its extrema
//! pairs of limit points are born: F' = 0, a cusp. Where h'' jumps, `γ_k` has a corner and no derivative; an extremum
//! there is not a cusp.

use super::weight::Weight;
use crate::disc::chebyshev::{self, ChebyshevRule, ROOT_NODES};
use crate::disc::{Panels, Place};
use crate::gap::panels::Variable;
use crate::problem::Control;
use std::f64::consts::FRAC_PI_2;
use std::sync::Arc;

/// Values of F' below this share of its terms are rounding.
const ROUNDING: f64 = 1e-11;

/// If the derivative of g' by the panel's variable is below this share of its size at the break, h'' does not jump
/// there.
const SMOOTH: f64 = 1e-8;

/// F = `W_k g'` and its derivatives by s at one radius, reduced.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EdgeJet {
    /// F.
    pub value: f64,
    /// F'.
    pub slope: f64,
    /// F''.
    pub bend: f64,
}

impl EdgeJet {
    /// F from the derivatives of g at the radius `s`.
    pub fn of(control: Control, s: f64, [first, second, third]: [f64; 3]) -> Self {
        let Weight { value, slope, bend } = Weight::of(control, s);
        Self {
            value: value * first,
            slope: value * (slope * first + second),
            bend: value * ((slope * slope + bend) * first + 2.0 * slope * second + third),
        }
    }
}

/// √(πγ/2) of a reduced work of adhesion; F is compared with it.
pub fn root_of(work_of_adhesion: f64) -> f64 {
    (FRAC_PI_2 * work_of_adhesion).sqrt()
}

/// The reduced γ that belongs to F: zero where F is not positive.
pub fn adhesion_of(value: f64) -> f64 {
    let f = value.max(0.0);
    f * f / FRAC_PI_2
}

/// A place at which F has an extremum along the radius: at this adhesion a pair of limit points is born.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cusp {
    /// s, reduced.
    pub contact_radius: f64,
    /// F there.
    pub value: f64,
    /// Whether F has a minimum there.
    pub is_minimum: bool,
}

/// The law of one gap under one device.
#[derive(Debug, Clone)]
pub struct Law {
    /// The table of g.
    pub panels: Arc<Panels>,
    /// The device, reduced.
    pub control: Control,
}

impl Law {
    /// F at the radius `s`; `None` beyond the table or on its innermost panel, which holds no limit point.
    pub fn edge(&self, s: f64) -> Option<EdgeJet> {
        let place = self.place(s)?;
        Some(EdgeJet::of(self.control, s, self.panels.slopes(place)))
    }

    /// `γ_k(s)`, reduced; zero where g' ≤ 0, `None` beyond the table.
    pub fn critical(&self, s: f64) -> Option<f64> {
        let place = self.place(s)?;
        let slope = self.panels.weighted_slope(place) / self.panels.list()[place.panel].weight(place.x);
        Some(adhesion_of(Weight::of(self.control, s).value * slope))
    }

    /// [`Law::critical`] at many radii in ascending or descending order; NaN where there is none.
    pub fn over(&self, radii: &[f64]) -> Vec<f64> {
        let mut found = Vec::with_capacity(radii.len());
        let mut rest = radii;
        while let Some((s, others)) = rest.split_first() {
            // Eight at a time if they lie on one panel.
            let place = self.place(*s);
            let eight = rest.first_chunk::<8>().zip(place).filter(|(eight, place)| {
                let span = &self.panels.list()[place.panel].span;
                eight.iter().all(|s| span.lo < *s && *s <= span.hi)
            });
            if let Some((eight, place)) = eight {
                let slopes = self.panels.eight_slopes(place.panel, eight);
                let pairs = eight.iter().zip(slopes);
                found.extend(pairs.map(|(s, slope)| adhesion_of(Weight::of(self.control, *s).value * slope)));
                rest = &rest[8..];
            } else {
                found.push(self.critical(*s).unwrap_or(f64::NAN));
                rest = others;
            }
        }
        found
    }

    fn place(&self, s: f64) -> Option<Place> {
        let known = s > 0.0 && s <= self.panels.reach();
        known.then(|| self.panels.place(s)).filter(|place| place.panel > 0)
    }

    /// The extrema of F with F > 0 between two radii, ascending, and the radii of the corners of F between them.
    pub fn cusps(&self, [from, to]: [f64; 2]) -> (Vec<Cusp>, Vec<f64>) {
        let (mut cusps, mut corners) = (Vec::new(), Vec::new());
        let mut before: Option<bool> = None;
        for (panel, of) in self.panels.list().iter().enumerate().skip(1) {
            if of.span.hi < from {
                continue;
            }
            if of.span.lo > to {
                break;
            }
            let power = self.singular(panel);
            let series = self.tendency(panel, power);
            let starts = chebyshev::sum(&series, -1.0) > 0.0;
            let border = of.span.lo;
            let wanted = |s: f64| from <= s && s <= to;
            if power > 0 && wanted(border) {
                corners.push(border);
            } else if before.is_some_and(|before| before != starts) {
                self.push(border, starts, wanted, &mut cusps);
            }
            let size: f64 = series.iter().map(|c| c.abs()).sum();
            let mut grows = starts;
            for x in chebyshev::roots(&series, ROUNDING * size) {
                grows = !grows;
                self.push(of.span.radius(x), grows, wanted, &mut cusps);
            }
            before = Some(grows);
        }
        (cusps, corners)
    }

    fn push(&self, s: f64, is_minimum: bool, wanted: impl Fn(f64) -> bool, cusps: &mut Vec<Cusp>) {
        let edge = self.edge(s).filter(|edge| edge.value > 0.0 && wanted(s));
        cusps.extend(edge.map(|edge| Cusp { contact_radius: s, value: edge.value, is_minimum }));
    }

    /// The power of the stretch that makes F' smooth on a panel: 3 if h' jumps at its inner end, 1 if h'' does,
    /// otherwise 0.
    fn singular(&self, panel: usize) -> i32 {
        let of = &self.panels.list()[panel];
        match of.span.variable {
            Variable::Root { base } if base >= of.span.lo => {
                if of.is_steep() {
                    return 3;
                }
                let series = self.panels.slope_series(panel);
                let size: f64 = series.iter().map(|c| c.abs()).sum();
                let jump = chebyshev::sum_and_slope(&series, -1.0)[1];
                i32::from(jump.abs() > SMOOTH * size)
            }
            _ => 0,
        }
    }

    /// On a panel, the series of F' times this power of the stretch.
    fn tendency(&self, panel: usize, power: i32) -> Vec<f64> {
        let span = self.panels.list()[panel].span;
        ChebyshevRule::of(ROOT_NODES).series(|x| {
            let slopes = self.panels.slopes(Place { panel, x });
            EdgeJet::of(self.control, span.radius(x), slopes).slope * span.stretch(x).powi(power)
        })
    }
}
