//! The kernel between points of rings, with its logarithm taken out on a ring's own block.
//!
//! ```text
//! M = K(k)/(r + r'),  k' = |r − r'|/(r + r')
//! on one ring   M = L ln|x − y| + S,  L = −(2/π)K(k')/(r + r'),  S = −(K(k')/π)(ln q' − 2 ln|x − y|)/(r + r'),  q' the nome of k'
//! ```
//!
//! With σ = r + r', W = 2[ln 2 + ΣC] − (ln q' − 2 ln|x − y|) the symmetric block of Chebyshev sums is K(k')W/(πσ). Where the
//! points move with the speeds v, Λ = (v − v')/(r − r') − (v + v')/σ (dv/dr − v/r on the diagonal), m = k'², it changes by
//!
//! ```text
//! [W m (K − D)/(1 − m) − π²/(2(1 − m)K)] Λ/(πσ) − (v + v')/σ · block,      K = K(k'), D = (K − E)/m
//! ```
//!
//! and on another ring ∂M/∂r = [E(k)/(r' − r) − K(k)/σ]/2r, ∂M/∂r' = −(M + r ∂M/∂r)/r'.

use super::elliptic::{self, FOUR_MEANS, ROOT};
use super::nodes::Nodes;
use std::f64::consts::{FRAC_1_PI, PI};
use wide::f64x4;

/// A block between the points of two rings, by rows, and what moves with the points.
#[derive(Debug, Clone, Default)]
pub struct MovedBlock {
    /// On one ring the factor of Λ; between rings ∂M/∂r.
    pub first: Vec<f64>,
    /// On one ring the block itself; between rings ∂M/∂r'.
    pub second: Vec<f64>,
}

fn four(of: &[f64], from: usize) -> f64x4 {
    of[from..].first_chunk::<4>().map_or(f64x4::ZERO, |four| f64x4::new(*four))
}

fn put(into: &mut [f64], from: usize, what: f64x4) {
    if let Some(four) = into[from..].first_chunk_mut::<4>() {
        *four = what.to_array();
    }
}

/// Writes the block of one ring, from the diagonal on, into the rows of `block`, which begin at its diagonal, `stride`
/// apart; where `moved` is given, also what moves the block.
pub fn own(nodes: &Nodes, block: &mut [f64], stride: usize, mut moved: Option<&mut MovedBlock>) {
    let (n, r, rule) = (nodes.radii.len(), &nodes.radii[..], nodes.rule);
    let half = nodes.half();
    let more = (half / nodes.middle()).powi(2) > FOUR_MEANS;
    if let Some(moved) = moved.as_deref_mut() {
        moved.first.resize(n * n, 0.0);
        moved.second.resize(n * n, 0.0);
    }
    let quarter = f64x4::splat(0.25 * half);
    for i in 0..n {
        let here = f64x4::splat(r[i]);
        for k in (i & !3..n).step_by(4) {
            let away = |of: &[f64]| {
                if k >= i {
                    four(of, k - i)
                } else {
                    f64x4::new(std::array::from_fn(|l| of[i.abs_diff(k + l)]))
                }
            };
            let sum = four(&rule.log_sums, i + k + 1) + away(&rule.log_sums);
            let sigma = here + four(r, k);
            let per_sigma = f64x4::ONE / sigma;
            let (apart, lift) = match &nodes.graded {
                None => {
                    let product = four(&rule.sines, i + k + 1) * away(&rule.sines);
                    (f64x4::splat(2.0 * half) * product, f64x4::ONE)
                }
                Some(graded) => graded.pair(i, k),
            };
            let ratio = apart * per_sigma;
            let m = ratio * ratio;
            let near = elliptic::near(m, more);
            // ln q' − 2 ln|cos t − cos t'| in one logarithm.
            let scale = quarter * lift * per_sigma;
            let scale = scale * scale;
            let scale = scale * scale;
            let log = (near.power / (scale * scale)).ln() * f64x4::splat(1.0 / ROOT);
            let w = sum - log;
            let k_sigma = near.k * per_sigma * f64x4::splat(FRAC_1_PI);
            let value = k_sigma * w;
            put(&mut block[i * stride..], k, value);
            if let Some(moved) = moved.as_deref_mut() {
                let beyond = f64x4::ONE / (f64x4::ONE - m);
                let turning = m * (near.k - near.d) * w - f64x4::splat(0.5 * PI * PI) / near.k;
                put(&mut moved.first[i * n..], k, turning * beyond * per_sigma * f64x4::splat(FRAC_1_PI));
                put(&mut moved.second[i * n..], k, value);
            }
        }
    }
    if let Some(moved) = moved {
        for of in [&mut moved.first, &mut moved.second] {
            for i in 0..n {
                for k in i + 1..n {
                    of[k * n + i] = of[i * n + k];
                }
            }
        }
    }
}

/// Writes the block between a ring and another further out into the rows of `block`, `stride` apart.
pub fn between(
    inner: &Nodes,
    outer: &Nodes,
    block: &mut [f64],
    stride: usize,
    mut moved: Option<&mut MovedBlock>,
) {
    let (rows, columns) = (inner.radii.len(), outer.radii.len());
    let least = (outer.ends[0] - inner.ends[1]) / (outer.ends[0] + inner.ends[1]);
    let means = elliptic::means(least);
    if let Some(moved) = moved.as_deref_mut() {
        moved.first.resize(rows * columns, 0.0);
        moved.second.resize(rows * columns, 0.0);
    }
    for (i, r) in inner.radii.iter().enumerate() {
        let here = f64x4::splat(*r);
        for k in (0..columns).step_by(4) {
            let there = four(&outer.radii, k);
            let per_sigma = f64x4::ONE / (there + here);
            let apart = there - here;
            let [complete, second] = elliptic::far(apart * per_sigma, means);
            let value = complete * per_sigma;
            put(&mut block[i * stride..], k, value);
            if let Some(moved) = moved.as_deref_mut() {
                let by_inner = (second / apart - value) * f64x4::splat(0.5 / r);
                put(&mut moved.first[i * columns..], k, by_inner);
                put(&mut moved.second[i * columns..], k, -(value + here * by_inner) / there);
            }
        }
    }
}
