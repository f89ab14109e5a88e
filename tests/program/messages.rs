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
    for amplitude in ["1e10", "1e20", "1e30"] {
        let ended = home.run(&["cycle", "--set", &format!("gap.amplitude={amplitude}")]);
        assert!(!ended.err.contains("must lie outside"), "{amplitude}: {}", ended.err);
        assert!(
            ended.status <= 2 && (ended.status == 0 || ended.out.is_empty()),
            "{amplitude}: {}",
            ended.err
        );
    }
}
