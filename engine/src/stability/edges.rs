//! Makes sure that a line runs between any two neighbouring cells of a map with different numbers of snaps.
//!
//! Along the edge of the grid from one cell to the other, the snaps are counted on both sides of every line that
//! crosses it. Where they differ with no line between, the change is found by halving. If it is a cusp, a landing or a
//! start, it either begins a line, which is followed over the map, or is a point of a line that the chord between two
//! of its points just missed. Changes that are none of these are joined from edge to edge.

use super::count::NEARLY;
use super::equations::{Equations, Sort};
use super::family::Family;
use super::map::{Counts, Map, MapLine, MapPoint};
use crate::progress::Progress;

/// How far from a line the snaps are counted on both its sides, as a share of the edge.
const ASIDE: f64 = 0.05;

/// A line this far beyond the end of an edge, in shares of the map, still crosses it.
const TOUCHES: f64 = 1e-9;

/// A solution further than this from the change found by halving, in shares of the map, is not that change.
const SAME: f64 = 1e-4;

/// A solution this near to the chord between two points of a line, in waves and shares, is a point of that line.
const BESIDE: f64 = 0.01;

/// How many of the cusps and landings nearest to the change are tried, and how many changes are looked for on one edge.
const TRIED: usize = 4;
const MOST: usize = 12;

/// An edge of the grid: the axis it runs along, the share of the other one, and its ends.
#[derive(Debug, Clone, Copy)]
struct GridEdge {
    axis: usize,
    held: f64,
    ends: [f64; 2],
    /// Its cell at the lower end.
    cell: [usize; 2],
}

impl GridEdge {
    fn at(&self, share: f64) -> [f64; 2] {
        let mut at = [self.held; 2];
        at[self.axis] = share;
        at
    }
}

/// A place on an edge, and the snaps there.
#[derive(Debug, Clone, Copy)]
struct Counted {
    share: f64,
    snaps: Option<usize>,
}

/// A change that is on no line.
struct Loose {
    edge: GridEdge,
    point: MapPoint,
}

impl Family {
    /// Adds to `map` the lines that are missing between neighbouring cells of `counts`.
    pub(super) fn complete(&self, map: &mut Map, counts: &Counts, progress: &dyn Progress) {
        let mut loose = Vec::new();
        let [columns, rows] = counts.shares.each_ref().map(Vec::len);
        for i in 0..columns {
            progress.report(i as f64 / columns as f64);
            for j in 0..rows {
                for axis in [1, 0] {
                    let [u, v] = if axis == 0 { [i + 1, j] } else { [i, j + 1] };
                    if u >= columns || v >= rows || counts.cells[j][i] == counts.cells[v][u] {
                        continue;
                    }
                    let along = &counts.shares[axis];
                    let from = [i, j][axis];
                    let held = counts.shares[1 - axis][[i, j][1 - axis]];
                    let edge = GridEdge { axis, held, ends: [along[from], along[from + 1]], cell: [i, j] };
                    let known = [counts.cells[j][i], counts.cells[v][u]];
                    loose.extend(self.explain(edge, known, map, progress));
                    if progress.stop() {
                        return;
                    }
                }
            }
        }
        if !loose.is_empty() {
            map.notes.push(words(loose.len()));
            map.lines.extend(joined(&loose, counts));
        }
    }

    /// Accounts for the changes along an edge between these numbers of snaps; returns the first change that is on no
    /// line.
    fn explain(
        &self,
        edge: GridEdge,
        known: [Option<usize>; 2],
        map: &mut Map,
        progress: &dyn Progress,
    ) -> Option<Loose> {
        let [from, to] = edge.ends;
        let aside = ASIDE * (to - from);
        let mut last = None;
        for _ in 0..MOST {
            // In pairs: before the first line, between each two lines, and behind the last.
            let mut stops = vec![Counted { share: from, snaps: known[0] }];
            for share in map.crossings(edge) {
                let [before, after] = [-aside, aside].map(|by| (share + by).clamp(from, to));
                if before > stops.last().map_or(from, |last| last.share) {
                    stops.extend([before, after].map(|share| self.counted(edge, share)));
                } else if let Some(last) = stops.last_mut() {
                    // A line next to another one, or at the end of the edge.
                    *last = self.counted(edge, after);
                }
            }
            stops.push(Counted { share: to, snaps: known[1] });
            if stops.len() == 2 && stops[0].share >= to {
                return None;
            }
            let open = stops.chunks_exact(2).find(|ends| ends[0].snaps != ends[1].snaps)?;
            let change = self.first_change(edge, [open[0], open[1]]);
            last = Some(change);
            if progress.stop() {
                return None;
            }
            if !self.on_line(edge, change, map, progress) {
                break;
            }
        }
        last.and_then(|change| self.loose(edge, change))
    }

