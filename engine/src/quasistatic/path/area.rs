//! The loss of a jump as the work left over at its edges.
//!
//! ```text
//! −∫ Σ 2πe_i (G_i − γ) dα_i      at held control, along straight lines from the edges before to those after
//! ```
//!
//! The potential does not depend on the way, so any way will do: a new contact opens from a point, a gap closes to its
//! middle. The sum is Fejér's second rule, whose nodes are doubled until two sums agree (J. Waldvogel, BIT Numer.
//! Math. 46, 195 (2006), doi:10.1007/s10543-006-0045-4). It runs over the square root of the time from where a contact
//! opens, or from where an edge passes a corner; as a gap closes, G is smooth. The energy of a stretched ring that
//! vanishes falls only with the logarithm of its width, so the ring is integrated in that variable,
//!
//! ```text
//! U = K/(ln(32c/w) + C)      c its radius, w → 0, C from what stands beside it
//! ```

use super::balance::Balance;
use super::event::PathState;
use crate::annuli::Contacts;
use crate::annuli::ground::gauss;
use crate::elementary::{cos, exp, ln, sin};
use std::f64::consts::{FRAC_PI_2, PI};

/// Nodes for the integral over a vanishing ring.
const NODES: usize = 32;

/// The most intervals on one way, and how many more for each wave that an edge passes.
const INTERVALS: f64 = 64.0;
const INTERVALS_PER_WAVE: f64 = 48.0;

/// The largest error of the finer of two sums, as a share of its parts. It is estimated as the difference from the
/// coarser sum, times the ratio of that difference to the previous one. Sums of an analytic function are far better.
const OFF: f64 = 3e-8;

/// Where the rest of a vanishing ring takes over, as a share of its width, and how much wider its second sample is.
const REST: f64 = 1e-6;
const WIDER: f64 = 10.0;

/// The way of two edges, from the small contact to the large one.
#[derive(Debug, Clone, Copy)]
enum EdgeWay {
    /// On a straight line.
    Line([f64; 2], [f64; 2]),
    /// A ring that opens from nothing at a radius.
    Open(f64, [f64; 2]),
}

impl EdgeWay {
    /// Both edges and their rates at t.
    fn at(&self, t: f64) -> [[f64; 2]; 2] {
        let [from, to] = match self {
            Self::Line(from, to) => [*from, *to],
            Self::Open(point, to) => [[*point; 2], *to],
        };
        [0, 1].map(|k| [from[k] + t * (to[k] - from[k]), to[k] - from[k]])
    }
}

/// Edges with their rates.
type Moving = Vec<[[f64; 2]; 2]>;

