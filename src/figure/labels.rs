//! The placement of the labels of a map: snap counts in their regions, crests on their lines.

use super::parts::{Figure, Mark, Sign};
use super::places::Places;
use pulloff_engine::report::MapReport;
use pulloff_engine::report::map::MapRow;
use std::collections::VecDeque;

/// A line shorter than this, as a share of the map, has no room for its crest.
const SHORTEST: f64 = 0.08;

/// The smallest distance between labels, as a share of the map.
const APART: f64 = 0.045;

/// The smallest distance of a label from the border, as a share of the map.
const INSIDE: f64 = 0.03;

/// Where along a line its label may be placed, the best position first.
const ALONG: [f64; 7] = [0.5, 0.35, 0.65, 0.2, 0.8, 0.1, 0.9];

/// The number of snaps in each region of the map, placed where the region is widest.
///
/// A region is a set of adjacent cells with the same count; its label is on the cell farthest from all other counts.
pub fn counts(report: &MapReport, x: &Places, y: &Places) -> Vec<Mark> {
    /// A region whose deepest cell is fewer cells than this from its border has no room for a number.
    const ROOM: usize = 2;
    let Some(counts) = &report.counts else { return Vec::new() };
    let cells = &counts.snaps;
    let [width, height] = [counts.x.len(), counts.y.len()];
    let next = |(i, j): (usize, usize)| {
        let near = [(i.wrapping_sub(1), j), (i + 1, j), (i, j.wrapping_sub(1)), (i, j + 1)];
        near.into_iter().filter(move |(i, j)| *i < width && *j < height)
    };
    let places = || (0..height).flat_map(|j| (0..width).map(move |i| (i, j)));
    // For each cell, the number of steps to another count or out of the map.
    let mut depth = vec![vec![0_usize; width]; height];
    let on_border = |(i, j): (usize, usize)| {
        next((i, j)).count() < 4 || next((i, j)).any(|(a, b)| cells[b][a] != cells[j][i])
    };
    let mut edge: VecDeque<(usize, usize)> = places().filter(|place| on_border(*place)).collect();
    for (i, j) in &edge {
        depth[*j][*i] = 1;
    }
    while let Some((i, j)) = edge.pop_front() {
        for (a, b) in next((i, j)) {
            if depth[b][a] == 0 {
                depth[b][a] = depth[j][i] + 1;
                edge.push_back((a, b));
            }
        }
    }
    let mut seen = vec![vec![false; width]; height];
    let mut marks = Vec::new();
    for place in places() {
        let Some(count) = cells[place.1][place.0].filter(|_| !seen[place.1][place.0]) else { continue };
        let mut deepest = place;
        let mut region = vec![place];
        seen[place.1][place.0] = true;
        while let Some((i, j)) = region.pop() {
            if depth[j][i] > depth[deepest.1][deepest.0] {
                deepest = (i, j);
            }
            for (a, b) in next((i, j)) {
                if !seen[b][a] && cells[b][a] == Some(count) {
                    seen[b][a] = true;
                    region.push((a, b));
                }
            }
        }
        if depth[deepest.1][deepest.0] >= ROOM {
            let at = (x.at(counts.x[deepest.0]), y.at(counts.y[deepest.1]));
            marks.push(Mark { sign: Sign::Snaps(count), at });
        }
    }
    marks
}

/// Adds the crest of the longest line of each kind at each crest, where there is room beside the other marks of the figure;
/// lines across which the count does not change have none. Numbers move inward from the border.
pub fn crests(report: &MapReport, x: &Places, y: &Places, figure: &mut Figure) {
    let bounds = figure.places();
    for at in 0..figure.marks.len() {
        let Mark { sign, at: place } = figure.marks[at];
        if let (Sign::Snaps(_), Some((x, y))) = (sign, bounds.share(figure.place(place))) {
            let [x, y] = [x, y].map(|share| share.clamp(INSIDE, 1.0 - INSIDE));
            figure.marks[at].at = figure.values_at(bounds.at((x, y)));
        }
    }
    let is_line =
        |row: &&MapRow| matches!(row.kind, "fold" | "cusp" | "landing") && row.changes != Some(false);
    let rows: Vec<&MapRow> = report.rows.iter().filter(is_line).filter(|row| row.line.is_some()).collect();
    let share = |at: (f64, f64)| bounds.share(figure.place(at));
    let place = |row: &&MapRow| share((x.at(row.x), y.at(row.y)));
    let of_line = |a: &&MapRow, b: &&MapRow| a.line == b.line && a.kind == b.kind;
    let mut lines: Vec<_> = rows
        .chunk_by(of_line)
        .filter_map(|rows| {
            let points: Vec<(f64, f64)> = rows.iter().filter_map(place).collect();
            Some((length(&points), rows[0].kind, rows[0].crest?, points))
        })
        .collect();
    lines.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut taken: Vec<(f64, f64)> = figure.marks.iter().filter_map(|mark| share(mark.at)).collect();
    let mut told = Vec::new();
    for (whole, kind, crest, points) in lines.into_iter().filter(|(whole, ..)| *whole >= SHORTEST) {
        if told.contains(&(kind, crest)) {
            continue;
        }
        let is_free =
            |at: &(f64, f64)| taken.iter().all(|other| (at.0 - other.0).hypot(at.1 - other.1) > APART);
        if let Some(at) = ALONG.into_iter().filter_map(|share| along(&points, share * whole)).find(is_free) {
            taken.push(at);
            told.push((kind, crest));
            let at = figure.values_at(bounds.at(at));
            figure.marks.push(Mark { sign: Sign::OfCrest(crest), at });
        }
    }
}

fn step(pair: &[(f64, f64)]) -> f64 {
    (pair[1].0 - pair[0].0).hypot(pair[1].1 - pair[0].1)
}

fn length(points: &[(f64, f64)]) -> f64 {
    points.windows(2).map(step).sum()
}

/// The first point of a line beyond this distance along it.
fn along(points: &[(f64, f64)], mut rest: f64) -> Option<(f64, f64)> {
    for pair in points.windows(2) {
        rest -= step(pair);
        if rest <= 0.0 {
            return Some(pair[1]);
        }
    }
    points.last().copied()
}
