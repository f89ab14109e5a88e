//! Sessions: what is read back equals what was saved, bit for bit, and a walk continues as if nothing had happened.

use crate::support::home::Home;
use crate::support::pty::Pty;
use crate::support::session::Session;
use pulloff::explorer::archive::Archive;
use pulloff::explorer::branches::branches;
use pulloff::explorer::session::{Document, Ended, FORMAT, Snapshot, Unreadable, summary};
use pulloff::explorer::{Command, History, Id, Inline, Model, Node, NodeKind, Overlay, View, answer, update};
use pulloff::figure::Role;
use pulloff::figure::Subject;
use pulloff::store::Store;
use pulloff_engine::preset::write;
use pulloff_engine::sweep::QuantityColumn;
use rustix::process::Signal;
use std::path::Path;

fn document(model: &Model) -> Vec<u8> {
    Document::new(&Snapshot::of(model), Ended::Running, 7).json().expect("a document")
}

fn read(bytes: &[u8]) -> Result<Snapshot, Unreadable> {
    Document::read(bytes)?.snapshot()
}

/// Everything a node knows, every number with all its digits.
fn told(node: &Node) -> String {
    let Node { parent, kind, setting, control, point, state, step, stiffness, ahead, admissibility, .. } =
        node;
    let (preset, scales) = (write(&setting.preset), setting.scales);
    let rest = (node.digits, node.from_exact, node.begins, node.stability);
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
    assert_eq!(ours.history.cursor(), theirs.history.cursor());
    let (ours, theirs) = (Snapshot::of(ours), Snapshot::of(theirs));
    assert_eq!((&ours.preset, &ours.saved, &ours.source), (&theirs.preset, &theirs.saved, &theirs.source));
    assert_eq!((&ours.look, &ours.pins), (&theirs.look, &theirs.pins));
}

/// Steps, jumps, undo, branches, knobs, controls, pins and views.
fn story() -> Vec<Command> {
    let set = |key: &'static str, text: &str| Command::Set { key: key.into(), text: text.to_owned() };
    let (column, over) =
        (QuantityColumn::named("peak_force").expect("a quantity"), "gap.amplitude=0.001..0.003");
    let study = Command::Study { column, over: Some(over.to_owned()) };
    let mut story = vec![study, Command::Show(View::ForceApproach), Command::Steps(3)];
    story.extend(
        [Id::Halve, Id::Step, Id::NextEvent, Id::Jump, Id::Undo, Id::Undo, Id::Reverse].map(Into::into),
    );
    story.extend([Command::Steps(2), Id::Pin.into(), Id::NextView.into()]);
    story.push(Command::Zoom { view: View::ForceApproach, closer: true, about: (0.3, 0.6) });
    story.extend([set("gap.amplitude", "0.002"), Command::Steps(2), set("path.control", "force")]);
    story.extend([Id::NextEvent, Id::Jump, Id::More, Id::More, Id::Step, Id::Undo, Id::Undo].map(Into::into));
    story.extend([Id::Step, Id::Redo, Id::Undo, Id::Undo, Id::Undo, Id::Redo].map(Into::into));
    story.extend([Command::Overlay(Overlay::Exact), Id::Axes.into(), Id::Restart.into(), Id::Double.into()]);
    story.extend([
        Command::Steps(2),
        Id::NextPanel.into(),
        Command::Overlay(pulloff::explorer::Overlay::Device),
    ]);
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
        broken.resume();
        broken.does(command);
    }
    broken.resume();
    assert!(whole.model.history.len() > 20, "{}", whole.model.history.len());
    assert_same(&whole.model, &broken.model);
    assert_eq!(whole.model.pins.all().len(), broken.model.pins.all().len());
}

#[test]
fn a_walk_in_rings_goes_on_as_if_it_had_never_been_interrupted() {
    told_without_a_break_and_with_many("wavy-sphere", &[("basis.rings", "60")]);
}

#[test]
fn a_walk_in_the_exact_basis_goes_on_as_if_it_had_never_been_interrupted() {
    told_without_a_break_and_with_many(
        "fig-9",
        &[("basis.kind", "exact"), ("path.start_contact_radius", "0.4")],
    );
}

