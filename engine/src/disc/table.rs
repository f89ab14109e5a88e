//! The table of g: the transform of one gap, from which everything about one connected disc is read.
//!
//! ```text
//! g(a) = a ∫₀^{π/2} h'(a sin θ) dθ      with  g',  ∫₀ᵃ g,  ∫₀ᵃ g²
//! ```
//!
//! On panels that are proved to resolve h', and so g ([`panels`](crate::gap::panels)), each is a Chebyshev series;
//! powers of r have closed forms. A table belongs to a gap alone: adhesion, modulus, device and start are no part of
//! it. It reaches as far as requested. When more is requested it is made anew, in stages that do not depend on earlier
//! requests, so that the same question has the same answer to the last bit.
//!
//! I. N. Sneddon, Int. J. Eng. Sci. 3, 47 (1965), doi:10.1016/0020-7225(65)90019-4, eqs. (4.1)-(4.9), for g.

use super::blend::Blend;
use super::chebyshev::ChebyshevRule;
use super::clusters::NODES;
use super::law::PowerTransform;
use super::panels::{Panel, Panels};
use super::sources::Sources;
use super::spans::{TableError, graded};
use super::{cubic, outside, waves};
use crate::elementary::{exp2, log2, log10};
use crate::gap::{Form, Gap, Piece, Wave};
use crate::gap::{panels::Span, panels::Unresolved, panels::Variable, panels::divide};
use crate::progress::{Progress, Unwatched};
use std::collections::BTreeMap;
use std::fmt;
use std::num::NonZero;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

/// The smallest radius that matters, as a share of the largest one first requested.
const SMALLEST: f64 = 1e-5;

/// Panels of a gap with waves are half a wave wide; towards the axis each is a fourth as wide as the one before.
const WAVE_SHARE: f64 = 0.5;
const TOWARDS_AXIS: f64 = 4.0;

/// The panel of a cubic right of a knot is at most this many times as wide as the interval before it: 16 nodes then
/// leave an error of 1e-13.
const WIDER: f64 = 1.25;

/// The most panels of half a wave: a few hundred megabytes.
const MOST_WAVE_PANELS: f64 = 100_000.0;

/// Tables reach this close to the radius where the gap ends; a spline reaches its last knot.
const SHARE_OF_KNOWN: f64 = 0.999_999;

/// How much finer towards the axis each step in fineness is.
const FINER: f64 = 1e-3;

/// Waves times panels times angles beyond which waves are sampled like any other gap.
const MANY_WAVES: f64 = 3e7;

/// An error that is only rounding: no more digits are reported.
const ROUNDING: f64 = 1e-13;

/// Radii at which the table is checked against the gap itself.
const CHECKS: u32 = 6;

/// Tables kept, in addition to one for each core: each core may be at work on a gap of its own.
const KEPT: usize = 8;

/// The tables of the last gaps, each with its key.
pub type KeptTables<K> = Mutex<Vec<(K, Arc<Table>)>>;

/// How far panels reach and how finely they begin: nothing else decides them, so that an answer never depends on
/// earlier requests.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct TableStage {
    /// They reach to 2^(k/4), or to the end of the gap.
    reach: i32,
    /// The innermost ends at [`SMALLEST`]·[`FINER`]^m of that.
    fineness: i32,
}

/// The transform of one gap.
pub struct Table {
    gap: Arc<dyn Gap>,
    form: Form,
    /// What the gap is a mixture of, with the weights, where that is known.
    blend: Option<(Arc<Blend>, Vec<f64>)>,
    /// The panels requested so far.
    stages: Mutex<BTreeMap<TableStage, Arc<Panels>>>,
}

impl fmt::Debug for Table {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Table").field("gap", &self.gap).finish_non_exhaustive()
    }
}

impl Table {
    /// The table of `gap` up to the radius `reach`, or to where the gap ends.
    ///
    /// # Errors
    /// [`TableError`].
    pub fn new(gap: Arc<dyn Gap>, reach: f64, progress: &dyn Progress) -> Result<Self, TableError> {
        let form = gap.form();
        let table = Self { gap, form, blend: None, stages: Mutex::default() };
        table.up_to_while(reach, 0, progress)?;
        Ok(table)
    }

    /// The table of `gap`, which is the mixture of the gaps of `blend` with these weights.
    pub fn of_blend(gap: Arc<dyn Gap>, blend: &Arc<Blend>, weights: Vec<f64>) -> Self {
        let form = gap.form();
        Self { gap, form, blend: Some((Arc::clone(blend), weights)), stages: Mutex::default() }
    }

