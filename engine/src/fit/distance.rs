//! The signed distance of a point from a path, in units of its noise.
//!
//! ```text
//! c(s) = (x/σ_x, P/σ_P[, s/σ_s]),     (m − c)·c' = 0 at the foot,     r = (m − c)·n
//! ```
//!
//! The polyline gives the stretch on which the foot lies; there it is the root of (m − c)·c', with the exact c'. An error ε of the
//! foot changes r by ε² times the curvature. At the ends of a piece the distance is that from the end, signed as beside it.

use super::path::{Foot, Path, Piece, Place, Vertex};
use crate::elementary::hypot;

/// The foot of a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Nearest {
    /// The piece of the path.
    pub piece: usize,
    /// Where on it.
    pub foot: Foot,
    /// The distances along the normals, one in a plane, two in space.
    pub residuals: [f64; 2],
    /// The derivatives of the residuals by the scaled point.
    pub normals: [Place; 2],
}

/// A path in units of noise.
#[derive(Debug)]
pub struct Scaled<'a> {
    path: &'a Path,
    corners: Vec<Place>,
    /// The ends of the boxes around [`BOXED`] stretches each.
    boxes: Vec<[Place; 2]>,
    weights: Place,
}

/// The way along a curve at which the foot is found, in units of noise.
const FOUND: f64 = 1e-8;
const STEPS: usize = 60;
/// Stretches of the polyline that are passed over together where their box is too far away.
const BOXED: usize = 16;

fn minus(a: Place, b: Place) -> Place {
    std::array::from_fn(|i| a[i] - b[i])
}

fn dot(a: Place, b: Place) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn scaled(a: Place, by: Place) -> Place {
    // A coordinate without weight may be no number.
    std::array::from_fn(|i| if by[i] == 0.0 { 0.0 } else { a[i] * by[i] })
}

/// `sum` = a x + b y.
fn sum(a: f64, x: Place, b: f64, y: Place) -> Place {
    std::array::from_fn(|i| a * x[i] + b * y[i])
}

/// The squared distance of a point from a box; 0 within.
fn from_box(m: Place, [lo, hi]: &[Place; 2]) -> f64 {
    let off: Place = std::array::from_fn(|i| (lo[i] - m[i]).max(m[i] - hi[i]).max(0.0));
    dot(off, off)
}

impl<'a> Scaled<'a> {
    /// `path` with the coordinates times `weights`, 1/σ, or 0 for one that is not measured.
    #[must_use]
    pub fn new(path: &'a Path, weights: Place) -> Self {
        let corners: Vec<Place> = path.vertices.iter().map(|vertex| scaled(vertex.at, weights)).collect();
        let around = |from: usize| {
            let some = &corners[from..(from + BOXED + 1).min(corners.len())];
            some.iter().fold([[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]], |[lo, hi], at| {
                [std::array::from_fn(|i| lo[i].min(at[i])), std::array::from_fn(|i| hi[i].max(at[i]))]
            })
        };
        let boxes = (0..corners.len().saturating_sub(1)).step_by(BOXED).map(around).collect();
        Self { path, corners, boxes, weights }
    }

    /// The foot of the point `m`, in units of noise; `None` where the path is nothing.
    #[must_use]
    pub fn nearest(&self, m: Place) -> Option<Nearest> {
        let vertices = &self.path.vertices;
        let mut best = (f64::INFINITY, 0, 0.0);
        let away: Vec<f64> = self.boxes.iter().map(|ends| from_box(m, ends)).collect();
        let first = (0..away.len()).min_by(|&a, &b| away[a].total_cmp(&away[b]))?;
        self.search(m, first, &mut best);
        for (i, away) in away.iter().enumerate() {
            // Of places that are equally near the first on the path counts.
            if i != first && *away <= best.0 {
                self.search(m, i, &mut best);
            }
        }
        let (distance, at, share) = best;
        if !distance.is_finite() {
            return None;
        }
        let piece = vertices[at].piece;
        match self.path.pieces.get(piece)? {
            Piece::Line([before, after]) => {
                let along = minus(scaled(*before, self.weights), scaled(*after, self.weights));
                let foot = match share {
                    share if share <= 0.0 => Foot::Outer,
                    share if share >= 1.0 => Foot::Inner,
                    share => Foot::Share(1.0 - share),
                };
                let c = scaled(self.path.foot(piece, foot)?, self.weights);
                self.told(piece, foot, minus(m, c), along)
            }
            Piece::Arc(_) => self.on_arc(m, at, share),
        }
    }

