//! The equivalent profile of a gap that is a cubic between its knots, on one panel for each piece.
//!
//! ```text
//! g(a) = a ∫₀^a h'(r)/√(a² − r²) dr        g'(a) = ∫₀^a (h' + r h'')/√(a² − r²) dr
//! ```
//!
//! The integrals over one piece are known in closed form, but those of narrow pieces are small differences of large
//! numbers: with 1000 knots they leave nine digits, with 100 000 four. Gauss's rule keeps all digits, provided that it
//! takes only differences without cancellation. With a = lo + y² on the panel of the knot lo, a − r is y² and
//! differences of knots. Pieces closer than their width are near, and r = a is the singularity:
//!
//! | piece | how |
//! |---|---|
//! | the panel's own and near ones, with r = a far from the axis | z = √(a − r): dr/√(a² − r²) = −2dz/√(a + r), r − lo = (z₁ − z)(z₁ + z) |
//! | the same near the axis | r = a cos φ: dr/√(a² − r²) = −dφ, r − lo = 2a sin((φ₁ + φ)/2) sin((φ₁ − φ)/2) |
//! | any other | Gauss's rule in r: the singularity is at least the width away |
//!
//! To keep the cost of many pieces from growing with their square, the samples of 8, 16, 32, … neighbours are spread
//! onto 20 Chebyshev points of their block, from which they are seen by panels at least the width of the block away.
//! The weights are those of the interpolation of the kernel 1/√(a² − r²), transposed. The singularity of the kernel
//! leaves an error of 5.8⁻²⁰.

use crate::elementary::{atan2, cos, sin};
use crate::gap::Piece;
use crate::progress::{Progress, Stopped};
use gauss_quad::GaussLegendre;
use std::array;
use std::f64::consts::PI;
use std::num::NonZeroUsize;
use wide::f64x4;

/// Nodes of a panel.
pub const NODES: usize = 16;

/// Nodes of Gauss's rule on a piece, in any of the variables. A singularity as far away as the piece is wide leaves an
/// error of 5.8⁻²⁰.
const SAMPLES: usize = 10;
const RULE: NonZeroUsize = NonZeroUsize::new(SAMPLES).unwrap();

/// Chebyshev points of a block.
const POINTS: usize = 20;

/// Pieces of the smallest block; every further level has twice as many.
const SMALLEST_BLOCK: usize = 8;

/// The largest (a − lo)/a for which a piece is taken in z: the singularity of 1/√(a + r) is then so far that it leaves
/// an error of 9⁻²⁰.
const FAR_FROM_AXIS: f64 = 0.25;

/// Panels between two checks whether to go on.
const PANELS_PER_QUESTION: usize = 32;

/// Four nodes at a time.
const LANES: usize = NODES / 4;

impl Piece {
    fn width(&self) -> f64 {
        self.hi - self.lo
    }

    /// h' at lo + t.
    fn slope(&self, t: f64) -> f64 {
        let [c0, c1, c2] = self.slope;
        c0 + t * (c1 + t * c2)
    }

    /// h'' there.
    fn bend(&self, t: f64) -> f64 {
        let [_, c1, c2] = self.slope;
        c1 + 2.0 * t * c2
    }
}

/// The nodes of a panel as shares of its largest y, which is √(hi − lo): Chebyshev's of the first kind, descending.
pub fn nodes() -> [f64; NODES] {
    // (1 + cos x)/2 as a square keeps the digits of the small ones.
    array::from_fn(|j| cos(PI * (2 * j + 1) as f64 / (4 * NODES) as f64).powi(2))
}

/// g and dg/dy, y = √(a − lo), at the [`nodes`] of every piece of `pieces[from..]`; `progress` is asked now and then.
///
/// The pieces begin at the axis, each where the one before ends, and h' does not jump between them: a jump would need a
/// term in dg/dy. h' on the axis may have any value.
///
/// # Errors
/// [`Stopped`].
pub fn transform(
    pieces: &[Piece],
    from: usize,
    progress: &dyn Progress,
) -> Result<Vec<[[f64; NODES]; 2]>, Stopped> {
    let sources = PieceSamples::new(pieces);
    let nodes = nodes();
    let mut panels = Vec::with_capacity(pieces.len().saturating_sub(from));
    for (i, piece) in pieces.iter().enumerate().skip(from) {
        if (i - from).is_multiple_of(PANELS_PER_QUESTION) {
            progress.go_on()?;
        }
        let y = nodes.map(|x| x * piece.width().sqrt());
        let mut panel = PanelSums::new(piece.lo, &y);
        sources.gather(&mut panel, i);
        panels.push(panel.finish(&y));
    }
    Ok(panels)
}

