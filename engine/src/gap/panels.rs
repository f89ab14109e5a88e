//! Panels in the radius on which a gap's slope is provably resolved.
//!
//! Transforms of a gap are tabulated on panels as Chebyshev series of [`NODES`] nodes. A function that is bounded by M
//! on the ellipse ρ = 4 about a panel leaves an error of (4/3) M 4⁻ⁿ. For a panel of half width d, that ellipse lies in
//! the disc of radius 2.125 d about its middle. A panel is accepted where
//!
//! ```text
//! M = max |h'| on that disc  ≤  20 max |h'| on [0, hi],
//! ```
//!
//! with M from the gap's own bound ([`Gap::slope_bound`]), so nothing between the nodes is missed. Only the right side
//! is sampled; an underestimate there only makes the panels narrower. A gap without such bounds is judged by its last
//! coefficients.
//!
//! Between a break at b and the next one, the variable is y = √(a − b): the transform is A(y²) + y B(y²) there,
//! whatever jumps at b. A disc of radius ρ about y becomes one of radius 2yρ + ρ² about b + y². Where the disc reaches
//! beyond y = 0, the slope of the left side is continued around b. It must then be bounded there too, and the disc must
//! not reach the previous break. Left of a break nothing is needed. The innermost panel is taken in u, r = hi u⁵, so
//! that a broken power costs nothing.

use super::function::{ComplexDisc, Gap};
use crate::elementary::cos;
use crate::units::number::short;
use std::f64::consts::PI;
use thiserror::Error;

/// Nodes of the series on a panel.
pub const NODES: usize = 24;

/// The largest number of panels.
const MOST: usize = 20_000;

/// The long half axis of the ellipse ρ = 4 about (−1, 1).
const REACH: f64 = 2.125;

/// How many times larger the slope may be on the disc than on [0, hi].
const GROWTH: f64 = 20.0;

/// Slopes below this share of the largest slope count as this share of it.
const FLOOR: f64 = 1e-10;

/// How far a disc may reach beyond a break, as a share of the distance to the previous break.
const CLEAR: f64 = 0.9;

/// The narrowest panel, as a share of the largest radius.
const NARROWEST: f64 = 1e-15;

/// The first panels end at the largest radius divided by powers of this number.
const FIRST: f64 = 4.0;

/// The number of radii searched for the largest slope: over the whole range, and in one panel.
const COARSE: usize = 256;
const FINE: usize = 8;

/// How large the last coefficients of a gap without bounds may be, and how many of them are looked at.
const TAIL: f64 = 1e-13;
const LAST: usize = 4;

/// How the radius is measured on a panel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Variable {
    /// r = hi·u⁵, u in 0..1: the innermost panel.
    Fifth,
    /// r itself.
    Radius,
    /// y = √(r − base), right of the break `base`.
    Root {
        /// The break.
        base: f64,
    },
}

/// A panel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Span {
    /// Its smaller radius.
    pub lo: f64,
    /// Its larger radius.
    pub hi: f64,
    /// How the radius is measured on it.
    pub variable: Variable,
}

/// A gap that is not resolved.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[error("{}", self.words(|r| short(r, 6)))]
pub struct Unresolved {
    /// The radius that was reached.
    pub radius: f64,
    /// The largest radius asked for.
    pub largest: f64,
    /// The largest number of panels allowed.
    pub panels: f64,
}

impl Unresolved {
    /// What is wrong, with the radii as `length` prints them.
    pub fn words(&self, length: impl Fn(f64) -> String) -> String {
        let [radius, largest] = [self.radius, self.largest].map(length);
        format!(
            "the gap is too rough: its slope is not resolved by {} panels, which end at r = {radius} (it \
             must be up to r = {largest})",
            self.panels
        )
    }
}

