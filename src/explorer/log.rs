//! What happens on the path, as one list: what is done, where the walker stands, and what lies ahead.
//!
//! The path is that of the device: unloading from the initial disc, or loading from apart to the turn and back. Each of
//! its events has one number, on charts, in the log, on the status line and in files. A jump walked by hand that is not
//! an event of the path has no number.

use super::loops::LoopData;
use super::model::Model;
use super::node::{Node, NodeKind};
use pulloff_engine::problem::Begin;
use pulloff_engine::quasistatic::walk::{At, Passing};
use pulloff_engine::report::PathReport;
use pulloff_engine::report::path::{EventReport, StateReport};

/// Radii of one state that were found in two ways agree to this accuracy.
const SAME: f64 = 1e-6;

/// Whether an event has happened.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum EventMark {
    Done,
    /// The walker stands where it begins.
    Here,
    Ahead,
    /// Behind the walker, who left the path before the event and rejoined it after.
    PassedBy,
}

/// One line of the log.
#[derive(Debug, Clone)]
pub struct LogEntry {
    pub mark: EventMark,
    /// Its number on the path, counted from 1; `None` for a jump walked off the path.
    pub number: Option<usize>,
    pub event: EventReport,
    /// How often it has happened: an edge that goes back may make a jump again.
    pub times: u32,
    /// The newest node of the walk that it made.
    pub node: Option<usize>,
}

/// The events of the path and of the walk, in order.
#[derive(Debug, Clone, Default)]
pub struct Log {
    pub entries: Vec<LogEntry>,
}

impl Log {
    /// The energy lost so far, and whether a loss without bound is among it.
    pub fn lost(&self) -> (f64, bool) {
        sum(self.entries.iter().map(|entry| (entry, entry.times)))
    }

    /// The energy that the events passed by would have lost, and whether a loss without bound is among it.
    pub fn passed_by(&self) -> (f64, bool) {
        sum(self.entries.iter().filter(|entry| entry.mark == EventMark::PassedBy).map(|entry| (entry, 1)))
    }

    /// Whether jumps that are no events of the path are among what is done.
    pub fn has_left_path(&self) -> bool {
        self.entries.iter().any(|entry| entry.number.is_none())
    }

    /// The index in the list of the event with this number.
    pub fn place(&self, number: usize) -> Option<usize> {
        self.entries.iter().position(|entry| entry.number == Some(number))
    }

    /// The index in the list of the event that happened last; `None` where none has.
    pub fn latest(&self) -> Option<usize> {
        let made = (0..self.entries.len()).filter(|at| self.entries[*at].node.is_some());
        let made = made.max_by_key(|at| self.entries[*at].node);
        made.or_else(|| self.entries.iter().rposition(|entry| entry.times > 0))
    }

    /// The event where the walker stands.
    pub fn here(&self) -> Option<&LogEntry> {
        self.entries.iter().find(|entry| entry.mark == EventMark::Here)
    }
}

/// The loss of events that have each happened so many times, and whether one without bound is among them.
fn sum<'a>(events: impl Iterator<Item = (&'a LogEntry, u32)>) -> (f64, bool) {
    let happened = events.filter(|(_, times)| *times > 0);
    happened.fold((0.0, false), |(sum, unbounded), (entry, times)| match entry.event.dissipated {
        Some(lost) => (sum + f64::from(times) * lost, unbounded),
        None => (sum, true),
    })
}

/// Whether an event begins in this state.
fn begins_at(event: &EventReport, node: &Node) -> bool {
    let stands = node.state.in_units(node.setting.units()).contact_radius;
    radius(event.before.as_ref()).is_some_and(|begins| is_near(begins, stands))
}

/// How an event of the path has happened.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
struct Happened {
    times: u32,
    /// The last node that it made; `None` before the walk began, and where it was a turn.
    by: Option<usize>,
}

impl Happened {
    const UNSEEN: Self = Self { times: 1, by: None };

    fn is_done(self) -> bool {
        self.times > 0
    }
}

fn is_near(a: f64, b: f64) -> bool {
    (a - b).abs() <= SAME * a.abs().max(b.abs())
}