/// The nodes of a panel and the sums there: ∫h'/√(a² − r²) dr and ∫r h''/√(a² − r²) dr.
struct PanelSums {
    lo: f64,
    /// a − lo.
    from_lo: [f64x4; LANES],
    a: [f64x4; LANES],
    sums: [[f64x4; LANES]; 2],
}

impl PanelSums {
    fn new(lo: f64, y: &[f64; NODES]) -> Self {
        let four = |k: usize| f64x4::new(array::from_fn(|lane| y[4 * k + lane]));
        let from_lo = array::from_fn(|k| four(k) * four(k));
        Self { lo, from_lo, a: from_lo.map(|x| x + f64x4::splat(lo)), sums: [[f64x4::ZERO; LANES]; 2] }
    }

    fn finish(self, y: &[f64; NODES]) -> [[f64; NODES]; 2] {
        let flat = |four: [f64x4; LANES]| -> [f64; NODES] {
            let four = four.map(f64x4::to_array);
            array::from_fn(|j| four[j / 4][j % 4])
        };
        let a = flat(self.a);
        let [slope, bend] = self.sums.map(flat);
        [array::from_fn(|j| a[j] * slope[j]), array::from_fn(|j| 2.0 * y[j] * (slope[j] + bend[j]))]
    }

    /// Adds the contribution of samples that lie at a distance from all nodes.
    fn add<const N: usize>(&mut self, samples: &WeightedSamples<N>) {
        let distance = f64x4::splat(self.lo - samples.lo);
        let offset: [f64x4; LANES] = self.from_lo.map(|x| x + distance);
        for (&t, (&slope, &bend)) in
            samples.offsets.iter().zip(samples.weights[0].iter().zip(&samples.weights[1]))
        {
            let (r, t) = (f64x4::splat(samples.lo + t), f64x4::splat(t));
            let (slope, bend) = (f64x4::splat(slope), f64x4::splat(bend));
            for (k, offset) in offset.iter().enumerate() {
                let kernel = f64x4::ONE / ((*offset - t) * (self.a[k] + r)).sqrt();
                self.sums[0][k] += slope * kernel;
                self.sums[1][k] += bend * kernel;
            }
        }
    }

    /// Adds the contribution of `piece`, which is near the nodes or, if `own`, holds them.
    fn add_near(&mut self, rule: &[(f64, f64)], piece: &Piece, own: bool) {
        // The first node is the outermost, where (a − lo)/a is largest.
        let outermost = self.a[0].to_array()[0];
        if outermost - piece.lo <= FAR_FROM_AXIS * outermost {
            self.add_in_root(rule, piece, own);
        } else {
            self.add_in_angle(rule, piece, own);
        }
    }

    /// The variable z = √(a − r).
    fn add_in_root(&mut self, rule: &[(f64, f64)], piece: &Piece, own: bool) {
        let [lo, c0, c1, c2] = [piece.lo, piece.slope[0], piece.slope[1], piece.slope[2]].map(f64x4::splat);
        let (two, width) = (f64x4::splat(2.0), f64x4::splat(piece.width()));
        let (to_lo, to_hi) = (f64x4::splat(self.lo - piece.lo), f64x4::splat(self.lo - piece.hi));
        for k in 0..LANES {
            let outer = (self.from_lo[k] + to_lo).sqrt();
            let (inner, length) = if own {
                (f64x4::ZERO, outer)
            } else {
                let inner = (self.from_lo[k] + to_hi).sqrt();
                (inner, width / (outer + inner))
            };
            for &(x, weight) in rule {
                let below = length * f64x4::splat(1.0 - x);
                let t = below * (outer + inner + length * f64x4::splat(x));
                let r = lo + t;
                let kernel = f64x4::splat(2.0 * weight) * length / (self.a[k] + r).sqrt();
                self.sums[0][k] += kernel * (c0 + t * (c1 + t * c2));
                self.sums[1][k] += kernel * r * (c1 + two * t * c2);
            }
        }
    }

