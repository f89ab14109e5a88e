//! What is kept of a model, and the model restored from it.

use crate::explorer::backgrounds::want_all;
use crate::explorer::command::{FIRST_LENGTH, LENGTHS};
use crate::explorer::effect::Effect;
use crate::explorer::fit::fit_again;
use crate::explorer::history::History;
use crate::explorer::journal::{Journal, KeptJournal};
use crate::explorer::map_axes::MapAxes;
use crate::explorer::model::Model;
use crate::explorer::pins::Pins;
use crate::explorer::requests::want_curve;
use crate::explorer::undo::Undo;
use crate::explorer::view::{Axes, Overlays, ScreenPanel, View, Window};
use crate::store::{Fingerprint, Loaded, Source};
use pulloff_engine::preset::Preset;
use pulloff_engine::problem::Control;
use pulloff_engine::stability::MapAxis;
use pulloff_engine::sweep::QuantityColumn;
use serde::{Deserialize, Serialize};

/// What a person made in a session. A clone shares the walk with it, as a snapshot does with its model.
#[derive(Debug, Clone)]
pub struct Snapshot {
    pub session: u64,
    /// The current preset, without a value that is still being typed.
    pub preset: Preset,
    pub saved: Preset,
    pub source: Source,
    pub fingerprint: Option<Fingerprint>,
    pub history: History,
    pub undo: Undo,
    /// Whether the walker has been tried on the current preset.
    pub settled: bool,
    pub pins: Vec<(usize, Preset)>,
    pub look: SessionLook,
    pub journal: KeptJournal,
    /// Where the fit began whose values these are: its errors and report are found again from there.
    pub fitted_from: Option<Preset>,
}

/// How a session is displayed and walked; the fields are as in [`Model`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SessionLook {
    pub panel: ScreenPanel,
    pub parameter: usize,
    pub event: usize,
    pub view: View,
    pub windows: Vec<(View, Window)>,
    pub cross: Option<(f64, f64)>,
    pub axes: Axes,
    pub overlays: Overlays,
    pub inward: bool,
    pub length: f64,
    pub stiffness: Option<f64>,
    pub device: Option<bool>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub map: Option<MapAxes>,
    pub study: SavedStudy,
}

/// The quantity that is studied, by its name, and the range over which it is where that is not the usual one.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SavedStudy {
    pub quantity: String,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub over: Option<MapAxis>,
}

impl SessionLook {
    fn of(model: &Model) -> Self {
        let windows = View::ALL.into_iter().map(|view| (view, model.window(view)));
        Self {
            panel: model.panel,
            parameter: model.parameter,
            event: model.event,
            view: model.view,
            windows: windows.filter(|(_, window)| !window.is_whole()).collect(),
            cross: model.cross,
            axes: model.axes,
            overlays: model.overlays,
            inward: model.inward,
            length: model.length,
            stiffness: model.stiffness,
            device: model.device,
            map: model.map_axes.clone(),
            study: SavedStudy { quantity: model.studied.name(), over: model.studied_over.clone() },
        }
    }

    /// Gives `model` this look; anything that cannot be shown so stays as in a new session.
    fn lay_over(self, model: &mut Model) {
        (model.panel, model.axes) = (self.panel, self.axes);
        model.look_at(self.view);
        (model.overlays, model.inward) = (self.overlays, self.inward);
        (model.event, model.device) = (self.event, self.device);
        model.map_axes = self.map;
        if let Ok(column) = QuantityColumn::named(&self.study.quantity) {
            (model.studied, model.studied_over) = (column, self.study.over);
        }
        model.parameter = self.parameter.min(model.knobs().len().saturating_sub(1));
        for (view, window) in self.windows.into_iter().filter(|(_, window)| window.is_possible()) {
            model.windows[view as usize] = window;
        }
        let share = 0.0..=1.0;
        model.cross = self.cross.filter(|(x, y)| share.contains(x) && share.contains(y));
        model.length = if LENGTHS.contains(&self.length) { self.length } else { FIRST_LENGTH };
        model.stiffness = self.stiffness.filter(|k| k.is_finite() && *k > 0.0);
    }
}

impl Snapshot {
    /// Takes the snapshot of `model`.
    pub fn of(model: &Model) -> Self {
        Self {
            session: model.session,
            preset: model.untried.as_ref().map_or(&model.preset, |before| &before.place.preset).clone(),
            saved: model.saved.clone(),
            source: model.source.clone(),
            fingerprint: model.fingerprint,
            history: model.history.clone(),
            undo: model.undo.clone(),
            settled: model.is_settled() || model.is_tried,
            pins: model.pins.presets().map(|(number, preset)| (number, preset.clone())).collect(),
            look: SessionLook::of(model),
            journal: model.journal.kept().clone(),
            fitted_from: model.fit_began().cloned(),
        }
    }

    /// What [`is_like`](Self::is_like) needs of it, without the walk.
    #[must_use]
    pub fn mark(&self) -> Self {
        Self { history: self.history.stamp(), ..self.clone() }
    }

    /// Whether both contain the same.
    pub fn is_like(&self, other: &Self) -> bool {
        self.session == other.session
            && self.history.revision() == other.history.revision()
            && (&self.look, self.settled) == (&other.look, other.settled)
            && self.fitted_from == other.fitted_from
            && (&self.source, self.fingerprint) == (&other.source, other.fingerprint)
            && (&self.preset, &self.saved, &self.pins) == (&other.preset, &other.saved, &other.pins)
            && self.journal == other.journal
    }

    /// Whether there is anything to lose: a state walked, a value changed, a curve pinned, a map or a study over a range that was
    /// asked for. Looking does not count.
    pub fn is_worth_keeping(&self) -> bool {
        let is_asked = self.look.map.is_some() || self.look.study.over.is_some();
        self.history.len() > 1 || self.preset != self.saved || !self.pins.is_empty() || is_asked
    }

    /// The states walked by hand.
    pub fn steps(&self) -> usize {
        self.history.len().saturating_sub(1)
    }

    /// The session restored from it, and the curves it needs. It takes the place of `before`, whose late replies are
    /// recognised.
    pub fn resume(self, before: Option<&Model>) -> (Model, Vec<Effect>) {
        let loaded = Loaded {
            source: self.source,
            preset: self.saved,
            text: String::new(),
            fingerprint: self.fingerprint,
        };
        let mut model = Model::new(loaded);
        model.preset = self.preset;
        (model.history, model.undo) = (self.history, self.undo);
        model.journal = Journal::of(self.journal);
        model.is_tried = self.settled;
        self.look.lay_over(&mut model);
        if let Control::Stiffness(k) = model.preset.path.control {
            model.stiffness = Some(k);
        }
        if let Some(before) = before {
            model.follow(before);
        }
        let mut effects = vec![want_curve(&mut model)];
        model.pins = Pins::awaiting(self.pins);
        effects.extend(want_all(&mut model));
        effects.extend(self.fitted_from.map(|from| fit_again(&mut model, from)));
        (model, effects)
    }
}
