//! Which pane goes where at each size. Neighbours share a wall.
//!
//! | from | panes |
//! |---|---|
//! | 40x10 | the selected one alone |
//! | 60x16 | Problem with the state in its last line; one chart; the log |
//! | 80x16 | the same with both charts side by side |
//! | 120x36 | Problem, Here and Result in a column of 27 or more; both charts; the log below, whole |
//! | 160x45 | the same with a third chart |
//!
//! Charts of the force share its axis: an event stands on the same row in both. The pane chosen with `z` fills the
//! screen.

use crate::explorer::{ScreenPanel, View};
use ratatui::layout::Rect;

/// The smallest screen on which anything is shown.
pub const SMALLEST: (u16, u16) = (40, 10);

/// How the panes are arranged.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum PaneLayout {
    /// Only the selected one.
    Alone,
    /// One above the other over the whole width.
    Stacked,
    /// A column of text panes, with the charts beside it.
    Column,
}

/// The panes at one size.
#[derive(Debug, Clone, Copy)]
struct Arrangement {
    /// The smallest width and height.
    from: (u16, u16),
    shape: PaneLayout,
    charts: usize,
}

/// The panes at every size, the largest first: the first that fits is used.
const ARRANGEMENTS: [Arrangement; 5] = [
    Arrangement { from: (160, 45), shape: PaneLayout::Column, charts: 3 },
    Arrangement { from: (120, 36), shape: PaneLayout::Column, charts: 2 },
    Arrangement { from: (80, 16), shape: PaneLayout::Stacked, charts: 2 },
    Arrangement { from: (60, 16), shape: PaneLayout::Stacked, charts: 1 },
    Arrangement { from: SMALLEST, shape: PaneLayout::Alone, charts: 1 },
];

/// The least width inside the column, and how many more columns of a screen give it one more.
const COLUMN: u16 = 27;
const PER_COLUMN: u16 = 10;
/// Lines of values where panes are stacked; the state has one more line.
pub const VALUE_LINES: u16 = 2;
/// The rows of the log with its walls, for screens up to this many rows.
const LOG_ROWS: [(u16, u16); 6] = [(19, 4), (24, 5), (29, 6), (35, 8), (44, 11), (u16::MAX, 16)];
/// Lines of Result.
const RESULT_LINES: u16 = 9;
/// Lines of Here that stepping needs, and lines including the slopes.
const HERE_LINES: [u16; 2] = [6, 12];
/// The number of lines of values that matter more than the slopes.
const LEAST_VALUES: u16 = 8;

/// Where the panes are; panes that do not fit are left out.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Regions {
    pub header: Rect,
    pub problem: Option<Rect>,
    pub here: Option<Rect>,
    pub result: Option<Rect>,
    /// The views with their areas, the first view first.
    pub charts: Vec<(View, Rect)>,
    pub log: Option<Rect>,
    pub status: Rect,
    pub footer: Rect,
    /// Whether Problem consists of lines of cells, with the state below.
    pub is_stacked: bool,
}

impl Regions {
    /// The panes that are drawn, in the order of the Tab key; if only one is shown, each is drawn when it is selected.
    pub fn panels(&self, is_alone: bool) -> Vec<ScreenPanel> {
        let is_drawn = |panel: &ScreenPanel| match panel {
            ScreenPanel::Problem => self.problem.is_some(),
            ScreenPanel::Here => self.here.is_some(),
            ScreenPanel::Result => self.result.is_some(),
            ScreenPanel::Charts => !self.charts.is_empty(),
            ScreenPanel::Log => self.log.is_some(),
        };
        ScreenPanel::ALL.into_iter().filter(|panel| is_alone || is_drawn(panel)).collect()
    }
}

/// What the panes need.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Wants {
    /// The first view.
    pub view: View,
    /// Lines of the log.
    pub log: usize,
    /// Lines of the problem, one per value.
    pub problem: usize,
    pub panel: ScreenPanel,
    /// Whether the selected pane fills the screen.
    pub is_whole: bool,
}

/// Whether only the selected pane is shown at this size.
pub fn is_alone(area: Rect, is_whole: bool) -> bool {
    is_whole || arrangement(area).is_some_and(|found| found.shape == PaneLayout::Alone)
}