/// Panels from `from`, 0 or the end of a panel, to `to`, on which the slope of `gap` is resolved by [`NODES`] nodes.
///
/// `smallest` is the smallest radius that matters: the innermost panel ends there, or at the first break. `breaks` are
/// the breaks of the gap up to `to`, ascending.
///
/// # Errors
/// More than 20 000 panels; the error names the radius reached.
pub fn divide(
    gap: &dyn Gap,
    [from, to]: [f64; 2],
    smallest: f64,
    breaks: &[f64],
) -> Result<Vec<Span>, Unresolved> {
    let breaks: Vec<f64> = breaks.iter().copied().filter(|b| *b > 0.0 && *b < to).collect();
    let mut divider = Divider { gap, to, steepest: 0.0, floor: 0.0, spans: Vec::new() };
    let coarse: Vec<f64> = (0..COARSE).map(|i| to * (i as f64 + 0.5) / COARSE as f64).collect();
    divider.floor = FLOOR * divider.steepest_at(&coarse);
    let within: Vec<f64> = coarse.iter().copied().filter(|r| *r < from).collect();
    divider.steepest = divider.steepest_at(&within);
    let first = breaks.first().copied().unwrap_or(to);
    for (lo, hi) in borders([from, first], to, smallest) {
        if lo == 0.0 {
            divider.steepest = divider.steepest_in(lo, hi);
            divider.spans.push(Span { lo, hi, variable: Variable::Fifth });
        } else {
            divider.stretch(lo, hi, Variable::Radius, 0.0)?;
        }
    }
    for (i, &base) in breaks.iter().enumerate() {
        let hi = breaks.get(i + 1).copied().unwrap_or(to);
        if hi > from {
            let before = i.checked_sub(1).map_or(0.0, |i| breaks[i]);
            divider.stretch(base.max(from), hi, Variable::Root { base }, before)?;
        }
    }
    Ok(divider.spans)
}

/// The first panels up to the first break, ascending.
fn borders([from, first]: [f64; 2], to: f64, smallest: f64) -> Vec<(f64, f64)> {
    let mut ends = vec![first];
    let mut end = to / FIRST;
    while end > smallest.max(from) {
        if end < first {
            ends.push(end);
        }
        end /= FIRST;
    }
    if from == 0.0 && smallest > 0.0 && smallest < first {
        ends.push(smallest);
    }
    ends.push(from);
    ends.reverse();
    ends.windows(2).map(|pair| (pair[0], pair[1])).filter(|(lo, hi)| lo < hi).collect()
}

struct Divider<'a> {
    gap: &'a dyn Gap,
    to: f64,
    /// The largest slope so far.
    steepest: f64,
    /// Smaller slopes count as this one.
    floor: f64,
    spans: Vec<Span>,
}