impl Balance<'_> {
    /// What is lost between two states at one control value, one within the other; `None` where there is no state on
    /// the way. A new contact opens from one of the `crests`, a length each.
    pub fn area_between(
        &self,
        before: Option<&PathState>,
        after: Option<&PathState>,
        value: f64,
        crests: &[f64],
    ) -> Option<f64> {
        let intervals = |state: Option<&PathState>| state.map_or(Vec::new(), |state| state.contacts.clone());
        let (old, new) = (intervals(before), intervals(after));
        let grows = length(&new) >= length(&old);
        let (small, large) = if grows { (&old, &new) } else { (&new, &old) };
        let lost = -self.opened(small, large, value, grows.then_some(crests))?;
        Some(if grows { lost } else { -lost })
    }

    /// ∫ Σ 2πe (G − γ) dα from the small contacts to the large ones.
    fn opened(
        &self,
        small: &[[f64; 2]],
        large: &[[f64; 2]],
        value: f64,
        crests: Option<&[f64]>,
    ) -> Option<f64> {
        let (mut ways, mut vanishing) = (Vec::new(), Vec::new());
        for &[lo, hi] in large {
            let inside: Vec<[f64; 2]> = small.iter().copied().filter(|[a, b]| *b > lo && *a < hi).collect();
            let (Some(first), Some(last)) = (inside.first(), inside.last()) else {
                let crest = crests.and_then(|crests| crests.iter().find(|r| **r > lo && **r < hi));
                match crest {
                    _ if lo <= 0.0 => ways.push(EdgeWay::Open(0.0, [lo, hi])),
                    Some(crest) => ways.push(EdgeWay::Open(*crest, [lo, hi])),
                    None => vanishing.push([lo, hi]),
                }
                continue;
            };
            // Its own pieces, and the gaps between them that close.
            let middles: Vec<f64> = inside.windows(2).map(|pair| 0.5 * (pair[0][1] + pair[1][0])).collect();
            for (k, piece) in inside.iter().enumerate() {
                let inner = if k == 0 { lo } else { middles[k - 1] };
                let outer = if k + 1 == inside.len() { hi } else { middles[k] };
                ways.push(EdgeWay::Line(*piece, [inner, outer]));
            }
            debug_assert!(first[0] <= last[1]);
        }
        // First the contacts that stay move, beside the whole rings that are about to vanish; then those vanish, one
        // after the other.
        let farthest = ways
            .iter()
            .flat_map(|way| match way {
                EdgeWay::Line(from, to) => [from[0] - to[0], to[1] - from[1]],
                EdgeWay::Open(point, to) => [point - to[0], to[1] - point],
            })
            .fold(0.0, f64::max);
        // At most 1024.
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let most = (INTERVALS + INTERVALS_PER_WAVE * farthest / self.ground.wave).min(1024.0) as usize;
        let mut sum = 0.0;
        if !ways.is_empty() {
            for pair in self.borders(&ways).windows(2) {
                let (from, width) = (pair[0], pair[1] - pair[0]);
                let opens = from > 0.0 || ways.iter().any(|way| matches!(way, EdgeWay::Open(..)));
                let rooted = [opens, pair[1] < 1.0];
                sum += integral(most, &mut |u| {
                    let [share, speed] = match rooted {
                        [true, true] => [sin(FRAC_PI_2 * u).powi(2), 0.5 * PI * sin(PI * u)],
                        [true, false] => [u * u, 2.0 * u],
                        [false, true] => [u * (2.0 - u), 2.0 * (1.0 - u)],
                        [false, false] => [u, 1.0],
                    };
                    let (t, speed) = (from + width * share, width * speed);
                    let mut edges: Moving = ways.iter().map(|way| way.at(t)).collect();
                    edges.extend(vanishing.iter().map(|ring| ring.map(|edge| [edge, 0.0])));
                    Some(speed * self.rate(edges, value)?)
                })?;
            }
        }
        let mut stays: Vec<[f64; 2]> = small.to_vec();
        for ring in &vanishing {
            sum += self.vanished(&stays, *ring, value)?;
            stays.push(*ring);
        }
        Some(sum)
    }

    /// The times at which an edge passes a break of the gap, with 0 and 1: there G varies as the square root of the
    /// time.
    fn borders(&self, ways: &[EdgeWay]) -> Vec<f64> {
        let mut times = vec![0.0, 1.0];
        for way in ways {
            for [start, rate] in way.at(0.0) {
                if rate.abs() > 0.0 {
                    let passed = self.ground.stops().iter().map(|stop| (stop - start) / rate);
                    times.extend(passed.filter(|t| *t > 1e-9 && *t < 1.0 - 1e-9));
                }
            }
        }
        times.sort_by(f64::total_cmp);
        times.dedup_by(|a, b| *a - *b < 1e-9);
        times
    }

    /// Σ 2πe (G − γ) de/dt for edges [radius, rate] of contacts, in any order.
    fn rate(&self, mut edges: Vec<[[f64; 2]; 2]>, value: f64) -> Option<f64> {
        edges.sort_by(|a, b| a[0][0].total_cmp(&b[0][0]));
        let (disc, rings): (Moving, Moving) = edges.into_iter().partition(|[inner, _]| inner[0] <= 0.0);
        let contacts = Contacts {
            disc: disc.first().map_or(0.0, |[_, outer]| outer[0]),
            rings: rings.iter().map(|[inner, outer]| [inner[0], outer[0]]).collect(),
        };
        let kappa = self.intensities(&contacts, value).ok()?;
        let root = self.work_of_adhesion.sqrt();
        let rates = disc.iter().map(|[_, outer]| outer[1]).chain(rings.iter().flatten().map(|edge| edge[1]));
        let terms = contacts.edges().into_iter().zip(kappa).zip(rates);
        Some(
            terms
                .map(|((edge, kappa), rate)| {
                    2.0 * PI * edge.radius * (kappa - root) * (kappa + root) * edge.sign * rate
                })
                .sum(),
        )
    }

    /// The same for a stretched ring that opens from nothing, beside others.
    fn vanished(&self, others: &[[f64; 2]], [a, b]: [f64; 2], value: f64) -> Option<f64> {
        let (middle, width) = (0.5 * (a + b), b - a);
        let of = |w: f64| {
            let mut edges: Vec<[[f64; 2]; 2]> =
                others.iter().map(|ring| ring.map(|edge| [edge, 0.0])).collect();
            edges.push([[middle - 0.5 * w, -0.5], [middle + 0.5 * w, 0.5]]);
            self.rate(edges, value)
        };
        let log = |w: f64| ln(32.0 * middle / w);
        let (from, to) = (log(REST * width).recip(), log(width).recip());
        let mut sum = 0.0;
        for [x, weight] in gauss(NODES) {
            let u = 0.5 * (from + to) + 0.5 * (to - from) * x;
            let w = 32.0 * middle * exp(-u.recip());
            sum += 0.5 * (to - from) * weight * of(w)? * w / (u * u);
        }
        // U = K/(L + C), L = ln(32c/w): the root of −dU/dL = w dU/dw is √K/(L + C).
        let w = REST * width;
        // The elastic part of U; the adhesion of the rest follows from its area.
        let adhesion = 2.0 * PI * middle * self.work_of_adhesion;
        let [near, wider] = [w, WIDER * w].map(|w| of(w).map(|rate| ((rate + adhesion) * w).max(0.0).sqrt()));
        let (near, wider) = (near?, wider?);
        let root = ln(WIDER) / (near.recip() - wider.recip());
        Some(sum + root * near - adhesion * w)
    }
}

