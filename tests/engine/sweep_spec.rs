//! The spec of a sweep: what it specifies for each row, and what is wrong with a bad one.

#![allow(clippy::unwrap_used, reason = "a helper of a test fails the test by panicking")]

use pulloff::store::Store;
use pulloff::sweep::spec;
use pulloff_engine::sweep::{MOST_ROWS, Spec, SpecError};
use std::path::Path;

fn read(text: &str) -> Result<Spec, SpecError> {
    spec::read(&Store::at("presets", &[]), Path::new("."), "s.toml", text)
}

fn axis(text: &str) -> String {
    format!("preset = \"fig-9\"\n[[axis]]\n{text}")
}

/// The values of every row, as they appear in the results.
fn rows(text: &str) -> Vec<String> {
    let spec = read(text).unwrap();
    let row = |row| spec.values(row).iter().map(ToString::to_string).collect::<Vec<_>>().join(" ");
    (0..spec.rows).map(row).collect()
}

#[test]
fn values_of_every_kind() {
    let one = |text: &str| rows(&axis(text));
    assert_eq!(one("key = 'gap.amplitude'\nvalues = [1, 0.5, '1/8', 0]"), ["1.0", "0.5", "0.125", "0.0"]);
    assert_eq!(
        one("key = 'gap.wavelength'\nlinear = { from = 0.1, to = 0.3, count = 3 }"),
        ["0.1", "0.2", "0.3"]
    );
    assert_eq!(
        one("key = 'groups.adhesion'\nlogarithmic = { from = 1e-3, to = 0.1, count = 3 }"),
        ["0.001", "0.01", "0.1"]
    );
    assert_eq!(
        one("key = 'basis.rings'\nlinear = { from = 10, to = 40, count = 4 }"),
        ["10", "20", "30", "40"]
    );
    assert_eq!(
        one("key = 'path.control'\nvalues = ['force', 'displacement', 'stiffness=0.1', '2']"),
        ["force", "displacement", "stiffness=0.1", "stiffness=2"]
    );
    assert_eq!(
        one("key = 'path.control.stiffness'\nlogarithmic = { from = 1, to = 4, count = 3 }"),
        ["1.0", "2.0", "4.0"]
    );
    // The ends are exactly as typed, for descending ranges too.
    assert_eq!(one("key = 'gap.amplitude'\nlinear = { from = 0.3, to = 0.1, count = 2 }"), ["0.3", "0.1"]);
    let two = format!(
        "{}\n[[axis]]\nkey = 'gap.wavelength'\nvalues = [3, 4, 5]",
        axis("key = 'gap.amplitude'\nvalues = [1, 2]")
    );
    assert_eq!(rows(&two), ["1.0 3.0", "1.0 4.0", "1.0 5.0", "2.0 3.0", "2.0 4.0", "2.0 5.0"]);
}

#[test]
fn values_that_belong_together_are_laid_down_together() {
    // One at a time, each of the two would be refused.
    let text = r#"
        preset = "random-waves"
        combine = "pairs"
        [[axis]]
        key = "gap.longest_wavelength"
        values = [0.02, 5]
        [[axis]]
        key = "gap.shortest_wavelength"
        values = [0.01, 4]
    "#;
    let spec = read(text).unwrap();
    for (row, longest) in [(0, 0.02), (1, 5.0)] {
        assert_eq!(spec.problem(row).unwrap().get("gap.longest_wavelength"), Some(longest.into()));
    }
    // Groups are applied last, whatever the order; a shape brings its own keys.
    let text = r#"
        preset = "fig-3-jkr"
        [[axis]]
        key = "groups.amplitude_over_wavelength"
        values = [0.02]
        [[axis]]
        key = "gap.wavelength"
        values = [0.5]
        [[axis]]
        key = "gap.shape"
        values = ["wavy-sphere", "cone"]
    "#;
    let spec = read(text).unwrap();
    assert_eq!(spec.problem(0).unwrap().get("gap.amplitude"), Some(0.01.into()));
    let fault = spec.problem(1).unwrap_err();
    assert_eq!(
        fault.to_string(),
        "refused value: gap.wavelength belongs to gap.shape = wavy-sphere, and the gap is a cone"
    );
}