    /// The variable φ = arccos(r/a).
    fn add_in_angle(&mut self, rule: &[(f64, f64)], piece: &Piece, own: bool) {
        for k in 0..LANES {
            let (from_lo, a) = (self.from_lo[k].to_array(), self.a[k].to_array());
            let (mut slopes, mut bends) = ([0.0; 4], [0.0; 4]);
            for lane in 0..4 {
                let a = a[lane];
                // √(a² − r²) where the piece begins and where it ends.
                let begin = ((from_lo[lane] + (self.lo - piece.lo)) * (a + piece.lo)).sqrt();
                let (hi, width, end) = if own {
                    (a, from_lo[lane], 0.0)
                } else {
                    let end = ((from_lo[lane] + (self.lo - piece.hi)) * (a + piece.hi)).sqrt();
                    (piece.hi, piece.width(), end)
                };
                let largest = atan2(begin, piece.lo);
                // From sin(φ₁ − φ₀) = (r₀√(a² − r₁²) − r₁√(a² − r₀²))/a², times the sum of the two.
                let sine = a * width * ((hi + piece.lo) / (begin * hi + end * piece.lo)) * a;
                let length = atan2(sine, hi * piece.lo + begin * end);
                for &(x, weight) in rule {
                    let below = length * (1.0 - x);
                    let t = 2.0 * a * sin(largest - 0.5 * below) * sin(0.5 * below);
                    let weight = weight * length;
                    slopes[lane] += weight * piece.slope(t);
                    bends[lane] += weight * (piece.lo + t) * piece.bend(t);
                }
            }
            self.sums[0][k] += f64x4::new(slopes);
            self.sums[1][k] += f64x4::new(bends);
        }
    }
}

/// Weighted samples of h' and of r h'' that stand for an integral over [lo, hi].
struct WeightedSamples<const N: usize> {
    lo: f64,
    hi: f64,
    /// r − lo.
    offsets: [f64; N],
    weights: [[f64; N]; 2],
}

impl WeightedSamples<SAMPLES> {
    /// Gauss's rule on a piece.
    fn of_piece(piece: &Piece, rule: &[(f64, f64)]) -> Self {
        let offsets = array::from_fn(|k| piece.width() * rule[k].0);
        let weight = |k: usize| piece.width() * rule[k].1;
        let slope = array::from_fn(|k| weight(k) * piece.slope(offsets[k]));
        let bend = array::from_fn(|k| weight(k) * (piece.lo + offsets[k]) * piece.bend(offsets[k]));
        Self { lo: piece.lo, hi: piece.hi, offsets, weights: [slope, bend] }
    }
}

impl WeightedSamples<POINTS> {
    /// The samples of neighbours, as seen from afar.
    fn of_block<const N: usize>(parts: &[WeightedSamples<N>], points: &[(f64, f64); POINTS]) -> Self {
        let (lo, hi) = (parts[0].lo, parts[parts.len() - 1].hi);
        let offsets = points.map(|(x, _)| x * (hi - lo));
        let mut weights = [[0.0; POINTS]; 2];
        for part in parts {
            for k in 0..N {
                let t = (part.lo - lo) + part.offsets[k];
                let [slope, bend] = [part.weights[0][k], part.weights[1][k]];
                let hit = offsets.iter().position(|point| (t - point).abs() == 0.0);
                let shares: [f64; POINTS] = if let Some(hit) = hit {
                    array::from_fn(|m| if m == hit { 1.0 } else { 0.0 })
                } else {
                    let raw: [f64; POINTS] = array::from_fn(|m| points[m].1 / (t - offsets[m]));
                    let total: f64 = raw.iter().sum();
                    raw.map(|share| share / total)
                };
                for (m, share) in shares.iter().enumerate() {
                    weights[0][m] += share * slope;
                    weights[1][m] += share * bend;
                }
            }
        }
        Self { lo, hi, offsets, weights }
    }
}

/// All pieces as samples, and their blocks.
struct PieceSamples<'a> {
    pieces: &'a [Piece],
    /// Gauss's rule on (0, 1).
    rule: Vec<(f64, f64)>,
    samples: Vec<WeightedSamples<SAMPLES>>,
    /// Blocks of 8, 16, 32, … pieces, with fewer in the last block of a level, up to the level with one block.
    levels: Vec<Vec<WeightedSamples<POINTS>>>,
}

