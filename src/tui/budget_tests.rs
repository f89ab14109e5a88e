//! What the line has to carry: bytes per key, and frames per held key, counted by a stand-in for the terminal.

use super::app::App;
use super::converse;
use super::terminal::{Display, FrameSink, Inbox, Incoming, Pace};
use super::theme::{Charts, Palette, Theme};
use crate::explorer::{Effect, Inline, Reply, Workers};
use crate::store::Store;
use crossterm::event::{KeyCode, KeyEvent, KeyModifiers};
use std::cell::RefCell;
use std::io;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::time::{Duration, Instant};

/// A terminal that counts, and reports each frame; with a gate, it takes each frame only when let.
struct Counter {
    size: (u16, u16),
    frames: Mutex<Vec<usize>>,
    told: Option<Sender<()>>,
    gate: Option<Mutex<Receiver<()>>>,
}

impl Counter {
    /// It lives as long as the test program, as a terminal does.
    fn leak(size: (u16, u16), told: Option<Sender<()>>, gate: Option<Receiver<()>>) -> &'static Self {
        Box::leak(Box::new(Self { size, frames: Mutex::default(), told, gate: gate.map(Mutex::new) }))
    }

    /// The bytes of each frame since the last call.
    fn take(&self) -> Vec<usize> {
        std::mem::take(&mut self.frames.lock().unwrap())
    }
}

impl FrameSink for Counter {
    fn write_frame(&self, frame: &[u8]) -> io::Result<()> {
        if let Some(told) = &self.told {
            // Nobody listens to what is drawn after the last key.
            let _ = told.send(());
        }
        if let Some(gate) = &self.gate {
            let _ = gate.lock().unwrap().recv();
        }
        self.frames.lock().unwrap().push(frame.len());
        Ok(())
    }

    fn take_mouse(&self, _wanted: bool) -> io::Result<()> {
        Ok(())
    }

    fn size(&self) -> io::Result<(u16, u16)> {
        Ok(self.size)
    }
}

/// The explorer on such a terminal, with its effects run inline.
struct Session {
    app: App,
    driver: Inline,
    _folder: tempfile::TempDir,
}

impl Session {
    fn new(preset: &str, theme: Theme) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let store = Store::at(folder.path(), &[]);
        let loaded = store.load(&store.resolve(preset).unwrap(), &[] as &[&str]).unwrap();
        let (app, effects) = App::new(loaded, theme);
        let mut session = Self { app, driver: Inline::new(store), _folder: folder };
        session.settle(effects);
        session
    }

    fn settle(&mut self, mut effects: Vec<Effect>) {
        while !effects.is_empty() {
            let replies: Vec<_> = effects.into_iter().filter_map(|e| self.driver.run(e)).collect();
            effects = replies.into_iter().flat_map(|reply| self.app.reply(reply)).collect();
        }
    }

    fn draw(&mut self, display: &mut Display<Counter>) {
        let (mut views, mut screen) = (0, self.app.screen);
        display.draw(|frame| {
            screen = frame.area();
            views = super::view::draw(frame, &self.app);
        });
        let effects = self.app.make_room(screen, views);
        self.settle(effects);
    }

    /// Draws until the views have what they need.
    fn draw_all(&mut self, display: &mut Display<Counter>) {
        for _ in 0..3 {
            self.draw(display);
        }
    }

    /// The bytes that the terminal gets for a key.
    fn cost(&mut self, display: &mut Display<Counter>, counter: &Counter, key: char) -> usize {
        counter.take();
        let effects = self.app.key(KeyCode::Char(key).into());
        self.settle(effects);
        self.draw(display);
        counter.take().iter().sum()
    }
}

const THEMES: [Theme; 2] = [
    Theme { palette: Palette::Dark, charts: Charts::Braille, ascii: false },
    Theme { palette: Palette::Dark, charts: Charts::Ascii, ascii: true },
];

/// A walk over limit points and jumps: many steps, and each key that moves the walker.
const WALK: &str = "      n x          n x       n x     b        b  u u L    ca        n x      ";

/// The costliest step of a walk that is first shown in the view reached by this many keys.
fn costliest_step(preset: &str, size: (u16, u16), theme: Theme, views: usize) -> usize {
    let counter = Counter::leak(size, None, None);
    let mut display = Display::new(counter).unwrap();
    let mut session = Session::new(preset, theme);
    session.draw_all(&mut display);
    for _ in 0..views {
        session.cost(&mut display, counter, 't');
        session.draw_all(&mut display);
    }
    let costs: Vec<_> = WALK.chars().map(|key| (key, session.cost(&mut display, counter, key))).collect();
    let steps = costs.iter().filter(|(key, _)| *key == ' ').map(|(_, bytes)| *bytes);
    steps.max().unwrap()
}

