use super::onto;
use crate::fixtures::{read, text as shipped};
use crate::preset::fixtures::{any_preset, wavy};
use crate::preset::{Preset, write};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use std::fmt::Write;

/// The text with these assignments made; also checks what it reads as.
fn edited(text: &str, assignments: &[&str]) -> String {
    let mut preset = read("p", text).unwrap_or_else(|error| panic!("{error}\n{text}"));
    for assignment in assignments {
        let (key, value) = assignment.split_once('=').unwrap();
        preset.assign(key, value).unwrap_or_else(|error| panic!("{assignment}: {error}"));
    }
    let edited = onto(None, text, &preset).unwrap_or_else(|| panic!("{assignments:?} on\n{text}"));
    assert_eq!(read("p", &edited).unwrap(), preset, "{edited}");
    edited
}

/// A user's own text, in which no two things look alike.
const MINE: &str = "\
# My notes, 3 May.

title   =   'mine'   # a title

# the bodies
[material]
work_of_adhesion=0.004# tight
effective_modulus = 1_0.0e-1 # as measured

[path]   # first the path
start_contact_radius = 0.5
# ends early
end_contact_radius = 2e-3 # far in

[gap]
shape = \"wavy-sphere\"
  amplitude = 0.0025   # A
\tradius_of_curvature = 1 # R
wavelength = \"0.1/2\"
# the end
";

#[test]
fn a_changed_value_is_replaced_and_nothing_else() {
    assert_eq!(edited(MINE, &[]), MINE);
    let both = edited(MINE, &["gap.amplitude=0.003", "material.work_of_adhesion=0.005"]);
    // A comment stays in its column.
    assert_eq!(both, MINE.replace("0.0025 ", "0.003  ").replace("=0.004#", "=0.005#"));
    // A number written differently stays as it was typed if its value is the same.
    assert_eq!(edited(MINE, &["gap.wavelength=0.05", "material.effective_modulus=1"]), MINE);
    assert_eq!(
        edited(MINE, &["title=it's \"new\""]),
        MINE.replace("'mine'", "\"it's \\\"new\\\"\"")
            .replace("\"it's \\\"new\\\"\"", &toml::Value::String("it's \"new\"".to_owned()).to_string())
            .replace("   # a title", " # a title")
    );
}

#[test]
fn what_is_not_there_is_added_to_its_table_and_what_is_gone_leaves_its_comments() {
    let sphere = edited(MINE, &["gap.shape=sphere"]);
    let expected = MINE
        .replace("\"wavy-sphere\"", "\"sphere\"")
        .replace("  amplitude = 0.0025   # A\n", "# A\n")
        .replace("wavelength = \"0.1/2\"\n", "");
    assert_eq!(sphere, expected);
    let force = edited(MINE, &["path.start_force=0.1", "basis.kind=rings", "basis.rings=50"]);
    assert!(force.contains("[path]   # first the path\n# ends early\n"), "{force}");
    assert!(force.contains("far in\nstart_force = 0.1"), "{force}");
    assert!(force.contains("# the end\n\n[basis]\nkind = \"rings\""), "{force}");
    let control = edited(MINE, &["path.control=stiffness=0.5"]);
    assert!(control.contains("# far in\ncontrol = { stiffness = 0.5 }"), "{control}");
    // Keys before all tables.
    let bare = MINE.replace("title   =   'mine'   # a title\n", "");
    let titled = edited(&bare, &["title=new"]);
    assert!(
        titled.starts_with("# My notes, 3 May.\n\n\ntitle = \"new\"\n# the bodies\n[material]"),
        "{titled}"
    );
    let unended = edited(MINE.trim_end_matches("# the end\n").trim_end(), &["gap.shape=random-waves"]);
    assert!(unended.contains("\nseed = "), "{unended}");
}

