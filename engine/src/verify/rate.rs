//! An edge with a speed against its asymptotic laws, at rates slow enough for them to hold.
//!
//! ```text
//! peak under displacement   −P = P_c [1 + (3RV/(4 s_c v₀))ⁿ]                 sphere, s_c its radius at P_c
//! dissipation               D − Σ losses ~ V^{2n/(2 + n)}
//! creep, δ held             G/γ − 1 ~ t^{−n/(1 − n)}
//! creep, P = −P_c − ε held  t = B(½, 1/n − ½) √(2/P'') (T_c/2)^{1/n} ε^{½ − 1/n}/v₀,  T_c = 2s_c √(2πγs_c)
//! ```
//!
//! All follow from the law of the edge by expansion about an equilibrium of the sphere in closed form: a state that the
//! slow edge passes, a limit point, the state that it creeps to, or a state near the smallest force.

use super::cases::{PaperFigure, fig_9, smooth, sphere};
use super::row::{Group, VerifyRow};
use crate::disc::ExactBasis;
use crate::disc::Table;
use crate::elementary::{ln, pow};
use crate::problem::{Control, Part, Problem};
use crate::progress::Unwatched;
use crate::quasistatic::path::{PathSetting, unload};
use crate::quasistatic::{Curve, path::Losses};
use crate::rate::failure::time_to_failure;
use crate::rate::{EdgeLaw, MovingEdge, Pull, PullSettings, Puller};
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

/// γ/(E*R) of the sphere.
const WORK: f64 = 0.01;

/// The smooth sphere, and Fig. 9.
struct Gaps {
    sphere: Arc<Table>,
    waves: Arc<Table>,
}

fn table(problem: &Problem, reach: f64) -> Option<Arc<Table>> {
    Table::new(problem.clone().reduced().gap, reach, &Unwatched).ok().map(Arc::new)
}

fn edge(exponent: f64, gamma: f64) -> MovingEdge {
    MovingEdge { law: EdgeLaw::symmetric(exponent), opening: gamma, closing: gamma }
}

/// A pull at fixed grips.
fn pulled(table: &Table, edge: MovingEdge, start: f64, parts: &[Part]) -> Option<Pull> {
    let puller = Puller {
        table,
        control: Control::Displacement,
        edge,
        start,
        wave: table.gap().feature_length(),
        rise: None,
        settings: PullSettings::default(),
    };
    puller.pull(parts, &Unwatched).ok()
}

/// The rows against laws, and the row that compares two numbers of ours.
pub fn groups() -> [Group; 2] {
    let fig_9 = fig_9();
    let gaps = table(&sphere(WORK), 1.0)
        .zip(table(&fig_9.problem, fig_9.start))
        .map(|(sphere, waves)| Gaps { sphere, waves });
    let mut rows = Vec::new();
    let mut own = Vec::new();
    if let Some(gaps) = &gaps {
        rows.extend(peaks(gaps));
        rows.extend(creep(gaps));
        rows.extend(dissipation(gaps, &fig_9, &mut own));
    } else {
        rows.push(VerifyRow::relative("the tables", f64::NAN, 1.0, 0.0));
    }
    [
        Group {
            title: "Pulls at a rate against the laws of slow pulls".to_owned(),
            measure: "relative",
            rows,
        },
        Group { title: "Self-consistency: Fig. 9, a slow pull".to_owned(), measure: "relative", rows: own },
    ]
}

/// The sphere's largest pull at a low rate.
fn peaks(gaps: &Gaps) -> Vec<VerifyRow> {
    let critical = 1.5 * PI * WORK;
    let radius = smooth(WORK).pull_off_radius();
    [(1.0, 1e-5), (0.5, 1e-7), (0.25, 1e-9)]
        .into_iter()
        .map(|(exponent, rate)| {
            let pull = pulled(&gaps.sphere, edge(exponent, WORK), 0.5, &[Part::Apart { rate }]);
            let ours = pull.map_or(f64::NAN, |pull| -pull.peak.force / critical - 1.0);
            let law = pow(0.75 * rate / radius, exponent);
            VerifyRow::relative(format!("n = {exponent}: rise of the largest pull"), ours, law, 0.02)
        })
        .collect()
}

