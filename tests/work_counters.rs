//! What the standard traces cost, in counts that do not depend on the machine.
//!
//! A change of the step size, the corrector or the search for limit points shows here before anyone feels it.
//! After a wanted change put the printed row in the table.

#![allow(clippy::unwrap_used, reason = "a helper of a test fails the test by panicking")]

use pulloff::case::Case;
use pulloff::contact::Control;
use pulloff::preset::{BasisSpec, Store};
use pulloff::ritz::Grading;

/// Points, rejected steps, evaluations of the equations; limit points under displacement and under force.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Counts {
    points: usize,
    rejections: usize,
    evaluations: usize,
    by_displacement: usize,
    by_force: usize,
}

fn counts(name: &str) -> Counts {
    // A folder that need not exist: the preset is a shipped one.
    let store = Store::at("presets", &[]);
    let mut preset = store.load(&store.resolve(name).unwrap(), &[] as &[&str]).unwrap().preset;
    preset.basis = BasisSpec::Rings { rings: 200, grading: Grading::Uniform };
    let curve = Case::new(&preset).unwrap().trace().unwrap();
    Counts {
        points: curve.branch.points.len(),
        rejections: curve.branch.work.rejections,
        evaluations: curve.branch.work.evaluations,
        by_displacement: curve.limit_points(Control::Displacement).len(),
        by_force: curve.limit_points(Control::Force).len(),
    }
}

const TABLE: [(&str, [usize; 5]); 4] = [
    ("fig-3-jkr", [28, 0, 120, 1, 1]),
    ("fig-8", [86, 5, 376, 5, 3]),
    ("fig-9", [453, 89, 2286, 19, 19]),
    ("wavy-sphere", [389, 73, 1943, 15, 15]),
];

#[test]
fn standard_traces_cost_what_they_did() {
    for (name, row) in TABLE {
        let [points, rejections, evaluations, by_displacement, by_force] = row;
        let wanted = Counts { points, rejections, evaluations, by_displacement, by_force };
        let ours = counts(name);
        println!("{name}: {ours:?}");
        // Rounding differs between machines and may tip a step: ± 2, and 2 % of the evaluations.
        assert!(ours.points.abs_diff(wanted.points) <= 2, "{name}: {ours:?}, was {wanted:?}");
        assert!(ours.rejections.abs_diff(wanted.rejections) <= 2, "{name}: {ours:?}, was {wanted:?}");
        let evaluations = ours.evaluations.abs_diff(wanted.evaluations);
        assert!(50 * evaluations <= wanted.evaluations, "{name}: {ours:?}, was {wanted:?}");
        // Limit points are facts of the curve.
        assert_eq!(
            (ours.by_displacement, ours.by_force),
            (wanted.by_displacement, wanted.by_force),
            "{name}"
        );
    }
}
