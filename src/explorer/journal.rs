//! How each state of a session came about, and the script that leads to it again.
//!
//! A request that makes states has a [`WalkOrigin`]: the lines that lead to where it began, and what it does there. With
//! the number of states it has made, that gives the lines that lead to any of its states, so undo and redo leave none:
//! wherever the walker goes in the tree, its lines are those of its state. Lines are written when something took effect,
//! not when it was requested. What a walk depends on besides the walker's state (the values, the direction, the step
//! length) is compared with what a replay has at that place, and set first where it differs. So values tried and taken
//! back, a direction reversed twice and what affects only the screen leave nothing, and the order is that in which
//! states were made, whatever the timing was.

use super::command::{Command, FIRST_LENGTH, Id, MOST_STEPS};
use super::curve::CurveData;
use super::node::Trace;
use super::script;
use super::walk::{Action, WalkOutcome};
use crate::store::Source;
use pulloff_engine::exact;
use pulloff_engine::preset::changes::changes;
use pulloff_engine::preset::{BasisSpec, Preset};
use pulloff_engine::problem::Begin;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// The most lines and origins kept, and the most bytes in the lines: half of what a script may have.
const LINES: usize = script::MOST_LINES / 2;
const BYTES: usize = 1 << 19;
/// Why a journal ends.
const TOO_LONG: &str = "the session is longer than a script may be";
const NOT_ONE_LINE: &str = "a value of the session cannot be written on one line";

/// What was done since a preset was opened.
#[derive(Debug, Clone, Default)]
pub struct Journal {
    kept: KeptJournal,
    bytes: usize,
    walking: Option<OpenWalk>,
}

/// Where the walk began.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Beginning<P = Preset> {
    pub source: Source,
    pub preset: P,
}

/// How the states of a request came about.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct WalkOrigin<P = Arc<Preset>> {
    before: JournalLines<P>,
    deed: Deed,
    /// With which state the request ended, so that a further step is another one, and the command that ends there too.
    over: Option<(usize, Option<String>)>,
}

/// What was done, as far as it depends on the number of states made.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum Deed {
    /// Nothing but setting the values.
    Values,
    /// Steps by hand, of one request or of several that continue each other.
    Steps,
    Run,
    /// A command that makes its states whatever their number, and the direction in which it leaves the walk.
    Whole {
        line: String,
        inward: Option<bool>,
    },
}

/// Lines, and what a replay has set at their end.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct JournalLines<P = Arc<Preset>> {
    /// The number of the last line.
    last: Option<usize>,
    preset: P,
    inward: bool,
    #[serde(with = "exact")]
    length: f64,
    /// Why the lines do not lead to the state.
    broken: Option<String>,
}

/// A line, and the number of the one before it.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct JournalLine {
    before: Option<usize>,
    text: String,
}

/// A walk that is not over yet.
#[derive(Debug, Clone)]
struct OpenWalk {
    action: Action,
    curve: Arc<CurveData>,
    inward: bool,
    length: f64,
    /// The origin of its states, once it has made one.
    origin: Option<usize>,
}

/// What a session keeps of a journal: everything but a walk that is not over yet. A document holds the numbers of its
/// presets.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct KeptJournal<P = Arc<Preset>> {
    start: Option<Box<Beginning<P>>>,
    lines: Arc<Vec<JournalLine>>,
    origins: Arc<Vec<WalkOrigin<P>>>,
    /// The place of the walker's state.
    here: Trace,
}

impl<P> Default for KeptJournal<P> {
    fn default() -> Self {
        Self { start: None, lines: Arc::default(), origins: Arc::default(), here: Trace::default() }
    }
}

impl<P: Clone> KeptJournal<P> {
    /// The same with other presets.
    /// Errors: Those of `preset`.
    pub fn map<Q, E>(&self, mut preset: impl FnMut(&P) -> Result<Q, E>) -> Result<KeptJournal<Q>, E> {
        let start = self
            .start
            .as_ref()
            .map(|at| Ok(Box::new(Beginning { source: at.source.clone(), preset: preset(&at.preset)? })));
        let start = start.transpose()?;
        let origins = self.origins.iter().map(|origin| {
            let JournalLines { last, preset: values, inward, length, broken } = origin.before.clone();
            let before = JournalLines { last, preset: preset(&values)?, inward, length, broken };
            Ok(WalkOrigin { before, deed: origin.deed.clone(), over: origin.over.clone() })
        });
        let origins = Arc::new(origins.collect::<Result<_, E>>()?);
        Ok(KeptJournal { start, lines: Arc::clone(&self.lines), origins, here: self.here })
    }
}

