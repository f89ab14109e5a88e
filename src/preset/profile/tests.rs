//! Good files, bad files and files damaged at random.

use super::*;
use proptest::prelude::*;

/// Ten rows of a paraboloid, parted by `separator`.
fn rows(separator: &str) -> String {
    let row =
        |i: u8| [0.5 * f64::from(i), 0.1 * f64::from(i * i)].map(|x| x.to_string()).join(separator) + "\n";
    (0..10).map(row).collect()
}

fn good(text: &str) -> Columns {
    parse(text.as_bytes()).unwrap()
}

fn refused(text: &str) -> String {
    parse(text.as_bytes()).unwrap_err().to_string()
}

fn names(columns: &Columns) -> [Option<&str>; 2] {
    [columns.units[0].as_deref(), columns.units[1].as_deref()]
}

#[test]
fn every_separator_gives_the_same_columns() {
    let reference = good(&rows(","));
    assert_eq!((reference.radii.len(), reference.radii[9], reference.gaps[9]), (10, 4.5, 8.1));
    assert!(reference.notes.is_empty() && reference.units == [None, None]);
    for separator in [";", "\t", " ", "   ", " , ", "; ", " \t "] {
        assert_eq!(good(&rows(separator)), reference, "{separator:?}");
    }
    for text in [
        format!("\u{feff}{}", rows(",")),
        rows(",").replace('\n', "\r\n"),
        format!("# one\n% two\n// three\n\nr,h\n{}\n   \n# end", rows(",")),
        rows(",").replace("0.5,0.1\n", "\"0.5\" , \"0.1\"\n"),
    ] {
        assert_eq!(good(&text), reference, "{text:?}");
    }
}

#[test]
fn units_come_from_the_header_or_from_a_remark_that_names_both() {
    let micro_nano = [Some("um"), Some("nm")];
    for (header, units) in [
        ("r [um], h (nm)", micro_nano),
        ("r [um]; h (nm)", micro_nano),
        ("r[um] h[nm]", micro_nano),
        ("r [um] h (nm)", micro_nano),
        ("r (um)\th (nm)", micro_nano),
        ("radius,gap", [None, None]),
        ("radius (um), gap", [Some("um"), None]),
        ("r [um, rounded], h [nm]", [Some("um, rounded"), Some("nm")]),
        ("r [], h [nm]", [None, Some("nm")]),
        ("# r [um], h [nm]", micro_nano),
        ("# made by hand\n# r [um] h [nm]", micro_nano),
        ("# r [um], h", [None, None]),
    ] {
        for separator in [",", " ", "\t", ";"] {
            let columns = good(&format!("{header}\n{}", rows(separator)));
            assert_eq!(names(&columns), units, "{header:?} {separator:?}");
        }
    }
    // A remark between or below the rows is none.
    assert_eq!(names(&good(&format!("{}# r [um], h [nm]\n", rows(",")))), [None, None]);
}

#[test]
fn units_become_factors() {
    let columns = good(&format!("r [um], h [nm]\n{}", rows(",")));
    let factor = |unit: &str| match unit {
        "um" => Some(2.0_f64.powi(-20)),
        "nm" => Some(2.0_f64.powi(-30)),
        _ => None,
    };
    let scaled = columns.clone().in_units(factor).unwrap();
    let nine = (scaled.radii[9], scaled.gaps[9]);
    assert_eq!(nine, (4.5 * 2.0_f64.powi(-20), 8.1 * 2.0_f64.powi(-30)));
    let error = columns.in_units(|unit| (unit == "um").then_some(1.0)).unwrap_err();
    assert_eq!(error.to_string(), "the unit \"nm\" of the gap is not known");
}

#[test]
fn order_and_repetition_are_put_right_with_a_note() {
    let reference = good(&rows(","));
    let reversed: String = rows(",").lines().rev().flat_map(|line| [line, "\n"]).collect();
    let sorted = good(&reversed);
    assert_eq!((&sorted.radii, &sorted.gaps), (&reference.radii, &reference.gaps));
    assert_eq!(sorted.notes.len(), 1);
    let twice = good(&format!("{}{}", rows(","), rows(",")));
    assert_eq!((&twice.radii, &twice.gaps), (&reference.radii, &reference.gaps));
    assert_eq!(twice.notes[1], "10 rows were there twice and count once");
}

