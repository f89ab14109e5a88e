//! Roots of a function of one number: by halving if only the side of the root is known, by interpolation if the value
//! is.

/// The last number found from `from` towards `to` (in either order) at which `stays` holds, and the first at which it
/// does not: the interval is halved until no number lies between.
///
/// About sixty calls, and nothing can be missed. `stays` is assumed to hold at `from` and not at `to`; neither is
/// tested.
pub fn halved(mut from: f64, mut to: f64, mut stays: impl FnMut(f64) -> bool) -> [f64; 2] {
    loop {
        let middle = 0.5 * (from + to);
        if !(from.min(to) < middle && middle < from.max(to)) {
            return [from, to];
        }
        if stays(middle) { from = middle } else { to = middle }
    }
}

/// Where `f` changes its sign between `a` and `b`, which may be in either order, by halving. If `f` has the same sign
/// at both ends, the answer is one of the ends.
pub fn sign_change(a: f64, b: f64, f: impl Fn(f64) -> f64) -> f64 {
    let side = f(a) > 0.0;
    halved(a, b, |x| (f(x) > 0.0) == side)[1]
}

/// Where a function with a single minimum between `lo` and `hi` is smallest, by golden-section search: to half the
/// digits of its values.
pub fn least(mut lo: f64, mut hi: f64, f: impl Fn(f64) -> f64) -> f64 {
    const SECTION: f64 = 0.618_033_988_749_894_9;
    const ROUNDS: usize = 48;
    for _ in 0..ROUNDS {
        let [a, b] = [hi - SECTION * (hi - lo), lo + SECTION * (hi - lo)];
        if f(a) < f(b) { hi = b } else { lo = a }
    }
    0.5 * (lo + hi)
}

/// An interval with a change of sign of a function between its ends.
///
/// It is narrowed by Chandrupatla's rule: inverse quadratic interpolation where three values allow it, halving
/// elsewhere. T. R. Chandrupatla, Adv. Eng. Softw. 28, 145 (1997), doi:10.1016/S0965-9978(96)00051-8. The first place
/// tried is that of the chord.
#[derive(Debug, Clone)]
pub struct RootBracket {
    /// The place tried last with its value, the end of the other sign, and the end given up.
    last: [f64; 2],
    other: [f64; 2],
    left: Option<[f64; 2]>,
}

impl RootBracket {
    /// Most evaluations.
    const MOST: usize = 200;

    /// The bracket between two places with their values; `None` if these have the same sign.
    pub fn new(a: [f64; 2], b: [f64; 2]) -> Option<Self> {
        ((a[1] > 0.0) != (b[1] > 0.0)).then_some(Self { last: a, other: b, left: None })
    }

    /// The end at which the function is positive, or the one at which it is not.
    pub fn end(&self, positive: bool) -> f64 {
        if (self.last[1] > 0.0) == positive { self.last[0] } else { self.other[0] }
    }

    /// Evaluates until the next place lies within `near` of the last one. `None` if `f` has no value.
    pub fn find(&mut self, near: f64, mut f: impl FnMut(f64) -> Option<f64>) -> Option<()> {
        for _ in 0..Self::MOST {
            let x = self.next(0.5 * near);
            if self.is_narrow(near) || self.take(x, f(x)?) || (self.next(0.0) - x).abs() <= near {
                break;
            }
        }
        Some(())
    }

    /// Evaluates until both ends lie within `near` of each other, or one is a root. `None` if `f` has no value.
    pub fn close(&mut self, near: f64, mut f: impl FnMut(f64) -> Option<f64>) -> Option<()> {
        for _ in 0..Self::MOST {
            let x = self.next(0.5 * near);
            if self.is_narrow(near) || self.take(x, f(x)?) {
                break;
            }
        }
        Some(())
    }

    fn is_narrow(&self, near: f64) -> bool {
        let [a, b] = [self.last[0], self.other[0]];
        let middle = 0.5 * (a + b);
        (a - b).abs() <= near || !(a.min(b) < middle && middle < a.max(b))
    }

    /// Where to evaluate next: no nearer to an end than `near`.
    fn next(&self, near: f64) -> f64 {
        let ([a, fa], [b, fb]) = (self.last, self.other);
        let share = match self.left {
            None => fa / (fa - fb),
            Some([c, fc]) => {
                let (place, value) = ((a - b) / (c - b), (fa - fb) / (fc - fb));
                if value * value < place && (1.0 - value) * (1.0 - value) < 1.0 - place {
                    fa / (fb - fa) * (fc / (fb - fc))
                        + (c - a) / (b - a) * (fa / (fc - fa)) * (fb / (fc - fb))
                } else {
                    0.5
                }
            }
        };
        let least = (near / (a - b).abs()).min(0.5);
        let share = if share.is_finite() { share.clamp(least, 1.0 - least) } else { 0.5 };
        a + share * (b - a)
    }

    /// Takes the value at a place between its ends; returns whether it is a root.
    fn take(&mut self, x: f64, value: f64) -> bool {
        if (value > 0.0) == (self.last[1] > 0.0) {
            self.left = Some(self.last);
        } else {
            self.left = Some(self.other);
            self.other = self.last;
        }
        self.last = [x, value];
        value == 0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_root_to_rounding_in_either_order() {
        for (a, b) in [(0.0, 2.0), (2.0, 0.0)] {
            assert!((sign_change(a, b, |x| x * x - 2.0) - 2f64.sqrt()).abs() <= f64::EPSILON * 2.0);
        }
        assert_eq!(sign_change(0.0, 1.0, |_| 1.0).to_bits(), 1f64.to_bits());
        assert_eq!(sign_change(0.0, f64::NAN, |x| x).to_bits(), f64::NAN.to_bits());
    }

    #[test]
    fn the_least_value_lies_where_it_should() {
        assert!((least(0.0, 3.0, |x| (x - 1.25).powi(2) + 2.0) - 1.25).abs() < 1e-7);
    }

    #[test]
    fn interpolation_takes_few_values_and_never_many() {
        type Case = (fn(f64) -> f64, f64, usize);
        let functions: [Case; 4] = [
            (|x| x * x * x - 2.0, 2f64.cbrt(), 14),
            (|x| x.exp() - 2.0, 2f64.ln(), 14),
            (|x| 2.0 * x - 1.0, 0.5, 4),
            (|x| (x - 1.0).signum() * (x - 1.0).abs().powf(0.1), 1.0, 120),
        ];
        for (f, root, most) in functions {
            for [from, to] in [[0.0, 3.0], [3.0, 0.0]] {
                let mut asked = 0;
                let mut f = |x| {
                    asked += 1;
                    Some(f(x))
                };
                let mut bracket = RootBracket::new([from, f(from).unwrap()], [to, f(to).unwrap()]).unwrap();
                bracket.close(1e-13, &mut f).unwrap();
                let ends = [bracket.end(false), bracket.end(true)];
                assert!(ends.iter().any(|end| (end - root).abs() <= 1e-13), "{root}: {ends:?}");
                assert!(asked <= most, "{root}: {asked}");
            }
        }
        assert!(RootBracket::new([0.0, 1.0], [1.0, 2.0]).is_none());
    }
}
