//! Undo takes back one command, whatever it was, and redo repeats it: bit for bit, whether typed slowly or in one burst.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a helper of a test fails the test by panicking")]

use crate::support::session::Session;
use fastrand::Rng;
use pulloff::explorer::export::Export;
use pulloff::explorer::script::{self, Permission, play};
use pulloff::explorer::undo::SessionPlace;
use pulloff::explorer::{Command, Effect, Id, Model, NodeKind, ScreenPanel, open, update};
use pulloff::store::Store;
use pulloff_engine::preset::{Preset, write};
use std::sync::Arc;

/// Everything that undo should bring back.
#[derive(Debug, Clone, PartialEq)]
struct Told {
    preset: Preset,
    source: String,
    inward: bool,
    length: u64,
    /// P, δ, s and Φ of the walker, and whether the state solves the values.
    state: Option<([u64; 4], bool)>,
    pins: Vec<(usize, Preset)>,
}

fn told(session: &Session) -> Told {
    let model = &session.model;
    let state = model.history.current().map(|node| {
        let of = node.state;
        let bits = [of.force, of.approach, of.contact_radius, of.energy].map(f64::to_bits);
        (bits, matches!(node.kind, NodeKind::Stale(_)))
    });
    Told {
        preset: model.preset.clone(),
        source: model.source.shown(),
        inward: model.inward,
        length: model.length.to_bits(),
        state,
        pins: model.pins.presets().map(|(number, pinned)| (number, pinned.clone())).collect(),
    }
}

/// Any command that a user may give, except those that only look.
fn any_command(rng: &mut Rng) -> Command {
    let set = |key: &'static str, text: String| Command::Set { key: key.into(), text };
    match rng.u8(..30) {
        0..=5 => Command::Steps(rng.usize(1..5)),
        6..=7 => Id::NextEvent.into(),
        9..=10 => Id::Jump.into(),
        11 => Command::RunOf(rng.usize(1..8)),
        8 | 12 => Id::Reverse.into(),
        13 => [Id::Halve, Id::Double][rng.usize(..2)].into(),
        14 => Id::Restart.into(),
        15 => set("path.control", ["displacement", "force", "0.15"][rng.usize(..3)].to_owned()),
        16..=20 => [Id::More, Id::Less, Id::MuchMore, Id::MuchLess][rng.usize(..4)].into(),
        21 => Command::SelectEvent(rng.usize(1..4)),
        22 => set("material.work_of_adhesion", format!("{:?}", 0.002 + rng.f64() * 0.005)),
        23 => set("gap.amplitude", format!("{:?}", 0.001 + rng.f64() * 0.002)),
        24 => set("groups.adhesion", format!("{:?}", 0.01 + rng.f64() * 0.02)),
        25 => Command::Assign(vec![
            ("gap.wavelength".into(), "0.12".to_owned()),
            ("path.control".into(), "force".to_owned()),
        ]),
        27 => [Id::Pin, Id::Pin, Id::Rings][rng.usize(..3)].into(),
        28 => Command::Unpin(Some(rng.usize(1..3))),
        26 => Command::MoveTo(format!("{:?}", 0.2 + 0.2 * rng.f64())),
        _ => Command::OpenWith {
            name: ["wavy-sphere", "fig-3-jkr"][rng.usize(..2)].to_owned(),
            assignments: vec![("path.end_contact_radius".into(), "0.12".to_owned())],
        },
    }
}

fn small() -> Session {
    let mut session = Session::new("wavy-sphere");
    session.set("gap.wavelength", "0.1").set("path.end_contact_radius", "0.12");
    // The commands that led here are not part of the test.
    session.model.undo = pulloff::explorer::undo::Undo::default();
    session
}

/// Undoes everything and redoes it; each place must be as it was.
fn back_and_forth(session: &mut Session) -> usize {
    session.does(Command::Travel { id: Id::Redo, count: 400 });
    let end = told(session);
    let mut places = vec![end];
    while session.does(Id::Undo).model.message.is_none() || !session.status().contains("nothing to undo") {
        places.push(told(session));
        assert!(places.len() < 400, "undo does not end");
    }
    let count = places.len() - 1;
    for (at, place) in places.iter().rev().enumerate().skip(1) {
        session.does(Id::Redo);
        assert_eq!(told(session), *place, "redone {at} of {count}");
    }
    session.does(Id::Redo);
    assert!(session.status().contains("nothing to redo"), "{}", session.status());
    for (at, place) in places.iter().enumerate().skip(1) {
        session.does(Id::Undo);
        assert_eq!(told(session), *place, "undone {at} of {count}");
    }
    count
}

/// The newest place of undo, and the number of places.
fn newest(session: &Session) -> (Option<*const SessionPlace>, usize) {
    let past = session.model.undo.past();
    (past.last().map(Arc::as_ptr), past.len())
}

