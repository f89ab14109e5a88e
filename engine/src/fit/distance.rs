//! The signed distance of a point from a path, in units of its noise.
//!
//! ```text
//! c(s) = (x/σ_x, P/σ_P[, s/σ_s]),     (m − c)·c' = 0 at the foot,     r = (m − c)·n
//! ```
//!
//! The polyline gives the stretch on which the foot lies; there the foot is the root of (m − c)·c', with the exact c'.
//! An error ε of the foot changes r by ε² times the curvature. At the ends of a piece the distance is that from the
//! end, with the sign that it has beside the end.

use super::path::{FitPath, Foot, PathPiece, PathPlace, Vertex};
use crate::elementary::hypot;

/// The foot of a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Nearest {
    /// The piece of the path.
    pub piece: usize,
    /// Where on it.
    pub foot: Foot,
    /// The place of the foot on the path.
    pub at: PathPlace,
    /// The distances along the normals, one in a plane, two in space.
    pub residuals: [f64; 2],
    /// The derivatives of the residuals with respect to the scaled point.
    pub normals: [PathPlace; 2],
}

/// A path in units of noise.
#[derive(Debug)]
pub struct ScaledPath<'a> {
    path: &'a FitPath,
    corners: Vec<PathPlace>,
    /// The derivatives with respect to s at the corners.
    slopes: Vec<PathPlace>,
    /// The ends of the boxes around [`BOXED`] stretches each.
    boxes: Vec<[PathPlace; 2]>,
    /// The ends of the boxes around [`BOXED`] boxes each.
    chests: Vec<[PathPlace; 2]>,
    weights: PathPlace,
}

/// The foot is found once it moves along the curve by less than this, in units of noise.
const FOUND: f64 = 1e-8;
const STEPS: usize = 60;
/// The number of stretches of the polyline that are skipped together where their box is too far away, and of boxes
/// where the one around them is.
const BOXED: usize = 8;

fn minus(a: PathPlace, b: PathPlace) -> PathPlace {
    std::array::from_fn(|i| a[i] - b[i])
}

fn dot(a: PathPlace, b: PathPlace) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn scaled(a: PathPlace, by: PathPlace) -> PathPlace {
    // A coordinate without weight may be not a number.
    std::array::from_fn(|i| if by[i] == 0.0 { 0.0 } else { a[i] * by[i] })
}

/// `sum` = a x + b y.
fn sum(a: f64, x: PathPlace, b: f64, y: PathPlace) -> PathPlace {
    std::array::from_fn(|i| a * x[i] + b * y[i])
}

/// The squared distance of a point from a box; 0 within.
fn from_box(m: PathPlace, [lo, hi]: &[PathPlace; 2]) -> f64 {
    let off: PathPlace = std::array::from_fn(|i| (lo[i] - m[i]).max(m[i] - hi[i]).max(0.0));
    dot(off, off)
}

/// The box around some.
fn around(some: impl Iterator<Item = [PathPlace; 2]>) -> [PathPlace; 2] {
    some.fold([[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]], |[lo, hi], ends| {
        [std::array::from_fn(|i| lo[i].min(ends[0][i])), std::array::from_fn(|i| hi[i].max(ends[1][i]))]
    })
}

impl<'a> ScaledPath<'a> {
    /// `path` with the coordinates times `weights`, 1/σ, or 0 for one that is not measured.
    #[must_use]
    pub fn new(path: &'a FitPath, weights: PathPlace) -> Self {
        let corners: Vec<PathPlace> = path.vertices.iter().map(|vertex| scaled(vertex.at, weights)).collect();
        let slopes = path.vertices.iter().map(|vertex| scaled(vertex.slopes, weights)).collect();
        let boxes: Vec<[PathPlace; 2]> = (0..corners.len().saturating_sub(1))
            .step_by(BOXED)
            .map(|from| {
                around(corners[from..(from + BOXED + 1).min(corners.len())].iter().map(|at| [*at; 2]))
            })
            .collect();
        let chests = boxes.chunks(BOXED).map(|some| around(some.iter().copied())).collect();
        Self { path, corners, slopes, boxes, chests, weights }
    }

