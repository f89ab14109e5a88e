//! The state of a session, without terminals, keys or colours.

use super::command::{Command, FIRST_LENGTH, FIRST_PACE};
use super::curve::{CurveData, Inadmissible};
use super::data::Folder;
use super::history::{Bookmark, History};
use super::journal::Journal;
use super::map_axes::MapAxes;
use super::node::{Node, NodeKind};
use super::pins::Pins;
use super::progress::CurveStage;
use super::results::Results;
use super::setting::same_curve;
use super::undo::{SessionPlace, Undo};
use super::view::{Axes, Home, Overlay, Overlays, ScreenPanel, View, Window};
use super::walk::measure;
use crate::mend::WordedFault;
use crate::store::{Fingerprint, Listing, Loaded, Source};
use pulloff_engine::case::critical_force;
use pulloff_engine::fit::Fit;
use pulloff_engine::preset::groups::GROUPS;
use pulloff_engine::preset::{Key, Preset, Row, Value, data};
use pulloff_engine::problem::{Begin, Control, Turn};
use pulloff_engine::quasistatic::Path;
use pulloff_engine::quasistatic::walk::At;
use pulloff_engine::report::number::{significant, with_unit};
use pulloff_engine::report::path::EventReport;
use pulloff_engine::stability::MapAxis;
use pulloff_engine::sweep::quantity::Under;
use pulloff_engine::sweep::{QUANTITIES, QuantityColumn};
use pulloff_engine::units::Quantity;
use std::collections::VecDeque;
use std::sync::Arc;

/// Why the present values have no curve, in words.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum CurveError {
    GivenUp(String),
    Failed(String),
}

impl CurveError {
    /// The reason in words.
    pub fn text(&self) -> &str {
        match self {
            Self::GivenUp(text) | Self::Failed(text) => text,
        }
    }
}

/// What a job on files asks the person to choose or answer.
#[derive(Debug, Clone)]
pub enum Question {
    Preset(Box<Listing>),
    /// A file for this key.
    File(Key, Box<Folder>),
    /// What the columns of a measured curve mean.
    Columns(Box<super::data::Foreign>),
    SaveAnyway,
    /// Whether to replace the preset of this name; the flag says whether with the data of its profile.
    ReplacePreset(String, bool),
    /// Whether to replace the file at this path with this export.
    ReplaceFile(super::export::Export, String),
}

/// What commands wait for besides walks and curves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Awaits {
    Nothing,
    /// A file that will change the problem.
    File,
}

/// A walk request that is running.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Walking {
    pub id: u64,
    pub made: usize,
    /// The number of states requested; `None` for a run, which goes on until something happens.
    pub wanted: Option<usize>,
    /// Whether it was started automatically: the state is solved again for other values.
    pub solves: bool,
    /// The number of the pinned curve on which its target was chosen: it leads to the present curve instead.
    pub instead_of: Option<usize>,
    /// Whether it runs at the pace.
    pub paced: bool,
    /// Whether it has been asked to end: more states may still arrive.
    pub stops: bool,
}

/// How much a message matters.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Level {
    Info,
    /// Something could not be done as requested.
    Error,
    /// The computation or the system failed: no other input helps.
    Failure,
}

impl Level {
    /// The level of a failure for this reason.
    pub fn of(reason: &WordedFault) -> Self {
        if reason.can_be_mended { Self::Error } else { Self::Failure }
    }

    /// Whether something could not be done.
    pub fn is_bad(self) -> bool {
        self != Self::Info
    }
}

/// Where the last fit began.
#[derive(Debug, Clone)]
pub struct FitStart {
    pub preset: Preset,
    /// Whether the fit is under way again, for its errors and its report: its values are those of the session.
    pub(super) repeats: bool,
}

