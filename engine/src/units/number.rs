//! How numbers are written for people.

use super::unit::superscript;
use super::{Quantity, UnitSystem};

/// `x` with `digits` significant digits: plain if that is short, otherwise with an exponent.
pub fn significant(x: f64, digits: usize) -> String {
    if x == 0.0 {
        return "0".to_owned();
    }
    if !x.is_finite() {
        return "-".to_owned();
    }
    let digits = digits.max(1);
    let scientific = format!("{x:.*e}", digits - 1);
    // Rounding can carry into the next decade (9.99 → 10.0), so the exponent is read off the rounded number.
    let Some((mantissa, exponent)) = scientific.split_once('e') else { return scientific };
    let Ok(exponent) = exponent.parse::<i32>() else { return scientific };
    let last = i32::try_from(digits).unwrap_or(i32::MAX) - 1 - exponent;
    if (-4..6).contains(&exponent) {
        // Not negative, unless there are more digits before the point than are significant.
        return format!("{x:.*}", usize::try_from(last).unwrap_or(0));
    }
    format!("{}e{exponent}", trim_zeros(mantissa))
}

/// `x` with at most `digits` significant digits and no trailing zeros.
pub fn short(x: f64, digits: usize) -> String {
    let text = significant(x, digits);
    if text.contains('e') { text } else { trim_zeros(&text).to_owned() }
}

/// `x` with `digits` significant digits in a column whose largest number is `largest`: what rounding has left of zero
/// is zero.
pub fn in_column(x: f64, digits: usize, largest: f64) -> String {
    /// A solver's equations hold to about this share of what they contain.
    const ROUNDING: f64 = 1e-12;
    significant(if x.abs() <= ROUNDING * largest.abs() { 0.0 } else { x }, digits)
}

/// `x` with as many digits as are needed to read back the very same number.
pub fn exact(x: f64) -> String {
    format!("{x:?}")
}

/// The digits of a double that survive a conversion of units and back.
pub const TYPED: usize = 15;

/// `x` as it was typed, before conversions of its unit left a last digit that nobody typed.
pub fn as_typed(x: f64) -> f64 {
    format!("{x:.*e}", TYPED - 1).parse().unwrap_or(x)
}

/// A loss: four digits, with an exponent if it is small or large and not zero, so that losses of very different size align.
pub fn loss(x: f64) -> String {
    match x.abs() {
        0.0 => "0".to_owned(),
        0.1..1e5 => significant(x, 4),
        _ => format!("{x:.3e}"),
    }
}

/// `x` with this many decimals; a zero has no sign.
pub fn fixed(x: f64, decimals: usize) -> String {
    let text = format!("{x:.decimals$}");
    let is_zero = text.trim_matches(['-', '0', '.']).is_empty();
    text.strip_prefix('-').filter(|_| is_zero).map_or_else(|| text.clone(), str::to_owned)
}

/// A formatted number as in print: −0.5, 1.5×10⁻⁴.
pub fn printed(text: &str) -> String {
    let minus = |text: &str| text.replace('-', "−");
    let parts = text.split_once('e').and_then(|(mantissa, power)| Some((mantissa, power.parse().ok()?)));
    parts.map_or_else(
        || minus(text),
        |(mantissa, power)| format!("{}×10{}", minus(mantissa), superscript(power)),
    )
}

/// A relative difference: its sign, two digits and its decade.
pub fn difference(x: f64) -> String {
    format!("{x:+.1e}")
}

fn trim_zeros(text: &str) -> &str {
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { text }
}

/// A value of a quantity, in SI or reduced units, as shown to a person: `number` formats it in its display unit, and
/// the unit follows.
pub fn with_unit(
    units: &UnitSystem,
    quantity: Quantity,
    x: f64,
    ascii: bool,
    number: impl Fn(f64) -> String,
) -> String {
    let shown = units.shown(quantity, x);
    shown.text(&number(shown.number), ascii)
}

/// A value for a message: six digits, in ASCII, because a message may go anywhere.
pub fn said(units: &UnitSystem, quantity: Quantity, x: f64) -> String {
    with_unit(units, quantity, x, true, |x| short(x, 6))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn significant_digits_in_every_decade() {
        for (x, digits, text) in [
            (0.0, 4, "0"),
            (1.0, 4, "1.000"),
            (0.035_718_65, 4, "0.03572"),
            (-1.479_672_9, 4, "-1.480"),
            (9.9996, 4, "10.00"),
            (123_456.7, 4, "123457"),
            (1.0e-9, 4, "1e-9"),
            (-2.5e6, 3, "-2.5e6"),
            (f64::NAN, 3, "-"),
        ] {
            assert_eq!(significant(x, digits), text);
        }
        for (x, text) in [(-8e-16, "0"), (8e-12, "8e-12"), (0.0, "0"), (-0.036, "-0.0360")] {
            assert_eq!(in_column(x, 3, -0.036), text);
        }
        assert_eq!(in_column(-8e-16, 3, 1e-15), "-8e-16");
        assert_eq!([-8e-16, -0.0006].map(|x| fixed(x, 3)), ["0.000", "-0.001"]);
        assert_eq!(short(0.0025, 6), "0.0025");
        assert_eq!(short(200.0, 4), "200");
    }

    #[test]
    fn a_number_in_print_has_a_minus_sign_and_a_raised_power() {
        let texts = ["-0.5", "1.5e-4", "-1e12", "0", "NaN", "1e"];
        assert_eq!(texts.map(printed), ["−0.5", "1.5×10⁻⁴", "−1×10¹²", "0", "NaN", "1e"]);
    }
}
