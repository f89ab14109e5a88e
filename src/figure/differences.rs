//! P minus that of the pinned curves and of theory, over the contact radius: for curves less than a dot apart.
//!
//! A solid line compares at equal s, a broken one at equal δ. The other curve is taken at its own states, and ours is
//! solved there, so that nothing is interpolated between drawn points.

use super::bounds::Bounds;
use super::parts::{Axis, Figure, Line, Mark, Role, Sign};
use super::subject::Subject;
use crate::explorer::curve::CurvePoint;
use crate::explorer::pins::letter;
use crate::explorer::reach::OF_SHORT_RANGE;
use pulloff_engine::disc::solution::Solution;
use pulloff_engine::problem::Control;
use pulloff_engine::report::number::significant;
use pulloff_engine::theory::Exact;

/// Bisection steps on a stretch of the curve: enough to go far below what is drawn, and below rounding.
const HALVINGS: usize = 50;

/// Another curve: δ, P and s of its states in the user's units, from the outermost inward.
struct OtherCurve<'a> {
    role: Role,
    name: String,
    states: Vec<[f64; 3]>,
    /// P at any s.
    force: Box<dyn Fn(f64) -> Option<f64> + 'a>,
}

/// Builds the view.
pub fn figure(subject: &Subject<'_>) -> Figure {
    let scale = subject.scale();
    let (x, force) = (scale.radius_axis("s"), scale.force_axis());
    let y = Axis { symbol: format!("Δ{}", force.symbol), ..force };
    let title = format!("{} over {}, broken: at equal δ", y.title(), x.symbol);
    let mut figure = Figure::empty(title, x, y);
    if subject.curve.case.cohesion.is_some() {
        figure.missing = Some(OF_SHORT_RANGE.to_owned());
        return figure;
    }
    let ours = Ours::of(subject);
    let place = |[s, difference]: [f64; 2]| (scale.radius(s), scale.force(difference));
    let others = others(subject, &mut figure.notes);
    if others.is_empty() {
        figure.missing =
            Some("nothing to compare with: neither a pinned curve nor theory is drawn".to_owned());
        return figure;
    }
    let walker = subject.walk.last().filter(|node| subject.is_on_curve(node) && !node.is_apart());
    let walker = walker.map(|node| node.state.in_units(node.setting.units()));
    let (mut pinned, mut said, mut here) = (Vec::new(), Vec::new(), None);
    for other in &others {
        let by_radius: Vec<(f64, f64)> = ours.at_equal_radius(&other.states).into_iter().map(place).collect();
        let by_approach = ours.at_equal_approach(&other.states).into_iter().map(place).collect();
        // At the state itself, not between two drawn points.
        if let Some((state, force)) =
            walker.and_then(|state| Some((state, (other.force)(state.contact_radius)?)))
        {
            let at = place([state.contact_radius, state.force - force]);
            // The legend has the names of pins, and here they come first.
            let value = significant(at.1, 3);
            match other.role {
                Role::Pin(number) => pinned.push(format!("{} {value}", letter(number))),
                _ => said.push(format!("{} {value}", other.name)),
            }
            here.get_or_insert(at);
        }
        figure
            .lines
            .push(Line::new(other.role, format!("{}, at equal δ", other.name), by_approach).broken(true));
        figure.lines.push(Line::new(other.role, format!("{}, at equal s", other.name), by_radius));
    }
    figure.bounds = Bounds::of(figure.lines.iter().flat_map(|line| line.points.iter().copied()));
    if let Some(at) = here {
        pinned.append(&mut said);
        if let Some(first) = pinned.first_mut() {
            *first = format!("at @, equal s: {first}");
        }
        figure.notes.splice(0..0, pinned);
        figure.marks.push(Mark { sign: Sign::Walker, at });
    }
    figure
}

