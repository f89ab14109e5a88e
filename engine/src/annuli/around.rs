//! The bodies around the edges of a state: the gap between the contacts and outside them, and the pressure in them.
//!
//! ```text
//! gap(r) = h − δ + (4/π) ∫₀^r X/√(r² − a²) da = (4/π)[Σ y (M − N)(r, r') − F(r)],       X = ½(δ − g) − Σ y/√(r'² − a²) on the disc
//! p(r) = −(2/π) Σ y √(r'² − s²)/((r'² − r²)√(s² − r²)) + what one disc has               in the disc
//! p(r) = f(t)/(r dr/dt)                                                                  in a ring, f its cosine series
//! ```

use super::elliptic;
use super::ground::{DiscNodes, Ground};
use super::state::AnnuliState;
use crate::disc::{chebyshev, outside};
use crate::elementary::{asin, sin};
use crate::progress::{Progress, Stopped};
use std::f64::consts::{FRAC_2_PI, PI};
use wide::f64x4;

/// Distance between an edge and the first sampled radius, in waves: beside an edge the sums are poor.
pub const BESIDE: f64 = 0.06;

/// Sampled radii in each wave.
const PER_WAVE: f64 = 14.0;

/// Points of the series that finds a minimum.
const POINTS: usize = 11;

/// How far beyond what can touch a search goes, in lengths of the gap.
const OVER: f64 = 0.15;

/// The fewest steps between radii, and the most, in one search.
const FEWEST_RADII: f64 = 8.0;
const MOST_RADII: f64 = 20_000.0;

/// A place where the gap has a minimum.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GapMinimum {
    /// r, a length.
    pub radius: f64,
    /// The gap there, a length; negative where the bodies would overlap.
    pub gap: f64,
}

/// A state at an approach, ready for radii.
#[derive(Debug)]
pub struct Around<'a> {
    ground: &'a Ground,
    state: &'a AnnuliState,
    delta: f64,
    radii: Vec<f64>,
    y: Vec<f64>,
    /// ∫ X/√(r² − a²) da over the disc for radii r beyond the inner edge of the first ring, as Σ x/√((r² − edge²) + below): [below, x].
    under: Vec<[f64; 2]>,
}

impl<'a> Around<'a> {
    /// For a state at the approach `delta`.
    pub fn new(ground: &'a Ground, state: &'a AnnuliState, delta: f64) -> Self {
        let y: Vec<f64> = state.y[0].iter().zip(&state.y[1]).map(|(a, b)| a + delta * b).collect();
        let radii: Vec<f64> = state.nodes.iter().flat_map(|nodes| nodes.radii.iter().copied()).collect();
        let (s, first) = (state.contacts.disc, state.contacts.rings.first());
        let under = first.filter(|_| s > 0.0).map_or_else(Vec::new, |[edge, _]| {
            let rings = |below: f64| -> f64 {
                let terms = radii.iter().zip(&y);
                terms.map(|(r, y)| y / ((r - edge).max(0.0) * (r + edge) + below).sqrt()).sum()
            };
            let even = DiscNodes::even(s, *edge);
            let nodes = even.below.iter().zip(&even.weight);
            let smooth = nodes.map(|(below, weight)| [*below, weight * (0.5 * delta - rings(*below))]);
            let gap = ground.sum_below(s, *edge).into_iter().map(|[below, weight]| [below, -0.5 * weight]);
            smooth.chain(gap).collect()
        });
        Self { ground, state, delta, radii, y, under }
    }

