//! Reports what takes long: reporting everything would add two frames to every step.

use super::app::App;
use crate::explorer::backgrounds::under_way;
use std::time::{Duration, Instant};

/// Shorter jobs are not shown.
const SHORT: Duration = Duration::from_millis(100);

/// The background job under way, and since when.
#[derive(Debug, Default)]
pub(super) struct SlowNotice {
    since: Option<(&'static str, Instant)>,
    is_told: bool,
}

impl SlowNotice {
    /// Updates the notice in `app`; returns whether it changed.
    pub(super) fn look(&mut self, app: &mut App) -> bool {
        let now = Instant::now();
        let under_way = under_way(&app.model);
        let begun = |name: &'static str| {
            let same = self.since.filter(|(last, _)| *last == name);
            (name, same.map_or(now, |(_, begun)| begun))
        };
        self.since = under_way.as_ref().map(|(name, _)| begun(name));
        self.is_told = self.since.is_some_and(|(_, begun)| now.duration_since(begun) >= SHORT);
        let late = under_way.filter(|_| self.is_told).map(|(_, says)| says);
        let is_changed = app.late != late;
        app.late = late;
        is_changed
    }

    /// When to look again if nothing happens before then.
    pub(super) fn due(&self) -> Option<Instant> {
        self.since.filter(|_| !self.is_told).map(|(_, begun)| begun + SHORT)
    }
}

#[cfg(test)]
mod tests {
    use super::super::slow_notice::*;
    use crate::explorer::pins::Pins;
    use crate::store::Store;
    use crate::tui::theme::Theme;

    #[test]
    fn what_is_under_way_is_told_of_once_it_takes_long_and_no_longer_than_it_takes() {
        let store = Store::at("/nowhere", &[]);
        let loaded = store.load(&store.resolve("fig-3-jkr").unwrap(), &[] as &[&str]).unwrap();
        let (mut app, _) = App::new(loaded, Theme::default());
        let mut late = SlowNotice::default();
        assert!(!late.look(&mut app) && late.due().is_none());
        app.model.pins = Pins::awaiting([(1, app.model.preset.clone()), (2, app.model.preset.clone())]);
        while !late.look(&mut app) {
            assert!(app.late.is_none() && late.due().is_some());
            std::thread::sleep(Duration::from_millis(5));
        }
        let says = |app: &App, text: &str| app.late.as_ref().is_some_and(|late| late.contains(text));
        assert!(says(&app, "computing 2 pinned curves") && late.due().is_none());
        // The next one of the same kind is late as well.
        app.model.pins.came(1, None);
        assert!(late.look(&mut app));
        assert!(says(&app, "computing a pinned curve"));
        app.model.pins.came(2, None);
        assert!(late.look(&mut app) && app.late.is_none());
    }
}