/// The curves to compare with. A pin whose numbers have other units is left out, with a note.
fn others<'a>(subject: &Subject<'a>, notes: &mut Vec<String>) -> Vec<OtherCurve<'a>> {
    let theory = &subject.curve.base.theory;
    let overlays = subject.overlays;
    let (curve, unit) = (&subject.curve.base.curve, subject.curve.case.units().length);
    let ours = curve.innermost() * unit..=curve.outermost() * unit;
    let mut all = Vec::new();
    let mut add = |role, name: &str, states: &'a [[f64; 3]], force: Box<dyn Fn(f64) -> Option<f64> + 'a>| {
        // Theory continues beyond our curve, where other branches have the same δ.
        let states: Vec<_> = states.iter().copied().filter(|at| ours.contains(&at[2])).collect();
        if !states.is_empty() {
            all.push(OtherCurve { role, name: name.to_owned(), states, force });
        }
    };
    let problem = &subject.curve.case.problem;
    if let (Some(smooth), true) = (subject.curve.case.smooth(), overlays.smooth) {
        add(Role::Smooth, theory.smooth_name, &theory.smooth, Box::new(move |s| Some(smooth.force(s))));
    }
    if let (Some(envelope), true) = (&theory.envelope, overlays.envelope) {
        let states = &envelope.unloading;
        add(Role::Envelope, "envelope", states, Box::new(|s| between(states, s)));
    }
    if overlays.exact {
        let exact = Exact::of(problem);
        add(Role::Exact, theory.exact_name, &theory.exact, Box::new(move |s| Some(exact.force(s))));
    }
    let mut pinned = Vec::new();
    notes.extend(subject.other_pins.iter().map(|number| format!("{} has other units", letter(*number))));
    for pin in &subject.pins {
        if pin.curve.case.cohesion.is_some() {
            notes.push(format!("{} has a range of adhesion", letter(pin.number)));
            continue;
        }
        let state = |at: &CurvePoint| [at.approach, at.force, at.contact_radius];
        let states = pin.curve.points.iter().map(state).collect();
        let name = pin.name(subject.preset);
        let (solution, units) = (&pin.curve.base.curve.solution, pin.curve.case.units());
        let force = move |s: f64| Some(solution.at(solution.place(s / units.length)?).force * units.force);
        pinned.push(OtherCurve { role: Role::Pin(pin.number), name, states, force: Box::new(force) });
    }
    all.extend(pinned);
    all
}

/// Our curve: its solution, and its states cut where δ turns.
struct Ours<'a> {
    solution: &'a dyn Solution,
    /// The units of length and force.
    units: [f64; 2],
    /// The range of s (reduced) over which the curve is drawn.
    range: [f64; 2],
    /// Stretches on which δ rises or falls monotonically with s, from outside inward: s and δ of the ends and the states between.
    stretches: Vec<Vec<[f64; 2]>>,
}

impl<'a> Ours<'a> {
    fn of(subject: &Subject<'a>) -> Self {
        let (curve, units) = (&subject.curve.base.curve, subject.curve.case.units());
        // Include the limit points themselves: beyond one, the same δ is on another branch.
        let mut states: Vec<[f64; 2]> =
            curve.samples.iter().map(|at| [at.contact_radius, at.approach]).collect();
        let limits = curve.limit_points(Control::Displacement).into_iter();
        states.extend(limits.map(|limit| [limit.contact_radius, limit.approach]));
        states.sort_by(|a, b| b[0].total_cmp(&a[0]));
        Self {
            solution: &*curve.solution,
            units: [units.length, units.force],
            range: [curve.innermost(), curve.outermost()],
            stretches: monotone(states.into_iter(), |at| at[1]),
        }
    }

    /// δ and P at a radius, all reduced.
    fn at(&self, s: f64) -> Option<[f64; 2]> {
        let local = self.solution.at(self.solution.place(s)?);
        Some([local.approach, local.force])
    }

    /// s and our P minus theirs, in the user's units, at each of their radii; NaN where we have none.
    fn at_equal_radius(&self, states: &[[f64; 3]]) -> Vec<[f64; 2]> {
        let [length, force] = self.units;
        let difference = |&[_, p, s]: &[f64; 3]| {
            let is_ours = (self.range[0]..=self.range[1]).contains(&(s / length));
            let ours = Some(s / length).filter(|_| is_ours).and_then(|s| self.at(s));
            [s, ours.map_or(f64::NAN, |[_, ours]| ours * force - p)]
        };
        states.iter().map(difference).collect()
    }