    /// The gap at a radius outside the contacts, a length.
    pub fn gap(&self, r: f64) -> f64 {
        let contacts = &self.state.contacts;
        let s = contacts.disc;
        let Some([edge, _]) = contacts.rings.first() else {
            return outside::gap_from(&self.ground.panels, s, self.delta, r);
        };
        let rings = 2.0 * FRAC_2_PI * self.pressed(r);
        if s <= 0.0 {
            return self.ground.gap.jet(r).value - self.delta + rings;
        }
        if r > *edge {
            let base = (r - edge) * (r + edge);
            let disc: f64 = self.under.iter().map(|[below, x]| x / (base + below).sqrt()).sum();
            return self.ground.gap.jet(r).value - self.delta + rings + 2.0 * FRAC_2_PI * disc;
        }
        // Beside the disc its own sum is better conditioned than a difference of h and displacements.
        let under = DiscNodes::even(s, r);
        let shaded: f64 = under
            .below
            .iter()
            .zip(&under.weight)
            .map(|(below, weight)| {
                let terms = self.radii.iter().zip(&self.y);
                let there: f64 = terms.map(|(x, y)| y / ((x - r) * (x + r) + below).sqrt()).sum();
                weight * there / below.sqrt()
            })
            .sum();
        outside::gap_from(&self.ground.panels, s, self.delta, r) + rings - 2.0 * FRAC_2_PI * shaded
    }

    /// Σ y M at a radius.
    fn pressed(&self, r: f64) -> f64 {
        let least = self.radii.iter().map(|x| (r - x).abs() / (r + x)).fold(1.0, f64::min);
        let means = elliptic::means(least);
        let here = f64x4::splat(r);
        let (radii, y) = (self.radii.as_chunks::<4>().0, self.y.as_chunks::<4>().0);
        let sum = radii.iter().zip(y).fold(f64x4::ZERO, |sum, (there, y)| {
            let there = f64x4::new(*there);
            let per_sigma = f64x4::ONE / (here + there);
            let complement = (here - there).abs() * per_sigma;
            sum + f64x4::new(*y) * elliptic::far_first(complement, means) * per_sigma
        });
        sum.reduce_add()
    }

    /// The pressure at a radius inside a contact, a stress, compression positive; not a number outside.
    pub fn pressure(&self, r: f64) -> f64 {
        let s = self.state.contacts.disc;
        if r < s {
            let alone = outside::pressure(&self.ground.panels, s, self.delta, r);
            let inside = ((s - r) * (s + r)).sqrt();
            let terms = self.radii.iter().zip(&self.y);
            let rings: f64 = terms
                .map(|(there, y)| {
                    y * ((there - s) * (there + s)).sqrt() / ((there - r) * (there + r) * inside)
                })
                .sum();
            return alone - FRAC_2_PI * rings;
        }
        let mut from = 0;
        for nodes in &self.state.nodes {
            let n = nodes.radii.len();
            let [a, b] = nodes.ends;
            if r > a && r < b {
                return nodes.density(&self.y[from..from + n], r) / r;
            }
            from += n;
        }
        f64::NAN
    }

    /// The minima of the gap outside the contacts, from the axis outward: those between contacts, and those beyond the
    /// last contact up to the radius `to`. The axis itself counts as one where it lies outside and the gap rises from
    /// it, and so does a corner.
    ///
    /// # Errors
    /// [`Stopped`].
    pub fn crests(&self, to: f64, progress: &dyn Progress) -> Result<Vec<GapMinimum>, Stopped> {
        let contacts = &self.state.contacts;
        let mut intervals = contacts.gaps();
        let outermost = contacts.outermost();
        let to = to.min(self.ground.reach());
        // Up to where the gap rises again, if the last crest is close to the end.
        let end = (to + OVER * self.ground.length_at(to)).min(self.ground.reach());
        let mut found = Vec::new();
        if to > outermost {
            intervals.push([outermost, end]);
        }
        let beside = BESIDE * self.ground.wave;
        for [lo, hi] in intervals {
            let from = if lo > 0.0 { lo + beside } else { 0.0 };
            let until = if hi < end || outermost >= to { hi - beside } else { hi };
            if until > from {
                self.minima([from, until], progress, &mut found)?;
            }
        }
        found.retain(|crest| crest.radius <= to);
        Ok(found)
    }

