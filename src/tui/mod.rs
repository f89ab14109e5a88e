//! The explorer on a terminal: keys in, pictures out. Nothing here computes.
//!
//! | file | what lives there |
//! |---|---|
//! | [`terminal`] | taking and giving back the terminal, signals, hang-ups, pacing |
//! | [`keymap`] | command id → keys |
//! | [`app`] | keys and pastes → commands; replies → model; what lies over the screen |
//! | `held` | which presses come from a key held down |
//! | `slow_notice` | notices for slow jobs |
//! | [`overlay`] | prompts, choices, questions and the help, as data |
//! | [`layout`] | which pane goes where at each size |
//! | [`look`] | theme, charts and mouse from flags, configuration and environment |
//! | [`config`] | the user's settings file |
//! | [`theme`] | styles and glyphs, by palette, Unicode or ASCII |
//! | [`chart`] | a figure on cells: axes, curves, marks, the cross-hair |
//! | `marks` | how each line and sign of a figure is drawn |
//! | `ticks` | round numbers beside an axis |
//! | [`raster`] | curves as dots in cells, and the colour of each cell |
//! | [`copy`] | the state, the events, a chart and the screen as text, for the clipboard |
//! | [`view`] | one file per screen region |

pub mod app;
pub mod chart;
pub mod config;
pub mod copy;
mod held;
pub mod keymap;
pub mod layout;
pub mod look;
mod marks;
pub mod overlay;
pub mod raster;
mod slow_notice;
pub mod terminal;
pub mod theme;
mod ticks;
pub mod view;

#[cfg(test)]
mod budget_tests;

pub use terminal::refuse_reason;

use crate::explorer::archive::{Archive, Autosave, HeldSession, ago};
use crate::explorer::model::{Level, Model};
use crate::explorer::session::{Ended, Snapshot};
use crate::explorer::{Effect, Reply, Workers};
use crate::fault;
use crate::store::{Loaded, Store, temporary};
use app::App;
use held::Held as HeldKey;
use keymap::Keymap;
use look::Look;
use pulloff_engine::text::{counted, sanitize};
use ratatui::Frame;
use slow_notice::SlowNotice;
use std::io::{self, Write};
use std::process::ExitCode;
use std::time::{Duration, Instant};
use terminal::{Display, FrameSink, Inbox, Incoming};
use theme::Theme;

/// What a person has set, ready to use.
#[derive(Debug, Clone, Default)]
pub struct UserSettings {
    pub keymap: Keymap,
    pub look: look::LookWish,
    /// A message to show when the screen comes up.
    pub notice: Option<String>,
}

/// What the explorer begins with.
#[derive(Debug)]
pub enum Opening {
    /// A preset, and a message about sessions, if there is one.
    Preset(Box<Loaded>, Option<String>),
    /// A preset, with the offer to resume a session that was cut off.
    Offer(Box<Loaded>, Box<HeldSession>),
    Resume(Box<HeldSession>),
}

/// How long the last write of a session may take when the person quits, and when something else ends the program.
const PATIENCE: [Duration; 2] = [Duration::from_secs(5), Duration::from_millis(800)];

/// How long quitting waits for a file being written: the shell is waiting too.
const SAVE_PATIENCE: Duration = Duration::from_secs(10);

/// A session in words: its preset, and how much was walked.
fn describe(held: &HeldSession) -> String {
    let steps = counted(held.summary.steps, "step");
    format!("{}, {steps}", sanitize(&held.summary.preset_name, 24))
}

/// The explorer at its beginning, and the session that it may resume.
fn begin(start: Opening, theme: Theme, autosave: &Autosave) -> (App, Vec<Effect>, Option<Box<HeldSession>>) {
    match start {
        Opening::Preset(loaded, notice) => {
            let (mut app, effects) = App::new(*loaded, theme);
            app.model.message = notice.map(|notice| (Level::Info, notice));
            (app, effects, None)
        }
        Opening::Offer(loaded, held) => {
            let (mut app, effects) = App::new(*loaded, theme);
            let when = ago(held.summary.saved_at);
            app.offer(&format!("A session was cut off {when} ({}).", describe(&held)), held.snapshot.clone());
            (app, effects, Some(held))
        }
        Opening::Resume(held) => {
            let mut text = format!("resumed {} ({})", held.claim.name(), describe(&held));
            let (mut app, effects) = App::resumed(held.snapshot, theme);
            if let Some((_, note)) = app.model.message.take() {
                text = format!("{text}; {note}");
            }
            app.model.message = Some((Level::Info, text));
            autosave.adopt(&Snapshot::of(&app.model), held.claim, held.summary.ended);
            (app, effects, None)
        }
    }
}

