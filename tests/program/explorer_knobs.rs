//! The explorer without a terminal: groups as knobs, whole commands undone, commands that wait for a curve,
//! messages about long work, and messages in units.

use crate::support::session::Session;
use pulloff::explorer::model::Level;
use pulloff::explorer::script::parse;
use pulloff::explorer::{Command, CurveStage, Effect, Id, NodeKind, Reply, ScreenPanel, answer, update};
use pulloff_engine::preset::Value;
use pulloff_engine::problem::Control;

fn number(session: &Session, key: &str) -> f64 {
    let value = session.model.preset.get(key);
    value.and_then(|value| if let Value::Number(x) = value { Some(x) } else { None }).expect("a number")
}

/// Selects a knob other than the first one, as the arrows do.
fn select(session: &mut Session, key: &str) {
    session.model.panel = ScreenPanel::Problem;
    let at = session.model.knobs().iter().position(|(row, _)| row.key == key).expect("a knob");
    session.model.parameter = at - 1;
    session.does(Id::Down);
}

#[test]
fn a_group_is_turned_typed_and_taken_back_like_a_parameter() {
    let near = |a: f64, b: f64| (a / b - 1.0).abs() < 1e-12;
    let mut session = Session::new("wavy-sphere");
    let before = session.model.preset.clone();
    select(&mut session, "groups.amplitude_over_wavelength");
    assert_eq!(session.status(), "turning it changes A, λ held");
    session.does(Id::MuchMore);
    assert_eq!(session.status(), "changed: A 0.003; λ held");
    assert!(near(number(&session, "gap.amplitude"), 0.003));
    assert!(near(number(&session, "gap.wavelength"), 0.05));
    assert_eq!(session.model.curve.clone().unwrap().setting.preset, session.model.preset);
    session.does(Id::Undo);
    assert_eq!(session.model.preset, before);

    select(&mut session, "groups.wavelength_over_radius");
    session.set("groups.wavelength_over_radius", "1/25");
    assert_eq!(session.status(), "changed: A 0.002, λ 0.04; R and A/λ held");
    assert!(near(number(&session, "groups.amplitude_over_wavelength"), 0.05));
    session.does(Id::Undo);
    assert_eq!(session.model.preset, before);

    select(&mut session, "groups.adhesion");
    session.does(Id::More);
    assert!(near(number(&session, "groups.adhesion"), 0.026));
    session.set("groups.adhesion", "1 mN");
    assert_eq!(session.model.status().0, Level::Error);
    assert!(near(number(&session, "groups.adhesion"), 0.026));
    // A gap without groups has no such knobs.
    let cone = Session::new("cone");
    assert!(cone.model.knobs().iter().all(|(row, _)| !row.key.starts_with("groups.")));
}

#[test]
fn in_si_what_a_group_changed_and_a_pin_have_units() {
    let mut session = Session::new("fig-9-si");
    session.does(Id::Pin);
    select(&mut session, "groups.amplitude_over_wavelength");
    session.does(Id::MuchMore);
    assert_eq!(session.status(), "changed: A 15 µm; λ held");
    assert_eq!(session.model.pins.all()[0].name(&session.model.preset), "A 12.5 µm");
    // Beyond the pull-off force of 28 mN.
    session.set("path.start_force", "-40 mN");
    let (level, text) = session.model.status();
    assert_eq!(level, Level::Error);
    assert!(text.contains("no contact has the force -40000 uN; the smallest"), "{text}");
    assert_eq!(text.matches(" uN").count(), 2, "{text}");
}