    /// The table of `gap`, which is the gap of `key`: made once, and shared while it is among the last ones requested.
    ///
    /// # Errors
    /// [`TableError`].
    pub fn shared<K: PartialEq + Clone + Send + 'static>(
        store: &KeptTables<K>,
        key: &K,
        gap: &Arc<dyn Gap>,
        reach: f64,
        progress: &dyn Progress,
    ) -> Result<Arc<Self>, TableError> {
        let lock = || store.lock().unwrap_or_else(PoisonError::into_inner);
        let known = {
            let mut kept = lock();
            let at = kept.iter().position(|(known, _)| known == key);
            at.map(|at| {
                let place = kept.len() - 1;
                kept[at..].rotate_left(1);
                Arc::clone(&kept[place].1)
            })
        };
        if let Some(table) = known {
            table.up_to_while(reach, 0, progress)?;
            return Ok(table);
        }
        // Not under the lock, and neither is anything that allocates or frees memory: another gap must not wait for
        // this one.
        let table = Arc::new(Self::new(Arc::clone(gap), reach, progress)?);
        let entry = (key.clone(), Arc::clone(&table));
        let oldest = {
            let mut kept = lock();
            let oldest = (kept.len() >= kept_at_most()).then(|| kept.remove(0));
            kept.push(entry);
            oldest
        };
        drop(oldest);
        Ok(table)
    }

    /// The gap.
    pub fn gap(&self) -> &Arc<dyn Gap> {
        &self.gap
    }

    /// The largest radius that a table of the gap can have; infinite where the gap is known everywhere.
    pub fn end(&self) -> f64 {
        let share = if matches!(self.form, Form::Cubic(_)) { 1.0 } else { SHARE_OF_KNOWN };
        self.gap.largest_radius().map_or(f64::INFINITY, |known| share * known)
    }

    /// Whether the curve has a corner at the contact radius `s`, to rounding: the slope of the gap jumps there.
    pub fn has_corner(&self, s: f64) -> bool {
        const ROUNDING: f64 = 1e-15;
        if matches!(self.form, Form::Power { .. } | Form::Waves { .. }) {
            return false;
        }
        let Ok(panels) = self.up_to(s * (1.0 + 1e-9)) else { return false };
        let at = panels.place(s).panel;
        let near = panels.list().iter().skip(at).take(2);
        near.into_iter()
            .any(|panel| panel.is_steep() && panel.span.lo > 0.0 && (panel.span.lo - s).abs() <= ROUNDING * s)
    }

    /// The panels up to `reach`, or to where the gap ends.
    ///
    /// # Errors
    /// [`TableError::TooFine`].
    pub fn up_to(&self, reach: f64) -> Result<Arc<Panels>, TableError> {
        self.up_to_while(reach, 0, &Unwatched)
    }

    /// The panels up to `reach`, or a little further; each step in `fineness` begins them a thousandth as far out. `progress` is asked
    /// now and then.
    ///
    /// # Errors
    /// [`TableError`].
    pub fn up_to_while(
        &self,
        reach: f64,
        fineness: i32,
        progress: &dyn Progress,
    ) -> Result<Arc<Panels>, TableError> {
        let end = self.end();
        let whole = reach >= end || matches!(self.form, Form::Cubic(_));
        // A positive number has a binary logarithm of about a thousand at most.
        #[expect(clippy::cast_possible_truncation)]
        let steps = (4.0 * log2(reach.max(f64::MIN_POSITIVE)) - 1e-9).ceil() as i32;
        let stage = TableStage { reach: if whole { i32::MAX } else { steps }, fineness };
        let lock = || self.stages.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(known) = lock().get(&stage) {
            return Ok(Arc::clone(known));
        }
        // Not under the lock: another radius must not wait for this one.
        let reach = if whole { end } else { exp2(0.25 * f64::from(steps)).max(reach).min(end) };
        let law = match self.form {
            Form::Power { factor, exponent } => Some(PowerTransform::new(factor, exponent)),
            _ => None,
        };
        let smallest = SMALLEST * FINER.powi(fineness) * reach;
        let mut panels =
            Panels { list: Vec::new(), law, smallest, digits: OnceLock::new(), moments: OnceLock::new() };
        self.fill(&mut panels, reach, progress)?;
        let panels = Arc::new(panels);
        lock().insert(stage, Arc::clone(&panels));
        Ok(panels)
    }

    fn fill(&self, panels: &mut Panels, reach: f64, progress: &dyn Progress) -> Result<(), TableError> {
        if let Some((blend, weights)) = &self.blend {
            return blend.fill(weights, panels, reach, progress);
        }
        match &self.form {
            Form::Power { exponent, .. } => {
                let spans = PowerTransform::spans(*exponent, reach, panels.smallest);
                panels.list.extend(spans.into_iter().map(|span| Arc::new(Panel::closed(span))));
            }
            Form::Cubic(pieces) => {
                let pieces = &parted(pieces, panels.smallest);
                let samples = cubic::transform(pieces, 0, progress)?;
                let rule = ChebyshevRule::of(cubic::NODES);
                for (piece, [value, by_variable]) in pieces.iter().zip(samples) {
                    let span =
                        Span { lo: piece.lo, hi: piece.hi, variable: Variable::Root { base: piece.lo } };
                    let mut slope = by_variable;
                    for (slope, x) in slope.iter_mut().zip(&rule.nodes) {
                        *slope /= span.stretch(*x);
                    }
                    panels.push(span, rule, &value, &slope, false);
                }
                panels.smallest = pieces.first().map_or(0.0, |piece| piece.hi);
            }
            Form::Waves { curvature, waves } if few(waves, reach) => {
                let spans = wave_spans(waves, reach, panels.smallest)?;
                let samples = waves::transform(*curvature, waves, &spans, progress)?;
                let rule = ChebyshevRule::of(waves::NODES);
                for (span, [value, slope]) in spans.into_iter().zip(samples) {
                    panels.push(span, rule, &value, &slope, false);
                }
            }
            form => {
                let breaks = self.gap.breaks_up_to(reach);
                let spans = match form {
                    Form::Waves { waves, .. } => wave_spans(waves, reach, panels.smallest)?,
                    _ => graded(
                        &*self.gap,
                        divide(&*self.gap, [0.0, reach], panels.smallest, &breaks)
                            .map_err(TableError::TooFine)?,
                    ),
                };
                let sampled = Sources::new(&*self.gap, &spans, &breaks, progress)?;
                let rule = ChebyshevRule::of(NODES);
                for span in spans {
                    progress.go_on()?;
                    let [mut value, mut slope] = [[0.0; NODES]; 2];
                    for (j, x) in rule.nodes.iter().enumerate() {
                        [value[j], slope[j]] = sampled.transform(&*self.gap, &span, *x);
                    }
                    let steep = span.is_steep(|base| sampled.jumps_at(base));
                    panels.push(span, rule, &value, &slope, steep);
                }
            }
        }
        Ok(())
    }

    /// Decimal digits of g on `panels`, as found at a few radii where the gap itself is compared with the one that the
    /// table gives.
    ///
    /// ```text
    /// h(r) = (2/π) ∫₀ʳ g(a)/√(r² − a²) da
    /// ```
    pub fn digits(&self, panels: &Panels) -> f64 {
        /// The golden ratio spreads the radii evenly, whatever their number.
        const SPREAD: f64 = 0.618_033_988_749_894_9;
        *panels.digits.get_or_init(|| {
            let reach = panels.reach();
            let error = (1..=CHECKS)
                .map(|k| {
                    let r = reach * (f64::from(k) * SPREAD).fract();
                    let exact = self.gap.jet(r).value;
                    let size = exact.abs().max(panels.value(panels.place(r)).abs());
                    if size > 0.0 {
                        (outside::gap_from(panels, 0.0, 0.0, r) - exact).abs() / size
                    } else {
                        0.0
                    }
                })
                .fold(0.0, |worst: f64, error| if error.is_nan() { f64::INFINITY } else { worst.max(error) });
            -log10(error.clamp(ROUNDING, 1.0))
        })
    }
}