#[test]
fn presets_of_every_kind_come_back() {
    let folder = tempfile::tempdir().unwrap();
    for shipped in pulloff::store::SHIPPED {
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
    let radii = (0..200).map(|i| f64::from(i) / 100.0);
    let rows: Vec<String> = radii.map(|r| format!("{r} {}", r * r / 2.0)).collect();
    std::fs::write(&path, format!("# r h\n{}\n", rows.join("\n"))).unwrap();
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
    // Saved between a change and its curve: the curve is still computed and the state solved.
    let (mut session, mut cut) = (Session::new("wavy-sphere"), Session::new("wavy-sphere"));
    let command = Command::Set { key: "gap.amplitude".into(), text: "0.002".to_owned() };
    session.does(command.clone());
    drop(update(&mut cut.model, command));
    cut.resume();
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
    let ours = format!("\"format\":{FORMAT}");
    let future = text.replacen(&ours, "\"format\":99", 1).replacen("0.1.0", "9.9.9", 1);
    let refused = format!("format 99 (it was written by pulloff 9.9.9); this one reads format {FORMAT}");
    assert!(told(&future).contains(&refused), "{}", told(&future));
    assert!(matches!(summary(future.as_bytes()), Err(Unreadable::Format { format: 99, .. })));
    // Of another format, only the format number is read.
    assert!(matches!(read(br#"{"format":4,"program_version":"3"}"#), Err(Unreadable::Format { .. })));
    for cut in (0..bytes.len() - 2).step_by(97) {
        assert!(matches!(read(&bytes[..cut]), Err(Unreadable::Damaged(_))), "cut at {cut}");
    }
    for (from, to) in [
        ("\"cursor\":2", "\"cursor\":3"),
        ("\"parent\":1", "\"parent\":2"),
        ("\"setting\":0", "\"setting\":9"),
        ("\"saved\":0", "\"saved\":9"),
        ("\"origin\":1", "\"origin\":9"),
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

#[test]
fn branches_stay_and_can_be_gone_to() {
    let mut session = Session::new("wavy-sphere");
    session.all(&[Id::Step, Id::Step, Id::Step]);
    assert_eq!(branches(&session.model.history).len(), 1);
    session.does(Id::Branches);
    assert!(session.status().contains("the walk has one branch"), "{}", session.status());
    let first = session.model.history.cursor().unwrap();
    session.does(Id::Undo).set("gap.amplitude", "0.002").does(Command::Steps(2));
    // A knob turned on the way is not a branch.
    session.does(Id::More).does(Id::More).does(Id::More);
    let found = branches(&session.model.history);
    assert_eq!(found.len(), 2, "{found:?}");
    assert!(found[0].is_here && found[1].end == first && !found[1].is_here);
    let starts: Vec<usize> = found[1].nodes.iter().map(|node| node.step).collect();
    assert_eq!(starts, [2, 3], "from where it parts to its end");
    let state = session.model.history.node(first).unwrap().state;
    let numbering = session.model.history.numbering();
    session.does(Command::GoTo { node: first, numbering });
    assert_eq!(session.model.walker().unwrap().state, state);
    assert_eq!(session.model.preset.get("gap.amplitude").unwrap().to_string(), "0.0025");
    // Redo leads back to it from the start.
    session.does(Command::Travel { id: Id::Undo, count: 99 });
    session.does(Command::Travel { id: Id::Redo, count: 99 });
    assert_eq!(session.model.history.cursor(), Some(first));
    let before = session.model.history.cursor();
    session.does(Command::GoTo { node: 1, numbering: numbering + 1 });
    assert!(session.status().contains("ask for its branches again"));
    assert_eq!(session.model.history.cursor(), before);
}

#[test]
fn the_other_branches_are_drawn_where_the_curve_is() {
    let mut session = Session::new("wavy-sphere");
    session.all(&[Id::Step, Id::Step, Id::Step, Id::Undo, Id::Undo]);
    let branch = |view| {
        let subject = Subject::of(&session.model).unwrap();
        let scale = subject.scale();
        let lines: Vec<_> =
            subject.figure(view).lines.into_iter().filter(|line| line.role == Role::Branch).collect();
        (lines, scale)
    };
    for view in [View::ForceApproach, View::ForceRadius] {
        let (lines, scale) = branch(view);
        // From the state in which it branches off through those after it.
        let states = (1..=3).map(|number| {
            let node = session.model.history.node(number).unwrap();
            let state = node.state.in_units(node.setting.units());
            scale.place(view, [state.approach, state.force, state.contact_radius])
        });
        assert_eq!(lines.iter().map(|line| &line.points).collect::<Vec<_>>(), [&states.collect::<Vec<_>>()]);
    }
    assert!(branch(View::Unloading).0.is_empty());
    // States of another problem would lie beside the curve without a name.
    session.set("gap.amplitude", "0.002");
    session.does(Command::Steps(2));
    let subject = Subject::of(&session.model).unwrap();
    assert!(subject.figure(View::ForceApproach).lines.iter().all(|line| line.role != Role::Branch));
}

/// Goes to the state before; false if there is none.
fn go_back(history: &mut History) -> bool {
    history.parent().is_some_and(|before| history.go(before))
}

#[test]
fn a_held_knob_stays_bounded_too() {
    let mut session = Session::new("fig-3-jkr");
    session.does(Id::Step).set("material.work_of_adhesion", "0.02");
    let node = session.model.history.current().unwrap().clone();
    assert_eq!(node.kind, NodeKind::Solved);
    let history = &mut session.model.history;
    for _ in 0..30_000 {
        history.push_beside(node.clone());
        history.shorten(&[]);
        assert!(history.len() <= 5001);
    }
    assert_eq!(history.cursor(), Some(history.len() - 1));
    assert!(go_back(history) && history.current().unwrap().kind == NodeKind::Step);
}

#[test]
fn a_million_steps_stay_bounded_and_a_tree() {
    let mut session = Session::new("wavy-sphere");
    session.does(Id::Step).does(Id::NextEvent).does(Id::Jump);
    let nodes: Vec<Node> = session.model.history.nodes().cloned().collect();
    let of =
        |wanted: &dyn Fn(&NodeKind) -> bool| nodes.iter().find(|node| wanted(&node.kind)).unwrap().clone();
    let step = of(&|kind| *kind == NodeKind::Step);
    let jump = of(&|kind| matches!(kind, NodeKind::Jump(_)));
    let start = of(&|kind| *kind == NodeKind::Start);
    let mut history = History::default();
    history.push(start);
    let (mut most, mut jumps, mut ends) = (0, 0, 0);
    for at in 1..1_000_000_usize {
        let node = if at % 5000 == 0 { &jump } else { &step };
        jumps += usize::from(at % 5000 == 0);
        history.push(Node { step: at, ..node.clone() });
        history.shorten(&[]);
        if at % 9000 == 0 {
            // A branch: this state is its end.
            assert!(go_back(&mut history) && go_back(&mut history));
            ends += 1;
        }
        most = most.max(history.len());
    }
    assert!(most <= 5_001, "{most}");
    assert!(history.numbering() > 100);
    let mut children = vec![0; history.len()];
    for (at, node) in history.nodes().enumerate() {
        assert_eq!(node.parent.is_none(), at == 0);
        if let Some(parent) = node.parent {
            children[parent] += 1;
            assert!(parent < at && history.node(parent).unwrap().step < node.step);
        }
    }
    let jumped: Vec<&Node> = history.nodes().filter(|node| matches!(node.kind, NodeKind::Jump(_))).collect();
    assert_eq!(jumped.len(), jumps);
    assert!(jumped.iter().all(|node| node.step % 5000 == 0));
    assert!(children.iter().filter(|count| **count == 0).count() > ends, "an end is lost");
    // All of the newest are there, and the way back from them leads to the start.
    assert_eq!(history.current().unwrap().step, 999_999);
    for _ in 0..1900 {
        let after = history.current().unwrap().step;
        assert!(go_back(&mut history));
        // Three steps where a branch splits off.
        let before = history.current().unwrap().step;
        assert!(before + 1 == after || (before + 3 == after && (after - 1) % 9000 == 0), "{before} {after}");
    }
    while go_back(&mut history) {}
    assert_eq!((history.cursor(), history.current().unwrap().kind.clone()), (Some(0), NodeKind::Start));
    // What is left is a session like any other.
    session.model.history = history;
    let back = read(&document(&session.model)).unwrap();
    assert_eq!(back.history.len(), session.model.history.len());
}

/// A home with its sessions.
struct Sessions(Home);

impl Sessions {
    fn new() -> Self {
        Self(Home::new())
    }

    fn archive(&self) -> Archive {
        Archive::at(self.0.path(".local/state/pulloff/sessions"))
    }

    /// Exit status, output and errors.
    fn run(&self, arguments: &[&str]) -> (i32, String, String) {
        let ended = self.0.run(arguments);
        (ended.status, ended.out, ended.err)
    }

    fn explore(&self, arguments: &[&str]) -> Pty {
        let program = Path::new(env!("CARGO_BIN_EXE_pulloff"));
        Pty::spawn(program, arguments, &[("HOME", self.0.folder().to_str().expect("a home"))], 100, 30)
    }
}

#[test]
fn sessions_are_listed_shown_and_deleted() {
    let home = Sessions::new();
    assert_eq!(home.run(&["sessions", "list"]), (0, String::new(), String::new()));
    assert!(!home.0.path(".local").exists(), "a list writes nothing");
    let mut session = Session::new("wavy-sphere");
    session.does(Command::Steps(4)).set("gap.amplitude", "0.0024");
    for ended in [Ended::Quit, Ended::Running] {
        let document = Document::new(&Snapshot::of(&session.model), ended, 7).json().unwrap();
        home.archive().begin("wavy-sphere").unwrap().write(&document).unwrap();
    }
    let (status, list, _) = home.run(&["sessions", "list"]);
    let lines: Vec<Vec<&str>> = list.lines().map(|line| line.split("  ").collect()).collect();
    assert_eq!((status, lines.len()), (0, 2), "{list}");
    assert!(list.lines().next().unwrap().starts_with("wavy-sphere-2  less than a minute ago"), "{list}");
    // The session that is marked as running has no program.
    assert!(lines[0].contains(&"dropped") && list.lines().nth(1).unwrap().contains("quit"), "{list}");
    assert!(list.contains("wavy-sphere, 5 steps, preset not saved"), "{list}");

    let (_, shown, _) = home.run(&["sessions", "show", "wavy-sphere-1"]);
    for text in ["preset      wavy-sphere", "ended       quit", "steps       5", "walker      delta 0."] {
        assert!(shown.contains(text), "no {text} in {shown}");
    }
    let (_, newest, _) = home.run(&["sessions", "show"]);
    assert!(newest.starts_with("session     wavy-sphere-"), "{newest}");
    let (_, json, _) = home.run(&["sessions", "show", "wavy-sphere-1", "--format=json"]);
    let back = read(json.as_bytes()).unwrap();
    assert_eq!(back.preset, session.model.preset);

    let (status, _, said) = home.run(&["sessions", "delete", "wavy-sphere-1"]);
    assert_eq!((status, &*said), (2, "pulloff: nobody can answer here: --yes deletes without asking\n"));
    let held = home.archive().load("wavy-sphere-1").unwrap();
    let (status, _, said) = home.run(&["sessions", "delete", "wavy-sphere-1", "--yes"]);
    assert!(status == 2 && said.contains("is running in another pulloff"), "{said}");
    let other = home.archive().load("wavy-sphere-2").unwrap();
    let (status, _, said) = home.run(&["--resume"]);
    assert!(status == 2 && said.contains(" is running in another pulloff"), "{said}");
    drop((held, other));
    assert_eq!(home.run(&["sessions", "delete", "wavy-sphere-1", "--yes"]).0, 0);
    let (status, _, said) = home.run(&["sessions", "show", "wavy-sphere-1"]);
    assert!(status == 2 && said.contains("did you mean wavy-sphere-2?"), "{said}");
    // A fault in the name is reported before a fault of the terminal.
    let (status, _, said) = home.run(&["--resume", "nothing"]);
    assert!(status == 2 && said.contains("no session is called \"nothing\""), "{said}");
    assert_eq!(home.run(&["fig-9", "--resume"]).0, 2);
    assert_eq!(home.run(&["sessions", "delete", "wavy-sphere-2", "--yes"]).0, 0);
    let (status, _, said) = home.run(&["--resume"]);
    assert_eq!((status, &*said), (2, "pulloff: there is no session to resume\n"));
}

/// The lines of the screen that show where the walker is.
fn walker(pty: &Pty) -> Vec<String> {
    let screen = pty.screen();
    screen.lines().filter(|line| line.starts_with("│ @ ")).map(str::to_owned).collect()
}

const UP: &str = "stable under displacement control";

#[test]
fn a_session_that_was_cut_off_is_offered_and_goes_on_with_the_same_numbers() {
    for signal in [None, Some(Signal::HUP), Some(Signal::TERM), Some(Signal::KILL)] {
        let home = Sessions::new();
        let mut pty = home.explore(&[]);
        pty.wait_for(|screen| screen.contains(UP) && !screen.contains("cut off"), "the curve, and no offer");
        pty.keys("    n");
        pty.wait_for(|screen| screen.contains("Event 1 of 6"), "the limit point");
        let before = walker(&pty);
        assert_eq!(before.len(), 1, "{before:?}");
        match signal {
            None => pty.close_terminal(),
            Some(Signal::KILL) => {
                // Nobody can save any more; what the last write had is there.
                pty.wait_until(|_| home.archive().summary("wavy-sphere-1").is_ok(), "a write");
                let walked = |pty: &Pty| pty.screen().contains("Event 1 of 6");
                pty.wait_until(
                    |pty| {
                        walked(pty)
                            && home.archive().summary("wavy-sphere-1").is_ok_and(|told| told.steps > 5)
                    },
                    "a write of the limit point",
                );
                pty.signal(Signal::KILL);
            }
            Some(signal) => pty.signal(signal),
        }
        pty.exit_code();

        let mut pty = home.explore(&[]);
        pty.wait_for(|screen| screen.contains("A session was cut off less than a minute ago"), "the offer");
        assert!(pty.screen().contains("(wavy-sphere, "), "{}", pty.screen());
        pty.keys("\r");
        pty.wait_for(|screen| screen.contains("Event 1 of 6"), "the limit point again");
        pty.wait_until(|pty| walker(pty) == before, "the same numbers");
        // It continues where it was, with everything before.
        pty.keys("x");
        pty.wait_for(|screen| screen.contains("Landed, lost 1.217e-4, stable again"), "the landing");
        pty.keys("uu");
        pty.wait_for(
            |screen| screen.contains("Stable under displacement"),
            "the state before the limit point",
        );
        pty.keys("q");
        assert_eq!(pty.exit_code(), 0);
        pty.assert_restored();
        assert_eq!(home.archive().summary("wavy-sphere-1").unwrap().ended, Ended::Quit);
        assert_eq!(home.archive().list().unwrap().len(), 1, "the same session, not another");

        // Left properly: not offered, but available by name.
        let mut pty = home.explore(&[]);
        pty.wait_for(|screen| screen.contains(UP), "the curve");
        assert!(!pty.screen().contains("cut off"), "{}", pty.screen());
        pty.keys("q");
        pty.exit_code();
        let mut pty = home.explore(&["--resume", "wavy-sphere-1"]);
        pty.wait_for(|screen| screen.contains("resumed wavy-sphere-1"), "the session");
        pty.keys("q");
        assert_eq!(pty.exit_code(), 0);
    }
}

#[test]
fn an_offer_waits_for_its_answer() {
    let home = Sessions::new();
    let mut pty = home.explore(&[]);
    pty.wait_for(|screen| screen.contains(UP), "the curve");
    pty.keys("    ");
    pty.wait_for(|screen| screen.contains("@ 4 "), "four steps");
    pty.signal(Signal::TERM);
    assert_eq!(pty.exit_code(), 143);
    // A requested preset is shown; the session is only mentioned.
    let mut pty = home.explore(&["wavy-sphere"]);
    pty.wait_for(|screen| screen.contains("--resume wavy-sphere-1 goes on"), "the hint");
    assert!(!pty.screen().contains("Go on?"), "{}", pty.screen());
    pty.keys("q");
    pty.exit_code();
    let mut pty = home.explore(&[]);
    pty.wait_for(|screen| screen.contains("Go on?") && screen.contains(UP), "the offer");
    pty.keys("  \x1b");
    pty.wait_for(|screen| !screen.contains("Go on?"), "the answer");
    pty.keys("  ");
    pty.wait_for(|screen| screen.contains("@ 2 "), "the two steps after the answer");
    pty.keys("q");
    assert_eq!(pty.exit_code(), 0);
    let names: Vec<String> = home.archive().list().unwrap().into_iter().map(|entry| entry.name).collect();
    assert_eq!(names, ["wavy-sphere-2", "wavy-sphere-1"]);
    // Two programs write a session each.
    let mut first = home.explore(&["--resume", "wavy-sphere-1"]);
    first.wait_for(|screen| screen.contains("@ 4 "), "the session");
    let (status, _, said) = home.run(&["--resume", "wavy-sphere-1"]);
    assert!(status == 2 && said.contains("is running in another pulloff"), "{said}");
    first.keys("q");
    first.exit_code();
}

#[test]
fn a_program_that_changed_nothing_writes_nothing() {
    let home = Sessions::new();
    let mut pty = home.explore(&[]);
    pty.wait_for(|screen| screen.contains(UP), "the curve");
    pty.keys("t\t\t");
    pty.wait_for(|screen| screen.contains("s/λ over δ/R  (t:"), "another view");
    pty.signal(Signal::HUP);
    pty.exit_code();
    assert!(!home.0.path(".local").exists());
}
