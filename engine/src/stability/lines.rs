//! Lines followed by the tracer from known points on them, up to the border of the map.

use super::equations::{Equations, Sort};
use crate::continuation::{Bracket, Point, Tracer, Vector};
use crate::progress::Progress;

/// A line that comes back to within this of its start is closed.
const CLOSED: f64 = 0.03;

/// A point this near to a line, in waves and shares, is on it.
const ON_LINE: f64 = 0.05;

/// A line of a map: its points, each with radii (in the unit of the equations) and shares, and the places of its
/// swallowtails.
#[derive(Debug, Clone, PartialEq)]
pub struct Traced {
    /// The points in order.
    pub points: Vec<Vec<f64>>,
    /// The swallowtails of a line of cusps, or the cusps of a line of limit points.
    pub tips: Vec<Vec<f64>>,
}

impl Traced {
    /// Whether the solution `y` lies on the line.
    pub fn has(&self, y: &[f64]) -> bool {
        self.points.windows(2).any(|pair| {
            let (a, b) = (Vector::from_column_slice(&pair[0]), Vector::from_column_slice(&pair[1]));
            let (y, along) = (Vector::from_column_slice(y), &b - &a);
            let share = ((&y - &a).dot(&along) / along.norm_squared()).clamp(0.0, 1.0);
            (y - a - along * share).norm() <= ON_LINE
        })
    }
}

impl Equations<'_> {
    /// Whether a solution is on the map and meaningful there.
    pub(super) fn is_good(&self, y: &[f64]) -> bool {
        let radii = self.radii();
        let [end, start] = self.family.radii.map(|s| s / self.unit);
        let known = y[..radii].iter().all(|s| (end..=start).contains(s));
        let inside = y[radii..].iter().all(|share| (0.0..=1.0).contains(share));
        let locals = || self.locals(y).unwrap_or_default();
        let is_met = match self.sort {
            // A jump begins and lands at minima of the control.
            Sort::Landing => y[0] - y[1] > 1e-3 && locals().iter().all(|local| local.edge.slope > 0.0),
            // A maximum further out than the start, which is unstable.
            Sort::Arrival => matches!(locals()[..], [crest, start]
                if crest.contact_radius > start.contact_radius
                    && crest.edge.slope < 0.0
                    && start.edge.value < start.root),
            Sort::Fold | Sort::Cusp | Sort::Start => true,
        };
        known && inside && is_met
    }

    /// The line through the solution `y`, in both directions from it.
    pub fn line(&self, y: &[f64], progress: &dyn Progress) -> Option<Traced> {
        let n = y.len();
        let forward: Vec<f64> =
            (0..n).map(|k| if k + 1 == n { 1.0 } else { 0.37 / (k + 1) as f64 }).collect();
        let start = self.point(y, &forward)?;
        let mut tracer = Tracer::new(self, self.settings());
        let mut half = |start: Point| {
            let mut points = vec![start];
            tracer.length = tracer.settings.first;
            let mut closed = false;
            while points.len() < tracer.settings.points && !progress.stop() {
                let last = &points[points.len() - 1];
                let Ok(next) = tracer.step(last) else { break };
                let far = points.len() > 10;
                closed = far && (next.y() - points[0].y()).norm() < CLOSED;
                let good = self.is_good(next.y().as_slice());
                if !good {
                    points.extend(self.border(last, &next));
                    break;
                }
                points.push(next);
                if closed {
                    break;
                }
            }
            (points, closed)
        };
        let (ahead, closed) = half(start.clone());
        let mut points = if closed { Vec::new() } else { half(start.reversed()).0 };
        points.reverse();
        points.pop();
        // All in the same direction as the first half.
        let mut points: Vec<Point> = points.into_iter().map(Point::reversed).collect();
        points.extend(ahead);
        if closed {
            points.extend(points.first().cloned());
        }
        let tips = match self.sort {
            Sort::Cusp | Sort::Fold => self.tips(&points),
            Sort::Landing | Sort::Start | Sort::Arrival => Vec::new(),
        };
        let points = points.iter().map(|point| point.y().as_slice().to_vec()).collect();
        Some(Traced { points, tips })
    }

    /// The point at which the line leaves the map between two others, located by the unknown that leaves first.
    fn border(&self, from: &Point, to: &Point) -> Option<Point> {
        let (from, to) = (from.y(), to.y());
        let [end, start] = self.family.radii.map(|s| s / self.unit);
        let mut first: Option<(f64, usize, f64)> = None;
        for k in 0..from.len() {
            let range = if k < self.radii() { [end, start] } else { [0.0, 1.0] };
            for limit in range {
                let share = (limit - from[k]) / (to[k] - from[k]);
                if (0.0..=1.0).contains(&share) && first.is_none_or(|(known, ..)| share < known) {
                    first = Some((share, k, limit));
                }
            }
        }
        let (share, k, limit) = first?;
        let mut y: Vec<f64> = from.iter().zip(to.iter()).map(|(a, b)| a + share * (b - a)).collect();
        y[k] = limit;
        let y = self.polished(&y, k)?;
        let chord: Vec<f64> = from.iter().zip(to.iter()).map(|(a, b)| b - a).collect();
        self.point(&y, &chord)
    }

    /// The swallowtails of a line of cusps, where both numbers turn; the cusps of a line of limit points, where its one
    /// number turns.
    fn tips(&self, points: &[Point]) -> Vec<Vec<f64>> {
        let mut tracer = Tracer::new(self, self.settings());
        let mut row = Vector::zeros(points.first().map_or(0, |point| point.y().len()));
        let Some(last) = row.len().checked_sub(1) else { return Vec::new() };
        row[last] = 1.0;
        let bend = |point: &Point| {
            let locals = self.locals(point.y().as_slice());
            locals.and_then(|locals| {
                locals
                    .first()
                    .map(|local| if self.sort == Sort::Fold { local.edge.slope } else { local.edge.bend })
            })
        };
        let turned = points.windows(2).enumerate().filter(|(_, pair)| {
            let [a, b] = [bend(&pair[0]), bend(&pair[1])];
            a.zip(b).is_some_and(|(a, b)| (a > 0.0) != (b > 0.0))
        });
        turned
            .filter_map(|(index, pair)| {
                let bracket = Bracket { index, from: pair[0].clone(), to: pair[1].clone() };
                let located = tracer.limit_point(&bracket, &row).ok()?;
                Some(located.point.y().as_slice().to_vec())
            })
            .collect()
    }
}