    /// Looks for a place nearer than `best`, its squared distance, its stretch and its share of that, in one box.
    fn search(&self, m: Place, boxed: usize, best: &mut (f64, usize, f64)) {
        let vertices = &self.path.vertices;
        let from = boxed * BOXED;
        for (i, pair) in self.corners.windows(2).enumerate().skip(from).take(BOXED) {
            if vertices[i].piece != vertices[i + 1].piece {
                continue;
            }
            let (along, from) = (minus(pair[1], pair[0]), minus(m, pair[0]));
            let share = (dot(from, along) / dot(along, along)).clamp(0.0, 1.0);
            let off = sum(1.0, from, if share.is_finite() { -share } else { 0.0 }, along);
            let distance = dot(off, off);
            if distance < best.0 || (distance <= best.0 && i < best.1) {
                *best = (distance, i, share);
            }
        }
    }

    /// The foot on an arc near the stretch from the corner `at` inward.
    fn on_arc(&self, m: Place, at: usize, share: f64) -> Option<Nearest> {
        let vertices = &self.path.vertices;
        let piece = vertices[at].piece;
        // Half the slope of the squared distance, outward.
        let look = |s: f64| -> Option<(f64, Place, Place)> {
            let (place, slopes) = self.path.at(s)?;
            let (off, along) = (minus(m, scaled(place, self.weights)), scaled(slopes, self.weights));
            Some((-dot(off, along), off, along))
        };
        let same = |i: usize| vertices.get(i).is_some_and(|vertex: &Vertex| vertex.piece == piece);
        let (mut outer, mut inner) = (at, at + 1);
        let clamped = |vertex: usize, foot: Foot, is_edge: bool| {
            let s = vertices[vertex].along;
            let (_, off, along) = look(s)?;
            self.told(piece, if is_edge { Foot::Radius(s) } else { foot }, off, along)
        };
        let mut hi = vertices[outer].along;
        while look(hi)?.0 < 0.0 {
            if outer == 0 || !same(outer - 1) {
                return clamped(outer, Foot::Outer, piece == 0);
            }
            inner = outer;
            outer -= 1;
            hi = vertices[outer].along;
        }
        let mut lo = vertices[inner].along;
        while look(lo)?.0 > 0.0 {
            if !same(inner + 1) {
                return clamped(inner, Foot::Inner, piece + 1 == self.path.pieces.len());
            }
            hi = lo;
            inner += 1;
            lo = vertices[inner].along;
        }
        let mut s = hi + (lo - hi) * if inner == at + 1 { share } else { 0.5 };
        let mut last: Option<(f64, f64)> = None;
        for _ in 0..STEPS {
            let (slope, off, along) = look(s)?;
            let length = dot(along, along);
            if slope > 0.0 {
                hi = s;
            } else {
                lo = s;
            }
            // By the curve's own bend after the first step.
            let bend = match last {
                Some((t, before)) => (slope - before) / (s - t),
                None => length,
            };
            // Of two places that are one it is no number.
            let bend = if bend > 0.1 * length { bend } else { length };
            let mut next = s - slope / bend;
            if !(next > lo && next < hi) {
                next = 0.5 * (lo + hi);
            }
            let way = (next - s).abs();
            if way * length.sqrt() <= FOUND || way <= 4.0 * f64::EPSILON * s {
                return self.told(piece, Foot::Radius(s), off, along);
            }
            last = Some((s, slope));
            s = next;
        }
        let (_, off, along) = look(s)?;
        self.told(piece, Foot::Radius(s), off, along)
    }

    /// The distances of `off` along the normals of `along`.
    fn told(&self, piece: usize, foot: Foot, off: Place, along: Place) -> Option<Nearest> {
        let length = dot(along, along).sqrt();
        if !(length > 0.0 && length.is_finite()) {
            return None;
        }
        let t = along.map(|x| x / length);
        let flat = hypot(t[0], t[1]);
        let first = [-t[1] / flat, t[0] / flat, 0.0];
        let space = self.weights[2] > 0.0;
        // t × first: with it the three are a frame.
        let second = if space {
            [-t[2] * first[1], t[2] * first[0], t[0] * first[1] - t[1] * first[0]]
        } else {
            [0.0; 3]
        };
        let (r, beside, beyond) = (dot(off, first), dot(off, second), dot(off, t));
        let is_inside = matches!(foot, Foot::Radius(_) | Foot::Share(_));
        if is_inside || beyond == 0.0 {
            return Some(Nearest { piece, foot, residuals: [r, beside], normals: [first, second] });
        }
        let whole = hypot(r, beyond).copysign(r);
        let normal = sum(r / whole, first, beyond / whole, t);
        Some(Nearest { piece, foot, residuals: [whole, beside], normals: [normal, second] })
    }
}
