//! Random problems of every shape through the engine, as a user writes them, against an independent quadrature.
//!
//! `cargo test --test engine campaign::` runs sixty of them. To run all two thousand:
//!
//! ```text
//! cargo test --release --test engine campaign:: -- --ignored --nocapture
//! ```
//!
//! With `PULLOFF_CAMPAIGN=17..18` before that line, only those numbers run; each problem is drawn independently. The
//! answers are compared with `support/quadrature.rs`: states and events to 1e-8 of their ranges, radii of limit points
//! to a relative 1e-6, losses to a relative 1e-6. A missed or invented event is a failure; so is a refused start where
//! one exists. Refusals are counted by reason.

#![allow(
    clippy::float_cmp,
    clippy::unreadable_literal,
    clippy::maybe_infinite_iter,
    clippy::items_after_statements,
    clippy::too_many_lines,
    reason = "numbers copied digit by digit, and special cases told by their exact values"
)]
#![allow(clippy::unwrap_used, clippy::panic, reason = "a helper of a test fails the test by panicking")]

use crate::support::problems::{Problem, Start, draw};
use crate::support::quadrature::{Disc, Path, State};
use pulloff_engine::case::{Case, CaseError};
use pulloff_engine::gap::{Gap, Shape};
use pulloff_engine::problem::Control;
use pulloff_engine::problem::Turn;
use pulloff_engine::progress::Unwatched;
use pulloff_engine::quasistatic::path::{Event, EventKind, Path as Ours, PathSetting, PathState};
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::fmt::Write;
use std::ops::Range;
use std::sync::atomic::{AtomicU64, Ordering};

/// The tolerance of states and events, as a share of their ranges.
const STATES: f64 = 1e-8;
/// The relative tolerance of the radii of limit points.
const LIMITS: f64 = 1e-6;
/// The tolerances of losses: relative, and as a share of δ times P. For δ and P, their ranges on the path are taken or,
/// where the path is short, their sizes, because a loss is a difference of energies.
const LOSSES: [f64; 2] = [1e-6, 1e-14];
/// Larger errors than this are printed.
const NOTABLE: f64 = 1e-10;
/// Controls closer than this share of the range are a tie: rounding decides which of two landings is taken.
const TIE: f64 = 1e-13;
/// How far beyond the start a state is looked for, where the gap continues.
const OUTWARD: [f64; 4] = [1.0, 2.0, 6.0, 20.0];

/// The largest contact, as a share of the radius up to which a gap is known.
const LARGEST_CONTACT: f64 = 0.995;

/// The worst of each kind of error, as shares of the tolerance.
#[derive(Debug, Clone, Copy, Default)]
struct Worst {
    states: f64,
    limits: f64,
    losses: f64,
}

impl Worst {
    fn with(self, other: Self) -> Self {
        Self {
            states: self.states.max(other.states),
            limits: self.limits.max(other.limits),
            losses: self.losses.max(other.losses),
        }
    }
}

/// The outcome of a problem.
enum Outcome {
    Right {
        worst: Worst,
        events: usize,
        corners: usize,
    },
    /// The reason of the refusal.
    Refused(String),
    /// The numbers differ, and the engine warned of it.
    Warned(String),
    Wrong(String),
}