/// The median cost of a plain key in bytes; where the list of parameters scrolls, it is a little more.
const MEDIAN: [usize; 2] = [130, 150];

#[test]
fn a_value_turned_beside_a_pin_costs_three_kilobytes() {
    // A turn changes the value by two to four per cent. The selection moved to λ costs most, since all its waves move:
    // the whole curve is then another one, and so is the pinned one over s/λ.
    for (theme, way, most) in [(THEMES[0], "", 3000), (THEMES[1], "", 3000), (THEMES[0], "j", 4500)] {
        let counter = Counter::leak((120, 40), None, None);
        let mut display = Display::new(counter).unwrap();
        let mut session = Session::new("wavy-sphere", theme);
        for key in way.chars().chain(['p']) {
            session.cost(&mut display, counter, key);
        }
        session.draw_all(&mut display);
        let costs: Vec<usize> =
            ">>>><<".chars().map(|key| session.cost(&mut display, counter, key)).collect();
        assert!(costs.iter().all(|bytes| *bytes <= most), "{costs:?} {theme:?} {way:?}");
    }
}

#[test]
fn idle_costs_nothing_and_a_move_little() {
    // Where panes are stacked, the lines of values move when another line is reached, and the title is long.
    for (size, theme, most) in [
        ((80, 24), THEMES[0], 450),
        ((100, 30), THEMES[0], 450),
        ((120, 40), THEMES[0], 350),
        ((120, 40), THEMES[1], 350),
    ] {
        let counter = Counter::leak(size, None, None);
        let mut display = Display::new(counter).unwrap();
        let mut session = Session::new("wavy-sphere", theme);
        session.draw_all(&mut display);
        counter.take();
        session.draw(&mut display);
        assert_eq!(counter.take(), [0], "an unchanged screen");
        let rows = session.app.model.knobs().len();
        let keys = std::iter::repeat_n('l', rows).chain(std::iter::repeat_n('h', rows));
        let costs: Vec<usize> = keys.map(|key| session.cost(&mut display, counter, key)).collect();
        assert!(costs.iter().all(|bytes| *bytes < most), "{costs:?} at {size:?}");
        let over = costs.iter().filter(|bytes| **bytes >= 300).count();
        assert!(over <= 2, "{costs:?} at {size:?}");
        // Keys at the end of the list, which change nothing, are not counted.
        let mut costs: Vec<usize> = costs.into_iter().filter(|bytes| *bytes > 0).collect();
        costs.sort_unstable();
        assert!(costs[costs.len() / 2] <= MEDIAN[usize::from(size.1 < 40)], "{costs:?} at {size:?}");
    }
}

#[test]
fn a_step_costs_less_than_one_and_a_half_kilobytes() {
    // Every view of a curve with jumps: the curves, the pressure, the gap, the potential, the unloading.
    for views in [0, 1, 2, 3, 4, 5, 6] {
        for theme in THEMES {
            let bytes = costliest_step("wavy-sphere", (120, 40), theme, views);
            assert!(bytes < 1500, "{bytes} bytes in view {views}, {theme:?}");
        }
    }
    // A larger screen shows more of it.
    for (preset, size, views, most) in [
        ("wavy-sphere", (80, 24), 3, 1500),
        ("wavy-sphere", (160, 44), 3, 2000),
        ("fig-1-hertz", (120, 40), 3, 1500),
        ("fig-3-jkr", (120, 40), 0, 1500),
        ("fig-10-force", (120, 40), 0, 1500),
        // With measured points behind the curve.
        ("lens", (120, 40), 0, 1500),
    ] {
        let bytes = costliest_step(preset, size, THEMES[0], views);
        assert!(bytes < most, "{bytes} bytes for {preset} at {size:?}");
    }
}

#[test]
fn four_charts_of_a_large_screen_cost_no_more_than_their_number() {
    let [braille, ascii] = THEMES.map(|theme| costliest_step("wavy-sphere", (200, 60), theme, 0));
    assert!(braille < 2500 && ascii < 1500, "{braille} and {ascii} bytes");
}

