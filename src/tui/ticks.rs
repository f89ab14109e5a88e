//! Round numbers beside an axis.

use crate::figure::AxisScale;
use pulloff_engine::report::number::{fixed, short};

/// Round ticks inside `bounds`, about `most` and at least two, with labels of equal precision; on an axis of counts,
/// only whole numbers, and no more ticks than there are of these. Along a logarithmic axis the bounds and the ticks are
/// decimal logarithms of the values, and the labels the values themselves.
pub fn ticks(bounds: [f64; 2], run: AxisScale, most: usize) -> Vec<(f64, String)> {
    // A single number gives no scale: then the steps are halved, or nearly.
    const FINER: usize = 4;
    if run == AxisScale::Logarithmic {
        return factors(bounds, most);
    }
    let found = (0..FINER).map(|halvings| spaced(bounds, run, most << halvings));
    found.reduce(|coarse, fine| if coarse.len() < 2 { fine } else { coarse }).unwrap_or_default()
}

/// Powers of ten between two decimal logarithms, all or every second, third, …; in a short range other round numbers.
fn factors([lo, hi]: [f64; 2], most: usize) -> Vec<(f64, String)> {
    /// The most decades: more than between the smallest and the largest number.
    const DECADES: i32 = 700;
    if most == 0 || !(lo..hi).contains(&lo) || hi - lo > f64::from(DECADES) {
        return Vec::new();
    }
    let is_inside = |at: &f64| (lo - 1e-9..=hi + 1e-9).contains(at);
    // The range is short.
    #[expect(clippy::cast_possible_truncation)]
    let powers = lo.floor() as i32..=hi.floor() as i32;
    let of = |factors: &[f64], every: i32| -> Vec<f64> {
        let powers = powers.clone().filter(|power| power % every == 0);
        let all =
            powers.flat_map(|power| factors.iter().map(move |factor| f64::from(power) + factor.log10()));
        all.filter(is_inside).collect()
    };
    let series = [of(&[1.0, 2.0, 5.0], 1), of(&[1.0, 3.0], 1)].into_iter();
    let all = series.chain((1..DECADES).map(|every| of(&[1.0], every))).find(|all| all.len() <= most);
    match all.filter(|all| all.len() > 1) {
        Some(all) => all.into_iter().map(|at| (at, short(10f64.powf(at), 3))).collect(),
        None => ticks([lo, hi].map(|at| 10f64.powf(at)), AxisScale::Linear, most)
            .into_iter()
            .map(|(value, label)| (value.log10(), label))
            .collect(),
    }
}

/// The same, but at most `most` ticks, and possibly none.
fn spaced([lo, hi]: [f64; 2], run: AxisScale, most: usize) -> Vec<(f64, String)> {
    let range = hi - lo;
    if most == 0 || !range.is_finite() || range <= 0.0 {
        return Vec::new();
    }
    let raw = range / most as f64;
    let decade = 10f64.powf(raw.log10().floor());
    let step = [1.0, 2.0, 5.0, 10.0].into_iter().map(|m| m * decade).find(|step| *step >= raw).unwrap_or(raw);
    let step = if run == AxisScale::Counted { step.max(1.0) } else { step };
    let first = (lo / step).ceil();
    // Enough decimals to distinguish neighbouring ticks; very small or large values get an exponent.
    let decimals = (-step.log10().floor()).max(0.0);
    let size = lo.abs().max(hi.abs());
    let plain = decimals <= 5.0 && size < 1e6;
    // Far into a curve only the last digits differ.
    let digits = (size / step).log10().ceil().clamp(2.0, 16.0) + 1.0;
    (0..=most)
        .map(|i| (first + i as f64) * step)
        .take_while(|tick| *tick <= hi + 1e-9 * step)
        .map(|tick| {
            let tick = if tick.abs() < 0.5 * step { 0.0 } else { tick };
            // Between 0 and 5, and between 3 and 17, see above.
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
            let label = if plain { fixed(tick, decimals as usize) } else { short(tick, digits as usize) };
            (tick, label)
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_inside() {
        let labels = |bounds, most| {
            ticks(bounds, AxisScale::Linear, most).into_iter().map(|(_, l)| l).collect::<Vec<_>>()
        };
        assert_eq!(labels([-0.061, 0.066], 4), ["-0.05", "0.00", "0.05"]);
        assert_eq!(labels([-1.5, 0.4], 5), ["-1.5", "-1.0", "-0.5", "0.0"]);
        assert_eq!(labels([0.0, 3e-9], 3), ["0", "1e-9", "2e-9", "3e-9"]);
        assert_eq!(labels([0.3, 1.7], 1), ["0.5", "1.0", "1.5"]);
        // Far into a curve, neighbouring ticks still differ.
        let deep = labels([0.123_456_78, 0.123_456_82], 4);
        assert_eq!(deep, ["0.12345678", "0.12345679", "0.1234568", "0.12345681", "0.12345682"]);
        assert!(ticks([1.0, 1.0], AxisScale::Linear, 4).is_empty());
        assert!(ticks([0.0, f64::NAN], AxisScale::Linear, 4).is_empty());
        let factors = |bounds, most| {
            let all = ticks(bounds, AxisScale::Logarithmic, most).into_iter();
            all.map(|(_, label)| label).collect::<Vec<_>>()
        };
        assert_eq!(factors([-8.0, 2.0], 6), ["1e-8", "1e-6", "0.0001", "0.01", "1", "100"]);
        assert_eq!(factors([-1.2, 1.1], 4), ["0.1", "1", "10"]);
        assert_eq!(factors([-0.5, 0.8], 5), ["0.5", "1", "2", "5"]);
        assert_eq!(factors([0.35, 0.45], 4), ["2.4", "2.6", "2.8"]);
        assert!(factors([1.0, f64::INFINITY], 4).is_empty());
        let counts =
            |bounds| ticks(bounds, AxisScale::Counted, 6).into_iter().map(|(_, l)| l).collect::<Vec<_>>();
        assert_eq!(counts([-0.1, 2.1]), ["0", "1", "2"]);
        assert_eq!(counts([2.9, 14.2]), ["4", "6", "8", "10", "12", "14"]);
    }
}