#[test]
fn two_hundred_commands_typed_slowly_come_back_bit_for_bit() {
    for seed in 0..2 {
        let mut rng = Rng::with_seed(seed);
        let mut session = small();
        let start = told(&session);
        // The places from which each command that changed something started.
        let mut before = Vec::new();
        for _ in 0..200 {
            let last = told(&session);
            let (newest, count) = self::newest(&session);
            session.does(match rng.u8(..6) {
                0 => Command::HeldStep(rng.usize(1..3)),
                _ => any_command(&mut rng),
            });
            // A turn that continues an earlier one is part of that command; steps of a held key become one command.
            let (now, left) = self::newest(&session);
            if left < count {
                before.truncate(before.len() + left - count);
            } else if told(&session) != last && now != newest {
                before.push(last);
            }
        }
        let mut seen = before.len();
        for place in before.iter().rev() {
            session.does(Id::Undo);
            // May first pass through the same state under another node, which nothing here distinguishes.
            while told(&session) != *place && seen < 400 {
                session.does(Id::Undo);
                seen += 1;
            }
            assert_eq!(told(&session), *place, "seed {seed}");
        }
        assert!(seen < before.len() + 20, "{seen} {}", before.len());
        assert_eq!(told(&session), start);
        assert!(back_and_forth(&mut session) >= before.len(), "seed {seed}");
    }
}

/// Keys that arrive together, all of them before any answer.
fn burst(session: &mut Session, commands: &[Command]) {
    let mut effects: Vec<Effect> = Vec::new();
    for command in commands {
        effects.extend(update(&mut session.model, command.clone()));
    }
    session.driver.settle(&mut session.model, effects);
}

#[test]
fn two_hundred_commands_in_one_burst_come_back_bit_for_bit_and_lead_where_slow_ones_do() {
    for seed in 10..12 {
        let mut rng = Rng::with_seed(seed);
        let mut commands: Vec<Command> = (0..240)
            .map(|_| match rng.u8(..6) {
                0 => Id::Undo.into(),
                1 => [Id::Redo, Id::Undo][rng.usize(..2)].into(),
                _ => any_command(&mut rng),
            })
            .collect();
        // Steps in a row are a held key, which stops at a limit point.
        let is_step = |command: &Command| command.id() == Id::Step;
        commands.dedup_by(|next, last| is_step(next) && is_step(last));
        let (mut fast, mut slow) = (small(), small());
        burst(&mut fast, &commands);
        for command in &commands {
            slow.does(command.clone());
        }
        let values = |session: &Session| {
            let Told { preset, source, inward, length, .. } = told(session);
            (write(&preset), source, inward, length)
        };
        assert_eq!(values(&fast), values(&slow), "seed {seed}");
        let radius = |session: &Session| session.radius();
        assert!((radius(&fast) / radius(&slow) - 1.0).abs() < 1e-9, "seed {seed}");
        back_and_forth(&mut fast);
    }
}

#[test]
fn each_value_is_a_command_of_its_own_and_redo_returns_each() {
    let mut session = Session::new("wavy-sphere");
    let start = told(&session);
    session.does(Id::More);
    let first = told(&session);
    session.set("gap.wavelength", "0.06");
    let second = told(&session);
    session.does(Id::Undo);
    assert_eq!(told(&session), first);
    session.does(Id::Undo);
    assert_eq!(told(&session), start);
    session.does(Id::Redo);
    assert_eq!(told(&session), first);
    session.does(Id::Redo);
    assert_eq!(told(&session), second);
    // The control goes back with its command.
    let mut session = Session::new("wavy-sphere");
    let start = told(&session);
    session.all(&[Id::More, Id::More]);
    let turned = told(&session);
    session.set("path.control", "force").does(Id::Undo);
    assert_eq!(told(&session), turned);
    // Successive turns of one value are one command.
    session.does(Id::Undo);
    assert_eq!(told(&session), start);
    session.does(Id::Redo);
    assert_eq!(told(&session), turned);
}

#[test]
fn steps_of_a_key_held_are_taken_back_together_and_end_at_a_limit_point() {
    let mut session = Session::new("wavy-sphere");
    let start = told(&session);
    session.does(Command::Steps(1));
    let first = told(&session);
    // Pressed again, and held: the second repeat says that it is held.
    for command in [Command::Steps(1), Command::Steps(1), Command::HeldStep(2), Command::HeldStep(1)] {
        session.does(command);
    }
    let end = told(&session);
    session.does(Id::Undo);
    assert_eq!(told(&session), first);
    session.does(Id::Redo);
    assert_eq!(told(&session), end);
    session.does(Id::Undo).does(Id::Undo);
    assert_eq!(told(&session), start);
    // In a burst too.
    burst(&mut session, &[Command::Steps(1), Command::HeldStep(1), Command::HeldStep(1)]);
    assert_eq!(session.model.walker().unwrap().step, 3);
    for _ in 0..40 {
        session.does(Command::HeldStep(1));
    }
    assert_eq!(session.kind(), NodeKind::Limit);
    session.does(Command::Steps(1));
    assert_eq!(session.kind(), NodeKind::Step);
    session.does(Id::Undo);
    assert_eq!(session.kind(), NodeKind::Limit);
    session.does(Id::Undo);
    assert_eq!(told(&session), start);
    // Steps are not joined across another command.
    session.does(Command::Steps(1)).does(Id::Halve).does(Command::HeldStep(2)).does(Id::Undo);
    assert!(session.model.length < 0.02 && session.model.walker().unwrap().step == 1);
}

