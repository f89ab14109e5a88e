//! Campaigns over paths and reports: a tenth of each in every run of the tests, all of it when ignored tests are run.
//!
//! **Paths as they were.** `data/frozen.txt` has the events of unloadings and loops of random problems, rounded, so
//! that a change in what follows them shows event by event. A line is one path: `u` for an unloading from the start of
//! the problem, or `c` for the loop that turns at its radius, followed by the number of the problem. Then comes each
//! event as the first letter of its kind with the outermost edge before and after, in 1e-5 of the start radius; then
//! the number of events, the sum of the losses and the smallest force in reduced units. A refusal is its sentence
//! without numbers. `FREEZE=0..100 cargo test -p pulloff-engine --test paths all_paths_are_as_they_were -- --ignored`
//! rewrites the lines of these problems; do so only after looking into every difference.
//!
//! **Loops with rings.** No event gains energy, and recomputed states are in equilibrium and overlap nowhere.
//!
//! **Stops.** A report that is told to stop at its n-th question ends as cancelled, whatever n is.

#![allow(
    clippy::float_cmp,
    clippy::unreadable_literal,
    clippy::items_after_statements,
    clippy::too_many_lines,
    clippy::maybe_infinite_iter,
    clippy::disallowed_methods,
    dead_code,
    reason = "shared with the campaign of the program's tests, which judges by functions of its own"
)]
#![allow(clippy::unwrap_used, clippy::panic, reason = "a helper of a test fails the test by panicking")]

#[path = "../../../tests/support/problems.rs"]
pub mod problems;
#[path = "../../../tests/support/quadrature.rs"]
pub mod quadrature;

use crate::support::random_gap;
use problems::{Problem, draw};
use pulloff_engine::annuli::{Around, Contacts, Ground, Wanted};
use pulloff_engine::case::{Case, CaseError};
use pulloff_engine::disc::Table;
use pulloff_engine::preset::{self, shipped};
use pulloff_engine::problem::{Control, Turn};
use pulloff_engine::progress::{Progress, Stopped, Unwatched};
use pulloff_engine::quasistatic::path::{EventKind, Path, PathSetting, PathState, Warning, cycle};
use pulloff_engine::report::map::{MapError, Ordinate};
use pulloff_engine::report::path::Extent;
use pulloff_engine::report::{MapReport, PathReport, StabilityReport, TraceReport};
use pulloff_engine::stability::MapAxis;
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::fmt::Write;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// Problems below this number are looped as well.
const LOOPS: u64 = 300;

/// One in this many of the problems in the file is checked in every run of the tests.
const SHARE: u64 = 10;

/// The questions that a loop may ask before it counts as too long.
const QUESTIONS: u64 = 2_000;

/// For longer paths only the first and the last events are in the file.
const FIRST: usize = 6;
const LAST: usize = 3;

/// Allowed differences: of radii in their last digit, of sums relative to themselves.
const RADII: i64 = 2;
const SUMS: f64 = 2e-5;

/// How much the loss of a jump by area may differ, if there is a warning.
const AREA: f64 = 1e-2;

fn letter(kind: EventKind) -> char {
    match kind {
        EventKind::FirstTouch => 'F',
        EventKind::Touch => 'T',
        EventKind::Merge => 'M',
        EventKind::SnapIn => 'I',
        EventKind::Snap => 'S',
        EventKind::LastContact => 'L',
        EventKind::Split => 'P',
        EventKind::Vanish => 'V',
        EventKind::Turn => 'R',
        EventKind::JumpIn => 'J',
        EventKind::SnapOff => 'O',
        EventKind::Depin => 'D',
    }
}

