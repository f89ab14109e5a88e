//! The map of two numbers: lines of cusps, landings and starts, and the number of snaps in every cell.

use super::count::{Passage, even};
use super::equations::{Equations, Sort};
use super::family::{AxisShares, Family, FamilyError};
use super::law::adhesion_of;
use super::lines::Traced;
use crate::elementary::hypot;
use crate::gap::Gap;
use crate::progress::{Progress, ProgressPart, Stopped};

/// Columns of the map in which cusps are looked for.
const CUSP_COLUMNS: u32 = 24;

/// Cells per side of the grid on which cusps are looked for if neither number is the work of adhesion.
const CUSP_CELLS: u32 = 14;

/// How far from a line the snaps are counted on both its sides, in shares.
const ASIDE: f64 = 1e-4;

/// A point of a line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MapPoint {
    /// s, reduced.
    pub contact_radius: f64,
    /// The shares of both axes; zero for an axis that does not exist.
    pub at: [f64; 2],
    /// The weighted control there.
    pub control_value: f64,
    /// δ.
    pub approach: f64,
    /// P.
    pub force: f64,
}

/// A line of a map.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct MapLine {
    /// What it consists of; `None` where the number of snaps changes for some other reason.
    pub sort: Option<Sort>,
    /// The crest it lies at, numbered from the axis; none without a wave.
    pub crest: Option<u32>,
    /// Its points in order.
    pub points: Vec<MapPoint>,
    /// Its swallowtails.
    pub tips: Vec<MapPoint>,
    /// At each point, whether the number of snaps differs on its two sides; empty until that is known.
    pub changes: Vec<bool>,
    /// The unknowns of its equations at each point; empty if it has no equations.
    pub(super) solutions: Vec<Vec<f64>>,
}

/// The lines of a map.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Map {
    /// The lines.
    pub lines: Vec<MapLine>,
    /// Remarks about the lines.
    pub notes: Vec<String>,
}

/// The number of snaps over a map.
#[derive(Debug, Clone, PartialEq)]
pub struct Counts {
    /// The shares of the columns and of the rows.
    pub shares: [Vec<f64>; 2],
    /// The snaps, one row per share up the map; none where there is no path.
    pub cells: Vec<Vec<Option<usize>>>,
}

impl Family {
    /// The map of both axes, with the snaps on a grid of this many columns and rows: between two neighbouring cells
    /// with different numbers of snaps there is a line.
    ///
    /// # Errors
    /// [`FamilyError::Stopped`]; also if the gap cannot be tabulated somewhere, or a value is out of its range.
    pub fn map(&mut self, cells: [u32; 2], progress: &dyn Progress) -> Result<(Map, Counts), FamilyError> {
        let mut map = Map::default();
        let counted = self.counts(cells, &ProgressPart::new(progress, [0.0, 0.4]));
        let (counts, radii) = counted.ok_or(Stopped)?;
        if let Some(radii) = radii {
            map.notes.extend(self.widen(radii).err());
        }
        self.draw(&mut map, progress)?;
        self.complete(&mut map, &counts, &ProgressPart::new(progress, [0.5, 0.8]));
        self.mark_changes(&mut map, &ProgressPart::new(progress, [0.8, 1.0]));
        let corners = self.member(&[0.5; 2]).and_then(|member| member.law(&[0.5; 2]));
        if corners.is_ok_and(|law| !law.cusps(self.radii).1.is_empty()) {
            map.notes.push(
                "the second derivative of the gap jumps: there the law has corners, which are not cusps, and pairs \
                 of limit points that begin at them are not on a line of cusps"
                    .to_owned(),
            );
        }
        Ok(progress.go_on().map(|()| (map, counts))?)
    }

    /// The lines that are looked for all over the map, whether or not the number of snaps changes across them.
    fn draw(&self, map: &mut Map, progress: &dyn Progress) -> Result<(), FamilyError> {
        let cusps = Equations::new(self, Sort::Cusp);
        if let Some(lines) = self.explicit_cusps(progress)? {
            for (points, tips) in lines {
                let known = points.iter().filter_map(|born| {
                    let y = vec![born.contact_radius / cusps.unit, born.at[0], born.at[1]];
                    Some((self.point_at(&born.at, born.contact_radius)?, y))
                });
                let (points, solutions) = known.unzip();
                let tips = tips.iter().filter_map(|born| self.point_at(&born.at, born.contact_radius));
                let tips = tips.collect();
                map.lines.push(self.line_of(Sort::Cusp, points, solutions, tips));
            }
        } else {
            self.follow(&cusps, self.cusp_starts(progress), map, progress);
        }
        if self.start().is_some() {
            let starts = Equations::new(self, Sort::Start);
            self.follow(&starts, self.start_starts(progress), map, progress);
        }
        map.lines.retain(|line| line.points.len() > 1);
        Ok(())
    }