impl KeptJournal {
    /// Whether its numbers are those of lines and origins that it has, in the order in which they were made.
    pub fn is_whole(&self) -> bool {
        let ascends = |(at, line): (usize, &JournalLine)| line.before.is_none_or(|before| before < at);
        let has_line = |origin: &WalkOrigin| origin.before.last.is_none_or(|last| last < self.lines.len());
        self.lines.iter().enumerate().all(ascends)
            && self.origins.iter().all(has_line)
            && (self.start.is_none() || self.has(self.here))
    }

    /// Whether it knows how the state at this place came about.
    pub fn has(&self, at: Trace) -> bool {
        at.origin < self.origins.len()
    }
}

impl Journal {
    /// What a session keeps of it.
    pub fn kept(&self) -> &KeptJournal {
        &self.kept
    }

    /// The journal of a resumed session.
    pub fn of(kept: KeptJournal) -> Self {
        let bytes = kept.lines.iter().map(|line| line.text.len()).sum();
        Self { kept, bytes, walking: None }
    }

    /// The lines that lead to the walker's state.
    pub fn lines(&self) -> Vec<String> {
        let mut journal = self.clone();
        let lines = journal.lines_to(self.kept.here);
        lines.map_or_else(Vec::new, |lines| journal.texts(&lines))
    }

    /// Where the walk began; nothing before the first state.
    pub fn start(&self) -> Option<Beginning> {
        let start = self.kept.start.as_deref()?;
        Some(Beginning { source: start.source.clone(), preset: (*start.preset).clone() })
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
        let Some(mut lines) = journal.lines_to(self.kept.here) else { return Ok(Vec::new()) };
        let own = Arc::clone(&lines.preset);
        // Nothing is walked where there is no curve.
        journal.sync(&mut lines, preset.unwrap_or(&own), Some(way).filter(|_| !failed), failed);
        let texts = journal.texts(&lines);
        lines.broken.map_or(Ok(texts), Err)
    }

    pub(super) fn begin(&mut self, source: Source, preset: Preset) {
        let before = JournalLines {
            last: None,
            inward: preset.path.begin == Begin::Disc,
            preset: Arc::new(preset.anywhere()),
            length: FIRST_LENGTH,
            broken: None,
        };
        let origins = Arc::new(vec![WalkOrigin { before, deed: Deed::Values, over: None }]);
        let start = Some(Box::new(Beginning { source, preset: Arc::new(preset) }));
        *self = Self { kept: KeptJournal { start, origins, ..KeptJournal::default() }, ..Self::default() };
    }

    pub(super) fn walks(&mut self, action: Action, curve: Arc<CurveData>, inward: bool, length: f64) {
        self.walking = Some(OpenWalk { action, curve, inward, length, origin: None });
    }

    /// A walk made a state, from which the path leads `inward` if the walker follows one: its place.
    pub(super) fn made(&mut self, inward: Option<bool>) -> Trace {
        let mut here = Trace { inward, ..self.kept.here };
        // The states that begin the first walk come of themselves.
        if let Some(mut walking) = self.walking.take() {
            here = Trace { inward, ..self.next(&mut walking) };
            self.walking = Some(walking);
        }
        self.kept.here = here;
        here
    }

    /// The place of the next state of `walking`.
    fn next(&mut self, walking: &mut OpenWalk) -> Trace {
        let from = self.kept.here;
        if walking.origin.is_some() {
            return Trace { made: from.made + 1, ..from };
        }
        let is_like = |lines: &JournalLines, values: &Preset| {
            *lines.preset == *values
                && (lines.inward, lines.length.to_bits()) == (walking.inward, walking.length.to_bits())
        };
        let values = self.values(walking);
        if let Action::Steps(count) = walking.action
            && let Some(origin) = self.kept.origins.get(from.origin)
            && origin.deed == Deed::Steps
            && origin.over.as_ref().is_none_or(|(made, _)| *made != from.made)
            && from.made + count <= MOST_STEPS
            && is_like(&origin.left(from), &values)
        {
            walking.origin = Some(from.origin);
            return Trace { made: from.made + 1, ..from };
        }
        let origin = self.originate(walking, &values, false);
        walking.origin = Some(origin);
        Trace { origin, made: 1, inward: None }
    }

