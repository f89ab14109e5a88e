//! The cost and the findings of the step control, rule by rule, on the sixty random wavy spheres of the tests.
//!
//! `cargo bench --bench step_rules` prints a table: points and evaluations per trace, limit points found out of those
//! of the explicit curve, traces that found all of them, and traces that reached their end. The defaults of
//! `continuation::settings` were chosen from it.

use pulloff_engine::continuation::{Settings, Tracer};
use pulloff_engine::disc::Basis;
use pulloff_engine::gap::Shape;
use pulloff_engine::problem::{Control, Problem, Reduced};
use pulloff_engine::progress::Unwatched;
use pulloff_engine::quasistatic::curve::settings;
use pulloff_engine::quasistatic::{Curve, CurveStop};
use pulloff_engine::ritz::Rings;
use std::sync::Arc;

const FROM: f64 = 1.0;
const TO: f64 = 0.03;
const CONTROLS: [Control; 2] = [Control::Displacement, Control::Force];

fn problems() -> Vec<Reduced> {
    let mut random = fastrand::Rng::with_seed(20_260_611);
    let mut between = |lo: f64, hi: f64| lo + (hi - lo) * random.f64();
    let mut draw = || {
        let work_of_adhesion = 10f64.powf(between(-3.5, -2.5));
        let amplitude = between(0.002, 0.006);
        let wavelength = between(0.1, 0.25);
        let shape = Shape::WavySphere { radius_of_curvature: 1.0, amplitude, wavelength };
        Problem { effective_modulus: 1.0, work_of_adhesion, shape }.reduced()
    };
    (0..60).map(|_| draw()).collect()
}

/// A rule: its name, the desired turning in degrees, the share of a wave by which the edge may move per step, whether
/// grazing pairs are looked for, and the longest step.
struct Rule(&'static str, f64, f64, bool, f64);

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let basis: Arc<dyn Basis> = Rings::shared(200)?;
    let problems = problems();
    let truth: Vec<Vec<usize>> = problems
        .iter()
        .filter_map(|problem| Curve::of(problem.clone(), basis.clone(), FROM, TO))
        .map(|curve| CONTROLS.map(|control| curve.limit_points(control).len()).to_vec())
        .collect();
    let all: usize = truth.iter().flatten().sum();
    println!("{all} limit points on the explicit curves of {} problems", problems.len());
    println!(
        "{:<42} {:>7} {:>7} {:>7} {:>10} {:>9} {:>8}",
        "rule", "median", "evals", "reject", "found", "complete", "at end"
    );
    let rules = [
        Rule("turning 10, cap 1/12, grazing", 10.0, 1.0 / 12.0, true, 0.1),
        Rule("turning 15, cap 1/12, grazing (default)", 15.0, 1.0 / 12.0, true, 0.1),
        Rule("turning 20, cap 1/12, grazing", 20.0, 1.0 / 12.0, true, 0.1),
        Rule("turning 30, cap 1/12, grazing", 30.0, 1.0 / 12.0, true, 0.1),
        Rule("turning 15, cap 1/12, sign changes only", 15.0, 1.0 / 12.0, false, 0.1),
        Rule("turning 15, cap 1/6, grazing", 15.0, 1.0 / 6.0, true, 0.1),
        Rule("turning 15, no cap, grazing", 15.0, f64::INFINITY, true, 0.1),
        Rule("turning 15, no cap, sign changes only", 15.0, f64::INFINITY, false, 0.1),
        Rule("turning 15, cap 1/12, grazing, step 0.05", 15.0, 1.0 / 12.0, true, 0.05),
        Rule("turning 15, cap 1/12, grazing, step 0.2", 15.0, 1.0 / 12.0, true, 0.2),
    ];
    for Rule(name, turning, cap, grazing, longest) in rules {
        let (mut points, mut found, mut complete, mut at_end) = (Vec::new(), 0, 0, 0);
        let (mut evaluations, mut rejections) = (0, 0);
        for (problem, truth) in problems.iter().zip(&truth) {
            let adjust = |settings: &mut Settings| {
                settings.turning = turning.to_radians();
                // The default cap is a twelfth of a wave in the scaled unknown.
                settings.largest_increment[2] *= 12.0 * cap;
                settings.grazing = if grazing { settings.grazing } else { -1.0 };
                settings.longest = longest;
                settings.points = 5000;
            };
            let Some(curve) = Curve::of(problem.clone(), basis.clone(), FROM, TO) else { continue };
            let Some((branch, stop)) = curve.traced(adjust, &Unwatched) else { continue };
            at_end += usize::from(stop == CurveStop::End);
            let counts = CONTROLS.map(|control| {
                let mut settings = settings(&curve.equilibrium);
                settings.grazing = if grazing { settings.grazing } else { -1.0 };
                let row = curve.equilibrium.control_row(control);
                let brackets = Tracer::new(&curve.equilibrium, settings).brackets(&branch.points, &row);
                brackets.map_or(0, |found| found.len())
            });
            found += counts.iter().sum::<usize>();
            complete += usize::from(counts.to_vec() == *truth);
            points.push(branch.points.len());
            evaluations += branch.work.evaluations;
            rejections += branch.work.rejections;
        }
        points.sort_unstable();
        let median = points.get(points.len() / 2).copied().unwrap_or(0);
        let share = |n: usize| n / problems.len();
        println!(
            "{name:<42} {median:>7} {:>7} {:>7} {:>10} {complete:>9} {at_end:>8}",
            share(evaluations),
            share(rejections),
            format!("{found}/{all}"),
        );
    }
    Ok(())
}