/// A session.
#[derive(Debug, Clone)]
pub struct Model {
    /// Which session of the program it is: each opened preset starts another.
    pub session: u64,
    pub preset: Preset,
    /// Whether the session is kept in a file as far as is known, or why it is not.
    pub kept: Result<(), String>,
    /// The preset as loaded or last saved: any difference is unsaved.
    pub saved: Preset,
    /// The state before the value that is being typed and tried.
    pub untried: Option<Box<Untried>>,
    pub source: Source,
    /// The comment before the first key in the file of the preset, one line each; empty if not known.
    pub comment: String,
    pub fingerprint: Option<Fingerprint>,
    /// The curve on the screen; it can be older than the preset while a new one is computed.
    pub curve: Option<Arc<CurveData>>,
    /// Why the preset as it is has no curve.
    pub curve_error: Option<CurveError>,
    /// The number of the newest curve requested.
    pub curve_wanted: u64,
    /// The number of the newest curve that arrived, failed or was given up.
    pub curve_shown: u64,
    /// Progress of the curve being computed, if that takes long.
    pub stage: Option<CurveStage>,
    /// Results computed in the background.
    pub results: Results,
    /// The axes of the map; `None` for the usual ones.
    pub map_axes: Option<MapAxes>,
    /// The title that a save replaced, and the one it gave: what undo brings back has it too.
    pub(super) retitled: Option<[String; 2]>,
    /// The last fit that was adopted; the values may have changed since.
    pub fit: Option<Arc<Fit>>,
    /// Where that began.
    pub(super) fitted_from: Option<FitStart>,
    /// The quantity being studied.
    pub studied: QuantityColumn,
    /// The range it is studied over while its key is selected; `None` for the usual one.
    pub studied_over: Option<MapAxis>,
    /// The last stiffness of the device, in the user's units.
    pub stiffness: Option<f64>,
    /// Whether the line of the device is drawn; `None` draws it only for a spring.
    pub device: Option<bool>,
    pub history: History,
    pub journal: Journal,
    pub undo: Undo,
    pub inward: bool,
    /// The longest step by hand, in the scaled unknowns.
    pub length: f64,
    /// The pace of a run, in states per second.
    pub pace: f64,
    /// Whether the walk of a resumed session has already been tried on its first curve.
    pub is_tried: bool,
    pub walking: Option<Walking>,
    /// Commands that wait for the walk, the curve or a file, in order.
    pub queue: VecDeque<Command>,
    /// What else they wait for.
    pub awaits: Awaits,
    pub panel: ScreenPanel,
    pub parameter: usize,
    pub event: usize,
    /// The selected line of the table of states; `None` follows the walker.
    pub walk_line: Option<usize>,
    /// The view shown if only one fits, and the first if more do.
    pub view: View,
    /// The view last looked at in each place, in the order of [`Home::ALL`].
    pub homes: [View; Home::ALL.len()],
    pub views: usize,
    /// The part of each view that is shown, in the order of [`View::ALL`].
    pub windows: [Window; View::ALL.len()],
    /// The cross-hair in the first view, in shares of its window.
    pub cross: Option<(f64, f64)>,
    pub axes: Axes,
    /// The theory drawn over the curve.
    pub overlays: Overlays,
    pub pins: Pins,
    /// The message to show; `None` leaves the line to the hint.
    pub message: Option<(Level, String)>,
    /// The names and titles of the presets, once the list of commands has been opened.
    pub preset_names: Vec<[String; 2]>,
    pub question: Option<Question>,
    pub next_request: u64,
    pub quit: bool,
}

/// What there was before values were tried.
#[derive(Debug, Clone)]
pub struct Untried {
    pub place: SessionPlace,
    pub mark: Bookmark,
}

/// Whether a state solves the problem of `curve`.
pub fn is_on_curve(curve: &CurveData, node: &Node) -> bool {
    let [its, ours] = [&node.setting.preset, &curve.setting.preset];
    // The number of a state belongs to one path.
    let way =
        |preset: &Preset| (preset.path.control, preset.path.contact, preset.path.begin, preset.path.turn);
    let same_path = match (node.on_path, &curve.along) {
        (None, None) => true,
        (Some(_), Some(_)) => way(its) == way(ours),
        // When apart, there is nothing to solve.
        (None, Some(_)) | (Some(_), None) => node.is_apart(),
    };
    same_curve(its, ours) && same_path && !matches!(node.kind, NodeKind::Stale(_))
}

impl Model {
    /// A force of `preset` as the axes show it, with its unit.
    pub fn force_in_words(&self, preset: &Preset, force: f64, digits: usize) -> String {
        let critical = critical_force(preset).filter(|_| self.axes == Axes::Reduced);
        critical.map_or_else(
            || with_unit(&preset.units, Quantity::Force, force, false, |x| significant(x, digits)),
            |critical| format!("{} Pc", significant(force / critical, digits)),
        )
    }