/// Compares the engine's answer for a problem with the truth.
fn judge(problem: &Problem) -> Outcome {
    let case = match Case::new(&problem.preset) {
        Ok(case) => case,
        Err(error) => return refused(problem, &error),
    };
    let curve = match case.curve(&Unwatched) {
        Ok(curve) => curve,
        Err(error) => return refused(problem, &error),
    };
    let ours = match case.unload(&curve, &PathSetting::one_disc(case.control), &Unwatched) {
        Ok(ours) => ours,
        Err(error) => return refused(problem, &error),
    };
    if case.start * case.units().length > LARGEST_CONTACT * problem.end * problem.length {
        return Outcome::Refused(format!("{}: starts where the quadrature does not look", problem.kind));
    }
    let Some(Truth { disc, from, stretches }) = truth(problem) else {
        return Outcome::Wrong(format!(
            "started at {:e}, where nothing starts",
            case.start * case.units().length
        ));
    };
    // The truth must be consistent with itself.
    let finer = disc.clone().with_nodes(24);
    for share in [0.13, 0.57, 0.91] {
        let s = share * disc.reach();
        let (a, b) = (disc.state(s), finer.state(s));
        let [size, _] = disc.sizes(s);
        assert!(
            (a.approach - b.approach).abs() <= 1e-12 * size,
            "the quadrature is not fine enough:\n{}",
            problem.text
        );
    }
    let warned = |error: String| {
        let warnings = case.warnings(case.start);
        let digits = warnings.iter().find(|w| w.contains("digits") || w.contains("certified"));
        digits.map_or(Outcome::Wrong(error.clone()), |w| Outcome::Warned(format!("{w}: {error}")))
    };
    let mut worst = Worst::default();
    for share in [1.0, 0.97, 0.71, 0.43, 0.18, 0.09, 0.03, 0.01] {
        let s = share * from;
        match state(problem, &case, &disc, s) {
            Ok(error) => worst.states = worst.states.max(error),
            Err(error) => return warned(error),
        }
    }
    for [corner, _] in disc.corners().iter().filter(|corner| corner[0] < from) {
        // On a corner the curve is a root of the radius, so a change of units takes its last digit.
        for beside in [1.0 - 1e-6, 1.0 + 1e-6] {
            match state(problem, &case, &disc, beside * corner) {
                Ok(error) => worst.states = worst.states.max(error),
                Err(error) => return warned(error),
            }
        }
    }
    if std::env::var("SHOW").is_ok() {
        let path = disc.unload(problem.control, &stretches, from, 0.004 * from).unwrap();
        for (event, jump) in ours.events.iter().zip(&path.jumps) {
            let s = event.before.as_ref().unwrap().contact_radius * case.units().length / problem.length;
            let at =
                case.basis.equilibrium(&case.reduced, event.before.as_ref().unwrap().contact_radius).unwrap();
            println!("engine {s:e} truth {:e} slopes {:?}", jump.before.radius, at.slopes());
            for n in [16, 24, 40] {
                let d = disc.clone().with_nodes(n);
                let h = 1e-5 * s;
                println!(
                    "{n}: tend {:e} {:e}; diff {:e}",
                    d.tendency(s, problem.control),
                    d.tendency(jump.before.radius, problem.control),
                    (d.state(s + h).force - d.state(s - h).force) / (2.0 * h)
                );
            }
        }
        if let Shape::Profile(m) = &problem.preset.gap {
            let k = m.profile().knots();
            for w in k.windows(3) {
                let (a, b) = (0.5 * (w[0] + w[1]), 0.5 * (w[1] + w[2]));
                let (ja, jb) = (m.profile().jet(a), m.profile().jet(b));
                let (ta, tb) = (w[1] - a, w[1] - b);
                let left = ja.first + ta * (ja.second + 0.5 * ta * ja.third);
                let right = jb.first + tb * (jb.second + 0.5 * tb * jb.third);
                println!(
                    "{:.6} {:e} jump {:e}  ({:e})",
                    w[1] / problem.length,
                    left,
                    right - left,
                    (w[2] - w[1]) / problem.length
                );
            }
        }
        println!("{}", problem.text);
    }
    let to = case.end * case.units().length / problem.length;
    let path = |stretches: &[[f64; 2]]| disc.unload(problem.control, stretches, from, to);
    let compare = |path: Option<Path>| compare(problem, &case, &ours, &disc, from, &path.ok_or("no path")?);
    // Where they differ, too few radii may have been examined.
    let found = compare(path(&stretches)).or_else(|_| compare(path(&disc.rising(problem.control, 12))));
    match found {
        Ok(errors) => {
            let corners = disc.corners();
            let on_corner = |event: &&Event| {
                let s = event.before.as_ref().unwrap().contact_radius * case.units().length / problem.length;
                corners.iter().any(|corner| (corner[0] - s).abs() <= 1e-14 * s)
            };
            Outcome::Right {
                worst: worst.with(errors),
                events: ours.events.len(),
                corners: ours.events.iter().filter(on_corner).count(),
            }
        }
        Err(error) => warned(error),
    }
}

/// The number of questions after which a loop counts as too long.
const QUESTIONS: u64 = 5_000;

