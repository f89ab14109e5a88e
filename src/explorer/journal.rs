//! What was done in a session, as the lines of a script that repeats it.
//!
//! A line is written when something took effect, not when it was requested: the reply to a walk says how many states it
//! made, and only then do they become a line. What a walk depends on besides the walker's state (the values, the
//! direction, the step length) is compared with what a replay has at that place, and set first where it differs. So
//! values tried and taken back, a direction reversed twice and what affects only the screen leave nothing, and the
//! order is that in which states were made, whatever the timing was.

use super::command::{Command, FIRST_LENGTH, Id, MOST_STEPS};
use super::curve::CurveData;
use super::detours::without_detours;
use super::node::{Node, NodeKind};
use super::script;
use super::walk::{Action, WalkOutcome};
use crate::store::Source;
use pulloff_engine::exact;
use pulloff_engine::preset::changes::changes;
use pulloff_engine::preset::{BasisSpec, Preset};
use pulloff_engine::problem::Begin;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// The most lines kept, and the most bytes in them: half of what a script may have.
const LINES: usize = script::MOST_LINES / 2;
const BYTES: usize = 1 << 19;

/// What was done since a preset was opened.
#[derive(Debug, Clone, Default)]
pub struct Journal {
    kept: KeptJournal,
    /// How many states each line made; not known for the earlier lines of a resumed session.
    states: Arc<Vec<Option<usize>>>,
    bytes: usize,
    walking: Option<OpenWalk>,
}

/// Where the walk began.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Beginning<P = Preset> {
    pub source: Source,
    pub preset: P,
}

/// What a replay has set at the end of the lines.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Replay<P = Preset> {
    pub preset: P,
    pub inward: bool,
    #[serde(with = "exact")]
    pub length: f64,
}

/// A walk that is not over yet.
#[derive(Debug, Clone)]
struct OpenWalk {
    action: Action,
    curve: Arc<CurveData>,
    inward: bool,
    length: f64,
    made: usize,
}

/// What a session keeps of a journal: everything but a walk that is not over yet. A document holds the numbers of its
/// presets.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct KeptJournal<P = Preset> {
    pub lines: Arc<Vec<String>>,
    pub start: Option<Box<Beginning<P>>>,
    pub replay: Option<Box<Replay<P>>>,
    /// The steps of the last line, if further steps can be added to it.
    pub steps: Option<usize>,
    /// Why the lines no longer lead to the current state.
    pub broken: Option<String>,
}

impl Default for KeptJournal {
    fn default() -> Self {
        Self { lines: Arc::default(), start: None, replay: None, steps: None, broken: None }
    }
}

impl<P> KeptJournal<P> {
    /// The same with other presets.
    /// Errors: Those of `preset`.
    pub fn map<Q, E>(self, mut preset: impl FnMut(P) -> Result<Q, E>) -> Result<KeptJournal<Q>, E> {
        let Self { lines, start, replay, steps, broken } = self;
        let start = start.map(|at| Ok(Box::new(Beginning { source: at.source, preset: preset(at.preset)? })));
        let start = start.transpose()?;
        let replay = replay.map(|at| {
            Ok(Box::new(Replay { preset: preset(at.preset)?, inward: at.inward, length: at.length }))
        });
        Ok(KeptJournal { lines, start, replay: replay.transpose()?, steps, broken })
    }
}

impl Journal {
    /// What a session keeps of it.
    pub fn kept(&self) -> KeptJournal {
        let mut over = self.clone();
        over.abandoned();
        over.kept
    }

    /// The journal of a resumed session.
    pub fn of(kept: KeptJournal) -> Self {
        let bytes = kept.lines.iter().map(String::len).sum();
        let states = Arc::new(vec![None; kept.lines.len()]);
        Self { kept, states, bytes, walking: None }
    }

    /// Its lines so far; a walk under way is not among them yet.
    pub fn lines(&self) -> &[String] {
        &self.kept.lines
    }

    /// Where the walk began; nothing before the first state.
    pub fn start(&self) -> Option<&Beginning> {
        self.kept.start.as_deref()
    }

    /// The lines that lead to `preset`, or without one to the walker's state, walked `way` (inward or not, step
    /// length); `failed` if the preset has no curve.
    pub fn so_far(
        &self,
        preset: Option<&Preset>,
        way: (bool, f64),
        failed: bool,
    ) -> Result<Vec<String>, String> {
        let mut journal = self.clone();
        journal.abandoned();
        let own = journal.kept.replay.as_ref().map(|replay| replay.preset.clone());
        if let Some(preset) = preset.or(own.as_ref()) {
            journal.sync(preset, Some(way), failed);
        }
        if let Some(broken) = journal.kept.broken {
            return Err(broken);
        }
        let made = journal.kept.lines.iter().cloned().zip(journal.states.iter().copied());
        Ok(without_detours(&made.collect::<Vec<_>>()))
    }