/// How a sphere creeps when it is held: at an approach, and under a load that is slightly too large.
fn creep(gaps: &Gaps) -> Vec<VerifyRow> {
    let mut rows = Vec::new();
    for exponent in [0.25, 0.5] {
        let left = |time: f64| {
            let parts = [Part::Ramp { to: -0.02, rate: 0.1 }, Part::Hold { time }];
            pulled(&gaps.sphere, edge(exponent, WORK), 0.5, &parts)
                .and_then(|pull| pull.holds.first().copied())
        };
        let slope = left(1e5).zip(left(1e6)).map_or(f64::NAN, |(a, b)| ln(b / a) / ln(10.0));
        let law = -exponent / (1.0 - exponent);
        rows.push(VerifyRow::relative(format!("n = {exponent}: creep at a held approach"), slope, law, 0.02));
    }
    let critical = 1.5 * PI * WORK;
    let s = smooth(WORK).pull_off_radius();
    let panels = gaps.sphere.up_to(0.5).ok();
    // P'' of the sphere at P_c, and B(½, 1/n − ½).
    let (bend, unit) = (8.0 * s - 0.75 * (8.0 * PI * WORK / s).sqrt(), 2.0 * s * (TAU * WORK * s).sqrt());
    for (exponent, beta) in [(0.5, 0.5 * PI), (0.25, 5.0 * PI / 16.0)] {
        let over = 1e-4 * critical;
        let of =
            |panels| time_to_failure(panels, &edge(exponent, WORK), 0.5, -critical - over).ok().flatten();
        let ours = panels.as_ref().and_then(of).unwrap_or(f64::NAN);
        let law =
            beta * (2.0 / bend).sqrt() * pow(0.5 * unit, 1.0 / exponent) * pow(over, 0.5 - 1.0 / exponent);
        rows.push(VerifyRow::relative(format!("n = {exponent}: time under a dead load"), ours, law, 1e-3));
    }
    rows
}

/// How the dissipation in a pull of Fig. 9 approaches the losses of its unloading.
fn dissipation(gaps: &Gaps, figure: &PaperFigure, own: &mut Vec<VerifyRow>) -> Vec<VerifyRow> {
    let gamma = figure.problem.work_of_adhesion;
    let lost = losses(gaps, figure);
    let dissipated = |exponent: f64, rate: f64| {
        let pull = pulled(&gaps.waves, edge(exponent, gamma), figure.start, &[Part::Apart { rate }]);
        pull.and_then(|pull| pull.dissipated).unwrap_or(f64::NAN)
    };
    own.push(VerifyRow::own("dissipated at V = 1e-10 v0", dissipated(1.0, 1e-10), lost, lost, 1e-5));
    [0.25, 0.5, 1.0]
        .into_iter()
        .map(|exponent| {
            let [slow, slower] = [1e-7, 1e-8].map(|rate| dissipated(exponent, rate) - lost);
            let slope = ln(slow / slower) / ln(10.0);
            let law = 2.0 * exponent / (2.0 + exponent);
            VerifyRow::relative(format!("n = {exponent}: dissipated beyond jumps"), slope, law, 0.03)
        })
        .collect()
}

fn losses(gaps: &Gaps, figure: &PaperFigure) -> f64 {
    let basis = Arc::new(ExactBasis::new(Arc::clone(&gaps.waves), figure.start));
    let curve = Curve::of(figure.problem.clone().reduced(), basis, figure.start, 1e-3);
    let setting = PathSetting { losses: Losses::Once, ..PathSetting::one_disc(Control::Displacement) };
    let path = curve.and_then(|curve| unload(&curve, &setting, &Unwatched).ok());
    path.and_then(|path| path.totals.dissipated).unwrap_or(f64::NAN)
}
