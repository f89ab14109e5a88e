//! The explorer on a terminal: keys in, pictures out. Nothing here computes.
//!
//! | file | what lives there |
//! |---|---|
//! | [`terminal`] | taking and giving back the terminal, signals, hang-ups, pacing |
//! | [`keymap`] | command id → keys |
//! | [`app`] | keys and pastes → commands; replies → model; what lies over the screen |
//! | [`overlay`] | prompts, choices, questions and the help, as data |
//! | [`layout`] | which region goes where at which size |
//! | [`look`] | theme, charts and mouse from flags, configuration and environment |
//! | [`theme`] | styles and glyphs, by palette, Unicode or ASCII |
//! | [`chart`] | one chart: axes, ticks, curves, marks, the cross-hair |
//! | [`stroke`] | how a curve is drawn: dots, dashes, letters along it |
//! | [`copy`] | the state, the events, a chart and the screen as text, for the clipboard |
//! | [`hatch`] | areas filled with slanting lines |
//! | [`view`] | one file per screen region |

pub mod app;
pub mod chart;
pub mod copy;
pub mod hatch;
pub mod keymap;
pub mod layout;
pub mod look;
pub mod overlay;
pub mod stroke;
pub mod terminal;
pub mod theme;
pub mod view;

#[cfg(test)]
mod budget;

pub use terminal::refuse_reason;

use crate::explorer::model::Level;
use crate::explorer::{Effect, Reply, Workers};
use crate::fault;
use crate::preset::{Loaded, Store, temporary};
use app::App;
use keymap::Keymap;
use look::Look;
use std::io;
use std::process::ExitCode;
use std::time::Duration;
use terminal::{Display, Inbox, Incoming, Sink};
use theme::Palette;

/// What a person has set, ready to be used.
#[derive(Debug, Clone, Default)]
pub struct Settings {
    /// The keys of the commands.
    pub keymap: Keymap,
    /// How the screen is to look.
    pub look: look::LookFile,
    /// What is to be told when the screen comes up.
    pub notice: Option<String>,
}

/// How long quitting waits for a file that is being written: the shell waits too.
const SAVE_PATIENCE: Duration = Duration::from_secs(10);

/// Runs the explorer until the person quits.
///
/// # Errors
/// When the terminal cannot be taken, or the system gives no thread.
pub fn run(store: Store, loaded: Loaded, look: Look, settings: Settings) -> io::Result<ExitCode> {
    // A theme asked for by name holds against NO_COLOR, which the backend would obey by itself.
    crossterm::style::force_color_output(look.theme != Palette::Mono);
    let (guard, mut display, inbox) = terminal::enter::<Reply>()?;
    let sender = inbox.sender();
    let workers = Workers::start(store, move |reply| {
        // Refused only when the screen is gone, and the process with it.
        let _ = sender.send(reply);
    })?;
    let (mut app, effects) = App::new(loaded, look.theme());
    app.mouse = look.mouse;
    app.keymap = settings.keymap;
    app.model.message = settings.notice.map(|text| (Level::Error, text));
    workers.submit_all(effects);
    converse(&mut app, &mut display, &inbox, &|effects| workers.submit_all(effects));
    drop(guard);
    // A file still being written would be cut off.
    temporary::finish(SAVE_PATIENCE);
    Ok(ExitCode::SUCCESS)
}

/// Keys and replies in, frames out, until the person quits.
///
/// All that has happened is taken in before a frame, and a frame is written before the next thing is looked at: a held
/// key on a slow line makes one frame for many keys.
fn converse<S: Sink>(
    app: &mut App,
    display: &mut Display<S>,
    inbox: &Inbox<Reply>,
    submit: &dyn Fn(Vec<Effect>),
) {
    let mut dirty = true;
    while !app.model.quit {
        // Unchanged: wait for as long as it takes. Changed: only until the next frame is due.
        let first = inbox.next(dirty.then(|| display.due()));
        for incoming in first.into_iter().chain(inbox.pending()) {
            let effects = match incoming {
                Incoming::Key(key) if keymap::is_suspend(key) => {
                    terminal::suspend();
                    Vec::new()
                }
                Incoming::Key(key) => {
                    fault::point(fault::UI);
                    app.key(key)
                }
                Incoming::Mouse(mouse) => app.mouse(mouse),
                Incoming::Paste(text) => app.paste(&text),
                Incoming::Resized | Incoming::Resumed => {
                    display.repaint();
                    Vec::new()
                }
                Incoming::App(reply) => app.reply(reply),
            };
            submit(effects);
            dirty = true;
        }
        display.take_mouse(app.mouse);
        if let Some(text) = app.clipboard.take() {
            display.copy(&text);
        }
        if dirty && display.is_due() {
            let (mut views, mut screen) = (0, app.screen);
            display.draw(|frame| {
                screen = frame.area();
                views = view::draw(frame, app);
            });
            dirty = false;
            submit(app.make_room(screen, views));
        }
    }
}