    /// A session on a loaded preset; nothing is computed yet.
    pub fn new(loaded: Loaded) -> Self {
        let stiffness = match loaded.preset.path.control {
            Control::Stiffness(k) => Some(k),
            Control::Displacement | Control::Force => None,
        };
        let comment = loaded.comment();
        let mut model = Self {
            session: 0,
            kept: Ok(()),
            saved: loaded.preset.clone(),
            preset: loaded.preset,
            untried: None,
            comment,
            source: loaded.source,
            fingerprint: loaded.fingerprint,
            curve: None,
            curve_error: None,
            curve_wanted: 0,
            curve_shown: 0,
            stage: None,
            results: Results::default(),
            map_axes: None,
            retitled: None,
            fit: None,
            fitted_from: None,
            studied: QuantityColumn { quantity: &QUANTITIES[0], under: Under::Own },
            studied_over: None,
            stiffness,
            device: None,
            history: History::default(),
            journal: Journal::default(),
            undo: Undo::default(),
            inward: true,
            length: FIRST_LENGTH,
            pace: FIRST_PACE,
            is_tried: false,
            walking: None,
            queue: VecDeque::new(),
            awaits: Awaits::Nothing,
            panel: ScreenPanel::Problem,
            parameter: 0,
            event: 0,
            walk_line: None,
            view: View::ForceApproach,
            homes: Home::ALL.map(|home| home.views()[0]),
            views: 1,
            windows: [Window::WHOLE; View::ALL.len()],
            cross: None,
            axes: Axes::Reduced,
            overlays: Overlays::default(),
            pins: Pins::default(),
            message: None,
            preset_names: Vec::new(),
            question: None,
            next_request: 1,
            quit: false,
        };
        // The amplitude, if there is one, is the knob that shows most.
        model.parameter = model.knobs().iter().position(|(row, _)| row.key == "gap.amplitude").unwrap_or(0);
        model
    }

    /// Takes the place of `before`: request numbers continue, so that late replies to that session are recognised.
    pub(super) fn follow(&mut self, before: &Self) {
        self.session = before.session + 1;
        self.next_request = before.next_request + 1;
        (self.curve_wanted, self.curve_shown) = (before.next_request, before.next_request);
        self.views = before.views;
    }

    pub(super) fn tell(&mut self, level: Level, text: impl Into<String>) {
        // Several mistakes are several lines, and there is one.
        self.message = Some((level, text.into().replace('\n', "; ")));
    }

    pub(super) fn number(&mut self) -> u64 {
        let number = self.next_request;
        self.next_request += 1;
        number
    }

    /// The lines of a script that leads to where the session is now.
    pub fn script(&self) -> Result<Vec<String>, String> {
        // Values whose curve was given up have no state: nothing was done with them.
        let given_up = matches!(self.curve_error, Some(CurveError::GivenUp(_)));
        let preset = (!given_up).then_some(&self.preset);
        let has_no_path = self.curve.as_ref().is_some_and(|curve| matches!(curve.along, Some(Err(_))));
        let failed = matches!(self.curve_error, Some(CurveError::Failed(_))) || has_no_path;
        self.journal.so_far(preset, (self.inward, self.length), failed)
    }

    /// Whether the preset differs from its file.
    pub fn is_unsaved(&self) -> bool {
        self.preset != self.saved
    }

    /// Whether the walker has been tried on the present problem: no curve and no walk is under way.
    pub fn is_settled(&self) -> bool {
        self.walking.is_none() && self.shows_its_curve()
    }

    /// Whether the curve on the screen is that of the present values, under their control.
    pub fn shows_its_curve(&self) -> bool {
        self.curve.as_ref().is_some_and(|curve| {
            let [ours, its] = [&self.preset, &curve.setting.preset].map(|preset| &preset.path);
            let same_way = ours.begin == its.begin && (curve.along.is_none() || ours.turn == its.turn);
            let same_device = (ours.control, ours.contact) == (its.control, its.contact);
            let same_units = self.preset.units == curve.setting.preset.units;
            curve.base.is_of(&self.preset) && same_device && same_way && same_units
        })
    }

    /// Whether something is drawn over the curve.
    pub fn is_over(&self, overlay: Overlay) -> bool {
        match overlay {
            Overlay::Smooth => self.overlays.smooth,
            Overlay::Exact => self.overlays.exact,
            Overlay::Envelope => self.overlays.envelope,
            Overlay::Device => self.shows_device(),
        }
    }

    /// Whether the line of the device is drawn: by default, only that of a spring.
    pub fn shows_device(&self) -> bool {
        self.device.unwrap_or(matches!(self.control(), Some(Control::Stiffness(_))))
    }