    /// The foot of the point `m`, in units of noise; `None` where the path is empty. `box_of_last` is the box that
    /// holds the foot of the previous point and is searched first: rows that follow each other lie near each other.
    pub fn nearest(&self, m: PathPlace, box_of_last: &mut usize) -> Option<Nearest> {
        let vertices = &self.path.vertices;
        let mut best = (f64::INFINITY, 0, 0.0);
        let first = *box_of_last;
        self.search(m, first, &mut best);
        for (chest, ends) in self.chests.iter().enumerate() {
            if from_box(m, ends) > best.0 {
                continue;
            }
            let boxes = self.boxes.iter().enumerate().skip(chest * BOXED).take(BOXED);
            for (i, ends) in boxes {
                // Of equally near places the first on the path counts.
                if i != first && from_box(m, ends) <= best.0 {
                    self.search(m, i, &mut best);
                }
            }
        }
        *box_of_last = best.1 / BOXED;
        let (distance, at, share) = best;
        if !distance.is_finite() {
            return None;
        }
        let piece = vertices[at].piece;
        match self.path.pieces.get(piece)? {
            PathPiece::Line([before, after]) => {
                let along = minus(scaled(*before, self.weights), scaled(*after, self.weights));
                let foot = match share {
                    share if share <= 0.0 => Foot::Outer,
                    share if share >= 1.0 => Foot::Inner,
                    share => Foot::Share(1.0 - share),
                };
                let at = self.path.foot(piece, foot)?;
                told(self.weights, piece, (foot, at), minus(m, scaled(at, self.weights)), along)
            }
            PathPiece::Arc(_) => self.on_arc(m, at),
        }
    }

    /// Looks for a place nearer than `best`, its squared distance, its stretch and its share of that, in one box.
    fn search(&self, m: PathPlace, boxed: usize, best: &mut (f64, usize, f64)) {
        let vertices = &self.path.vertices;
        let from = boxed * BOXED;
        for (i, pair) in self.corners.windows(2).enumerate().skip(from).take(BOXED) {
            if vertices[i].piece != vertices[i + 1].piece {
                continue;
            }
            let (along, from) = (minus(pair[1], pair[0]), minus(m, pair[0]));
            let square = dot(along, along);
            if square == 0.0 {
                // A line between equal states has no direction; the arc that begins there has one.
                continue;
            }
            let share = (dot(from, along) / square).clamp(0.0, 1.0);
            let off = sum(1.0, from, if share.is_finite() { -share } else { 0.0 }, along);
            let distance = dot(off, off);
            if distance < best.0 || (distance <= best.0 && i < best.1) {
                *best = (distance, i, share);
            }
        }
    }

    /// The foot on an arc near the stretch from the corner `at` inward.
    fn on_arc(&self, m: PathPlace, at: usize) -> Option<Nearest> {
        let vertices = &self.path.vertices;
        let piece = vertices[at].piece;
        // Half the slope of the squared distance, outward.
        let slope = |vertex: usize| -dot(minus(m, self.corners[vertex]), self.slopes[vertex]);
        let same = |i: usize| vertices.get(i).is_some_and(|vertex: &Vertex| vertex.piece == piece);
        let clamped = |vertex: usize, foot: Foot, is_edge: bool| {
            let Vertex { at, along, .. } = vertices[vertex];
            let foot = if is_edge { Foot::Radius(along) } else { foot };
            told(self.weights, piece, (foot, at), minus(m, self.corners[vertex]), self.slopes[vertex])
        };
        let (mut outer, mut inner) = (at, at + 1);
        while slope(outer) < 0.0 {
            if outer == 0 || !same(outer - 1) {
                return clamped(outer, Foot::Outer, piece == 0);
            }
            inner = outer;
            outer -= 1;
        }
        while slope(inner) > 0.0 {
            if !same(inner + 1) {
                return clamped(inner, Foot::Inner, piece + 1 == self.path.pieces.len());
            }
            outer = inner;
            inner += 1;
        }
        let bridge = Bridge {
            ends: [self.corners[inner], self.corners[outer]],
            slopes: [self.slopes[inner], self.slopes[outer]],
            way: vertices[outer].along - vertices[inner].along,
        };
        let (mut lo, mut hi) = (vertices[inner].along, vertices[outer].along);
        let share = bridge.foot(m);
        let mut s = lo + share * bridge.way;
        let mut last: Option<(f64, f64)> = None;
        for step in 0..=STEPS {
            let (place, slopes) = self.path.at(s)?;
            let (off, along) = (minus(m, scaled(place, self.weights)), scaled(slopes, self.weights));
            let (slope, length) = (-dot(off, along), dot(along, along));
            if slope > 0.0 {
                hi = s;
            } else {
                lo = s;
            }
            // By the bend of the bridge at first, and by the curve's own after the first step.
            let bend = match last {
                Some((t, before)) => (slope - before) / (s - t),
                None => length - dot(off, bridge.bend(share)),
            };
            // Between two places that coincide it is not a number.
            let bend = if bend > 0.1 * length { bend } else { length };
            let mut next = s - slope / bend;
            if !(next > lo && next < hi) {
                next = 0.5 * (lo + hi);
            }
            let way = (next - s).abs();
            if step == STEPS || way * length.sqrt() <= FOUND || way <= 4.0 * f64::EPSILON * s {
                return told(self.weights, piece, (Foot::Radius(s), place), off, along);
            }
            last = Some((s, slope));
            s = next;
        }
        None
    }
}