/// Whether nothing can be drawn on this screen, if anything was drawn yet.
pub fn is_too_small(area: Rect) -> bool {
    area != Rect::ZERO && arrangement(area).is_none()
}

/// The width inside the column on a screen of this size that has one.
pub fn column_width(area: Rect) -> u16 {
    COLUMN + area.width.saturating_sub(120) / PER_COLUMN
}

fn arrangement(area: Rect) -> Option<Arrangement> {
    let fits = |it: &Arrangement| area.width >= it.from.0 && area.height >= it.from.1;
    ARRANGEMENTS.into_iter().find(fits)
}

/// The panes of a screen; `None` below the smallest size.
pub fn regions(area: Rect, wants: Wants) -> Option<Regions> {
    let found = arrangement(area)?;
    let line = |y: u16| Rect { y, height: 1, ..area };
    let body = Rect { y: area.y + 1, height: area.height - 3, ..area };
    let mut regions = Regions {
        header: line(area.y),
        problem: None,
        here: None,
        result: None,
        charts: Vec::new(),
        log: None,
        status: line(body.bottom()),
        footer: line(body.bottom() + 1),
        is_stacked: false,
    };
    if wants.is_whole || found.shape == PaneLayout::Alone {
        match wants.panel {
            ScreenPanel::Problem => regions.problem = Some(body),
            ScreenPanel::Here => regions.here = Some(body),
            ScreenPanel::Result => regions.result = Some(body),
            ScreenPanel::Charts => regions.charts = vec![(wants.view, body)],
            ScreenPanel::Log => regions.log = Some(body),
        }
        return Some(regions);
    }
    let most = LOG_ROWS.iter().find(|(height, _)| area.height <= *height).map_or(0, |(_, rows)| *rows);
    let wanted = u16::try_from(wants.log.max(1) + 2).unwrap_or(u16::MAX);
    // Where panes are stacked, the log keeps its rows: charts that grow and shrink with it would be sent as a whole.
    let rows = if found.shape == PaneLayout::Stacked { most } else { wanted.clamp(3, most) };
    let (main, log) = split_top(body, body.height + 1 - rows);
    regions.log = Some(log);
    let charts = if found.shape == PaneLayout::Stacked {
        regions.is_stacked = true;
        let (problem, charts) = split_top(main, VALUE_LINES + 3);
        regions.problem = Some(problem);
        charts
    } else {
        let (side, charts) = split_left(main, column_width(area) + 2);
        column(&mut regions, side, wants);
        charts
    };
    let views = std::iter::once(wants.view).chain(wants.view.companions());
    regions.charts = views.zip(beside(charts, found.charts)).collect();
    Some(regions)
}

/// Problem, Here and Result; space is taken in this order: from the values of Problem, the slopes of Here, half of
/// Result.
fn column(regions: &mut Regions, side: Rect, wants: Wants) {
    let values = u16::try_from(wants.problem).unwrap_or(u16::MAX);
    // Four walls, two of them shared.
    let lines = side.height.saturating_sub(4);
    let [least, most] = HERE_LINES;
    let spare = lines.saturating_sub(least + RESULT_LINES + LEAST_VALUES.min(values));
    let here = least + spare.min(most - least);
    let problem = values.min(lines.saturating_sub(here + RESULT_LINES)).max(LEAST_VALUES.min(values));
    let here = here.max(lines.saturating_sub(problem + RESULT_LINES).min(most + 3));
    let (top, rest) = split_top(side, lines.saturating_sub(here + RESULT_LINES) + 2);
    let (middle, bottom) = split_top(rest, here + 2);
    (regions.problem, regions.here, regions.result) = (Some(top), Some(middle), Some(bottom));
}

/// The first `count` columns, and the rest starting from the wall that both share.
fn split_left(area: Rect, count: u16) -> (Rect, Rect) {
    let first = Rect { width: count, ..area };
    let shared = count.saturating_sub(1);
    (first, Rect { x: area.x + shared, width: area.width - shared, ..area })
}

/// The first `count` rows, and the rest starting from the wall that both share.
fn split_top(area: Rect, count: u16) -> (Rect, Rect) {
    let count = count.min(area.height);
    let first = Rect { height: count, ..area };
    let shared = count.saturating_sub(1);
    (first, Rect { y: area.y + shared, height: area.height - shared, ..area })
}

