//! The parts of a figure: axes, lines, marks and areas, each with a role but no appearance.

use super::bounds::Bounds;
use crate::explorer::Window;
use pulloff_engine::problem::Control;

/// What a line shows. A renderer gives each role a stroke of its own.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Role {
    Zero,
    Undeformed,
    /// The smooth sphere of the same curvature and adhesion.
    Smooth,
    Envelope,
    Pin(usize),
    Branch,
    Exact,
    Unstable,
    Stable,
    /// The whole loop while the control goes down, and while it goes up.
    Unloading,
    Loading,
    /// An equilibrium that cannot exist: the next crest would already touch.
    Inadmissible,
    /// A computed profile or landscape: pressure, deformed gap, potential.
    Body,
    Contact,
    /// The zone in which adhesion with a range pulls.
    Zone,
    /// The edges of contacts over the control.
    Edges,
    /// From the walker's level up to the barrier.
    Barrier,
    /// The line of the loading device through the walker.
    Device,
    /// A pull at a rate.
    Pull,
    Walk,
    /// The curve of the selected event, drawn over its line.
    Chosen,
    Jump,
    /// A line of a map across which the number of snaps does not change.
    Unchanged,
    /// Where a limit point passes the start of the path.
    Starts,
    /// Where a jump just reaches, or just passes over, a crest.
    Landings,
    /// Where pairs of limit points are born.
    Cusps,
    /// The same law under a dead load.
    Twin,
    /// The work of adhesion of the preset.
    Level,
    /// The law of stability: the adhesion at which a state is a limit point.
    Law,
}

/// A line through points in axis values, its parts in order.
#[derive(Debug, Clone, PartialEq)]
pub struct Line {
    pub role: Role,
    /// Its name in a legend; empty where it needs none.
    pub name: String,
    /// Its points; one that is not finite breaks the line.
    pub points: Vec<(f64, f64)>,
    /// Whether it is drawn broken even though its role is not: an unstable part of a curve kept for comparison.
    pub is_broken: bool,
}

/// What a mark stands for. A renderer gives each sign a letter of its own.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Sign {
    /// A limit point of another control.
    OtherLimit(Control),
    /// A limit point of the control that is on no path.
    Limit,
    /// The state in which an event of the path begins, by its number from 1.
    Event(usize),
    /// The same of an event that begins at no limit point: a touch, a turn, an end of contact within a zone.
    Passing(usize),
    /// The event that ends a path, by its number: the bodies come apart. 0 where the numbers on the screen are those of
    /// another path.
    LastContact(usize),
    /// The least force of the path: A of the paper, where the bodies pull off under a dead load.
    LargestPull,
    /// The least approach of the path: B of the paper, where the bodies pull off under fixed grips.
    Farthest,
    Landing,
    /// A crest touches.
    Touch,
    /// The control turns round.
    Turn,
    Crest,
    Edge,
    Minimum,
    Maximum,
    /// The barrier next to the walker's state.
    Barrier,
    /// The walker, in a state with other values than those of the curve.
    Stray,
    Walker,
    /// A pair of limit points is born.
    Cusp,
    /// A pair of cusps is born.
    Swallowtail,
    /// Where the preset stands on a map.
    Preset,
    /// The crest that a line of a map belongs to, by its number from the axis.
    OfCrest(u32),
    /// The number of snaps in the surrounding region of a map; the last number stands for that or more.
    Snaps(usize),
    /// A point that a text refers to by this letter.
    Letter(char),
    /// A computed value, on a line through all of them.
    Value,
    /// A measured point, from an approach or a retraction, in contact or apart: drawn behind everything.
    Measured {
        loading: bool,
        apart: bool,
    },
}

/// A sign at a point in axis values.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mark {
    pub sign: Sign,
    pub at: (f64, f64),
}

/// What an area shows. A renderer gives each meaning a fill of its own.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Meaning {
    /// Energy that is lost.
    Lost,
    /// The bodies are in contact there.
    Contact,
    /// The bodies pull at each other, within a contact.
    Tension,
    /// The range of 90 % of the members of an ensemble, and that of half of them.
    Most,
    Half,
}

impl Meaning {
    /// Its name in a legend.
    pub fn name(self) -> &'static str {
        match self {
            Self::Lost => "energy lost",
            Self::Contact => "in contact",
            Self::Tension => "pulling",
            Self::Most => "5-95 % of the members",
            Self::Half => "25-75 % of the members",
        }
    }
}

/// A closed outline in axis values.
#[derive(Debug, Clone, PartialEq)]
pub struct Area {
    pub meaning: Meaning,
    /// Its corners; the last is joined to the first.
    pub outline: Vec<(f64, f64)>,
    /// The energy that it represents, in the user's units.
    pub lost: Option<f64>,
}