#[test]
fn a_burst_of_walks_and_undos_is_taken_in_its_order() {
    let mut session = Session::new("wavy-sphere");
    burst(&mut session, &[Id::NextEvent, Id::Jump, Id::NextEvent, Id::Undo].map(Command::from));
    assert!(matches!(session.kind(), NodeKind::Jump(_)), "{:?}", session.kind());
    // Another line is selected before the turn is processed: the turn applies to what was selected at the key.
    let amplitude = session.model.preset.get("gap.amplitude");
    let all = [Id::NextEvent, Id::Down, Id::More, Id::Up, Id::More].map(Command::from);
    assert_eq!(session.model.panel, ScreenPanel::Problem);
    burst(&mut session, &all);
    assert_ne!(session.model.preset.get("gap.amplitude"), amplitude);
    burst(&mut session, &[Id::Undo.into()]);
    assert_eq!(session.model.preset.get("gap.amplitude"), amplitude);
    assert!(session.model.is_unsaved(), "the first of the two is still turned");
}

#[test]
fn an_opened_preset_is_one_command_and_its_walk_comes_back() {
    let mut session = Session::new("wavy-sphere");
    session.does(Id::NextEvent).does(Id::More).does(Id::Pin);
    let before = told(&session);
    session.does(Command::Open("fig-9".to_owned())).does(Command::Steps(2));
    let after = told(&session);
    session.all(&[Id::Undo, Id::Undo]);
    assert_eq!(told(&session), before);
    session.does(Id::Undo);
    assert!(session.model.pins.is_empty() && session.model.is_unsaved());
    session.does(Id::Undo);
    assert!(!session.model.is_unsaved());
    session.all(&[Id::Redo, Id::Redo, Id::Redo, Id::Redo]);
    assert_eq!(told(&session), after);
    assert_eq!(session.model.history.len(), 3);
}

#[test]
fn looking_is_not_in_the_history() {
    let mut session = Session::new("wavy-sphere");
    session.all(&[Id::ZoomIn, Id::NextView, Id::Axes, Id::NextPanel, Id::Down]);
    session.does(Id::Undo);
    assert!(session.status().contains("nothing to undo"), "{}", session.status());
    // Nor does a command that came to nothing.
    session.does(Id::Jump).does(Id::Undo);
    assert!(session.status().contains("nothing to undo"), "{}", session.status());
}

/// The session that a script leads to.
fn played(text: &str) -> Session {
    let mut session = Session::new("wavy-sphere");
    let store = Store::at(session.folder.path().join("presets"), &[]);
    let loaded = store.load(&store.resolve("wavy-sphere").unwrap(), &[] as &[&str]).unwrap();
    let (mut model, effects) = open(loaded);
    let lines = script::read("t", text).unwrap();
    let draws = |_: &Model, _| Err("nothing is drawn here".to_owned());
    play(&mut model, &session.driver, effects, &lines, Permission::default(), &draws, &mut |_, _| {})
        .unwrap();
    session.model = model;
    session
}

#[test]
fn scripts_undo_as_keys_do() {
    let one = played("set gap.amplitude=0.003\n");
    let two = played("set gap.amplitude=0.003\nset material.work_of_adhesion=0.0052\nundo\n");
    assert_eq!(told(&one), told(&two));
    let control = played("control force\nundo\n");
    assert_eq!(control.model.preset, control.model.saved);
    assert_eq!(told(&played("step 5\nundo\n")), told(&played("")));
    assert_eq!(told(&played("set gap.amplitude=0.003\nstep 3\ncontrol force\nundo 3\n")), told(&played("")));
}

#[test]
fn an_exported_script_of_undos_walks_the_same_again() {
    let mut session = Session::new("wavy-sphere");
    session.all(&[Id::Step, Id::Step, Id::NextEvent, Id::Jump, Id::Undo, Id::Undo, Id::More, Id::More]);
    session
        .all(&[Id::Undo, Id::Step, Id::Undo, Id::Undo, Id::Redo, Id::Redo])
        .set("path.control", "force")
        .does(Id::Step);
    let path = session.folder.path().join("s.pulloff");
    let path = path.to_string_lossy().into_owned();
    session.does(Command::Export { what: Export::Script, path: path.clone(), replace: false });
    let text = std::fs::read_to_string(path).unwrap();
    assert!(text.starts_with("# A session of pulloff: "), "{text}");
    let again = played(&text);
    assert_eq!(told(&again), told(&session), "{text}");
}
