//! The cost of a frame: a whole screen drawn from a session that stands on its curve. `cargo bench --bench frame`.

// A benchmark has nobody to report an error to.
#![allow(clippy::unwrap_used)]

use divan::Bencher;
use pulloff::explorer::{Inline, View};
use pulloff::store::Store;
use pulloff::tui::app::App;
use pulloff::tui::theme::Theme;
use pulloff::tui::view;
use ratatui::Terminal;
use ratatui::backend::TestBackend;

fn main() {
    divan::main();
}

/// A session on the wavy sphere with the interior of its start state.
fn session(view: View, views: usize) -> App {
    // The folder need not exist: the preset is a shipped one.
    let store = Store::at("presets", &[]);
    let loaded = store.load(&store.resolve("wavy-sphere").unwrap(), &[] as &[&str]).unwrap();
    let (mut app, effects) = App::new(loaded, Theme::default());
    let driver = Inline::new(store);
    driver.settle(&mut app.model, effects);
    app.model.view = view;
    let effects = app.make_room(app.screen, views);
    driver.settle(&mut app.model, effects);
    app
}

fn frame(bencher: Bencher, app: &App, width: u16, height: u16) {
    let mut terminal = Terminal::new(TestBackend::new(width, height)).unwrap();
    bencher.bench_local(|| {
        let draw = |frame: &mut ratatui::Frame<'_>| {
            view::draw(frame, app);
        };
        terminal.draw(draw).unwrap();
    });
}

/// Two views of the curve.
#[divan::bench]
fn frame_120x40(bencher: Bencher) {
    frame(bencher, &session(View::ForceApproach, 2), 120, 40);
}

/// The hatched path above a view of the curve.
#[divan::bench]
fn frame_120x40_unloading(bencher: Bencher) {
    frame(bencher, &session(View::Unloading, 2), 120, 40);
}

/// Four views, two of them of the state.
#[divan::bench]
fn frame_200x60(bencher: Bencher) {
    frame(bencher, &session(View::ForceApproach, 4), 200, 60);
}