impl<'a> PieceSamples<'a> {
    fn new(pieces: &'a [Piece]) -> Self {
        let rule = GaussLegendre::new(RULE);
        let rule: Vec<_> = rule.iter().map(|&(x, weight)| (0.5 * (1.0 + x), 0.5 * weight)).collect();
        // Chebyshev's points on (0, 1) with their barycentric weights.
        let points: [(f64, f64); POINTS] = array::from_fn(|m| {
            let angle = PI * (2 * m + 1) as f64 / (4 * POINTS) as f64;
            let sign = if m % 2 == 0 { 1.0 } else { -1.0 };
            (cos(angle).powi(2), sign * sin(2.0 * angle))
        });
        let samples: Vec<_> = pieces.iter().map(|piece| WeightedSamples::of_piece(piece, &rule)).collect();
        let mut levels: Vec<Vec<WeightedSamples<POINTS>>> = vec![
            samples.chunks(SMALLEST_BLOCK).map(|parts| WeightedSamples::of_block(parts, &points)).collect(),
        ];
        while let Some(below) = levels.last().filter(|level| level.len() > 1) {
            let above = below.chunks(2).map(|parts| WeightedSamples::of_block(parts, &points)).collect();
            levels.push(above);
        }
        Self { pieces, rule, samples, levels }
    }

    /// Adds everything up to the nodes of `panel`, the panel of the piece `i`.
    fn gather(&self, panel: &mut PanelSums, i: usize) {
        self.gather_block(panel, i, self.levels.len() - 1, 0);
        panel.add_near(&self.rule, &self.pieces[i], true);
    }

