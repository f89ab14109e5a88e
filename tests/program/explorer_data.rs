//! A measured curve in the explorer: laid behind the chart, shifted, removed, and kept with preset, session and script.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a helper of a test fails the test by panicking")]

use crate::support::session::Session;
use pulloff::explorer::export::Export;
use pulloff::explorer::fit::FittedError;
use pulloff::explorer::model::{Model, Question};
use pulloff::explorer::script::parse;
use pulloff::explorer::session::{Document, Ended, Snapshot};
use pulloff::explorer::{Command, Id, View, update};
use pulloff::figure::{Mark, Sign, Subject};
use pulloff_engine::preset::data;

/// Runs a line of a script.
/// The standard error that a fit has given a value.
fn known_to(session: &Session, key: &str) -> f64 {
    match session.model.fitted_error(key) {
        Some(FittedError::Holds(error)) => error,
        unknown => panic!("{key}: {unknown:?}"),
    }
}

fn says(session: &mut Session, line: &str) {
    let command = parse(line).unwrap().unwrap();
    session.does(command);
}

/// The measured points of a view, of the approach and of the retraction.
fn drawn(session: &Session, view: View) -> [Vec<(f64, f64)>; 2] {
    let figure = Subject::of(&session.model).unwrap().figure(view);
    [true, false].map(|approach| {
        let is = |mark: &&Mark| matches!(mark.sign, Sign::Measured { loading, .. } if loading == approach);
        figure.marks.iter().filter(is).map(|mark| mark.at).collect()
    })
}

#[test]
fn points_lie_behind_every_view_that_has_their_columns_and_go_again() {
    let mut session = Session::new("lens");
    let curve = session.model.curve.clone().unwrap();
    for view in View::ALL {
        let count: usize = drawn(&session, view).iter().map(Vec::len).sum();
        let expected = match view {
            View::ForceApproach | View::ForcePosition | View::Unloading | View::Cycle => 700,
            // The columns contain no radius.
            _ => 0,
        };
        assert_eq!(count, expected, "{view:?}");
    }
    let before = drawn(&session, View::ForceApproach);
    // The curve is not computed again for the points behind it.
    session.set(data::OFFSET, "5 um");
    let shifted = drawn(&session, View::ForceApproach);
    for (a, b) in before.iter().flatten().zip(shifted.iter().flatten()) {
        assert!((a.0 - b.0 - 5.0).abs() < 1e-9 && a.1.to_bits() == b.1.to_bits(), "{a:?} {b:?}");
    }
    assert!(std::sync::Arc::ptr_eq(&curve, session.model.curve.as_ref().unwrap()));
    // Over the position of the device the points are as measured, less the offset: the spring is in the curve.
    let branches = session.model.preset.branches().unwrap().unwrap();
    let rows = branches.list.iter().flat_map(|branch| branch.attached.iter().chain(&branch.free));
    let over_position = drawn(&session, View::ForcePosition);
    for (row, at) in rows.zip(over_position.iter().flatten()) {
        assert!((1e6 * row.x - 5.0 - at.0).abs() < 1e-9, "{row:?} {at:?}");
    }
    // And the curve over it is δ + P/k.
    let figure = Subject::of(&session.model).unwrap().figure(View::ForcePosition);
    let line = figure.lines.iter().find(|line| line.name == "stable").unwrap();
    let on_curve = curve.points.iter().map(|at| 1e6 * (at.approach + at.force / 500.0));
    let [lo, hi] = on_curve.fold([f64::MAX, f64::MIN], |[lo, hi], x| [lo.min(x), hi.max(x)]);
    assert!(line.points.iter().all(|at| at.0 > lo - 1e-9 && at.0 < hi + 1e-9) && figure.x.symbol == "Δ");
    // Changed by a key: a thousandth of the range, from wherever it is.
    let knob = |key: &'static str| Command::Turn { id: Id::More, key: key.into() };
    let range = session.model.preset.branches().unwrap().unwrap().ranges;
    session.does(knob(data::OFFSET)).does(knob(data::BASELINE));
    let value = |session: &Session, key| session.model.preset.get(key).unwrap().as_number().unwrap();
    assert!((value(&session, data::OFFSET) - 5e-6 - 1e-3 * range[0]).abs() < 1e-4 * range[0]);
    let free = session.model.preset.branches().unwrap().unwrap().baseline.unwrap();
    assert!((value(&session, data::BASELINE) - free - 1e-3 * range[1]).abs() < 1e-4 * range[1]);
    says(&mut session, "data none");
    assert_eq!(session.model.preset.data.source, None);
    assert!(drawn(&session, View::ForceApproach).iter().all(Vec::is_empty));
    session.does(Id::Undo);
    assert_eq!(drawn(&session, View::ForceApproach)[0].len(), 350);
    // An invalid file leaves everything unchanged and says why.
    let path = session.folder.path().join("bad.csv");
    std::fs::write(&path, "delta,force\n1,2\n3,x\n").unwrap();
    says(&mut session, &format!("data {}", path.display()));
    assert!(
        session.status().contains("line 3: column 2: the force \"x\" is not a number"),
        "{}",
        session.status()
    );
    assert_eq!(drawn(&session, View::ForceApproach)[0].len(), 350);
    // So does a file whose rows make no branches, and a value that leaves too few of them.
    let kept = session.model.preset.clone();
    let jumbled: Vec<String> = (0..40).map(|i| format!("{},{}", (i * 17) % 40, i % 3)).collect();
    std::fs::write(&path, format!("delta [um],force [mN]\n{}\n", jumbled.join("\n"))).unwrap();
    for (line, why) in [
        (format!("data {}", path.display()), "bad.csv: the rows are not in order"),
        (format!("set {}=698", data::SKIP), "shipped:lens.csv: only 2 rows are left"),
    ] {
        says(&mut session, &line);
        let said = session.status();
        assert!(said.starts_with(why) && said.ends_with("the data stay as they were"), "{said}");
        assert_eq!(session.model.preset, kept);
    }
    // A file that is there already is told to be.
    says(&mut session, &format!("data {}", kept.data.source.as_ref().unwrap().name));
    assert_eq!(session.status(), "data is already shipped:lens.csv");
    session.does(Command::Browse { key: data::FILE.into(), folder: Some(session.folder.path().to_owned()) });
    let Some(Question::File(key, folder)) = session.model.question.take() else { panic!("no folder") };
    assert_eq!((&*key, &*folder.files), (data::FILE, &["bad.csv".to_owned()][..]));
}

