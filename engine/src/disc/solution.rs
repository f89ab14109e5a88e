//! The equilibria of one disc over all its radii, panel by panel: limit points, landings and losses are found on them.

use super::panels::Panels;
use super::span::Place;
use super::spans::TableError;
use super::table::Table;
use crate::gap::panels::Span;
use crate::problem::Control;
use crate::progress::Progress;
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::fmt::Debug;
use std::sync::Arc;

/// How often a table is refined towards the axis while its innermost disc is not yet unstable.
const TIMES_FINER: i32 = 40;

/// One equilibrium with the slopes of the curve with respect to the variable v of its panel, finite everywhere.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Local {
    /// s, or the outer edge of a zone: what runs along the curve.
    pub contact_radius: f64,
    /// δ.
    pub approach: f64,
    /// P.
    pub force: f64,
    /// dδ/dv and dP/dv.
    pub slopes: [f64; 2],
    /// ds/dv.
    pub stretch: f64,
}

/// The edges of one equilibrium.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Edges {
    /// s, 0 where the bodies are held without contact.
    pub contact_radius: f64,
    /// c, the outer edge of the zone in which adhesion with a range acts; `None` where it acts at the edge of contact alone.
    pub zone: Option<f64>,
}

/// The equilibria of one disc, one for each radius, in ascending panels. The radius is that of the contact, or of the
/// zone in which adhesion with a range acts.
pub trait Solution: Debug + Send + Sync {
    /// The number of panels.
    fn len(&self) -> usize;

    /// Whether there are none.
    fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// One of the panels; there may be holes between them, where rings have no equilibrium.
    fn span(&self, panel: usize) -> &Span;

    /// The place of the radius `s`, on the panel that ends there if it is a border; `None` outside all panels.
    fn place(&self, s: f64) -> Option<Place>;

    /// The equilibrium at a place.
    fn at(&self, place: Place) -> Local;

    /// The radius of the equilibrium at a place, a length.
    fn radius(&self, place: Place) -> f64 {
        self.span(place.panel).radius(place.x)
    }

    /// The equilibria at four places of one panel: areas are sums of many.
    fn at_four(&self, panel: usize, x: [f64; 4]) -> [Local; 4] {
        x.map(|x| self.at(Place { panel, x }))
    }

    /// U at a place.
    fn energy(&self, place: Place) -> f64;

    /// The edges at a place.
    fn edges(&self, place: Place) -> Edges {
        Edges { contact_radius: self.radius(place), zone: None }
    }

    /// The places at which contact in a zone begins or ends.
    fn touches(&self) -> &[Place] {
        &[]
    }

    /// On a panel, the series of a positive multiple of the derivative of the controlled quantity with respect to s;
    /// and the size of its terms, to which its rounding is relative.
    ///
    /// The state is stable where the series is positive.
    fn tendency(&self, panel: usize, control: Control) -> (Vec<f64>, f64);

    /// How far the solution reaches.
    fn reach(&self) -> f64 {
        self.len().checked_sub(1).map_or(0.0, |last| self.span(last).hi)
    }

    /// Where it begins.
    fn begin(&self) -> f64 {
        if self.is_empty() { 0.0 } else { self.span(0).lo }
    }

    /// Whether moving edges pass on to the next panel, which begins where this one ends or a hair beyond.
    fn is_passed(&self, panel: usize) -> bool {
        self.is_joined(panel)
    }

    /// Whether the next panel begins where this one ends.
    fn is_joined(&self, panel: usize) -> bool {
        panel + 1 < self.len() && self.span(panel).hi >= self.span(panel + 1).lo
    }
}

/// The exact equilibria, from the table.
///
/// ```text
/// T = √(2πγs)      δ = g − T      P = 2(δs − ∫g)      U = δ²s − 2δ∫g + ∫g² − πγs²
/// stable under a device of stiffness k  ⇔  g' > √(πγ/2)/W_k,    W_k = √s (1 + x)/(1 + 3x),   x = 2s/k
/// ```
///
/// (x = 0 for displacement, x → ∞ for force): the slope of the control is linear in T, so that only the weight of one
/// known function depends on the adhesion, and changing the adhesion costs nothing.
#[derive(Debug, Clone)]
pub struct ExactSolution {
    panels: Arc<Panels>,
    work_of_adhesion: f64,
}

impl ExactSolution {
    /// The equilibria of a gap with this table under the adhesion γ.
    pub fn new(panels: Arc<Panels>, work_of_adhesion: f64) -> Self {
        Self { panels, work_of_adhesion }
    }