/// The unloading branch of the loop that turns at the start of a problem, as an unloading; or why there is none, in words.
fn way_down(problem: &Problem, case: &Case) -> Result<Ours, String> {
    let asked = AtomicU64::new(0);
    let tired = || asked.fetch_add(1, Ordering::Relaxed) > QUESTIONS;
    let turn = Turn::Radius(case.start);
    let cycle = case.cycle(Some(turn), &case.setting(), &tired).map_err(|error| {
        let words = error.to_string();
        words.chars().filter(|c| !c.is_ascii_digit()).collect::<String>()
    })?;
    let turned = cycle.events.iter().position(|event| event.kind == EventKind::Turn);
    let turned = turned.ok_or("no turn")?;
    let start = cycle.events[turned].after.clone().ok_or("nothing at the turn")?;
    if start.rings() > 0 {
        return Err("turns with rings".to_owned());
    }
    if start.contact_radius * case.units().length > LARGEST_CONTACT * problem.end * problem.length {
        return Err("turns where the quadrature does not look".to_owned());
    }
    Ok(Ours { events: cycle.events[turned + 1..].to_vec(), states: vec![start], ..cycle })
}

/// Compares the unloading branch of a loop with the unloading of its disc.
fn judge_loop(problem: &Problem) -> Outcome {
    let case = match Case::new(&problem.preset) {
        Ok(case) => case,
        Err(error) => return Outcome::Refused(error.to_string()),
    };
    let ours = match way_down(problem, &case) {
        Ok(ours) => ours,
        Err(reason) => return Outcome::Refused(format!("{}: {reason}", problem.kind)),
    };
    let from = ours.start().unwrap().contact_radius * case.units().length / problem.length;
    let known = LARGEST_CONTACT * problem.end;
    let disc = Disc::new(&problem.terms, problem.gamma, (1.05 * from).min(known));
    let found = [1, 12].map(|finer| {
        let path = disc.unload(problem.control, &disc.rising(problem.control, finer), from, 1e-5 * from);
        compare(problem, &case, &ours, &disc, from, &path.ok_or("no path")?)
    });
    match found {
        [Ok(worst), _] | [_, Ok(worst)] => Outcome::Right { worst, events: ours.events.len(), corners: 0 },
        [_, Err(error)] if error.starts_with("a tie") => Outcome::Refused("a tie".to_owned()),
        [_, Err(error)] => Outcome::Wrong(error),
    }
}

/// A refusal, which is right unless the truth has a start and a path.
fn refused(problem: &Problem, error: &CaseError) -> Outcome {
    let words = error.to_string();
    let reason = match error {
        CaseError::Start { .. } => "no start",
        CaseError::Path { .. } => "unstable start",
        CaseError::Table { .. } => "too fine to tabulate",
        _ => "other",
    };
    if let (CaseError::Start { .. } | CaseError::Path { .. }, Some(Truth { from, .. })) =
        (error, truth(problem))
    {
        return Outcome::Wrong(format!("refused, and starts at {from:e}: {words}"));
    }
    println!("{words}\n{}", problem.text);
    Outcome::Refused(format!("{}: {reason}", problem.kind))
}

/// The disc up to where its path begins, the requested radius, and the stretches on which the control rises.
struct Truth {
    disc: Disc,
    from: f64,
    stretches: Vec<[f64; 2]>,
}

/// The truth; `None` where no path begins.
fn truth(problem: &Problem) -> Option<Truth> {
    let known = LARGEST_CONTACT * problem.end;
    let disc = |reach: f64| Disc::new(&problem.terms, problem.gamma, reach.min(known));
    let outermost = |control, value| {
        [2.5, 10.0, 40.0]
            .into_iter()
            .find_map(|factor| disc(factor * problem.drawn).outermost(control, value))
    };
    let from = match problem.start {
        Start::Radius(from) => from,
        Start::Approach(value) => outermost(Control::Displacement, value)?,
        Start::Force(value) => outermost(Control::Force, value)?,
    };
    for factor in OUTWARD {
        let disc = disc(factor * from);
        if from > disc.reach() {
            return None;
        }
        let stretches = disc.rising(problem.control, 1);
        if disc.start(problem.control, &stretches, from).is_some() {
            return Some(Truth { disc, from, stretches });
        }
    }
    None
}

/// The distance of the engine's state of radius `s` from the true one, over the sizes of δ and P.
fn state(problem: &Problem, case: &Case, disc: &Disc, s: f64) -> Result<f64, String> {
    let units = case.units();
    let at = case.basis.equilibrium(&case.reduced, s * problem.length / units.length);
    let Some(at) = at else { return Err(format!("no equilibrium at {s:e}")) };
    let ours = scaled(problem, case, s, at.approach, at.force);
    let truth = disc.state(s);
    let sizes = disc.sizes(s);
    let error = ((ours.approach - truth.approach) / sizes[0])
        .abs()
        .max(((ours.force - truth.force) / sizes[1]).abs());
    if error <= STATES { Ok(error) } else { Err(format!("at {s:e}: {ours:?} is {truth:?}")) }
}

