//! Tests of fits in which an edge is pinned between two works of adhesion.

use super::problem::START;
use super::tests::{Body, E, Normal, SPHERE, W, close, noisy, preset, run, sphere};
use super::*;
use crate::measured::{Asked, Points, Segment};
use crate::preset::edge::CLOSING_ADHESION;
use crate::preset::{Value, data};
use crate::progress::Unwatched;

/// The contact radius at which the edge turns.
const MOST: f64 = 1.6;

/// A loop on a sphere with E* = 1.3 whose closing edge gains 0.01 and whose opening edge costs 0.03.
fn pinned() -> Points {
    between([0.01, 0.03])
}

/// The same with these works of adhesion.
fn between(works: [f64; 2]) -> Points {
    let [advancing, receding] = works.map(|w| sphere(1.3, w, 2.0));
    let mut points = Body { state: &advancing, compliance: 0.0, most: MOST }.samples(600);
    let down = Body { state: &receding, compliance: 0.0, most: MOST };
    let ((top, pressed), (turned, _)) = (advancing(MOST), receding(MOST));
    let last = down.way(down.fold());
    // Back from the turn along dP/dδ = 2E*s at its radius, then with the larger work.
    for i in 0..300 {
        let x = top + (i as f64 + 0.5) / 300.0 * 1.4 * (last - top);
        let force = if x > turned {
            pressed + 2.0 * 1.3 * MOST * (x - top)
        } else {
            down.radius(x).map_or(0.0, |s| receding(s).1)
        };
        (points.x[300 + i], points.force[300 + i]) = (x, force);
    }
    let mut normal = Normal::new(4);
    points.force.iter_mut().for_each(|p| *p += 5e-4 * normal.next());
    points
}

#[test]
fn an_edge_is_pinned_between_two_works_of_adhesion() {
    let points = pinned();
    let free = [E, W, CLOSING_ADHESION].map(str::to_owned).to_vec();
    let options = Options { free, ..Options::default() };
    let fit = fit(&preset(SPHERE, 1.5, 0.007, ""), &points, &options, &Unwatched).unwrap();
    let keys: Vec<&str> = fit.parameters.iter().map(|fitted| fitted.key.as_str()).collect();
    assert_eq!(keys[1..4], [W, CLOSING_ADHESION, START]);
    close(&fit, &[1.3, 0.03, 0.01, MOST], 0.02);
    assert_eq!(fit.verdict, Verdict::Describes, "{:?}", fit.reasons);
    assert!(fit.warnings.iter().any(|warning| warning.contains("the edge is pinned")), "{:?}", fit.warnings);
    // The fitted preset has the dead band.
    let closing = fit.preset.edge.closing_work_of_adhesion.unwrap();
    assert!((closing / 0.01 - 1.0).abs() < 0.02, "{closing}");
    // Where x is zero is found along with it, however far that is from the start.
    let mut shifted = points.clone();
    shifted.x.iter_mut().for_each(|x| *x += 3.0);
    let with_offset = Options {
        free: [E, W, CLOSING_ADHESION, "data.offset"].map(str::to_owned).to_vec(),
        ..options.clone()
    };
    let moved = super::fit(&preset(SPHERE, 1.5, 0.007, ""), &shifted, &with_offset, &Unwatched).unwrap();
    close(&moved, &[1.3, 0.03, 0.01, 3.0, MOST], 0.02);
    assert_eq!(moved.verdict, Verdict::Describes, "{:?}", moved.reasons);
    // One work of adhesion alone does not describe it.
    let one = run(&preset(SPHERE, 1.5, 0.02, ""), &points, &[E, W]);
    assert_eq!(one.verdict, Verdict::DoesNotDescribe);
    assert_eq!(one.reasons[0].kind, "branches", "{:?}", one.reasons);
    let said = "free material.closing_work_of_adhesion. With that, the model describes them";
    assert!(one.reasons[0].sentence.ends_with(said), "{:?}", one.reasons[0]);
    // Where both are equal nothing is pinned.
    let start = preset("shape='sphere'\nradius_of_curvature=1.0", 1.4, 0.015, "");
    let same = super::fit(&start, &noisy(3, false), &options, &Unwatched).unwrap();
    close(&same, &[1.0, 0.02, 0.02], 0.1);
    assert_eq!(same.verdict, Verdict::Describes, "{:?} {:?}", same.reasons, same.direction);
    assert!(same.parameters.iter().all(|of| of.key != START), "{:?}", same.parameters);
}