    fn counted(&self, edge: GridEdge, share: f64) -> Counted {
        Counted { share, snaps: self.passage(&edge.at(share)).map(|path| path.snaps) }
    }

    /// The first change between two places of an edge, as its two sides.
    fn first_change(&self, edge: GridEdge, [mut a, mut b]: [Counted; 2]) -> [Counted; 2] {
        for _ in 0..NEARLY {
            let here = self.counted(edge, 0.5 * (a.share + b.share));
            if here.snaps == a.snaps { a = here } else { b = here }
        }
        [a, b]
    }

    /// Whether the change is a cusp, a landing or a start; if so, it is on a line of `map` afterwards.
    fn on_line(
        &self,
        edge: GridEdge,
        [before, after]: [Counted; 2],
        map: &mut Map,
        progress: &dyn Progress,
    ) -> bool {
        let share = 0.5 * (before.share + after.share);
        let at = edge.at(share);
        let held = 1 - edge.axis;
        let same = SAME.min(0.5 * ASIDE * (edge.ends[1] - edge.ends[0]));
        let mut tried: Vec<(Sort, Vec<f64>)> = Vec::new();
        let unit = Equations::new(self, Sort::Cusp).unit;
        let member = self.member(&at);
        let root = member.as_ref().map_or(f64::NAN, |member| member.root);
        let mut cusps = self.cusps(&at);
        cusps.sort_by(|a, b| (a.value - root).abs().total_cmp(&(b.value - root).abs()));
        let cusps = cusps.iter().take(TRIED).map(|cusp| vec![cusp.contact_radius / unit, at[0], at[1]]);
        tried.extend(cusps.map(|y| (Sort::Cusp, y)));
        let mut crests: Vec<[f64; 2]> = Vec::new();
        for path in [after, before].into_iter().filter_map(|counted| self.passage(&edge.at(counted.share))) {
            let minima = path.minima.iter().enumerate();
            let mut pairs: Vec<([f64; 2], f64)> = minima
                .flat_map(|(k, outer)| path.minima[..k].iter().map(move |inner| (outer, inner)))
                .map(|(outer, inner)| ([outer[0], inner[0]], (outer[1] - inner[1]).abs()))
                .collect();
            pairs.sort_by(|a, b| a.1.total_cmp(&b.1));
            let pairs = pairs.iter().take(TRIED).map(|(radii, _)| {
                let [outer, inner] = radii.map(|s| s / unit);
                vec![outer, inner, at[0], at[1]]
            });
            tried.extend(pairs.map(|y| (Sort::Landing, y)));
            crests.extend(path.crests);
        }
        if let Some(start) = self.start() {
            tried.push((Sort::Start, at.to_vec()));
            let value = member
                .as_ref()
                .ok()
                .and_then(|member| member.local(start))
                .map(|local| local.control_value());
            let off = |crest: &[f64; 2]| value.map_or(f64::NAN, |value| (crest[1] - value).abs());
            crests.sort_by(|a, b| off(a).total_cmp(&off(b)));
            let crests = crests.iter().take(TRIED).map(|[s, _]| vec![s / unit, at[0], at[1]]);
            tried.extend(crests.map(|y| (Sort::Arrival, y)));
        }
        tried.into_iter().any(|(sort, y)| {
            let of = Equations::new(self, sort);
            let found = of.polished(&y, of.radii() + held);
            let near = found.filter(|y| (y[of.radii() + edge.axis] - share).abs() <= same);
            near.is_some_and(|mut y| {
                // If the change is at the border of the map, keep the solution on the map.
                y[of.radii() + edge.axis] = y[of.radii() + edge.axis].clamp(edge.ends[0], edge.ends[1]);
                of.is_good(&y) && self.add(&of, &y, map, progress)
            })
        })
    }

    /// Adds a solution to the line it lies on, or its line to the map; returns whether there is one.
    fn add(&self, of: &Equations<'_>, y: &[f64], map: &mut Map, progress: &dyn Progress) -> bool {
        let lines = map.lines.iter_mut().filter(|line| line.sort == Some(of.sort));
        let nearest = lines.filter_map(|line| line.nearest(y).map(|(off, k)| (off, k, line)));
        if let Some((off, k, line)) = nearest.min_by(|a, b| a.0.total_cmp(&b.0))
            && off <= BESIDE
            && let Some(point) = self.map_point(of, y)
        {
            line.points.insert(k + 1, point);
            line.solutions.insert(k + 1, y.to_vec());
            return true;
        }
        let traced = of.line(y, progress).map(|line| self.map_line(of, &line));
        let Some(line) = traced.filter(|line| line.points.len() > 1) else { return false };
        map.lines.push(line);
        true
    }

