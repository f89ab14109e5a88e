//! The commands that change only what is shown: views, windows, the cross-hair, overlays, pins.

use super::backgrounds::want_all;
use super::command::Id;
use super::effect::Effect;
use super::map_axes::{CURVES, MapAxes, can_be_axis, key_of};
use super::model::{Level, Model};
use super::pins::letter;
use super::reach::{pick_walk_line, walk_line};
use super::script::key_called;
use super::update::values::tell_bare_range;
use super::view::{Axes, Overlay, ScreenPanel, View, Window};
use pulloff_engine::preset::Key;
use pulloff_engine::problem::Begin;
use pulloff_engine::stability::COMPLIANCE;

/// One press magnifies the chart by this factor.
const CLOSER: f64 = 2.0;
/// One press moves the chart by this share of what is visible.
const PAN: f64 = 0.125;
/// One press moves the cross-hair by this share: across, and upwards, where a screen has fewer cells.
const ACROSS: f64 = 1.0 / 64.0;
const UPWARDS: f64 = 1.0 / 32.0;

/// The problems for which there is an envelope of small waves.
pub const NO_ENVELOPE: &str = "for wavy spheres with adhesion only";

/// The middle of a window.
pub const MIDDLE: (f64, f64) = (0.5, 0.5);

/// Shows where each limit point happens over the selected value; if that is shown already, the map of it and the
/// adhesion.
pub(super) fn map(model: &mut Model) {
    let Some((row, _)) = model.selected_knob().filter(|(row, _)| can_be_axis(row)) else {
        let text = match model.selected_knob() {
            // Problem is where the value is selected.
            Some((row, _)) => format!("{} is not a number: pick one in Problem or the control", row.label),
            None => {
                format!("select a number first, or the control: {} goes to Problem", Id::NextPanel.named())
            }
        };
        return model.tell(Level::Error, text);
    };
    // An axis of the same key keeps its range.
    let shown = model.map_axes.clone().filter(|_| model.view == View::Map);
    let over = MapAxes::over(&row.key);
    let x = shown.as_ref().map(|shown| shown.x.clone()).filter(|x| key_of(x) == over.x);
    let is_shown = x.is_some() && shown.is_some_and(|shown| shown.y == over.y);
    let axes = if is_shown { MapAxes::beside_adhesion(&row.key, &model.preset) } else { over };
    let x = x.filter(|x| key_of(x) == axes.x).unwrap_or(axes.x);
    show_map(model, MapAxes { x, y: axes.y });
}

/// Shows the map of these axes; without a second one, the limit points over the first.
pub(super) fn map_of(model: &mut Model, x: &Key, y: Option<&Key>) {
    let axis = |text: &Key, words: &[&str]| -> Result<Key, String> {
        let key = key_of(text);
        if key == COMPLIANCE || words.contains(&&**text) {
            return Ok(text.clone());
        }
        let called = key_called(&model.preset, key)?;
        Ok(format!("{called}{}", &text[key.len()..]).into())
    };
    let axes = axis(x, &[]).and_then(|x| {
        let over = MapAxes::over(&x);
        let y = y.map(|y| axis(y, &CURVES.map(|(name, _)| name))).transpose()?;
        Ok(MapAxes { y: y.map_or(over.y, Key::into_owned), x: over.x })
    });
    match axes {
        Err(why) => model.tell(Level::Error, why),
        Ok(axes) if key_of(&axes.x) == key_of(&axes.y) => {
            model.tell(Level::Error, "the two axes of a map must be different keys");
        }
        Ok(axes) => match axes.ranges(&model.preset) {
            Ok(_) => {
                for axis in [&axes.x, &axes.y] {
                    tell_bare_range(model, axis);
                }
                show_map(model, axes);
            }
            Err(why) => model.tell(Level::Error, why),
        },
    }
}

fn show_map(model: &mut Model, axes: MapAxes) {
    model.map_axes = Some(axes);
    model.look_at(View::Map);
    model.windows[View::Map as usize] = Window::WHOLE;
}

/// Zooms a view about a place of its window.
pub(super) fn zoom(model: &mut Model, view: View, closer: bool, about: (f64, f64)) {
    if view.is_table() {
        model.tell(Level::Info, "a table has nothing to zoom");
        return;
    }
    let times = if closer { CLOSER } else { 1.0 / CLOSER };
    match model.window(view).zoomed(times, about) {
        Some(window) => model.set_window(view, window),
        None if closer => model.tell(Level::Info, "no closer: there is no more detail to show"),
        None => {
            model.tell(Level::Info, format!("no further away: {} shows the whole chart", Id::Whole.named()));
        }
    }
}

pub(super) fn whole(model: &mut Model) {
    // All views side by side that share an axis.
    for view in model.shown_views() {
        if view == model.view || (view.is_of_force() && model.view.is_of_force()) {
            model.set_window(view, Window::WHOLE);
        }
    }
}

