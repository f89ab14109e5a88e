//! The journal of a session is a script that reproduces its walk: the same states to the last digit, whatever the timing was.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a helper of a test fails the test by panicking")]

use crate::support::session::Session;
use fastrand::Rng;
use pulloff::explorer::export::Export;
use pulloff::explorer::job::Done;
use pulloff::explorer::journal::Journal;
use pulloff::explorer::script::{self, Permission, play};
use pulloff::explorer::walk::walk;
use pulloff::explorer::{Command, Effect, Id, Inline, Model, Node, Reply, answer, open, update};
use pulloff::store::Store;
use std::collections::VecDeque;
use std::path::Path;
use tempfile::TempDir;

/// Small problems, so that many walks are quick: exact and in rings, in reduced units and in SI.
const PROBLEMS: [(&str, &[&str]); 4] = [
    ("wavy-sphere", &["gap.wavelength=0.1", "path.end_contact_radius=0.12"]),
    ("fig-9", &["basis.rings=40", "gap.wavelength=0.1", "path.end_contact_radius=0.12"]),
    ("wavy-sphere", &["gap.shape=sphere", "basis.kind=rings", "basis.rings=30", "path.control=force"]),
    ("wavy-sphere", &["gap.wavelength=0.1", "path.begin=apart", "path.end_contact_radius=0.12"]),
];

fn any_command(rng: &mut Rng) -> Command {
    let set = |key: &'static str, text: String| Command::Set { key: key.into(), text };
    match rng.u8(..37) {
        34 => Id::MoveTo.into(),
        35 => Command::MoveTo(format!("{:?}", 0.1 + 0.4 * rng.f64())),
        36 => set("material.closing_work_of_adhesion", ["0.002", "none"][rng.usize(..2)].to_owned()),
        32 => set("path.begin", ["apart", "disc"][rng.usize(..2)].to_owned()),
        33 => Command::Assign(vec![
            ("gap.amplitude".into(), "0.0018".to_owned()),
            ("path.control".into(), ["force", "displacement"][rng.usize(..2)].to_owned()),
        ]),
        0..=5 => Command::Steps(rng.usize(1..6)),
        6..=8 => Id::NextEvent.into(),
        10..=12 => Id::Jump.into(),
        13 => Command::RunOf(rng.usize(1..8)),
        9 | 14 => Id::Reverse.into(),
        15 => [Id::Halve, Id::Double][rng.usize(..2)].into(),
        16..=18 => Id::Undo.into(),
        19 => Id::Redo.into(),
        20 => Id::Restart.into(),
        21 => set("path.control", ["displacement", "force", "0.15"][rng.usize(..3)].to_owned()),
        22..=24 => [Id::More, Id::Less, Id::MuchMore, Id::MuchLess][rng.usize(..4)].into(),
        25 => Command::SelectEvent(rng.usize(1..4)),
        26 => set("material.work_of_adhesion", format!("{:?}", rng.f64() * 0.01)),
        27 => set("title", "a \"title\" # of two  words".to_owned()),
        28 => {
            Command::Try { key: "gap.radius_of_curvature".into(), text: format!("{}", 1.0 + 0.1 * rng.f64()) }
        }
        29 => Command::TakeBack,
        30 => [Id::Pin, Id::ZoomIn, Id::NextView, Id::NextPanel, Id::Axes][rng.usize(..5)].into(),
        _ => [Id::Down, Id::Up, Id::Cancel][rng.usize(..3)].into(),
    }
}

/// A driver that answers late, in pieces, and out of order between the lanes, as threads may.
struct Late {
    inline: Inline,
    pending: VecDeque<Effect>,
    replies: VecDeque<Reply>,
}

impl Late {
    fn submit(&mut self, rng: &mut Rng, effects: Vec<Effect>) {
        for effect in effects {
            match effect {
                // The newest curve wins.
                Effect::Curve(_) => {
                    self.pending.retain(|old| !matches!(old, Effect::Curve(_) | Effect::Compute(_)));
                }
                Effect::StopWalk(_) => self.cut(rng),
                Effect::Walk(_) | Effect::File(_) | Effect::StopCurve(_) => {}
                // Of these, only what is known of the curve affects the walk.
                Effect::Compute(ref task) if ["check", "profile", "pins"].contains(&task.name) => {
                    let is_older =
                        |old: &Effect| matches!(old, Effect::Compute(waits) if waits.name == task.name);
                    self.pending.retain(|old| !is_older(old));
                }
                Effect::Compute(_) | Effect::Stop { .. } | Effect::Pace(_) => continue,
            }
            self.pending.push_back(effect);
        }
    }