/// How many tables are kept.
fn kept_at_most() -> usize {
    static CORES: OnceLock<usize> = OnceLock::new();
    KEPT + *CORES.get_or_init(|| std::thread::available_parallelism().map_or(1, NonZero::get))
}

/// Whether each wave may be transformed by itself.
fn few(waves: &[Wave], reach: f64) -> bool {
    let steepest = waves.iter().fold(0.0_f64, |most, wave| most.max(wave.wavenumber));
    let phase = steepest * reach;
    waves.len() as f64 * phase * phase <= MANY_WAVES
}

/// The pieces, split so that a panel resolves each.
///
/// The first, which begins at the axis, is split until its innermost part ends at `smallest` or below: the innermost
/// panel needs only discs that are too small to be stable. On the panel right of a knot the transform is smooth in the
/// root of the distance from that knot, but not at the knot before: a panel much wider than the interval before it is
/// split into parts, each as wide as its distance from the knot.
fn parted(pieces: &[Piece], smallest: f64) -> Vec<Piece> {
    let Some(first) = pieces.first() else { return Vec::new() };
    let inward = |outer: &f64| (*outer > smallest).then(|| outer / TOWARDS_AXIS);
    let mut ends: Vec<f64> = std::iter::successors(Some(first.hi), inward).collect();
    ends.push(first.lo);
    ends.reverse();
    let mut parted = Vec::with_capacity(pieces.len() + ends.len());
    parted.extend(ends.windows(2).map(|ends| part(first, [ends[0], ends[1]])));
    for pair in pieces.windows(2) {
        let (before, Piece { lo: knot, hi, .. }) = (pair[0], pair[1]);
        let mut lo = knot;
        let mut width = knot - before.lo;
        while hi - lo > WIDER * width {
            parted.push(part(&pair[1], [lo, lo + width]));
            lo += width;
            width = lo - knot;
        }
        parted.push(part(&pair[1], [lo, hi]));
    }
    parted
}