#[test]
fn one_of_two_works_of_adhesion_may_be_given() {
    let points = pinned();
    let mut given = preset(SPHERE, 1.5, 0.02, "");
    given.set(CLOSING_ADHESION, 0.01.into()).unwrap();
    let held = run(&given, &points, &[E, W]);
    close(&held, &[1.3, 0.03, MOST], 0.02);
    assert_eq!(held.verdict, Verdict::Describes, "{:?}", held.reasons);
    assert_eq!(held.preset.edge.closing_work_of_adhesion, Some(0.01));
    close(&run(&preset(SPHERE, 1.5, 0.03, ""), &points, &[E, CLOSING_ADHESION]), &[1.3, 0.01, MOST], 0.02);
    given.set(data::UNCERTAIN, Value::Text(format!("{CLOSING_ADHESION}=20%"))).unwrap();
    let known = run(&given, &points, &[E, W]);
    close(&known, &[1.3, 0.03, MOST], 0.02);
    let closing = known.parameters.iter().find(|fitted| fitted.key == CLOSING_ADHESION).unwrap();
    assert!((closing.value / 0.01 - 1.0).abs() < 0.02 && closing.has_error(), "{closing:?}");
    assert!(known.preset.data.uncertain.starts_with(CLOSING_ADHESION), "{}", known.preset.data.uncertain);
    // One that turns out to be above what was found is not kept, in words.
    given.set_all([(W, 0.06.into()), (CLOSING_ADHESION, 0.05.into()), (data::UNCERTAIN, "".into())]).unwrap();
    let above = run(&given, &points, &[E, W]);
    assert_eq!(above.preset.edge.closing_work_of_adhesion, None);
    assert!(
        above.notes.iter().any(|note| note.contains("is above the work of adhesion")),
        "{:?}",
        above.notes
    );
}

#[test]
fn an_approach_without_adhesion_determines_no_work_of_adhesion() {
    let mut points = between([1e-9, 0.03]);
    let mut normal = Normal::new(0);
    points.force.iter_mut().for_each(|force| *force += 0.01 * normal.next());
    let found = run(&preset(SPHERE, 1.5, 0.02, ""), &points, &[E, W, CLOSING_ADHESION]);
    assert_eq!(found.verdict, Verdict::NotDetermined, "{:?}", found.parameters);
    let why = found.direction.unwrap();
    assert!(why.contains("hold material.closing_work_of_adhesion"), "{why}");
    // Held next to nothing, as that says.
    let mut given = preset(SPHERE, 1.5, 0.02, "");
    given.set(CLOSING_ADHESION, 1e-9.into()).unwrap();
    let held = run(&given, &points, &[E, W]);
    close(&held, &[1.3, 0.03, MOST], 0.02);
    assert_eq!(held.verdict, Verdict::Describes, "{:?}", held.reasons);
}

#[test]
fn an_approach_alone_says_which_work_of_adhesion_it_shows() {
    let mut given = preset(SPHERE, 1.5, 0.02, "");
    given.set(CLOSING_ADHESION, 0.015.into()).unwrap();
    let asked = Asked { segment: Some(Segment::Approach), ..Asked::default() };
    let options = Options { free: [E, W].map(str::to_owned).to_vec(), asked, ..Options::default() };
    let found = fit(&given, &pinned(), &options, &Unwatched).unwrap();
    close(&found, &[1.3, 0.01], 0.03);
    assert!(found.notes.iter().any(|note| note.contains("is that of the approach")), "{:?}", found.notes);
}

/// The fit of the retraction of a loop alone, with `γ_a` given, where the instrument begins to write `late` rows after the turn.
fn retraction(late: usize) -> Fit {
    let mut given = preset(SPHERE, 1.5, 0.02, "");
    given.set(CLOSING_ADHESION, 0.01.into()).unwrap();
    run(&given, &written_late(late), &[E, W])
}

/// The points of this retraction.
fn written_late(late: usize) -> Points {
    let mut points = pinned();
    let first = 300 + late;
    points.x.drain(..first);
    points.force.drain(..first);
    points.segments.as_mut().unwrap().drain(..first);
    points
}

#[test]
fn a_retraction_alone_may_begin_with_a_pinned_edge() {
    for skip in [0, 10] {
        let found = retraction(skip);
        close(&found, &[1.3, 0.03, MOST], 0.02);
        assert_eq!(found.verdict, Verdict::Describes, "{skip} {:?}", found.reasons);
    }
    let later = retraction(180);
    close(&later, &[1.3, 0.03], 0.02);
    assert_eq!(later.verdict, Verdict::Describes, "{:?}", later.reasons);
    assert!(later.parameters.iter().all(|of| of.key != START), "{:?}", later.parameters);
    assert!(later.notes.iter().any(|note| note.contains("no rows show")), "{:?}", later.notes);
}

#[test]
fn a_retraction_that_begins_with_a_pinned_edge_is_told_so() {
    let found = run(&preset(SPHERE, 1.5, 0.02, ""), &written_late(0), &[E, W]);
    assert_eq!(found.verdict, Verdict::DoesNotDescribe);
    assert_eq!(found.reasons[0].kind, "dead-band", "{:?}", found.reasons);
    assert!(found.reasons[0].sentence.contains("rests at s = 1.6001"), "{:?}", found.reasons[0]);
}