/// This many charts side by side; the first ones are a column wider if the width does not divide evenly.
fn beside(area: Rect, count: usize) -> Vec<Rect> {
    let mut rest = area;
    let mut places = Vec::new();
    for left in (1..=count).rev() {
        let share = u16::try_from(left).unwrap_or(1);
        let (first, others) = split_left(rest, (rest.width - 1).div_ceil(share) + 1);
        places.push(first);
        rest = others;
    }
    places
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wants(log: usize) -> Wants {
        Wants { view: View::ForceApproach, log, problem: 16, panel: ScreenPanel::Charts, is_whole: false }
    }

    fn all(regions: &Regions) -> Vec<Rect> {
        let panes = [regions.problem, regions.here, regions.result, regions.log];
        panes.into_iter().flatten().chain(regions.charts.iter().map(|(_, rect)| *rect)).collect()
    }

    #[test]
    fn panes_fill_the_screen_and_share_walls_only_at_every_size() {
        for width in 0..310 {
            for height in 0..70 {
                let area = Rect::new(0, 0, width, height);
                let Some(regions) = regions(area, wants(usize::from(width % 20))) else {
                    assert!(width < SMALLEST.0 || height < SMALLEST.1);
                    continue;
                };
                let mut all = all(&regions);
                all.extend([regions.header, regions.status, regions.footer]);
                for (i, a) in all.iter().enumerate() {
                    assert_eq!(a.intersection(area), *a);
                    assert!(a.width > 2 && a.height > 0, "{width}x{height} {a:?}");
                    for b in &all[i + 1..] {
                        // They share at most a wall, which is one cell wide.
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
            }
        }
    }

    /// Sizes and their panes: charts with the cells of each, and the lines of Problem, Here, Result and the log.
    #[test]
    fn every_size_has_its_panes() {
        use View::{Contact, ForceApproach, ForceRadius};
        type Row = ((u16, u16), &'static [(u16, u16)], [Option<u16>; 4]);
        const TABLE: [Row; 7] = [
            ((40, 12), &[(40, 9)], [None; 4]),
            ((60, 20), &[(60, 9)], [Some(3), None, None, Some(3)]),
            ((80, 24), &[(41, 13), (40, 13)], [Some(3), None, None, Some(3)]),
            ((100, 30), &[(51, 16), (50, 16)], [Some(3), None, None, Some(6)]),
            ((120, 40), &[(47, 30), (46, 30)], [Some(8), Some(9), Some(9), Some(6)]),
            ((160, 45), &[(44, 35), (43, 35), (43, 35)], [Some(10), Some(12), Some(9), Some(6)]),
            ((200, 60), &[(56, 50), (55, 50), (55, 50)], [Some(22), Some(15), Some(9), Some(6)]),
        ];
        let pair = [ForceApproach, ForceRadius, Contact];
        for ((width, height), charts, lines) in TABLE {
            let regions = regions(Rect::new(0, 0, width, height), wants(6)).unwrap();
            let size = format!("{width}x{height}");
            let cells: Vec<_> = regions.charts.iter().map(|(_, at)| (at.width, at.height)).collect();
            assert_eq!(cells, charts, "{size}");
            assert!(regions.charts.iter().map(|(view, _)| *view).eq(pair[..charts.len()].iter().copied()));
            let inside = [regions.problem, regions.here, regions.result, regions.log];
            let inside = inside.map(|pane| pane.map(|pane| pane.height - 2));
            assert_eq!(inside, lines, "{size}");
            // However many events there are.
            let many = super::regions(Rect::new(0, 0, width, height), wants(99)).unwrap();
            assert!(many.log.is_none_or(|log| log.height * 2 < height), "{size}");
            // Tab goes to the panes that are drawn, or to each pane if only one is shown.
            let alone = is_alone(Rect::new(0, 0, width, height), false);
            let panels = regions.panels(alone);
            let drawn = if alone { 5 } else { 1 + inside.iter().flatten().count() };
            assert_eq!(panels.len(), drawn, "{size}");
        }
    }

    #[test]
    fn one_panel_can_have_the_whole_screen() {
        for panel in ScreenPanel::ALL {
            let area = Rect::new(0, 0, 80, 24);
            let regions = regions(area, Wants { panel, is_whole: true, ..wants(6) }).unwrap();
            assert_eq!(all(&regions), [Rect::new(0, 1, 80, 21)]);
        }
    }
}
