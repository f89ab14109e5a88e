//! NIST's nonlinear sets: data, starts and certified values from the Statistical Reference Datasets,
//! <https://itl.nist.gov/div898/strd/nls/nls_main.shtml>.

use super::*;
use crate::progress::{Unwatched, until};

/// A model y(x; b) with its data; derivatives by central differences.
struct Set {
    x: Vec<f64>,
    y: Vec<f64>,
    model: fn(f64, &[f64]) -> f64,
}

impl LeastSquares for Set {
    type Look = ();

    fn look(&self, u: &[f64]) -> Option<(DVector<f64>, ())> {
        let r = self.x.iter().zip(&self.y).map(|(x, y)| y - (self.model)(*x, u));
        Some((DVector::from_iterator(self.x.len(), r), ()))
    }

    fn derivatives(&self, u: &[f64], (): &()) -> Option<DMatrix<f64>> {
        let jacobian = DMatrix::from_fn(self.x.len(), u.len(), |i, j| {
            let h = 1e-6 * u[j].abs();
            let at = |h: f64| {
                let mut u = u.to_vec();
                u[j] += h;
                (self.model)(self.x[i], &u)
            };
            -(at(h) - at(-h)) / (2.0 * h)
        });
        Some(jacobian)
    }
}

fn check(set: &Set, starts: [&[f64]; 2], certified: &[f64], sum: f64) {
    for start in starts {
        let settings = MinimizationSettings {
            rounds: 1000,
            tolerance: 1e-11,
            resolution: 1e-12,
            ..MinimizationSettings::default()
        };
        let found = minimize(set, start, &settings, &Unwatched).unwrap();
        assert_eq!(found.ending, Ending::Converged);
        for (ours, theirs) in found.parameters.iter().zip(certified) {
            assert!((ours / theirs - 1.0).abs() < 1e-6, "{:?} {certified:?}", found.parameters);
        }
        assert!((2.0 * found.cost / sum - 1.0).abs() < 1e-8, "{} {sum}", found.cost);
    }
}

#[test]
fn misra1a_of_lower_difficulty() {
    let set = Set {
        x: vec![
            77.6, 114.9, 141.1, 190.8, 239.9, 289.0, 332.8, 378.4, 434.8, 477.3, 536.8, 593.1, 689.1, 760.0,
        ],
        y: vec![
            10.07, 14.73, 17.94, 23.93, 29.61, 35.18, 40.02, 44.82, 50.76, 55.05, 61.01, 66.40, 75.47, 81.78,
        ],
        model: |x, b| b[0] * (1.0 - (-b[1] * x).exp()),
    };
    let certified = [2.389_421_291_8e2, 5.501_564_318_1e-4];
    check(&set, [&[500.0, 0.0001], &[250.0, 0.0005]], &certified, 1.245_513_889_4e-1);
}

#[test]
fn thurber_of_higher_difficulty() {
    let set = Set {
        x: vec![
            -3.067, -2.981, -2.921, -2.912, -2.840, -2.797, -2.702, -2.699, -2.633, -2.481, -2.363, -2.322,
            -1.501, -1.460, -1.274, -1.212, -1.100, -1.046, -0.915, -0.714, -0.566, -0.545, -0.400, -0.309,
            -0.109, -0.103, 0.010, 0.119, 0.377, 0.790, 0.963, 1.006, 1.115, 1.572, 1.841, 2.047, 2.200,
        ],
        y: vec![
            80.574, 84.248, 87.264, 87.195, 89.076, 89.608, 89.868, 90.101, 92.405, 95.854, 100.696, 101.060,
            401.672, 390.724, 567.534, 635.316, 733.054, 759.087, 894.206, 990.785, 1090.109, 1080.914,
            1122.643, 1178.351, 1260.531, 1273.514, 1288.339, 1327.543, 1353.863, 1414.509, 1425.208,
            1421.384, 1442.962, 1464.350, 1468.705, 1447.894, 1457.628,
        ],
        model: |x, b| {
            let above = b[0] + x * (b[1] + x * (b[2] + x * b[3]));
            above / (1.0 + x * (b[4] + x * (b[5] + x * b[6])))
        },
    };
    let certified = [
        1.288_139_680_0e3,
        1.491_079_253_5e3,
        5.832_383_687_7e2,
        7.541_664_429_1e1,
        9.662_950_286_4e-1,
        3.979_728_579_7e-1,
        4.972_729_734_9e-2,
    ];
    let starts: [&[f64]; 2] =
        [&[1000.0, 1000.0, 400.0, 40.0, 0.7, 0.3, 0.03], &[1300.0, 1500.0, 500.0, 75.0, 1.0, 0.4, 0.05]];
    check(&set, starts, &certified, 5.642_708_239_7e3);
}

#[test]
fn huber_passes_over_an_outlier_and_counts_are_repetitions() {
    let line = |y: Vec<f64>| Set { x: (0..20).map(f64::from).collect(), y, model: |x, b| b[0] + b[1] * x };
    let mut y: Vec<f64> = (0..20).map(|i| 2.0 + 0.5 * f64::from(i) + 0.01 * f64::from(i % 3 - 1)).collect();
    y[7] = 40.0;
    let of = |huber| {
        let settings = MinimizationSettings { huber, ..MinimizationSettings::default() };
        minimize(&line(y.clone()), &[1.0, 1.0], &settings, &Unwatched).unwrap().parameters
    };
    let (plain, robust) = (of(f64::INFINITY), of(0.015));
    assert!((plain[0] - 2.0).abs() > 1.0 && (robust[0] - 2.0).abs() < 0.01, "{plain:?} {robust:?}");
}

#[test]
fn it_can_be_stopped_and_keeps_what_it_has() {
    let set = Set {
        x: (0..20).map(f64::from).collect(),
        y: (0..20).map(|i| (0.1 * f64::from(i)).exp()).collect(),
        model: |x, b| b[0] * (b[1] * x).exp(),
    };
    let start = set.residuals(&[5.0, 0.3]).unwrap().norm_squared();
    let found = minimize(&set, &[5.0, 0.3], &MinimizationSettings::default(), &until(3)).unwrap();
    assert!(found.ending == Ending::Cancelled && found.rounds == 3 && 2.0 * found.cost < start);
}

#[test]
fn rounds_that_gained_next_to_nothing_have_found_the_minimum() {
    let falling = |by: f64| -> Vec<f64> { (0..60).map(|round| 10.0 - by * f64::from(round)).collect() };
    for (by, ending) in [(1e-5, Ending::Converged), (1e-2, Ending::Rounds)] {
        assert_eq!(after_all(&falling(by), 10.0 - 60.0 * by, 5e-3), ending);
    }
    // A few rounds tell nothing, and nor does a gain that is not asked for.
    assert_eq!(after_all(&[1.0; 49], 1.0, 5e-3), Ending::Rounds);
    assert_eq!(after_all(&[1.0; 60], 1.0, 0.0), Ending::Rounds);
}
