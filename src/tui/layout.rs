//! Which region goes where at which size. Neighbours share a wall.
//!
//! | size | left | charts | events |
//! |---|---|---|---|
//! | below 60 wide | nothing | one | below, from 18 rows on |
//! | 60-99 | 26 | one | below |
//! | 100-159 | 31 | two of the force, side by side; of others one, or where events are folded two, one above the other | below |
//! | from 160x45 | 36 | two, side by side | below |
//! | from 200x60 | 36 | four, of at least 14 rows of plot each; the lower two over the whole width where the left has room | below |
//! | from 240 wide, below 30 rows | 36 | two, side by side | a column of their own |
//!
//! Side by side, P over δ and P over s have one axis of P: an event stands on the same row in both.
//!
//! Events take the rows they need, as many as leave the charts theirs. The panel that `z` chose has the whole screen.

use crate::explorer::{Panel, View};
use ratatui::layout::Rect;

/// The smallest screen on which anything is shown.
pub const SMALLEST: (u16, u16) = (40, 10);

/// Where the regions are; those that do not fit are left out.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Regions {
    pub header: Rect,
    pub problem: Option<Rect>,
    pub walker: Option<Rect>,
    /// The views with their place, the first one first.
    pub charts: Vec<(View, Rect)>,
    pub events: Option<Rect>,
    pub status: Rect,
    pub footer: Rect,
}

/// What the panels want.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Wants {
    /// The first view.
    pub view: View,
    /// Rows of events; `None` where only their heading is shown.
    pub events: Option<usize>,
    /// Rows of the problem.
    pub problem: usize,
    /// The panel that has the whole screen.
    pub whole: Option<Panel>,
}

/// Width of the column of the events where they have one.
const EVENTS_COLUMN: u16 = 88;
/// From this width on two charts of the force stand side by side.
const PAIR: u16 = 100;
/// Rows of folded events: two walls, the upper one with their heading.
const FOLDED: usize = 2;
/// Rows of a chart that has a plot of 14: its walls, its legend, its labels.
const CHART_ROWS: u16 = 18;

/// The regions of a screen; `None` below the smallest size.
pub fn regions(area: Rect, wants: Wants) -> Option<Regions> {
    let (width, height) = (area.width, area.height);
    if width < SMALLEST.0 || height < SMALLEST.1 {
        return None;
    }
    let line = |y: u16| Rect { y, height: 1, ..area };
    let body = Rect { y: area.y + 1, height: height - 3, ..area };
    let mut regions = Regions {
        header: line(area.y),
        problem: None,
        walker: None,
        charts: Vec::new(),
        events: None,
        status: line(body.bottom()),
        footer: line(body.bottom() + 1),
    };
    match wants.whole {
        Some(Panel::Problem) => regions.problem = Some(body),
        Some(Panel::Walker) => regions.walker = Some(body),
        Some(Panel::Events) => regions.events = Some(body),
        Some(Panel::Charts) => regions.charts = vec![(wants.view, body)],
        None => fill(&mut regions, body, (width, height), wants),
    }
    Some(regions)
}

/// The first `count` columns, and the rest from the wall that both share.
fn split_left(area: Rect, count: u16) -> (Rect, Rect) {
    let first = Rect { width: count, ..area };
    let shared = count.saturating_sub(1);
    (first, Rect { x: area.x + shared, width: area.width - shared, ..area })
}

/// The first `count` rows, and the rest from the wall that both share.
fn split_top(area: Rect, count: u16) -> (Rect, Rect) {
    let first = Rect { height: count, ..area };
    let shared = count.saturating_sub(1);
    (first, Rect { y: area.y + shared, height: area.height - shared, ..area })
}

