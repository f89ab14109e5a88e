//! Which region goes where at which size.

use crate::explorer::View;
use ratatui::layout::{Constraint, Layout, Rect};

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

/// The regions of a screen that shows `view` and so many `events`; `None` below the smallest size.
pub fn regions(area: Rect, view: View, events: usize) -> Option<Regions> {
    let (width, height) = (area.width, area.height);
    if width < SMALLEST.0 || height < SMALLEST.1 {
        return None;
    }
    let most = match height {
        ..=17 => 0,
        18..=23 => 5,
        24..=29 => 6,
        30..=39 => 9,
        40..=49 => 12,
        _ => 16,
    };
    // Frame and heads take three lines; two lines of events are kept free, so that the charts do not jump.
    let events_height = u16::try_from(events.max(2) + 3).unwrap_or(u16::MAX).min(most);
    let [header, main, events, status, footer] = Layout::vertical([
        Constraint::Length(1),
        Constraint::Fill(1),
        Constraint::Length(events_height),
        Constraint::Length(1),
        Constraint::Length(1),
    ])
    .areas(area);
    let side_width = match width {
        ..=59 => 0,
        60..=99 => 26,
        100..=159 => 31,
        _ => 36,
    };
    let [side, charts] =
        Layout::horizontal([Constraint::Length(side_width), Constraint::Fill(1)]).areas(main);
    // The walker needs six lines and its title, and the parameters more than that, as far as there are lines.
    let walker_height = if main.height >= 25 {
        11
    } else if main.height >= 24 {
        9
    } else {
        7.min(main.height / 2 + 1)
    };
    let [problem, walker] =
        Layout::vertical([Constraint::Fill(1), Constraint::Length(walker_height)]).areas(side);
    let views = std::iter::once(view).chain(view.companions());
    let charts = views.zip(places(charts, width, height)).collect();
    let shown = |rect: Rect| (rect.width > 0 && rect.height > 2).then_some(rect);
    Some(Regions {
        header,
        problem: shown(problem),
        walker: shown(walker),
        charts,
        events: shown(events),
        status,
        footer,
    })
}

/// The places of the charts on a screen of this size: one, two, or four where they stay as large as on a small screen.
fn places(charts: Rect, width: u16, height: u16) -> Vec<Rect> {
    let half = [Constraint::Fill(1), Constraint::Fill(1)];
    if width < 100 || height < 30 {
        return vec![charts];
    }
    if width < 160 {
        let rows: [Rect; 2] = Layout::vertical(half).areas(charts);
        return rows.to_vec();
    }
    let columns: [Rect; 2] = Layout::horizontal(half).areas(charts);
    if height < 45 {
        return columns.to_vec();
    }
    let [left, right] = columns.map(|column| Layout::vertical(half).areas::<2>(column));
    vec![left[0], right[0], left[1], right[1]]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn regions_fill_the_screen_without_overlap_at_every_size() {
        for width in 0..220 {
            for height in 0..70 {
                let area = Rect::new(0, 0, width, height);
                let Some(regions) = regions(area, View::ForceApproach, usize::from(width % 20)) else {
                    assert!(width < SMALLEST.0 || height < SMALLEST.1);
                    continue;
                };
                let mut all = vec![regions.header, regions.status, regions.footer];
                all.extend(regions.problem.into_iter().chain(regions.walker).chain(regions.events));
                all.extend(regions.charts.iter().map(|(_, rect)| *rect));
                for (i, a) in all.iter().enumerate() {
                    assert_eq!(a.intersection(area), *a);
                    assert!(all[i + 1..].iter().all(|b| a.intersection(*b).is_empty()), "{width}x{height}");
                }
                let views = match (width, height) {
                    (160.., 45..) => 4,
                    (100.., 30..) => 2,
                    _ => 1,
                };
                assert_eq!(regions.charts.len(), views, "{width}x{height}");
            }
        }
    }
}