#[test]
fn many_points_are_thinned_for_drawing_alone() {
    let mut session = Session::new("wavy-sphere");
    let rows: Vec<String> =
        (0..20_000).map(|i| 2e-5 * f64::from(i)).map(|x| format!("{x},{}", x * x)).collect();
    let path = session.folder.path().join("many.csv");
    std::fs::write(&path, format!("delta,force\n{}\n", rows.join("\n"))).unwrap();
    says(&mut session, &format!("data {}", path.display()));
    let said = session.status();
    assert!(said.contains("many.csv: approach: ") && said.contains(" in contact, "), "{said}");
    let count: usize = drawn(&session, View::ForceApproach).iter().map(Vec::len).sum();
    assert!((2000..=3000).contains(&count), "{count}");
}

#[test]
fn a_session_and_a_script_carry_the_points_whatever_became_of_the_file() {
    let mut session = Session::new("wavy-sphere");
    let path = session.folder.path().join("curve.csv");
    let rows: Vec<String> =
        (0..50).map(|i| format!("{},{}", 0.01 * f64::from(i), 0.1 * f64::from(i * i))).collect();
    std::fs::write(&path, format!("delta,force\n{}\n", rows.join("\n"))).unwrap();
    says(&mut session, &format!("data {}", path.display()));
    session.set(data::OFFSET, "0.1").does(Command::Steps(2));
    let lines = session.model.script().unwrap();
    assert!(lines.iter().any(|line| line.contains("data.file=")), "{lines:?}");
    let mut again = Session::new("wavy-sphere");
    for line in &lines {
        says(&mut again, line);
    }
    assert_eq!(again.model.preset, session.model.preset);
    let document = Document::new(&Snapshot::of(&session.model), Ended::Quit, 0).json().unwrap();
    std::fs::remove_file(&path).unwrap();
    let back = Document::read(&document).unwrap().snapshot().unwrap();
    assert_eq!(back.preset, session.model.preset);
    let before = drawn(&session, View::ForceApproach);
    let (mut model, effects) = back.resume(None);
    session.driver.settle(&mut model, effects);
    session.model = model;
    assert_eq!(drawn(&session, View::ForceApproach), before);
}

