//! What the tests of the gaps share.

use crate::gap::Gap;

/// Checks h' and h'' against central differences of one order less, to the accuracy of the difference; `wave` is the
/// length over which the gap bends.
pub fn check_two_derivatives(gap: &dyn Gap, r: f64, wave: f64) {
    check(gap, r, wave, 2);
}

/// Checks h', h'' and h''' against central differences of one order less.
pub fn check_derivatives(gap: &dyn Gap, r: f64, wave: f64) {
    check(gap, r, wave, 3);
}

fn check(gap: &dyn Gap, r: f64, wave: f64, orders: usize) {
    let e = 1e-4 * wave;
    let list = |r: f64| {
        let jet = gap.jet(r);
        [jet.value, jet.first, jet.second, jet.third]
    };
    let at = list(r);
    let points = [-2.0, -1.0, 1.0, 2.0].map(|k| list(r + k * e));
    // The size of the gap over `wave`. Divided by waveᵏ it is the size of the k-th derivative, of which the difference
    // keeps about ten digits.
    let size = (0..4).map(|k| at[k].abs() * wave.powi(i32::try_from(k).unwrap())).fold(0.0, f64::max);
    for k in 1..=orders {
        let [a, b, c, d] = points.map(|p| p[k - 1]);
        // Fourth-order accurate in e.
        let slope = (8.0 * (c - b) - (d - a)) / (12.0 * e);
        let scale = size / wave.powi(i32::try_from(k).unwrap());
        assert!((slope - at[k]).abs() <= 1e-9 * scale, "{gap:?} r={r} order {k}: {slope} {}", at[k]);
    }
}