#[test]
#[allow(clippy::too_many_lines, reason = "a table of texts and messages")]
fn each_mistake_names_its_line_and_what_is_allowed() {
    let mut wrong = Vec::new();
    for (text, message) in [
        ("x", "s.toml:1: "),
        ("", "s.toml:1: preset is missing: it must be the name of a preset"),
        (
            "preset = 3",
            "s.toml:1: preset must be the name of a preset, or a preset file (with a '/' or ending in .toml), not 3",
        ),
        (
            "\npreset = 'wavy-spher'",
            "s.toml:2: preset: no preset is called \"wavy-spher\"; did you mean wavy-sphere?",
        ),
        ("preset = './none.toml'", "s.toml:1: preset: ./none.toml: cannot read: No such file"),
        ("preset = 'cone'\naxes = 1", "s.toml:2: unknown key axes; did you mean axis?"),
        ("preset = 'cone'", "s.toml:1: axis is missing: it must be one or more tables [[axis]]"),
        (
            "preset = 'cone'\n[ensemble]\nmembers = 9\nseed = 1",
            "s.toml:2: the members would all be the same: the preset has no gap.seed that could differ, and no axis has a distribution",
        ),
        (
            "preset = 'random-waves'\nset = ['gap.seed=1']\n[ensemble]\nmembers = 9\nseed = 1",
            "s.toml:3: the members would all be the same",
        ),
        (
            "preset = 'random-waves'\n[ensemble]\nmembers = 1\nseed = 1",
            "s.toml:3: ensemble.members = 1 is out of range: it must be a whole number from 2 to 100000",
        ),
        (
            "preset = 'random-waves'\nensemble = { members = 9 }",
            "s.toml:2: ensemble.seed is missing: it must be a whole number",
        ),
        (
            "preset = 'random-waves'\nensemble = { members = 9, seed = 1 }\nrandom = { draws = 9, seed = 1 }",
            "s.toml:2: [ensemble] draws its members itself: it cannot be combined with [random]",
        ),
        (
            "preset = 'random-waves'\nensemble = { members = 99999, seed = 1 }\n[[axis]]\nkey = 'gap.rms'\n\
             linear = { from = 0, to = 1, count = 200 }",
            "s.toml:2: 200 points x 99999 members are out of range: at most 10000000 rows",
        ),
        ("preset = 'cone'\naxis = []", "s.toml:2: axis must be one or more tables [[axis]]"),
        (
            "preset = 'wavy-sphere'\nset = ['gap.amplitude=-1']\n[[axis]]\nkey = 'gap.amplitude'\nvalues = [1]",
            "s.toml:2: --set gap.amplitude=-1: gap.amplitude = -1.0 is out of range: it must be 0 or a number from 1e-30 to 1e30",
        ),
        (
            &axis("values = [1]"),
            "s.toml:2: axis.key is missing: it must be a key of the preset, such as \"gap.amplitude\"",
        ),
        (
            &axis("key = 'gap.amplitud'\nvalues = [1]"),
            "s.toml:3: axis.key: unknown key gap.amplitud; did you mean gap.amplitude?",
        ),
        (
            &axis("key = 'groups.adhesio'\nvalues = [1]"),
            "s.toml:3: axis.key: unknown key groups.adhesio; of the groups, groups.amplitude_over_wavelength, ",
        ),
        (
            &axis("key = 'title'\nvalues = ['a']"),
            "s.toml:3: title is not a quantity of the problem: it cannot be swept",
        ),
        (
            &axis("key = 'gap.slope'\nvalues = [1]"),
            "s.toml:3: gap.slope belongs to gap.shape = cone, and the gap is a wavy-sphere",
        ),
        (
            &axis("key = 'gap.amplitude'"),
            "s.toml:3: the axis gap.amplitude must have exactly one of values, linear, logarithmic, distribution",
        ),
        (
            &axis("key = 'gap.amplitude'\nvalues = [1]\nlinear = {}"),
            "s.toml:5: the axis gap.amplitude must have exactly one of",
        ),
        (
            &axis("key = 'gap.amplitude'\nvalue = [1]"),
            "s.toml:4: unknown key axis.value; did you mean values?",
        ),
        (
            &axis("key = 'gap.amplitude'\nvalues = []"),
            "s.toml:4: axis.values of the axis gap.amplitude is empty",
        ),
        (
            &axis("key = 'gap.amplitude'\nvalues = [\n1,\n-1]"),
            "s.toml:6: gap.amplitude = -1.0 is out of range: it must be 0 or a number from 1e-30 to 1e30",
        ),
        (
            &axis("key = 'gap.amplitude'\nvalues = ['3 um']"),
            "s.toml:4: gap.amplitude: the problem is in reduced units: expected a pure number, got 3 um, a length",
        ),
        (
            &axis("key = 'gap.amplitude'\nvalues = [true]"),
            "s.toml:4: axis.values: gap.amplitude is the boolean true; write a number or a string",
        ),
        (
            &axis("key = 'path.control'\nvalues = ['forse']"),
            "s.toml:4: path.control = \"forse\" is not known",
        ),
        (&axis("key = 'basis.rings'\nvalues = [3]"), "s.toml:4: basis.rings = 3 is out of range: it must be"),
        (
            &axis("key = 'gap.amplitude'\nlinear = { from = 1, to = 2 }"),
            "s.toml:4: axis.linear.count is missing: it must be the number of values",
        ),
        (
            &axis("key = 'gap.amplitude'\nlinear = { from = 1, to = 2, count = 1 }"),
            "s.toml:4: axis.linear.count = 1 is out of range: it must be a whole number from 2 to 10000000",
        ),
        (
            &axis("key = 'gap.amplitude'\nlinear = { from = 1, to = 2, count = 2.5 }"),
            "s.toml:4: axis.linear.count must be a whole number from 2 to 10000000, not 2.5",
        ),
        (
            &axis("key = 'gap.amplitude'\nlinear = { from = 1, til = 2, count = 9 }"),
            "s.toml:4: unknown key axis.linear.til",
        ),
        (
            &axis("key = 'path.start_approach'\nlogarithmic = { from = -1, to = 2, count = 9 }"),
            "s.toml:4: axis.logarithmic.from = -1.0 is out of range: path.start_approach must be above 0 to have a logarithm",
        ),
        (
            &axis("key = 'basis.rings'\nlinear = { from = 10, to = 15, count = 4 }"),
            "s.toml:4: basis.rings takes whole numbers: 4 values in equal steps from 10 to 15 are not whole",
        ),
        (
            &axis("key = 'basis.rings'\nlogarithmic = { from = 10, to = 15, count = 4 }"),
            "s.toml:4: axis.logarithmic.from: basis.rings = 10 is not a real number",
        ),
        (
            &axis("key = 'gap.amplitude'\ndistribution = { uniform = [1, 2] }"),
            "s.toml:2: the axis gap.amplitude has a distribution: it needs [random] with draws and seed",
        ),
        (
            &format!("random = {{ draws = 3, seed = 1 }}\n{}", axis("key = 'gap.amplitude'\nvalues = [1]")),
            "s.toml:3: with [random] the axis gap.amplitude must have a distribution",
        ),
        (
            &format!(
                "combine = 'grid'\nrandom = {{ draws = 3, seed = 1 }}\n{}",
                axis("key = 'gap.amplitude'\nvalues = [1]")
            ),
            "s.toml:1: combine is for a grid or for pairs: [random] has neither",
        ),
        (
            &format!(
                "random = {{ draws = 0, seed = 1 }}\n{}",
                axis("key = 'gap.amplitude'\ndistribution = { uniform = [1, 2] }")
            ),
            "s.toml:1: random.draws = 0 is out of range: it must be a whole number from 1 to 10000000",
        ),
        (
            &format!(
                "random = {{ draws = 3 }}\n{}",
                axis("key = 'gap.amplitude'\ndistribution = { uniform = [1, 2] }")
            ),
            "s.toml:1: random.seed is missing",
        ),
        (
            &format!("combine = 'pair'\n{}", axis("key = 'gap.amplitude'\nvalues = [1]")),
            "s.toml:1: combine = \"pair\" is not known: it must be \"grid\" or \"pairs\"; did you mean pairs?",
        ),
        (
            &axis("key = 'gap.amplitude'\ndistribution = { uniform = [2, 1] }"),
            "s.toml:4: axis.distribution.uniform: 2.0 is not below 1.0",
        ),
        (
            &axis("key = 'gap.amplitude'\ndistribution = { uniform = [2] }"),
            "s.toml:4: axis.distribution.uniform must be two values, [from, to], not an array of 1",
        ),
        (
            &axis("key = 'gap.amplitude'\ndistribution = { log-uniform = [0, 1] }"),
            "s.toml:4: axis.distribution.log-uniform = 0.0 is out of range",
        ),
        (
            &axis("key = 'gap.amplitude'\ndistribution = { gauss = 1 }"),
            "s.toml:4: unknown key axis.distribution.gauss",
        ),
        (
            &axis("key = 'gap.amplitude'\ndistribution = { normal = { mean = 1, deviation = 0 } }"),
            "s.toml:4: axis.distribution.normal.deviation = 0.0 is out of range: it must be above 0",
        ),
        (
            &axis("key = 'basis.rings'\ndistribution = { uniform = [10, 20] }"),
            "s.toml:4: axis.distribution.uniform: basis.rings = 10 is not a real number",
        ),
        (
            &axis("key = 'gap.amplitude'\ndistribution = { integers = [3, 2] }"),
            "s.toml:4: axis.distribution.integers: 3 is above 2",
        ),
        (
            &format!(
                "{}\n[[axis]]\nkey = 'gap.amplitude'\nvalues = [2]",
                axis("key = 'gap.amplitude'\nvalues = [1]")
            ),
            "s.toml:5: the axis gap.amplitude conflicts with the axis gap.amplitude",
        ),
        (
            &format!(
                "{}\n[[axis]]\nkey = 'path.start_force'\nvalues = [2]",
                axis("key = 'path.start_approach'\nvalues = [1]")
            ),
            "s.toml:5: the axis path.start_force conflicts with the axis path.start_approach",
        ),
        // The group would win, and the column of the other give a value that no row has.
        (
            &format!(
                "{}\n[[axis]]\nkey = 'gamma'\nvalues = [0.002]",
                axis("key = 'groups.adhesion'\nvalues = [0.02]")
            ),
            "s.toml:5: the axis material.work_of_adhesion conflicts with the axis groups.adhesion",
        ),
        (
            &format!("{}\n[[axis]]\nkey = 'A/λ'\nvalues = [0.02]", axis("key = 'A'\nvalues = [0.002]")),
            "s.toml:5: the axis groups.amplitude_over_wavelength conflicts with the axis gap.amplitude",
        ),
        (
            &format!(
                "combine = 'pairs'\n{}\n[[axis]]\nkey = 'gap.wavelength'\nvalues = [2]",
                axis("key = 'gap.amplitude'\nvalues = [1, 2]")
            ),
            "s.toml:6: pairs need axes of equal length: gap.wavelength has 1 values, gap.amplitude has 2",
        ),
        (
            &format!(
                "{}\n[[axis]]\nkey = 'gap.wavelength'\nlinear = {{ from = 1, to = 2, count = 5001 }}",
                axis("key = 'gap.amplitude'\nlinear = { from = 1, to = 2, count = 2000 }")
            ),
            "s.toml:5: 2000 x 5001 rows are out of range: at most 10000000",
        ),
        (
            &format!("quantities = []\n{}", axis("key = 'gap.amplitude'\nvalues = [1]")),
            "s.toml:1: quantities is empty",
        ),
        (
            &format!("quantities = ['snap']\n{}", axis("key = 'gap.amplitude'\nvalues = [1]")),
            "s.toml:1: quantities: no quantity is called \"snap\"; did you mean snaps?",
        ),
        (
            &format!("quantities = ['snaps',\n'snaps']\n{}", axis("key = 'gap.amplitude'\nvalues = [1]")),
            "s.toml:2: quantities: snaps is listed twice",
        ),
    ] {
        let found = match read(text) {
            Ok(_) => "nothing wrong".to_owned(),
            Err(error) => error.to_string(),
        };
        if !found.starts_with(message) || found.lines().count() != 1 {
            wrong.push(format!("{text}\n  {found}\n  {message}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n\n"));
    assert_eq!(MOST_ROWS, 10_000_000);
}

#[test]
fn the_identity_is_that_of_what_is_computed() {
    let base = axis("key = 'gap.amplitude'\nvalues = [0.001, 0.002]");
    let identity = |text: &str| spec::identity(&read(text).unwrap());
    assert_eq!(identity(&base).len(), 64);
    let same = base.replace("0.001", "1e-3").replace("[[axis]]", "combine = 'grid' # as it is\n[[axis]]");
    assert_eq!(identity(&same), identity(&base));
    for other in [
        base.replace("0.001", "0.0011"),
        base.replace("fig-9", "wavy-sphere"),
        format!("combine = 'pairs'\n{base}"),
        format!("quantities = ['snaps']\n{base}"),
        format!("set = ['gap.wavelength=0.06']\n{base}"),
    ] {
        assert_ne!(identity(&other), identity(&base), "{other}");
    }
    // A measured profile is identified by its data, not by its name.
    let profile = "preset = 'profile'\n[[axis]]\nkey = 'material.work_of_adhesion'\nvalues = [0.01]";
    assert!(spec::canonical(&read(profile).unwrap()).contains("\ndata = [\""));
}

#[test]
fn a_value_of_set_that_no_row_has_is_refused() {
    for (set, axis, words) in [
        (
            "gap.amplitude=0.001",
            "gap.amplitude",
            "set gives gap.amplitude a value that no row uses: the axis gap.amplitude",
        ),
        ("gap={amplitude=0.001}", "gap.amplitude", "set gives gap.amplitude a value"),
        ("path.start_approach=0.1", "path.start_contact_radius", "set gives path.start_approach a value"),
        ("path.control=force", "path.control.stiffness", "set gives path.control a value"),
        ("path.control={stiffness=2}", "path.control.stiffness", "set gives path.control.stiffness a value"),
        ("groups.adhesion=0.01", "material.work_of_adhesion", "set gives groups.adhesion a value"),
        ("gap.wavelength=0.1", "groups.wavelength_over_radius", "set gives gap.wavelength a value"),
    ] {
        let text = |set: &str| {
            format!(
                "preset = 'fig-9'\nset = [\n'basis.rings=50',\n'{set}']\n[[axis]]\nkey = '{axis}'\nvalues = [0.1]"
            )
        };
        let refused = read(&text(set)).unwrap_err().to_string();
        assert!(refused.starts_with(&format!("s.toml:4: {words}")), "{set}: {refused}");
        assert!(refused.ends_with("gives every row its own; remove one of them"), "{refused}");
        // Without the assignment the sweep is fine.
        read(&text("title=x")).unwrap();
    }
    // A value that a group holds, or is computed from, has an effect.
    for (set, axis) in [
        ("gap.wavelength=0.1", "groups.amplitude_over_wavelength"),
        ("groups.amplitude_over_wavelength=0.1", "gap.wavelength"),
        ("groups.amplitude_over_wavelength=0.1", "groups.wavelength_over_radius"),
        ("gap.radius_of_curvature=2", "groups.adhesion"),
    ] {
        let text = format!("preset = 'fig-9'\nset = ['{set}']\n[[axis]]\nkey = '{axis}'\nvalues = [0.02]");
        read(&text).unwrap();
    }
}
