//! The program's messages about a problem: in its own terms, and no more than is worth saying.

use crate::support::home::Home;

/// The shipped profile, copied with its rows, is the same problem, with a message about the units of its lengths.
#[test]
fn a_copy_of_the_shipped_profile_is_the_same_problem() {
    let home = Home::new();
    let shipped = home.quiet(&["presets", "show", "profile"]);
    home.file("mine.toml", &shipped.replace("shipped:rough-sphere.csv", "rows.csv"));
    home.file("rows.csv", include_str!("../../presets/data/rough-sphere.csv"));
    let (own, theirs) = (home.run(&["unload", "mine.toml"]), home.run(&["unload", "profile"]));
    assert_eq!((own.status, theirs.status), (0, 0), "{}", own.err);
    assert_eq!(own.out, theirs.out);
    assert!(own.err.contains("rows.csv: names um as the unit of its radii"), "{}", own.err);
    assert!(!theirs.err.contains("as the unit"), "{}", theirs.err);
}

/// What is subtracted on the axis is reported where it is more than rounding.
#[test]
fn rounding_on_the_axis_is_no_news() {
    let home = Home::new();
    let of = |formula: &str| {
        let set = format!("gap.formula={formula}");
        let ended = home.run(&["unload", "formula", "--set", &set]);
        assert_eq!(ended.status, 0, "{formula}: {}", ended.err);
        ended.err.contains("on the axis: this is subtracted")
    };
    assert!(of("r^2/2 + 1e-3"));
    assert!(!of("r^2/2 - 1.03e-204"));
    assert!(!of("r^2/2 + (0.1 + 0.2 - 0.3)"));
}

/// Waves higher than any number can resolve are refused in terms of the problem.
#[test]
fn a_gap_of_any_height_has_no_message_from_inside() {
    let home = Home::new();
    for amplitude in ["1e15", "1e20", "1e30"] {
        let ended = home.run(&["cycle", "--set", &format!("gap.amplitude={amplitude}")]);
        assert!(!ended.err.contains("must lie outside"), "{amplitude}: {}", ended.err);
        assert!(
            ended.status <= 2 && (ended.status == 0 || ended.out.is_empty()),
            "{amplitude}: {}",
            ended.err
        );
    }
}

/// The theory is for small slopes, and waves may be steeper than that.
#[test]
fn steep_waves_are_told() {
    let home = Home::new();
    for (amplitude, is_told) in [("0.0025", false), ("0.01", true)] {
        let ended = home.run(&["unload", "wavy-sphere", "--set", &format!("gap.amplitude={amplitude}")]);
        assert_eq!(ended.status, 0, "{}", ended.err);
        assert_eq!(ended.err.contains("the gap has slopes up to 1.6: "), is_told, "{}", ended.err);
    }
}

/// A path that starts closer than the largest pull says so; one that starts further out does not.
#[test]
fn a_start_beyond_the_largest_pull_is_told() {
    let home = Home::new();
    let told = |radius: &str| {
        let start = format!("path.start_contact_radius={radius}");
        let ended = home.run(&["unload", "lens", "--set", "data.file=none", "--set", &start]);
        assert_eq!(ended.status, 0, "{}", ended.err);
        ended.err.contains("start further out than ")
    };
    assert!(told("20um") && !told("100um"));
    for (start, is_told) in [("0.3", true), ("0.4", false)] {
        let start = format!("path.start_contact_radius={start}");
        let sets = [
            "gap.amplitude=0",
            "gamma=0.0101",
            "material.adhesion=dugdale",
            "material.cohesive_strength=1.83",
            &start,
        ];
        let with = sets.iter().flat_map(|set| ["--set", set]);
        let ended = home.run(&["unload", "wavy-sphere"].into_iter().chain(with).collect::<Vec<_>>());
        assert_eq!(ended.err.contains("larger contacts pull more"), is_told, "{start}: {}", ended.err);
    }
    // Nothing is told of a start that is exactly the one asked for.
    let ended = home.run(&["unload", "fig-1-hertz"]);
    assert!(
        !ended.err.contains("is unstable") && !ended.out.contains("is unstable"),
        "{}{}",
        ended.out,
        ended.err
    );
}

/// Of values given together, the refusal is that of all of them.
#[test]
fn values_given_together_are_refused_together() {
    let home = Home::new();
    home.file(
        "all.pulloff",
        "open fig-3-jkr\nset material.adhesion=dugdale material.cohesive_strength=0.177\n",
    );
    let ended = home.run(&["run", "all.pulloff"]);
    assert!(ended.status == 2 && ended.err.contains("basis"), "{}", ended.err);
    let lens = "set data.file=none gap.radius_of_curvature=\"5 mm\" path.control=displacement";
    home.file("lens.pulloff", &format!("open lens\n{lens}\n"));
    assert_eq!(home.run(&["run", "lens.pulloff"]).status, 0);
}

