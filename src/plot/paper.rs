//! The figures of the paper, computed again: each with our numbers, the exact theory, and a caption that states how
//! well they agree. Fig. 6 is a sketch of the problem and has no numbers.
//!
//! | figure | what it shows |
//! |---|---|
//! | 1, 3 | the contact pressure of the smooth sphere without and with adhesion |
//! | 2, 4 | its force and contact radius |
//! | 5 | the error over the number of rings |
//! | 7 | the pressure on waves without adhesion, under rising load |
//! | 8, 9 | force and contact radius on slight and on steep waves |
//! | 10 | what the jumps of Fig. 9 dissipate under displacement and under force control |
//! | rate | beyond the paper: the largest pull of Fig. 9 over the rate |

use crate::explorer::curve::CurvePoint;
use crate::explorer::studies::{StudyOutcome, StudyWish, threads};
use crate::explorer::{Axes, CurveData, Overlays, Staged, View};
use crate::figure::curves::place;
use crate::figure::study;
use crate::figure::{Axis, AxisScale, Figure, Line, Mark, Role, Scale, Sign, Subject};
use crate::store::{read_with, shipped};
use pulloff_engine::case::{Case, CaseError, critical_force};
use pulloff_engine::elementary::pow;
use pulloff_engine::preset::edge::RATE;
use pulloff_engine::preset::{Key, Preset, ReadError};
use pulloff_engine::problem::Control;
use pulloff_engine::progress::Unwatched;
use pulloff_engine::quasistatic::Profile;
use pulloff_engine::quasistatic::admissible::Judge;
use pulloff_engine::report::number::significant;
use pulloff_engine::ritz::{Grading, NewtonSettings, Rings, RingsError, solve};
use pulloff_engine::sweep::{Cell, QuantityColumn};
use pulloff_engine::theory::Exact;
use pulloff_engine::verify::cases::{smooth, sphere};
use pulloff_engine::verify::convergence::radius_at;
use std::fmt::Write;

/// A figure of the paper.
#[derive(Debug, Clone)]
pub struct PaperSheet {
    /// The name of its files: `fig-9a`.
    pub name: &'static str,
    /// What is drawn.
    pub figure: Figure,
    /// What it shows, and how well our numbers agree with theory.
    pub caption: String,
}

