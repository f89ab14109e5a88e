//! What the panels last showed, to show it again: most keys change one panel, and the charts take longest to draw.
//!
//! A picture is kept for as long as every frame shows it, together with all that it was drawn from: the scene, which
//! is that of the whole screen, and what it is. Large things are the same when they are the same in memory, which the
//! scene keeps alive, or by the number that the history counts its changes with.

use crate::explorer::loops::LoopData;
use crate::explorer::pins::Pin;
use crate::explorer::profile::Inside;
use crate::explorer::{Axes, CurveData, EventSource, Model, Overlays, View, Window};
use crate::tui::app::App;
use crate::tui::keymap::Keymap;
use crate::tui::theme::Theme;
use pulloff_engine::preset::Preset;
use pulloff_engine::units::UnitSystem;
use ratatui::Frame;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use std::sync::Arc;

/// A panel, and what of the session only this panel shows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum What {
    Walker,
    Events(usize),
    /// A view, its window, and the cross-hair; the first has the keys.
    Chart {
        view: View,
        window: Window,
        cross: Option<(f64, f64)>,
        is_first: bool,
    },
}

/// A panel as it was drawn.
#[derive(Debug)]
struct Picture {
    what: What,
    is_selected: bool,
    cells: Buffer,
}

/// The pictures of the last frame.
#[derive(Debug, Default)]
pub struct Pictures {
    scene: Option<Scene>,
    /// Those of the frame before, as far as they have not been shown again,
    old: Vec<Picture>,
    shown: Vec<Picture>,
}

impl Pictures {
    /// A frame of `app` begins: pictures of another scene are worth nothing.
    pub(super) fn begin(&mut self, app: &App) {
        self.old = std::mem::take(&mut self.shown);
        if !self.scene.as_ref().is_some_and(|scene| scene.is_of(app)) {
            self.old.clear();
            self.scene = Some(Scene::of(app));
        }
    }

    /// The frame is drawn: what it did not show is forgotten.
    pub(super) fn end(&mut self) {
        self.old = Vec::new();
    }

    /// Shows a panel in `area`: as in the frame before, or drawn anew, which must change nothing outside of `area`.
    pub(super) fn show(
        &mut self,
        frame: &mut Frame<'_>,
        area: Rect,
        what: What,
        is_selected: bool,
        draw: impl FnOnce(&mut Frame<'_>),
    ) {
        let is_same = |picture: &Picture| {
            (picture.what, picture.is_selected, picture.cells.area) == (what, is_selected, area)
        };
        if let Some(at) = self.old.iter().position(is_same) {
            let picture = self.old.swap_remove(at);
            copy(&picture.cells, frame.buffer_mut(), area);
            self.shown.push(picture);
            return;
        }
        draw(frame);
        let mut cells = Buffer::empty(area);
        copy(frame.buffer_mut(), &mut cells, area);
        self.shown.push(Picture { what, is_selected, cells });
    }
}

/// Copies the cells of `area`, which is inside of both.
fn copy(from: &Buffer, to: &mut Buffer, area: Rect) {
    for y in area.top()..area.bottom() {
        let row = |buffer: &Buffer| {
            let start = buffer.index_of(area.x, y);
            start..start + usize::from(area.width)
        };
        let (source, target) = (row(from), row(to));
        to.content[target].clone_from_slice(&from.content[source]);
    }
}

/// All that walker, charts and events are drawn from, but for what [`What`] says.
#[derive(Debug)]
struct Scene {
    session: u64,
    revision: u64,
    curve: Option<Arc<CurveData>>,
    /// What stands in place of a curve.
    is_computing: bool,
    cycle: Option<Arc<LoopData>>,
    inside: Option<Arc<Inside>>,
    pins: Vec<Pin>,
    /// By which the pins are named.
    preset: Option<Preset>,
    units: UnitSystem,
    overlays: Overlays,
    device: Option<bool>,
    axes: Axes,
    events: EventSource,
    is_inward: bool,
    length: f64,
    theme: Theme,
    keymap: Keymap,
}

fn inside(model: &Model) -> Option<&Arc<Inside>> {
    model.profile.as_ref().filter(|_| model.profile_wanted.is_some())
}

/// The preset, where pins are named by it.
fn naming(model: &Model) -> Option<&Preset> {
    (!model.pins.all().is_empty()).then_some(&model.preset)
}

/// Whether both are the same in memory, or missing.
fn is_same<T>(a: Option<&Arc<T>>, b: Option<&Arc<T>>) -> bool {
    match (a, b) {
        (Some(a), Some(b)) => Arc::ptr_eq(a, b),
        (None, None) => true,
        _ => false,
    }
}

impl Scene {
    fn of(app: &App) -> Self {
        let model = &app.model;
        Self {
            session: model.session,
            revision: model.history.revision(),
            curve: model.curve.clone(),
            is_computing: model.is_computing(),
            cycle: model.cycle.clone(),
            inside: inside(model).cloned(),
            pins: model.pins.all().to_vec(),
            preset: naming(model).cloned(),
            units: model.preset.units.clone(),
            overlays: model.overlays,
            device: model.device,
            axes: model.axes,
            events: model.events,
            is_inward: model.inward,
            length: model.length,
            theme: app.theme,
            keymap: app.keymap.clone(),
        }
    }

    fn is_of(&self, app: &App) -> bool {
        let model = &app.model;
        // Named one by one, so that none is forgotten.
        let Self { session, revision, curve, is_computing, inside: shown, pins, preset, units, .. } = self;
        let Self { cycle, overlays, device, axes, events, is_inward, length, theme, keymap, .. } = self;
        let is_pinned =
            |(a, b): (&Pin, &Pin)| a.number == b.number && is_same(Some(&a.curve), Some(&b.curve));
        let all = model.pins.all();
        (*session, *revision) == (model.session, model.history.revision())
            && is_same(curve.as_ref(), model.curve.as_ref())
            && *is_computing == model.is_computing()
            && is_same(shown.as_ref(), inside(model))
            && is_same(cycle.as_ref(), model.cycle.as_ref())
            && pins.len() == all.len()
            && pins.iter().zip(all).all(is_pinned)
            && preset.as_ref() == naming(model)
            && *units == model.preset.units
            && (*overlays, *device, *axes, *events)
                == (model.overlays, model.device, model.axes, model.events)
            && (*is_inward, length.to_bits()) == (model.inward, model.length.to_bits())
            && (theme, keymap) == (&app.theme, &app.keymap)
    }
}