#[test]
fn keys_that_come_while_a_frame_is_written_make_one_frame() {
    let (told, frame_begun) = channel();
    let (let_go, gate) = channel();
    let counter = Counter::leak((120, 40), Some(told), Some(gate));
    let mut session = Session::new("wavy-sphere", THEMES[0]);
    let inbox = Inbox::<Reply>::empty();
    let typist = inbox.typist();
    let driving = std::thread::spawn(move || {
        // The terminal holds the first frame while the keys come, so no other frame is under way.
        frame_begun.recv().unwrap();
        for _ in 0..100 {
            typist(Incoming::Key(KeyCode::Char('j').into()));
            typist(Incoming::Key(KeyCode::Char('k').into()));
        }
        typist(Incoming::Key(KeyCode::Char('j').into()));
        assert!(frame_begun.try_recv().is_err(), "a second frame was begun");
        let_go.send(()).unwrap();
        frame_begun.recv().unwrap();
        typist(Incoming::Key(KeyEvent::new(KeyCode::Char('c'), KeyModifiers::CONTROL)));
        let_go.send(()).unwrap();
    });
    let mut display = Display::new(counter).unwrap();
    let waiting = RefCell::new(Vec::new());
    let row = session.app.model.selected_knob().map(|(row, _)| row.key.clone());
    converse(
        &mut session.app,
        &mut display,
        &inbox,
        &|effects| waiting.borrow_mut().extend(effects),
        &mut |_| {},
    );
    driving.join().unwrap();
    // The first, the one for 201 keys, and, if it is due, the one after the key that quits.
    let frames = counter.take().len();
    assert!(frames == 2 || frames == 3, "{frames} frames for 202 keys");
    assert_ne!(session.app.model.selected_knob().map(|(row, _)| row.key.clone()), row, "the last key counts");
}

/// A pace at which no frame follows another while a test runs.
const STANDSTILL: Pace = Pace {
    shortest: Duration::from_secs(3600),
    rate: 16_000.0,
    longest_for_size: Duration::ZERO,
    write_factor: 0,
    longest_for_write: Duration::ZERO,
};

/// How long a frame that need not wait for anything may take on a loaded machine.
const SOON: Duration = Duration::from_secs(20);

#[test]
fn the_first_curve_waits_for_no_pace_and_every_frame_after_it_does() {
    let (told, frame_begun) = channel();
    let counter = Counter::leak((120, 40), Some(told), None);
    let folder = tempfile::tempdir().unwrap();
    let store = Store::at(folder.path(), &[]);
    let loaded = store.load(&store.resolve("wavy-sphere").unwrap(), &[] as &[&str]).unwrap();
    let (mut app, effects) = App::new(loaded, THEMES[0]);
    let inbox = Inbox::<Reply>::empty();
    let (typist, sender) = (inbox.typist(), inbox.sender());
    let driving = std::thread::spawn(move || {
        // The empty screen appears before the curve.
        frame_begun.recv_timeout(SOON).unwrap();
        let driver = Inline::new(store);
        for reply in effects.into_iter().filter_map(|effect| driver.run(effect)) {
            assert!(sender.send(reply), "the inbox is gone");
        }
        let curve = frame_begun.recv_timeout(SOON);
        // Drawn only when due, long after the test.
        typist(Incoming::Key(KeyCode::Char('j').into()));
        typist(Incoming::Key(KeyEvent::new(KeyCode::Char('c'), KeyModifiers::CONTROL)));
        curve.is_ok()
    });
    let mut display = Display::paced(counter, STANDSTILL).unwrap();
    converse(&mut app, &mut display, &inbox, &|_| {}, &mut |_| {});
    assert!(driving.join().unwrap(), "the curve waited for the pace");
    assert!(app.model.curve.is_some());
    let frames = counter.take();
    assert!(frames.len() == 2 && frames[1] > 1000, "{frames:?}");
}

#[test]
fn a_frame_drawn_early_leaves_its_wait_to_the_next() {
    let counter = Counter::leak((80, 24), None, None);
    let mut display = Display::paced(counter, STANDSTILL).unwrap();
    let mut session = Session::new("wavy-sphere", THEMES[0]);
    session.draw(&mut display);
    let due = display.due();
    session.app.key(KeyCode::Char('j').into());
    session.draw(&mut display);
    assert_eq!(display.due(), due + STANDSTILL.shortest);
}