    /// Radii of an interval including both ends, closer together where the gap is fine.
    fn radii(&self, [from, to]: [f64; 2]) -> Vec<f64> {
        let waves = self.ground.lengths_between([from, to]);
        let steps = (waves * PER_WAVE).ceil().clamp(FEWEST_RADII, MOST_RADII);
        // Evenly spaced, in the lengths of the gap.
        let unit = waves / steps;
        let mut radii = vec![from];
        let mut r = from;
        loop {
            let step = unit * self.ground.length_at(r);
            // Where the gap gets finer, the length at the end of the step counts.
            r += step.min(unit * self.ground.length_at(r + step));
            if r >= to - 0.5 * unit * self.ground.wave || radii.len() as f64 > 2.0 * MOST_RADII {
                break;
            }
            radii.push(r);
        }
        if radii.len() == 1 {
            radii.push(0.5 * (from + to));
        }
        radii.push(to);
        radii
    }

    /// Adds the minima of an interval to those found.
    fn minima(
        &self,
        [from, to]: [f64; 2],
        progress: &dyn Progress,
        found: &mut Vec<GapMinimum>,
    ) -> Result<(), Stopped> {
        let radii = self.radii([from, to]);
        let (count, at) = (radii.len() - 1, |k: usize| radii[k]);
        // Far out on a fine gap each of these takes long.
        let gap = |k: usize| progress.go_on().map(|()| self.gap(at(k)));
        let gaps = (0..=count).map(gap).collect::<Result<Vec<f64>, _>>()?;
        if from == 0.0 && gaps[0] <= gaps[1] {
            let dimple = self.ground.is_dimpled();
            found.push(if dimple {
                self.minimum([0.0, at(1)])
            } else {
                GapMinimum { radius: 0.0, gap: gaps[0] }
            });
        }
        for k in 1..count {
            if gaps[k] <= gaps[k - 1] && gaps[k] < gaps[k + 1] {
                found.push(self.minimum([at(k - 1), at(k + 1)]));
            }
        }
        for corner in self.ground.stops().iter().filter(|b| **b > from && **b < to) {
            let gap = self.gap(*corner);
            let beside = 1e-4 * self.ground.wave;
            if self.gap(corner - beside) > gap && self.gap(corner + beside) > gap {
                found.push(GapMinimum { radius: *corner, gap });
            }
        }
        Ok(())
    }

    /// The minimum between two radii, by a Chebyshev series, or by one on each side of a corner of the gap.
    pub fn minimum(&self, [lo, hi]: [f64; 2]) -> GapMinimum {
        let corners = self.ground.stops();
        let inside = corners.partition_point(|r| *r <= lo)..corners.partition_point(|r| *r < hi);
        let inner = corners.get(inside).unwrap_or_default();
        let borders: Vec<f64> = std::iter::once(lo).chain(inner.iter().copied()).chain([hi]).collect();
        let parts = borders.windows(2).map(|pair| {
            let [radius, gap] = chebyshev::least(POINTS, [pair[0], pair[1]], |r| self.gap(r));
            GapMinimum { radius, gap }
        });
        parts.min_by(|a, b| a.gap.total_cmp(&b.gap)).unwrap_or(GapMinimum { radius: lo, gap: f64::NAN })
    }
}

impl super::nodes::Nodes {
    /// p r at a radius on the ring, from the terms y of its sums.
    fn density(&self, y: &[f64], r: f64) -> f64 {
        let n = y.len();
        let [a, b] = self.ends;
        let half = self.half();
        let theta = 2.0 * asin(((r - a) / (b - a)).sqrt().clamp(0.0, 1.0));
        let (t, stretch) = self.angle(theta);
        let angles = &self.rule.angles;
        // Q(t) = (1/n) Σ Q_k [1 + 2 Σ cos m t_k cos m t] and y = (π/n) Q.
        let kernel = |at: f64| -> f64 {
            let term = |angle: f64| {
                let sine = sin(0.5 * angle);
                if sine.abs() < 1e-12 { (2 * n) as f64 - 1.0 } else { sin((n as f64 - 0.5) * angle) / sine }
            };
            0.5 * (term(at - t) + term(at + t))
        };
        let sum: f64 = angles.iter().zip(y).map(|(at, y)| y * kernel(*at)).sum();
        sum / PI / (stretch * half * sin(theta))
    }

    /// t and dθ/dt at the angle θ.
    fn angle(&self, theta: f64) -> (f64, f64) {
        self.graded.as_ref().map_or((theta, 1.0), |graded| graded.angle(theta))
    }
}
