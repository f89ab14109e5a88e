//! Files good, bad and damaged; signs, branches, noise.

mod forms;
mod free_part;

use super::points::MeasuredPoint;
use super::*;
use crate::gap::shapes::split_mix::SplitMix64;
use crate::problem::Control;
use crate::progress::Unwatched;
use crate::report::pull::{AskedPulls, MomentRow, PullReport};
use crate::units::{DisplayUnits, UnitSystem};
use std::f64::consts::TAU;
use std::fmt::Write;

fn si() -> UnitSystem {
    UnitSystem::Si(DisplayUnits::default())
}

/// A JKR curve of E* = R = 1, γ = 0.01 by s: approach from δ = −0.1 to 0.05 and back, as rows (δ, P, is retraction).
fn jkr(noise: f64) -> Vec<(f64, f64, bool)> {
    let gamma = 0.01;
    let mut random = SplitMix64::new(3);
    let mut normal = move || (0..12).map(|_| random.unit()).sum::<f64>() - 6.0;
    let state = |s: f64| {
        let root = (TAU * gamma * s).sqrt();
        (s * s - root, 4.0 / 3.0 * s * s * s - 2.0 * s * root)
    };
    let mut rows = Vec::new();
    let attached = |delta: f64| {
        let (mut lo, mut hi) = (0.128, 1.0);
        for _ in 0..60 {
            let middle = 0.5 * (lo + hi);
            if state(middle).0 > delta { hi = middle } else { lo = middle }
        }
        state(lo).1
    };
    for i in 0..=300 {
        let delta = -0.1 + 0.0005 * f64::from(i);
        let force = if delta < 0.0 { 0.0 } else { attached(delta) };
        rows.push((delta, force + noise * normal(), false));
    }
    for i in 0..=300 {
        let delta = 0.05 - 0.0005 * f64::from(i);
        let force = if delta < -0.0735 { 0.0 } else { attached(delta) };
        rows.push((delta, force + noise * normal(), true));
    }
    rows
}

fn csv(rows: &[(f64, f64, bool)]) -> String {
    rows.iter().fold("delta, force, segment\n".to_owned(), |mut text, (x, p, back)| {
        writeln!(text, "{x:?},{p:?},{back}").unwrap();
        text
    })
}

fn branches(text: &str) -> Result<Branches, BranchError> {
    let measured = parse(text.as_bytes(), &ColumnSpec::default()).unwrap();
    measured.points(&UnitSystem::Reduced, Some(1.0)).unwrap().branches(&Asked::default())
}

/// x and P of all points.
fn strip(list: &[MeasuredBranch]) -> Vec<[f64; 2]> {
    list.iter().flat_map(|b| b.attached.iter().chain(&b.free)).map(|p| [p.x, p.force]).collect()
}

#[test]
fn every_separator_unit_and_name_gives_the_same_points() {
    let rows = jkr(0.0);
    for (header, separator) in [
        ("indentation [um], Force (nN)", ", "),
        ("delta/um\tload/nN", "\t"),
        ("\"depth\" [um];F [nN]", ";"),
        ("# displacement [um] force [nN]", "  "),
    ] {
        let text = rows.iter().fold(format!("% a remark\n\n{header}\n"), |mut text, (x, p, _)| {
            writeln!(text, "{x:?}{separator}{p:?}").unwrap();
            text
        });
        let measured = parse(text.as_bytes(), &ColumnSpec::default()).unwrap();
        let points = measured.points(&si(), None).unwrap();
        assert_eq!(points.abscissa, Abscissa::Approach, "{header}");
        assert!((points.x[0] + 1e-7).abs() < 1e-20 && (points.force[300] - 1e-9 * rows[300].1).abs() < 1e-20);
        let refused = measured.points(&UnitSystem::Reduced, None).unwrap_err().to_string();
        assert!(refused.contains("has a unit, um, and the problem is in reduced units"), "{refused}");
    }
}