#[test]
fn a_whole_command_is_undone_at_once() {
    let mut session = Session::new("wavy-sphere");
    let cursor = |session: &Session| session.model.history.cursor().unwrap();
    session.does(Command::Steps(7));
    assert_eq!(session.model.history.current().unwrap().step, 7);
    session.does(Id::Undo);
    assert_eq!((cursor(&session), session.kind()), (0, NodeKind::Start));
    session.does(Id::Undo);
    assert!(session.status().contains("nothing to undo"));
    // Each one a separate command.
    session.does(Id::NextEvent);
    let limit = cursor(&session);
    session.does(Id::Jump).does(Command::Steps(3)).does(Id::Undo);
    assert!(matches!(session.kind(), NodeKind::Jump(_)));
    session.does(Id::Undo);
    assert_eq!(cursor(&session), limit);
    session.does(Id::Undo);
    assert_eq!(cursor(&session), 0);
    // Nothing is erased: redo goes forward again, state by state.
    session.all(&[Id::Redo, Id::Redo, Id::Redo]);
    assert_eq!(session.model.history.current().unwrap().kind, NodeKind::Step);
    session.does(Command::Travel { id: Id::Undo, count: 2 });
    assert_eq!(cursor(&session), limit);
    // Values typed since then are taken back first.
    let before = session.model.preset.clone();
    let set = Command::Set { key: "gap.amplitude".into(), text: "0.003".to_owned() };
    drop(update(&mut session.model, set));
    let effects = update(&mut session.model, Id::Undo.into());
    session.driver.settle(&mut session.model, effects);
    assert_eq!(session.model.preset, before);
}

#[test]
fn how_far_a_curve_is_belongs_to_the_newest_one() {
    let mut session = Session::new("wavy-sphere");
    let set = Command::Set { key: "gap.amplitude".into(), text: "0.003".to_owned() };
    let effects = update(&mut session.model, set);
    let id = session.model.curve_wanted;
    let far = |id| Reply::Stage { id, stage: CurveStage::Curve(70) };
    assert!(answer(&mut session.model, far(id - 1)).is_empty());
    assert_eq!(session.model.stage, None);
    answer(&mut session.model, far(id));
    assert!(session.status().ends_with("point 70; cancel cancels"), "{}", session.status());
    session.driver.settle(&mut session.model, effects);
    // A late answer, as from a thread: the computation is no longer running.
    answer(&mut session.model, far(id));
    assert!(!session.model.is_computing() && !session.status().contains("point 70"));
}

#[test]
fn a_walk_counts_its_states_and_a_pause_is_no_error() {
    let mut session = Session::new("wavy-sphere");
    let effects = update(&mut session.model, Command::Steps(9));
    let Some(Effect::Walk(request)) = effects.first() else { panic!("{effects:?}") };
    let mut made = Vec::new();
    let outcome = pulloff::explorer::walk::walk(request, &mut |state| {
        made.push(state);
        made.len() < 4
    });
    let (id, count) = (request.id, made.len());
    assert_eq!(count, 4);
    answer(&mut session.model, Reply::Walked { id, made, outcome: None });
    assert_eq!(session.status(), "walking, 4 of 9 states; cancel stops");
    answer(&mut session.model, Reply::Walked { id, made: Vec::new(), outcome: Some(outcome) });
    let (level, text) = session.model.status();
    assert_eq!(level, Level::Info);
    assert!(text.starts_with("paused"), "{text}");
}

#[test]
fn what_is_typed_behind_a_change_of_values_is_done_with_the_new_ones() {
    let mut session = Session::new("wavy-sphere");
    session.all(&[Id::NextEvent, Id::Jump]);
    let steps = session.model.history.len();
    // All in one burst, before any of it is done.
    let set = Command::Set { key: "gap.amplitude".into(), text: "0.0023".to_owned() };
    let effects = update(&mut session.model, set);
    for id in [Id::NextEvent, Id::Jump, Id::Reverse, Id::Step, Id::Reverse, Id::NextEvent] {
        assert!(update(&mut session.model, id.into()).is_empty());
    }
    assert_eq!((session.model.history.len(), session.model.queue.len()), (steps, 6));
    assert!(session.status().contains("new values, 6 commands wait for it"), "{}", session.status());
    session.driver.settle(&mut session.model, effects);
    let node = session.model.history.current().unwrap();
    assert!(node.is_limit(Control::Displacement) && session.model.is_on_curve(node) && session.model.inward);
    let mut one_by_one = Session::new("wavy-sphere");
    one_by_one.all(&[Id::NextEvent, Id::Jump]).set("gap.amplitude", "0.0023");
    one_by_one.all(&[Id::NextEvent, Id::Jump, Id::Reverse, Id::Step, Id::Reverse, Id::NextEvent]);
    assert_eq!(session.model.journal.lines(), one_by_one.model.journal.lines());
    assert_eq!(node.state, one_by_one.model.history.current().unwrap().state);
}