    /// Whether a paced run is under way; any key but those of the pace ends it.
    pub fn is_running(&self) -> bool {
        self.walking.is_some_and(|walking| walking.paced && !walking.stops)
    }

    /// Whether a walk is under way, or the curve for the next walk is being computed.
    pub fn is_busy(&self) -> bool {
        self.walking.is_some() || self.is_computing()
    }

    /// Whether a newer curve is being computed.
    pub fn is_computing(&self) -> bool {
        self.curve_shown < self.curve_wanted
    }

    /// The parameters that can be changed, with their values, then the dimensionless groups that can be set.
    pub fn knobs(&self) -> Vec<(Row, Option<Value>)> {
        // The title comes last: the numbers are what people change.
        let (texts, numbers): (Vec<Row>, Vec<Row>) = self.preset.knobs().partition(|row| row.key == "title");
        numbers
            .into_iter()
            .chain(texts)
            .chain(GROUPS.iter().map(Row::Borrowed))
            .map(|row| (row.clone(), self.preset.get(&row.key)))
            .filter(|(row, value)| value.is_some() || self.may_be_typed(&row.key))
            .collect()
    }

    /// Whether a key without a value is offered anyway.
    fn may_be_typed(&self, key: &str) -> bool {
        match key {
            "path.end_contact_radius" => true,
            data::OFFSET | data::BASELINE => self.preset.data.source.is_some(),
            _ => false,
        }
    }

    /// The selected parameter and its value.
    pub fn selected_knob(&self) -> Option<(Row, Option<Value>)> {
        self.knobs().into_iter().nth(self.parameter)
    }

    /// The control in reduced units, for the curve's problem.
    pub fn control(&self) -> Option<Control> {
        self.curve.as_ref().map(|curve| curve.case.control)
    }

    /// Whether the current node solves the problem of the curve on the screen.
    pub fn is_on_curve(&self, node: &Node) -> bool {
        self.curve.as_ref().is_some_and(|curve| is_on_curve(curve, node))
    }

    /// Whether the state was computed for the problem of the curve, whatever was controlled.
    pub fn is_of_present_values(&self, node: &Node) -> bool {
        self.curve.as_ref().is_some_and(|curve| curve.base.is_of(&node.setting.preset))
    }

    /// The views on the screen, the first one first.
    pub fn shown_views(&self) -> Vec<View> {
        std::iter::once(self.view).chain(self.view.companions()).take(self.views.max(1)).collect()
    }

    /// The part of a view that is shown: views of the force beside the first one show the same part of its axis.
    pub fn window(&self, view: View) -> Window {
        let window = self.windows[view as usize];
        if self.shares_force(view) {
            Window { y: self.windows[self.view as usize].y, ..window }
        } else {
            window
        }
    }

    /// Looks at a view; its place will return to it.
    pub(super) fn look_at(&mut self, view: View) {
        self.view = view;
        self.homes[view.home() as usize] = view;
    }

    /// Shows a part of a view.
    pub fn set_window(&mut self, view: View, window: Window) {
        self.windows[view as usize] = window;
        if self.shares_force(view) {
            self.windows[self.view as usize].y = window.y;
        }
    }

    fn shares_force(&self, view: View) -> bool {
        self.view.is_of_force() && view.is_of_force()
    }

    /// Where the session stands, for undo.
    pub fn place(&self) -> SessionPlace {
        SessionPlace {
            preset: self.preset.clone(),
            node: self.history.id(),
            inward: self.inward,
            length: self.length,
            pins: self.pins.clone(),
            settled: self.is_settled() || self.is_tried,
            is_step: false,
            shelved: None,
        }
    }

    /// Whether the session stands at `place`.
    pub fn is_at(&self, place: &SessionPlace) -> bool {
        place.is_like(&self.place())
    }

    /// Whether any of `places` differs from where the session stands.
    pub(super) fn can_travel(&self, places: &[Arc<SessionPlace>]) -> bool {
        let here = self.place();
        places.iter().rev().any(|place| !place.is_like(&here))
    }

    /// Whether the values have changed since the walker's state was made.
    pub fn is_ahead(&self) -> bool {
        self.history.current().is_some_and(|node| {
            !same_curve(&node.setting.preset, &self.preset) && !matches!(node.kind, NodeKind::Stale(_))
        })
    }

    /// The walker's node, if it lies on the curve on the screen.
    pub fn walker(&self) -> Option<&Node> {
        self.history.current().filter(|node| self.is_on_curve(node))
    }

