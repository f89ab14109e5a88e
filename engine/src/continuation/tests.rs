//! Systems of other sizes than the contact's, with second derivatives and without.

use super::fixtures::{Bratu, Circle, Cubic, Lifted, point};
use super::{
    End, Linearization, NewtonFailure, Point, Settings, SizeError, StepFailure, Stop, System, Tracer, Vector,
};

/// The only limit point of λ on the curve of Bratu's problem, and the evaluations that tracing and locating took.
fn fold(nodes: usize, with_second: bool) -> (f64, usize) {
    let system = Bratu { nodes, with_second };
    let mut tracer = Tracer::new(&system, Settings::new(nodes + 1));
    // Up to a load below that of the fold, and from there past it, back to a smaller one.
    let (branch, stop) = tracer.trace(system.start(), End { unknown: nodes, value: 1.0 }, |_| true);
    assert_eq!(stop, Stop::End);
    let start = branch.points.last().unwrap().clone();
    let (branch, stop) = tracer.trace(start, End { unknown: nodes, value: 0.9 }, |_| true);
    assert_eq!(stop, Stop::End);
    assert!(branch.points.iter().all(|p| p.positive == branch.points[0].positive));
    let row = system.load();
    let brackets = tracer.brackets(&branch.points, &row).unwrap();
    assert_eq!(brackets.len(), 1);
    let found = tracer.limit_point(&brackets[0], &row).unwrap();
    assert!(found.bend < 0.0 && found.correction < 1e-8 && found.point.slope(&row).abs() < 1e-9);
    (found.point.y()[nodes], tracer.work.evaluations)
}

#[test]
fn the_fold_of_a_hundred_unknowns_is_the_known_one_to_second_order() {
    const KNOWN: f64 = 3.513_830_719;
    let (coarse, _) = fold(49, true);
    let (fine, evaluations) = fold(99, true);
    let order = ((coarse - KNOWN) / (fine - KNOWN)).log2();
    assert!((order - 2.0).abs() < 0.01, "{coarse} {fine} {order}");
    assert!((fine + (fine - coarse) / 3.0 - KNOWN).abs() < 5e-8, "{coarse} {fine}");
    assert!(evaluations < 400, "{evaluations}");
    // Differences give the same, for two more evaluations per point and per round.
    let (by_differences, more) = fold(99, false);
    assert!((by_differences - fine).abs() < 1e-12, "{by_differences} {fine}");
    assert!(more > evaluations && more < 2 * evaluations, "{more} {evaluations}");
}

#[test]
fn the_folds_of_three_equations_with_second_derivatives_and_without() {
    let row = Vector::from_vec(vec![0.0, 0.0, 0.0, 1.0]);
    for with_second in [true, false] {
        let system = Lifted { with_second };
        let mut tracer = Tracer::new(&system, Settings::new(4));
        let (branch, stop) = tracer.trace(system.point(-2.0), End { unknown: 0, value: 2.0 }, |_| true);
        assert_eq!(stop, Stop::End);
        let brackets = tracer.brackets(&branch.points, &row).unwrap();
        let folds: Vec<Point> =
            brackets.iter().map(|bracket| tracer.limit_point(bracket, &row).unwrap().point).collect();
        assert_eq!(folds.len(), 2);
        for (fold, u) in folds.iter().zip([-1.0, 1.0]) {
            let exact = Vector::from_vec(vec![u, 1.0, u, Cubic::p(u)]);
            assert!((fold.y() - exact).norm() < 1e-13, "{fold:?}");
        }
        let ends = [&branch.points[0], &branch.points[1]];
        let half = 0.5 * (ends[0].y() + ends[1].y())[3];
        let between = tracer.control_value(ends, &row, half).unwrap();
        assert!((between.y()[3] - half).abs() < 1e-14 && (Cubic::p(between.y()[0]) - half).abs() < 1e-13);
    }
}

#[test]
fn differences_are_as_good_as_second_derivatives_need_be_and_stay_inside() {
    /// The circle where its first unknown is not positive.
    struct Half;
    impl System for Half {
        fn unknowns(&self) -> usize {
            2
        }
        fn linearize(&self, y: &Vector, at: &mut Linearization) -> Option<()> {
            if y[0] > 0.0 { None } else { Circle.linearize(y, at) }
        }
    }
    for angle in [1.6, 2.0, 3.0, std::f64::consts::PI] {
        let here = Circle.point(angle);
        // The curvature of the unit circle points to its centre.
        assert!((here.curvature() + here.y()).norm() < 1e-9, "{here:?}");
    }
    let edge = point(&Half, vec![0.0, 1.0], &[-1.0, 0.0]);
    assert!((edge.curvature() + edge.y()).norm() < 1e-4, "{edge:?}");
}

/// A system whose Jacobian has one column fewer than the system has unknowns.
struct Narrow;

impl System for Narrow {
    fn unknowns(&self) -> usize {
        3
    }
    fn linearize(&self, _: &Vector, at: &mut Linearization) -> Option<()> {
        *at = Linearization::new(3);
        at.jacobian = super::Matrix::zeros(2, 2);
        Some(())
    }
}

/// A system without a curve.
struct Lonely;

impl System for Lonely {
    fn unknowns(&self) -> usize {
        1
    }
    fn linearize(&self, _: &Vector, _: &mut Linearization) -> Option<()> {
        None
    }
}

#[test]
fn sizes_that_do_not_agree_are_told() {
    let end = End { unknown: 0, value: 2.5 };
    let start = Cubic.point(-3.0);
    let failed = |error| Stop::Failed(StepFailure::Sizes(error));
    let mismatch = |part, found, expected| SizeError::Mismatch { part, found, expected };

    let three = Lifted { with_second: true };
    let (branch, stop) = Tracer::new(&three, Settings::new(4)).trace(start.clone(), end, |_| true);
    assert_eq!((branch.points.len(), stop), (1, failed(mismatch("a point", 2, 4))));
    let (_, stop) = Tracer::new(&Cubic, Settings::new(3)).trace(start.clone(), end, |_| true);
    assert_eq!(stop, failed(mismatch("the largest increments", 3, 2)));
    let far = End { unknown: 2, value: 0.0 };
    let (_, stop) = Tracer::new(&Cubic, Settings::new(2)).trace(start.clone(), far, |_| true);
    assert_eq!(stop, failed(SizeError::NoUnknown { unknown: 2, unknowns: 2 }));

    let narrow = point_of_three();
    let (_, stop) = Tracer::new(&Narrow, Settings::new(3)).trace(narrow, end, |_| true);
    assert_eq!(stop, failed(mismatch("a row of the Jacobian", 2, 3)));
    let (_, stop) = Tracer::new(&Lonely, Settings::new(1)).trace(start.clone(), end, |_| true);
    assert_eq!(stop, failed(SizeError::TooFew(1)));

    let points = [start, Cubic.point(0.0)];
    let mut tracer = Tracer::new(&Cubic, Settings::new(2));
    let row = Vector::zeros(3);
    let wrong = mismatch("the row of the control", 3, 2);
    assert_eq!(tracer.brackets(&points, &row).unwrap_err(), wrong);
    let located = tracer.control_value([&points[0], &points[1]], &row, 0.0);
    assert_eq!(located.unwrap_err(), NewtonFailure::Sizes(wrong));
}

/// A point of three unknowns, whatever its system.
fn point_of_three() -> Point {
    Point::of(super::Columns::from_element(3, 0.5), true)
}