fn radius(state: Option<&StateReport>) -> Option<f64> {
    state.map(|state| state.contact_radius)
}

/// Whether both begin and end in the same state.
fn is_same(a: &EventReport, b: &EventReport) -> bool {
    let near = |a: Option<f64>, b: Option<f64>| match (a, b) {
        (Some(a), Some(b)) => is_near(a, b),
        (a, b) => a.is_none() && b.is_none(),
    };
    a.direction == b.direction
        && near(radius(a.before.as_ref()), radius(b.before.as_ref()))
        && near(radius(a.after.as_ref()), radius(b.after.as_ref()))
}

/// How many events of a path lie behind a state on its way in this direction.
fn behind(events: &[EventReport], s: f64, direction: &str) -> usize {
    let is_behind = |event: &&EventReport| match (event.direction, direction) {
        ("loading", "unloading") => true,
        ("unloading", "unloading") => radius(event.before.as_ref()).is_some_and(|r| r > s),
        ("loading", _) => radius(event.after.as_ref()).is_none_or(|r| r < s),
        _ => false,
    };
    events.iter().take_while(is_behind).count()
}

impl Model {
    /// The path of the device from its beginning; it can be that of earlier values.
    pub fn path(&self) -> Option<&PathReport> {
        match self.preset.path.begin {
            Begin::Apart => self.cycle()?.report(),
            Begin::Disc => self.curve.as_ref()?.report.as_ref(),
        }
    }

    /// The warnings about the values and their path.
    pub fn warnings(&self) -> Vec<String> {
        let mut warnings = self.curve.as_ref().map_or_else(Vec::new, |curve| curve.warnings());
        let whole = self
            .cycle()
            .filter(|whole| self.preset.path.begin == Begin::Apart && whole.is_of_preset(&self.preset));
        let of_loop = whole.and_then(LoopData::report).map_or(&[][..], |report| &report.warnings);
        let new: Vec<String> =
            of_loop.iter().filter(|warning| !warnings.contains(warning)).cloned().collect();
        warnings.extend(new);
        warnings
    }

    /// The events of the path.
    pub fn path_events(&self) -> &[EventReport] {
        self.path().map_or(&[], |path| &path.events)
    }

    /// The number of lines in the log: its events, and after them the inadmissible parts of the curve.
    pub fn log_lines(&self) -> usize {
        self.log().entries.len() + self.shown_inadmissible().len()
    }

    /// The log.
    pub fn log(&self) -> Log {
        self.log_along().unwrap_or_else(|| self.log_on_curve())
    }

