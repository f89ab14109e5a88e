//! The panels of a table of g: on each, series of g, its slope, ∫₀ᵃ g and ∫₀ᵃ g², or a closed law.

use super::chebyshev::{self, ChebyshevRule, ROOT_NODES};
use super::clusters::{Cluster, Clusters};
use super::law::PowerTransform;
use super::sources::GAUSS;
use super::span::{Place, panel_of};
use crate::gap::{panels::Span, panels::Variable};
use std::sync::{Arc, OnceLock};
use wide::f64x4;

/// A series ends where its coefficients fall below this share of the largest.
const CHOP: f64 = 1e-17;

/// Panels whose outer end is less than this many times as far out as their inner end are far from the axis.
const FAR_FROM_AXIS: f64 = 1.6;

/// One panel of a table.
#[derive(Debug)]
pub struct Panel {
    /// Where.
    pub span: Span,
    /// v = centre + half·x.
    line: [f64; 2],
    /// The series of g; none where the law is closed.
    value: Vec<f64>,
    /// The series of dg/da, or of dg/dv.
    slope: Vec<f64>,
    /// Whether `slope` is with respect to the panel's variable: where h' jumps at the base, dg/da is infinite there.
    steep: bool,
    /// The series of ∫₀ᵃ g and ∫₀ᵃ g².
    area: Vec<f64>,
    square: Vec<f64>,
    /// The series of 1/√a, or of da/dv/√a, for the roots of the stability law.
    edge: OnceLock<Vec<f64>>,
}

/// What a table gives at one radius.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TransformValues {
    /// a.
    pub radius: f64,
    /// g.
    pub value: f64,
    /// dg/da, on the panel's side at a break; infinite right of a break where h' jumps.
    pub slope: f64,
    /// d²g/da².
    pub bend: f64,
    /// ∫₀ᵃ g.
    pub area: f64,
    /// ∫₀ᵃ g².
    pub square: f64,
}

/// The panels of a table, ascending from the axis without holes.
#[derive(Debug)]
pub struct Panels {
    pub(super) list: Vec<Arc<Panel>>,
    pub(super) law: Option<PowerTransform>,
    pub(super) smallest: f64,
    pub(super) digits: OnceLock<f64>,
    pub(super) moments: OnceLock<Clusters<1>>,
}

impl Panel {
    pub(super) fn closed(span: Span) -> Self {
        let line = span.line();
        let none = Vec::new;
        let (value, slope, area, square) = (none(), none(), none(), none());
        Self { span, line, value, slope, steep: false, area, square, edge: OnceLock::new() }
    }

    /// The panel with these series; ∫g and ∫g² continue from the end of the panel before.
    fn new(span: Span, value: Vec<f64>, slope: Vec<f64>, steep: bool, before: Option<&Self>) -> Self {
        let line @ [centre, half] = span.line();
        let value = chebyshev::chop(value, CHOP);
        let start = before.map_or([0.0; 2], |panel| [&panel.area, &panel.square].map(|s| s.iter().sum()));
        let [area, square] = [value.clone(), chebyshev::square(&value)].map(|density| {
            // Times da/dx.
            let density = match span.variable {
                Variable::Radius => density,
                Variable::Root { .. } => chebyshev::times_line(&density, 2.0 * centre, 2.0 * half),
                Variable::Fifth => {
                    let u4 = (0..4).fold(density, |series, _| chebyshev::times_line(&series, centre, half));
                    u4.iter().map(|c| 5.0 * span.hi * c).collect()
                }
            };
            chebyshev::integral(&density).into_iter().map(|c| half * c).collect::<Vec<f64>>()
        });
        let [area, square] = [(area, start[0]), (square, start[1])].map(|(mut series, start)| {
            series[0] += start;
            chebyshev::chop(series, CHOP)
        });
        Self {
            span,
            line,
            value,
            slope: chebyshev::chop(slope, CHOP),
            steep,
            area,
            square,
            edge: OnceLock::new(),
        }
    }