#[test]
fn nothing_is_walked_on_a_curve_of_other_values() {
    let mut session = Session::new("wavy-sphere");
    session.does(Id::NextEvent);
    let steps = session.model.history.len();
    let set = |text: &str| Command::Set { key: "gap.amplitude".into(), text: text.to_owned() };
    // Given up, with a step that waited for it.
    drop(update(&mut session.model, set("0.0023")));
    drop(update(&mut session.model, Id::Step.into()));
    drop(update(&mut session.model, Id::Cancel.into()));
    assert!(session.model.queue.is_empty());
    assert_eq!(session.model.script().unwrap(), ["next-event"], "nothing was done with these values");
    for id in [Id::Step, Id::NextEvent, Id::Run] {
        session.does(id);
        assert_eq!(session.model.history.len(), steps, "{id:?}");
        assert!(session.status().contains("the curve is the old one"), "{}", session.status());
    }
    session.does(Id::Undo).does(Id::Step);
    assert_eq!(session.model.history.len(), steps + 1);
    // Computed after all.
    drop(update(&mut session.model, set("0.0023")));
    drop(update(&mut session.model, Id::Cancel.into()));
    session.does(Id::Restart);
    assert!(session.model.shows_its_curve());
    // A second change waits for the commands that wait for the first.
    let steps = session.model.history.len();
    let effects = update(&mut session.model, set("0.0024"));
    drop(update(&mut session.model, Id::Step.into()));
    assert!(update(&mut session.model, set("0.0025")).is_empty());
    session.driver.settle(&mut session.model, effects);
    assert!(session.model.shows_its_curve() && session.model.queue.is_empty());
    // Solved again, a step, and solved again.
    assert_eq!(session.model.history.len(), steps + 3);
}

#[test]
fn the_walker_is_not_sent_further_than_a_walk_may_lead() {
    let mut session = Session::new("wavy-sphere");
    let start = session.radius();
    session.does(Command::MoveTo(format!("{:?}", 2.9 * start)));
    assert!((session.radius() / (2.9 * start) - 1.0).abs() < 1e-9);
    session.does(Command::MoveTo(format!("{:?}", 3.1 * start)));
    assert!((session.radius() / (2.9 * start) - 1.0).abs() < 1e-9);
    assert!(
        session.status().contains("1.271 is out of range: it must be at most 1.23"),
        "{}",
        session.status()
    );
}

#[test]
fn a_walk_that_has_not_left_its_start_begins_again_for_values_without_its_state() {
    let mut session = Session::new("wavy-sphere");
    let set = |radius: &str| parse(&format!("set gap.radius_of_curvature={radius}")).unwrap().unwrap();
    session.does(set("4"));
    assert_eq!(session.kind(), NodeKind::Solved, "{}", session.status());
    assert!(session.model.is_at_start());
    assert!(session.status().contains("now at its start"), "{}", session.status());
    session.does(Id::NextEvent);
    assert!(session.status().contains("Event 1 of"), "{}", session.status());
    // Away from its start, the state stays, and turning back solves it again.
    let state = session.model.history.current().unwrap().state;
    session.does(set("1"));
    assert!(session.status().contains("no equilibrium at this displacement"), "{}", session.status());
    session.does(set("4"));
    let again = session.model.history.current().unwrap().state;
    assert!((again.approach / state.approach - 1.0).abs() < 1e-9);
}

#[test]
fn short_keys_are_the_last_part_of_a_key_or_its_symbol() {
    let mut session = Session::new("wavy-sphere");
    for (line, key, text) in [
        ("set amplitude=0.002", "gap.amplitude", "0.002"),
        ("set A=0.0021", "gap.amplitude", "0.0021"),
        ("set γ=0.004 lambda=0.06", "material.work_of_adhesion", "0.004"),
        ("set control=force", "path.control", "force"),
    ] {
        session.does(parse(line).unwrap().unwrap());
        assert_eq!(session.model.preset.get(key).unwrap().to_string(), text, "{line}: {}", session.status());
    }
    // A letter that a formula uses as a parameter means that parameter.
    let mut session = Session::new("formula");
    session.does(parse("set A=0.003").unwrap().unwrap());
    assert_eq!(session.model.preset.get("gap.parameters.A").unwrap().to_string(), "0.003");
    session.does(parse("set B=0.003").unwrap().unwrap());
    assert_eq!(session.status(), "unknown key B");
    let mut session = Session::new("harmonics");
    session.does(parse("set amplitude=0.003").unwrap().unwrap());
    assert!(session.status().starts_with("amplitude is short for several: gap."), "{}", session.status());
}