fn fill(regions: &mut Regions, body: Rect, (width, height): (u16, u16), wants: Wants) {
    let side_width = match width {
        ..=59 => 0,
        60..=99 => 27,
        100..=159 => 32,
        _ => 37,
    };
    let is_flat = width >= 240 && height < 30;
    let main = if is_flat {
        let (main, events) = split_left(body, body.width + 1 - EVENTS_COLUMN);
        regions.events = Some(events);
        main
    } else {
        let most = match height {
            ..=17 => 0,
            18..=23 => 5,
            24..=29 => 6,
            30..=39 => 9,
            40..=49 => 12,
            _ => 19,
        };
        // The walls and the heads take three lines; what there is to say instead of events takes one.
        let rows = wants.events.map_or(FOLDED, |events| events.max(1) + 3);
        let rows = u16::try_from(rows).unwrap_or(u16::MAX).min(most);
        if rows == 0 {
            body
        } else {
            let (main, events) = split_top(body, body.height + 1 - rows);
            regions.events = Some(events);
            main
        }
    };
    let mut charts = main;
    // The walker needs six lines, and the parameters more than that, as far as there are lines.
    let walker_rows = match main.height {
        26.. => 12,
        25 => 10,
        rows => 8.min(rows / 2 + 2),
    };
    let wanted = u16::try_from(wants.problem + 2).unwrap_or(u16::MAX).saturating_add(walker_rows - 1);
    if side_width > 0 {
        let (side, right) = split_left(main, side_width);
        charts = right;
        let (problem, walker) = split_top(side, side.height + 1 - walker_rows);
        (regions.problem, regions.walker) = (Some(problem), Some(walker));
    }
    let views = std::iter::once(wants.view).chain(wants.view.companions());
    let half = |area: Rect| <[Rect; 2]>::from(split_left(area, area.width / 2 + 1));
    let places = if !is_flat && width >= 200 && height >= 60 && charts.height >= 2 * CHART_ROWS {
        let middle = charts.height / 2 + 1;
        let top = middle.max(wanted);
        let is_wide = charts.height + 1 >= top + CHART_ROWS;
        let (above, below) = split_top(charts, if is_wide { top } else { middle });
        let below = if is_wide { Rect { x: main.x, width: main.width, ..below } } else { below };
        if is_wide {
            // The left column ends with the upper charts.
            let side = Rect { width: side_width, height: top, ..main };
            let (problem, walker) = split_top(side, side.height + 1 - walker_rows);
            (regions.problem, regions.walker) = (Some(problem), Some(walker));
        }
        [half(above), half(below)].concat()
    } else if is_flat || (width >= 160 && height >= 45) || (width >= PAIR && wants.view.is_of_force()) {
        half(charts).to_vec()
    } else if wants.events.is_none() && charts.height + 1 >= 2 * CHART_ROWS {
        <[Rect; 2]>::from(split_top(charts, charts.height / 2 + 1)).to_vec()
    } else {
        vec![charts]
    };
    regions.charts = views.zip(places).collect();
    let is_seen = |rect: &Rect| rect.width > 2 && rect.height > 2;
    regions.problem = regions.problem.filter(is_seen);
    regions.walker = regions.walker.filter(is_seen);
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wants(events: usize) -> Wants {
        Wants { view: View::ForceApproach, events: Some(events), problem: 14, whole: None }
    }

    #[test]
    fn regions_fill_the_screen_and_share_walls_only_at_every_size() {
        for width in 0..310 {
            for height in 0..70 {
                let area = Rect::new(0, 0, width, height);
                let Some(regions) = regions(area, wants(usize::from(width % 20))) else {
                    assert!(width < SMALLEST.0 || height < SMALLEST.1);
                    continue;
                };
                let mut all = vec![regions.header, regions.status, regions.footer];
                all.extend(regions.problem.into_iter().chain(regions.walker).chain(regions.events));
                all.extend(regions.charts.iter().map(|(_, rect)| *rect));
                for (i, a) in all.iter().enumerate() {
                    assert_eq!(a.intersection(area), *a);
                    for b in &all[i + 1..] {
                        // At most a wall, which is one cell wide.
                        let shared = a.intersection(*b);
                        assert!(
                            shared.is_empty() || shared.width.min(shared.height) == 1,
                            "{width}x{height}"
                        );
                    }
                }
                for cell in area.positions() {
                    assert!(all.iter().any(|rect| rect.contains(cell)), "{width}x{height} {cell:?}");
                }
                let views = match (width, height) {
                    (200.., 60..) => 4,
                    (100.., _) => 2,
                    _ => 1,
                };
                assert_eq!(regions.charts.len(), views, "{width}x{height}");
                for (_, chart) in &regions.charts {
                    assert!(views < 4 || chart.height >= CHART_ROWS, "{width}x{height}");
                }
            }
        }
    }

    #[test]
    fn folded_events_leave_their_rows_to_the_charts() {
        let folded = Wants { events: None, ..wants(6) };
        for (size, charts) in [((80, 24), 1), ((100, 30), 2), ((120, 40), 2), ((160, 45), 2), ((200, 60), 4)]
        {
            let area = Rect::new(0, 0, size.0, size.1);
            let [plain, folded] = [wants(6), folded].map(|wants| regions(area, wants).unwrap());
            assert_eq!(folded.charts.len(), charts, "{size:?}");
            assert_eq!(folded.events.map(|events| events.height), Some(2), "{size:?}");
            let rows = |regions: &Regions| {
                regions.charts.iter().map(|(_, chart)| u32::from(chart.height)).sum::<u32>()
            };
            assert!(rows(&folded) > rows(&plain), "{size:?}");
            assert!(
                charts < 4 || folded.charts.iter().all(|(_, chart)| chart.height >= CHART_ROWS),
                "{size:?}"
            );
        }
    }

    #[test]
    fn one_panel_can_have_the_whole_screen() {
        for whole in Panel::ALL {
            let area = Rect::new(0, 0, 80, 24);
            let regions = regions(area, Wants { whole: Some(whole), ..wants(6) }).unwrap();
            let shown = [regions.problem, regions.walker, regions.events].into_iter().flatten();
            let all: Vec<Rect> = shown.chain(regions.charts.iter().map(|(_, rect)| *rect)).collect();
            assert_eq!(all, [Rect::new(0, 1, 80, 21)]);
        }
    }
}