    /// Whether a state is a limit point under `control`, whatever it was reached under: the slopes of one are rounding.
    pub fn is_limit(&self, node: &Node, control: Control) -> bool {
        /// A limit point is known to the square root of rounding, as a share of its radius.
        const KNOWN: f64 = 1e-7;
        let curve = self.curve.as_deref().filter(|curve| is_on_curve(curve, node));
        let Some(curve) = curve.filter(|_| node.on_path.is_none() && !node.has_rings()) else {
            return node.is_limit(control);
        };
        let s = node.state.contact_radius;
        let is_here = |radius: f64| (radius - s).abs() <= KNOWN * s;
        let unit = curve.case.units().length;
        node.is_limit(control)
            || control == curve.case.control && curve.limits.iter().any(|at| is_here(at.contact_radius))
            || curve.other_limits.iter().any(|(of, at)| *of == control && is_here(at.contact_radius / unit))
    }

    /// Whether the edge runs inward from an unstable state: one in which a walk begins has it run outward, as at the beginning of an
    /// unloading.
    pub fn runs_inward(&self, node: &Node) -> bool {
        self.inward && !(node.begins && matches!(node.kind, NodeKind::Start | NodeKind::Moved))
    }

    /// The number, among the curve's limit points of the control, of the one on which the walker stands.
    pub fn limit_number(&self) -> Option<usize> {
        let node = self.walker()?;
        let curve = self.curve.as_ref()?;
        if !node.is_limit(curve.case.control) || node.has_rings() {
            return None;
        }
        let s = node.state.contact_radius;
        curve.limits.iter().position(|limit| (limit.contact_radius - s).abs() <= 1e-7 * s)
    }

    /// Whether edges can run from here: at a limit point of the control, at a touch, or in an unstable state.
    pub fn can_jump(&self) -> bool {
        let (Some(node), Some(control)) = (self.walker(), self.control()) else { return false };
        // The states of a path are stable up to rounding.
        let is_unstable = node.on_path.is_none() && !node.stability.under(control);
        let runs = node.at(control) != At::Nothing || is_unstable;
        !node.is_apart() && runs
    }

    /// Where the path ends outward (reduced): its turn, or its beginning if it starts from a disc.
    pub fn outer_end(&self) -> Option<Turn> {
        let curve = self.curve.as_ref()?;
        let (path, units) = (&self.preset.path, curve.case.units());
        let turn = path.turn.filter(|_| path.begin == Begin::Apart);
        let turn = turn.map(|turn| turn.in_units(1.0 / units.length, 1.0 / units.force, curve.case.control));
        let start =
            curve.unloading.as_ref().ok().and_then(Path::start).map_or(0.0, |start| start.contact_radius);
        Some(turn.unwrap_or(Turn::Radius(curve.case.start.max(start))))
    }

    /// Whether the walker stands at that end, or beyond it.
    pub fn is_at_outer_end(&self) -> bool {
        let (Some(node), Some(end), Some(control)) = (self.walker(), self.outer_end(), self.control()) else {
            return false;
        };
        let slack = 1e-9 * end.value().abs();
        measure(end, control, &node.state) >= end.value() - slack
    }

    /// Whether the walker stands where the curve starts.
    pub fn is_at_start(&self) -> bool {
        let start = self.curve.as_ref().map(|curve| curve.case.start);
        let here = self.walker().map(|node| node.state.contact_radius);
        start.zip(here).is_some_and(|(start, here)| (here - start).abs() <= 1e-9 * start)
    }

    /// The jumps of the walk that led to the walker, with the number of their node.
    pub fn walked_events(&self) -> Vec<(usize, EventReport)> {
        let mut made = 0;
        let event = |(number, node): (usize, &Node)| match &node.kind {
            NodeKind::Jump(event) => {
                made += 1;
                let mut report = EventReport::new(&node.setting.reduced, node.control, made, event);
                let before = node.parent.and_then(|parent| self.history.node(parent));
                let landed = node.is_apart() || node.admissibility.holds;
                report.admissible = before.map(|before| before.admissibility.holds && landed);
                Some((number, report))
            }
            _ => None,
        };
        self.history.path().into_iter().filter_map(event).collect()
    }

    /// The inadmissible parts of the curve; in the log they come after the events.
    pub fn shown_inadmissible(&self) -> &[Inadmissible] {
        let base = self.curve.as_ref().map(|curve| &curve.base);
        base.and_then(|base| base.inadmissible.as_deref()).unwrap_or_default()
    }
}