    /// The walk could not solve the values, and leaves a state that says so: its place.
    pub(super) fn unsolved(&mut self) -> Trace {
        if let Some(walking) = self.walking.take() {
            if matches!(walking.action, Action::Solve { .. }) {
                let values = self.values(&walking);
                let origin = self.originate(&walking, &values, true);
                self.kept.here = Trace { origin, made: 1, inward: None };
            }
            self.walking = Some(walking);
        }
        self.kept.here
    }

    /// The values that a replay must have for `walking`, wherever it runs.
    fn values(&self, walking: &OpenWalk) -> Preset {
        let mut values = walking.curve.setting.preset.anywhere();
        values.path.begin = self.begun(walking);
        values
    }

    /// A new origin for `walking`: its number.
    fn originate(&mut self, walking: &OpenWalk, values: &Preset, may_fail: bool) -> usize {
        let Some(mut before) = self.lines_to(self.kept.here) else { return 0 };
        let way = Some((walking.inward, walking.length));
        let whole =
            |command: &Command, inward| script::line(command).map(|line| Deed::Whole { line, inward });
        let (way, deed) = match &walking.action {
            Action::Solve { .. } => (None, Some(Deed::Values)),
            Action::Steps(_) => (way, Some(Deed::Steps)),
            Action::ToLimit | Action::ToEvent(_) | Action::Run(_) => (way, Some(Deed::Run)),
            Action::Jump => (way, whole(&Id::Jump.into(), None)),
            Action::Begin => (None, whole(&Id::Restart.into(), Some(false))),
            Action::MoveTo { command: command @ Command::Plain(Id::Restart), .. } => {
                (None, whole(command, Some(true)))
            }
            // Going to a radius does not turn the walk.
            Action::MoveTo { command: command @ Command::MoveTo(_), .. }
            | Action::MoveToState { command, .. } => (None, whole(command, None)),
            Action::MoveTo { command, .. }
            | Action::MoveToLimit { command, .. }
            | Action::MoveToContacts { command, .. } => (None, whole(command, Some(walking.inward))),
        };
        self.sync(&mut before, values, way, may_fail);
        if deed.is_none() {
            before.broken = Some(NOT_ONE_LINE.to_owned());
        }
        if self.kept.origins.len() >= LINES {
            before.broken = Some(TOO_LONG.to_owned());
        }
        let origins = Arc::make_mut(&mut self.kept.origins);
        // Beyond that, all states share the last one.
        if origins.len() <= LINES {
            origins.push(WalkOrigin { before, deed: deed.unwrap_or(Deed::Values), over: None });
        }
        origins.len() - 1
    }

    /// The walk is abandoned: its further states are ignored.
    pub(super) fn abandoned(&mut self) {
        self.walking = None;
    }

    /// Where a replay must begin for `walking`: that is not part of the curve of one disc, and only a restart asks for it.
    fn begun(&self, walking: &OpenWalk) -> Begin {
        let begin = walking.curve.setting.preset.path.begin;
        match (&walking.action, self.kept.origins.get(self.kept.here.origin)) {
            // A path belongs to one beginning, and so does a curve that has ring elements only with one of them.
            _ if walking.curve.along.is_some() || walking.curve.setting.preset.basis != BasisSpec::Exact => {
                begin
            }
            (Action::Begin, _) => Begin::Apart,
            (Action::MoveTo { command: Command::Plain(Id::Restart), .. }, _) => Begin::Disc,
            (_, Some(origin)) => origin.before.preset.path.begin,
            (_, None) => begin,
        }
    }