impl Divider<'_> {
    /// Adds the panels from `lo` to `hi`, between breaks; `before` is the break before the base of the variable.
    fn stretch(&mut self, lo: f64, hi: f64, variable: Variable, before: f64) -> Result<(), Unresolved> {
        let mut open = vec![(lo, hi)];
        while let Some((lo, hi)) = open.pop() {
            let steepest = self.steepest.max(self.steepest_in(lo, hi));
            let middle = match variable {
                Variable::Root { base } => {
                    let y = 0.5 * ((lo - base).sqrt() + (hi - base).sqrt());
                    base + y * y
                }
                _ => 0.5 * (lo + hi),
            };
            let splits = lo < middle && middle < hi && hi - lo > NARROWEST * self.to;
            if splits && !self.is_resolved(Span { lo, hi, variable }, before, steepest.max(self.floor)) {
                open.extend([(middle, hi), (lo, middle)]);
                continue;
            }
            if self.spans.len() >= MOST {
                return Err(Unresolved { radius: lo, largest: self.to, panels: MOST as f64 });
            }
            self.steepest = steepest;
            self.spans.push(Span { lo, hi, variable });
        }
        Ok(())
    }

    /// Whether the nodes resolve the slope on this panel; `steepest` is the largest slope before the panel or in it.
    fn is_resolved(&self, span: Span, before: f64, steepest: f64) -> bool {
        let Span { lo, hi, variable } = span;
        let allowed = GROWTH * steepest;
        let bound = |centre: f64, radius: f64, branch: f64| {
            self.gap.slope_bound(ComplexDisc { centre, radius, branch }).map(|bound| bound <= allowed)
        };
        let resolved = if let Variable::Root { base } = variable {
            let [from, to] = [lo, hi].map(|r| (r - base).sqrt());
            let (middle, reach) = (0.5 * (from + to), REACH * 0.5 * (to - from));
            // The largest |y|² on the far side of y = 0.
            let around = reach * reach - middle * middle;
            if around >= CLEAR * (base - before) {
                return false;
            }
            let centre = base + middle * middle;
            // Rounding must not put the branch on the other side of a break.
            let right = bound(centre, reach * (2.0 * middle + reach), centre.clamp(lo, hi));
            if around > 0.0 && right == Some(true) {
                bound(base, (middle + reach).powi(2), 0.5 * (before + base))
            } else {
                right
            }
        } else {
            let middle = 0.5 * (lo + hi);
            bound(middle, REACH * 0.5 * (hi - lo), middle)
        };
        resolved.unwrap_or_else(|| self.has_no_tail(span, steepest))
    }

    /// Whether the last coefficients of the slope on this panel are no more than rounding.
    fn has_no_tail(&self, Span { lo, hi, variable }: Span, steepest: f64) -> bool {
        let angle = |k: usize| PI * (k as f64 + 0.5) / NODES as f64;
        let radius = |k: usize| {
            let share = 0.5 * (1.0 - cos(angle(k)));
            match variable {
                Variable::Root { base } => {
                    let [from, to] = [lo, hi].map(|r| (r - base).sqrt());
                    let y = from + share * (to - from);
                    (base + y * y).clamp(lo, hi)
                }
                _ => lo + share * (hi - lo),
            }
        };
        let radii: Vec<f64> = (0..NODES).map(radius).collect();
        let slopes = self.slopes(&radii);
        (NODES - LAST..NODES).all(|n| {
            let sum: f64 = slopes.iter().enumerate().map(|(k, h1)| h1 * cos(n as f64 * angle(k))).sum();
            2.0 / NODES as f64 * sum.abs() <= TAIL * steepest
        })
    }

    fn slopes(&self, radii: &[f64]) -> Vec<f64> {
        let mut found = [(); 3].map(|()| vec![0.0; radii.len()]);
        let [first, second, third] = &mut found;
        self.gap.derivatives(1.0, radii, [first, second, third]);
        let [first, ..] = found;
        first
    }

    /// The largest finite slope at these radii.
    fn steepest_at(&self, radii: &[f64]) -> f64 {
        if radii.is_empty() {
            return 0.0;
        }
        self.slopes(radii).into_iter().map(f64::abs).filter(|slope| slope.is_finite()).fold(0.0, f64::max)
    }

    fn steepest_in(&self, lo: f64, hi: f64) -> f64 {
        let radii: Vec<f64> = (0..FINE).map(|i| lo + (hi - lo) * (i as f64 + 0.5) / FINE as f64).collect();
        self.steepest_at(&radii)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gap::Jet;
    use crate::gap::{formula::Formula, formula::FormulaGap};
    use std::sync::atomic::{AtomicUsize, Ordering};

    fn gap(text: &str, to: f64) -> FormulaGap {
        Formula::parse(text).unwrap().bind(&[]).unwrap().over(to).unwrap()
    }

    /// A gap that counts how often it is asked for a bound, or one that has no bounds.
    #[derive(Debug)]
    struct Counted {
        gap: FormulaGap,
        asked: AtomicUsize,
        bounded: bool,
    }

    impl Gap for Counted {
        fn jet(&self, r: f64) -> Jet {
            self.gap.jet(r)
        }

        fn feature_length(&self) -> Option<f64> {
            self.gap.feature_length()
        }

        fn slope_bound(&self, disc: ComplexDisc) -> Option<f64> {
            self.asked.fetch_add(1, Ordering::Relaxed);
            self.bounded.then(|| self.gap.bound().slope_bound(disc))
        }

        fn reference_length(&self) -> f64 {
            1.0
        }
    }

    fn divided(text: &str, to: f64, bounded: bool) -> (Vec<Span>, usize) {
        let gap = gap(text, to);
        let breaks = gap.breaks_up_to(to);
        let gap = Counted { gap, asked: AtomicUsize::new(0), bounded };
        let spans = divide(&gap, [0.0, to], 1e-5 * to, &breaks).unwrap();
        check_neighbours(&spans);
        assert_eq!((spans[0].lo, spans[spans.len() - 1].hi), (0.0, to), "{text}");
        for b in &breaks {
            assert!(
                !spans.iter().any(|span| span.lo < *b && *b < span.hi),
                "{text}: {b} lies inside a panel"
            );
        }
        (spans, gap.asked.into_inner())
    }

    /// Each panel begins where the previous one ends.
    fn check_neighbours(spans: &[Span]) {
        let ends: Vec<f64> = spans[..spans.len() - 1].iter().map(|span| span.hi).collect();
        let starts: Vec<f64> = spans[1..].iter().map(|span| span.lo).collect();
        assert_eq!(ends, starts);
    }

    /// The radius at −1 ≤ x ≤ 1 of the variable of a panel.
    fn radius(Span { lo, hi, variable }: Span, x: f64) -> f64 {
        let share = 0.5 * (1.0 + x);
        let r = match variable {
            Variable::Fifth => hi * share.powi(5),
            Variable::Radius => lo + share * (hi - lo),
            Variable::Root { base } => {
                let [from, to] = [lo, hi].map(|r| (r - base).sqrt());
                base + (from + share * (to - from)).powi(2)
            }
        };
        r.clamp(lo.next_up(), hi.next_down())
    }

    /// The largest difference between h' and its interpolant, relative to the largest |h'| up to there, or to `least`
    /// if larger.
    fn error(gap: &dyn Gap, spans: &[Span], least: f64) -> f64 {
        let node = |k: usize| (PI * (k as f64 + 0.5) / NODES as f64).cos();
        let slope = |span: Span, x: f64| gap.jet(radius(span, x)).first;
        let mut steepest = least;
        let mut worst = 0f64;
        for &span in spans {
            let slopes: Vec<f64> = (0..NODES).map(|k| slope(span, node(k))).collect();
            steepest = slopes.iter().fold(steepest, |s, x| s.max(x.abs()));
            for i in 0..50 {
                let x = (f64::from(i) - 24.7) / 25.3;
                let (mut above, mut below) = (0.0, 0.0);
                for (k, h1) in slopes.iter().enumerate() {
                    let sign = if k % 2 == 0 { 1.0 } else { -1.0 };
                    let weight = sign * (PI * (k as f64 + 0.5) / NODES as f64).sin() / (x - node(k));
                    above += weight * h1;
                    below += weight;
                }
                worst = worst.max((above / below - slope(span, x)).abs() / steepest);
            }
        }
        worst
    }

    #[test]
    fn a_bump_takes_few_panels_and_few_discs() {
        let (spans, discs) = divided("r^2/2 + 0.0025*exp(-((r-0.3)/0.01)^2)", 0.5, true);
        assert!((28..=36).contains(&spans.len()), "{} panels", spans.len());
        assert!((45..=62).contains(&discs), "{discs} discs");
        assert_eq!(spans[0], Span { lo: 0.0, hi: 5e-6, variable: Variable::Fifth });
        let (spans, _) = divided("r^2/2 + 0.0005*exp(-2000*(1-cos(2*pi*r/0.1)))", 0.5, true);
        assert!((140..=190).contains(&spans.len()), "{} panels", spans.len());
    }

    #[test]
    fn a_bump_between_all_samples_is_found() {
        let (spans, discs) = divided("r^2/2 + 1e-9*exp(-((r-0.23712345)/3e-5)^2)", 0.5, true);
        assert!(discs < 200, "{discs} discs");
        let at = spans.iter().find(|span| span.hi > 0.237_123_45).unwrap();
        assert!(at.hi - at.lo < 2e-4, "{at:?}");
    }

    #[test]
    fn the_slope_is_resolved_on_every_panel() {
        for (text, most) in [
            ("r^2/2", 12),
            ("r^2/2 + 0.0025*exp(-((r-0.3)/0.01)^2)", 40),
            ("r^2/2 + 1e-9*exp(-((r-0.23712345)/3e-5)^2)", 90),
            ("r^2/2 + 1.1566388e-05/(1+((r-0.180266)/0.00060626)^2)", 60),
            ("r^2/2 + 0.07*abs(r-0.12)", 30),
            ("r^2/2 + 0.5*max(0.0008 - abs(r-0.3), 0)", 60),
            ("r^2/2 + 0.02*abs(sin(pi*r/0.27))", 40),
            ("r^2/2 + abs(r-0.3)^1.5", 180),
            ("0.2*max(r-0.3, 0)", 30),
            ("0.2*max(r-0.3, 0)^1.5", 110),
            ("r^1.21", 40),
            ("0.2*r + 0.01*tanh((r-0.2)/0.003)", 60),
            ("1 - sqrt(1 - r^2)", 12),
            ("r^2/2 + 1e-3*atan(1e3*(r-0.3)*max(r-0.1, 0))", 90),
            ("5", 12),
        ] {
            let (spans, _) = divided(text, 0.5, true);
            assert!(spans.len() <= most, "{text}: {} panels", spans.len());
            // In the innermost panel a broken power is smooth in u only to some order.
            let spans: Vec<Span> =
                spans.into_iter().filter(|span| span.variable != Variable::Fifth).collect();
            // Beside a branch point the last panels are a few units in the last place of r wide. The slope there is y,
            // which is known only to the square root of that.
            let (allowed, least) = if text.contains("^1.5") { (3e-8, 0.1) } else { (2e-12, 1e-300) };
            let worst = error(&gap(text, 0.5), &spans, least);
            assert!(worst <= allowed, "{text}: {worst:e}");
        }
    }

    #[test]
    fn panels_go_on_outward() {
        let text = "r^2/2 + 0.02*abs(r-0.3) + 0.001*exp(-((r-0.8)/0.01)^2)";
        let gap = gap(text, 2.0);
        let breaks = gap.breaks_up_to(2.0);
        for middle in [0.1, 0.3, 0.7] {
            let inner = divide(&gap, [0.0, middle], 1e-5, &breaks).unwrap();
            let outer = divide(&gap, [middle, 2.0], 1e-5, &breaks).unwrap();
            assert_eq!((inner[inner.len() - 1].hi, outer[0].lo), (middle, middle));
            let spans: Vec<Span> = inner.into_iter().skip(1).chain(outer).collect();
            check_neighbours(&spans);
            assert!(spans.len() < 80);
            assert!(error(&gap, &spans, 1e-300) < 2e-12, "{middle}");
            for span in spans {
                let right = span.lo >= 0.3;
                assert_eq!(span.variable != Variable::Radius, right, "{span:?}");
            }
        }
    }

    #[test]
    fn a_gap_without_bounds_is_judged_by_its_tail() {
        let text = "r^2/2 + 0.0025*exp(-((r-0.3)/0.01)^2) + 0.01*abs(r - 0.2)";
        let (spans, _) = divided(text, 0.5, false);
        assert!(spans.len() < 60, "{} panels", spans.len());
        assert!(error(&gap(text, 0.5), &spans[1..], 1e-300) < 1e-11);
    }

    #[test]
    fn what_takes_too_many_panels_is_refused() {
        let gap = gap("r^2/2 + 1e-7*sin(1e6*r)", 0.5);
        let refused = divide(&gap, [0.0, 0.5], 5e-6, &[]).unwrap_err();
        assert!(refused.radius > 0.01 && refused.radius < 0.5, "{refused}");
        assert!(refused.to_string().starts_with("the gap is too rough"), "{refused}");
    }
}