#[test]
fn a_tab_file_states_its_spring_and_its_segments() {
    let mut text = "# BEGIN METADATA\n# {\n#   \"spring constant\": 0.043,\n#   \"speed\": [1, 2]\n# }\n# END METADATA\n#\n\
                    # force\theight (measured)\theight (piezo)\tindex\tsegment\n"
        .to_owned();
    for (i, (x, p, back)) in jkr(1e-5).iter().enumerate() {
        let p = 1e-3 * p;
        let z = -(x + p / 0.043);
        writeln!(text, "{p:e}\t{z:e}\t{z:e}\t{i}\t{}", if *back { "True" } else { "False" }).unwrap();
    }
    let measured = parse(text.as_bytes(), &ColumnSpec::default()).unwrap();
    let spring = measured.stiffness.map(|stated| stated.value);
    assert_eq!(spring, Some(0.043));
    assert!(measured.notes[0].contains("columns 2 and 3 both hold the position: the first is read"));
    let points = measured.points(&si(), spring).unwrap();
    assert_eq!(points.abscissa, Abscissa::Position);
    let branches = points.branches(&Asked::default()).unwrap();
    assert_eq!(branches.turned, [true, false], "heights fall as the tip comes down: {:?}", branches.notes);
    assert_eq!(branches.list.len(), 2);
    assert!(matches!(measured.points(&si(), None), Err(PointsError::NoSpring("position"))));
    let both = points::stiffness(measured.stiffness, Control::Stiffness(0.05), &si()).unwrap_err();
    assert!(both.to_string().contains("path.control.stiffness is 0.05 N/m"), "{both}");
    assert_eq!(points::stiffness(measured.stiffness, Control::Displacement, &si()), Ok(Some(0.043)));
}

#[test]
fn the_free_part_the_jump_and_the_noise_are_found() {
    for segments in [true, false] {
        let mut text = csv(&jkr(1e-4));
        if !segments {
            text = text.lines().map(|line| line.rsplit_once(',').unwrap().0.to_owned() + "\n").collect();
        }
        let found = branches(&text).unwrap();
        let [approach, retraction] = &found.list[..] else { panic!("{:?}", found.notes) };
        assert_eq!((approach.segment, retraction.segment), (Segment::Approach, Segment::Retraction));
        assert_eq!(approach.free.len(), 200);
        let apart = 300 - jkr(0.0)[301..].iter().take_while(|(x, ..)| *x >= -0.0735).count() + 1;
        assert_eq!(retraction.free.len(), apart);
        assert!((found.noise.sigma[1] / 1e-4 - 1.0).abs() < 0.2, "{:?}", found.noise);
        assert!(found.baseline.unwrap().abs() < 3e-5);
        assert!(
            found.noise.from[1] == Origin::Apart && found.noise.from[0] == Origin::Assumed,
            "{:?}",
            found.noise
        );
    }
}

#[test]
fn a_word_in_the_first_row_is_no_header() {
    let text = format!("delta [mm],force [mN]\n0.1,abc\n{}", "0.2,0.3\n".repeat(20));
    let error = parse(text.as_bytes(), &ColumnSpec::default()).unwrap_err().to_string();
    assert_eq!(error, "line 2: \"abc\" is not a number, in a row of numbers");
    // Separated thousands are not another header above the rows below a thousand.
    let text = format!("segment;force;delta\n{}retract;900,0;4.6\n", "retract;1.900,0;4.6\n".repeat(20));
    let rows = format!("{text}{}", "retract;800,0;4.6\n".repeat(9));
    let error = parse(rows.as_bytes(), &ColumnSpec::default()).unwrap_err().to_string();
    assert!(
        error.ends_with("\"1.900,0\" is not a number, in a row of numbers: thousands must not be separated"),
        "{error}"
    );
    // A row in which nothing was measured is no header either.
    let rows = "0.1,0.3\n0.2,0.4\n".repeat(10);
    assert!(parse(format!("delta,force\nnan,nan\n{rows}").as_bytes(), &ColumnSpec::default()).is_ok());
}

/// Where δ is least it changes as little as the position of bodies apart, and noise moves the force.
#[test]
fn columns_in_their_places_do_not_look_swapped_however_noisy_they_are() {
    for seed in 0..120 {
        let mut random = fastrand::Rng::with_seed(seed);
        let mut normal = move || (0..12).map(|_| random.f64()).sum::<f64>() - 6.0;
        let noise = [0.005, 0.01, 0.02][(seed % 3) as usize];
        let row = |i: usize| {
            let s = 2.2 - 2.0 * i as f64 / 59.0;
            (s * s - 0.6 * s.sqrt(), s.powi(3) - 1.2 * s.powf(1.5))
        };
        let most = row(0).1;
        let rows: Vec<_> = (0..60).map(|i| (row(i).0, row(i).1 + noise * most * normal(), true)).collect();
        assert!(branches(&csv(&rows)) != Err(BranchError::Swapped), "{seed}");
    }
}

