//! Good files, bad files and files damaged at random.

use super::*;
use crate::gap::Gap;
use crate::gap::{shapes::ProfileGap, shapes::Smoothing};
use crate::text::{NotText, is_unsafe};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

/// Ten rows of a paraboloid, separated by `separator`.
fn rows(separator: &str) -> String {
    let row =
        |i: u8| [0.5 * f64::from(i), 0.1 * f64::from(i * i)].map(|x| x.to_string()).join(separator) + "\n";
    (0..10).map(row).collect()
}

fn good(text: &str) -> ProfileColumns {
    parse(text.as_bytes()).unwrap()
}

fn refused(text: &str) -> String {
    parse(text.as_bytes()).unwrap_err().to_string()
}

fn names(columns: &ProfileColumns) -> [Option<&str>; 2] {
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
    // A remark between or below the rows is not a header.
    assert_eq!(names(&good(&format!("{}# r [um], h [nm]\n", rows(",")))), [None, None]);
}

#[test]
fn units_of_length_stand_behind_a_slash_or_a_space_too() {
    for (header, units) in [
        ("radius / um, height / nm", [Some("um"), Some("nm")]),
        ("r/um,h/nm", [Some("um"), Some("nm")]),
        ("radius µm, \"height nm\"", [Some("µm"), Some("nm")]),
        // Ratios, and words that are not units.
        ("r/R,h/R", [None, None]),
        ("the radius, the gap", [None, None]),
        ("um, nm", [None, None]),
    ] {
        assert_eq!(names(&good(&format!("{header}\n{}", rows(",")))), units, "{header:?}");
    }
}

#[test]
fn columns_that_their_header_names_the_other_way_round_are_refused() {
    for header in ["h [nm],r [um]", "Height / nm, Radius / um", "z,x"] {
        let said = refused(&format!("{header}\n{}", rows(",")));
        assert!(said.contains("a profile has the radius first"), "{header}: {said}");
    }
    // Unknown names mean nothing.
    good(&format!("depth of the scan,length\n{}", rows(",")));
}

#[test]
fn gaps_become_lengths_in_the_unit_of_the_radii() {
    for (header, unit, factor) in [
        ("r [um], h [nm]", "um", 1e-3),
        ("r [µm], h [Å]", "um", 1e-4),
        ("r [micron], h [\u{3bc}m]", "micron", 1.0),
        ("r [mm], h [m]", "mm", 1e3),
        ("r / in, h / mm", "in", 1.0 / 25.4),
        ("r nm, h nm", "nm", 1.0),
    ] {
        let (columns, found) = good(&format!("{header}\n{}", rows(","))).in_one_unit().unwrap();
        assert_eq!(found.unwrap().ascii(), unit, "{header}");
        assert_eq!(columns.radii, good(&rows(",")).radii);
        assert!((columns.gaps[9] / (8.1 * factor) - 1.0).abs() < 1e-15, "{header}: {}", columns.gaps[9]);
    }
    let bare = good(&rows(","));
    assert_eq!(bare.clone().in_one_unit().unwrap(), (bare, None));
}

#[test]
fn units_that_are_no_lengths_and_missing_ones_are_refused_by_name_with_their_line() {
    for (header, said) in [
        ("r [um], h [N]", "line 1: the unit \"N\" of the gap is a force, not a length"),
        ("r [foo], h [nm]", "line 1: the unit \"foo\" of the radius is not known"),
        ("# mine\nr [um], h [um^2]", "line 2: the unit \"um^2\" of the gap is an area, not a length"),
        ("\n# r [s], h [nm]", "line 2: the unit \"s\" of the radius is a time, not a length"),
        ("r [um], h", "line 1: the header gives the radius in um but no unit for the gap: write both"),
        ("r, h [nm]", "line 1: the header gives the gap in nm but no unit for the radius: write both"),
        ("r / um, h", "line 1: the header gives the radius in um but no unit for the gap: write both"),
    ] {
        let error = good(&format!("{header}\n{}", rows(","))).in_one_unit().unwrap_err().to_string();
        assert!(error.starts_with(said), "{header}: {error}");
    }
}