    /// The log of a walk along the path, where the number of its state says what is done; `None` for a walk along the
    /// curve.
    fn log_along(&self) -> Option<Log> {
        let node = self.walker()?;
        let (at, path) = (node.on_path?, self.curve.as_ref()?.along.as_ref()?.as_ref().ok()?);
        let (events, passings) = (self.path_events(), Passing::all(path));
        if events.len() != passings.len() {
            return None;
        }
        let walk = self.history.path();
        let first = walk.iter().rposition(|(_, node)| node.begins).unwrap_or(0);
        let made_by = |passing: &Passing<'_>| {
            let is_it = |node: &Node| {
                matches!(&node.kind, NodeKind::Jump(event) if event.kind == passing.event.kind)
                    && node.on_path == Some(passing.after)
            };
            let made = walk[first..].iter().filter(|(_, node)| self.is_on_curve(node) && is_it(node));
            made.fold(Happened::default(), |before, (at, _)| Happened {
                times: before.times + 1,
                by: Some(*at),
            })
        };
        let is_done = |passing: &Passing<'_>| match &passing.event {
            event if event.before.is_none() => true,
            event if event.after.is_none() => node.is_apart(),
            _ if passing.after > passing.before => passing.after <= at,
            // No edge runs there: the event is behind unless the walker was sent to its beginning.
            _ => passing.before < at || passing.before == at && node.kind != NodeKind::Moved,
        };
        let here = passings.iter().position(|passing| !is_done(passing) && passing.before == at);
        let entries = events.iter().zip(&passings).enumerate().map(|(index, (event, passing))| {
            let (is_done, made) = (is_done(passing), made_by(passing));
            LogEntry {
                mark: match (here == Some(index), is_done) {
                    (true, _) => EventMark::Here,
                    (false, true) => EventMark::Done,
                    (false, false) => EventMark::Ahead,
                },
                number: Some(index + 1),
                event: event.clone(),
                times: made.times.max(u32::from(is_done)),
                node: made.by,
            }
        });
        Some(Log { entries: entries.collect() })
    }

    /// The log of a walk along the curve, by the radii at which jumps begin and end.
    fn log_on_curve(&self) -> Log {
        let events = self.path_events();
        let walk = self.history.path();
        let first = walk.iter().rposition(|(_, node)| node.begins).unwrap_or(0);
        let walk = &walk[first..];
        let of_curve: Vec<&(usize, &Node)> = walk.iter().filter(|(_, node)| self.is_on_curve(node)).collect();
        // How many events lie behind the last state that no event of the path led to.
        let (mut done, mut passed) = self.done_before(events, of_curve.first().map(|(_, node)| *node));
        // A jump that is not an event of the path comes after the last event that was done.
        let mut strays: Vec<(usize, LogEntry)> = Vec::new();
        let mut last = done.iter().rposition(|done| done.is_done()).map_or(passed, |at| at + 1);
        for (number, event) in self.walked_events() {
            let Some((_, node)) = of_curve.iter().find(|(of_curve, _)| *of_curve == number) else { continue };
            // What happened under another control is not of this path, and no loss of it.
            if !self.is_own(node) {
                passed = self.passed_by(events, &event);
                last = last.max(passed);
                continue;
            }
            if let Some(at) = events.iter().position(|other| is_same(&event, other)) {
                done[at] = Happened { times: done[at].times + 1, by: Some(number) };
                last = at + 1;
                passed = last;
                continue;
            }
            passed = self.passed_by(events, &event);
            let (mark, node) = (EventMark::Done, Some(number));
            strays.push((last, LogEntry { mark, number: None, event, times: 1, node }));
            last = last.max(passed);
        }
        let at = self.stands_before(events, &done);
        if let Some(turn) = events.iter().position(|event| event.kind == "turn")
            && self.has_turned(&events[turn], of_curve.iter().map(|(_, node)| *node))
        {
            done[turn] = Happened::UNSEEN;
        }
        let mut entries = Vec::new();
        let mut strays = strays.into_iter().peekable();
        for (index, event) in events.iter().enumerate() {
            while let Some((_, entry)) = strays.next_if(|(after, _)| *after <= index) {
                entries.push(entry);
            }
            let mark = match (at == Some(index), done[index].is_done()) {
                (true, _) => EventMark::Here,
                (false, true) => EventMark::Done,
                (false, false) if index < passed => EventMark::PassedBy,
                (false, false) => EventMark::Ahead,
            };
            let Happened { times, by: node } = done[index];
            entries.push(LogEntry { mark, number: Some(index + 1), event: event.clone(), times, node });
        }
        entries.extend(strays.map(|(_, entry)| entry));
        Log { entries }
    }

    /// Whether a state was reached under the control of the path.
    fn is_own(&self, node: &Node) -> bool {
        self.control().is_none_or(|control| node.control == control)
    }

    /// What of the path has happened before a walk along the curve that begins at `first`, and how many events lie behind
    /// that state if none of them led to it.
    fn done_before(&self, events: &[EventReport], first: Option<&Node>) -> (Vec<Happened>, usize) {
        let mut done = vec![Happened::default(); events.len()];
        let Some(node) = first else { return (done, 0) };
        let (behind, is_on_path) = self.passed_before(events, node);
        let mut passed = 0;
        match node.kind {
            // Bodies in contact have come together at some point.
            NodeKind::Start => done[..behind].fill(Happened::UNSEEN),
            // Such a state is reached through the events before it.
            NodeKind::Moved | NodeKind::Limit | NodeKind::Touch(_) if is_on_path && self.is_own(node) => {
                done[..behind].fill(Happened::UNSEEN);
            }
            // Sent elsewhere, or solved again in place for other values: what lies behind did not happen.
            NodeKind::Moved | NodeKind::Solved | NodeKind::Limit if !self.is_start(node) => passed = behind,
            _ => {}
        }
        (done, passed)
    }

    /// How many events lie behind the landing of a jump that is not one of them. A path that only unloads has none that
    /// an outward jump goes back to.
    fn passed_by(&self, events: &[EventReport], jump: &EventReport) -> usize {
        let direction = if self.preset.path.begin == Begin::Disc { "unloading" } else { jump.direction };
        radius(jump.after.as_ref()).map_or(events.len(), |lands| behind(events, lands, direction))
    }

    /// The event that begins in the state of the walker, if it has not happened.
    fn stands_before(&self, events: &[EventReport], done: &[Happened]) -> Option<usize> {
        let node = self.walker().filter(|node| !node.is_apart())?;
        // Nothing runs at a turn: only a walker that was sent there stands before it.
        if node.at(self.control()?) == At::Nothing && node.kind != NodeKind::Moved {
            return None;
        }
        let direction = if self.inward { "unloading" } else { "loading" };
        let has_jumped = matches!(node.kind, NodeKind::Jump(_));
        events.iter().zip(done).position(|(event, done)| {
            (!done.is_done() || !has_jumped) && event.direction == direction && begins_at(event, node)
        })
    }

    /// The number of the event of the path that begins in the state of the walker, whichever way the walk goes.
    pub fn event_beginning_here(&self) -> Option<usize> {
        let node = self.walker().filter(|node| !node.is_apart())?;
        self.path_events().iter().find(|event| begins_at(event, node)).map(|event| event.number)
    }

    /// Whether a walk, whose states these are, has come as far as the turn of the path and goes back.
    fn has_turned<'a>(&self, turn: &EventReport, mut walk: impl Iterator<Item = &'a Node>) -> bool {
        let reached = radius(turn.before.as_ref()).unwrap_or(f64::INFINITY);
        let radius = |node: &Node| node.state.contact_radius * node.setting.units().length;
        self.inward && walk.any(|node| radius(node) >= reached * (1.0 - SAME))
    }

    /// Whether a walk begins with the disc at the preset's start; the path begins there, or further out if it is
    /// unstable.
    fn is_start(&self, node: &Node) -> bool {
        let start = self.curve.as_ref().map(|curve| curve.case.start);
        node.begins && start.is_some_and(|start| is_near(node.state.contact_radius, start))
    }

    /// How many events of the path lie before the state with which a walk begins, and whether it is a state of
    /// the path: one in which an event begins, or the largest pull.
    fn passed_before(&self, events: &[EventReport], node: &Node) -> (usize, bool) {
        let s = node.state.in_units(node.setting.units()).contact_radius;
        let is_there = |state: Option<&StateReport>| radius(state).is_some_and(|r| is_near(r, s));
        let from_disc = self.preset.path.begin == Begin::Disc;
        if let NodeKind::Start = node.kind {
            // A loop begins where its first touch lands; a disc that is there already is on its way apart.
            let landed = events.iter().position(|event| is_there(event.after.as_ref()));
            // Without adhesion the contact grows from nothing: the walk begins a little after the touch.
            let touched =
                || events.iter().position(|event| event.kind == "first-touch" && !self.is_start(node));
            let behind = landed.or_else(touched).map_or_else(|| behind(events, s, "unloading"), |at| at + 1);
            return (if from_disc { 0 } else { behind }, false);
        }
        let begins = events.iter().position(|event| is_there(event.before.as_ref()));
        let pull = self.path().and_then(|path| radius(path.totals.pull()));
        let is_pull = pull.is_some_and(|pull| is_near(pull, s));
        let is_on_path = begins.is_some() || is_pull;
        // Bodies are pulled hardest on their way apart, whichever way the walker has turned since.
        let direction = if self.inward || from_disc || is_pull { "unloading" } else { "loading" };
        (begins.unwrap_or_else(|| behind(events, s, direction)), is_on_path)
    }
}