#[test]
fn flipped_signs_are_turned_and_said_and_swapped_columns_refused() {
    let rows = jkr(1e-4);
    for (sx, sp) in [(1.0, 1.0), (-1.0, 1.0), (1.0, -1.0), (-1.0, -1.0)] {
        let turned: Vec<_> = rows.iter().map(|(x, p, back)| (sx * x, sp * p, *back)).collect();
        let found = branches(&csv(&turned)).unwrap();
        assert_eq!(found.turned, [sx < 0.0, sp < 0.0], "{:?}", found.notes);
        assert_eq!(found.notes.len(), usize::from(sx < 0.0) + usize::from(sp < 0.0));
        let right = branches(&csv(&rows)).unwrap();
        assert!(strip(&found.list) == strip(&right.list));
    }
    let swapped: Vec<_> = rows.iter().map(|(x, p, back)| (*p, *x, *back)).collect();
    assert!(branches(&csv(&swapped)) == Err(BranchError::Swapped));
    // With noise, too, the force of bodies apart stays constant.
    let noisy: Vec<_> = jkr(5e-4).iter().map(|(x, p, back)| (*p, *x, *back)).collect();
    assert!(branches(&csv(&noisy)) == Err(BranchError::Swapped));
    // Who names the columns is believed, and told.
    let said = ColumnSpec::parse("approach=1,force=2").unwrap();
    let points = parse(csv(&swapped).as_bytes(), &said).unwrap().points(&UnitSystem::Reduced, None).unwrap();
    let told = points.branches(&Asked::default()).unwrap().swapped().unwrap();
    assert!(told.ends_with("look swapped; they are read as specified"), "{told}");
}

#[test]
fn a_record_that_ends_at_its_last_contact_keeps_its_signs() {
    // Pulled without a moment of rest or of bodies apart, at any speed and from any contact.
    let text = |columns: [bool; 2], start: f64, rate: f64, reversed: bool| {
        let preset = format!(
            "format = 1\ntitle = \"pull\"\n[material]\neffective_modulus = 1.0\nwork_of_adhesion = 0.001\n[gap]\n\
             shape = \"sphere\"\nradius_of_curvature = 1.0\n[edge]\nexponent = 0.5\n[path]\n\
             start_contact_radius = {start}\nrate = {rate}\n"
        );
        let preset = crate::preset::read("pull", &preset).unwrap();
        let report = PullReport::compute(&preset, &AskedPulls::default(), &Unwatched).unwrap();
        let run = &report.runs[0];
        let last = run.last_contact.as_ref().unwrap().time;
        let moments: Vec<_> = run.moments.iter().filter(|at| at.contact_radius > 0.0).collect();
        let at = |t: f64, of: fn(&MomentRow) -> f64| {
            let next = moments.partition_point(|at| at.time < t).clamp(1, moments.len() - 1);
            let [a, b] = [moments[next - 1], moments[next]];
            of(a) + (of(b) - of(a)) * (t - a.time) / (b.time - a.time)
        };
        let [with_radius, with_segment] = columns;
        let mut text = "time,approach,force".to_owned();
        text += if with_radius { ",contact radius" } else { "" };
        text += if with_segment { ",segment\n" } else { "\n" };
        for i in 0..300 {
            let t = last * 0.999 * f64::from(i) / 299.0;
            let sign = if reversed { -1.0 } else { 1.0 };
            let [x, p, s] =
                [|at: &MomentRow| at.approach, |at: &MomentRow| at.force, |at: &MomentRow| at.contact_radius]
                    .map(|of| at(t, of));
            let _ = write!(text, "{t:e},{:e},{p:e}", sign * x);
            if with_radius {
                let _ = write!(text, ",{s:e}");
            }
            text += if with_segment { ",retraction\n" } else { "\n" };
        }
        text
    };
    for start in [0.1, 0.15, 0.2, 0.4] {
        for rate in [1e-4, 1e-2, 1.0, 10.0] {
            for columns in [[false, false], [true, false], [false, true]] {
                let measured = |reversed| {
                    let text = text(columns, start, rate, reversed);
                    let measured = parse(text.as_bytes(), &ColumnSpec::default()).unwrap();
                    measured.points(&UnitSystem::Reduced, None).unwrap().branches(&Asked::default()).unwrap()
                };
                let found = measured(false);
                assert_eq!(found.turned, [false; 2], "{start} {rate} {columns:?} {:?}", found.notes);
                if columns != [false; 2] {
                    let found = measured(true);
                    assert_eq!(found.turned, [true, false], "{start} {rate} {columns:?} {:?}", found.notes);
                }
            }
        }
    }
}