/// One axis.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Axis {
    /// The quantity, over what it is divided by: `P/Pc`, `δ`, `s/λ`.
    pub symbol: String,
    /// Its dimension in words; empty for a pure number.
    pub unit: &'static str,
    /// The unit of its values where the problem is in SI; empty otherwise.
    pub shown: String,
    pub run: AxisScale,
}

/// How the values run along an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum AxisScale {
    #[default]
    Linear,
    /// Equal factors are equally spaced; values that are not positive are not drawn.
    Logarithmic,
    /// As [`AxisScale::Linear`], but only whole numbers mean anything.
    Counted,
}

impl AxisScale {
    /// The scale on which ascending values are spaced more evenly; a single value, or two, cannot tell.
    pub fn of(values: &[f64]) -> Self {
        /// Over less than this factor an axis is as easily read with steps.
        const DECADE: f64 = 10.0;
        let [Some(first), Some(last)] = [values.first(), values.last()] else { return Self::Linear };
        let spread = |apart: fn(f64, f64) -> f64| {
            let all = values.windows(2).map(|pair| apart(pair[0], pair[1]));
            let [least, most] =
                all.fold([f64::INFINITY, 0.0], |[least, most], x| [x.min(least), x.max(most)]);
            most / least
        };
        let has_factors = *first > 0.0 && last / first >= DECADE;
        let is_even = has_factors && spread(|a, b| (b / a).ln()) < spread(|a, b| b - a);
        if is_even { Self::Logarithmic } else { Self::Linear }
    }

    /// The position of a value on the axis, in steps of the axis; NaN where it has none.
    pub fn place(self, value: f64) -> f64 {
        match self {
            Self::Linear | Self::Counted => value,
            Self::Logarithmic => value.log10(),
        }
    }

    /// The value at a position.
    pub fn value(self, place: f64) -> f64 {
        match self {
            Self::Linear | Self::Counted => place,
            Self::Logarithmic => 10.0_f64.powf(place),
        }
    }
}

impl Axis {
    /// An axis of a pure number.
    pub fn pure(symbol: String) -> Self {
        Self { symbol, unit: "", shown: String::new(), run: AxisScale::Linear }
    }

    /// The same axis with this scale.
    #[must_use]
    pub fn running(self, run: AxisScale) -> Self {
        Self { run, ..self }
    }

    /// The title beside the axis: `δ (µm)`, `P/Pc`.
    pub fn title(&self) -> String {
        if self.shown.is_empty() { self.symbol.clone() } else { format!("{} ({})", self.symbol, self.shown) }
    }
}

/// A figure, on screen and on paper: everything a renderer needs except strokes, letters and colours.
#[derive(Debug, Clone, PartialEq)]
pub struct Figure {
    pub title: String,
    pub x: Axis,
    pub y: Axis,
    /// The lines, in drawing order.
    pub lines: Vec<Line>,
    /// The marks, the last on top.
    pub marks: Vec<Mark>,
    pub areas: Vec<Area>,
    /// The bounds of the whole figure, as shown at first.
    pub bounds: Bounds,
    pub notes: Vec<String>,
    pub missing: Option<String>,
    /// Whether a circle looks round: both axes have the same scale.
    pub is_even: bool,
}

impl Figure {
    /// A figure with nothing on it.
    pub fn empty(title: String, x: Axis, y: Axis) -> Self {
        Self {
            title,
            x,
            y,
            lines: Vec::new(),
            marks: Vec::new(),
            areas: Vec::new(),
            bounds: Bounds::of([]),
            notes: Vec::new(),
            missing: None,
            is_even: false,
        }
    }

    /// A figure of `lines` over all their points.
    pub fn of(x: Axis, y: Axis, lines: Vec<Line>) -> Self {
        let mut figure = Self { lines, ..Self::empty(String::new(), x, y) };
        figure.bounds = figure.around(figure.lines.iter().flat_map(|line| line.points.iter().copied()));
        figure
    }

    /// The bounds of points on the axes of this figure; a logarithmic axis skips values that are not positive.
    pub fn around(&self, points: impl IntoIterator<Item = (f64, f64)>) -> Bounds {
        let places = Bounds::of(points.into_iter().map(|at| self.place(at)));
        self.value(&places)
    }

    /// The position of a point on the axes.
    pub fn place(&self, (x, y): (f64, f64)) -> (f64, f64) {
        (self.x.run.place(x), self.y.run.place(y))
    }

    fn value(&self, places: &Bounds) -> Bounds {
        Bounds { x: places.x.map(|at| self.x.run.value(at)), y: places.y.map(|at| self.y.run.value(at)) }
    }

    /// The values at a position on the screen.
    pub fn values_at(&self, (x, y): (f64, f64)) -> (f64, f64) {
        (self.x.run.value(x), self.y.run.value(y))
    }

    /// The bounds as positions on the axes.
    pub(super) fn places(&self) -> Bounds {
        let Bounds { x, y } = self.bounds;
        Bounds { x: x.map(|x| self.x.run.place(x)), y: y.map(|y| self.y.run.place(y)) }
    }

