//! What rings need from a gap: h, its transform, its lengths, and sums over the disc.
//!
//! Sums under the disc are taken over v, with a = a₁ tanh v and a₁ the inner edge of the first ring: 1/√(r² − a²) for r
//! ≥ a₁ is then analytic for |Im v| < π/2, however near to the disc the ring begins.

use crate::disc::{Panel, Panels, Place, Table, TableError, outside};
use crate::elementary::{cbrt, cosh, ln, tanh};
use crate::gap::{Form, Gap};
use crate::progress::Progress;
use crate::root;
use gauss_quad::GaussLegendre;
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::num::NonZeroUsize;
use std::sync::{Arc, OnceLock};

/// The most nodes in one sum over the disc.
const MOST_NODES: usize = 512;

/// Accuracy of sums over the disc, as ln(1/error).
const DIGITS: f64 = 34.6;

/// Samples of a gap from which stand-ins for its lengths, and its crests, are found: how many evenly spaced; how many
/// at most on all panels of the table, which are as fine as the gap is; and the limits on each panel.
const SAMPLES: u32 = 4000;
const MOST_ON_PANELS: usize = 200_000;
const ON_PANEL: [usize; 2] = [2, 16];

/// For a gap that ends, the share of it within which its lengths are found.
const INSIDE: f64 = 0.9;

/// Gauss's nodes and weights on (−1, 1), ascending; made once.
pub fn gauss(n: usize) -> &'static [[f64; 2]] {
    static RULES: [OnceLock<Vec<[f64; 2]>>; MOST_NODES + 1] = [const { OnceLock::new() }; MOST_NODES + 1];
    let n = n.clamp(1, MOST_NODES);
    RULES[n].get_or_init(|| {
        let rule = GaussLegendre::new(NonZeroUsize::new(n).unwrap_or(NonZeroUsize::MIN));
        let mut pairs: Vec<[f64; 2]> = rule.iter().map(|(x, weight)| [*x, *weight]).collect();
        pairs.sort_by(|a, b| a[0].total_cmp(&b[0]));
        pairs
    })
}

/// A gap with its table, as far out as requested.
#[derive(Debug, Clone)]
pub struct Ground {
    /// The gap.
    pub gap: Arc<dyn Gap>,
    /// The table.
    pub table: Arc<Table>,
    /// Its panels.
    pub panels: Arc<Panels>,
    /// λ: the shortest wave, or what stands for it.
    pub wave: f64,
    /// ρ: the smallest radius of curvature of a crest, 1/max h''.
    pub crest: f64,
    /// The largest wavenumber of h where h is analytic on every disc; none where it is not.
    pub(super) entire: Option<f64>,
    /// The smallest g from the inner end of each panel outward, less what samples may miss.
    pub(super) least: Vec<f64>,
    /// The breaks where h' itself jumps.
    pub corners: Vec<f64>,
    /// The length over which the gap changes, at each border of the panels from the axis outward; empty where it is λ
    /// everywhere.
    pub(super) local: Vec<f64>,
    /// Whether the transform only grows.
    pub(super) grows: bool,
    /// Whether the breaks are knots of a spline.
    pub(super) spline: bool,
    /// The radii where h' or a higher derivative jumps, ascending.
    pub breaks: Vec<f64>,
}

/// Nodes of a sum over the disc: ∫₀^s f da = Σ `weight` f(`radius`).
#[derive(Debug, Clone, Default)]
pub struct DiscNodes {
    /// a.
    pub radius: Vec<f64>,
    /// a₁² sech² v = a₁² − a².
    pub below: Vec<f64>,
    /// The weight.
    pub weight: Vec<f64>,
}

impl DiscNodes {
    fn push(&mut self, edge: f64, v: f64, weight: f64) {
        let sech = cosh(v).recip();
        let square = sech * sech;
        self.radius.push(edge * tanh(v));
        self.below.push(edge * edge * square);
        self.weight.push(edge * weight * square);
    }

    /// The nodes for ∫₀^s da/√((r² − a²)(r'² − a²)), r and r' at least `edge`: the integrand is even in v.
    pub fn even(s: f64, edge: f64) -> Self {
        let end = artanh(s, edge);
        let beta = FRAC_PI_2 / end;
        let n = up(DIGITS / (4.0 * ln(beta + (beta * beta + 1.0).sqrt())) + 2.0);
        let mut nodes = Self::default();
        for [x, weight] in &gauss(2 * n)[n..] {
            nodes.push(edge, end * x, end * weight);
        }
        nodes
    }