    /// The equilibria of the gap of `table` up to the radius `reach` under the adhesion γ. The table is refined towards the
    /// axis until the innermost disc is unstable: smaller ones then are, and no limit point lies among them.
    ///
    /// # Errors
    /// [`TableError`].
    pub fn refined(
        table: &Table,
        reach: f64,
        work_of_adhesion: f64,
        progress: &dyn Progress,
    ) -> Result<Self, TableError> {
        let mut panels = table.up_to_while(reach, 0, progress)?;
        for fineness in 1..TIMES_FINER {
            if Self::begins_unstable(&panels, work_of_adhesion) || !panels.smallest().is_normal() {
                break;
            }
            panels = table.up_to_while(reach, fineness, progress)?;
        }
        Ok(Self::new(panels, work_of_adhesion))
    }

    /// The equilibrium at s, from g, dg/dv and ∫g there.
    fn local(&self, [s, stretch]: [f64; 2], [value, by_variable, area]: [f64; 3]) -> Local {
        let root = (TAU * self.work_of_adhesion * s).sqrt();
        let approach = value - root;
        // T' = T/2s.
        let fall = if s > 0.0 { 0.5 * root / s * stretch } else { 0.0 };
        let slope = by_variable - fall;
        Local {
            contact_radius: s,
            approach,
            force: 2.0 * (approach * s - area),
            slopes: [slope, 2.0 * (s * slope - root * stretch)],
            stretch,
        }
    }

    /// √(πγ/2).
    fn edge(work_of_adhesion: f64) -> f64 {
        (FRAC_PI_2 * work_of_adhesion).sqrt()
    }

    /// Whether the disc that ends with the innermost panel is unstable under every control, as all smaller ones then are.
    fn begins_unstable(panels: &Panels, work_of_adhesion: f64) -> bool {
        let Some(first) = panels.list().first() else { return true };
        let values = panels.values(Place { panel: 0, x: 1.0 });
        work_of_adhesion == 0.0 || values.slope * first.span.hi.sqrt() < Self::edge(work_of_adhesion)
    }
}

impl Solution for ExactSolution {
    fn len(&self) -> usize {
        self.panels.list().len()
    }

    fn span(&self, panel: usize) -> &Span {
        &self.panels.list()[panel].span
    }

    fn place(&self, s: f64) -> Option<Place> {
        (s >= 0.0 && s <= self.panels.reach()).then(|| self.panels.place(s))
    }

    fn at(&self, place: Place) -> Local {
        let [value, area] = self.panels.value_and_area(place);
        let s = self.panels.radius(place);
        let stretch = self.span(place.panel).stretch(place.x);
        self.local([s, stretch], [value, self.panels.slope_by_variable(place), area])
    }

    fn at_four(&self, panel: usize, x: [f64; 4]) -> [Local; 4] {
        let [values, slopes, areas] = self.panels.four_with_slopes(panel, x);
        let span = self.span(panel);
        std::array::from_fn(|i| {
            self.local([span.radius(x[i]), span.stretch(x[i])], [values[i], slopes[i], areas[i]])
        })
    }

    fn energy(&self, place: Place) -> f64 {
        let [value, area] = self.panels.value_and_area(place);
        let s = self.panels.radius(place);
        let delta = value - (TAU * self.work_of_adhesion * s).sqrt();
        delta * delta * s - 2.0 * delta * area + self.panels.square(place)
            - PI * self.work_of_adhesion * s * s
    }

    fn tendency(&self, panel: usize, control: Control) -> (Vec<f64>, f64) {
        if panel == 0 {
            // One sign all over the innermost panel.
            let grows =
                self.work_of_adhesion == 0.0 && self.panels.values(Place { panel: 0, x: 1.0 }).slope > 0.0;
            return (vec![if grows { 1.0 } else { -1.0 }], 0.0);
        }
        let of = &self.panels.list()[panel];
        let mut series = self.panels.slope_series(panel);
        let size: f64 = series.iter().map(|c| c.abs()).sum();
        let edge = Self::edge(self.work_of_adhesion);
        let own;
        let (weights, factor) = match control {
            Control::Displacement => (of.edge(), edge),
            Control::Force => (of.edge(), 3.0 * edge),
            Control::Stiffness(k) => {
                own = of.edge_rule().series(|x| {
                    let s = of.span.radius(x);
                    of.weight(x) / s.sqrt() * (k + 6.0 * s) / (k + 2.0 * s)
                });
                (&own[..], edge)
            }
        };
        series.resize(series.len().max(weights.len()), 0.0);
        for (c, weight) in series.iter_mut().zip(weights) {
            *c -= factor * weight;
        }
        (series, size)
    }
}