#[test]
fn an_unordered_file_is_refused_and_one_with_segments_read_backwards_is_the_same() {
    let mut rows = jkr(1e-4);
    let right = branches(&csv(&rows)).unwrap();
    rows.reverse();
    let back = branches(&csv(&rows)).unwrap();
    assert!(strip(&right.list) == strip(&back.list));
    assert_eq!(right.noise, back.noise);
    let mut random = SplitMix64::new(9);
    for i in (1..rows.len()).rev() {
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "an index below the length"
        )]
        rows.swap(i, (random.unit() * (i + 1) as f64) as usize);
    }
    assert!(matches!(branches(&csv(&rows)), Err(BranchError::Unordered { .. })));
    let measured = parse(csv(&rows).as_bytes(), &ColumnSpec::default()).unwrap();
    let asked = Asked { sigma: [Some(1e-5), Some(1e-4), None], ..Asked::default() };
    let shuffled = measured.points(&UnitSystem::Reduced, None).unwrap().branches(&asked).unwrap();
    assert!(strip(&right.list) == strip(&shuffled.list));
}

#[test]
fn what_a_person_says_of_columns_is_read_or_refused() {
    let text = "a b c\n".to_owned() + &"1 2 3\n2 3 5\n".repeat(6);
    let unknown = parse(text.as_bytes(), &ColumnSpec::default()).unwrap_err().to_string();
    // b and c mean nothing; a alone is a radius.
    assert!(unknown.starts_with("line 1: there is no column for the force"), "{unknown}");
    let spec = ColumnSpec::parse("x=c, force=2 [nN]").unwrap();
    let measured = parse(text.as_bytes(), &spec).unwrap();
    assert_eq!(measured.columns[0].values[..2], [3.0, 5.0]);
    assert_eq!(measured.columns[1].unit.as_ref().unwrap().ascii(), "nN");
    for (said, expected) in [
        ("x", "\"x\" is not of the form ROLE=COLUMN"),
        ("forse=1", "did you mean force?"),
        ("x=0", "columns are counted from 1"),
        ("x=1,approach=2", "approach is given twice"),
        ("force=1 [um]", "the unit \"um\" of force is not a unit of force"),
    ] {
        let message = ColumnSpec::parse(said).unwrap_err().to_string();
        assert!(message.contains(expected), "{said}: {message}");
    }
    for (said, expected) in [
        ("x=9,force=1", "no column 9: a row has 3"),
        ("x=q,force=1", "no column \"q\"; the columns are \"a\""),
    ] {
        let message = parse(text.as_bytes(), &ColumnSpec::parse(said).unwrap()).unwrap_err().to_string();
        assert!(message.contains(expected), "{said}: {message}");
    }
}