    /// The part of the figure that `window` shows.
    #[must_use]
    pub fn in_window(self, window: &Window) -> Self {
        let bounds = self.value(&self.places().part(window));
        Self { bounds, ..self }
    }

    /// The figure for a screen, whose cells are evenly spaced: points and bounds along a logarithmic axis are decimal
    /// logarithms of the values.
    #[must_use]
    pub fn on_screen(mut self) -> Self {
        let [x, y] = [self.x.run, self.y.run];
        if x != AxisScale::Logarithmic && y != AxisScale::Logarithmic {
            return self;
        }
        let place = |at: &mut (f64, f64)| *at = (x.place(at.0), y.place(at.1));
        self.bounds = self.places();
        self.lines.iter_mut().flat_map(|line| &mut line.points).for_each(place);
        self.marks.iter_mut().for_each(|mark| place(&mut mark.at));
        self.areas.iter_mut().flat_map(|area| &mut area.outline).for_each(place);
        self
    }

    /// Names the computed curve, whose stability alone does not distinguish it from the curves beside it.
    #[must_use]
    pub fn naming(mut self, curve: &str) -> Self {
        let own = self.lines.iter_mut().filter(|line| matches!(line.role, Role::Stable | Role::Unstable));
        for line in own {
            line.name = format!("{curve}, {}", line.name);
        }
        self
    }

    /// The same figure with its axes exchanged.
    #[must_use]
    pub fn transposed(mut self) -> Self {
        let swap = |at: &mut (f64, f64)| *at = (at.1, at.0);
        self.lines.iter_mut().flat_map(|line| &mut line.points).for_each(swap);
        self.marks.iter_mut().for_each(|mark| swap(&mut mark.at));
        self.areas.iter_mut().flat_map(|area| &mut area.outline).for_each(swap);
        std::mem::swap(&mut self.x, &mut self.y);
        std::mem::swap(&mut self.bounds.x, &mut self.bounds.y);
        self
    }

    /// Where one is on the figure: the walker, or the preset on a map and in a study.
    pub fn here(&self) -> Option<(f64, f64)> {
        let is_here = |mark: &&Mark| matches!(mark.sign, Sign::Walker | Sign::Stray | Sign::Preset);
        self.marks.iter().rev().find(is_here).map(|mark| mark.at)
    }
}

impl Line {
    /// A line with a name.
    pub fn new(role: Role, name: impl Into<String>, points: Vec<(f64, f64)>) -> Self {
        Self { role, name: name.into(), points, is_broken: false }
    }

    /// The same line, broken or not.
    #[must_use]
    pub fn broken(self, is_broken: bool) -> Self {
        Self { is_broken, ..self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_axis_of_equal_factors_is_logarithmic_and_one_of_equal_steps_is_not() {
        let factors: Vec<f64> = (0..9).map(|i| 10.0_f64.powf(0.25 * f64::from(i))).collect();
        let steps: Vec<f64> = (0..9).map(|i| 1.0 + 12.0 * f64::from(i)).collect();
        let is_logarithmic = |values: &[f64]| AxisScale::of(values) == AxisScale::Logarithmic;
        assert!(is_logarithmic(&factors) && !is_logarithmic(&steps) && !is_logarithmic(&[0.0, 1.0, 100.0]));
        // Few values, and two or none, which cannot tell.
        assert!(is_logarithmic(&[0.01, 0.1, 1.0]) && !is_logarithmic(&[0.01, 0.5, 1.0]));
        assert!(!is_logarithmic(&[0.01, 1.0]) && !is_logarithmic(&[]));
    }

    #[test]
    fn on_a_screen_logarithms_stand_along_a_logarithmic_axis() {
        let axis = |name: &str| Axis::pure(name.to_owned());
        let line = Line::new(Role::Body, "", vec![(1e-4, 1.0), (1.0, 2.0), (1e2, 3.0)]);
        let figure = Figure::of(axis("V").running(AxisScale::Logarithmic), axis("P"), vec![line]);
        // A part of the range is one of the logarithms, on paper too.
        let half = Window { x: [0.5, 1.0], ..Window::WHOLE };
        let paper = figure.clone().in_window(&half);
        let screen = figure.on_screen();
        let part = screen.bounds.part(&half);
        let (x, y) = screen.values_at((2.0, 3.0));
        assert!((x - 100.0).abs() < 1e-12 && (y - 3.0).abs() < 1e-12, "{x} {y}");
        assert_eq!(screen.lines[0].points, [(-4.0, 1.0), (0.0, 2.0), (2.0, 3.0)]);
        assert!((paper.bounds.x[0].log10() - part.x[0]).abs() < 1e-12 && (part.x[0] + 1.0).abs() < 1e-12);
    }
}