    /// Cuts short a walk that has not been answered completely.
    fn cut(&mut self, rng: &mut Rng) {
        let open =
            self.replies.iter().rposition(|reply| matches!(reply, Reply::Walked { outcome: Some(_), .. }));
        if let Some(Reply::Walked { outcome, made, .. }) = open.and_then(|at| self.replies.get_mut(at))
            && made.len() > 1
        {
            made.truncate(rng.usize(1..made.len()));
            *outcome = Some(pulloff::explorer::walk::WalkOutcome::Paused);
        }
    }

    /// One effect done, or one answer given.
    fn go_on(&mut self, rng: &mut Rng, model: &mut Model) -> bool {
        if let Some(reply) = self.replies.pop_front() {
            let effects = answer(model, reply);
            self.submit(rng, effects);
            return true;
        }
        if self.pending.is_empty() {
            return false;
        }
        // Any lane may come first; within a lane the order is kept.
        let at = rng.usize(..self.pending.len());
        let lane = std::mem::discriminant(&self.pending[at]);
        let first = self.pending.iter().position(|effect| std::mem::discriminant(effect) == lane).unwrap();
        match self.pending.remove(first).unwrap() {
            Effect::Walk(request) => {
                let mut made: Vec<Node> = Vec::new();
                let outcome = walk(&request, &mut |state| {
                    made.push(state);
                    true
                });
                let id = request.id;
                while made.len() > 2 && rng.bool() {
                    let rest = made.split_off(rng.usize(1..made.len()));
                    self.replies.push_back(Reply::Walked { id, made, outcome: None });
                    made = rest;
                }
                self.replies.push_back(Reply::Walked { id, made, outcome: Some(outcome) });
            }
            effect => self.replies.extend(self.inline.run(effect)),
        }
        true
    }
}

/// The bytes of the walk, exported.
fn walk_csv(model: &mut Model, driver: &Inline, folder: &Path) -> String {
    let path = folder.join("walk.csv");
    export(model, driver, Export::Walk, &path);
    std::fs::read_to_string(path).unwrap()
}

fn export(model: &mut Model, driver: &Inline, what: Export, path: &Path) {
    let path = path.to_string_lossy().into_owned();
    for effect in update(model, Command::Export { what, path, replace: true }) {
        if let Some(Reply::File(done)) = driver.run(effect) {
            assert!(matches!(*done, Done::Exported(..)), "{done:?}");
        }
    }
}

/// The walk and the script of a session in the state `model`, and the walk of that script.
fn replayed(model: &mut Model, driver: &Inline, folder: &Path) -> (String, String, String) {
    let walked = walk_csv(model, driver, folder);
    let path = folder.join("session.pulloff");
    export(model, driver, Export::Script, &path);
    let text = std::fs::read_to_string(path).unwrap();
    let lines = script::read("session", &text).unwrap();
    let store = Store::at(folder.join("presets"), &[]);
    let loaded = store.load(&store.resolve("fig-3-jkr").unwrap(), &[] as &[&str]).unwrap();
    let (mut again, effects) = open(loaded);
    play(
        &mut again,
        driver,
        effects,
        &lines,
        Permission::default(),
        &|_, _| Err(String::new()),
        &mut |_, _| {},
    )
    .unwrap_or_else(|failed| panic!("{failed}\n{text}"));
    let back = walk_csv(&mut again, driver, folder);
    (walked, back, text)
}

/// A session on one of the problems, in a folder of its own.
fn begun(seed: u64) -> (TempDir, Model, Inline) {
    let (name, assignments) = PROBLEMS[usize::try_from(seed).unwrap() % PROBLEMS.len()];
    let folder = tempfile::tempdir().unwrap();
    let store = Store::at(folder.path().join("presets"), &[]);
    let (mut model, effects) = open(store.load(&store.resolve(name).unwrap(), assignments).unwrap());
    let driver = Inline::new(store);
    driver.settle(&mut model, effects);
    (folder, model, driver)
}