    /// Traces the lines through those of `starts` that are not yet on a line.
    fn follow(&self, of: &Equations<'_>, starts: Vec<Vec<f64>>, map: &mut Map, progress: &dyn Progress) {
        let mut known: Vec<Traced> = Vec::new();
        for y in starts {
            if progress.stop() {
                return;
            }
            if known.iter().any(|line| line.has(&y)) {
                continue;
            }
            let Some(line) = of.line(&y, progress) else { continue };
            map.lines.push(self.map_line(of, &line));
            known.push(line);
        }
    }

    /// A line of the tracer as a line of the map.
    pub(super) fn map_line(&self, of: &Equations<'_>, line: &Traced) -> MapLine {
        let known = line.points.iter().filter_map(|y| Some((self.map_point(of, y)?, y.clone())));
        let (points, solutions) = known.unzip();
        let tips = line.tips.iter().filter_map(|y| self.map_point(of, y)).collect();
        self.line_of(of.sort, points, solutions, tips)
    }

    /// A solution as a point of the map.
    pub(super) fn map_point(&self, of: &Equations<'_>, y: &[f64]) -> Option<MapPoint> {
        let (radii, shares) = y.split_at(of.radii());
        let s = radii.first().map_or_else(|| self.start(), |s| Some(s * of.unit))?;
        self.point_at(&[shares[0], shares[1]], s)
    }

    fn line_of(
        &self,
        sort: Sort,
        points: Vec<MapPoint>,
        solutions: Vec<Vec<f64>>,
        tips: Vec<MapPoint>,
    ) -> MapLine {
        let middle = points.get(points.len() / 2);
        let crest = middle.and_then(|point| self.crest(point.contact_radius));
        MapLine { sort: Some(sort), crest, points, tips, changes: Vec::new(), solutions }
    }

