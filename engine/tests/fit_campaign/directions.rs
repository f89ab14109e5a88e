//! The directions in which the columns of made curves run: found from their rows, whatever is flipped.

use super::campaign::{all, asked, wanted};
use super::kinds::{Kind, Made, any_retraction};
use super::trial::{made, options, preset};
use pulloff_engine::fit::{Options, doubt_of_wave, fit};
use pulloff_engine::measured::{Asked, Points};
use pulloff_engine::progress::Unwatched;
use std::ops::Range;

/// A retraction alone, of any kind.
static ANY: Kind = Kind { name: "retraction of any kind", is_model: true, make: any_retraction };

/// The kinds whose rows show in which direction their columns run, and whether their x is turned.
fn directed() -> impl Iterator<Item = (&'static Kind, bool)> {
    // Contact radii run in one direction only.
    const WITHOUT: [&str; 5] = ["P(s)", "ends at the last contact", "Hertz", "cone", "punch"];
    let has = |kind: &&Kind| wanted(kind) && !WITHOUT.iter().any(|without| kind.name.contains(without));
    all().into_iter().chain([&ANY]).filter(has).map(|kind| (kind, kind.name.starts_with("x turned")))
}

/// The share of sets, with both columns in each of their directions, for which the direction is found and no other is
/// thought as likely.
fn directions(numbers: &Range<u64>) -> Vec<String> {
    let mut failures = Vec::new();
    for (kind, is_turned) in directed() {
        let (mut wrong, mut doubtful, mut sets) = (0, 0, 0);
        for number in numbers.clone() {
            let preset = preset(&made(kind, number));
            let points = preset.data.source.as_ref().unwrap().points(&preset.reading()).unwrap();
            for flipped in [[false, false], [true, false], [false, true], [true, true]] {
                let flip = |of: &[f64], is: bool| of.iter().map(|x| if is { -x } else { *x }).collect();
                let points = Points {
                    x: flip(&points.x, flipped[0]),
                    force: flip(&points.force, flipped[1]),
                    ..points.clone()
                };
                let truth = [flipped[0] != is_turned, flipped[1]];
                sets += 1;
                match points.branches(&Asked::default()) {
                    Ok(found) if found.or.is_some() => {
                        doubtful += 1;
                        println!("  {number} {flipped:?}: {:?} or {:?}", found.turned, found.or);
                    }
                    Ok(found) if found.turned == truth => {}
                    other => {
                        wrong += 1;
                        if wrong < 4 {
                            println!(
                                "  {number} {flipped:?}: {:?}",
                                other.map(|found| (found.turned, found.notes))
                            );
                        }
                    }
                }
            }
        }
        println!("{}: {wrong} of {sets} wrong, {doubtful} doubtful", kind.name);
        if wrong > 0 {
            failures.push(format!("{}: {wrong} of {sets} directions are wrong", kind.name));
        }
    }
    failures
}

#[test]
fn columns_that_run_the_other_way_are_turned_or_in_doubt() {
    let failures = directions(&asked(0..10));
    assert!(failures.is_empty(), "{failures:#?}");
}

/// A retraction in contact from the first row to the last: read backwards, each snap looks like the jump to rows apart.
#[test]
fn a_contact_that_snaps_is_not_read_backwards() {
    let made = Made {
        text: include_str!("minima/whole.csv").to_owned(),
        preset: include_str!("minima/snaps.toml").to_owned(),
        free: Vec::new(),
        truth: Vec::new(),
    };
    let preset = preset(&made);
    let points = preset.data.source.as_ref().unwrap().points(&preset.reading()).unwrap();
    let branches = points.branches(&Asked::default()).unwrap();
    assert_eq!(branches.turned, [false, false], "{:?}", branches.notes);
    let apart: usize = branches.list.iter().map(|branch| branch.free.len()).sum();
    let said = doubt_of_wave(&preset, &branches).unwrap();
    assert!(said.starts_with(&format!("{apart} rows taken to be apart")) && apart < 20, "{said}");
}

#[test]
fn of_two_directions_in_doubt_the_one_that_fits_is_taken() {
    let text = include_str!("minima/named.csv");
    let free = vec!["E*", "gamma", "data.offset"];
    let made = Made {
        text: text.to_owned(),
        preset: include_str!("minima/named.toml").to_owned(),
        free,
        truth: Vec::new(),
    };
    let preset = preset(&made);
    let points = preset.data.source.as_ref().unwrap().points(&preset.reading()).unwrap();
    assert!(points.branches(&Asked::default()).unwrap().or.is_some(), "it is in no doubt");
    let options = options(&made.free);
    let said = Asked { turned: Some([false, false]), ..options.asked };
    let right = fit(&preset, &points, &Options { asked: said, ..options.clone() }, &Unwatched).unwrap();
    let found = fit(&preset, &points, &options, &Unwatched).unwrap();
    assert_eq!(found.verdict, right.verdict);
    for (a, b) in found.parameters.iter().zip(&right.parameters) {
        assert!((a.value / b.value - 1.0).abs() < 1e-6, "{a:?} {b:?}");
    }
    let tells = |note: &String| note.contains("with x=+,force=+ chi squared is ") && note.contains("--signs");
    assert!(found.notes.iter().any(tells), "{:?}", found.notes);
}