/// Why a figure could not be made.
#[derive(Debug, thiserror::Error)]
pub enum PaperError {
    #[error("a shipped preset cannot be read: {0}")]
    Preset(#[from] ReadError),
    #[error("the shipped preset {0} is missing")]
    Missing(&'static str),
    #[error(transparent)]
    Case(#[from] CaseError),
    #[error(transparent)]
    Basis(#[from] RingsError),
    /// There is no equilibrium where the paper shows one.
    #[error("there is no equilibrium at the contact radius {0}")]
    NoState(f64),
}

/// The rings of the pressures: few enough to see each one.
const FEW_RINGS: &str = "basis.rings=20";
/// δ/R of the errors of Fig. 5.
const APPROACH: f64 = 0.1;
/// The numbers of rings of Fig. 5.
const RINGS: [usize; 8] = [10, 20, 40, 80, 160, 320, 640, 1280];
/// The share of the contact in which pressures are compared; at an adhesive edge their differences have no bound.
const COMPARED: f64 = 0.9;

/// The names of all figures, in the order of the paper.
pub const NAMES: [&str; 16] = [
    "fig-1", "fig-2a", "fig-2b", "fig-3", "fig-4a", "fig-4b", "fig-5", "fig-7a", "fig-7b", "fig-8a",
    "fig-8b", "fig-9a", "fig-9b", "fig-10a", "fig-10b", "rate",
];

/// All figures, in the order of the paper; `begin` is called with the name of each before it is computed.
pub fn sheets(mut begin: impl FnMut(&str)) -> Result<Vec<PaperSheet>, PaperError> {
    let mut sheets = Vec::new();
    begin("Fig. 1");
    sheets.push(smooth_pressure("fig-1", "fig-1-hertz", 0.3, "Hertz's theory")?);
    begin("Fig. 2");
    sheets.extend(curves(["fig-2a", "fig-2b"], "fig-1-hertz", "Smooth sphere without adhesion")?);
    begin("Fig. 3");
    sheets.push(smooth_pressure("fig-3", "fig-3-jkr", 0.3, "the theory of Johnson, Kendall and Roberts")?);
    begin("Fig. 4");
    sheets.extend(curves(["fig-4a", "fig-4b"], "fig-3-jkr", "Smooth sphere with adhesion, γ' = 0.05")?);
    begin("Fig. 5");
    sheets.push(errors()?);
    begin("Fig. 7");
    sheets.push(loads("fig-7a", "0.001", "A/λ = 0.01, λ/R = 0.1", &[0.12, 0.24, 0.36, 0.48])?);
    sheets.push(loads("fig-7b", "0.01", "A/λ = 0.1, λ/R = 0.1", &[0.4, 0.6, 0.8])?);
    begin("Fig. 8");
    sheets.extend(curves(["fig-8a", "fig-8b"], "fig-8", "Slight waves, A/λ = 0.01, λ/R = 0.1, γ' = 0.05")?);
    begin("Fig. 9");
    sheets.extend(curves(["fig-9a", "fig-9b"], "fig-9", "Steep waves, A/λ = 0.05, λ/R = 0.05, γ' = 0.025")?);
    begin("Fig. 10");
    sheets.push(losses("fig-10a", Control::Displacement)?);
    sheets.push(losses("fig-10b", Control::Force)?);
    begin("rate");
    sheets.push(rates()?);
    Ok(sheets)
}

/// Force over approach and contact radius over force of a shipped preset, in the paper's rings, over the exact solution.
fn curves(
    names: [&'static str; 2],
    preset: &'static str,
    title: &str,
) -> Result<[PaperSheet; 2], PaperError> {
    // In this figure the paper marks where the bodies come apart.
    let has_ends = preset == "fig-8";
    let preset = shipped(preset, &[])?;
    let data = checked(&preset)?;
    let case = &data.case;
    let theory = Exact::of(&case.problem).name();
    let sheet = |name, view, what: &str| {
        let mut figure = figure(&data, view);
        let ends = if has_ends { ends(&data, view, &mut figure) } else { String::new() };
        let caption = format!(
            "{title}: {what}. {} rings, stable parts solid, unstable ones dashed under displacement control, limit points \
             marked.{ends} {theory} (dots): our curve is nowhere further from it than {} of the picture.",
            case.basis.size(),
            significant(furthest(&figure), 2)
        );
        // The paper plots the contact radius upward.
        let figure = if view == View::ForceRadius { figure.transposed() } else { figure };
        PaperSheet { name, figure, caption }
    };
    Ok([
        sheet(names[0], View::ForceApproach, "the force over the approach"),
        sheet(names[1], View::ForceRadius, "the contact radius over the force"),
    ])
}

/// Marks A, where the bodies come apart under a dead load, and B, where they do under displacement, and returns their
/// coordinates as text.
fn ends(data: &CurveData, view: View, figure: &mut Figure) -> String {
    let least = |of: fn(&CurvePoint) -> f64| data.points.iter().min_by(|a, b| of(a).total_cmp(&of(b)));
    let scale = Scale::of(data, Axes::Reduced);
    let mut said = String::new();
    let ends =
        [('A', least(|at| at.force), "smallest force"), ('B', least(|at| at.approach), "smallest approach")];
    for (letter, point, what) in ends {
        let Some(point) = point else { continue };
        let (force, approach) = (scale.force(point.force), point.approach);
        figure.marks.push(Mark { sign: Sign::Letter(letter), at: scale.place(view, place(point)) });
        let [force, approach] = [force, approach].map(|x| significant(x, 4));
        // Writing to a string cannot fail.
        let _ = write!(said, " {letter}: the {what}, P = {force} P_c at δ = {approach} R.");
    }
    said
}

/// The largest distance of the computed curve from the exact one, as a share of the picture.
fn furthest(figure: &Figure) -> f64 {
    let share = |(x, y): &(f64, f64)| {
        let share = |[lo, hi]: [f64; 2], value: f64| (value - lo) / (hi - lo);
        (share(figure.bounds.x, *x), share(figure.bounds.y, *y))
    };
    let points = |wanted: &dyn Fn(Role) -> bool| -> Vec<(f64, f64)> {
        figure
            .lines
            .iter()
            .filter(|line| wanted(line.role))
            .flat_map(|line| line.points.iter().map(share))
            .collect()
    };
    let ours = points(&|role| matches!(role, Role::Stable | Role::Unstable));
    let exact = points(&|role| role == Role::Exact);
    let from = |(x, y): (f64, f64)| {
        exact.windows(2).map(|ends| distance((x, y), ends[0], ends[1])).fold(f64::INFINITY, f64::min)
    };
    ours.into_iter().map(from).fold(0.0, f64::max)
}

/// The distance of a point from the line between two others.
fn distance((x, y): (f64, f64), (ax, ay): (f64, f64), (bx, by): (f64, f64)) -> f64 {
    let (dx, dy) = (bx - ax, by - ay);
    let length = dx * dx + dy * dy;
    let share = if length > 0.0 { (((x - ax) * dx + (y - ay) * dy) / length).clamp(0.0, 1.0) } else { 0.0 };
    (x - ax - share * dx).hypot(y - ay - share * dy)
}

/// A view of a curve with the exact solution.
fn figure(data: &CurveData, view: View) -> Figure {
    let overlays = Overlays { smooth: true, exact: true, envelope: false };
    let subject = Subject::alone(data, overlays);
    subject.figure(view)
}

/// The quasi-static path of Fig. 9 and its losses, in the exact basis, whose energies are accurate to rounding.
fn losses(name: &'static str, control: Control) -> Result<PaperSheet, PaperError> {
    let word = if control == Control::Force { "force" } else { "displacement" };
    let set = [format!("path.control={word}"), "basis.kind=exact".to_owned()];
    let preset = shipped("fig-9", &[&set[0], &set[1]])?;
    let data = checked(&preset)?;
    let events = data.report.as_ref().map_or(&[][..], |report| &report.events);
    let total: f64 = events.iter().filter_map(|event| event.dissipated).sum();
    let apart = events
        .iter()
        .filter_map(|event| Some((event.dissipated? - event.dissipated_by_area?).abs() / event.dissipated?))
        .fold(0.0, f64::max);
    let caption = format!(
        "The instabilities of Fig. 9 under {word} control: the path followed (solid), the jumps, and the energy each \
         dissipates (hatched), {} E*R³ in the {} of them that lose a defined energy. The drop of the potential and the \
         hatched area, found independently, differ by at most {}.",
        significant(total, 5),
        events.iter().filter(|event| event.dissipated.is_some()).count(),
        significant(apart, 2)
    );
    Ok(PaperSheet { name, figure: figure(&data, View::Unloading), caption })
}

/// The largest pull of Fig. 9 over the rate of the pull, with its limit at low rates.
fn rates() -> Result<PaperSheet, PaperError> {
    const EXPONENT: f64 = 0.5;
    // Twenty per decade.
    let rates: Vec<f64> = (-160..=40).map(|k| pow(10.0, f64::from(k) / 20.0)).collect();
    let exponent = format!("edge.exponent={EXPONENT}");
    let preset = shipped("fig-9", &["basis.kind=exact", &exponent, "path.rate=1"])?;
    let column = QuantityColumn::named("peak_force").map_err(|_| PaperError::Missing("peak_force"))?;
    let values = rates.iter().map(|rate| (*rate).into()).collect();
    let wish = StudyWish { preset: preset.clone(), key: Key::Borrowed(RATE), column, values, over: None };
    let data = wish.run(threads(), &Unwatched, &mut |_| {}).ok_or(PaperError::Missing("the study"))?;
    let mut figure = study::of(&data, &preset, Axes::Raw);
    // No preset is being varied here.
    figure.lines.retain(|line| line.role != Role::Level);
    figure.marks.clear();
    let found = |rate: f64| {
        let at = data.nearest(rate).map(|(at, _)| &data.outcomes[at]);
        let force = if let Some(StudyOutcome::Found(Cell::Number(force))) = at { *force } else { f64::NAN };
        let critical = critical_force(&preset).unwrap_or(f64::NAN);
        significant(-force / critical, 4)
    };
    let caption = format!(
        "Beyond the paper: the smallest force of Fig. 9 over the rate V/v₀ of the pull, with an edge that costs \
         γ [1 + (v/v₀)^{EXPONENT}]. The thin line is the quasi-static path, the dots the first order beside it. The pull is {} P_c \
         at V = 1e-8 v₀, {} P_c at 1e-2 v₀, {} P_c at v₀.",
        found(1e-8),
        found(1e-2),
        found(1.0)
    );
    Ok(PaperSheet { name: "rate", figure, caption })
}

/// The contact pressure of the smooth sphere in a few rings, over theory.
fn smooth_pressure(
    name: &'static str,
    preset: &'static str,
    s: f64,
    theory: &str,
) -> Result<PaperSheet, PaperError> {
    let preset = shipped(preset, &[FEW_RINGS])?;
    let case = Case::new(&preset)?;
    let pressure = Pressure::at(&case, s)?;
    let rings = case.basis.size();
    let caption = format!(
        "The contact pressure of the smooth sphere at s = {s} R in {rings} rings (steps) and {theory} (dots). Within \
         {COMPARED} s they differ by at most {} of the pressure on the axis.",
        significant(pressure.apart, 2)
    );
    let lines = vec![
        Line::new(Role::Zero, "", vec![(0.0, 0.0), (1.0, 0.0)]),
        Line::new(Role::Body, format!("{rings} rings"), pressure.steps(rings)),
        Line::new(Role::Exact, Exact::of(&case.problem).name(), pressure.exact),
    ];
    Ok(PaperSheet { name, figure: pressures("r/s", lines), caption })
}

/// The pressure on waves without adhesion at these contact radii.
fn loads(name: &'static str, amplitude: &str, title: &str, radii: &[f64]) -> Result<PaperSheet, PaperError> {
    let last = radii.iter().copied().fold(0.0, f64::max);
    let set = [
        "material.work_of_adhesion=0".to_owned(),
        format!("gap.amplitude={amplitude}"),
        "basis.kind=exact".to_owned(),
        format!("path.start_contact_radius={last}"),
    ];
    let preset = shipped("fig-8", &[&set[0], &set[1], &set[2], &set[3]])?;
    let case = Case::new(&preset)?;
    let mut lines = vec![Line::new(Role::Zero, "", vec![(0.0, 0.0), (last, 0.0)])];
    let (mut apart, mut smallest) = (0.0_f64, f64::INFINITY);
    for (i, &s) in radii.iter().enumerate() {
        let pressure = Pressure::at(&case, s)?;
        apart = apart.max(pressure.apart);
        smallest = pressure.ours.iter().map(|(_, p)| *p).fold(smallest, f64::min);
        let load = format!("P = {} E*R²", significant(pressure.force, 3));
        let at_radius = |line: Vec<(f64, f64)>| line.into_iter().map(|(r, p)| (r * s, p)).collect();
        lines.push(Line::new(Role::Pin(i + 1), load, at_radius(pressure.ours)));
        lines.push(Line::new(Role::Exact, Exact::of(&case.problem).name(), at_radius(pressure.exact)));
    }
    let sign = if smallest < 0.0 {
        "Where the waves are steep the pressure is negative in the troughs: without adhesion the disc would come apart \
         there, and one connected disc is an assumption."
    } else {
        "It is positive everywhere, so the contact is one connected disc."
    };
    let caption = format!(
        "The contact pressure on waves without adhesion, {title}, under rising load: as computed (lines) and the exact \
         solution (dots). {sign} The two differ by at most {} of the pressure on the axis.",
        significant(apart, 2)
    );
    Ok(PaperSheet { name, figure: pressures("r/R", lines), caption })
}

fn pressures(radius: &str, lines: Vec<Line>) -> Figure {
    let axis = |title: &str| Axis::pure(title.to_owned());
    Figure::of(axis(radius), axis("p/E*"), lines)
}

/// A pressure and the exact one, over r/s.
struct Pressure {
    ours: Vec<(f64, f64)>,
    exact: Vec<(f64, f64)>,
    /// P.
    force: f64,
    /// The largest difference within `COMPARED`, in units of the exact pressure on the axis.
    apart: f64,
}

impl Pressure {
    /// At the equilibrium of contact radius `s`, in the problem's own units, which here are reduced ones.
    fn at(case: &Case, s: f64) -> Result<Self, PaperError> {
        let state = case.basis.equilibrium(&case.reduced, s).ok_or(PaperError::NoState(s))?;
        let judge = Judge::new(&case.reduced, &case.table);
        let profile = Profile::of(&case.reduced, &*case.basis, &judge, s, state.approach);
        let exact = Exact::of(&case.problem);
        let ours: Vec<(f64, f64)> =
            profile.inside.iter().map(|inside| (inside.radius / s, inside.pressure)).collect();
        let axis = exact.pressure(s, 0.0).abs();
        let apart = ours
            .iter()
            .filter(|(r, _)| *r <= COMPARED)
            .map(|(r, p)| (p - exact.pressure(s, r * s)).abs() / axis)
            .fold(0.0, f64::max);
        // Up to our last radius, beyond which the exact pressure falls without bound.
        let last = ours.last().map_or(0.0, |(r, _)| *r);
        let fine = (0..=400).map(|i| last * f64::from(i) / 400.0);
        let exact = fine.map(|r| (r, exact.pressure(s, r * s))).collect();
        Ok(Self { ours, exact, force: state.force, apart })
    }

    /// The pressure of uniform rings, as the step function that it is.
    fn steps(&self, rings: usize) -> Vec<(f64, f64)> {
        let half = 0.5 / rings as f64;
        self.ours.iter().flat_map(|(r, p)| [(r - half, *p), (r + half, *p)]).collect()
    }
}

/// The errors of force and contact radius over the number of rings.
fn errors() -> Result<PaperSheet, PaperError> {
    let (mut lines, mut marks) = (Vec::new(), Vec::new());
    let mut words = Vec::new();
    for (i, (title, work_of_adhesion)) in [("Hertz", 0.0), ("JKR", 0.01)].into_iter().enumerate() {
        let exact = smooth(work_of_adhesion);
        let radius = radius_at(&exact, APPROACH);
        let force = exact.force(radius);
        let problem = sphere(work_of_adhesion).reduced();
        let mut found = Vec::new();
        for rings in RINGS {
            let basis = Rings::shared_with(rings, Grading::Uniform, &pulloff_engine::progress::Unwatched)?;
            let start = 3.0 * radius;
            let solved =
                solve(&*basis, &problem, Control::Displacement, APPROACH, start, NewtonSettings::default());
            let state = solved.map_err(|_| PaperError::NoState(radius))?.evaluation;
            let errors =
                [((state.contact_radius - radius) / radius).abs(), ((state.force - force) / force).abs()];
            found.push((rings as f64, errors));
        }
        for (k, quantity) in ["contact radius", "force"].into_iter().enumerate() {
            let points: Vec<(f64, f64)> = found.iter().map(|(rings, errors)| (*rings, errors[k])).collect();
            if let [.., (before, larger), (after, smaller)] = points[..] {
                let order = (larger / smaller).ln() / (after / before).ln();
                words.push(format!("{title}, {quantity}: {}", significant(order, 2)));
            }
            marks.extend(points.iter().map(|at| Mark { sign: Sign::Value, at: *at }));
            lines.push(Line::new(Role::Pin(2 * i + k + 1), format!("{title}, {quantity}"), points));
        }
    }
    // Half-way on paper between the two lowest curves at the smallest number of rings, clear of all curves.
    let [fewest, most] = [RINGS[0], RINGS[RINGS.len() - 1]].map(|rings| rings as f64);
    let ends =
        |line: &Line| line.points.first().zip(line.points.last()).map(|(first, last)| [first.1, last.1]);
    let ends: Vec<[f64; 2]> = lines.iter().filter_map(ends).collect();
    let mut first: Vec<f64> = ends.iter().map(|errors| errors[0]).collect();
    first.sort_by(f64::total_cmp);
    if let [lowest, next, ..] = first[..] {
        let error = (lowest * next).sqrt();
        lines.push(Line::new(Role::Zero, "1/N", vec![(fewest, error), (most, error * fewest / most)]));
    }
    // The last two curves are those of JKR: contact radius, force.
    let behind = match ends[..] {
        [.., radius, force] if force[1] > radius[1] => format!(
            " With adhesion our force converges more slowly than the contact radius here: its error is {} times as large in {fewest} \
             rings and {} times in {most}; the paper finds the force the more accurate of the two.",
            significant(force[0] / radius[0], 2),
            significant(force[1] / radius[1], 2)
        ),
        _ => String::new(),
    };
    let axis = |title: &str| Axis::pure(title.to_owned()).running(AxisScale::Logarithmic);
    let caption = format!(
        "The errors of contact radius and force at the approach δ = {APPROACH} R, relative to the exact values, over the \
         number of rings N, computed at the marks; the thin line falls as 1/N. The observed orders at the finest meshes are \
         {}.{behind}",
        words.join("; ")
    );
    let figure = Figure { marks, ..Figure::of(axis("N"), axis("relative error"), lines) };
    Ok(PaperSheet { name: "fig-5", figure, caption })
}

/// A shipped preset with assignments.
pub fn shipped(name: &'static str, assignments: &[&str]) -> Result<Preset, PaperError> {
    let found = shipped::find(name).ok_or(PaperError::Missing(name))?;
    Ok(read_with(name, found.text, assignments)?)
}

fn checked(preset: &Preset) -> Result<CurveData, PaperError> {
    let data = CurveData::compute(preset, &Staged::unwatched())?;
    Ok(data.checked(&Unwatched).unwrap_or(data))
}