/// A path as a line.
fn line(found: Result<Path, CaseError>, unit: f64) -> String {
    let path = match found {
        Ok(path) => path,
        Err(error) => {
            let words: String =
                error.to_string().chars().filter(|c| c.is_alphabetic() || *c == ' ').collect();
            return format!("! {}", words.split_whitespace().take(8).collect::<Vec<_>>().join(" "));
        }
    };
    let radius = |state: &Option<PathState>| {
        state.as_ref().map_or_else(String::new, |state| format!("{:.0}", 1e5 * state.contact_radius / unit))
    };
    let mut text = String::new();
    for (k, event) in path.events.iter().enumerate() {
        if k < FIRST || k + LAST >= path.events.len() {
            let [before, after] = [&event.before, &event.after].map(radius);
            write!(text, "{}{before}>{after} ", letter(event.kind)).unwrap();
        }
    }
    let pull = path.states.iter().map(|state| state.force).fold(f64::INFINITY, f64::min);
    write!(text, "{} {:.5e} {pull:.5e}", path.events.len(), path.losses()).unwrap();
    text
}

fn unloading(problem: &Problem) -> String {
    let found = Case::new(&problem.preset).and_then(|case| {
        let curve = case.curve(&Unwatched)?;
        let path = case.unload(&curve, &case.setting_of_unloading(), &Unwatched);
        path.map(|path| (path, case.start))
    });
    match found {
        Ok((path, start)) => line(Ok(path), start),
        Err(error) => line(Err(error), 1.0),
    }
}

fn a_loop(problem: &Problem) -> String {
    let asked = AtomicU64::new(0);
    let tired = || asked.fetch_add(1, Ordering::Relaxed) > QUESTIONS;
    match Case::new(&problem.preset) {
        Ok(case) => line(case.cycle(Some(Turn::Radius(case.start)), &case.setting(), &tired), case.start),
        Err(error) => line(Err(error), 1.0),
    }
}

/// The lines of the problems with these numbers, by name.
fn lines(numbers: impl Iterator<Item = u64>) -> BTreeMap<String, String> {
    let numbers: Vec<u64> = numbers.collect();
    let of = |number: &u64| {
        let problem = draw(*number).ok()?;
        let mut lines = vec![(format!("u{number}"), unloading(&problem))];
        if *number < LOOPS {
            lines.push((format!("c{number}"), a_loop(&problem)));
        }
        Some(lines)
    };
    // Paths that take too long are left out.
    numbers.par_iter().filter_map(of).flatten().filter(|(_, line)| line != "! cancelled").collect()
}

/// Whether two lines are the same except for rounding.
fn same(a: &str, b: &str) -> bool {
    let words = |text: &str| text.split(' ').map(str::to_owned).collect::<Vec<_>>();
    let (a, b) = (words(a), words(b));
    a.len() == b.len()
        && a.iter().zip(&b).all(|(a, b)| {
            if let (Ok(x), Ok(y)) = (a.parse::<f64>(), b.parse::<f64>()) {
                return (x - y).abs() <= SUMS * x.abs().max(y.abs());
            }
            let radii = |word: &str| -> Option<(String, Vec<i64>)> {
                let numbers =
                    word.get(1..)?.split('>').map(|x| if x.is_empty() { Some(-9) } else { x.parse().ok() });
                Some((word[..1].to_owned(), numbers.collect::<Option<_>>()?))
            };
            match (radii(a), radii(b)) {
                (Some((k, x)), Some((l, y))) => {
                    k == l && x.len() == y.len() && x.iter().zip(&y).all(|(x, y)| (x - y).abs() <= RADII)
                }
                _ => a == b,
            }
        })
}

fn file() -> String {
    format!("{}/tests/data/frozen.txt", env!("CARGO_MANIFEST_DIR"))
}

/// The lines of the file, by name.
fn frozen() -> BTreeMap<String, String> {
    let text = std::fs::read_to_string(file()).unwrap_or_default();
    text.lines().filter_map(|line| line.split_once(' ')).map(|(a, b)| (a.to_owned(), b.to_owned())).collect()
}

/// Compares the lines in the file for one in `share` problems.
fn compare(share: u64) {
    let frozen = frozen();
    let numbers = frozen.keys().filter_map(|name| name.strip_prefix('u')?.parse::<u64>().ok());
    let found = lines(numbers.filter(|number| number % share == 0));
    let mut differ = String::new();
    for (name, now) in &found {
        let Some(before) = frozen.get(name) else { continue };
        if !same(before, now) {
            write!(differ, "\n{name}\n  was {before}\n  is  {now}").unwrap();
        }
    }
    assert!(!found.is_empty() && differ.is_empty(), "{differ}");
}

