//! An angle graded towards breaks of the gap inside a ring.
//!
//! A corner of the gap makes a logarithm in the pressure, a kink a logarithm in its slope: no cosine series converges there. With
//!
//! ```text
//! r = c − d cos θ,  θ = w(t),  t_k = (k + ½)π/n,    unknown p r dr/dt
//! S(u) = v^p/(v^p + v̂^p),  v = (1/p − ½)(1 − 2u)³ + (2u − 1)/p + ½,  v̂ = v(1 − u),  p = 8
//! θ = θ_j + Δ S(u) between two breaks,   Δ (2S((1 + u)/2) − 1) from an edge to a break
//! ```
//!
//! w' vanishes to a high order at the breaks, and all sums stay as they are with cos t in place of x. Breaks fall
//! midway between points; beside a break the angle is kept as its distance from that break.
//!
//! R. Kress, J. Comput. Appl. Math. 61, 345 (1995), for the substitution.

use super::nodes::{Graded, Nodes};
use super::rule::RingRule;
use crate::elementary::{atan2, pow, sin};
use crate::root;
use std::f64::consts::PI;
use wide::f64x4;

/// p.
const POWER: f64 = 8.0;

/// S and S'.
fn sigmoid(u: f64) -> [f64; 2] {
    let [v, v_slope] = ramp(u);
    let [w, w_slope] = ramp(1.0 - u);
    let (vp, wp) = (pow(v, POWER), pow(w, POWER));
    let sum = vp + wp;
    let slope = POWER * pow(v * w, POWER - 1.0) * (v_slope * w + v * w_slope) / (sum * sum);
    [vp / sum, slope]
}

/// v and v'.
fn ramp(u: f64) -> [f64; 2] {
    let x = 1.0 - 2.0 * u;
    let cubic = 1.0 / POWER - 0.5;
    [(cubic * x * x * x - x / POWER + 0.5).max(0.0), -6.0 * cubic * x * x + 2.0 / POWER]
}

/// A place on a piece: its distances from both borders, and dθ/du.
struct GradedPlace {
    from_lower: f64,
    to_upper: f64,
    slope: f64,
}

/// The place at u on a piece of width Δ; `first` or `last` where there is no break at that end.
fn place(u: f64, width: f64, first: bool, last: bool) -> GradedPlace {
    if first {
        let [s, slope] = sigmoid(0.5 * (1.0 - u));
        return GradedPlace {
            from_lower: width * (1.0 - 2.0 * s),
            to_upper: 2.0 * width * s,
            slope: width * slope,
        };
    }
    if last {
        let [s, slope] = sigmoid(0.5 * u);
        return GradedPlace {
            from_lower: 2.0 * width * s,
            to_upper: width * (1.0 - 2.0 * s),
            slope: width * slope,
        };
    }
    let [s, slope] = sigmoid(u);
    GradedPlace { from_lower: width * s, to_upper: width * sigmoid(1.0 - u)[0], slope: width * slope }
}

impl Graded {
    /// |r − r'| and the lift of row `i` in the columns from `k` on.
    pub fn pair(&self, i: usize, k: usize) -> (f64x4, f64x4) {
        let at =
            |of: &[f64]| of[i * self.n + k..].first_chunk::<4>().map_or(f64x4::ONE, |four| f64x4::new(*four));
        (at(&self.apart), at(&self.lift))
    }

    /// t and dθ/dt at the angle θ.
    pub fn angle(&self, theta: f64) -> (f64, f64) {
        let last = self.pieces.len() - 1;
        let j = self.borders[1..].partition_point(|border| *border < theta).min(last);
        let width = self.borders[j + 1] - self.borders[j];
        let within = theta - self.borders[j];
        let [u, _] = root::halved(0.0, 1.0, |u| place(u, width, j == 0, j == last).from_lower < within);
        let before: usize = self.pieces[..j].iter().sum();
        let (n, here) = (self.n as f64, self.pieces[j] as f64);
        let slope = place(u, width, j == 0, j == last).slope * n / (PI * here);
        (PI * (before as f64 + here * u) / n, slope)
    }
}

/// The angles θ of the points of a ring.
struct Laid {
    /// θ at the ends of the pieces.
    borders: Vec<f64>,
    /// Each as the distance from a border, and that border.
    angles: Vec<(usize, f64)>,
    theta: Vec<f64>,
    /// dθ/dt at the points,
    stretches: Vec<f64>,
    /// and at the ends.
    stretch: [f64; 2],
}

