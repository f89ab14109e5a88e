//! Sessions: what is read back is what was, bit for bit, and a walk goes on as if nothing had happened.

#[path = "support/session.rs"]
mod session;

use pulloff::explorer::session::{Document, Ended, Snapshot, Unreadable, summary};
use pulloff::explorer::{Command, Id, Inline, Model, Node, Overlay, View, answer, update};
use pulloff::preset::{Store, write};
use session::Session;

fn document(model: &Model) -> Vec<u8> {
    Document::new(&Snapshot::of(model), Ended::Running, 7).json().expect("a document")
}

fn read(bytes: &[u8]) -> Result<Snapshot, Unreadable> {
    Document::read(bytes)?.snapshot()
}

/// The session written, read and begun anew, as after a dropped connection.
fn resume(session: &mut Session) {
    let snapshot = read(&document(&session.model)).expect("a session");
    let (model, effects) = snapshot.resume(None);
    session.model = model;
    session.driver.settle(&mut session.model, effects);
}

/// Everything a node knows, every number with all its digits.
fn told(node: &Node) -> String {
    let Node { parent, kind, setting, control, point, state, step, stiffness, ahead, admissibility, .. } =
        node;
    let (preset, scales) = (write(&setting.preset), setting.scales);
    let rest = (node.digits, node.from_exact, node.begins, node.stability());
    format!(
        "{parent:?} {kind:?} {control:?} {point:?} {state:?} {step} {stiffness:?} {ahead:?} {admissibility:?} {rest:?} \
         {scales:?} {preset}"
    )
}

fn assert_same(ours: &Model, theirs: &Model) {
    assert_eq!(ours.history.len(), theirs.history.len());
    for (number, (ours, theirs)) in ours.history.nodes().zip(theirs.history.nodes()).enumerate() {
        assert_eq!(told(ours), told(theirs), "node {number}");
    }
    let forward = |model: &Model| -> Vec<_> {
        (0..model.history.len()).map(|number| model.history.forward(number)).collect()
    };
    assert_eq!((ours.history.cursor(), forward(ours)), (theirs.history.cursor(), forward(theirs)));
    let (ours, theirs) = (Snapshot::of(ours), Snapshot::of(theirs));
    assert_eq!((&ours.preset, &ours.saved, &ours.source), (&theirs.preset, &theirs.saved, &theirs.source));
    assert_eq!((&ours.look, &ours.pins), (&theirs.look, &theirs.pins));
}

/// Steps, jumps, undo, branches, knobs, controls, pins and views.
fn story() -> Vec<Command> {
    let set = |key: &'static str, text: &str| Command::Set { key: key.into(), text: text.to_owned() };
    let mut story = vec![Command::Steps(3)];
    story.extend(
        [Id::Halve, Id::Step, Id::NextLimit, Id::Jump, Id::Undo, Id::Undo, Id::Reverse].map(Into::into),
    );
    story.extend([Command::Steps(2), Id::Pin.into(), Id::NextView.into()]);
    story.push(Command::Zoom { closer: true, about: (0.3, 0.6) });
    story.extend([set("gap.amplitude", "0.002"), Command::Steps(2), Id::Control.into()]);
    story.extend([Id::NextLimit, Id::Jump, Id::More, Id::More, Id::Step, Id::Undo, Id::Undo].map(Into::into));
    story.extend([Id::Step, Id::Redo, Id::Undo, Id::Undo, Id::Undo, Id::Redo].map(Into::into));
    story.extend([Command::Overlay(Overlay::Exact), Id::Axes.into(), Id::Restart.into(), Id::Double.into()]);
    story.extend([Command::Steps(2), Id::NextPanel.into(), Id::Device.into()]);
    story
}