#[test]
fn two_hundred_broken_files_are_a_sentence_each() {
    let good = csv(&jkr(1e-4)[..40]);
    let damage: [(&str, &str); 10] = [
        ("x", "column 1: the approach \"x\" is not a number"),
        ("1,5e", "has 4 cells, and the first row has 3"),
        ("1.5e", "is not a number"),
        ("1..5", "is not a number"),
        ("5 V", "is not a number"),
        ("+-1", "is not a number"),
        ("1\u{202e}2", "holds control or invisible characters"),
        ("1;2", "is not a number"),
        ("0x10", "is not a number"),
        ("--3", "is not a number"),
    ];
    let mut told = 0;
    for line in 0..20 {
        for (cell, expected) in damage {
            let lines: Vec<&str> = good.lines().collect();
            let rest = lines[line + 2].split_once(',').unwrap().1;
            let bad = format!("{cell},{rest}");
            let text = lines[..line + 2]
                .iter()
                .copied()
                .chain([bad.as_str()])
                .chain(lines[line + 3..].iter().copied());
            let text: Vec<&str> = text.collect();
            let message = parse(text.join("\n").as_bytes(), &ColumnSpec::default()).unwrap_err().to_string();
            assert!(
                message.starts_with(&format!("line {}: ", line + 3)) && message.contains(expected),
                "{message}"
            );
            assert!(!message.contains('\n'));
            told += 1;
        }
    }
    assert_eq!(told, 200);
    // Whatever the bytes, there is an answer.
    let mut random = SplitMix64::new(1);
    for _ in 0..2000 {
        let mut bytes = good.clone().into_bytes();
        for _ in 0..3 {
            let bits = random.bits();
            let at = usize::try_from(bits >> 16).unwrap_or(0) % bytes.len();
            bytes[at] = bits.to_le_bytes()[0];
        }
        if let Ok(measured) = parse(&bytes, &ColumnSpec::default())
            && let Ok(points) = measured.points(&UnitSystem::Reduced, Some(1.0))
        {
            let _ = points.branches(&Asked::default());
        }
    }
    for (text, expected) in [
        (&b"1 2\n\0\n"[..], "line 2: holds a zero byte"),
        (b"PK\x03\x04", "read in Python with pulloff.read_afm(path)"),
        (b"", "has 0 rows of numbers, and a measured curve has 8 to 1000000"),
        (b"1\n2\n", "1 columns without a header"),
        (b"1 2 3\n", "3 columns without a header"),
        (b"delta [nN], force\n1,2\n", "the unit \"nN\" of approach is not a unit of length"),
    ] {
        let message = parse(text, &ColumnSpec::default()).unwrap_err().to_string();
        assert!(message.contains(expected), "{message}");
    }
}

/// The rows of approach and retraction side by side, as some microscopes write them.
fn side_by_side(rows: &[(f64, f64, bool)], head: &str) -> String {
    let [up, down] = [false, true].map(|back| rows.iter().filter(move |row| row.2 == back));
    up.zip(down).fold(head.to_owned(), |mut text, (a, b)| {
        writeln!(text, "{:?},{:?},{:?},{:?}", a.0, a.1, b.0, b.1).unwrap();
        text
    })
}

#[test]
fn branches_beside_each_other_are_two_segments() {
    let rows = jkr(2e-5);
    let whole = branches(&csv(&rows)).unwrap();
    for head in [
        "Extend Z,Extend Force,Retract Z,Retract Force\n",
        "Force-Distance Curve\nFile Format:    3\n\nDate:    Wednesday, August 1, 2018\nX, um:    27.25\n\nExtend \
         Z-Sense,Extend Force,Retract Z-Sense,Retract Force\n",
        "z (approach),force (approach),z (retraction),force (retraction)\n",
    ] {
        let found = branches(&side_by_side(&rows, head)).unwrap();
        assert_eq!(strip(&found.list), strip(&whole.list), "{head}");
        assert!(found.notes.is_empty(), "{:?}", found.notes);
    }
    // The shorter side has empty cells; the stiffness stands above it.
    let mut text = side_by_side(
        &rows,
        "Force Constant, nN/nm: 0.25\nExtend Z (nm),Extend Force (nN),Retract Z (nm),Retract Force (nN)\n",
    );
    text.push_str("0.06,0.1,,\n");
    let measured = parse(text.as_bytes(), &ColumnSpec::default()).unwrap();
    assert_eq!(measured.stiffness.map(|stated| stated.value), Some(0.25));
    assert_eq!(measured.columns[0].values.len(), rows.len() + 1);
    assert_eq!(measured.segments.unwrap().iter().filter(|of| **of == Segment::Approach).count(), 302);
    assert!(measured.notes[0].starts_with("columns 1 and 2 are the approach, 3 and 4 the retraction"));
    // Half of one side is a row without a force. Units that differ are refused, because it is unclear what is meant.
    text.push_str("0.06,0.1,0.3,\n");
    let half = parse(text.as_bytes(), &ColumnSpec::default()).unwrap();
    assert_eq!((half.skipped, half.columns[0].values.len()), (1, rows.len() + 2));
    let mixed = side_by_side(&rows, "Extend Z (nm),Extend Force (nN),Retract Z (um),Retract Force (nN)\n");
    assert!(parse(mixed.as_bytes(), &ColumnSpec::default()).unwrap_err().to_string().contains("--columns"));
}