#[test]
fn a_tenth_of_the_paths_are_as_they_were() {
    compare(SHARE);
}

#[test]
#[ignore = "takes several minutes; with FREEZE=0..100 it writes the lines of these problems"]
fn all_paths_are_as_they_were() {
    let Ok(asked) = std::env::var("FREEZE") else { return compare(1) };
    let (from, to) = asked.split_once("..").unwrap();
    let mut all = frozen();
    all.extend(lines(from.parse().unwrap()..to.parse().unwrap()));
    let lines: Vec<String> = all.iter().map(|(name, line)| format!("{name} {line}")).collect();
    std::fs::write(file(), lines.join("\n") + "\n").unwrap();
}

/// What is wrong with a random loop: events that gain energy, areas that differ, states that are out of equilibrium or
/// overlap.
fn faults(number: u64) -> Vec<String> {
    let mut random = fastrand::Rng::with_seed(number ^ 0x7269_6E67);
    let (gap, name) = random_gap(&mut random);
    let gamma = 1e-5 * 30.0_f64.powf(random.f64());
    let control =
        [Control::Displacement, Control::Force, Control::Stiffness(0.03 * 100.0_f64.powf(random.f64()))]
            [random.usize(0..3)];
    let approach = 0.01 + 0.05 * random.f64();
    let name = format!("{number}: {name} γ {gamma:e} {control} to {approach}");
    let table = Arc::new(Table::new(Arc::clone(&gap), 0.3, &Unwatched).unwrap());
    let found = match cycle(&table, gamma, Turn::Approach(approach), &PathSetting::new(control), &Unwatched) {
        Ok(found) => found,
        Err(error) => return vec![format!("{name}: {error}")],
    };
    let mut faults = Vec::new();
    for (k, event) in found.events.iter().enumerate() {
        if event.dissipated.is_some_and(|lost| lost < -1e-18) {
            faults.push(format!("{name}: event {} gains {:?}", k + 1, event.dissipated));
        }
    }
    // An area may differ slightly where a narrow ring appears or disappears; there is a warning then.
    let told = |warning: &Warning| match warning {
        Warning::Digits { .. } => true,
        Warning::Area { share, .. } => *share < AREA,
        Warning::Balance { .. } => false,
    };
    if found.last_contact().is_none() || !found.warnings.iter().all(told) {
        faults.push(format!("{name}: {:?} {:?}", found.stop, found.warnings));
    }
    let farthest = found.states.iter().map(|state| state.contact_radius).fold(0.1, f64::max);
    let ground = Ground::new(table, 2.0 * farthest, &Unwatched).unwrap();
    let (with, without): (Vec<_>, Vec<_>) = found.states.iter().partition(|state| state.rings() > 0);
    let some = |states: Vec<&PathState>| {
        let step = (states.len() / 15).max(1);
        states.into_iter().step_by(step).cloned().collect::<Vec<_>>()
    };
    for state in [some(with), some(without)].concat() {
        let (discs, rings): (Vec<[f64; 2]>, Vec<[f64; 2]>) =
            state.contacts.iter().partition(|contact| contact[0] <= 0.0);
        let contacts = Contacts { disc: discs.first().map_or(0.0, |disc| disc[1]), rings };
        let anew = ground.state(&contacts, Wanted::Values).unwrap();
        let root = gamma.sqrt();
        let kappa = anew.intensities(state.approach);
        let off = kappa.iter().fold(0.0_f64, |most, kappa| most.max((kappa / root - 1.0).abs()));
        let force = (anew.force_at(state.approach) - state.force).abs() / state.force.abs().max(1e-4);
        let around = Around::new(&ground, &anew, state.approach);
        let crests = around.crests(ground.can_touch_up_to(state.approach), &Unwatched).unwrap();
        let gap = crests.iter().map(|crest| crest.gap).fold(f64::INFINITY, f64::min);
        if !(off < 1e-6 && force < 1e-8 && gap > -1e-9 * ground.wave) {
            faults.push(format!("{name}: κ {off:e}, force {force:e}, gap {gap:e}: {state:?}"));
        }
    }
    faults
}

