//! A root by halving, to rounding.

/// Where `f` changes its sign between `a` and `b`, which may stand in either order, by halving until no number lies
/// between.
///
/// About sixty evaluations, and nothing that could miss. Where `f` has one sign at both ends the answer is an end.
pub fn halved(mut a: f64, mut b: f64, f: impl Fn(f64) -> f64) -> f64 {
    let side = f(a) > 0.0;
    loop {
        let middle = 0.5 * (a + b);
        if !(a.min(b) < middle && middle < a.max(b)) {
            return b;
        }
        if (f(middle) > 0.0) == side {
            a = middle;
        } else {
            b = middle;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::halved;

    #[test]
    fn a_root_to_rounding_in_either_order() {
        for (a, b) in [(0.0, 2.0), (2.0, 0.0)] {
            assert!((halved(a, b, |x| x * x - 2.0) - 2f64.sqrt()).abs() <= f64::EPSILON * 2.0);
        }
        assert_eq!(halved(0.0, 1.0, |_| 1.0).to_bits(), 1f64.to_bits());
        assert_eq!(halved(0.0, f64::NAN, |x| x).to_bits(), f64::NAN.to_bits());
    }
}