    /// The walk is over.
    pub(super) fn ended(&mut self, outcome: &WalkOutcome) {
        let Some(OpenWalk { action, origin: Some(origin), .. }) = self.walking.take() else { return };
        let ends = match (&action, outcome) {
            // Beyond a limit point, or after the end, a further step is a separate walk.
            (Action::Steps(_), WalkOutcome::Done | WalkOutcome::Paused) => return,
            (Action::ToEvent(_), WalkOutcome::AtLimit | WalkOutcome::Ended(_)) => Some(Id::NextEvent),
            (Action::ToLimit, WalkOutcome::AtLimit | WalkOutcome::Ended(_))
            | (Action::Run(_), WalkOutcome::AtLimit) => Some(Id::Run),
            _ => None,
        };
        let made = self.kept.here.made;
        if let Some(origin) = Arc::make_mut(&mut self.kept.origins).get_mut(origin) {
            origin.over = Some((made, ends.and_then(|id| script::line(&id.into()))));
        }
    }

    /// The walker goes to the state at this place.
    pub(super) fn go(&mut self, to: Trace) {
        self.kept.here = to;
    }

    /// The lines that lead to the state at `to`; nothing before the first state.
    fn lines_to(&mut self, to: Trace) -> Option<JournalLines> {
        let origin = self.kept.origins.get(to.origin)?;
        let mut lines = origin.left(to);
        let line = match &origin.deed {
            Deed::Values => None,
            Deed::Steps => script::line(&Command::Steps(to.made)),
            Deed::Run => match &origin.over {
                Some((made, Some(line))) if *made == to.made => Some(line.clone()),
                _ => script::line(&Command::RunOf(to.made)),
            },
            Deed::Whole { line, .. } => Some(line.clone()),
        };
        if let Some(line) = line {
            self.write(&mut lines, line);
        }
        Some(lines)
    }

    /// The text of all of `lines`, from the first to the last.
    fn texts(&self, lines: &JournalLines) -> Vec<String> {
        let line = |at: usize| self.kept.lines.get(at);
        let back = std::iter::successors(lines.last.and_then(line), |last| last.before.and_then(line));
        let mut texts: Vec<String> = back.map(|line| line.text.clone()).collect();
        texts.reverse();
        texts
    }

    /// Writes what a replay needs to have set before the next line: values, direction, step length.
    fn sync(&mut self, lines: &mut JournalLines, values: &Preset, way: Option<(bool, f64)>, may_fail: bool) {
        // The script may be run from another folder.
        let values = values.anywhere();
        if *lines.preset != values {
            match changes(&lines.preset, &values) {
                Some(all) => match script::line(&Command::Assign(all)) {
                    Some(line) if may_fail => self.write(lines, format!("try {line}")),
                    Some(line) => self.write(lines, line),
                    None => lines.broken = Some(NOT_ONE_LINE.to_owned()),
                },
                None => {
                    lines.broken = Some("a value that was dropped cannot be put in a script".to_owned());
                }
            }
            lines.preset = Arc::new(values);
        }
        if let Some((inward, length)) = way {
            if lines.inward != inward {
                self.write_command(lines, &Id::Reverse.into());
                lines.inward = inward;
            }
            if lines.length.to_bits() != length.to_bits() {
                self.write_command(lines, &Command::StepLength(length));
                lines.length = length;
            }
        }
    }

    fn write_command(&mut self, lines: &mut JournalLines, command: &Command) {
        match script::line(command) {
            Some(line) => self.write(lines, line),
            None => lines.broken = Some(NOT_ONE_LINE.to_owned()),
        }
    }

    fn write(&mut self, lines: &mut JournalLines, text: String) {
        let all = Arc::make_mut(&mut self.kept.lines);
        if all.len() >= LINES || self.bytes + text.len() > BYTES || text.len() > script::LONGEST {
            lines.broken = Some(TOO_LONG.to_owned());
            return;
        }
        self.bytes += text.len();
        all.push(JournalLine { before: lines.last, text });
        lines.last = Some(all.len() - 1);
    }
}

impl WalkOrigin {
    /// What a replay has set at the state at `to`, with the lines before the last one.
    fn left(&self, to: Trace) -> JournalLines {
        let mut lines = self.before.clone();
        let whole = if let Deed::Whole { inward, .. } = self.deed { inward } else { None };
        lines.inward = to.inward.or(whole).unwrap_or(lines.inward);
        lines
    }
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