    /// The nodes for the same integrand times a function with wavenumbers up to `wavenumber`, which need not be even.
    pub fn any(s: f64, edge: f64, wavenumber: f64) -> Self {
        let end = artanh(s, edge);
        let beta = PI / end;
        let phase = 0.5 * wavenumber * edge * end.min(4.0);
        let n = up(DIGITS / (2.0 * ln(beta + (beta * beta + 1.0).sqrt())) + 2.0 + phase + 4.0 * cbrt(phase));
        let mut nodes = Self::default();
        for [x, weight] in gauss(n) {
            nodes.push(edge, 0.5 * end * (1.0 + x), 0.5 * end * weight);
        }
        nodes
    }
}

/// artanh(s/edge).
fn artanh(s: f64, edge: f64) -> f64 {
    0.5 * ln((edge + s) / (edge - s))
}

/// The next multiple of four.
fn up(n: f64) -> usize {
    // Positive, and a thousand at most.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    let n = n.clamp(1.0, MOST_NODES as f64) as usize;
    n.next_multiple_of(4)
}

impl Ground {
    /// The gap of `table` up to the radius `reach`, a length, or to where the gap ends.
    ///
    /// # Errors
    /// [`TableError`].
    pub fn new(table: Arc<Table>, reach: f64, progress: &dyn Progress) -> Result<Self, TableError> {
        let gap = Arc::clone(table.gap());
        let panels = table.up_to_while(reach, 0, progress)?;
        let reach = panels.reach();
        let breaks = gap.breaks_up_to(reach);
        let entire = match gap.form() {
            Form::Waves { waves, .. } => {
                Some(waves.iter().fold(0.0, |most: f64, wave| most.max(wave.wavenumber)))
            }
            // Even powers are polynomials in a².
            Form::Power { exponent, .. } if exponent.fract() == 0.0 => Some(0.0),
            _ => None,
        };
        let least = least(&panels);
        let grows = matches!(gap.form(), Form::Power { .. });
        let spline = matches!(gap.form(), Form::Cubic(_));
        let (corners, [standin, crest]) = lengths(&*gap, &panels, &breaks);
        let wave = gap.feature_length().unwrap_or(standin);
        let local = if gap.feature_length().is_some() { Vec::new() } else { local(&panels) };
        Ok(Self { gap, table, panels, wave, crest, entire, least, corners, local, grows, spline, breaks })
    }

    /// The length over which the gap changes at a radius: λ, or more where the panels of the table are wide.
    pub fn length_at(&self, r: f64) -> f64 {
        let list = self.panels.list();
        let at = list.partition_point(|panel| panel.span.hi < r);
        let (Some(inner), Some(outer), Some(panel)) =
            (self.local.get(at), self.local.get(at + 1), list.get(at))
        else {
            return self.wave;
        };
        let here = (inner + (r - panel.span.lo).abs()).min(outer + (panel.span.hi - r).abs());
        here.max(self.wave)
    }

    /// The shortest of these lengths between two radii.
    pub fn shortest_between(&self, [a, b]: [f64; 2]) -> f64 {
        let list = self.panels.list();
        let (from, to) = (
            list.partition_point(|panel| panel.span.hi <= a),
            list.partition_point(|panel| panel.span.hi < b),
        );
        let between = self.local.get(from + 1..=to).unwrap_or_default().iter().copied();
        let ends = [a, b].map(|r| self.length_at(r));
        ends.into_iter().chain(between).fold(f64::INFINITY, f64::min).max(self.wave)
    }

    /// How many of these lengths lie between two radii.
    pub fn lengths_between(&self, [a, b]: [f64; 2]) -> f64 {
        if self.local.is_empty() {
            return (b - a) / self.wave;
        }
        let list = self.panels.list();
        let from = list.partition_point(|panel| panel.span.hi <= a);
        let on = list[from..].iter().take_while(|panel| panel.span.lo < b);
        on.map(|panel| {
            let (lo, hi) = (panel.span.lo.max(a), panel.span.hi.min(b));
            (hi - lo) / self.length_at(lo).min(self.length_at(hi))
        })
        .sum()
    }

    /// Radii at which the whole gap is sampled, ascending: closer together where it is fine.
    pub fn samples(&self) -> Vec<f64> {
        samples(&self.panels)
    }