    pub(super) fn begin(&mut self, source: Source, preset: Preset) {
        let inward = preset.path.begin == Begin::Disc;
        let replay = Replay { preset: preset.anywhere(), inward, length: FIRST_LENGTH };
        let (start, replay) = (Some(Box::new(Beginning { source, preset })), Some(Box::new(replay)));
        *self = Self { kept: KeptJournal { start, replay, ..KeptJournal::default() }, ..Self::default() };
    }

    pub(super) fn walks(&mut self, action: Action, curve: Arc<CurveData>, inward: bool, length: f64) {
        self.walking = Some(OpenWalk { action, curve, inward, length, made: 0 });
    }

    pub(super) fn made(&mut self, states: usize) {
        if let Some(walking) = &mut self.walking {
            walking.made += states;
        }
    }

    /// The walk is abandoned: its further states are ignored.
    pub(super) fn abandoned(&mut self) {
        self.ended(&WalkOutcome::Paused, false);
    }

    /// Where a replay must begin for `walking`: that is not part of the curve of one disc, and only a restart asks for it.
    fn begun(&self, walking: &OpenWalk) -> Begin {
        let begin = walking.curve.setting.preset.path.begin;
        match (&walking.action, &self.kept.replay) {
            // A path belongs to one beginning, and so does a curve that has ring elements only with one of them.
            _ if walking.curve.along.is_some() || walking.curve.setting.preset.basis != BasisSpec::Exact => {
                begin
            }
            (Action::Begin, _) => Begin::Apart,
            (Action::MoveTo(s), _) if s.total_cmp(&walking.curve.case.start).is_eq() => Begin::Disc,
            (_, Some(replay)) => replay.preset.path.begin,
            (_, None) => begin,
        }
    }

    /// The walk is over; `is_stale` if it leaves the state marked as not solved.
    pub(super) fn ended(&mut self, outcome: &WalkOutcome, is_stale: bool) {
        let Some(walking) = self.walking.take() else { return };
        let mut preset = walking.curve.setting.preset.clone();
        preset.path.begin = self.begun(&walking);
        let preset = &preset;
        let way = Some((walking.inward, walking.length));
        let is_solve = matches!(walking.action, Action::Solve { .. });
        // A value that could not be solved and has been taken back meanwhile leaves nothing to replay.
        if walking.made == 0 && !(is_stale && is_solve) {
            return;
        }
        let (made, before) = (walking.made, self.kept.lines.len());
        match walking.action {
            Action::Solve { .. } => self.sync(preset, None, is_stale),
            Action::Steps(_) => {
                self.sync(preset, way, false);
                // Beyond a limit point, or after the end, a further step is a separate walk.
                self.step(walking.made, matches!(outcome, WalkOutcome::Done | WalkOutcome::Paused));
            }
            Action::ToLimit | Action::ToEvent(_) | Action::Run(_) => {
                self.sync(preset, way, false);
                let is_over = match outcome {
                    WalkOutcome::AtLimit => true,
                    WalkOutcome::Ended(_) => !matches!(walking.action, Action::Run(_)),
                    _ => false,
                };
                self.write(&match (is_over, walking.action) {
                    (true, Action::ToEvent(_)) => Id::NextEvent.into(),
                    (true, _) => Id::Run.into(),
                    (false, _) => Command::RunOf(walking.made),
                });
            }
            Action::Jump => {
                self.sync(preset, way, false);
                self.write(&Id::Jump.into());
            }
            Action::Begin => {
                self.sync(preset, None, false);
                self.write(&Id::Restart.into());
                self.turned(false);
            }
            Action::MoveTo(s) => {
                let case = &walking.curve.case;
                self.sync(preset, None, false);
                if s.total_cmp(&case.start).is_eq() && walking.curve.along.is_none() {
                    self.write(&Id::Restart.into());
                    self.turned(true);
                } else {
                    self.write(&Command::MoveTo(product(s, case.units().length)));
                }
            }
            Action::MoveToState { command, .. } => {
                self.sync(preset, None, false);
                self.write(&command);
            }
            Action::MoveToLimit { command, .. } | Action::MoveToContacts { command, .. } => {
                self.sync(preset, None, false);
                self.write(&command);
                self.turned(walking.inward);
            }
        }
        let all = self.kept.steps.filter(|all| *all > made).unwrap_or(made);
        let has_line = self.kept.lines.len() > before || all > made;
        if let Some(last) = Arc::make_mut(&mut self.states).last_mut() {
            // If states were made without a line, it is not known which line an undo takes back.
            *last = has_line.then_some(all);
        }
    }