    /// Adds the part of a block that lies before the piece `i`.
    fn gather_block(&self, panel: &mut PanelSums, i: usize, level: usize, k: usize) {
        let pieces = SMALLEST_BLOCK << level;
        if k * pieces >= i {
            return;
        }
        let block = &self.levels[level][k];
        if panel.lo - block.hi >= block.hi - block.lo {
            panel.add(block);
        } else if level > 0 {
            for half in [2 * k, 2 * k + 1] {
                self.gather_block(panel, i, level - 1, half);
            }
        } else {
            for j in k * pieces..i.min((k + 1) * pieces) {
                let piece = &self.pieces[j];
                if panel.lo - piece.hi >= piece.width() {
                    panel.add(&self.samples[j]);
                } else {
                    panel.add_near(&self.rule, piece, false);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::progress::Unwatched;
    use std::cell::Cell;
    use std::f64::consts::FRAC_PI_2;

    /// Uneven knots: the widths of neighbours differ by up to `ratio`.
    fn knots(n: usize, ratio: f64, random: &mut fastrand::Rng) -> Vec<f64> {
        let mut r = 0.0;
        let mut knots = vec![0.0];
        for _ in 0..n {
            r += ratio.powf(random.f64()) / n as f64;
            knots.push(r);
        }
        knots
    }

    /// Random pieces between which h' does not jump, with a slope at the axis.
    fn rough(knots: &[f64], random: &mut fastrand::Rng) -> Vec<Piece> {
        let last = knots[knots.len() - 1];
        let mut begin = 0.5;
        let piece = |pair: &[f64]| {
            let w = pair[1] - pair[0];
            let end = pair[1] / last + 0.4 * random.f64();
            let c2 = (random.f64() - 0.5) / (w * w);
            let piece = Piece { lo: pair[0], hi: pair[1], slope: [begin, (end - begin) / w - c2 * w, c2] };
            begin = end;
            piece
        };
        knots.windows(2).map(piece).collect()
    }

    /// g and dg/dy by Gauss's rule in r, s before the end of each piece or before a, halved towards there where a is near.
    fn by_quadrature(pieces: &[Piece], i: usize, y: f64) -> [f64; 2] {
        let rule = GaussLegendre::new(NonZeroUsize::new(24).unwrap());
        let a = pieces[i].lo + y * y;
        let [mut slope, mut bend] = [0.0; 2];
        for (j, piece) in pieces[..=i].iter().enumerate() {
            let (length, beyond) =
                if j == i { (y * y, 0.0) } else { (piece.width(), (pieces[i].lo - piece.hi) + y * y) };
            // What is left out, 2⁻¹²⁰, holds 2⁻⁶⁰ of an integral over 1/√s.
            let halvings = if beyond < length { 120 } else { 0 };
            let mut to = length;
            for k in 0..=halvings {
                let from = if k == halvings && beyond > 0.0 { 0.0 } else { 0.5 * to };
                // Summed separately, so that thousands of terms do not round thousands of times.
                let [mut slope_here, mut bend_here] = [0.0; 2];
                for (x, weight) in &rule {
                    let s = 0.5 * ((from + to) + (to - from) * x);
                    let t = length - s;
                    let r = piece.lo + t;
                    let kernel = 0.5 * (to - from) * weight / ((beyond + s) * (a + r)).sqrt();
                    slope_here += kernel * piece.slope(t);
                    bend_here += kernel * r * piece.bend(t);
                }
                slope += slope_here;
                bend += bend_here;
                to = from;
            }
        }
        [a * slope, 2.0 * y * (slope + bend)]
    }

    fn transformed(pieces: &[Piece]) -> Vec<[[f64; NODES]; 2]> {
        transform(pieces, 0, &Unwatched).unwrap()
    }

    #[test]
    fn it_agrees_with_an_independent_quadrature() {
        let mut random = fastrand::Rng::with_seed(1);
        for (n, every) in [(1, 1), (2, 1), (20, 1), (300, 17), (2000, 331)] {
            for ratio in [1.0, 10.0, 1e4] {
                let pieces = rough(&knots(n, ratio, &mut random), &mut random);
                let ours = transformed(&pieces);
                let size = [0, 1].map(|s| {
                    ours.iter().flat_map(|panel| panel[s]).fold(0.0_f64, |most, x| most.max(x.abs()))
                });
                let mut worst = [0.0_f64; 2];
                for at in (0..n * NODES).rev().step_by(every) {
                    let (i, j) = (at / NODES, at % NODES);
                    let exact = by_quadrature(&pieces, i, nodes()[j] * pieces[i].width().sqrt());
                    for s in 0..2 {
                        worst[s] = worst[s].max((ours[i][s][j] - exact[s]).abs() / size[s]);
                    }
                }
                println!("{n} pieces, ratio {ratio}: {worst:?}");
                assert!(worst.iter().all(|worst| *worst < 4e-15), "{n} pieces, ratio {ratio}: {worst:?}");
            }
        }
    }

    #[test]
    fn a_paraboloid_and_a_cone_in_pieces_are_what_they_are_whole() {
        let mut random = fastrand::Rng::with_seed(2);
        for (n, ratio) in [(1, 1.0), (7, 1.0), (400, 1.0), (4000, 1.0), (400, 1e4), (30, 1e8)] {
            let knots = knots(n, ratio, &mut random);
            let pieces = |slope: &dyn Fn(f64) -> [f64; 3]| -> Vec<Piece> {
                knots.windows(2).map(|p| Piece { lo: p[0], hi: p[1], slope: slope(p[0]) }).collect()
            };
            let (radius, cone) = (0.7, 0.3);
            // h' = r/R gives a²/R, h' = c gives πca/2.
            let paraboloid = transformed(&pieces(&|lo| [lo / radius, 1.0 / radius, 0.0]));
            let flanks = transformed(&pieces(&|_| [cone, 0.0, 0.0]));
            let mut worst = [0.0_f64; 4];
            for (i, pair) in knots.windows(2).enumerate() {
                for (j, x) in nodes().into_iter().enumerate() {
                    let y = x * (pair[1] - pair[0]).sqrt();
                    let a = pair[0] + y * y;
                    let exact = [
                        a * a / radius,
                        4.0 * y * a / radius,
                        FRAC_PI_2 * cone * a,
                        2.0 * y * FRAC_PI_2 * cone,
                    ];
                    let ours = [paraboloid[i][0][j], paraboloid[i][1][j], flanks[i][0][j], flanks[i][1][j]];
                    for (worst, (ours, exact)) in worst.iter_mut().zip(ours.iter().zip(exact)) {
                        *worst = worst.max((ours / exact - 1.0).abs());
                    }
                }
            }
            println!("{n} pieces, ratio {ratio}: {worst:?}");
            assert!(worst.iter().all(|worst| *worst < 4e-15), "{n} pieces, ratio {ratio}: {worst:?}");
        }
    }

    #[test]
    fn later_panels_are_the_same_alone() {
        let mut random = fastrand::Rng::with_seed(3);
        let pieces = rough(&knots(100, 10.0, &mut random), &mut random);
        let tail = transform(&pieces, 63, &Unwatched).unwrap();
        assert_eq!(tail, transformed(&pieces)[63..]);
        assert_eq!(transform(&pieces, 100, &Unwatched), Ok(Vec::new()));
        assert_eq!(transform(&[], 0, &Unwatched), Ok(Vec::new()));
    }

    #[test]
    fn it_stops_when_it_is_no_longer_wanted() {
        let mut random = fastrand::Rng::with_seed(4);
        let pieces = rough(&knots(200, 1.0, &mut random), &mut random);
        let asked = Cell::new(0);
        let until = || {
            asked.set(asked.get() + 1);
            asked.get() == 3
        };
        assert_eq!(transform(&pieces, 0, &until), Err(Stopped));
        assert_eq!(asked.get(), 3);
    }
}
