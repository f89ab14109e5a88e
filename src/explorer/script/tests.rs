use super::*;
use crate::explorer::command::{Command, Id, MOST_STEPS};
use crate::explorer::export::Export;
use crate::explorer::table::ROWS;
use crate::explorer::view::Overlay;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

fn plain() -> impl Strategy<Value = Command> {
    let ids: Vec<Id> = ROWS.iter().filter(|row| !row.takes.is_needed).map(|row| row.id).collect();
    proptest::sample::select(ids).prop_map(Command::from)
}

fn assignments(least: usize) -> impl Strategy<Value = Vec<(pulloff_engine::preset::Key, String)>> {
    let keys = ["gap.amplitude", "title", "gap.parameters.A", "gap.waves.2.phase", "groups.adhesion"];
    let one = (proptest::sample::select(keys.to_vec()), "\\PC{0,12}").prop_map(|(k, t)| (k.into(), safe(&t)));
    proptest::collection::vec(one, least..4)
}

fn safe(text: &str) -> String {
    text.chars().filter(|c| !pulloff_engine::text::is_unsafe(*c)).collect()
}

fn any_command() -> impl Strategy<Value = Command> {
    let text = || "\\PC{0,12}".prop_map(|text| safe(&text));
    let what = proptest::sample::select(Export::ALL.to_vec());
    let overlay = proptest::sample::select(Overlay::ALL.to_vec());
    let flag = any::<bool>;
    prop_oneof![
        plain(),
        (1..=MOST_STEPS).prop_map(Command::Steps),
        (1..=MOST_STEPS).prop_map(Command::RunOf),
        (1..=MOST_STEPS).prop_map(Command::SelectEvent),
        (1e-4..0.2f64).prop_map(Command::StepLength),
        (1e-9..1e3f64).prop_map(|radius| Command::MoveTo(format!("{radius:?}"))),
        assignments(1).prop_map(Command::Assign),
        overlay.prop_map(Command::Overlay),
        Just(Command::Map { x: "gap.amplitude".into(), y: None }),
        Just(Command::Map { x: "compliance".into(), y: Some("groups.adhesion".into()) }),
        Just(Command::Map { x: "groups.adhesion".into(), y: Some("force".into()) }),
        Just(Command::Map { x: "gap.amplitude=log:1e-4..5e-3".into(), y: Some("compliance=0..inf".into()) }),
        proptest::option::of(1..=6usize).prop_map(Command::Unpin),
        text().prop_map(Command::Open),
        (text(), assignments(1)).prop_map(|(name, assignments)| Command::OpenWith { name, assignments }),
        Just(Command::SaveAnyway),
        (text(), flag(), flag()).prop_map(|(name, replace, with_data)| Command::SaveAs {
            name,
            replace,
            with_data
        }),
        (what, text(), flag()).prop_map(|(what, name, replace)| {
            let path = format!("{name}a.{}", what.endings()[0]);
            Command::Export { what, path, replace }
        }),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 2000, rng_seed: RngSeed::Fixed(7), failure_persistence: None, ..ProptestConfig::default()
    })]

    #[test]
    fn the_line_of_a_command_reads_back(command in any_command()) {
        let text = line(&command).unwrap();
        prop_assert_eq!(parse(&text).unwrap(), Some(command), "{}", text);
    }

    #[test]
    fn any_text_is_a_command_or_a_fault_within_the_line(text in "\\PC{0,60}|(set|open|export|try|step)( [a-z.=\"\\\\#]{0,9}){0,4}") {
        if let Err(fault) = parse(&text) {
            prop_assert!((1..=text.chars().count() + 2).contains(&fault.column), "{} {:?}", text, fault);
            prop_assert!(!fault.what.chars().any(pulloff_engine::text::is_unsafe));
        }
        let _ = read("t", &text);
    }
}

fn fault(text: &str) -> String {
    read("t", text).unwrap_err().to_string()
}