#[test]
fn a_profile_that_is_offered_as_a_curve_is_told_where_it_belongs() {
    for header in ["r [um], h [nm]", "r, h", "radius, height", "x [um], z [nm]"] {
        let text = format!("{header}\n") + &"1, 2\n".repeat(10);
        let refused = parse(text.as_bytes(), &ColumnSpec::default()).unwrap_err().to_string();
        assert!(refused.contains("line 1") && refused.contains("a profile belongs in gap.file"), "{refused}");
        let said = ColumnSpec::parse("x=1 [um],force=2 [nN]").unwrap();
        let is_read = parse((format!("{header}\n") + &"1, 2\n".repeat(10)).as_bytes(), &said).is_ok();
        assert!(is_read, "{header}");
    }
    // A contact radius and no force lacks the force.
    for header in ["time [s], contact radius [um]", "approach [um], contact radius [um]"] {
        let text = format!("{header}\n") + &"1, 2\n".repeat(10);
        let refused = parse(text.as_bytes(), &ColumnSpec::default()).unwrap_err().to_string();
        assert!(refused.contains("no column for the force"), "{refused}");
    }
}

#[test]
fn decimals_with_a_comma_and_units_below_the_header_are_read() {
    let rows = jkr(2e-5);
    let text = rows.iter().fold("delta;force;segment\n(um);(nN);\n".to_owned(), |text, (x, p, back)| {
        text + &format!("{x:?};{p:?};{back}\n").replace('.', ",")
    });
    let measured = parse(text.as_bytes(), &ColumnSpec::default()).unwrap();
    let same = measured.columns[1].values.iter().zip(&rows).all(|(p, row)| p.total_cmp(&row.1).is_eq());
    assert!(
        same && measured.notes == ["decimals are written with a comma: 0,1 is read as 0.1"],
        "{:?}",
        measured.notes
    );
    assert_eq!(measured.columns[1].unit.as_ref().unwrap().ascii(), "nN");
    let deflection = "Z position [nm]\tvDeflection [nN]\n".to_owned() + &"1\t2\n".repeat(10);
    let measured = parse(deflection.as_bytes(), &ColumnSpec::default()).unwrap();
    assert_eq!(
        [measured.columns[0].role, measured.columns[1].role],
        [ColumnRole::Position, ColumnRole::Force]
    );
}

#[test]
fn rows_that_are_shuffled_stay_and_those_in_no_order_are_not_called_swapped() {
    let mut rows = jkr(2e-5);
    let whole = branches(&csv(&rows)).unwrap();
    let mut random = SplitMix64::new(5);
    for i in (1..rows.len()).rev() {
        rows.swap(i, usize::try_from(random.bits() % (i as u64 + 1)).unwrap());
    }
    let text = csv(&rows);
    assert!(matches!(branches(&text), Err(BranchError::Unordered { .. })), "{:?}", branches(&text));
    let measured = parse(text.as_bytes(), &ColumnSpec::default()).unwrap();
    let points = measured.points(&UnitSystem::Reduced, None).unwrap();
    let sigma = [Some(whole.noise.sigma[0]), Some(whole.noise.sigma[1]), None];
    let found = points.branches(&Asked { sigma, ..Asked::default() }).unwrap();
    assert_eq!(strip(&found.list), strip(&whole.list));
}

/// A length that is not used beside force and radius may be the approach under a name that is not known.
#[test]
fn a_column_that_may_be_the_approach_is_named() {
    let notes = |head: &str| {
        let rows = (0..30).map(|i| f64::from(30 - i)).fold(format!("{head}\n"), |mut text, s| {
            writeln!(text, "{},{},{s}", s * s, s * s * s - 20.0 * s).unwrap();
            text
        });
        parse(rows.as_bytes(), &ColumnSpec::default()).unwrap().notes.join("; ")
    };
    for head in ["x_mm,F_mN,a_um", "x (mm),force (mN),contact radius (um)"] {
        let told = notes(head);
        assert!(told.contains("column 1, \"x"), "{told}");
        assert!(told.contains("data.columns \"approach=1,"), "{told}");
    }
    assert_eq!(notes("delta (mm),force (mN),contact radius (um)"), "");
    assert_eq!(notes("voltage (V),force (mN),contact radius (um)"), "");
}

