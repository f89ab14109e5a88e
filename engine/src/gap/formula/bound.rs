//! The formula with its parameters given.

use super::fold::{FormulaStep, Steps};
use super::jets::{Block, Jets, LANES};
use crate::gap::Jet;
use std::array::from_fn;

/// Blocks that fit on the stack without allocation: more than typed formulas need.
const SHALLOW: usize = 8;

/// A gap formula with values for its parameters.
#[derive(Debug, Clone, PartialEq)]
pub struct Bound {
    pub(super) steps: Steps,
    offset: f64,
}

impl Bound {
    pub(super) fn new(steps: Steps) -> Self {
        let mut bound = Self { steps, offset: 0.0 };
        bound.offset = bound.jet(0.0).value;
        bound
    }

    /// The value of the formula on the axis, a length: it is subtracted, so that h(0) = 0.
    pub fn offset(&self) -> f64 {
        self.offset
    }

    /// The gap and its derivatives at the radius `r`.
    ///
    /// NaN where the formula is undefined; on the axis this may be true of the derivatives alone.
    pub fn jet(&self, r: f64) -> Jet {
        let mut jet = Jet::default();
        self.each(&self.steps.steps, 1.0, &[r], |_, [value, first, second, third]| {
            jet = Jet { value: value - self.offset, first, second, third };
        });
        jet
    }

    /// h at the radii s·x for every x of `nodes`, into a slice of the same length.
    pub fn values(&self, s: f64, nodes: &[f64], values: &mut [f64]) {
        self.each(&self.steps.steps, s, nodes, |at, [value]| values[at] = value - self.offset);
    }

    /// h', h'' and h''' at the radii s·x for every x of `nodes`, each into a slice of the same length.
    pub fn derivatives(&self, s: f64, nodes: &[f64], [first, second, third]: [&mut [f64]; 3]) {
        self.each(&self.steps.steps, s, nodes, |at, [_, h1, h2, h3]| {
            (first[at], second[at], third[at]) = (h1, h2, h3);
        });
    }

    /// Runs these steps, which make up a whole operand, at the radii s·x and passes on each value with its N − 1
    /// derivatives.
    pub(super) fn each<const N: usize>(
        &self,
        steps: &[FormulaStep],
        s: f64,
        nodes: &[f64],
        mut with: impl FnMut(usize, [f64; N]),
    ) {
        let mut run_on = |stack: &mut [Jets<N>]| {
            for (block, nodes) in nodes.chunks(LANES).enumerate() {
                // If the last block is not full, it repeats its first radius.
                let radii: [f64; LANES] = from_fn(|lane| s * nodes.get(lane).unwrap_or(&nodes[0]));
                let found = run(steps, Block::from(radii), stack).0.map(Block::to_array);
                for lane in 0..nodes.len() {
                    with(block * LANES + lane, found.map(|found| found[lane]));
                }
            }
        };
        if self.steps.depth <= SHALLOW {
            run_on(&mut [Jets::number(0.0); SHALLOW]);
        } else {
            run_on(&mut vec![Jets::number(0.0); self.steps.depth]);
        }
    }
}

/// Runs the steps on a stack that is large enough for them.
fn run<const N: usize>(steps: &[FormulaStep], radii: Block, stack: &mut [Jets<N>]) -> Jets<N> {
    // The number of blocks on the stack; the one on top is at `top - 1`.
    let mut top = 0;
    for step in steps {
        match *step {
            FormulaStep::Number(_) | FormulaStep::Radius => top += 1,
            FormulaStep::Binary(_) => top -= 1,
            _ => {}
        }
        let at = top - 1;
        stack[at] = match *step {
            FormulaStep::Number(number) => Jets::number(number),
            FormulaStep::Radius => Jets::radii(radii),
            FormulaStep::Binary(binary) => stack[at].binary(stack[top], binary),
            FormulaStep::Unary(unary) => stack[at].unary(unary),
            FormulaStep::Shift(c) => stack[at].shift(c),
            FormulaStep::Scale(c) => stack[at].scale(c),
            FormulaStep::Divide(c) => stack[at].divide(c),
            FormulaStep::Over(c) => stack[at].over(c),
            FormulaStep::IntegerPower(n) => stack[at].integer_power(n),
            FormulaStep::RealPower(p) => stack[at].real_power(p),
            FormulaStep::Exponential(c) => stack[at].exponential(c),
        };
    }
    stack[0]
}

#[cfg(test)]
mod tests {
    use crate::gap::formula::Formula;
    use crate::gap::{Gap, Jet, Shape};

    fn jet(text: &str, r: f64) -> Jet {
        Formula::parse(text).unwrap().bind(&[]).unwrap().jet(r)
    }