/// Gaps that only rise may be steep too, and so may some rows of a sweep.
#[test]
fn steep_gaps_are_told_in_sweeps_too() {
    let home = Home::new();
    let ended = home.run(&["unload", "cone", "--set", "slope=5"]);
    assert!(ended.err.contains("the gap has slopes up to 5: "), "{}", ended.err);
    // However narrow the steep place is.
    let narrow = "gap.formula=r^2/2+0.002*tanh((r-0.3)/1e-4)";
    let ended = home.run(&["trace", "formula", "--set", narrow]);
    assert!(ended.err.contains("the gap has slopes up to 20: "), "{}", ended.err);
    let axis = |to: &str| {
        format!(
            "preset='wavy-sphere'\nquantities=['start_contact_radius']\n[[axis]]\nkey='gap.amplitude'\nvalues=[0, {to}]"
        )
    };
    home.file("steep.toml", &axis("0.01"));
    let ended = home.run(&["sweep", "steep.toml", "-o", "r.csv"]);
    let told = "in 1 of 2 rows the gap is too steep, with slopes of up to 1.62 at gap.amplitude = 0.01: ";
    assert!(ended.err.contains(told), "{}", ended.err);
    home.file("small.toml", &axis("0.001"));
    let ended = home.run(&["sweep", "small.toml", "-o", "s.csv"]);
    assert!(!ended.err.contains("slopes"), "{}", ended.err);
}

/// The gap is a length: a parameter of a formula has no mass or time that no other parameter takes away.
#[test]
fn a_parameter_of_a_formula_has_a_unit_that_a_gap_can_have() {
    let home = Home::new();
    let preset = |formula: &str, parameters: &str| {
        format!(
            "units = \"SI\"\n[material]\neffective_modulus = \"1 MPa\"\nwork_of_adhesion = \"50 mJ/m^2\"\n[gap]\nshape = \
             \"formula\"\nformula = \"{formula}\"\n[gap.parameters]\n{parameters}\n[path]\nstart_contact_radius = \"80 um\"\n"
        )
    };
    home.file("wrong.toml", &preset("r^2/(2*R)", "R = \"3.2 mN\""));
    let expected = "wrong.toml:9: gap.parameters.R: expected a length or another quantity without mass and time, since the gap \
                    is a length, got 3.2 mN, a force";
    home.refused(&["unload", "wrong.toml"], &[expected]);
    // A drop of a liquid under a pressure has a radius of 2 gamma/p.
    let drop = preset("r^2*p/(4*G)", "p = \"45 Pa\"\nG = \"72 mN/m\"");
    for (name, text) in [("right.toml", preset("r^2/(2*R)", "R = \"3.2 mm\"")), ("drop.toml", drop)] {
        home.file(name, &text.replace("80 um", "300 um"));
        home.quiet(&["unload", name]);
    }
}

/// What a command leaves out is told: the speed of an edge plays no part in a path.
#[test]
fn a_path_says_that_it_has_no_speed() {
    let home = Home::new();
    let said = |command: &str, set: &str| home.quiet(&[command, "wavy-sphere", "--set", set]);
    for command in ["unload", "cycle"] {
        assert!(said(command, "edge.exponent=0.6").contains("plays no part here"), "{command}");
        assert!(!said(command, "gap.amplitude=0.002").contains("plays no part here"), "{command}");
    }
}

/// Every key can be found without the explorer, and is named where one is not known.
#[test]
fn all_keys_are_listed() {
    let home = Home::new();
    let all = home.quiet(&["presets", "keys"]);
    for key in
        ["edge.exponent  (n edge)", "gap.waves.N.phase", "groups.adhesion", "path.steps", "data.offset"]
    {
        assert!(all.lines().any(|line| line.starts_with(key)), "{key}: {all}");
    }
    let some = home.quiet(&["presets", "keys", "edge."]);
    assert!(
        some.lines().step_by(2).all(|line| line.starts_with("edge.")) && some.lines().count() > 4,
        "{some}"
    );
    home.refused(&["presets", "keys", "egde"], &["no key begins with egde"]);
    home.refused(
        &["unload", "--set", "xyzzy.foo=1"],
        &["unknown key xyzzy.foo; pulloff presets keys lists all"],
    );
}