/// The rows of [`jkr`] with their times, one millisecond apart, in this order.
fn timed(order: impl Iterator<Item = usize>, clock: impl Fn(usize) -> String) -> String {
    let rows = jkr(1e-4);
    order.fold("delta,force,time (ms)\n".to_owned(), |mut text, i| {
        let (x, p, _) = rows[i];
        writeln!(text, "{x:?},{p:?},{}", clock(i)).unwrap();
        text
    })
}

#[test]
fn times_are_read_in_seconds_and_tell_the_order() {
    let read =
        |text: &str| parse(text.as_bytes(), &ColumnSpec::default()).unwrap().points(&si(), None).unwrap();
    let ms = |i: usize| format!("{}", 3 * i + 100);
    let right = read(&timed(0..602, ms));
    let time = right.time.as_ref().unwrap();
    assert!((time[0] - 0.1).abs() < 1e-12 && (time[601] - 1.903).abs() < 1e-12, "{} {}", time[0], time[601]);
    let expected = right.branches(&Asked::default()).unwrap();
    assert!(
        expected
            .list
            .iter()
            .flat_map(|b| &b.attached)
            .all(|p| (p.time - 1e-3 * (3 * p.row + 97) as f64).abs() < 1e-12)
    );
    // With the retraction before the approach, or with rows in no order at all, sorting by time gives the right order.
    for order in [(301..602).chain(0..301).collect::<Vec<_>>(), (0..602).map(|i| i * 101 % 602).collect()] {
        let points = read(&timed(order.iter().copied(), ms));
        let found = points.branches(&Asked::default()).unwrap();
        assert!(found.notes[0].contains("in the order of their times"), "{:?}", found.notes);
        assert_eq!(found.noise, expected.noise);
        for (found, expected) in found.list.iter().zip(&expected.list) {
            let ats = |of: &[MeasuredPoint]| of.iter().map(|p| (p.at, p.time.to_bits())).collect::<Vec<_>>();
            assert_eq!(ats(&found.attached), ats(&expected.attached));
            assert_eq!(ats(&found.free), ats(&expected.free));
            assert!(
                found.attached.iter().all(|p| order[p.row - 1] == p.at - 1),
                "rows stay those of the file"
            );
        }
    }
}

#[test]
fn times_that_tell_nothing_are_left_out() {
    let read = |text: &str| parse(text.as_bytes(), &ColumnSpec::default()).unwrap();
    // A time of day, and one that is missing in some rows.
    for clock in [
        |i: usize| format!("14:23:{:02}", i % 60),
        |i: usize| if i == 7 { String::new() } else { i.to_string() },
    ] {
        let measured = read(&timed(0..602, clock));
        assert!(
            measured
                .notes
                .iter()
                .any(|note| note.contains("column 3 is a time, but not a number in every row"))
        );
        assert_eq!(measured.lines.len(), 602, "no row is lost");
        assert_eq!(measured.points(&si(), None).unwrap().time, None);
    }
    // A time that starts again with the retraction leaves the order as it is, and applies within each branch.
    let points = read(&timed(0..602, |i| (i % 301).to_string())).points(&si(), None).unwrap();
    let found = points.branches(&Asked::default()).unwrap();
    assert!(!found.notes.iter().any(|note| note.contains("times")), "{:?}", found.notes);
    assert!(found.list.iter().flat_map(|b| &b.attached).all(|p| p.at == p.row && p.time.is_finite()));
    // A time that the user names must be present.
    let spec = ColumnSpec::parse("x=1,force=2,time=3 [ms]").unwrap();
    let gap = timed(0..602, |i| if i == 7 { "x".to_owned() } else { i.to_string() });
    let refused = parse(gap.as_bytes(), &spec).unwrap_err().to_string();
    assert!(refused.contains("line 9: column 3: the time \"x\" is not a number"), "{refused}");
    let wrong = ColumnSpec::parse("x=1,force=2,time=3 [nm]").unwrap_err().to_string();
    assert!(wrong.contains("is not a unit of time"), "{wrong}");
    // In reduced units a time with a unit is dropped, and one without is used.
    let text = timed(0..602, |i| i.to_string());
    assert_eq!(read(&text).points(&UnitSystem::Reduced, None).unwrap().time, None);
    let text = text.replace(" (ms)", "");
    let time = read(&text).points(&UnitSystem::Reduced, None).unwrap().time.unwrap();
    assert_eq!(time[5].to_bits(), 5.0_f64.to_bits());
}