#[test]
fn dotted_keys_and_inline_tables_stay_what_they_are() {
    let dotted = "gap.shape = 'wavy-sphere' # dots\nmaterial.effective_modulus = 1\nmaterial . work_of_adhesion = 4e-3\n\
                  gap.radius_of_curvature = 1.0\ngap.amplitude = 0.0025\ngap.wavelength = 0.05\n# below\n\
                  path.start_contact_radius = 0.5\n";
    assert_eq!(edited(dotted, &["gap.amplitude=0.1"]), dotted.replace("0.0025", "0.1"));
    let sphere = edited(dotted, &["gap.shape=power-law", "path.control=force"]);
    assert!(sphere.contains("\ngap.exponent = ") && sphere.contains("\n# below\n"), "{sphere}");
    assert!(sphere.contains("path.start_contact_radius = 0.5\npath.control = \"force\""), "{sphere}");
    let inline = "gap = { shape = \"wavy-sphere\", radius_of_curvature = 1.0,  amplitude=0.0025, wavelength = 0.05 } # one\n\
                  material = { effective_modulus = 1, work_of_adhesion = 0.004 }\n\
                  path = { start_contact_radius = 0.5, control = { stiffness = 0.5 } } # line\n";
    assert_eq!(edited(inline, &["gap.amplitude=0.1"]), inline.replace("0.0025", "0.1"));
    let stiff = edited(inline, &["path.control=stiffness=0.7"]);
    assert_eq!(stiff, inline.replace("stiffness = 0.5", "stiffness = 0.7"));
    let force = edited(inline, &["path.control=force", "path.end_contact_radius=0.01"]);
    let whole =
        "path = { start_contact_radius = 0.5, control = \"force\", end_contact_radius = 0.01 } # line\n";
    assert!(force.ends_with(whole), "{force}");
    let sphere = edited(inline, &["gap.shape=sphere"]);
    assert!(sphere.starts_with("gap = { shape = \"sphere\", radius_of_curvature = 1.0"), "{sphere}");
    // A control with a table of its own becomes a word.
    let table = "[material]\neffective_modulus = 1\nwork_of_adhesion = 0.004\n[gap]\nshape = \"sphere\"\n\
                 radius_of_curvature = 1\n[path]\nstart_contact_radius = 0.5\n[path.control] # a spring\nstiffness = 0.5\n";
    let force = edited(table, &["path.control=force"]);
    assert!(force.contains("= 0.5\ncontrol = \"force\"") && force.ends_with("# a spring\n"), "{force}");
}

#[test]
fn parameters_waves_and_units_keep_their_forms() {
    let formula = &shipped("formula");
    let ranged =
        edited(formula, &["gap.parameters.A=0.003", "gap.parameters.lambda.max=0.1", "gap.parameters.R=2"]);
    assert!(ranged.contains("R = 2.0\nA = { value = 0.003, min = 0.0, max = 0.02 }\n"), "{ranged}");
    assert!(ranged.contains("lambda = { value = 0.05, max = 0.1 }"), "{ranged}");
    let sphere = edited(formula, &["gap.shape=sphere"]);
    assert!(!sphere.contains("[gap.parameters]") && sphere.contains("# The gap of Fig. 9"), "{sphere}");
    let waves = "[material]\neffective_modulus = 1\nwork_of_adhesion = 0.004\n[gap]\nshape = \"harmonics\"\n\
                 radius_of_curvature = 1\n# long\n[[gap.waves]]\namplitude = 1e-3 # a\nwavelength = 0.1\n# short\n\
                 [[gap.waves]]\nwavelength = 0.05\namplitude = 1e-4 # b\n[path]\nstart_contact_radius = 0.5\n";
    let turned = edited(waves, &["gap.waves.2.amplitude=2e-4"]);
    assert_eq!(turned, waves.replace("1e-4", "0.0002"));
    let inline = waves.replace(
        "# long\n[[gap.waves]]\namplitude = 1e-3 # a\nwavelength = 0.1\n# short\n\
        [[gap.waves]]\nwavelength = 0.05\namplitude = 1e-4 # b\n",
        "waves = [ { amplitude = 1e-3, wavelength = 0.1 } ] # all\n",
    );
    assert_ne!(inline, waves);
    let three =
        read("p", &waves.replace("[path]", "[[gap.waves]]\namplitude = 3e-5\nwavelength = 0.01\n[path]"))
            .unwrap();
    for text in [waves, &inline] {
        let more = onto(None, text, &three).unwrap();
        assert_eq!(read("p", &more).unwrap(), three, "{more}");
        let fewer = onto(None, &more, &read("p", text).unwrap()).unwrap();
        assert_eq!(read("p", &fewer).unwrap(), read("p", text).unwrap(), "{fewer}");
        assert!(
            ["# long", "# short"].iter().all(|comment| fewer.contains(comment) == text.contains(comment))
        );
    }
    // In SI values have their units, and another unit system changes every number's meaning.
    let si = &shipped("fig-9-si");
    let turned = edited(si, &["gap.amplitude=11 um"]);
    assert!(turned.lines().zip(si.lines()).filter(|(a, b)| a != b).count() == 1, "{turned}");
    let reduced = edited(si, &["units=reduced"]);
    assert!(!reduced.contains("[display]") && !reduced.contains("\nunits"), "{reduced}");
    let ours = write(&wavy());
    assert!(edited(&ours, &["units=SI"]).starts_with("# A pulloff preset. Numbers without a unit are SI.\n"));
    let open = ours.replace("end_contact_radius = 0.002", "# end_contact_radius = 0.002");
    let ended = edited(&open, &["path.end_contact_radius=0.1"]);
    assert!(ended.contains("\nend_contact_radius = 0.1"), "{ended}");
}