    #[test]
    fn the_wavy_sphere_is_that_of_the_closed_form() {
        let (radius_of_curvature, amplitude, wavelength) = (0.8, 0.003, 0.07);
        let shape = Shape::WavySphere { radius_of_curvature, amplitude, wavelength };
        let formula = Formula::parse("r^2/(2*R) + A*(1 - cos(2*pi*r/lambda))").unwrap();
        let values = [("R", radius_of_curvature), ("A", amplitude), ("lambda", wavelength)];
        let bound = formula.bind(&values).unwrap();
        let radii: Vec<f64> = (0..103).map(|i| 0.01 * f64::from(i)).collect();
        let mut found = [(); 4].map(|()| vec![f64::NAN; radii.len()]);
        let [value, first, second, third] = &mut found;
        bound.values(1.0, &radii, value);
        bound.derivatives(1.0, &radii, [first, second, third]);
        let q = std::f64::consts::TAU / wavelength;
        for (i, &r) in radii.iter().enumerate() {
            let (jet, exact) = (bound.jet(r), shape.jet(r));
            let [value, first, second, third] = [0, 1, 2, 3].map(|order: usize| found[order][i]);
            assert_eq!(jet, Jet { value, first, second, third }, "alone as in a block");
            // The angle q r is rounded, which moves the wave by a few units in its last place.
            let slack = 1e-15 * (1.0 + q * r);
            for (n, (found, exact)) in [
                (jet.value, exact.value),
                (jet.first, exact.first),
                (jet.second, exact.second),
                (jet.third, exact.third),
            ]
            .into_iter()
            .enumerate()
            {
                let scale = amplitude * q.powi(i32::try_from(n).unwrap()) + exact.abs();
                assert!((found - exact).abs() <= slack * scale, "r = {r}, order {n}: {found} {exact}");
            }
        }
    }

    #[test]
    fn every_rule_agrees_with_central_differences() {
        let x = "(0.2 + 0.5*r + 0.3*r^2)";
        let mut texts: Vec<String> = crate::expression::function::FUNCTIONS
            .iter()
            .map(|(name, function)| match function.arguments() {
                1 => format!("{name}({x})"),
                _ => format!("{name}({x}, 1.1 - r*r)"),
            })
            .collect();
        for form in [
            "x^2",
            "x^3",
            "x^4",
            "x^7",
            "x^-1",
            "x^-2",
            "x^-3",
            "x^2.5",
            "x^-0.5",
            "x^r",
            "1.3^x",
            "x/(1+r^2)",
            "2/x",
            "x/3",
            "-x*r",
            "1.5 - x",
            "max(r, 0.4)^1.5",
            "sin(x)^2*exp(-x)",
        ] {
            texts.push(
                form.replace('x', x).replace(&format!("e{x}p"), "exp").replace(&format!("ma{x}"), "max"),
            );
        }
        for text in texts {
            let bound = Formula::parse(&text).unwrap().bind(&[]).unwrap();
            for i in 1..40 {
                let (r, e) = (0.0213 * f64::from(i), 1e-5);
                let (lo, at, hi) = (bound.jet(r - e), bound.jet(r), bound.jet(r + e));
                for (order, difference, exact) in [
                    (1, hi.value - lo.value, at.first),
                    (2, hi.first - lo.first, at.second),
                    (3, hi.second - lo.second, at.third),
                ] {
                    let slope = difference / (2.0 * e);
                    assert!(
                        (slope - exact).abs() <= 1e-6 * (1.0 + exact.abs()),
                        "{text} r={r} order {order}: {slope} {exact}"
                    );
                }
            }
        }
    }

    #[test]
    fn the_axis_and_the_corners() {
        let with = |value, first, second, third| Jet { value, first, second, third };
        assert_eq!(jet("r^2", 0.0), with(0.0, 0.0, 2.0, 0.0));
        assert_eq!(jet("r^3 + 5", 0.0), with(0.0, 0.0, 0.0, 6.0));
        assert_eq!(jet("r^5 + 5", 2.0), with(32.0, 80.0, 160.0, 240.0));
        assert!(jet("sqrt(r^2)", 0.0).value.abs() < 1e-300);
        assert_eq!(jet("sqrt(r^2)", 2.0), with(2.0, 1.0, 0.0, 0.0));
        assert_eq!(jet("max(r - 1, 0)^1.5", 0.5), Jet::default());
        let corner = jet("abs(1 - r)^2.5", 1.0);
        assert_eq!(with(corner.value, corner.first, corner.second, 0.0), with(-1.0, 0.0, 0.0, 0.0));
        assert_eq!(jet("min(r, 2 - r)", 1.5), with(0.5, -1.0, 0.0, 0.0));
        assert_eq!(jet("abs(r - 1)", 0.5), with(-0.5, -1.0, 0.0, 0.0));
        assert!(jet("max(0*r + (0 - 1)^0.5, r)", 1.0).value.is_nan());
        assert!(
            jet("min(r, log(-1 - r))", 1.0).value.is_nan() && jet("min(log(-1 - r), r)", 1.0).value.is_nan()
        );
        let offset = |text: &str| Formula::parse(text).unwrap().bind(&[]).unwrap().offset();
        assert_eq!((offset("3 + r"), offset("7")), (3.0, 7.0));
    }

    #[test]
    fn large_angles_and_exponents_keep_their_digits() {
        for exponent in -3..=12 {
            let x = 10f64.powi(exponent) * 1.234_567;
            let close = |text: &str, exact: f64| {
                let found = jet(text, x).value;
                assert!(
                    (found - exact).abs() <= 4e-16 * exact.abs().max(1.0),
                    "{text} at {x}: {found} {exact}"
                );
            };
            close("sin(r)", x.sin());
            close("sin(r + pi/2) - 1", (x + std::f64::consts::FRAC_PI_2).sin() - 1.0);
            if exponent < 2 {
                close("exp(r) - 1", x.exp() - 1.0);
                close("exp(-r) - 1", (-x).exp() - 1.0);
            }
        }
    }
}
