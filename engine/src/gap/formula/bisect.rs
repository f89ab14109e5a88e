//! Halving an interval down to rounding.

/// The width at which an interval is no longer halved, as a share of the largest radius.
pub(super) const NARROW: f64 = 2e-15;

/// The first radius found where `good` no longer holds; it holds at `from` and not at `to`.
pub(super) fn bisect(mut from: f64, mut to: f64, good: impl Fn(f64) -> bool) -> f64 {
    loop {
        let middle = 0.5 * (from + to);
        if middle <= from || middle >= to {
            return to;
        }
        if good(middle) {
            from = middle;
        } else {
            to = middle;
        }
    }
}