#[test]
fn what_follows_from_other_values_is_written_out_where_those_change() {
    let text = "[material]\neffective_modulus = 1\nwork_of_adhesion = 0.004\n[gap]\nshape = \"sphere\"\n\
                radius_of_curvature = 1 # R\n";
    let preset = read("p", text).unwrap();
    let mut wider = preset.clone();
    wider.assign("gap.radius_of_curvature", "2").unwrap();
    let edited = onto(None, text, &wider).unwrap();
    assert_eq!(read("p", &edited).unwrap(), wider, "{edited}");
    assert!(edited.contains("radius_of_curvature = 2.0 # R"), "{edited}");
}

#[test]
fn line_ends_stay_what_they_are_and_no_preset_is_no_text() {
    let crlf = MINE.replace('\n', "\r\n");
    let force = edited(&crlf, &["path.control=force", "gap.amplitude=1e-4"]);
    assert_eq!(force.matches('\n').count(), force.matches("\r\n").count());
    assert_eq!(force.matches("\r\n").count(), crlf.matches("\r\n").count() + 1);
    for text in ["rings = ", "x = 1\n[gap]\nshape = 3\n"] {
        let made = onto(None, text, &wavy());
        assert!(made.is_none_or(|made| read("p", &made).unwrap() == wavy()));
    }
}

/// The text that `write` gives, in one of the forms that a user may have written, with comments in it.
fn dressed(preset: &Preset, form: u8) -> String {
    let written = write(preset);
    if form == 2 {
        return inlined(&written);
    }
    let mut all = String::from("# head\n");
    let mut table = String::new();
    for (i, text) in written.lines().enumerate() {
        let bare = text.split(" # ").next().unwrap().trim_end();
        if bare.starts_with('#')
            || bare.is_empty()
            || (preset.title.contains('#') && bare.starts_with("title"))
        {
            continue;
        }
        let line = match (form, bare.strip_prefix('[').map(|name| name.trim_matches(['[', ']']))) {
            (1, Some(name)) if !bare.starts_with("[[") && name != "gap.parameters" => {
                table = format!("{name}.");
                continue;
            }
            (_, Some(_)) => bare.to_owned(),
            (1, None) => format!("{table}{bare}"),
            (_, None) => format!("  {bare}"),
        };
        writeln!(all, "# above {i}\n{line} # behind {i}").unwrap();
    }
    all + "# tail\n"
}

/// The text with each table on one line; where a table contains tables, the result is not TOML.
fn inlined(written: &str) -> String {
    let mut all = String::from("# head\n");
    for (i, table) in written.split("\n[").enumerate() {
        let bare = |line: &str| line.split(" # ").next().unwrap().trim_end().to_owned();
        let mut lines = table.lines().map(bare).filter(|line| !line.starts_with('#') && !line.is_empty());
        if i == 0 {
            lines.for_each(|line| writeln!(all, "{line} # behind {i}").unwrap());
        } else {
            let name = lines.next().unwrap().trim_matches(['[', ']']).to_owned();
            let keys: Vec<String> = lines.collect();
            writeln!(all, "# above {i}\n{name} = {{ {} }} # behind {i}", keys.join(", ")).unwrap();
        }
    }
    all + "# tail\n"
}

/// The comments of a text.
fn comments(text: &str) -> Vec<&str> {
    text.lines()
        .filter_map(|line| line.split("# ").nth(1))
        .map(str::trim)
        .filter(|text| ["above", "behind", "head", "tail"].iter().any(|word| text.starts_with(word)))
        .collect()
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 300, rng_seed: RngSeed::Fixed(23), failure_persistence: None, ..ProptestConfig::default()
    })]

    #[test]
    fn a_preset_laid_over_any_text_reads_back_with_all_comments(
        mut from in any_preset(), mut to in any_preset(), form in 0..3u8, same_gap in any::<bool>(),
    ) {
        // In this test, a hash in a title looks like a comment.
        from.title = from.title.replace('#', "");
        to.title = to.title.replace('#', "");
        if same_gap {
            to.gap = from.gap.clone();
            to.path = from.path;
        }
        let text = dressed(&from, form);
        // A form that is not TOML, such as a table's header below dotted keys, proves nothing.
        prop_assume!(read("p", &text).is_ok_and(|read| read == from));
        let unchanged = onto(None, &text, &from);
        prop_assert_eq!(unchanged.as_deref(), Some(&*text));
        let made = onto(None, &text, &to);
        let made = made.ok_or_else(|| TestCaseError::fail(format!("not made:\n{text}\n{}", write(&to))))?;
        prop_assert_eq!(&read("p", &made).unwrap(), &to, "{}\n{}", text, made);
        prop_assert_eq!(comments(&text), comments(&made), "{}\n{}", text, made);
        // And back again.
        let back = onto(None, &made, &from);
        prop_assert_eq!(back.map(|back| read("p", &back).unwrap()), Some(from));
    }
}