#[test]
fn a_fit_changes_the_free_keys_as_one_command_and_says_their_errors() {
    let mut session = Session::new("lens");
    let before = session.model.preset.clone();
    session.does(Id::Fit);
    assert!(session.status().starts_with("fitted: χ² "), "{}", session.status());
    let value = |session: &Session, key: &str| session.model.preset.get(key).unwrap().as_number().unwrap();
    // A session that is resumed repeats the fit, and then has its errors and its report; so does one that ends before that.
    let (modulus, adhesion) = ("material.effective_modulus", "material.work_of_adhesion");
    let resumed = |model: &Model| {
        let document = Document::new(&Snapshot::of(model), Ended::Quit, 0).json().unwrap();
        Document::read(&document).unwrap().snapshot().unwrap().resume(None)
    };
    let (model, _) = resumed(&session.model);
    assert!(model.preset == session.model.preset && model.fitted().is_none() && model.fits_again());
    let (mut model, effects) = resumed(&model);
    session.driver.settle(&mut model, effects);
    assert!(
        model
            .message
            .as_ref()
            .is_some_and(|(_, said)| said.contains("errors and the report of the fit are back"))
    );
    assert!(model.preset == session.model.preset && !model.fits_again());
    assert_eq!(model.fitted_error(modulus), session.model.fitted_error(modulus));
    assert!(model.fitted_error(modulus).is_some());
    // What is undone while the fit repeats stays undone.
    let (mut model, effects) = resumed(&session.model);
    let undone = update(&mut model, Id::Undo.into());
    session.driver.settle(&mut model, effects);
    session.driver.settle(&mut model, undone);
    assert_eq!(model.preset, before);
    let redone = update(&mut model, Id::Redo.into());
    session.driver.settle(&mut model, redone);
    assert!(model.preset == session.model.preset && model.fitted_error(modulus).is_some());
    for (key, truth) in [(modulus, 1e6), (adhesion, 0.05), (data::OFFSET, 12.3e-6), (data::BASELINE, 4e-6)] {
        let (found, error) = (value(&session, key), known_to(&session, key));
        assert!((found - truth).abs() < 4.0 * error && error < 0.05 * truth, "{key}: {found} ± {error}");
    }
    assert_eq!(session.model.curve.as_ref().unwrap().setting.preset.material, session.model.preset.material);
    // A script leads to the same values without a fit.
    let mut again = Session::new("lens");
    for line in session.model.script().unwrap() {
        says(&mut again, &line);
    }
    assert_eq!(again.model.preset, session.model.preset);
    // With another R, another file or other rows, all standard errors are gone.
    let fitted = session.model.preset.clone();
    let file = tempfile::tempdir().unwrap();
    let curve = include_str!("../../presets/data/lens.csv").replace("-227.8", "-227.9");
    std::fs::write(file.path().join("other.csv"), curve).unwrap();
    let file = file.path().join("other.csv");
    for (key, value) in [
        ("gap.radius_of_curvature", "1.1 mm"),
        (data::FILE, file.to_str().unwrap()),
        (data::FREE_PART, "x=..9um"),
        (data::SIGNS, "x=+,force=+"),
        (data::SKIP, "2"),
    ] {
        session.set(key, value);
        assert_ne!(session.model.preset, fitted, "{key}: {}", session.status());
        assert!([adhesion, modulus].iter().all(|key| session.model.fitted_error(key).is_none()), "{key}");
        session.does(Id::Undo);
        assert_eq!(session.model.preset, fitted, "{key}");
    }
    session.set(data::SKIP, "2");
    let said = session.status();
    assert!(said.contains("approach: 191 in contact, 157 apart; retraction: "), "{said}");
    session.does(Id::Undo);
    // They are also gone with another value; u takes the whole fit back.
    session.set(adhesion, "60 mJ/m^2");
    assert!([adhesion, modulus].iter().all(|key| session.model.fitted_error(key).is_none()));
    session.does(Id::Undo);
    assert_eq!(session.model.preset, fitted);
    session.does(Id::Undo);
    assert_eq!(session.model.preset, before);
    let said = session.status();
    assert!(["δ0 ", "P0 "].iter().all(|label| said.contains(label)) && said.ends_with(" → none"), "{said}");
    // The residuals of the first guess are far above the noise; those of the fit are noise.
    let typical = |session: &mut Session| {
        session.model.view = View::Residuals;
        session.does(Id::Up);
        let mut all: Vec<f64> =
            drawn(session, View::Residuals).concat().iter().map(|at| at.1.abs()).collect();
        assert_eq!(all.len(), 700);
        all.sort_by(f64::total_cmp);
        all[350]
    };
    assert!(typical(&mut session) > 5.0);
    session.does(Id::Redo);
    assert!((0.4..1.1).contains(&typical(&mut session)));
}