fn scaled(problem: &Problem, case: &Case, s: f64, approach: f64, force: f64) -> State {
    let units = case.units();
    let length = units.length / problem.length;
    let force_unit = units.force / problem.modulus / problem.length / problem.length;
    State { radius: s, approach: approach * length, force: force * force_unit }
}

/// Compares the paths.
fn compare(
    problem: &Problem,
    case: &Case,
    ours: &Ours,
    disc: &Disc,
    from: f64,
    truth: &Path,
) -> Result<Worst, String> {
    let length = case.units().length / problem.length;
    let in_ours =
        |state: &PathState| scaled(problem, case, state.contact_radius * length, state.approach, state.force);
    let told = || tell(truth, ours, &in_ours);
    if ours.events.len() != truth.jumps.len() {
        if let Some(tie) = truth.jumps.iter().find(|jump| jump.margin <= TIE * disc.sizes(from)[0]) {
            return Err(format!("a tie: {tie:?}"));
        }
        return Err(format!("{} events are {}\n{}", ours.events.len(), truth.jumps.len(), told()));
    }
    let ranges = ranges(truth);
    let mut worst = Worst::default();
    let mut near = |what: &str, a: State, b: State| -> Result<(), String> {
        let error =
            ((a.approach - b.approach) / ranges[0]).abs().max(((a.force - b.force) / ranges[1]).abs());
        worst.states = worst.states.max(error);
        if error <= STATES { Ok(()) } else { Err(format!("{what}: off by {error:e}\n{}", told())) }
    };
    near("start", in_ours(ours.start().unwrap()), truth.start)?;
    for (event, jump) in ours.events.iter().zip(&truth.jumps) {
        let before = in_ours(event.before.as_ref().unwrap());
        near("limit point", before, jump.before)?;
        match (&event.after, jump.after) {
            (Some(after), Some(truth)) => {
                let after = in_ours(after);
                near("landing", after, truth)?;
                // Near a limit point the radius of a landing is a root of the control's rounding error.
                let error = (after.radius - truth.radius).abs() / from;
                let size = Disc::held(
                    problem.control,
                    &State { radius: 0.0, approach: ranges[0], force: ranges[1] },
                );
                let control = Disc::held(problem.control, &disc.state(after.radius))
                    - Disc::held(problem.control, &truth);
                if error > STATES && control.abs() > 1e-13 * size {
                    return Err(format!("landing: the radius is off by {error:e}\n{}", told()));
                }
            }
            (None, None) => {}
            _ => return Err(format!("another kind\n{}", told())),
        }
    }
    for (event, jump) in ours.events.iter().zip(&truth.jumps) {
        let before = in_ours(event.before.as_ref().unwrap());
        let error = (before.radius / jump.before.radius - 1.0).abs();
        worst.limits = worst.limits.max(error);
        if error > LIMITS {
            return Err(format!("limit point: the radius is off by {error:e}\n{}", told()));
        }
        let unit = case.units().energy / (problem.modulus * problem.length.powi(3));
        for loss in [event.dissipated, event.dissipated_by_area] {
            match (loss, jump.loss) {
                (Some(loss), Some(truth)) => {
                    let sizes = disc.sizes(jump.before.radius);
                    let energy = (ranges[0] * ranges[1]).max(sizes[0] * sizes[1]);
                    let (loss, floor) = (loss * unit, LOSSES[1] * energy);
                    let off = (loss - truth).abs();
                    if off > floor {
                        worst.losses = worst.losses.max(off / truth.abs());
                    }
                    if off > LOSSES[0] * truth.abs() + floor {
                        return Err(format!("loss: {loss:e} is {truth:e}, floor {floor:e}\n{}", told()));
                    }
                }
                (None, None) => {}
                other => return Err(format!("loss: {other:?}\n{}", told())),
            }
        }
    }
    Ok(worst)
}

/// The ranges of δ and P over the path, from bodies apart to its ends.
fn ranges(path: &Path) -> [f64; 2] {
    let states =
        path.jumps.iter().flat_map(|jump| [Some(jump.before), jump.after]).flatten().chain([path.start]);
    let mut ranges = [[0.0_f64; 2]; 2];
    for state in states {
        for (range, x) in ranges.iter_mut().zip([state.approach, state.force]) {
            *range = [range[0].min(x), range[1].max(x)];
        }
    }
    ranges.map(|[lo, hi]| hi - lo)
}