    /// The largest tabulated radius.
    pub fn reach(&self) -> f64 {
        self.panels.reach()
    }

    /// The breaks at which steps of a path end: all of them, or only the corners where the breaks are many or the knots
    /// of a spline.
    pub fn stops(&self) -> &[f64] {
        const MANY: usize = 100;
        if self.spline || self.breaks.len() > MANY { &self.corners } else { &self.breaks }
    }

    /// Whether the gap falls away from the axis: the body has a corner there, which presses last, and never without
    /// adhesion.
    pub fn is_dimpled(&self) -> bool {
        self.gap.jet(1e-9 * self.wave).first < -1e-7
    }

    /// The breaks inside a ring, far enough from its edges to be distinct from them.
    pub fn inside(&self, [a, b]: [f64; 2]) -> &[f64] {
        const APART: f64 = 1e-9;
        let margin = APART * (b - a);
        let from = self.breaks.partition_point(|r| *r <= a + margin);
        let to = self.breaks.partition_point(|r| *r < b - margin);
        &self.breaks[from..to.max(from)]
    }

    /// Whether the angle of a ring is graded towards these breaks: not towards many, nor towards the knots of a spline, whose first
    /// two derivatives are continuous.
    pub fn grades(&self, breaks: &[f64]) -> bool {
        const MOST: usize = 6;
        breaks.len() <= MOST && !self.spline
    }

    /// g at a radius.
    pub fn transform(&self, a: f64) -> f64 {
        self.panels.value(self.panels.place(a))
    }

    /// dg/da at a radius, on the side towards the axis at a break.
    pub fn slope(&self, a: f64) -> f64 {
        if a > 0.0 { self.panels.values(self.panels.place(a)).slope } else { 0.0 }
    }

    /// The radius beyond which g > δ. Outside the last edge the gap can first become negative only where g < δ: by
    /// Abel's inversion, a gap ≥ 0 up to a radius and g > δ beyond it give a positive gap.
    pub fn can_touch_up_to(&self, delta: f64) -> f64 {
        if self.grows {
            // One panel may cover the whole gap, whose transform takes each value once.
            let [_, beyond] = root::halved(0.0, self.reach(), |a| self.transform(a) < delta);
            return if delta > 0.0 { beyond } else { 0.0 };
        }
        let after = self.least.partition_point(|least| *least < delta);
        (0..after).rev().find_map(|panel| self.last_below(panel, delta)).unwrap_or(0.0)
    }

    /// A radius on a panel beyond which g stays above δ, at most about twice as far from its inner end as need be; `None`
    /// where g stays above on the panel. A panel may be much wider than what can touch.
    fn last_below(&self, panel: usize, delta: f64) -> Option<f64> {
        const HALVINGS: usize = 30;
        let mut hi = 1.0;
        for _ in 0..HALVINGS {
            let middle = 0.5 * (hi - 1.0);
            if lowest(&self.panels, panel, [middle, hi]) < delta {
                return Some(self.panels.radius(Place { panel, x: hi }));
            }
            hi = middle;
        }
        None
    }

    /// ∫₀^s g/√(r² − a²) da for r ≥ `edge` > s as Σ w/√((r² − edge²) + below): [below, w].
    pub fn sum_below(&self, s: f64, edge: f64) -> Vec<[f64; 2]> {
        // A sum that needs more nodes than the maximum would not be resolved.
        let Some(wavenumber) = self.entire.filter(|k| k * edge < 400.0) else {
            return outside::sum_below(&self.panels, s, edge);
        };
        let under = DiscNodes::any(s, edge, wavenumber);
        let nodes = under.radius.iter().zip(&under.below).zip(&under.weight);
        nodes.map(|((a, below), weight)| [*below, weight * self.transform(*a)]).collect()
    }
}

/// Twice the width of the panels at their borders, made to grow no faster than the distance from the narrow ones, so
/// that an edge sees fine structure before it gets there.
fn local(panels: &Panels) -> Vec<f64> {
    let widths: Vec<f64> = panels.list().iter().map(|panel| panel.span.hi - panel.span.lo).collect();
    let n = widths.len();
    let beside = |k: usize| -> f64 {
        let around = [k.checked_sub(1), Some(k).filter(|k| *k < n)];
        2.0 * around.into_iter().flatten().map(|k| widths[k]).fold(f64::INFINITY, f64::min)
    };
    let mut lengths: Vec<f64> = (0..=n).map(beside).collect();
    for k in 1..=n {
        lengths[k] = lengths[k].min(lengths[k - 1] + widths[k - 1]);
    }
    for k in (0..n).rev() {
        lengths[k] = lengths[k].min(lengths[k + 1] + widths[k]);
    }
    lengths
}