fn loops_stand(numbers: std::ops::Range<u64>) {
    let faults: Vec<String> = numbers.into_par_iter().flat_map_iter(faults).collect();
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn thirty_loops_with_rings_stand_when_computed_anew() {
    loops_stand(0..30);
}

#[test]
#[ignore = "several minutes"]
fn three_hundred_loops_with_rings_stand_when_computed_anew() {
    loops_stand(0..300);
}

/// Stops a computation at some of its questions and checks that it is cancelled; `computed` returns whether it was.
fn stops(name: &str, times: usize, computed: &dyn Fn(&dyn Progress) -> Result<bool, String>) {
    let ended = |last: u64| {
        let asked = AtomicU64::new(0);
        let stop = || asked.fetch_add(1, Ordering::Relaxed) >= last;
        (computed(&stop), asked.load(Ordering::Relaxed))
    };
    // Tables are kept, so the first run may ask more questions.
    for _ in 0..2 {
        assert_eq!(ended(u64::MAX).0, Ok(false), "{name}");
    }
    let (_, questions) = ended(u64::MAX);
    if questions == 0 {
        // Everything is already known, as for the law of stability once there is a table.
        assert!(name.starts_with("stability"), "{name}");
        return;
    }
    let mut random = fastrand::Rng::with_seed(questions);
    for k in 0..times {
        let last = if k == 0 { questions - 1 } else { random.u64(0..questions) };
        let (found, asked) = ended(last);
        // Another test may have had a table made meanwhile: a run with fewer questions is over before it is stopped.
        let is_over = found == Ok(false) && asked <= last;
        assert!(is_over || found == Ok(true), "{name}: {found:?}, stopped at question {last} of {questions}");
    }
}

/// Stops every report of some presets at this many of its questions.
fn every_report_stops(times: usize) {
    let of_case = |found: Result<(), CaseError>| match found {
        Ok(()) => Ok(false),
        Err(CaseError::Stopped(Stopped)) => Ok(true),
        Err(other) => Err(other.to_string()),
    };
    for name in ["fig-9-weak", "formula", "power-law"] {
        let text = shipped::SHIPPED.iter().find(|shipped| shipped.name == name).unwrap().text;
        let preset = preset::read(name, text).unwrap();
        let extent = Extent::default();
        stops(&format!("trace {name}"), times, &|progress| {
            of_case(TraceReport::compute(&preset, progress).map(drop))
        });
        stops(&format!("unload {name}"), times, &|progress| {
            of_case(PathReport::unload(&preset, extent, progress).map(drop))
        });
        stops(&format!("cycle {name}"), times, &|progress| {
            of_case(PathReport::cycle(&preset, None, extent, progress).map(drop))
        });
        stops(&format!("stability {name}"), times, &|progress| {
            of_case(StabilityReport::compute(&preset, 200, progress).map(drop))
        });
        let axis = |key: &str, range| MapAxis::new(key, range, true, 1.0).unwrap();
        let gamma = preset.material.work_of_adhesion;
        let x = axis("material.work_of_adhesion", [0.5 * gamma, 2.0 * gamma]);
        let y = Ordinate::Key(axis("compliance", [0.1, 10.0]));
        stops(&format!("map {name}"), times, &|progress| match MapReport::compute(
            &preset,
            x.clone(),
            &y,
            [6, 4],
            progress,
        ) {
            Ok(_) => Ok(false),
            Err(MapError::Stopped(Stopped) | MapError::Case(CaseError::Stopped(Stopped))) => Ok(true),
            Err(other) => Err(other.to_string()),
        });
    }
}

#[test]
fn every_report_stops_at_any_question() {
    every_report_stops(3);
}

#[test]
#[ignore = "several minutes"]
fn every_report_stops_at_sixty_questions() {
    every_report_stops(60);
}