fn tell(truth: &Path, ours: &Ours, in_ours: &dyn Fn(&PathState) -> State) -> String {
    let mut text = format!("  start {:?}, true {:?}\n", in_ours(ours.start().unwrap()), truth.start);
    for event in &ours.events {
        let (before, after) = (in_ours(event.before.as_ref().unwrap()), event.after.as_ref().map(in_ours));
        writeln!(text, "  ours {before:?} > {:?}; {:?}", after.map(|a| a.radius), event.dissipated).unwrap();
    }
    for jump in &truth.jumps {
        let after = jump.after.map(|a| a.radius);
        writeln!(text, "  true {:?} > {after:?}; {:?}, margin {:e}", jump.before, jump.loss, jump.margin)
            .unwrap();
    }
    text
}

/// Runs the problems with these numbers and prints their outcomes.
fn campaign(numbers: Range<u64>, judge: fn(&Problem) -> Outcome, share: f64) {
    let count = numbers.end - numbers.start;
    let outcomes: Vec<(u64, Option<Problem>, Outcome)> = numbers
        .into_par_iter()
        .map(|number| match draw(number) {
            Ok(problem) => {
                let outcome = judge(&problem);
                (number, Some(problem), outcome)
            }
            Err(reason) => (number, None, Outcome::Refused(format!("preset: {reason}"))),
        })
        .collect();
    let mut refused: BTreeMap<String, usize> = BTreeMap::new();
    let mut worst: BTreeMap<&str, (usize, usize, usize, Worst)> = BTreeMap::new();
    let mut failures = String::new();
    for (number, problem, outcome) in &outcomes {
        let text = problem.as_ref().map_or("", |problem| &problem.text);
        match outcome {
            Outcome::Right { worst: errors, events, corners } => {
                if errors.states > NOTABLE || errors.losses > NOTABLE {
                    println!("{number}: {errors:?}");
                }
                let of = worst.entry(problem.as_ref().map_or("", |problem| problem.kind)).or_default();
                *of = (of.0 + 1, of.1 + events, of.2 + corners, of.3.with(*errors));
            }
            Outcome::Refused(reason) => {
                println!("{number} refused: {reason}");
                *refused.entry(reason.clone()).or_default() += 1;
            }
            Outcome::Warned(reason) => {
                println!("{number} warned: {reason}");
                *refused.entry("warned, and wrong".to_owned()).or_default() += 1;
            }
            Outcome::Wrong(reason) => write!(failures, "\nproblem {number}: {reason}\n{text}").unwrap(),
        }
    }
    for (kind, (problems, events, corners, Worst { states, limits, losses })) in &worst {
        println!(
            "{kind}: {problems} right, {events} events ({corners} on corners), worst: states {states:.1e}, limit points {limits:.1e}, losses {losses:.1e}"
        );
    }
    println!("refused: {refused:?}");
    assert!(failures.is_empty(), "{failures}");
    let right: usize = worst.values().map(|of| of.0).sum();
    let events: usize = worst.values().map(|of| of.1).sum();
    assert!(
        right as f64 >= share * count as f64 && events >= right,
        "only {right} of {count}, {events} events"
    );
}

#[test]
fn sixty_problems_of_every_shape_are_those_of_the_quadrature() {
    campaign(0..60, judge, 0.9);
}

#[test]
fn the_ways_down_of_forty_loops_are_those_of_the_quadrature() {
    campaign(0..40, judge_loop, 0.7);
}

/// The requested numbers, or all of them.
fn asked() -> Range<u64> {
    let asked = std::env::var("PULLOFF_CAMPAIGN").unwrap_or_else(|_| "0..2000".to_owned());
    let (from, to) = asked.split_once("..").unwrap();
    from.parse().unwrap()..to.parse().unwrap()
}

#[test]
#[ignore = "takes a quarter of an hour"]
fn two_thousand_problems_of_every_shape_are_those_of_the_quadrature() {
    campaign(asked(), judge, 0.9);
}

#[test]
#[ignore = "takes a quarter of an hour"]
fn the_ways_down_of_two_thousand_loops_are_those_of_the_quadrature() {
    campaign(asked(), judge_loop, 0.5);
}