#[test]
fn decimals_may_have_a_comma_where_no_comma_separates_cells() {
    for separator in [";", "; ", "\t"] {
        let read = good(&rows(separator).replace('.', ","));
        let with_points = good(&rows(separator));
        assert_eq!((read.radii, read.gaps), (with_points.radii, with_points.gaps), "{separator:?}");
        assert_eq!(read.notes, ["decimals are written with a comma: 0,1 is read as 0.1"]);
        assert_eq!(with_points.notes, [""; 0]);
    }
}

/// Rows at these radii.
fn at(radii: impl Iterator<Item = f64>) -> String {
    radii.map(|r| format!("{r},{}\n", r * r)).collect::<Vec<_>>().concat()
}

#[test]
fn a_profile_without_its_centre_is_refused() {
    let radii = |first: f64| (0..20).map(move |i| first + 0.1 * f64::from(i));
    for first in [0.0, 0.05, 0.1] {
        good(&at(radii(first)));
    }
    let said = refused(&format!("r,h\n{}", at(radii(0.15))));
    let expected = "line 2: the smallest radius is 0.15, and the rows after it are at most 0.1";
    assert!(said.starts_with(expected), "{said}");
    // The line is that of the smallest radius, wherever that is.
    let said = refused(&at((3..23).rev().map(f64::from)));
    assert!(said.starts_with("line 20: the smallest radius is 3.0"), "{said}");
    // If the radii are uneven, the widest of the first distances counts.
    good(&at((0..20).map(|i| 0.3 + 0.1 * f64::from(i * i))));
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
    assert_eq!(twice.notes[1], "10 rows were listed twice and counted once");
    let once = good(&format!("{}{}\n", rows(","), rows(",").lines().next().unwrap()));
    assert_eq!(once.notes.last().unwrap(), "1 row was listed twice and counted once");
}

#[test]
fn every_fault_has_its_line() {
    let with = |line: &str| refused(&format!("{}{line}\n", rows(",")));
    assert_eq!(with("9,"), "line 11: the gap is missing");
    assert_eq!(with(",9"), "line 11: the radius is missing");
    assert_eq!(with("9"), "line 11: the gap is missing");
    assert_eq!(with("9,9,9"), "line 11: has 3 cells, and a row has two: radius and gap");
    assert_eq!(with("9,abc"), "line 11: the gap \"abc\" is not a number");
    assert_eq!(
        with("nan,1"),
        "line 11: the radius \"nan\" is out of range: it must be a number from -1e30 to 1e30"
    );
    assert!(with("9,-inf").contains("out of range") && with("9,1e31").contains("out of range"));
    assert_eq!(
        with("-1,1"),
        "line 11: the radius -1.0 is negative: radii are measured from the axis, so first fold a scan over \
         the whole diameter there"
    );
    assert_eq!(with("1,7"), "line 11: the radius 1.0 has a different gap in line 3");
    assert_eq!(with("1\u{1b}[2J,7"), "line 11: holds control or invisible characters");
    assert_eq!(with(&"1".repeat(3000)), "line 11: has 3000 bytes, more than the 2048 allowed");
    assert!(refused("0;0\n1,5;2\n2.5;3\n").starts_with(
        "line 3: \"2.5\" has a point, and line 2 has a number with a comma: one of them separates thousands"
    ));
    // A first line that was meant to be a row is not swallowed as a header.
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
    assert!(lines[0].starts_with("line 3: the radius 0.0 has a different gap in line 2"), "{error}");
    assert!(lines[1].starts_with("line 13: "));
    assert_eq!(lines[FAULTS_SHOWN], "and 29 more");
}