    /// The number of the crest nearest to the radius `s`, reduced, from the axis.
    pub fn crest(&self, s: f64) -> Option<u32> {
        let wave = self.preset.gap.wavelength()? / self.length;
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "rounded, and from 0 to some thousand"
        )]
        Some((s / wave).round().clamp(0.0, 1e9) as u32)
    }

    /// The limit point at these shares and the radius `s`, reduced.
    pub fn point_at(&self, at: AxisShares<'_>, s: f64) -> Option<MapPoint> {
        let local = self.member(at).ok()?.local(s)?;
        let (approach, force, control_value) = (local.approach(), local.force(), local.control_value());
        let at = [0, 1].map(|k| at.get(k).copied().unwrap_or(0.0));
        Some(MapPoint { contact_radius: s, at, control_value, approach, force })
    }

    /// Points on lines of cusps.
    fn cusp_starts(&self, progress: &dyn Progress) -> Vec<Vec<f64>> {
        let of = Equations::new(self, Sort::Cusp);
        if let (Some(adhesion), Some(factor)) = (self.adhesion(), self.adhesion_factor()) {
            // Where the adhesion is an axis, every cusp of the law is a cusp of the map.
            let other = 1 - adhesion;
            let mut starts = Vec::new();
            for share in even(CUSP_COLUMNS) {
                if progress.stop() {
                    break;
                }
                let mut at = [0.5; 2];
                at[other] = share;
                for cusp in self.cusps(&at) {
                    at[adhesion] = self.axes[adhesion].share(adhesion_of(cusp.value) / factor);
                    if (0.0..=1.0).contains(&at[adhesion]) {
                        let y = [cusp.contact_radius / of.unit, at[0], at[1]];
                        starts.extend(of.polished(&y, 1 + other));
                    }
                }
            }
            return starts;
        }
        let shares = even(CUSP_CELLS);
        let mut rows: Vec<Vec<Vec<[f64; 2]>>> = Vec::new();
        for y in &shares {
            let row = shares.iter().map(|x| {
                let at = [*x, *y];
                let root = self.member(&at).map_or(f64::NAN, |member| member.root);
                let cusps = if progress.stop() { Vec::new() } else { self.cusps(&at) };
                cusps.iter().map(|cusp| [cusp.contact_radius, cusp.value - root]).collect()
            });
            rows.push(row.collect());
        }
        let mut starts = Vec::new();
        let near = 0.3 * of.unit;
        let mut between = |a: [usize; 2], b: [usize; 2]| {
            for [s, off] in &rows[a[1]][a[0]] {
                let nearest =
                    rows[b[1]][b[0]].iter().min_by(|x, y| (x[0] - s).abs().total_cmp(&(y[0] - s).abs()));
                let Some([t, other]) = nearest.filter(|[t, other]| (t - s).abs() < near && off * other < 0.0)
                else {
                    continue;
                };
                let share = off / (off - other);
                let mix = |a: f64, b: f64| a + share * (b - a);
                let at = [0, 1].map(|k| mix(shares[a[k]], shares[b[k]]));
                let held = if a[0] == b[0] { 1 } else { 2 };
                starts.extend(of.polished(&[mix(*s, *t) / of.unit, at[0], at[1]], held));
            }
        };
        let n = shares.len();
        for j in 0..n {
            for i in 0..n {
                if i + 1 < n {
                    between([i, j], [i + 1, j]);
                }
                if j + 1 < n {
                    between([i, j], [i, j + 1]);
                }
            }
        }
        starts
    }

    /// Points at which the start of the path is a limit point.
    fn start_starts(&self, progress: &dyn Progress) -> Vec<Vec<f64>> {
        let of = Equations::new(self, Sort::Start);
        let Some(start) = self.start() else { return Vec::new() };
        let off = |at: AxisShares<'_>| {
            let member = self.member(at).ok()?;
            Some(member.local(start)?.edge.value - member.root)
        };
        let shares = even(CUSP_COLUMNS);
        let mut starts = Vec::new();
        for along in [0, 1] {
            for held in &shares {
                if progress.stop() {
                    return starts;
                }
                let place = |share: f64| {
                    let mut at = [*held; 2];
                    at[along] = share;
                    at
                };
                for pair in shares.windows(2) {
                    let (Some(a), Some(b)) = (off(&place(pair[0])), off(&place(pair[1]))) else { continue };
                    if (a > 0.0) != (b > 0.0) {
                        let share = pair[0] + (pair[1] - pair[0]) * a / (a - b);
                        starts.extend(of.polished(&place(share), 1 - along));
                    }
                }
            }
        }
        starts
    }

    /// Marks for every line where the number of snaps changes across it.
    fn mark_changes(&self, map: &mut Map, progress: &dyn Progress) {
        let count = map.lines.len() as f64;
        for (i, line) in map.lines.iter_mut().enumerate() {
            progress.report(i as f64 / count);
            let points = &line.points;
            let changes = (0..points.len()).map(|k| {
                let (a, b) = (points[k.saturating_sub(1)].at, points[(k + 1).min(points.len() - 1)].at);
                let along = [b[0] - a[0], b[1] - a[1]];
                let length = hypot(along[0], along[1]).max(f64::MIN_POSITIVE);
                let aside = |by: f64| {
                    let at = points[k].at;
                    [at[0] - by * along[1] / length, at[1] + by * along[0] / length]
                        .map(|share| share.clamp(0.0, 1.0))
                };
                let snaps = |by| self.passage(&aside(by)).map(|passage| passage.snaps);
                !progress.stop() && snaps(-ASIDE) != snaps(ASIDE)
            });
            line.changes = changes.collect();
        }
    }

    /// The snaps on a grid of this many columns and rows, cell by cell, and the smallest and the largest radius of
    /// their paths, if there is any path; `None` if `progress` said stop.
    fn counts(
        &self,
        [columns, rows]: [u32; 2],
        progress: &dyn Progress,
    ) -> Option<(Counts, Option<[f64; 2]>)> {
        let shares = [even(columns), even(rows)];
        let mut cells = vec![vec![None; shares[0].len()]; shares[1].len()];
        let mut radii: Option<[f64; 2]> = None;
        // Column by column, so that one table serves a whole column.
        for (i, x) in shares[0].iter().enumerate() {
            progress.report(*x);
            for (j, y) in shares[1].iter().enumerate() {
                if progress.stop() {
                    return None;
                }
                let passage = self.passage(&[*x, *y]);
                cells[j][i] = passage.as_ref().map(|passage| passage.snaps);
                if let Some(Passage { radii: [end, start], .. }) = passage {
                    let [from, to] = radii.unwrap_or([end, start]);
                    radii = Some([from.min(end), to.max(start)]);
                }
            }
        }
        Some((Counts { shares, cells }, radii))
    }
}