    /// x of the radius a.
    fn place(&self, a: f64) -> f64 {
        let [centre, half] = self.line;
        let v = match self.span.variable {
            Variable::Radius => a,
            Variable::Root { base } => (a - base).max(0.0).sqrt(),
            Variable::Fifth => return self.span.place(a),
        };
        ((v - centre) / half).clamp(-1.0, 1.0)
    }

    /// The series of da/dv/√a where the slope is with respect to the variable, of 1/√a where it is with respect to the
    /// radius.
    pub fn edge(&self) -> &[f64] {
        self.edge.get_or_init(|| self.edge_rule().series(|x| self.weight(x) / self.span.radius(x).sqrt()))
    }

    /// The rule that resolves powers of √a on the panel: away from the axis half the nodes do.
    pub fn edge_rule(&self) -> &'static ChebyshevRule {
        let near_axis = self.span.hi > FAR_FROM_AXIS * self.span.lo;
        ChebyshevRule::of(if near_axis { ROOT_NODES } else { ROOT_NODES / 2 })
    }

    /// The factor that makes a derivative with respect to the radius smooth on the whole panel: da/dv or 1.
    pub fn weight(&self, x: f64) -> f64 {
        if self.steep { self.span.stretch(x) } else { 1.0 }
    }

    /// Whether derivatives are with respect to the panel's variable.
    pub fn is_steep(&self) -> bool {
        self.steep
    }
}

impl Panels {
    /// The panels.
    pub fn list(&self) -> &[Arc<Panel>] {
        &self.list
    }

    /// How far they reach.
    pub fn reach(&self) -> f64 {
        self.list.last().map_or(0.0, |panel| panel.span.hi)
    }

    /// The outer end of the innermost panel: below it g has no relative digits.
    pub fn smallest(&self) -> f64 {
        self.smallest
    }

    /// The place of `a`; a border belongs to the panel that ends there.
    pub fn place(&self, a: f64) -> Place {
        let panel = panel_of(&self.list, |panel| &panel.span, a);
        Place { panel, x: self.list[panel].place(a) }
    }

    /// The radius of a place.
    pub fn radius(&self, at: Place) -> f64 {
        self.list[at.panel].span.radius(at.x)
    }

    /// g and ∫g at a place.
    pub fn value_and_area(&self, at: Place) -> [f64; 2] {
        let panel = &*self.list[at.panel];
        if let Some(law) = &self.law {
            let a = panel.span.radius(at.x);
            return [law.value(a), law.area(a)];
        }
        [chebyshev::sum(&panel.value, at.x), chebyshev::sum(&panel.area, at.x)]
    }

    /// g, ∫g and dg/da at some radii; on one panel their series are summed side by side.
    pub fn values_at<const N: usize>(&self, radii: &[f64; N]) -> [[f64; 3]; N] {
        let index = self.place(radii[0]).panel;
        let panel = &*self.list[index];
        let is_inside = |a: &f64| *a <= panel.span.hi && (*a > panel.span.lo || index == 0);
        if self.law.is_some() || !radii.iter().all(is_inside) {
            return radii.map(|a| {
                let at = self.place(a);
                let [value, area] = self.value_and_area(at);
                [value, area, self.weighted_slope(at) / self.list[at.panel].weight(at.x)]
            });
        }
        let x = radii.map(|a| panel.place(a));
        let [value, area, slope] = chebyshev::sums([&panel.value, &panel.area, &panel.slope], &x);
        std::array::from_fn(|i| [value[i], area[i], slope[i] / panel.weight(x[i])])
    }

    /// g at a place.
    pub fn value(&self, at: Place) -> f64 {
        let panel = &*self.list[at.panel];
        match &self.law {
            Some(law) => law.value(panel.span.radius(at.x)),
            None => chebyshev::sum(&panel.value, at.x),
        }
    }