    /// An undo, redo or change of branch led to `node` and its values.
    pub(super) fn travelled(&mut self, command: &Command, node: Option<&Node>) {
        self.write(command);
        let (Some(replay), Some(node)) = (&mut self.kept.replay, node) else { return };
        if !matches!(node.kind, NodeKind::Stale(_)) {
            let mut preset = node.setting.preset.anywhere();
            preset.title.clone_from(&replay.preset.title);
            preset.path.control = replay.preset.path.control;
            preset.path.begin = replay.preset.path.begin;
            replay.preset = preset;
        }
    }

    /// The last command leaves the walk in this direction.
    pub(super) fn turned(&mut self, inward: bool) {
        if let Some(replay) = &mut self.kept.replay {
            replay.inward = inward;
        }
    }

    /// Writes what a replay needs to have set before the next line: values, direction, step length.
    fn sync(&mut self, preset: &Preset, way: Option<(bool, f64)>, may_fail: bool) {
        let Some(mut replay) = self.kept.replay.take() else { return };
        // The script may be run from another folder.
        let preset = preset.anywhere();
        if replay.preset != preset {
            match changes(&replay.preset, &preset) {
                Some(all) => self.write_line(may_fail, &Command::Assign(all)),
                None => {
                    self.kept.broken = Some("a value that was dropped cannot be put in a script".to_owned());
                }
            }
            replay.preset = preset;
        }
        if let Some((inward, length)) = way {
            if replay.inward != inward {
                self.write(&Id::Reverse.into());
                replay.inward = inward;
            }
            if replay.length.to_bits() != length.to_bits() {
                self.write(&Command::StepLength(length));
                replay.length = length;
            }
        }
        self.kept.replay = Some(replay);
    }

    fn step(&mut self, count: usize, goes_on: bool) {
        let merged = self.kept.steps.map(|before| before + count).filter(|all| *all <= MOST_STEPS);
        if merged.is_some()
            && let Some(last) = Arc::make_mut(&mut self.kept.lines).pop()
        {
            Arc::make_mut(&mut self.states).pop();
            self.bytes -= last.len();
        }
        let count = merged.unwrap_or(count);
        self.write(&Command::Steps(count));
        self.kept.steps = goes_on.then_some(count);
    }

    fn write(&mut self, command: &Command) {
        self.write_line(false, command);
    }

    fn write_line(&mut self, may_fail: bool, command: &Command) {
        self.kept.steps = None;
        if self.kept.replay.is_none() && self.kept.start.is_none() {
            return;
        }
        let Some(line) = script::line(command) else {
            self.kept.broken = Some("a value of the session cannot be written on one line".to_owned());
            return;
        };
        let line = if may_fail { format!("try {line}") } else { line };
        if self.kept.lines.len() >= LINES || self.bytes + line.len() > BYTES || line.len() > script::LONGEST {
            self.kept.broken = Some("the session is longer than a script may be".to_owned());
            return;
        }
        self.bytes += line.len();
        Arc::make_mut(&mut self.kept.lines).push(line);
        Arc::make_mut(&mut self.states).push(Some(0));
    }
}

/// The number that gives `x` again when divided by `unit`, if rounding permits one.
fn product(x: f64, unit: f64) -> f64 {
    let near = x * unit;
    let all = [near, near.next_up(), near.next_down()];
    all.into_iter().find(|y| (y / unit).total_cmp(&x).is_eq()).unwrap_or(near)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::explorer::nudge::{Amount, nudge};
    use crate::store::{SHIPPED, read};

    #[test]
    fn every_turn_of_every_knob_is_one_assignment_with_the_exact_value() {
        let mut turned = 0;
        for shipped in SHIPPED {
            let preset = read(shipped.name, shipped.text).unwrap();
            for row in preset.knobs() {
                let Ok(to) = nudge(&preset, &row, true, Amount::First, 1.0) else { continue };
                if to == preset {
                    continue;
                }
                let all = changes(&preset, &to).unwrap_or_default();
                assert_eq!(all.len(), 1, "{} {}: {all:?}", shipped.name, row.key);
                let mut back = preset.clone();
                back.assign(&all[0].0, &all[0].1).unwrap();
                assert_eq!(back, to, "{} {}", shipped.name, row.key);
                turned += 1;
            }
        }
        assert!(turned > SHIPPED.len() * 4, "{turned}");
    }
}
