//! The cost of the standard traces, in counts that do not depend on the machine.
//!
//! A change to the step size, the corrector or the search for limit points shows here before anyone notices it. After a
//! deliberate change, put the printed row into the table.

#![allow(clippy::unwrap_used, reason = "a helper of a test fails the test by panicking")]

use pulloff::store::Store;
use pulloff_engine::case::Case;
use pulloff_engine::preset::BasisSpec;
use pulloff_engine::problem::Control;
use pulloff_engine::progress::Unwatched;
use pulloff_engine::ritz::Grading;

/// Points, rejected steps, evaluations of the equations, Newton rounds of the points that were kept; limit points under
/// displacement and under force.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Counts {
    points: usize,
    rejections: usize,
    evaluations: usize,
    rounds: usize,
    by_displacement: usize,
    by_force: usize,
}

fn counts(name: &str, basis: BasisSpec) -> Counts {
    // The folder need not exist: the preset is a shipped one.
    let store = Store::at("presets", &[]);
    let mut preset = store.load(&store.resolve(name).unwrap(), &[] as &[&str]).unwrap().preset;
    preset.basis = basis;
    let case = Case::new(&preset).unwrap();
    let curve = case.curve(&Unwatched).unwrap();
    let (branch, _) = case.trace(&curve, &Unwatched).unwrap();
    Counts {
        points: branch.points.len(),
        rejections: branch.work.rejections,
        evaluations: branch.work.evaluations,
        rounds: branch.points.iter().map(|point| point.rounds).sum(),
        by_displacement: curve.limit_points(Control::Displacement).len(),
        by_force: curve.limit_points(Control::Force).len(),
    }
}

const RINGS: BasisSpec = BasisSpec::Rings { rings: 200, grading: Grading::Uniform };
const EXACT: BasisSpec = BasisSpec::Exact;

const TABLE: [(&str, BasisSpec, [usize; 6]); 8] = [
    ("fig-3-jkr", RINGS, [28, 0, 120, 88, 1, 1]),
    ("fig-8", RINGS, [86, 5, 376, 269, 5, 3]),
    ("fig-9", RINGS, [451, 91, 2291, 1410, 19, 19]),
    ("wavy-sphere", RINGS, [347, 65, 1754, 1090, 15, 15]),
    ("fig-3-jkr", EXACT, [28, 0, 120, 88, 1, 1]),
    ("fig-8", EXACT, [86, 5, 376, 269, 5, 3]),
    ("fig-9", EXACT, [453, 93, 2313, 1414, 19, 19]),
    ("wavy-sphere", EXACT, [346, 69, 1781, 1087, 15, 15]),
];

#[test]
fn standard_traces_cost_what_they_did() {
    let all = TABLE.map(|(name, basis, row)| (name, basis, row, counts(name, basis)));
    for (name, basis, _, ours) in &all {
        println!("{name} {basis:?}: {ours:?}");
    }
    for (name, basis, row, ours) in all {
        let [points, rejections, evaluations, rounds, by_displacement, by_force] = row;
        let wanted = Counts { points, rejections, evaluations, rounds, by_displacement, by_force };
        // Rounding differs between machines and may change a step, and with it the following ones: 4 %, and 4.
        for (ours, was) in [
            (ours.points, wanted.points),
            (ours.rejections, wanted.rejections),
            (ours.evaluations, wanted.evaluations),
            (ours.rounds, wanted.rounds),
        ] {
            assert!(ours.abs_diff(was) <= 4 + was / 25, "{name} {basis:?}: {ours}, was {was}");
        }
        // Limit points are properties of the curve.
        assert_eq!(
            (ours.by_displacement, ours.by_force),
            (wanted.by_displacement, wanted.by_force),
            "{name}"
        );
    }
}