pub(super) fn cross_hair(model: &mut Model) {
    if model.view.is_table() && model.cross.is_none() {
        model.tell(Level::Info, "a table has no cross-hair: arrows move through its lines");
        return;
    }
    model.cross = if model.cross.is_some() { None } else { Some(MIDDLE) };
    if model.cross.is_some() {
        // In this panel the arrow keys move the cross-hair.
        model.panel = ScreenPanel::Charts;
    }
}

/// An arrow key in Charts moves the cross-hair, or, without one, the window.
pub(super) fn go(model: &mut Model, right: f64, up: f64) {
    if model.view.is_table() {
        let line = walk_line(model);
        pick_walk_line(model, if up < 0.0 { line + 1 } else { line.saturating_sub(usize::from(up > 0.0)) });
        return;
    }
    let window = model.window(model.view);
    let Some((x, y)) = model.cross else {
        let window = window.moved(right * PAN, up * PAN);
        model.set_window(model.view, window);
        if window.is_beyond() {
            model.tell(
                Level::Info,
                format!("past the end of the curve: {} shows all of it", Id::Whole.named()),
            );
        }
        return;
    };
    let (x, y) = (x + right * ACROSS, y + up * UPWARDS);
    let beyond = |at: f64| at - at.clamp(0.0, 1.0);
    model.set_window(model.view, window.moved(beyond(x), beyond(y)));
    model.cross = Some((x.clamp(0.0, 1.0), y.clamp(0.0, 1.0)));
}

/// Toggles an overlay, and says so if this problem has none.
pub(super) fn overlay(model: &mut Model, overlay: Overlay) {
    let on = !model.is_over(overlay);
    match overlay {
        Overlay::Smooth => model.overlays.smooth = on,
        Overlay::Exact => model.overlays.exact = on,
        Overlay::Envelope => model.overlays.envelope = on,
        Overlay::Device => model.device = Some(on),
    }
    let missing = model.curve.as_ref().is_some_and(|curve| curve.base.theory.envelope.is_none());
    if overlay == Overlay::Envelope && on && missing {
        model.tell(Level::Info, format!("the envelope is {NO_ENVELOPE}"));
    }
}

/// Switches between reduced axes and raw values.
pub(super) fn axes(model: &mut Model) {
    model.axes = if model.axes == Axes::Reduced { Axes::Raw } else { Axes::Reduced };
}

pub(super) fn pin(model: &mut Model) {
    let Some(curve) = model.curve.clone() else { return };
    match model.pins.add(&curve) {
        Ok(number) => {
            model.tell(
                Level::Info,
                format!(
                    "pinned as {}: change a value to compare; {} removes it",
                    letter(number),
                    Id::Pins.named()
                ),
            );
        }
        Err(reason) => model.tell(Level::Error, reason),
    }
}

/// Pins the same problem in ring elements beside its exact solution, or the reverse; removes the pin if it is there.
pub(super) fn in_rings(model: &mut Model) {
    const KIND: &str = "basis.kind";
    if model.preset.path.begin == Begin::Apart {
        return model.tell(Level::Error, "a loop has no ring elements: path.begin=disc compares them");
    }
    let is_exact = model.preset.get(KIND).is_none_or(|kind| kind.to_string() != "rings");
    let word = if is_exact { "rings" } else { "exact" };
    let mut preset = model.preset.clone();
    if let Err(invalid) = preset.set(KIND, word.into()) {
        return model.tell(Level::Error, invalid.to_string());
    }
    if let Some(number) = model.pins.number_of(&preset) {
        model.pins.remove(Some(number));
        return;
    }
    match model.pins.want(preset) {
        Ok(number) => {
            let text = if is_exact { "in ring elements" } else { "exactly" };
            model.tell(Level::Info, format!("the same problem {text} as pin {}", letter(number)));
        }
        Err(reason) => model.tell(Level::Error, reason),
    }
}

pub(super) fn unpin(model: &mut Model, number: Option<usize>) {
    if !model.pins.remove(number) {
        return model.tell(Level::Error, "no curve is pinned under that letter");
    }
    let which = number.map_or_else(|| "all pins".to_owned(), |number| format!("pin {}", letter(number)));
    model.tell(Level::Info, format!("removed {which}; {} brings back what was removed", Id::Undo.named()));
}

/// Carries views, overlays and pins over to another session.
pub(super) fn carry_on(from: &Model, to: &mut Model) {
    (to.axes, to.overlays, to.view, to.views) = (from.axes, from.overlays, from.view, from.views);
    to.homes = from.homes;
    (to.panel, to.studied) = (from.panel, from.studied);
    to.pins = from.pins.clone();
}

/// The screen has room for this many views.
pub fn make_room(model: &mut Model, views: usize) -> Vec<Effect> {
    model.views = views.clamp(1, View::ALL.len());
    want_all(model)
}