    /// The same at each of their approaches, on the nearest stretch of ours on which δ runs the same way, if that
    /// stretch has the approach. The line is broken where either branch ends.
    fn at_equal_approach(&self, states: &[[f64; 3]]) -> Vec<[f64; 2]> {
        let [length, force] = self.units;
        let mut found = Vec::new();
        let branches = monotone(states.iter().copied(), |at| at[0]);
        for (i, branch) in branches.iter().enumerate() {
            // A state next to a limit point may be on either side of it, so its branch is not known.
            let (first, last) = (usize::from(i > 0), usize::from(i + 1 < branches.len()));
            let branch = &branch[first..branch.len() - last];
            // Both are listed from outside inward.
            let way = rises(branch, |at| at[0]);
            let alike: Vec<_> = self.stretches.iter().filter(|own| rises(own, |at| at[1]) == way).collect();
            let mut last = None;
            for [delta, p, s] in branch {
                let (delta, s) = (delta / length, s / length);
                let near = (0..alike.len()).min_by(|a, b| away(alike[*a], s).total_cmp(&away(alike[*b], s)));
                if near != last {
                    found.push([f64::NAN; 2]);
                    last = near;
                }
                let state = near.and_then(|near| self.radius_on(alike[near], delta));
                let state = state.and_then(|s| Some((s, self.at(s)?)));
                found.push(state.map_or([f64::NAN; 2], |(s, [_, ours])| [s * length, ours * force - p]));
            }
            found.push([f64::NAN; 2]);
        }
        found
    }

    /// The radius at which δ has this value on a stretch; `None` where there is none.
    fn radius_on(&self, stretch: &[[f64; 2]], delta: f64) -> Option<f64> {
        let (first, last) = (stretch.first()?, stretch.last()?);
        let rises = last[1] > first[1];
        let is_before = |at: f64| if rises { at < delta } else { at > delta };
        let is_after = |at: f64| if rises { at > delta } else { at < delta };
        if is_before(last[1]) || is_after(first[1]) {
            return None;
        }
        let next = stretch.partition_point(|at| is_before(at[1])).clamp(1, stretch.len() - 1);
        let (mut near, mut far) = (stretch[next - 1][0], stretch[next][0]);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (near + far);
            if is_before(self.at(middle)?[0]) { near = middle } else { far = middle }
        }
        Some(0.5 * (near + far))
    }
}

/// Stretches of at least two states on which `of` only rises or only falls; neighbours share an end.
fn monotone<T: Copy>(states: impl Iterator<Item = T>, of: impl Fn(&T) -> f64) -> Vec<Vec<T>> {
    let mut stretches: Vec<Vec<T>> = Vec::new();
    let mut last: Option<T> = None;
    for state in states {
        match (stretches.last_mut(), last) {
            (Some(stretch), Some(before))
                if stretch.len() < 2 || (of(&state) > of(&before)) == rises(stretch, &of) =>
            {
                stretch.push(state);
            }
            (_, before) => stretches.push(before.into_iter().chain([state]).collect()),
        }
        last = Some(state);
    }
    stretches.retain(|stretch| stretch.len() > 1);
    stretches
}

/// The distance of a radius from those of a stretch.
fn away(stretch: &[[f64; 2]], s: f64) -> f64 {
    let Some((outer, inner)) = stretch.first().zip(stretch.last()) else { return f64::INFINITY };
    (s - outer[0]).max(inner[0] - s).max(0.0)
}

/// Whether `of` rises along a stretch.
fn rises<T>(stretch: &[T], of: impl Fn(&T) -> f64) -> bool {
    stretch.first().zip(stretch.last()).is_some_and(|(first, last)| of(last) > of(first))
}

/// P at the radius `s`, interpolated between neighbouring smooth states.
fn between(states: &[[f64; 3]], s: f64) -> Option<f64> {
    states.windows(2).find_map(|pair| {
        let [[_, p, a], [_, q, b]] = [pair[0], pair[1]];
        let share = (s - a) / (b - a);
        (0.0..=1.0).contains(&share).then_some(p + (q - p) * share)
    })
}