#[test]
fn every_fault_has_its_line() {
    let with = |line: &str| refused(&format!("{}{line}\n", rows(",")));
    assert_eq!(with("9,"), "line 11: the gap is missing");
    assert_eq!(with(",9"), "line 11: the radius is missing");
    assert_eq!(with("9"), "line 11: the gap is missing");
    assert_eq!(with("9,9,9"), "line 11: has 3 cells, and a row has two: radius and gap");
    assert_eq!(with("9,abc"), "line 11: the gap \"abc\" is no number");
    assert_eq!(with("nan,1"), "line 11: the radius \"nan\" is out of range: it must be at most 1e30 in size");
    assert!(with("9,-inf").contains("out of range") && with("9,1e31").contains("out of range"));
    assert_eq!(with("-1,1"), "line 11: the radius -1.0 is negative: radii count from the axis");
    assert_eq!(with("1,7"), "line 11: the radius 1.0 has another gap in line 3");
    assert_eq!(with("1\u{1b}[2J,7"), "line 11: holds control or invisible characters");
    assert_eq!(with(&"1".repeat(2000)), "line 11: has 2000 bytes, more than the 1024 of a row");
    assert!(
        refused("0;0\n1,5;2\n").contains("line 2: the radius \"1,5\" is no number (decimals have a point)")
    );
    // A first line that was to be a row is not swallowed as a header.
    assert!(refused(&format!("1.0, abc\n{}", rows(","))).starts_with("line 1: "));
    assert!(refused(&format!("abc, 1.0\n{}", rows(","))).starts_with("line 1: "));
    assert!(refused(&format!("r,h\nr,h\n{}", rows(","))).starts_with("line 2: "));
}

#[test]
fn faults_are_listed_in_order_up_to_a_number() {
    let text = format!("0,9\n{}{}0,8\n", rows(","), "x,y\n".repeat(30));
    let error = refused(&format!("r,h\n{text}"));
    let lines: Vec<&str> = error.lines().collect();
    assert_eq!(lines.len(), FAULTS_SHOWN + 1);
    assert!(lines[0].starts_with("line 3: the radius 0.0 has another gap in line 2"), "{error}");
    assert!(lines[1].starts_with("line 13: "));
    assert_eq!(lines[FAULTS_SHOWN], "and 12 more");
}

#[test]
fn too_few_and_no_text_are_refused() {
    for text in ["", "r,h\n", "# nothing", "\u{feff}"] {
        assert_eq!(refused(text), "has 0 rows, and a profile has 8 to 1000000");
    }
    assert!(refused("0,0\n1,1\n").starts_with("has 2 rows"));
    assert_eq!(parse(b"0,0\n1,1\n\xff\xfe,2\n"), Err(TextError::NotText(3)));
    assert!(parse(&[0; 5000]).unwrap_err().to_string().starts_with("line 1: "));
}

#[test]
fn files_are_regular_and_named_in_errors() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("profile.csv");
    std::fs::write(&path, rows(",")).unwrap();
    assert_eq!(read_profile(&path).unwrap().0, good(&rows(",")));
    std::fs::write(&path, "0,0\n").unwrap();
    assert!(
        read_profile(&path)
            .unwrap_err()
            .to_string()
            .ends_with("profile.csv: has 1 rows, and a profile has 8 to 1000000")
    );
    assert!(
        read_profile(folder.path()).unwrap_err().to_string().ends_with("is a folder, not a regular file")
    );
}

proptest! {
    /// Whatever is done to a good file, the answer is a sound profile or an error that names lines.
    #[test]
    fn damage_is_reported_and_never_panics(
        separator in prop::sample::select(vec![",", ";", "\t", " "]),
        damage in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>(), 0..4_u8), 1..12),
    ) {
        let mut bytes = format!("r [um]{separator}h [nm]\n{}", rows(separator)).into_bytes();
        for (place, byte, kind) in damage {
            if bytes.is_empty() {
                break;
            }
            let at = place.index(bytes.len());
            match kind {
                0 => bytes[at] = byte,
                1 => bytes.insert(at, byte),
                2 => drop(bytes.remove(at)),
                _ => bytes.truncate(at),
            }
        }
        match parse(&bytes) {
            Ok(columns) => {
                prop_assert!(ROW_RANGE.contains(&columns.radii.len()));
                prop_assert_eq!(columns.radii.len(), columns.gaps.len());
                prop_assert!(columns.radii.is_sorted_by(|a, b| a < b) && columns.radii[0] >= 0.0);
                prop_assert!(columns.gaps.iter().all(|h| h.is_finite()));
            }
            Err(error) => {
                let text = error.to_string();
                prop_assert!(text.contains("line ") || text.contains("rows"));
                prop_assert!(!text.chars().any(|c| c != '\n' && is_unsafe(c)), "{}", text);
            }
        }
    }
}