#[test]
fn a_script_is_read_with_comments_quotes_and_synonyms() {
    let text = "# a comment\n\n  step 20  # so many\nrun\ncontrol force\n\
        try set gap.wavelength=\"3 um\" title=\"a \\\"b\\\" # c\"\nexport curve \"out file.csv\"\r\nsave-as x replace";
    let lines = read("t", text).unwrap();
    let commands: Vec<(usize, Command)> =
        lines.iter().map(|line| (line.number, line.command.clone())).collect();
    let set = |all: &[(&'static str, &str)]| {
        Command::Assign(all.iter().map(|(key, text)| ((*key).into(), (*text).to_owned())).collect())
    };
    let expected = [
        (3, Command::Steps(20)),
        (4, Id::Run.into()),
        (5, set(&[("path.control", "force")])),
        (6, set(&[("gap.wavelength", "3 um"), ("title", "a \"b\" # c")])),
        (7, Command::Export { what: Export::Curve, path: "out file.csv".to_owned(), replace: false }),
        (8, Command::SaveAs { name: "x".to_owned(), replace: true, with_data: false }),
    ];
    assert_eq!(commands, expected);
    // A unit may follow its number without quotes.
    assert_eq!(
        parse("set gap.wavelength=3 um title=x").unwrap(),
        Some(set(&[("gap.wavelength", "3 um"), ("title", "x")]))
    );
    // A value may follow its key, and its unit that.
    assert_eq!(parse("set gap.wavelength 3 um").unwrap(), Some(set(&[("gap.wavelength", "3 um")])));
    let steps = "to 0.05 at 0.01; hold 5; apart at 0.1";
    for line in [format!("set path.steps={steps} title=x"), format!("set path.steps {steps} title=x")] {
        assert_eq!(parse(&line).unwrap(), Some(set(&[("path.steps", steps), ("title", "x")])));
    }
    assert!(lines.iter().all(|line| line.may_fail == (line.number == 6)));
}

#[test]
fn a_fault_names_line_column_word_and_what_is_allowed() {
    for (text, expected) in [
        ("step\n stepp 3", "t:2:2: no command is called \"stepp\"; did you mean step?"),
        ("step 0", "t:1:6: \"0\" is not a number from 1 to 9999"),
        ("step 3 4", "t:1:8: step takes no \"4\" here"),
        ("set", "t:1:5: KEY=VALUE is missing"),
        ("set gap.amplitud=1", "t:1:5: unknown key gap.amplitud; did you mean gap.amplitude?"),
        ("set amplitud=1", "t:1:5: unknown key amplitud; did you mean gap.amplitude?"),
        ("open fig-9 amplitude=1", "t:1:12: unknown key amplitude; did you mean gap.amplitude?"),
        ("set gap.shape=cone b", "t:1:20: \"b\" is not KEY=VALUE"),
        (
            "export curv x.csv",
            "t:1:8: no document is called \"curv\": it is curve, walk, events, script, pull, study, figure, screen; did you mean curve?",
        ),
        ("export curve", "t:1:14: a file is missing"),
        ("open", "t:1:1: open needs a preset"),
        ("step-length 1", "t:1:13: \"1\" is not a length from 0.0001 to 0.2"),
        ("save-as \"x", "t:1:9: the quote is not closed"),
        ("save-as \"x\\n\"", "t:1:11: in quotes \\ may only precede"),
        ("help", "t:1:1: help only changes what a screen shows"),
        ("more", "t:1:1: more needs a selection on the screen; a script says set KEY=VALUE"),
        ("try", "t:1:1: try needs a command"),
        ("step \u{1b}[2J", "t:1:6: a control or invisible character"),
    ] {
        let said = fault(text);
        assert!(said.starts_with(expected), "{text}: {said}");
    }
    assert_eq!(fault(&"x\n".repeat(100)).lines().count(), read::FAULTS);
    assert!(fault(&format!("{}x", "\n".repeat(MOST_LINES))).contains("a script has at most 20000 lines"));
    assert!(fault(&"x".repeat(LONGEST + 1)).contains("at most 16384 characters"));
}

#[test]
fn every_command_of_the_table_is_for_scripts_or_says_why_not() {
    let refused: Vec<&str> =
        ROWS.iter().filter(|row| for_script(&row.id.into()).is_err()).map(|row| row.name).collect();
    assert!(refused.contains(&"cross-hair") && !refused.contains(&"step") && !refused.contains(&"pin"));
    for row in ROWS {
        assert!(read("t", row.name).is_ok() || !fault(row.name).is_empty());
    }
}