/// A line of 16 kB/s with 75 ms each way for keys and frames: frames take their time, and are reported with the moment
/// at which they were begun.
struct SlowLine {
    frames: Mutex<Vec<(Instant, usize)>>,
    /// Whether a frame of a run is being written: only those are kept.
    runs: AtomicBool,
}

/// The time one way.
const WAY: Duration = Duration::from_millis(75);

impl FrameSink for SlowLine {
    fn write_frame(&self, frame: &[u8]) -> io::Result<()> {
        if self.runs.load(Ordering::Acquire) {
            self.frames.lock().unwrap().push((Instant::now(), frame.len()));
        }
        std::thread::sleep(Duration::from_secs_f64(frame.len() as f64 / 16_000.0));
        Ok(())
    }

    fn take_mouse(&self, _wanted: bool) -> io::Result<()> {
        Ok(())
    }

    fn size(&self) -> io::Result<(u16, u16)> {
        Ok((120, 40))
    }
}

#[test]
fn a_run_leaves_the_line_to_the_keys_and_any_of_them_pauses_it() {
    let folder = tempfile::tempdir().unwrap();
    let store = Store::at(folder.path(), &[]);
    let loaded = store.load(&store.resolve("wavy-sphere").unwrap(), &[] as &[&str]).unwrap();
    let (mut app, effects) = App::new(loaded, THEMES[0]);
    let inbox = Inbox::<Reply>::empty();
    let sender = inbox.sender();
    let workers = Workers::start(store, move |reply| {
        // Fails only if the screen is gone.
        let _ = sender.send(reply);
    })
    .unwrap();
    workers.submit_all(effects);
    let line: &'static SlowLine =
        Box::leak(Box::new(SlowLine { frames: Mutex::default(), runs: AtomicBool::default() }));
    let mut display = Display::new(line).unwrap();
    let typist = inbox.typist();
    let (state, states) = channel::<(usize, bool)>();
    let driving = std::thread::spawn(move || {
        let key = |c: char| {
            std::thread::sleep(WAY);
            typist(Incoming::Key(KeyCode::Char(c).into()));
        };
        let until = |wanted: &dyn Fn((usize, bool)) -> bool| loop {
            let found = states.recv_timeout(SOON).unwrap();
            if wanted(found) {
                break found.0;
            }
        };
        // Slowly, so that it runs for long; the keys of the pace do not pause it.
        until(&|(walked, _)| walked == 1);
        for c in "((r)".chars() {
            key(c);
        }
        until(&|(walked, runs)| runs && walked > 9);
        key('t');
        let paused = until(&|(_, runs)| !runs);
        // What was under way may still arrive, but nothing more.
        while let Ok((walked, runs)) = states.recv_timeout(Duration::from_millis(500)) {
            assert!(walked <= paused + 1 && !runs, "{walked} states, {paused} when it was paused");
        }
        // Twice in one burst: it begins and is paused, and the next key takes effect as usual.
        for c in "rrr".chars() {
            typist(Incoming::Key(KeyCode::Char(c).into()));
        }
        until(&|(walked, runs)| runs && walked > paused);
        key('q');
    });
    // Even if the driving thread fails, the screen is left.
    let quits = inbox.typist();
    let driving = std::thread::spawn(move || {
        let result = driving.join();
        quits(Incoming::Key(KeyEvent::new(KeyCode::Char('c'), KeyModifiers::CONTROL)));
        result
    });
    converse(&mut app, &mut display, &inbox, &|effects| workers.submit_all(effects), &mut |app| {
        line.runs.store(app.model.is_running(), Ordering::Release);
        // Nobody listens after the last key.
        let _ = state.send((app.model.history.path().len(), app.model.is_running()));
    });
    driving.join().unwrap().unwrap();
    let frames = line.frames.lock().unwrap().clone();
    let frames: Vec<(Instant, usize)> = frames.into_iter().filter(|(_, bytes)| *bytes > 0).collect();
    assert!(frames.len() > 1, "{} frames", frames.len());
    for (at, _) in &frames {
        // A little less than a second: the machine may have been busy between the decision and the write.
        let within = frames.iter().filter(|(other, _)| other >= at && *other < *at + 4 * SECOND / 5);
        let bytes: Vec<usize> = within.map(|(_, bytes)| *bytes).collect();
        assert!(bytes.len() == 1 || bytes.len() <= 9 && bytes.iter().sum::<usize>() <= 4000, "{bytes:?}");
    }
}

const SECOND: Duration = Duration::from_secs(1);
