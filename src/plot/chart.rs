//! What is drawn on paper.

use super::range::{Range, RangeError};
use crate::explorer::Window;
use crate::figure::{Area, Bounds, Figure, Line, Mark, Role, View};

/// How an axis runs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Run {
    #[default]
    Linear,
    /// Equal factors; what is not positive is not drawn.
    Logarithmic,
}

/// An axis of a chart.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct ChartAxis {
    /// What stands beside it: `δ (µm)`.
    pub title: String,
    pub run: Run,
}

/// A chart: what a figure shows, without what only a screen needs.
#[derive(Debug, Clone, PartialEq)]
pub struct Chart {
    pub x: ChartAxis,
    pub y: ChartAxis,
    pub bounds: Bounds,
    /// The lines, in the order of drawing; those of one name are one entry of the legend.
    pub lines: Vec<Line>,
    /// The signs, the last on top.
    pub marks: Vec<Mark>,
    pub areas: Vec<Area>,
    pub missing: Option<String>,
    /// Whether both axes have the same scale.
    pub is_even: bool,
}

impl Chart {
    /// A figure of the explorer in the part of it that `window` shows.
    pub fn of(figure: &Figure, window: &Window) -> Self {
        let axis = |title| ChartAxis { title, run: Run::Linear };
        Self {
            x: axis(figure.x.title()),
            y: axis(figure.y.title()),
            bounds: figure.bounds.part(window),
            lines: figure.lines.clone(),
            marks: figure.marks.clone(),
            areas: figure.areas.clone(),
            missing: figure.missing.clone(),
            is_even: figure.view == View::Contact,
        }
    }

    /// A chart of `lines` over all their points; a logarithmic axis passes over what is not positive.
    pub fn new(x: ChartAxis, y: ChartAxis, lines: Vec<Line>) -> Self {
        let place = |(px, py): &(f64, f64)| (x.run.place(*px), y.run.place(*py));
        let places = Bounds::of(lines.iter().flat_map(|line| &line.points).map(place));
        let bounds = Bounds { x: places.x.map(|at| x.run.value(at)), y: places.y.map(|at| y.run.value(at)) };
        Self { x, y, bounds, lines, marks: Vec::new(), areas: Vec::new(), missing: None, is_even: false }
    }

    /// The part of its x axis in `range`; an empty chart stays as it is.
    pub fn across(mut self, range: Range) -> Result<Self, RangeError> {
        if self.missing.is_none() {
            self.bounds.x = range.ends(&self.x.title, self.bounds.x, self.drawn().x)?;
        }
        Ok(self)
    }

    /// The part of its y axis in `range`; an empty chart stays as it is.
    pub fn upwards(mut self, range: Range) -> Result<Self, RangeError> {
        if self.missing.is_none() {
            self.bounds.y = range.ends(&self.y.title, self.bounds.y, self.drawn().y)?;
        }
        Ok(self)
    }

    /// How far anything drawn reaches, and how far it is shown.
    fn drawn(&self) -> Bounds {
        let Bounds { x, y } = &self.bounds;
        let lines = self.lines.iter().flat_map(|line| line.points.iter().copied());
        lines.filter(|(x, y)| x.is_finite() && y.is_finite()).fold(Bounds { x: *x, y: *y }, |all, (x, y)| {
            let wider = |[lo, hi]: [f64; 2], at: f64| [lo.min(at), hi.max(at)];
            Bounds { x: wider(all.x, x), y: wider(all.y, y) }
        })
    }

    /// Names the computed curve, which its stability alone does not tell from curves beside it.
    #[must_use]
    pub fn naming(mut self, curve: &str) -> Self {
        let own = self.lines.iter_mut().filter(|line| matches!(line.role, Role::Stable | Role::Unstable));
        for line in own {
            line.name = format!("{curve}, {}", line.name);
        }
        self
    }
}

impl Run {
    /// Where a value stands on the axis, in steps of it; no number where it has no place.
    fn place(self, value: f64) -> f64 {
        match self {
            Self::Linear => value,
            Self::Logarithmic => value.log10(),
        }
    }

    fn value(self, place: f64) -> f64 {
        match self {
            Self::Linear => place,
            Self::Logarithmic => 10.0_f64.powf(place),
        }
    }
}