/// ∫₀¹ f du, with up to about `most` intervals; f is not evaluated at the ends.
fn integral(most: usize, f: &mut dyn FnMut(f64) -> Option<f64>) -> Option<f64> {
    const FEWEST: usize = 16;
    // Only between the ends: n intervals have n − 1 values.
    let mut values = vec![f(0.5)?];
    let (mut coarser, mut differed) = (f64::NAN, f64::NAN);
    loop {
        let n = 2 * (values.len() + 1);
        let angle = PI / n as f64;
        values = (1..n)
            .map(
                |k| if k % 2 == 0 { Some(values[k / 2 - 1]) } else { f(0.5 * (1.0 - cos(angle * k as f64))) },
            )
            .collect::<Option<_>>()?;
        let weight = |k: usize| {
            let terms = (1..=n / 2).map(|j| {
                let order = (2 * j - 1) as f64;
                sin(order * angle * k as f64) / order
            });
            2.0 * sin(angle * k as f64) / n as f64 * terms.sum::<f64>()
        };
        let parts: Vec<f64> = (1..n).map(|k| weight(k) * values[k - 1]).collect();
        let (sum, size): (f64, f64) = (parts.iter().sum(), parts.iter().map(|part| part.abs()).sum());
        let differs = (sum - coarser).abs();
        let off = differs * (differs / differed).min(1.0);
        if n >= FEWEST && (off <= OFF * size || n >= most) {
            return Some(sum);
        }
        (coarser, differed) = (sum, differs);
    }
}

fn length(intervals: &[[f64; 2]]) -> f64 {
    intervals.iter().map(|[a, b]| b * b - a * a).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_that_agree_are_right_and_end_early() {
        let mut asked = 0;
        // ∫₀¹ sin(πu) e^u du = π(e + 1)/(π² + 1).
        let found = integral(1024, &mut |u| {
            asked += 1;
            Some(sin(PI * u) * exp(u))
        });
        let right = PI * (exp(1.0) + 1.0) / (PI * PI + 1.0);
        assert!((found.unwrap() / right - 1.0).abs() < 1e-13, "{found:?} {right}");
        assert!(asked <= 31, "{asked}");
        assert_eq!(integral(1024, &mut |u| (u < 0.7).then_some(u)), None);
        // A square root at a place inside: it takes as many values as there may be, and no more.
        let mut asked = 0;
        let rough = integral(64, &mut |u| {
            asked += 1;
            Some((u - 0.3).abs().sqrt())
        });
        assert!(rough.is_some() && asked <= 127, "{asked}");
    }
}