#[test]
fn the_value_that_is_turned_stays_selected_when_a_key_comes_before_it() {
    let mut session = Session::new("wavy-sphere");
    let selected = |session: &Session| session.model.selected_knob().unwrap().0.key.to_string();
    assert_eq!(selected(&session), "gap.amplitude");
    session.does(Command::Assign(vec![("material.closing_work_of_adhesion".into(), "0.003".to_owned())]));
    assert_eq!(session.model.preset.material.adhesion.name(), "short-range");
    assert_eq!(selected(&session), "gap.amplitude");
    session.does(Id::Undo);
    assert_eq!(selected(&session), "gap.amplitude");
}

#[test]
fn values_that_need_each_other_are_set_in_any_order() {
    let range = ("material.cohesive_range".into(), "0.005".to_owned());
    let word = ("material.adhesion".into(), "dugdale".to_owned());
    for all in [vec![range.clone(), word.clone()], vec![word, range]] {
        let mut session = Session::new("wavy-sphere");
        session.does(Command::Assign(all));
        assert_eq!(session.model.preset.material.adhesion.name(), "dugdale", "{}", session.status());
    }
    let mut session = Session::new("wavy-sphere");
    session.does(Command::Assign(vec![("material.adhesion".into(), "dugdale".to_owned())]));
    assert!(session.status().contains("needs material.cohesive_strength"), "{}", session.status());
}

#[test]
fn a_rate_without_a_law_of_the_edge_says_that_it_changes_nothing() {
    let mut session = Session::new("wavy-sphere");
    session.does(Command::Assign(vec![("path.rate".into(), "0.001".to_owned())]));
    assert!(session.status().contains("until edge.exponent"), "{}", session.status());
    let both =
        [("edge.exponent", "0.5"), ("path.rate", "0.01")].map(|(key, text)| (key.into(), text.to_owned()));
    session.does(Command::Assign(both.to_vec()));
    assert!(!session.status().contains("has no effect"), "{}", session.status());
}

#[test]
fn a_bare_number_of_an_si_preset_says_that_it_is_si_and_a_unit_may_stand_apart() {
    let mut session = Session::new("fig-9-si");
    session.does(parse("set gap.amplitude=1.2e-5").unwrap().unwrap());
    assert!(session.status().contains("a bare number is SI"), "{}", session.status());
    assert!((number(&session, "gap.amplitude") - 1.2e-5).abs() < 1e-18);
    session.does(parse("set gap.amplitude=12 um").unwrap().unwrap());
    assert!(!session.status().contains("a bare number is SI"), "{}", session.status());
    for line in ["control stiffness=2000 N/m", "set control=stiffness=2000 N/m"] {
        session.does(parse(line).unwrap().unwrap());
        let given = session.model.preset.get("path.control").unwrap().to_string();
        assert!(given.starts_with("stiffness=2000"), "{given}: {}", session.status());
    }
}

#[test]
fn a_value_that_is_so_already_is_told_to_be() {
    let mut session = Session::new("wavy-sphere");
    for (line, said) in [
        ("set A=0.0025", "A is already 0.0025"),
        ("set A=0.0025 lambda=0.05", "A is already 0.0025, λ is already 0.05"),
        ("set path.rate=none", "rate is already none"),
        ("control displacement", "control is already displacement"),
    ] {
        session.does(parse(line).unwrap().unwrap());
        assert_eq!(session.status(), said);
    }
    session.does(parse("set A=0.003 lambda=0.05").unwrap().unwrap());
    assert!(!session.status().contains("already"), "{}", session.status());
}