/// Radii on all panels of a table, ascending, spaced as closely as the gap is fine.
fn samples(panels: &Panels) -> Vec<f64> {
    let list = panels.list();
    let each = (MOST_ON_PANELS / list.len().max(1)).clamp(ON_PANEL[0], ON_PANEL[1]);
    let on = |panel: &Panel| {
        let (lo, hi) = (panel.span.lo, panel.span.hi);
        (0..each).map(move |k| lo + (hi - lo) * (k as f64 + 0.5) / each as f64)
    };
    list.iter().flat_map(|panel| on(panel)).collect()
}

/// A lower bound of g between two places of a panel.
fn lowest(panels: &Panels, panel: usize, [from, to]: [f64; 2]) -> f64 {
    /// Places sampled, and what may be missed between them, as a share of the range.
    const PLACES: u32 = 24;
    const MISSED: f64 = 0.01;
    let values = (0..=PLACES).map(|k| {
        let x = from + (to - from) * f64::from(k) / f64::from(PLACES);
        panels.value(Place { panel, x })
    });
    let (lo, hi) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), g| (lo.min(g), hi.max(g)));
    lo - MISSED * (hi - lo)
}

/// The smallest g from the inner end of each panel outward: ascending.
fn least(panels: &Panels) -> Vec<f64> {
    let of = |panel| lowest(panels, panel, [-1.0, 1.0]);
    let mut least: Vec<f64> = (0..panels.list().len()).map(of).collect();
    for panel in (1..least.len()).rev() {
        least[panel - 1] = least[panel - 1].min(least[panel]);
    }
    least
}

/// The corners up to the radius `reach`, and stand-ins for λ and ρ.
///
/// ```text
/// λ = 2π max|h' − cr|/max|h'' − c|,  c the least-squares slope of h';      ρ = 1/max h''
/// ```
///
/// λ is at most twice the smallest distance between corners, and at most a fourth of the reach. Close to where a gap
/// ends, as at the equator of a sphere, h'' may grow without bound, which says nothing about the gap further in.
fn lengths(gap: &dyn Gap, panels: &Panels, breaks: &[f64]) -> (Vec<f64>, [f64; 2]) {
    let reach = panels.reach();
    let sampled = gap.largest_radius().map_or(reach, |end| reach.min(INSIDE * end));
    let even = (0..SAMPLES).map(|k| sampled * (f64::from(k) + 0.5) / f64::from(SAMPLES));
    let radii = even.clone().chain(samples(panels).into_iter().filter(|r| *r < sampled));
    let jets: Vec<(f64, [f64; 2])> = radii
        .map(|r| {
            let jet = gap.jet(r);
            (r, [jet.first, jet.second])
        })
        .filter(|(_, [first, second])| first.is_finite() && second.is_finite())
        .collect();
    let [mut moment, mut square] = [0.0; 2];
    // The slope of the whole, from even samples alone: fine parts must not get more than their share.
    for (r, [first, _]) in jets.iter().take(even.len()) {
        moment += r * first;
        square += r * r;
    }
    let slope = if square > 0.0 { moment / square } else { 0.0 };
    let [mut rise, mut bend, mut sharpest] = [0.0_f64; 3];
    for (r, [first, second]) in &jets {
        rise = rise.max((first - slope * r).abs());
        bend = bend.max((second - slope).abs());
        sharpest = sharpest.max(*second);
    }
    let jump = |b: f64| {
        let step = 1e-9 * reach;
        (gap.jet(b + step).first - gap.jet(b - step).first).abs() > 1e-6
    };
    let corners: Vec<f64> = breaks.iter().copied().filter(|b| breaks.len() < 1000 && jump(*b)).collect();
    let before = std::iter::once(0.0).chain(corners.iter().copied());
    let apart = before.zip(&corners).map(|(a, b)| b - a).fold(f64::INFINITY, f64::min);
    let own = if bend > 1e-9 * slope.abs() { TAU * rise / bend } else { f64::INFINITY };
    let wave = own.min(2.0 * apart).min(0.25 * reach);
    (corners, [wave, if sharpest > 0.0 { sharpest.recip() } else { reach }])
}