#[test]
fn a_replay_walks_the_same_states_whatever_was_done() {
    let mut steps = 0;
    for seed in 0..16 {
        let mut rng = Rng::with_seed(seed);
        let (folder, mut model, driver) = begun(seed);
        let mut done = Vec::new();
        for _ in 0..24 {
            let command = any_command(&mut rng);
            done.push(command.clone());
            let effects = update(&mut model, command);
            driver.settle(&mut model, effects);
        }
        let (walked, back, text) = replayed(&mut model, &driver, folder.path());
        assert!(walked == back, "seed {seed}\n{done:#?}\n{text}\n{walked}\n{back}");
        steps += walked.lines().count();
    }
    assert!(steps > 100, "the walks are too short to say anything: {steps}");
}

#[test]
fn late_answers_and_pauses_are_journaled_as_they_took_effect() {
    let mut paused = 0;
    for seed in 100..124 {
        let mut rng = Rng::with_seed(seed);
        let (folder, mut model, driver) = begun(seed);
        let mut late = Late { inline: driver, pending: VecDeque::new(), replies: VecDeque::new() };
        for _ in 0..40 {
            let command = match rng.u8(..8) {
                0 => Id::Run.into(),
                1 => Id::Cancel.into(),
                _ => any_command(&mut rng),
            };
            let effects = update(&mut model, command);
            late.submit(&mut rng, effects);
            for _ in 0..rng.usize(..5) {
                late.go_on(&mut rng, &mut model);
            }
        }
        while late.go_on(&mut rng, &mut model) {}
        let (walked, back, text) = replayed(&mut model, &late.inline, folder.path());
        assert!(walked == back, "seed {seed}\n{text}\n{walked}\n{back}");
        paused += text.lines().filter(|line| line.starts_with("run ")).count();
    }
    assert!(paused > 5, "nothing was paused: {paused}");
}

#[test]
fn the_journal_says_what_was_done_and_leaves_out_what_was_not() {
    let mut session = Session::new("wavy-sphere");
    for _ in 0..3 {
        session.does(Id::Step);
    }
    session.does(Command::Steps(2)).does(Id::ZoomIn).does(Id::Step);
    assert_eq!(session.model.journal.lines(), ["step 6"]);
    session.all(&[Id::NextEvent, Id::Jump, Id::Undo, Id::Undo, Id::Redo]);
    session.all(&[Id::Reverse, Id::Reverse, Id::Halve]).does(Id::Step);
    // Changed four times, each with its own state; the values are exact.
    session.all(&[Id::More, Id::More]).set("path.control", "force").does(Id::Step);
    let expected = [
        "step 6",
        "next-event",
        "step-length 0.01",
        "step 1",
        "set gap.amplitude=0.0026",
        "set gap.amplitude=0.0027",
        "set path.control=force",
        "step 1",
    ];
    assert_eq!(session.model.journal.lines(), expected);
    // Tried and taken back.
    let before = session.model.history.cursor();
    session.set("gap.shape", "formula");
    let lines = session.model.journal.lines();
    let after = session.model.history.cursor();
    assert_ne!(before, after);
    let key = "gap.formula";
    session.does(Command::Try { key: key.into(), text: "r^2/2.2".to_owned() });
    assert_ne!(session.model.journal.lines(), lines);
    session.does(Command::TakeBack);
    assert_eq!((session.model.journal.lines(), session.model.history.cursor()), (lines.clone(), after));
    // What a session keeps of the journal continues in the same way.
    let kept = session.model.journal.kept();
    assert_eq!(Journal::of(kept.clone()).lines(), lines);
    assert_eq!(Journal::of(kept.clone()).kept(), kept);
    // A newly opened preset starts a new journal.
    session.does(Command::Open("fig-3-jkr".to_owned())).does(Id::Restart);
    assert!(session.model.journal.lines().is_empty(), "the walk stands where it begins");
    session.does(Id::Step).does(Id::Restart);
    assert_eq!(session.model.journal.lines(), ["step 1", "restart"]);
}

#[test]
fn values_without_a_path_are_tried_by_a_replay_too() {
    let mut session = Session::new("fig-9-si");
    let set = |key: &'static str, text: &str| Command::Assign(vec![(key.into(), text.to_owned())]);
    session.does(Command::Steps(2)).does(set("gap.amplitude", "0.003"));
    session.does(set("material.closing_work_of_adhesion", "3.86e-6")).does(set("path.begin", "apart"));
    let curve = session.model.curve.as_ref().unwrap();
    assert!(curve.along.as_ref().is_some_and(Result::is_err), "{}", session.status());
    let lines = session.model.script().unwrap();
    assert_eq!(lines.last().map(String::as_str), Some("try set path.begin=apart"), "{lines:?}");
}