    /// g at four places of a panel.
    pub fn four_values(&self, panel: usize, x: f64x4) -> f64x4 {
        let panel = &*self.list[panel];
        match &self.law {
            Some(law) => f64x4::new(x.to_array().map(|x| law.value(panel.span.radius(x)))),
            None => chebyshev::sum4(&panel.value, x),
        }
    }

    /// [`Panels::weighted_slope`] at four places of a panel.
    pub fn four_weighted_slopes(&self, panel: usize, x: f64x4) -> f64x4 {
        let panel = &*self.list[panel];
        match &self.law {
            Some(law) => f64x4::new(x.to_array().map(|x| law.slope(panel.span.radius(x)))),
            None => chebyshev::sum4(&panel.slope, x),
        }
    }

    /// Sources of ∫ g f da between two places of a panel, seen from at least as far away as these are apart.
    pub fn sources(&self, panel: usize, [lo, hi]: [f64; 2]) -> Cluster<1> {
        let (span, [_, half]) = (self.list[panel].span, self.list[panel].line);
        let (middle, part) = (0.5 * (lo + hi), 0.5 * (hi - lo));
        let places = GAUSS.map(|[x, weight]| (middle + part * x, part * half * weight));
        let value = |(x, weight): (f64, f64)| weight * span.stretch(x) * self.value(Place { panel, x });
        Cluster {
            ends: [lo, hi].map(|x| span.radius(x)),
            radii: places.map(|(x, _)| span.radius(x)),
            weights: [places.map(value)],
        }
    }

    /// The sources of all panels, made once.
    pub fn moments(&self) -> &Clusters<1> {
        let whole = |panel| self.sources(panel, [-1.0, 1.0]);
        self.moments.get_or_init(|| Clusters::new((0..self.list.len()).map(whole).collect(), 0))
    }

    /// dg/da times the [weight](Panel::weight) of the panel.
    pub fn weighted_slope(&self, at: Place) -> f64 {
        let panel = &*self.list[at.panel];
        match &self.law {
            Some(law) => law.slope(panel.span.radius(at.x)),
            None => chebyshev::sum(&panel.slope, at.x),
        }
    }

    /// The series of [`Panels::weighted_slope`] on a panel.
    pub fn slope_series(&self, panel: usize) -> Vec<f64> {
        let span = self.list[panel].span;
        match &self.law {
            Some(law) => ChebyshevRule::of(ROOT_NODES).series(|x| law.slope(span.radius(x))),
            None => self.list[panel].slope.clone(),
        }
    }

    /// The series of g on a panel.
    pub fn value_series(&self, panel: usize) -> Vec<f64> {
        let span = self.list[panel].span;
        match &self.law {
            Some(law) => ChebyshevRule::of(ROOT_NODES).series(|x| law.value(span.radius(x))),
            None => self.list[panel].value.clone(),
        }
    }

    /// dg/dv at a place: with respect to the panel's own variable, finite everywhere.
    pub fn slope_by_variable(&self, at: Place) -> f64 {
        let panel = &*self.list[at.panel];
        let slope = self.weighted_slope(at);
        if panel.steep { slope } else { slope * panel.span.stretch(at.x) }
    }

    /// Everything at a place.
    pub fn values(&self, at: Place) -> TransformValues {
        let panel = &*self.list[at.panel];
        let radius = panel.span.radius(at.x);
        if let Some(law) = &self.law {
            return TransformValues {
                radius,
                value: law.value(radius),
                slope: law.slope(radius),
                bend: law.bend(radius),
                area: law.area(radius),
                square: law.square(radius),
            };
        }
        let [weighted, by_x] = chebyshev::sum_and_slope(&panel.slope, at.x);
        let (stretch, [_, half]) = (panel.span.stretch(at.x), panel.line);
        let [slope, bend] = if panel.steep {
            let slope = weighted / stretch;
            [slope, (by_x / half - slope * panel.span.bend(at.x)) / (stretch * stretch)]
        } else {
            [weighted, by_x / half / stretch]
        };
        TransformValues {
            radius,
            value: chebyshev::sum(&panel.value, at.x),
            slope,
            bend,
            area: chebyshev::sum(&panel.area, at.x),
            square: chebyshev::sum(&panel.square, at.x),
        }
    }