/// A baseline left by a fit, or set by the user, is not information in addition to the rows apart: each fit determines
/// it again, with an error.
#[test]
fn a_second_fit_finds_the_baseline_anew() {
    let mut session = Session::new("lens");
    let free = |session: &Session| session.model.preset.data.free.clone();
    let asked = free(&session);
    assert!(!asked.contains(data::BASELINE));
    let value = |session: &Session, key: &str| session.model.preset.get(key).unwrap().as_number().unwrap();
    let keys = [data::BASELINE, data::OFFSET, "material.effective_modulus", "material.work_of_adhesion"];
    session.does(Id::Fit);
    let first = keys.map(|key| (value(&session, key), known_to(&session, key)));
    for wrong in ["4 uN", "60 uN"] {
        session.set(data::BASELINE, wrong);
        assert!(keys.iter().all(|key| session.model.fitted_error(key).is_none()), "{wrong}");
        session.does(Id::Fit);
        assert!(session.status().starts_with("fitted: χ² "), "{}", session.status());
        for (key, (before, error)) in keys.iter().zip(first) {
            let (found, now) = (value(&session, key), known_to(&session, key));
            assert!(
                (found - before).abs() < 0.01 * error && (now / error - 1.0).abs() < 0.01,
                "{key}: {found} {before}"
            );
        }
        assert_eq!(free(&session), asked, "what is free stays what a person says");
    }
}

#[test]
fn free_keys_are_marked_in_the_panel_and_what_is_not_determined_is_not_taken() {
    let mut session = Session::new("lens");
    let select = |session: &mut Session, key: &str| {
        session.model.parameter = session.model.knobs().iter().position(|(row, _)| row.key == key).unwrap();
        session.does(Id::Free);
    };
    let free = |session: &Session| session.model.preset.data.free().map(str::to_owned).collect::<Vec<_>>();
    select(&mut session, "gap.radius_of_curvature");
    assert_eq!(free(&session), ["E*", "gamma", "data.offset", "gap.radius_of_curvature"]);
    assert_eq!(session.status(), "R is free: a fit may change it");
    let before = session.model.preset.clone();
    session.does(Id::Fit);
    assert!(
        session.status().starts_with("not determined, so not taken: R +10 %, E* −4.7 %, γ −9.1 %"),
        "{}",
        session.status()
    );
    assert_eq!(session.model.preset, before);
    select(&mut session, "gap.radius_of_curvature");
    select(&mut session, "material.effective_modulus");
    assert_eq!(free(&session), ["gamma", "data.offset"]);
    select(&mut session, "basis.kind");
    assert!(session.status().contains("only those can be fitted"), "{}", session.status());
    // Typed names are those of keys too.
    says(&mut session, "free gamma,gama");
    assert!(session.status().contains("gama"), "{}", session.status());
    assert_eq!(free(&session), ["gamma", "data.offset"]);
    session.set(data::FREE, "").does(Id::Fit);
    assert!(session.status().starts_with("no value is free to fit: free lets"), "{}", session.status());
    says(&mut session, "data none");
    session.does(Id::Fit);
    assert!(
        session.status().starts_with("not fitted: the preset has no measured curve"),
        "{}",
        session.status()
    );
}

#[test]
fn a_foreign_header_asks_for_the_columns_and_the_answer_is_one_change() {
    let mut session = Session::new("wavy-sphere");
    let path = session.folder.path().join("foreign.csv");
    let rows: Vec<String> =
        (0..50).map(|i| format!("7,{},{}", 0.01 * f64::from(i), 0.1 * f64::from(i * i))).collect();
    std::fs::write(&path, format!("u1,u2,u3\n{}\n", rows.join("\n"))).unwrap();
    says(&mut session, &format!("data {}", path.display()));
    assert!(session.status().contains("data.columns \"approach=1,force=2\""), "{}", session.status());
    let Some(Question::Columns(foreign)) = session.model.question.take() else { panic!("nothing is asked") };
    let names: Vec<&str> = foreign.seen.iter().map(|seen| &*seen.name).collect();
    assert_eq!((&*foreign.shown, &names[..]), ("foreign.csv", &["u1", "u2", "u3"][..]));
    assert_eq!(foreign.seen[1].first, ["0", "0.01", "0.02"]);
    let mut all = vec![(data::COLUMNS.into(), "approach=2,force=3".to_owned())];
    all.extend(foreign.assignments);
    session.does(Command::Assign(all));
    assert_eq!(drawn(&session, View::ForceApproach).iter().map(Vec::len).sum::<usize>(), 50);
    // A script leads there.
    let mut again = Session::new("wavy-sphere");
    for line in &session.model.script().unwrap() {
        says(&mut again, line);
    }
    assert_eq!(again.model.preset.data.columns, "approach=2,force=3");
    assert_eq!(drawn(&again, View::ForceApproach), drawn(&session, View::ForceApproach));
    session.does(Id::Undo);
    let data = &session.model.preset.data;
    assert!(data.source.is_none() && data.columns.is_empty());
    // Another kind of fault is reported, and nothing is asked.
    std::fs::write(&path, "delta,force\n1,2\n3,x\n").unwrap();
    says(&mut session, &format!("data {}", path.display()));
    assert!(session.model.question.is_none(), "{}", session.status());
}