    fn loose(&self, edge: GridEdge, [before, after]: [Counted; 2]) -> Option<Loose> {
        let at = edge.at(0.5 * (before.share + after.share));
        let path = [before, after].iter().find_map(|counted| self.passage(&edge.at(counted.share)))?;
        let s = path.jumps.first().copied().unwrap_or(path.radii[1]);
        let point = self.point_at(&at, s).unwrap_or(MapPoint {
            contact_radius: s,
            at,
            control_value: f64::NAN,
            approach: f64::NAN,
            force: f64::NAN,
        });
        Some(Loose { edge, point })
    }
}

impl Map {
    /// The shares at which lines cross an edge, ascending.
    fn crossings(&self, edge: GridEdge) -> Vec<f64> {
        let (along, across) = (edge.axis, 1 - edge.axis);
        let [lo, hi] = [edge.ends[0] - TOUCHES, edge.ends[1] + TOUCHES];
        let mut found = Vec::new();
        for pair in self.lines.iter().flat_map(|line| line.points.windows(2)) {
            let [a, b] = [pair[0].at, pair[1].at];
            let [off, other] = [a[across] - edge.held, b[across] - edge.held];
            if a[along].max(b[along]) < lo || a[along].min(b[along]) > hi {
                continue;
            }
            if off.abs() <= TOUCHES {
                found.push(a[along]);
            }
            if other.abs() <= TOUCHES {
                found.push(b[along]);
            }
            if off * other < 0.0 {
                found.push(a[along] + off / (off - other) * (b[along] - a[along]));
            }
        }
        found.retain(|share| lo <= *share && *share <= hi);
        found.sort_by(f64::total_cmp);
        found
    }
}

impl MapLine {
    /// The distance of the solution `y` from the nearest chord, in waves and shares, and the number of that chord.
    fn nearest(&self, y: &[f64]) -> Option<(f64, usize)> {
        let chords = self.solutions.windows(2).enumerate().map(|(k, pair)| {
            let along = pair[0].iter().zip(&pair[1]).map(|(a, b)| b - a);
            let off = pair[0].iter().zip(y).map(|(a, y)| y - a);
            let (mut dot, mut square) = (0.0, f64::MIN_POSITIVE);
            for (off, along) in off.clone().zip(along.clone()) {
                dot += off * along;
                square += along * along;
            }
            let share = (dot / square).clamp(0.0, 1.0);
            (off.zip(along).map(|(off, along)| (off - share * along).powi(2)).sum::<f64>().sqrt(), k)
        });
        chords.min_by(|a, b| a.0.total_cmp(&b.0))
    }
}

/// The note on changes that are on no line of cusps, landings or starts.
fn words(count: usize) -> String {
    format!(
        "between {count} pairs of neighbouring cells the number of snaps changes without a cusp, landing or limit \
         point at the start: the path ends or begins elsewhere there, or the law has a corner; lines of kind change \
         join these places from cell to cell"
    )
}

/// The lines through loose changes: in a cell with two of them from one to the other, otherwise to its middle.
fn joined(loose: &[Loose], counts: &Counts) -> Vec<MapLine> {
    let [columns, rows] = counts.shares.each_ref().map(Vec::len);
    let mut lines = Vec::new();
    for j in 0..rows.saturating_sub(1) {
        for i in 0..columns.saturating_sub(1) {
            let around = |Loose { edge, .. }: &&Loose| {
                let [u, v] = edge.cell;
                if edge.axis == 0 {
                    u == i && (v == j || v == j + 1)
                } else {
                    v == j && (u == i || u == i + 1)
                }
            };
            let here: Vec<MapPoint> = loose.iter().filter(around).map(|loose| loose.point).collect();
            let line = |points: Vec<MapPoint>| MapLine { points, ..MapLine::default() };
            if let [a, b] = here[..] {
                lines.push(line(vec![a, b]));
                continue;
            }
            let [x, y] = [(0, i), (1, j)].map(|(axis, k)| {
                let shares: &[f64] = &counts.shares[axis];
                0.5 * (shares[k] + shares[k + 1])
            });
            lines.extend(here.iter().map(|point| line(vec![*point, MapPoint { at: [x, y], ..*point }])));
        }
    }
    lines
}