    /// g', g'' and g''' with respect to a, at a place off the innermost panel; not finite right of a break at which a
    /// derivative of the gap jumps.
    pub fn slopes(&self, at: Place) -> [f64; 3] {
        let panel = &*self.list[at.panel];
        let radius = panel.span.radius(at.x);
        if let Some(law) = &self.law {
            return [law.slope(radius), law.bend(radius), law.third(radius)];
        }
        let [value, first, second] = chebyshev::sum_and_slopes(&panel.slope, at.x);
        let [_, half] = panel.line;
        let [by_v, by_v2] = [first / half, second / (half * half)];
        let (stretch, bend) = (panel.span.stretch(at.x), panel.span.bend(at.x));
        // With respect to v, of the derivative with respect to a; the stretch of a panel right of a break is linear in
        // v.
        let [slope, by_v, by_v2] = if panel.steep {
            let ratio = bend / stretch;
            let slope = value / stretch;
            let by = by_v / stretch - slope * ratio;
            [slope, by, by_v2 / stretch - 2.0 * ratio * by]
        } else {
            [value, by_v, by_v2]
        };
        let second = by_v / stretch;
        [slope, second, (by_v2 - second * bend) / (stretch * stretch)]
    }

    /// ∫₀ᵃ g² at a place.
    pub fn square(&self, at: Place) -> f64 {
        let panel = &*self.list[at.panel];
        match &self.law {
            Some(law) => law.square(panel.span.radius(at.x)),
            None => chebyshev::sum(&panel.square, at.x),
        }
    }

    /// g, dg/dv and ∫g at four places of one panel.
    pub fn four_with_slopes(&self, panel: usize, x: [f64; 4]) -> [[f64; 4]; 3] {
        let of = &*self.list[panel];
        if let Some(law) = &self.law {
            let radii = x.map(|x| of.span.radius(x));
            return [radii.map(|a| law.value(a)), radii.map(|a| law.slope(a)), radii.map(|a| law.area(a))];
        }
        let four = |series: &[f64]| chebyshev::sum4(series, x.into()).to_array();
        let mut slopes = four(&of.slope);
        if !of.steep {
            for (slope, x) in slopes.iter_mut().zip(x) {
                *slope *= of.span.stretch(x);
            }
        }
        [four(&of.value), slopes, four(&of.area)]
    }

    /// g' at eight radii, which lie on one panel.
    pub fn eight_slopes(&self, panel: usize, radii: &[f64; 8]) -> [f64; 8] {
        let of = &*self.list[panel];
        if let Some(law) = &self.law {
            return radii.map(|a| law.slope(a));
        }
        let x = radii.map(|a| of.place(a));
        let [slopes] = chebyshev::sums([&of.slope], &x);
        std::array::from_fn(|i| slopes[i] / of.weight(x[i]))
    }

    /// g and ∫g at eight radii, which lie on one panel: the dense curve is made of these.
    pub fn eight(&self, panel: usize, radii: &[f64; 8]) -> [[f64; 8]; 2] {
        let of = &*self.list[panel];
        if let Some(law) = &self.law {
            return [radii.map(|a| law.value(a)), radii.map(|a| law.area(a))];
        }
        let x = radii.map(|a| of.place(a));
        chebyshev::sums([&of.value, &of.area], &x)
    }
}

impl Panels {
    pub(super) fn push(
        &mut self,
        span: Span,
        rule: &ChebyshevRule,
        value: &[f64],
        slope: &[f64],
        steep: bool,
    ) {
        let series = |samples: &[f64]| {
            let mut out = vec![0.0; samples.len()];
            rule.coefficients(samples, &mut out);
            out
        };
        let before = self.list.last().map(|panel| &**panel);
        let panel = Panel::new(span, series(value), series(slope), steep, before);
        self.list.push(Arc::new(panel));
    }
}