/// A part of a piece.
fn part(piece: &Piece, [lo, hi]: [f64; 2]) -> Piece {
    let [c0, c1, c2] = piece.slope;
    let t = lo - piece.lo;
    Piece { lo, hi, slope: [c0 + t * (c1 + t * c2), c1 + 2.0 * t * c2, c2] }
}

/// Panels of half the shortest wave, and towards the axis each a fourth as wide as the one before.
fn wave_spans(waves: &[Wave], reach: f64, smallest: f64) -> Result<Vec<Span>, TableError> {
    let steepest = waves.iter().fold(0.0_f64, |most, wave| most.max(wave.wavenumber));
    let span = |lo, hi| Span { lo, hi, variable: Variable::Radius };
    // Without waves g is a parabola, and any width will do.
    let width = if steepest > 0.0 { WAVE_SHARE * std::f64::consts::TAU / steepest } else { reach };
    // With few enough bits that its multiples are exact: panels of one width share their angles.
    let width = f64::from_bits(width.to_bits() & !0xffff);
    let radius = MOST_WAVE_PANELS * width;
    if radius < reach {
        return Err(TableError::TooFine(Unresolved { radius, largest: reach, panels: MOST_WAVE_PANELS }));
    }
    let mut spans = Vec::new();
    let mut lo = 0.0;
    let mut inner = vec![width];
    while inner.last().is_some_and(|hi| *hi > smallest) {
        inner.push(inner[inner.len() - 1] / TOWARDS_AXIS);
    }
    inner.reverse();
    for hi in inner {
        spans.push(span(lo, hi));
        lo = hi;
    }
    let mut k = (lo / width).round();
    while lo < reach {
        k += 1.0;
        let hi = width * k;
        spans.push(span(lo, hi));
        lo = hi;
    }
    Ok(spans)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gap::{Jet, Shape};
    use crate::gap::{formula::FormulaParameter, formula::TypedGap};
    use crate::gap::{
        shapes::ExactSphere, shapes::Harmonic, shapes::Harmonics, shapes::PowerLaw, shapes::ProfileGap,
        shapes::Smoothing,
    };
    use std::f64::consts::{FRAC_PI_2, PI};

    fn formula(text: &str) -> Arc<dyn Gap> {
        let none: Vec<FormulaParameter> = Vec::new();
        Arc::new(Shape::Formula(Arc::new(TypedGap::new(text, none, Some(0.6)).unwrap())))
    }

    fn made(gap: &Arc<dyn Gap>, reach: f64) -> Table {
        Table::new(Arc::clone(gap), reach, &Unwatched).unwrap()
    }

    /// ∫₀^{π/2} f(a sin θ) dθ by Gauss's rule on many even pieces, broken at `breaks`.
    fn angle_mean(a: f64, breaks: &[f64], f: impl Fn(f64) -> f64) -> f64 {
        let inside = breaks.iter().filter(|b| **b < a).map(|b| (b / a).asin());
        let borders: Vec<f64> = std::iter::once(0.0).chain(inside).chain([FRAC_PI_2]).collect();
        let pieces = borders.windows(2).flat_map(|pair| {
            let (from, to) = (pair[0], pair[1]);
            (0..400).map(move |k| {
                let at = |k: i32| from + (to - from) * f64::from(k) / 400.0;
                (at(k), at(k + 1))
            })
        });
        pieces
            .map(|(from, to)| {
                let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
                let node = |[x, weight]: &[f64; 2]| half * weight * f(a * (middle + half * x).sin());
                crate::disc::sources::GAUSS.iter().map(node).sum::<f64>()
            })
            .sum()
    }

    #[test]
    fn a_corner_is_seen_where_both_sides_are_equal_to_rounding() {
        // h' = 0.48 up to q and 0.43 beyond: g = s (0.43 π/2 + 0.05 arcsin(q/s)) there, whose slope has no bound at q.
        let q = 0.21_f64;
        for text in ["min(0.43*r, 0.48*r-0.0105)", "min(0.48*r-0.0105, 0.43*r)", "0.48*r-0.05*max(r-0.21, 0)"]
        {
            let panels = made(&formula(text), 0.5).up_to(0.5).unwrap();
            for beyond in [1e-9, 1e-6, 1e-3, 0.1, 1.0] {
                let s = q * (1.0 + beyond);
                let [[value, _, slope]] = panels.values_at(&[s]);
                let of_angle = 0.43 * FRAC_PI_2 + 0.05 * (q / s).asin();
                let exact = of_angle - 0.05 * q / (s * s - q * q).sqrt();
                assert!((value / (s * of_angle) - 1.0).abs() < 1e-11, "{text} {beyond}: {value}");
                assert!((slope / exact - 1.0).abs() < 1e-6, "{text} {beyond}: {slope} {exact}");
            }
        }
    }

    #[test]
    fn g_and_its_integrals_are_those_of_a_plain_quadrature() {
        let waves = [(0.003, 0.07, 0.0), (-0.001, 0.2, 1.1)];
        let waves = waves.map(|(amplitude, wavelength, phase)| Harmonic { amplitude, wavelength, phase });
        let cases: Vec<(&str, Arc<dyn Gap>, Vec<f64>)> = vec![
            ("waves", Arc::new(Harmonics::new(0.8, waves.to_vec()).unwrap()), vec![]),
            ("sphere", Arc::new(ExactSphere { radius: 1.0 }), vec![]),
            ("power", Arc::new(PowerLaw { factor: 0.4, exponent: 3.0 }), vec![]),
            ("bump", formula("r^2/2 + 0.0025*exp(-((r-0.3)/0.01)^2)"), vec![]),
            ("corner", formula("r^2/2 + 0.07*abs(r-0.12)"), vec![0.12]),
            ("triangle", formula("r^2/2 + 0.5*max(0.0008 - abs(r-0.3), 0)"), vec![0.2992, 0.3, 0.3008]),
            ("bend", formula("r^2/2 + max(r-0.2, 0)^2"), vec![0.2]),
        ];
        for (name, gap, breaks) in cases {
            let table = made(&gap, 0.55);
            let panels = table.up_to(0.55).unwrap();
            assert!(table.digits(&panels) > 12.5, "{name}: {}", table.digits(&panels));
            for a in [0.013, 0.11, 0.125, 0.25, 0.297, 0.3004, 0.33, 0.5] {
                let ours = panels.values(panels.place(a));
                let exact = a * angle_mean(a, &breaks, |r| gap.jet(r).first);
                assert!(
                    (ours.value - exact).abs() <= 1e-13 * exact.abs().max(a * a),
                    "{name} {a}: {ours:?} {exact}"
                );
                // ∫₀ᵃ g = ∫₀ᵃ h' √(a² − r²) dr = a² ∫ h' cos²θ dθ.
                let area = a * a * angle_mean(a, &breaks, |r| gap.jet(r).first * (1.0 - (r / a).powi(2)));
                assert!((ours.area - area).abs() <= 1e-13 * a.powi(3), "{name} {a}: {ours:?} {area}");
                // The slope and the square by differences and by halving steps of the value.
                let step = 1e-5 * a;
                let [lo, hi] = [a - step, a + step].map(|a| panels.values(panels.place(a)));
                let slope = (hi.value - lo.value) / (2.0 * step);
                assert!(
                    (ours.slope - slope).abs() <= 2e-4 * slope.abs().max(a),
                    "{name} {a}: {ours:?} {slope}"
                );
                let square = (hi.square - lo.square) / (2.0 * step);
                assert!(
                    (ours.value.powi(2) - square).abs() <= 1e-4 * square.abs().max(a.powi(4)),
                    "{name} {a}"
                );
            }
        }
    }

    #[test]
    fn an_answer_does_not_depend_on_what_was_asked_before() {
        for gap in [
            formula("r^2/2 + 0.07*abs(r-0.12) + 0.01*abs(r-0.4)"),
            Arc::new(Shape::WavySphere { radius_of_curvature: 1.0, amplitude: 0.0025, wavelength: 0.05 }),
            Arc::new(PowerLaw { factor: 0.4, exponent: 1.7 }),
        ] {
            let (asked, fresh) = (made(&gap, 0.2), made(&gap, 0.9));
            for reach in [0.25, 0.5, 0.61] {
                asked.up_to(reach).unwrap();
            }
            for reach in [0.3, 0.55] {
                let [x, y] = [&asked, &fresh].map(|table| table.up_to(reach).unwrap());
                for k in 1..=30 {
                    let a = 0.01 * f64::from(k);
                    assert_eq!(x.values(x.place(a)), y.values(y.place(a)), "{gap:?} {a}");
                }
            }
        }
    }

    #[test]
    fn known_transforms_in_closed_form() {
        // A cone of slope c: πca/2; a paraboloid: a²/R; a sphere: a artanh(a/R).
        let cone: Arc<dyn Gap> = Arc::new(PowerLaw::cone(0.3));
        let table = made(&cone, 1.0);
        let panels = table.up_to(1.0).unwrap();
        let at = |a: f64| panels.values(panels.place(a));
        assert!((at(0.37).value / (0.5 * PI * 0.3 * 0.37) - 1.0).abs() < 1e-15);
        let sphere: Arc<dyn Gap> = Arc::new(ExactSphere { radius: 1.0 });
        let table = made(&sphere, 0.99);
        for a in [1e-4, 0.3, 0.9, 0.99] {
            let panels = table.up_to(0.99).unwrap();
            let at = panels.values(panels.place(a));
            assert!((at.value / (a * a.atanh()) - 1.0).abs() < 1e-13, "{a}: {}", at.value);
        }
        assert!(table.up_to(2.0).unwrap().reach() < 1.0);
    }

    #[test]
    fn a_corner_is_a_border_and_known_as_one() {
        let table = made(&formula("r^2/2 + 0.07*abs(r-0.12)"), 0.5);
        assert!(table.has_corner(0.12) && !table.has_corner(0.13) && !table.has_corner(0.5));
        let smooth = made(&formula("r^2/2 + max(r-0.12, 0)^3"), 0.5);
        assert!(!smooth.has_corner(0.12));
    }

    #[test]
    fn a_profile_ends_with_its_last_row() {
        let radii: Vec<f64> = (0..60).map(|i| 0.01 * f64::from(i)).collect();
        let gaps: Vec<f64> = radii.iter().map(|r| r * r / 2.0 + 1e-3 * (30.0 * r).cos()).collect();
        let profile = ProfileGap::new(&radii, &gaps, Smoothing::None).unwrap();
        let knots = profile.knots()[1..].to_vec();
        let gap: Arc<dyn Gap> = Arc::new(profile);
        let table = made(&gap, 0.3);
        let panels = table.up_to(5.0).unwrap();
        assert!((panels.reach() - 0.59).abs() < 1e-12 && table.digits(&panels) > 12.5);
        for a in [0.005, 0.2, 0.345, 0.59] {
            let exact = a * angle_mean(a, &knots, |r| gap.jet(r).first);
            let ours = panels.value(panels.place(a));
            assert!((ours - exact).abs() <= 1e-14 * a * a, "{a}: {ours} {exact}");
        }
    }

    #[test]
    fn a_wrong_table_has_no_digits() {
        /// A paraboloid whose slope does not match its values.
        #[derive(Debug)]
        struct Wrong;

        impl Gap for Wrong {
            fn jet(&self, r: f64) -> Jet {
                Jet { value: r * r / 2.0, first: r * (1.0 + 1e-6), second: 1.0, third: 0.0 }
            }

            fn feature_length(&self) -> Option<f64> {
                None
            }

            fn reference_length(&self) -> f64 {
                1.0
            }
        }

        let gap: Arc<dyn Gap> = Arc::new(Wrong);
        let table = made(&gap, 0.5);
        let digits = table.digits(&table.up_to(0.5).unwrap());
        assert!((5.5..6.5).contains(&digits), "{digits}");
    }
}