/// Runs the explorer until the person quits; its session is kept in `archive`.
pub fn run(
    store: Store,
    archive: Archive,
    start: Opening,
    look: Look,
    settings: UserSettings,
) -> io::Result<ExitCode> {
    let autosave = Autosave::new(archive);
    let last = autosave.clone();
    // Anything else that ends the program does not wait for the loop below, which may be stuck in a write.
    terminal::set_last_words(Box::new(move || drop(last.finish(Ended::Dropped, PATIENCE[1]))));
    let (guard, mut display, inbox) = terminal::enter::<Reply>()?;
    let teller = inbox.sender();
    autosave.start(move |result| {
        // Fails only if the screen is gone.
        let _ = teller.send(Reply::SessionSaved(result));
    })?;
    let sender = inbox.sender();
    let workers = Workers::start(store, move |reply| {
        // Fails only if the screen is gone.
        let _ = sender.send(reply);
    })?;
    let (mut app, effects, mut offered) = begin(start, look.theme, &autosave);
    app.mouse = look.mouse;
    app.keymap = settings.keymap;
    if let Some(notice) = settings.notice {
        app.model.message = Some((Level::Error, notice));
    }
    workers.submit_all(effects);
    converse(&mut app, &mut display, &inbox, &|effects| workers.submit_all(effects), &mut |app| {
        if let Some(held) = offered.take_if(|_| !app.is_offering()) {
            // The offer is answered: if it was declined, another program may have the session.
            if app.model.session > 0 {
                autosave.adopt(&Snapshot::of(&app.model), held.claim, held.summary.ended);
            }
        }
        autosave.offer(Snapshot::of(&app.model));
    });
    drop(guard);
    if let Err(reason) = autosave.finish(Ended::Quit, PATIENCE[0]) {
        // The terminal has been given back, so a message stays on it. If nobody reads it, there is nothing to do.
        let _ = writeln!(io::stderr(), "pulloff: the session was not saved: {reason}");
    }
    // Otherwise a file still being written would be cut off; nothing is written after this.
    temporary::finish(SAVE_PATIENCE);
    Ok(ExitCode::SUCCESS)
}

/// Most curves and steps are done sooner: the frame waits this long for the result.
const GRACE: Duration = Duration::from_millis(30);

/// Whether `effects` begin a walk that has no states yet.
fn is_walk_begun(model: &Model, effects: &[Effect]) -> bool {
    effects.iter().any(|effect| matches!(effect, Effect::Walk(_)))
        && model.walking.is_some_and(|walking| walking.made == 0)
}

/// Takes in a key, another event of the terminal or a reply; returns the work that it requests.
fn take_in<S: FrameSink>(
    app: &mut App,
    display: &mut Display<S>,
    held: &mut HeldKey,
    incoming: Incoming<Reply>,
) -> Vec<Effect> {
    match incoming {
        Incoming::Key(key) if keymap::is_suspend(key) => terminal::suspend(),
        Incoming::Key(key) => {
            fault::point(fault::UI);
            app.held = held.before(key, Instant::now());
            return app.key(key);
        }
        Incoming::Mouse(mouse) => return app.mouse(mouse),
        Incoming::Paste(text) => return app.paste(&text),
        Incoming::Resized | Incoming::Resumed => display.repaint(),
        Incoming::App(reply) => return app.reply(reply),
    }
    Vec::new()
}

/// Keys and replies in, frames out, until the person quits.
///
/// Everything that has happened is taken in before a frame, and a frame is written before looking at what comes next: a
/// held key on a slow line makes one frame for many keys. Before each frame, `keep` is shown the state reached.
fn converse<S: FrameSink>(
    app: &mut App,
    display: &mut Display<S>,
    inbox: &Inbox<Reply>,
    submit: &dyn Fn(Vec<Effect>),
    keep: &mut dyn FnMut(&App),
) {
    let (mut notice, mut held) = (SlowNotice::default(), HeldKey::default());
    let mut dirty = true;
    // Whether the first curve is still to come; its frame does not wait for the pace of a slow line.
    let mut awaits_curve = true;
    // Until when the first frame may wait for the curve, and the first change since the last frame for the step that it
    // began.
    let mut grace = Some(Instant::now() + GRACE);
    while !app.model.quit {
        // Unchanged: wait until something is late. Changed: wait only until the next frame is due.
        let runs = app.model.is_running();
        let due = if runs { display.due_running() } else { display.due() };
        let due = [Some(due), grace].into_iter().flatten().max();
        let first = inbox.next(if dirty { due } else { notice.due() });
        for incoming in first.into_iter().chain(inbox.pending()) {
            let effects = take_in(app, display, &mut held, incoming);
            if !dirty && is_walk_begun(&app.model, &effects) {
                grace = Some(Instant::now() + GRACE);
            }
            submit(effects);
            dirty = true;
        }
        let waits = awaits_curve && app.model.curve.is_none();
        grace = grace.filter(|_| waits || app.model.walking.is_some_and(|walking| walking.made == 0));
        dirty |= notice.look(app);
        keep(app);
        display.take_mouse(app.mouse);
        if let Some(text) = app.clipboard.take() {
            display.copy(&text);
        }
        // A run is watched: its frames leave the line free for keys. The frame after its last state is like any other.
        let runs = app.model.is_running();
        let due = if runs { display.due_running() } else { display.due() };
        let is_due = due <= Instant::now() || (awaits_curve && app.model.curve.is_some());
        if dirty && is_due && grace.is_none_or(|until| until <= Instant::now()) {
            let (mut views, mut screen) = (0, app.screen);
            let render = |frame: &mut Frame<'_>| {
                screen = frame.area();
                views = view::draw(frame, app);
            };
            let is_drawn = if runs {
                display.draw_running(render)
            } else {
                display.draw(render);
                true
            };
            if !is_drawn {
                // Too large for what the line has carried: the next state may be smaller, or there will be more time.
                continue;
            }
            (dirty, grace) = (false, None);
            awaits_curve &= app.model.curve.is_none();
            submit(app.make_room(screen, views));
        }
    }
}