impl Laid {
    /// As many points on each piece between these borders.
    fn new(borders: Vec<f64>, pieces: &[usize], n: usize) -> Self {
        let last = pieces.len() - 1;
        let placed = |j: usize, u: f64| {
            let at = place(u, borders[j + 1] - borders[j], j == 0, j == last);
            let stretch = at.slope * n as f64 / (PI * pieces[j] as f64);
            (at, stretch)
        };
        let (mut angles, mut stretches) = (Vec::with_capacity(n), Vec::with_capacity(n));
        for (j, count) in pieces.iter().enumerate() {
            for k in 0..*count {
                let (at, stretch) = placed(j, (k as f64 + 0.5) / *count as f64);
                let is_lower = at.from_lower < at.to_upper;
                angles.push(if is_lower { (j, at.from_lower) } else { (j + 1, -at.to_upper) });
                stretches.push(stretch);
            }
        }
        let theta = angles.iter().map(|(border, off)| borders[*border] + off).collect();
        let stretch = [placed(0, 0.0).1, placed(last, 1.0).1];
        Self { borders, angles, theta, stretches, stretch }
    }

    /// The angle from point i to point k.
    fn between(&self, i: usize, k: usize) -> f64 {
        let [(own, off), (other, far)] = [self.angles[i], self.angles[k]];
        if own == other { far - off } else { (self.borders[other] - self.borders[own]) + (far - off) }
    }

    /// The sum and the difference of the angles of a point and a border; 2d times the sines of their halves is the
    /// difference of the radii.
    fn with_border(&self, k: usize, border: usize) -> [f64; 2] {
        let (own, off) = self.angles[k];
        let difference = if own == border { off } else { self.theta[k] - self.borders[border] };
        [self.theta[k] + self.borders[border], difference]
    }
}

/// θ of a radius on a ring.
pub fn angle_of([a, b]: [f64; 2], r: f64) -> f64 {
    2.0 * atan2((r - a).max(0.0).sqrt(), (b - r).max(0.0).sqrt())
}

impl Nodes {
    /// The points of a ring with these breaks inside, ascending, with the given number on each piece between them; the
    /// total is a multiple of four.
    pub fn graded(ends: [f64; 2], breaks: &[f64], pieces: &[usize]) -> Self {
        let n: usize = pieces.iter().sum();
        let rule = RingRule::of(n);
        let [a, b] = ends;
        let (width, last) = (b - a, pieces.len() - 1);
        let inner = breaks.iter().map(|r| angle_of(ends, *r));
        let laid = Laid::new(std::iter::once(0.0).chain(inner).chain([PI]).collect(), pieces, n);
        let radii_of = |j: usize| {
            if j == 0 {
                a
            } else if j > last {
                b
            } else {
                breaks[j - 1]
            }
        };
        // r minus the radius of a border.
        let from_border = |k: usize, border: usize| {
            let [sum, difference] = laid.with_border(k, border);
            width * sin(0.5 * sum) * sin(0.5 * difference)
        };
        let from_inner: Vec<f64> = laid.theta.iter().map(|theta| width * sin(0.5 * theta).powi(2)).collect();
        let own = |k: usize| laid.angles[k].0;
        let radii: Vec<f64> = (0..n).map(|k| radii_of(own(k)) + from_border(k, own(k))).collect();
        let (first_break, last_break) = (radii_of(1), radii_of(last));
        let (inward, outward) = ((first_break - a).recip(), (b - last_break).recip());
        let in_first = pieces[0];
        let in_last = n - pieces[last];
        let speeds = [
            (0..n)
                .map(|k| if k < in_first { -from_border(k, 1) * inward } else { 0.0 })
                .collect::<Vec<f64>>(),
            (0..n).map(|k| if k >= in_last { from_border(k, last) * outward } else { 0.0 }).collect(),
        ];
        let [mut apart, mut lift] = [vec![0.0; n * n], vec![0.0; n * n]];
        let mut quotients = [vec![0.0; n * n], vec![0.0; n * n]];
        for i in 0..n {
            let at = i * n + i;
            lift[at] = laid.stretches[i] * sin(laid.theta[i]) / sin(rule.angles[i]);
            quotients[0][at] = if i < in_first { -inward } else { 0.0 };
            quotients[1][at] = if i >= in_last { outward } else { 0.0 };
            for k in i + 1..n {
                let sum = laid.theta[i] + laid.theta[k];
                let product = sin(0.5 * sum) * sin(0.5 * laid.between(i, k));
                let ratio = product / (rule.sines[i + k + 1] * rule.sines[k - i]);
                for at in [i * n + k, k * n + i] {
                    apart[at] = width * product;
                    lift[at] = ratio;
                    for edge in 0..2 {
                        quotients[edge][at] = (speeds[edge][k] - speeds[edge][i]) / (width * product);
                    }
                }
            }
        }
        // Where both speeds lie on one line the quotient is its slope, which differences would lose.
        for i in 0..in_first {
            quotients[0][i * n..i * n + in_first].fill(-inward);
        }
        for i in in_last..n {
            quotients[1][i * n + in_last..(i + 1) * n].fill(outward);
        }
        let Laid { borders, stretch, .. } = laid;
        Self {
            ends,
            rule,
            radii,
            from_inner,
            speeds,
            slopes: [[-inward, 0.0], [0.0, outward]],
            stretch,
            graded: Some(Graded { n, borders, pieces: pieces.to_vec(), apart, lift, speeds: quotients }),
        }
    }
}
