//! Places on a panel: the radius a over −1 ≤ x ≤ 1.
//!
//! ```text
//! innermost panel   a = hi u⁵,       u = (1 + x)/2
//! left of breaks    a = c + d x
//! right of b        a = b + y²,      y = y_c + y_d x
//! ```

use crate::elementary::pow;
use crate::gap::{panels::Span, panels::Variable};

/// A place on a panel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Place {
    /// The number of the panel.
    pub panel: usize,
    /// −1 ≤ x ≤ 1.
    pub x: f64,
}

impl Span {
    /// y at both ends of a panel right of `base`.
    fn roots(&self, base: f64) -> [f64; 2] {
        [(self.lo - base).max(0.0).sqrt(), (self.hi - base).max(0.0).sqrt()]
    }

    /// The panel's own variable as a line in x: its value in the middle, and half its width.
    pub fn line(&self) -> [f64; 2] {
        match self.variable {
            Variable::Fifth => [0.5, 0.5],
            Variable::Radius => [0.5 * (self.lo + self.hi), 0.5 * (self.hi - self.lo)],
            Variable::Root { base } => {
                let [lo, hi] = self.roots(base);
                [0.5 * (lo + hi), 0.5 * (hi - lo)]
            }
        }
    }

    /// Whether derivatives on the panel are with respect to its own variable; `jumps` says whether h' jumps at a break.
    pub fn is_steep(&self, jumps: impl Fn(f64) -> bool) -> bool {
        match self.variable {
            Variable::Fifth => true,
            Variable::Radius => false,
            Variable::Root { base } => jumps(base),
        }
    }

    /// v at x.
    pub fn variable_at(&self, x: f64) -> f64 {
        let [centre, half] = self.line();
        // Exact at the ends, where a panel right of a break has v = 0.
        if x <= -1.0 { centre - half } else { centre + half * x }
    }

    /// a at x.
    pub fn radius(&self, x: f64) -> f64 {
        if x >= 1.0 {
            return self.hi;
        }
        if x <= -1.0 {
            return self.lo;
        }
        let v = self.variable_at(x);
        match self.variable {
            Variable::Fifth => self.hi * v.powi(5),
            Variable::Radius => v,
            Variable::Root { base } => base + v * v,
        }
    }

    /// x at a, which lies on the panel.
    pub fn place(&self, a: f64) -> f64 {
        let [centre, half] = self.line();
        let v = match self.variable {
            Variable::Fifth => pow(a / self.hi, 0.2),
            Variable::Radius => a,
            Variable::Root { base } => (a - base).max(0.0).sqrt(),
        };
        if half > 0.0 { ((v - centre) / half).clamp(-1.0, 1.0) } else { 1.0 }
    }

    /// da/dv at x.
    pub fn stretch(&self, x: f64) -> f64 {
        let v = self.variable_at(x);
        match self.variable {
            Variable::Fifth => 5.0 * self.hi * v.powi(4),
            Variable::Radius => 1.0,
            Variable::Root { .. } => 2.0 * v,
        }
    }

    /// d²a/dv² at x.
    pub fn bend(&self, x: f64) -> f64 {
        match self.variable {
            Variable::Fifth => 20.0 * self.hi * self.variable_at(x).powi(3),
            Variable::Radius => 0.0,
            Variable::Root { .. } => 2.0,
        }
    }
}

/// The panel of `a` among `spans`, which ascend without holes; a border belongs to the panel that ends there.
pub fn panel_of<T>(panels: &[T], span: impl Fn(&T) -> &Span, a: f64) -> usize {
    panels.partition_point(|panel| span(panel).hi < a).min(panels.len().saturating_sub(1))
}