fn told_without_a_break_and_with_many(preset: &str, changes: &[(&'static str, &str)]) {
    let (mut whole, mut broken) = (Session::new(preset), Session::new(preset));
    for (key, text) in changes {
        whole.set(key, text);
        broken.set(key, text);
    }
    for command in story() {
        whole.does(command.clone());
        resume(&mut broken);
        broken.does(command);
    }
    resume(&mut broken);
    assert!(whole.model.history.len() > 20, "{}", whole.model.history.len());
    assert_same(&whole.model, &broken.model);
    assert_eq!(whole.model.pins.all().len(), broken.model.pins.all().len());
}

#[test]
fn a_walk_in_rings_goes_on_as_if_it_had_never_been_interrupted() {
    told_without_a_break_and_with_many("wavy-sphere", &[("basis.rings", "60")]);
}

#[test]
fn a_walk_in_eigenfunctions_goes_on_as_if_it_had_never_been_interrupted() {
    told_without_a_break_and_with_many(
        "fig-9",
        &[("basis.kind", "spectral"), ("path.start_contact_radius", "0.4")],
    );
}

#[test]
fn presets_of_every_kind_come_back() {
    let folder = tempfile::tempdir().unwrap();
    for shipped in pulloff::preset::SHIPPED {
        let mut session = Session::new(shipped.name);
        session.does(Command::Steps(2));
        let before = document(&session.model);
        let back = read(&before).unwrap();
        assert_eq!(back.preset, session.model.preset, "{}", shipped.name);
        let (mut model, effects) = back.resume(None);
        Inline::new(Store::at(folder.path(), &[])).settle(&mut model, effects);
        assert_same(&session.model, &model);
        assert_eq!(String::from_utf8(before), String::from_utf8(document(&model)), "{}", shipped.name);
    }
}

#[test]
fn the_rows_of_a_profile_are_those_of_the_session_whatever_became_of_the_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("rough.csv");
    let rows: String =
        (0..200).map(|i| f64::from(i) / 100.0).map(|r| format!("{r} {}\n", r * r / 2.0)).collect();
    std::fs::write(&path, format!("# r[um] h[um]\n{rows}")).unwrap();
    let mut session = Session::new("wavy-sphere");
    session.set("gap.shape", "profile").set("gap.file", path.to_str().unwrap()).does(Command::Steps(2));
    let bytes = document(&session.model);
    std::fs::remove_file(&path).unwrap();
    let back = read(&bytes).unwrap();
    assert_eq!(back.preset, session.model.preset);
    let (mut model, effects) = back.resume(None);
    session.driver.settle(&mut model, effects);
    assert_same(&session.model, &model);
}

#[test]
fn a_value_that_was_being_typed_is_not_kept_but_an_unsolved_one_is() {
    let mut session = Session::new("wavy-sphere");
    let before = session.model.preset.clone();
    session.does(Command::Try { key: "gap.amplitude".into(), text: "0.001".to_owned() });
    assert_ne!(session.model.preset, before);
    assert_eq!(Snapshot::of(&session.model).preset, before);
    // Saved between a change and its curve: the curve is computed and the state solved after all.
    let (mut session, mut cut) = (Session::new("wavy-sphere"), Session::new("wavy-sphere"));
    let command = Command::Set { key: "gap.amplitude".into(), text: "0.002".to_owned() };
    session.does(command.clone());
    drop(update(&mut cut.model, command));
    resume(&mut cut);
    assert_same(&session.model, &cut.model);
}

#[test]
fn a_resumed_session_does_not_take_the_replies_to_the_one_before() {
    let mut session = Session::new("wavy-sphere");
    session.does(Command::Steps(2));
    let snapshot = Snapshot::of(&session.model);
    let late = update(&mut session.model, Id::Step.into());
    let (mut model, effects) = snapshot.resume(Some(&session.model));
    for effect in late {
        let reply = session.driver.run(effect).unwrap();
        assert!(answer(&mut model, reply).is_empty());
    }
    assert_eq!((model.history.len(), model.curve.is_none()), (3, true));
    session.driver.settle(&mut model, effects);
    assert!(model.walker().is_some_and(|node| node.step == 2));
}

#[test]
fn what_is_no_session_is_refused_in_words() {
    let mut session = Session::new("wavy-sphere");
    session.does(Command::Steps(2)).does(Id::NextView);
    assert_ne!(session.model.view, View::ForceApproach);
    let bytes = document(&session.model);
    let text = String::from_utf8(bytes.clone()).unwrap();
    let told = |text: &str| read(text.as_bytes()).unwrap_err().to_string();
    let future = text.replacen("\"format\":1", "\"format\":2", 1).replacen("0.1.0", "9.9.9", 1);
    assert!(
        told(&future).contains("format 2, of a later pulloff (it was written by 9.9.9)"),
        "{}",
        told(&future)
    );
    assert!(matches!(summary(future.as_bytes()), Err(Unreadable::Future { format: 2, .. })));
    // Nothing but the format of a later one is looked at.
    assert!(matches!(read(br#"{"format":3,"program_version":"3"}"#), Err(Unreadable::Future { .. })));
    for cut in (0..bytes.len() - 2).step_by(97) {
        assert!(matches!(read(&bytes[..cut]), Err(Unreadable::Damaged(_))), "cut at {cut}");
    }
    for (from, to) in [
        ("\"cursor\":2", "\"cursor\":3"),
        ("\"parent\":1", "\"parent\":2"),
        ("\"forward\":1", "\"forward\":2"),
        ("\"setting\":0", "\"setting\":9"),
        ("\"saved\":0", "\"saved\":9"),
        ("gap.shape", "gap.shaped"),
        ("rings = 200", "rings = 1"),
        ("\"kind\":\"step\"", "\"kind\":\"stop\""),
    ] {
        let torn = text.replacen(from, to, 1);
        if torn != text {
            assert!(told(&torn).starts_with("the session is damaged: "), "{from}: {}", told(&torn));
        }
    }
}

#[test]
fn a_summary_says_what_the_session_is() {
    let mut session = Session::new("wavy-sphere");
    assert!(!Snapshot::of(&session.model).is_worth_keeping());
    session.does(Id::NextView);
    assert!(!Snapshot::of(&session.model).is_worth_keeping());
    session.does(Command::Steps(4)).set("gap.amplitude", "0.0024");
    assert!(Snapshot::of(&session.model).is_worth_keeping());
    let summary = summary(&document(&session.model)).unwrap();
    assert_eq!((&*summary.preset_name, summary.steps, summary.unsaved), ("wavy-sphere", 5, true));
    assert_eq!((summary.saved_at, summary.ended), (7, Ended::Running));
}