#[test]
fn too_few_and_no_text_are_refused() {
    for text in ["", "r,h\n", "# nothing", "\u{feff}"] {
        assert_eq!(refused(text), "has 0 rows, and a profile has 8 to 1000000");
    }
    assert!(refused("0,0\n1,1\n").starts_with("has 2 rows"));
    assert_eq!(parse(b"0,0\n1,1\n\0,2\n"), Err(TextError::NotText(NotText::Zero(3))));
    assert!(parse(&[0; 5000]).unwrap_err().to_string().starts_with("line 1: "));
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 512, rng_seed: RngSeed::Fixed(11), failure_persistence: None, ..ProptestConfig::default()
    })]

    /// Whatever is done to a good file, the result is a sound profile or an error that names lines.
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
        sound_or_refused(&bytes);
    }

    /// Whole rows duplicated, moved, cut short, or with a cell that no instrument wrote.
    #[test]
    fn damaged_rows_are_reported_and_never_panic(
        separator in prop::sample::select(vec![",", ";", "\t", " "]),
        damage in prop::collection::vec((any::<prop::sample::Index>(), any::<prop::sample::Index>(), 0..6_u8), 1..8),
    ) {
        let mut lines: Vec<String> = rows(separator).lines().map(str::to_owned).collect();
        for (place, other, kind) in damage {
            let [at, to] = [place, other].map(|index| index.index(lines.len()));
            let line = lines[at].clone();
            let cell = CELLS[other.index(CELLS.len())];
            let (radius, gap) = line.split_once(separator).unwrap_or((&line, ""));
            match kind {
                0 => lines.insert(to, line),
                1 => lines.swap(at, to),
                2 => lines[at] = line.chars().take(other.index(line.chars().count() + 1)).collect(),
                3 => lines[at] = format!("{cell}{separator}{line}"),
                4 => lines[at] = format!("{radius}{separator}{cell}"),
                _ => lines[at] = format!("{cell}{separator}{gap}"),
            }
        }
        sound_or_refused(lines.join("\n").as_bytes());
    }
}

/// Cells that no instrument wrote: huge and tiny numbers, foreign digits, directional marks, units, formulas.
const CELLS: &[&str] = &[
    "1e30",
    "1e29",
    "-1e30",
    "1e308",
    "1e999",
    "-1e999",
    "1e-300",
    "1e-999",
    "5e-324",
    "0",
    "-0",
    "nan",
    "inf",
    "0x10",
    "1_000",
    "1,5",
    "٣",
    "３",
    "½",
    "−1",
    "1e５",
    "\u{202e}1",
    "1\u{200b}",
    "\u{feff}1",
    "\u{a0}1",
    "e\u{301}",
    "🦀",
    "\u{0}",
    "\u{7}",
    "\u{1b}[2J",
    "\u{2028}",
    "\"",
    "\"1",
    "1 um",
    "=1+1",
    "#",
    "//",
    "",
    "99999999999999999999999999999999",
];

/// Sound columns, from which a gap is made or refused with a reason; or an error that names lines.
fn sound_or_refused(bytes: &[u8]) {
    let columns = match parse(bytes) {
        Ok(columns) => columns,
        Err(error) => {
            let text = error.to_string();
            let is_no_text = matches!(error, TextError::NotText(_));
            assert!(is_no_text || text.contains("line ") || text.contains("rows"), "{text}");
            assert!(!text.chars().any(|c| c != '\n' && is_unsafe(c)), "{text:?}");
            return;
        }
    };
    assert!(ROW_RANGE.contains(&columns.radii.len()) && columns.radii.len() == columns.gaps.len());
    assert!(columns.radii.is_sorted_by(|a, b| a < b) && columns.radii[0] >= 0.0);
    assert!(columns.gaps.iter().all(|h| h.is_finite()));
    for smoothing in [Smoothing::None, Smoothing::Auto, Smoothing::Cutoff(1.0)] {
        match ProfileGap::new(&columns.radii, &columns.gaps, smoothing) {
            Ok(profile) => {
                let known = profile.largest_radius().unwrap();
                for share in [0.0, 1e-9, 0.3, 0.999] {
                    let jet = profile.jet(share * known);
                    let finite = [jet.value, jet.first, jet.second].iter().all(|x| x.is_finite());
                    assert!(finite, "{jet:?} {columns:?}");
                }
                assert!(profile.feature_length().is_none_or(|length| length > 0.0));
            }
            Err(error) => assert!(!error.to_string().is_empty()),
        }
    }
}
