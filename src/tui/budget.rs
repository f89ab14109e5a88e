//! What the line carries: bytes per key, and frames per held key, counted by a terminal that is a counter.

use super::app::App;
use super::converse;
use super::terminal::{Display, Inbox, Incoming, Sink};
use super::theme::{Charts, Palette, Theme};
use super::view::Pictures;
use crate::explorer::{Effect, Inline, Reply};
use crate::preset::Store;
use crossterm::event::{KeyCode, KeyEvent, KeyModifiers};
use std::cell::RefCell;
use std::io;
use std::sync::Mutex;
use std::sync::mpsc::{Receiver, Sender, channel};

/// A terminal of 120x40 that counts, and tells of each frame; with a gate it takes each only when let.
struct Counter {
    frames: Mutex<Vec<usize>>,
    told: Option<Sender<()>>,
    gate: Option<Mutex<Receiver<()>>>,
}

impl Counter {
    /// It lives as long as the test program, as a terminal does.
    fn leak(told: Option<Sender<()>>, gate: Option<Receiver<()>>) -> &'static Self {
        Box::leak(Box::new(Self { frames: Mutex::default(), told, gate: gate.map(Mutex::new) }))
    }

    /// The bytes of each frame since the last look.
    fn take(&self) -> Vec<usize> {
        std::mem::take(&mut self.frames.lock().unwrap())
    }
}

impl Sink for Counter {
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
        Ok((120, 40))
    }
}

/// The explorer on such a terminal, its effects done inline.
struct Session {
    app: App,
    driver: Inline,
    pictures: Pictures,
    _folder: tempfile::TempDir,
}

impl Session {
    fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        let store = Store::at(folder.path(), &[]);
        let loaded = store.load(&store.resolve("wavy-sphere").unwrap(), &[] as &[&str]).unwrap();
        let (app, effects) = App::new(loaded, Theme::new(Palette::Dark, Charts::Braille, false));
        let mut session = Self { app, driver: Inline::new(store), pictures: Pictures::default(), _folder: folder };
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
            views = super::view::draw(frame, &self.app, &mut self.pictures);
        });
        let effects = self.app.make_room(screen, views);
        self.settle(effects);
    }

    /// The bytes that the terminal gets for a key.
    fn cost(&mut self, display: &mut Display<Counter>, counter: &Counter, key: KeyCode) -> usize {
        counter.take();
        let effects = self.app.key(key.into());
        self.settle(effects);
        self.draw(display);
        counter.take().iter().sum()
    }
}

#[test]
fn idle_costs_nothing_a_move_little_and_a_step_one_and_a_half_kilobytes() {
    let counter = Counter::leak(None, None);
    let mut display = Display::new(counter).unwrap();
    let mut session = Session::new();
    // Drawn until the views have what they need.
    for _ in 0..3 {
        session.draw(&mut display);
    }
    counter.take();
    session.draw(&mut display);
    assert_eq!(counter.take(), [0], "an unchanged screen");
    for key in ['j', 'j', 'k', 'j', 'k'] {
        let bytes = session.cost(&mut display, counter, KeyCode::Char(key));
        assert!(bytes > 0 && bytes < 300, "{bytes} bytes for {key}");
    }
    let steps: Vec<_> = (0..40).map(|_| session.cost(&mut display, counter, KeyCode::Char(' '))).collect();
    let mean = steps.iter().sum::<usize>() / steps.len();
    assert!(mean > 0 && mean < 1500, "{mean} bytes for a step: {steps:?}");
    // One that passes an event changes the list below too.
    assert!(steps.iter().all(|&bytes| bytes < 3000), "{steps:?}");
}

#[test]
fn keys_that_come_while_a_frame_is_written_make_one_frame() {
    let (told, frame_begun) = channel();
    let (let_go, gate) = channel();
    let counter = Counter::leak(Some(told), Some(gate));
    let mut session = Session::new();
    let inbox = Inbox::<Reply>::new();
    let typist = inbox.typist();
    let driving = std::thread::spawn(move || {
        // The first frame is held by the terminal for as long as the keys come: none is in flight beside it.
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
    // The first, the one for 201 keys, and the one after the key that quits if it is due.
    let frames = counter.take().len();
    assert!(frames == 2 || frames == 3, "{frames} frames for 202 keys");
    assert_ne!(session.app.model.selected_knob().map(|(row, _)| row.key.clone()), row, "the last key counts");
}
