//! Gaps in the explorer: a formula while it is typed, another shape, a profile found in a folder.

use crate::support::session::Session;
use pulloff::explorer::Command;
use pulloff::explorer::data::Folder;
use pulloff::explorer::model::{Level, Question};
use pulloff::store::{Overwrite, save_file};

/// The folder whose profiles are offered.
fn listed_folder(session: &mut Session) -> Folder {
    let Some(Question::File(_, folder)) = session.model.question.take() else {
        unreachable!("no folder is offered")
    };
    *folder
}

#[test]
fn a_formula_is_tried_while_it_is_typed_and_can_be_taken_back() {
    let mut session = Session::new("formula");
    session.set("gap.parameters.lambda", "0.06");
    let before = session.model.preset.clone();
    let tries = |session: &mut Session, text: &str| {
        session.does(Command::Try { key: "gap.formula".into(), text: text.to_owned() });
    };
    let value = |session: &Session, name: &str| session.model.preset.get(&format!("gap.parameters.{name}"));
    // Halfway through a name: the new parameter takes the value of the one whose name it begins, which is gone; the
    // others are unchanged.
    tries(&mut session, "r^2/(2*R) + A*(1 - cos(2*pi*r/lam))");
    assert_eq!((value(&session, "lam"), value(&session, "lambda")), (Some(0.06.into()), None));
    assert_eq!(value(&session, "A"), before.get("gap.parameters.A"));
    assert_eq!(session.model.curve.clone().unwrap().setting.preset, session.model.preset);
    // A misspelt name is reported, and takes the value of the name that it resembles.
    tries(&mut session, "r^2/(2*R) + A*(1 - cos(2*pi*r/lamda))");
    assert_eq!(value(&session, "lamda"), Some(0.06.into()));
    let status = session.status().clone();
    assert!(status.contains("new parameter lamda = 0.06; did you mean lambda?"), "{status}");
    // With the whole name again, its value is the earlier one.
    tries(&mut session, "r^2/(2*R) + A*(1 - cos(2*pi*r/lambda)) + 0*B");
    assert_eq!((value(&session, "lambda"), value(&session, "B")), (Some(0.06.into()), Some(1.0.into())));
    // Not a formula: nothing changes.
    let tried = session.model.preset.clone();
    tries(&mut session, "r^2/(2*R");
    assert!(session.status().contains("column 9"), "{}", session.status());
    assert_eq!(session.model.preset, tried);
    session.does(Command::TakeBack);
    assert_eq!(session.model.preset, before);
    assert!(session.model.untried.is_none() && !session.model.is_computing());
    assert_eq!(session.model.curve.clone().unwrap().setting.preset, before);
    tries(&mut session, "r^2/(2*R)");
    session.set("gap.formula", "r^2/(2*R) + 0*lambda");
    assert_eq!(value(&session, "lambda"), Some(0.06.into()));
    assert!(session.model.untried.is_none());
}

#[test]
fn another_shape_keeps_what_both_know() {
    let mut session = Session::new("wavy-sphere");
    session.set("gap.amplitude", "0.003").set("gap.wavelength", "0.07").set("gap.radius_of_curvature", "1.1");
    let value = |session: &Session, key: &str| session.model.preset.get(key);
    session.set("gap.shape", "harmonics");
    assert_eq!(value(&session, "gap.radius_of_curvature"), Some(1.1.into()));
    assert_eq!(value(&session, "gap.waves.1.amplitude"), Some(0.003.into()));
    assert_eq!(value(&session, "gap.waves.1.wavelength"), Some(0.07.into()));
    session.set("gap.shape", "wavy-sphere").set("gap.amplitude", "0.003").set("gap.shape", "formula");
    assert_eq!(value(&session, "gap.parameters.A"), Some(0.003.into()));
    assert_eq!(value(&session, "gap.parameters.R"), Some(1.1.into()));
}

#[test]
fn a_gap_of_other_lengths_is_told_of() {
    let told = |shape: &str, preset: &str| {
        let mut session = Session::new(preset);
        session.set("gap.shape", shape);
        let (_, said) = session.model.message.clone().unwrap_or((Level::Info, String::new()));
        said.contains("lengths have another scale here").then_some(said)
    };
    let said = told("profile", "wavy-sphere").unwrap();
    assert!(said.contains("1 for the last: E*, γ and the path keep their numbers"), "{said}");
    // Gaps with a single length, and metres in both.
    assert_eq!([told("sphere", "wavy-sphere"), told("sphere", "fig-9-si")], [None, None]);
}

fn browse(folder: Option<std::path::PathBuf>) -> Command {
    Command::Browse { key: "gap.file".into(), folder }
}

#[test]
fn a_profile_is_found_in_a_folder_read_and_saved_with_its_preset() {
    let mut session = Session::new("profile");
    let folder = session.folder.path().canonicalize().unwrap();
    let path = |name: &str| folder.join(name).to_str().unwrap().to_owned();
    let rows = |radii: &[f64]| -> String {
        radii.iter().map(|r| format!("{r}, {}\n", r * r / 2000.0)).collect::<Vec<_>>().concat()
    };
    let mut radii: Vec<f64> = (0..100).map(|i| 4.0 * f64::from(i)).collect();
    std::fs::write(path("good.csv"), rows(&radii)).unwrap();
    radii.swap(3, 7);
    std::fs::write(path("mixed.txt"), rows(&radii)).unwrap();
    std::fs::write(path("bad.csv"), rows(&radii) + "400.0, much\n").unwrap();
    session.does(browse(Some(folder.clone())));
    let listed = listed_folder(&mut session);
    assert_eq!(listed.files, ["bad.csv", "good.csv", "mixed.txt"]);
    let (before, curve) = (session.model.preset.clone(), session.model.curve.clone().unwrap());
    session.set("gap.file", &listed.name_of("bad.csv"));
    assert!(session.status().contains("line 101: the gap \"much\" is not a number"), "{}", session.status());
    assert_eq!(session.model.preset, before);
    assert_eq!(session.model.curve.as_ref().unwrap().setting.preset, curve.setting.preset);
    session.set("gap.file", &listed.name_of("mixed.txt"));
    assert!(session.status().contains("have been sorted"), "{}", session.status());
    session.set("gap.file", &listed.name_of("good.csv"));
    assert!(session.status().contains("good.csv: 100 rows"), "{}", session.status());
    assert_eq!(session.model.curve.clone().unwrap().setting.preset, session.model.preset);
    // Saved beside the data, the preset names them by their path from there.
    let target = folder.join("mine.toml");
    save_file(&target, &session.model.preset, None, Overwrite::Never).unwrap();
    assert!(std::fs::read_to_string(&target).unwrap().contains("file = \"good.csv\""));
    // With its data elsewhere, the preset of the session names the copy.
    session.does(Command::SaveAs { name: "scan".to_owned(), replace: false, with_data: true });
    assert!(session.status().contains("saved as scan"), "{}", session.status());
    assert!(!session.model.is_unsaved() && folder.join("presets/good.csv").is_file());
    assert_eq!(session.model.preset.get("gap.file").unwrap().to_string(), "good.csv");
    session.does(browse(None));
    assert_eq!(listed_folder(&mut session).path, folder.join("presets"));
    session.does(browse(Some(folder.join("gone"))));
    assert!(session.status().contains("cannot be listed"), "{}", session.status());
}