/// The cubic between two corners of an arc, with the slopes of the curve at both: close to the curve, and known without
/// evaluating it.
struct Bridge {
    /// The inner end, and the outer.
    ends: [PathPlace; 2],
    slopes: [PathPlace; 2],
    /// The difference of s between them.
    way: f64,
}

impl Bridge {
    /// The place at a share of the way and its first two derivatives with respect to the share.
    fn at(&self, t: f64) -> [PathPlace; 3] {
        let [a, b] = self.ends;
        let weights = [
            [t * (1.0 - t) * (1.0 - t), t * t * (t - 1.0), t * t * (3.0 - 2.0 * t)],
            [(1.0 - t) * (1.0 - 3.0 * t), t * (3.0 * t - 2.0), 6.0 * t * (1.0 - t)],
            [6.0 * t - 4.0, 6.0 * t - 2.0, 6.0 - 12.0 * t],
        ];
        let mut places = weights.map(|[inner, outer, there]| {
            std::array::from_fn(|i| {
                self.way * (inner * self.slopes[0][i] + outer * self.slopes[1][i]) + there * (b[i] - a[i])
            })
        });
        places[0] = sum(1.0, places[0], 1.0, a);
        places
    }

    /// The second derivative with respect to s.
    fn bend(&self, t: f64) -> PathPlace {
        self.at(t)[2].map(|x| x / (self.way * self.way))
    }

    /// The share of the way at which the point `m` has its foot.
    fn foot(&self, m: PathPlace) -> f64 {
        const TIMES: usize = 20;
        const NEAR: f64 = 1e-12;
        let (mut lo, mut hi, mut t) = (0.0, 1.0, 0.5);
        for _ in 0..TIMES {
            let [place, along, bend] = self.at(t);
            let off = minus(m, place);
            let slope = -dot(off, along);
            if slope > 0.0 {
                hi = t;
            } else {
                lo = t;
            }
            let rise = dot(along, along) - dot(off, bend);
            let mut next = t - slope / rise;
            if !(next > lo && next < hi) {
                next = 0.5 * (lo + hi);
            }
            if (next - t).abs() <= NEAR {
                return next;
            }
            t = next;
        }
        t
    }
}

/// The distances of `off` along the normals of `along`.
fn told(
    weights: PathPlace,
    piece: usize,
    (foot, at): (Foot, PathPlace),
    off: PathPlace,
    along: PathPlace,
) -> Option<Nearest> {
    let length = dot(along, along).sqrt();
    if !(length > 0.0 && length.is_finite()) {
        return None;
    }
    let t = along.map(|x| x / length);
    let flat = hypot(t[0], t[1]);
    let first = [-t[1] / flat, t[0] / flat, 0.0];
    let space = weights[2] > 0.0;
    // t × first: it completes the frame.
    let second =
        if space { [-t[2] * first[1], t[2] * first[0], t[0] * first[1] - t[1] * first[0]] } else { [0.0; 3] };
    let (r, beside, beyond) = (dot(off, first), dot(off, second), dot(off, t));
    let is_inside = matches!(foot, Foot::Radius(_) | Foot::Share(_));
    if is_inside || beyond == 0.0 {
        return Some(Nearest { piece, foot, at, residuals: [r, beside], normals: [first, second] });
    }
    let whole = hypot(r, beyond).copysign(r);
    let normal = sum(r / whole, first, beyond / whole, t);
    Some(Nearest { piece, foot, at, residuals: [whole, beside], normals: [normal, second] })
}