#[test]
fn another_file_drops_what_held_for_the_previous_one() {
    let folder = tempfile::tempdir().unwrap();
    let rows: Vec<String> = (0..40).map(|i| format!("{},{}", 40 - i, 1.5 * f64::from(20 - i))).collect();
    let put = |name: &str, head: &str| {
        let path = folder.path().join(name);
        std::fs::write(&path, format!("{head}{}\n", rows.join("\n"))).unwrap();
        path.to_str().unwrap().to_owned()
    };
    let bare = put("bare.csv", "a,b\n");
    let also_bare = put("also-bare.csv", "c,d\n");
    let other = put("other.csv", "approach [um],force [uN]\n");
    let mut session = Session::new("lens");
    says(&mut session, &format!("set data.file={bare} data.columns=\"approach=1 [um],force=2 [uN]\""));
    says(&mut session, "set data.baseline=2uN data.skip=1 data.free=gamma");
    let said = |session: &Session| {
        let data = &session.model.preset.data;
        (data.columns.is_empty(), data.baseline.is_some(), data.skip, data.free.clone())
    };
    let given = (false, true, 1, "gamma".to_owned());
    assert_eq!(said(&session), given);
    // The same file again changes nothing. One without a header is read as before.
    says(&mut session, &format!("data {bare}"));
    assert_eq!(said(&session), given);
    says(&mut session, &format!("data {also_bare}"));
    assert_eq!(said(&session), (false, false, 0, "gamma".to_owned()));
    let message = session.model.message.as_ref().unwrap().1.clone();
    assert!(
        message.contains("data.skip, data.baseline of ") && message.contains(" are dropped"),
        "{message}"
    );
    session.does(Command::Plain(Id::Undo));
    assert_eq!(said(&session), given);
    // A header that says what the columns are counts, and what is given with the file holds.
    says(&mut session, &format!("set data.file={other} data.skip=3"));
    assert_eq!(said(&session), (true, false, 3, "gamma".to_owned()));
    says(&mut session, "data none");
    assert_eq!(said(&session), (true, false, 0, "gamma".to_owned()));
}

#[test]
fn a_walk_of_ones_own_lies_on_its_own_curve() {
    for (walk, exported) in [
        ("next-event\n".repeat(4), Export::Walk),
        ("next-event\n".repeat(12), Export::Walk),
        (String::new(), Export::Curve),
    ] {
        let mut session = Session::new("wavy-sphere");
        for _ in walk.lines() {
            session.does(Id::NextEvent);
        }
        let path = session.folder.path().join("own.csv").to_string_lossy().into_owned();
        session.does(Command::Export { what: exported, path: path.clone(), replace: false });
        let text = std::fs::read_to_string(&path).unwrap();
        let column =
            |name: &str| text.lines().next().unwrap().split(',').position(|head| head == name).unwrap();
        let (x, y) = (column("approach"), column("force"));
        let critical = session.model.curve.as_ref().unwrap().base.critical_force;
        let wanted: Vec<(f64, f64)> = text
            .lines()
            .skip(1)
            .map(|line| line.split(',').collect::<Vec<_>>())
            .map(|cells| (cells[x].parse().unwrap(), cells[y].parse::<f64>().unwrap() / critical))
            .collect();
        says(&mut session, &format!("data {path}"));
        let drawn = drawn(&session, View::ForceApproach).concat();
        assert!(drawn.len() + 3 > wanted.len() && drawn.len() > 20, "{} of {}", drawn.len(), wanted.len());
        for at in drawn {
            let is_it = |row: &(f64, f64)| (row.0 - at.0).abs() < 1e-9 && (row.1 - at.1).abs() < 1e-9;
            assert!(wanted.iter().any(is_it), "{at:?} is none of the rows");
        }
    }
}
