//! Every figure of every kind of problem: what is on it, and that its bounds suit any renderer.

use super::reading::What;
use super::*;
use crate::explorer::{Axes, CurveData, Model, Staged};
use crate::explorer::{Command, Id, Inline, Overlay, open, update};
use crate::store::Store;
use pulloff_engine::case::Case;
use pulloff_engine::problem::Control;
use pulloff_engine::progress::Unwatched;
use pulloff_engine::quasistatic::Losses;
use pulloff_engine::report::PathReport;
use pulloff_engine::report::path::Extent;

/// A session in which every effect is done inline, with room for every view.
struct Session {
    model: Model,
    driver: Inline,
    _folder: tempfile::TempDir,
}

impl Session {
    fn new(preset: &str) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let store = Store::at(folder.path(), &[]);
        let loaded = store.load(&store.resolve(preset).unwrap(), &[] as &[&str]).unwrap();
        let (mut model, effects) = open(loaded);
        model.views = 4;
        let driver = Inline::new(store);
        driver.settle(&mut model, effects);
        Self { model, driver, _folder: folder }
    }

    fn does(&mut self, command: impl Into<Command>) -> &mut Self {
        let effects = update(&mut self.model, command.into());
        self.driver.settle(&mut self.model, effects);
        self
    }

    fn figure(&self, view: View) -> Figure {
        Subject::of(&self.model).unwrap().figure(view)
    }
}

fn count(figure: &Figure, role: Role) -> usize {
    figure.lines.iter().filter(|line| line.role == role).count()
}

fn signs(figure: &Figure, sign: Sign) -> usize {
    figure.marks.iter().filter(|mark| mark.sign == sign).count()
}

fn is_fit(figure: &Figure) -> bool {
    let Bounds { x, y } = figure.bounds;
    [x, y].iter().all(|[lo, hi]| lo.is_finite() && hi.is_finite() && lo < hi)
}

fn last_contacts(figure: &Figure) -> usize {
    figure.marks.iter().filter(|mark| matches!(mark.sign, Sign::LastContact(_))).count()
}

#[test]
fn the_curve_has_its_pieces_its_limit_points_and_the_walk() {
    let mut session = Session::new("wavy-sphere");
    session.does(Id::NextEvent).does(Id::Jump).does(Id::Step);
    let curve = session.model.curve.clone().unwrap();
    for view in [View::ForceApproach, View::ForceRadius, View::RadiusApproach] {
        let figure = session.figure(view);
        let changes = curve.points.windows(2).filter(|pair| pair[0].stable != pair[1].stable).count();
        assert_eq!(count(&figure, Role::Stable) + count(&figure, Role::Unstable), changes + 1);
        // They meet in the limit points themselves.
        let limits = figure
            .marks
            .iter()
            .filter(|mark| matches!(mark.sign, Sign::Limit | Sign::Event(_) | Sign::LastContact(_)));
        for limit in limits {
            let ends = figure.lines.iter().filter(|line| matches!(line.role, Role::Stable | Role::Unstable));
            let mut ends = ends.flat_map(|line| [line.points[0], line.points[line.points.len() - 1]]);
            assert!(ends.any(|(x, y)| (x - limit.at.0).abs() < 1e-12 && (y - limit.at.1).abs() < 1e-12));
        }
        // Those on the path have the number of their event, each once; the others have none.
        let snaps = curve.report.as_ref().unwrap().events.len() - 1;
        assert!((1..=snaps).all(|number| signs(&figure, Sign::Event(number)) == 1));
        assert_eq!(signs(&figure, Sign::Limit) + snaps + 1, curve.limits.len());
        assert_eq!(last_contacts(&figure), 1);
        assert_eq!((signs(&figure, Sign::Landing), signs(&figure, Sign::Walker)), (1, 1));
        assert_eq!((count(&figure, Role::Walk), count(&figure, Role::Jump)), (2, 1));
        assert_eq!((count(&figure, Role::Smooth), count(&figure, Role::Exact)), (1, 0));
        assert!(figure.here().is_some() && is_fit(&figure));
    }
    let titles = View::ALL.map(|view| session.figure(view).title);
    assert_eq!(titles[..4], ["P/Pc over δ/R", "P/Pc over Δ/R", "P/Pc over s/λ", "s/λ over δ/R"]);
    session.does(Id::Axes);
    assert_eq!(session.figure(View::ForceRadius).title, "P over s");
    assert_eq!(session.figure(View::ForceRadius).y.unit, "force");
}

#[test]
fn radii_are_counted_in_waves_only_where_the_gap_has_one_alone() {
    for (preset, title) in
        [("formula", "P/Pc over s/R"), ("harmonics", "P/Pc over s/R"), ("wavy-sphere", "P/Pc over s/λ")]
    {
        let session = Session::new(preset);
        let curve = session.model.curve.as_ref().unwrap();
        assert_eq!(session.figure(View::ForceRadius).title, title);
        let has_crests = curve
            .report
            .as_ref()
            .unwrap()
            .events
            .iter()
            .any(|event| event.before.as_ref().unwrap().wave.is_some());
        assert_eq!(has_crests, title.ends_with("s/λ"), "{preset}");
    }
}

#[test]
fn what_is_not_admissible_is_drawn_over_the_curve() {
    let mut session = Session::new("wavy-sphere");
    let drawn = |session: &Session, view| count(&session.figure(view), Role::Inadmissible);
    assert_eq!(drawn(&session, View::ForceApproach), 0);
    session.does(Command::Set { key: "material.work_of_adhesion".into(), text: "1e-4".to_owned() });
    let parts = session.model.shown_inadmissible().len();
    for view in [View::ForceApproach, View::ForceRadius, View::RadiusApproach, View::Unloading] {
        assert!(parts > 3 && drawn(&session, view) == parts, "{view:?} {parts}");
    }
    // Over the curve, from end to end.
    let figure = session.figure(View::RadiusApproach);
    let scale = Subject::of(&session.model).unwrap().scale();
    let lines = figure.lines.iter().filter(|line| line.role == Role::Inadmissible);
    for (line, part) in lines.zip(session.model.shown_inadmissible()) {
        let s = |radius| scale.place(View::RadiusApproach, [0.0, 0.0, radius]).1;
        let ends = [part.report.from_contact_radius, part.report.to_contact_radius].map(s);
        assert!((line.points[0].1 - ends[0]).abs() < 1e-9 * ends[0]);
        assert!((line.points.last().unwrap().1 - ends[1]).abs() < 1e-9 * ends[0]);
    }
}

#[test]
fn overlays_are_drawn_where_they_exist() {
    let mut session = Session::new("wavy-sphere");
    for overlay in [Overlay::Exact, Overlay::Envelope] {
        session.does(Command::Overlay(overlay));
    }
    let figure = session.figure(View::ForceApproach);
    assert_eq!((count(&figure, Role::Exact), count(&figure, Role::Envelope)), (1, 2));
    assert!(figure.notes[0].starts_with("Kesari-Lew peak 1.49"), "{:?}", figure.notes);
    // Theory has every radius of the computed curve, and continues past the edges of the chart.
    let computed = session.model.curve.as_ref().unwrap();
    let own = |s: f64| (0.999 * computed.case.end..1.001 * computed.case.start).contains(&s);
    let theory = &computed.base.theory;
    let count_own = theory.exact.iter().filter(|at| own(at[2])).count();
    let samples = computed.base.curve.samples.len();
    assert!(count_own >= samples, "{count_own} of {samples}");
    for role in [Role::Exact, Role::Smooth] {
        let [x, y] = [figure.bounds.x[1], figure.bounds.y[1]];
        let line = figure.lines.iter().find(|line| line.role == role).unwrap();
        assert!(line.points.iter().any(|at| at.0 > x || at.1 > y), "{role:?} ends within the chart");
    }
    session.does(Command::Overlay(Overlay::Smooth));
    assert_eq!(count(&session.figure(View::ForceApproach), Role::Smooth), 0);
    let mut sphere = Session::new("fig-3-jkr");
    sphere.does(Command::Overlay(Overlay::Envelope));
    assert_eq!(count(&sphere.figure(View::ForceApproach), Role::Envelope), 0);
    assert!(sphere.model.status().1.contains("wavy spheres"));
}

#[test]
fn pinned_curves_have_their_numbers_names_and_divisors() {
    let mut session = Session::new("wavy-sphere");
    session.does(Id::Pin);
    let before = session.figure(View::ForceApproach);
    session
        .does(Command::Set { key: "material.work_of_adhesion".into(), text: "0.002".to_owned() })
        .does(Id::Pin);
    let figure = session.figure(View::ForceApproach);
    let pin = figure.lines.iter().find(|line| line.role == Role::Pin(1)).unwrap();
    assert!(pin.name.starts_with("gamma 0.00397"), "{}", pin.name);
    // Over the P_c of the present values, because an axis has one unit.
    let old: Vec<(f64, f64)> =
        before.lines.iter().filter(|line| line.role == Role::Pin(1)).flat_map(|l| l.points.clone()).collect();
    let parts = figure.lines.iter().filter(|line| line.role == Role::Pin(1));
    let now: Vec<(f64, f64)> = parts.clone().flat_map(|line| line.points.clone()).collect();
    let more = session.model.preset.material.work_of_adhesion / 0.025 * std::f64::consts::TAU;
    assert!(now.len() == old.len() && now.len() > 100);
    for (now, old) in now.iter().zip(&old) {
        let near = |a: f64, b: f64| (a - b).abs() <= 1e-12 * b.abs();
        assert!(near(now.0, old.0) && near(now.1 * more, old.1), "{now:?} {old:?}");
    }
    // Stable and unstable parts, as on the curve.
    assert!(parts.clone().any(|part| part.is_broken) && parts.clone().any(|part| !part.is_broken));
    assert!(count(&figure, Role::Pin(2)) > 1);
    let lowest = pin.points.iter().map(|at| at.1).fold(f64::INFINITY, f64::min);
    assert!(figure.bounds.y[0] < lowest);
    session.does(Command::Unpin(Some(1)));
    assert_eq!(count(&session.figure(View::ForceApproach), Role::Pin(1)), 0);
}

#[test]
fn the_unloading_has_an_area_for_every_loss_that_has_a_bound() {
    for (control, unbounded) in [("displacement", 0), ("force", 1), ("stiffness=0.15", 0)] {
        let mut session = Session::new("wavy-sphere");
        session.does(Command::Set { key: "path.control".into(), text: control.to_owned() });
        let curve = session.model.curve.clone().unwrap();
        let unloading = curve.unloading.as_ref().unwrap();
        let figure = session.figure(View::Unloading);
        assert_eq!(figure.areas.len() + unbounded, unloading.events.len(), "{control}");
        assert_eq!(count(&figure, Role::Jump), unloading.events.len());
        assert_eq!(last_contacts(&figure), 1);
        let scale = curve.base.critical_force;
        for (area, event) in figure.areas.iter().zip(&unloading.events) {
            // The outline encloses the lost energy: P/Pc over δ.
            let next = area.outline.iter().cycle().skip(1);
            let enclosed: f64 =
                area.outline.iter().zip(next).map(|(a, b)| 0.5 * (a.0 * b.1 - b.0 * a.1)).sum();
            let lost = event.dissipated.unwrap() * curve.case.units().energy;
            assert!(
                (enclosed.abs() * scale / lost - 1.0).abs() < 0.02,
                "{control}: {} {lost}",
                enclosed * scale
            );
            assert_eq!(area.lost, Some(lost));
        }
        assert!(figure.notes[0].starts_with("lost "), "{:?}", figure.notes);
    }
}

/// The loop of a shipped preset with these changes, and its curve.
fn looped(preset: &str, changes: &[&str]) -> (PathReport, CurveData) {
    let store = Store::at("/nowhere", &[]);
    let preset = store.load(&store.resolve(preset).unwrap(), changes).unwrap().preset;
    let report =
        PathReport::cycle(&preset, None, Extent { losses: Losses::Once, admissibility: false }, &Unwatched)
            .unwrap();
    (report, CurveData::compute(&preset, &Staged::unwatched()).unwrap())
}

fn enclosed(outline: &[(f64, f64)]) -> f64 {
    let next = outline.iter().cycle().skip(1);
    outline.iter().zip(next).map(|(a, b)| 0.5 * (a.0 * b.1 - b.0 * a.1)).sum::<f64>().abs()
}

#[test]
fn the_areas_of_a_loop_are_its_losses() {
    let whole = |preset, changes: &[&str]| {
        let (report, curve) = looped(preset, changes);
        let overlays = crate::explorer::Overlays::default();
        let subject = Subject { cycle: Some(&report), axes: Axes::Raw, ..Subject::alone(&curve, overlays) };
        let figure = subject.figure(View::Cycle);
        assert!(is_fit(&figure) && figure.missing.is_none());
        for area in &figure.areas {
            let lost = area.lost.unwrap();
            assert!(area.meaning == Meaning::Lost && (enclosed(&area.outline) / lost - 1.0).abs() < 0.02);
        }
        let lost: f64 = figure.areas.iter().filter_map(|area| area.lost).sum();
        (report, figure, lost)
    };
    // Only discs: every jump has its area, whatever is controlled.
    for (control, unbounded) in [("displacement", 0), ("stiffness=0.15", 0), ("force", 1)] {
        let control = format!("path.control={control}");
        let (report, figure, lost) = whole("fig-9-cycle", &[&control]);
        let jumps = report.events.iter().filter(|event| event.before != event.after).count();
        assert_eq!((figure.areas.len() + unbounded, count(&figure, Role::Jump)), (jumps, jumps), "{control}");
        assert_eq!((last_contacts(&figure), signs(&figure, Sign::Turn)), (1, 1));
        let all = report.totals.dissipated.unwrap_or(report.totals.dissipated_before_last_contact);
        assert!((lost / all - 1.0).abs() < 1e-9, "{control}: {lost} {all}");
    }
    // Jumps between rings follow no curve: one area for all.
    for control in ["displacement", "stiffness=0.15"] {
        let control = format!("path.control={control}");
        let (report, figure, lost) = whole("fig-9-weak", &[&control]);
        assert_eq!((figure.areas.len(), Some(lost)), (1, report.totals.dissipated), "{control}");
    }
}

#[test]
fn a_contact_map_shows_every_state_once() {
    for preset in ["fig-9-weak", "crater"] {
        let (report, curve) = looped(preset, &[]);
        let overlays = crate::explorer::Overlays::default();
        let subject = Subject { cycle: Some(&report), axes: Axes::Raw, ..Subject::alone(&curve, overlays) };
        let figure = subject.figure(View::ContactMap);
        assert!(is_fit(&figure) && figure.areas.iter().all(|area| area.meaning == Meaning::Contact));
        let corners: usize = figure.areas.iter().map(|area| area.outline.len()).sum();
        let contacts: usize = report.states.iter().map(|at| at.state.contacts.len()).sum();
        assert_eq!(corners, 2 * contacts, "{preset}");
        // Loading to the left of the turn, unloading to the right, and the first contact of the crater is off the axis.
        let turn = report.events.iter().find(|event| event.kind == "turn").unwrap();
        let turn = turn.control - report.events[0].control;
        let way: Vec<f64> = figure.areas.iter().map(|area| area.outline[0].0).collect();
        let last = figure.areas.last().unwrap().outline.iter().map(|at| at.0).fold(0.0, f64::max);
        assert!(way.is_sorted() && way[0] >= 0.0 && last > 1.01 * turn, "{preset}");
        let lowest = figure.areas[0].outline.iter().map(|at| at.1).fold(f64::INFINITY, f64::min);
        assert_eq!(lowest > 0.0, preset == "crater");
    }
}

#[test]
fn without_a_loop_its_views_say_so() {
    let session = Session::new("wavy-sphere");
    for view in [View::Cycle, View::ContactMap] {
        let figure = session.figure(view);
        assert!(is_fit(&figure) && figure.missing.as_deref() == Some("no loop yet"), "{view:?}");
    }
}

#[test]
fn figures_of_nothing_of_one_point_and_without_adhesion_are_fit_to_draw() {
    for preset in ["wavy-sphere", "fig-1-hertz", "fig-3-jkr"] {
        let mut session = Session::new(preset);
        session.does(Id::Pin);
        let whole = session.model.curve.clone().unwrap();
        for kept in [0, 1, whole.points.len()] {
            let mut curve = (*whole).clone();
            curve.points.truncate(kept);
            session.model.curve = Some(std::sync::Arc::new(curve));
            for view in View::ALL {
                for axes in [Axes::Reduced, Axes::Raw] {
                    session.model.axes = axes;
                    let figure = session.figure(view);
                    assert!(is_fit(&figure), "{preset} {view:?} {kept}: {:?}", figure.bounds);
                    assert!(!figure.title.is_empty());
                }
            }
        }
    }
}

#[test]
fn the_nearest_state_is_on_the_curve_and_coordinates_have_digits_enough() {
    let session = Session::new("wavy-sphere");
    let subject = Subject::of(&session.model).unwrap();
    let figure = subject.figure(View::ForceApproach);
    let point = &subject.curve.points[80];
    let at = subject.scale().place(View::ForceApproach, [point.approach, point.force, point.contact_radius]);
    let found = nearest(&subject, View::ForceApproach, &figure.bounds, at).unwrap();
    assert_eq!((found.at, found.contact_radius), (at, point.contact_radius));
    assert!(found.text(subject.scale()).contains("stable"));
    assert!(nearest(&subject, View::Pressure, &figure.bounds, at).is_none());
    let axes = [&figure.x, &figure.y];
    let deep = Bounds { x: [0.5, 0.5 + 1e-9], y: [-1.0, 1.0] };
    let text = reading::coordinates(&deep, axes, (0.5 + 5e-10, 0.25));
    assert_eq!(text, "δ/R 0.500000000500, P/Pc 0.250");
}

#[test]
fn near_a_limit_point_a_landing_or_a_pin_the_cross_hair_says_so() {
    let mut session = Session::new("wavy-sphere");
    session.does(Id::Pin).does(Command::Set { key: "gap.amplitude".into(), text: "0.0035".to_owned() });
    let subject = Subject::of(&session.model).unwrap();
    let (scale, view) = (subject.scale(), View::RadiusApproach);
    let bounds = subject.figure(view).bounds;
    // Closer than the limit points are to each other.
    let at = |quantities| {
        let (x, y) = scale.place(view, quantities);
        let close = Bounds { x: [x - 0.001, x + 0.001], y: [y - 0.02, y + 0.02] };
        let off = (x + 1e-5, y);
        nearest(&subject, view, &close, off).unwrap().what
    };
    let events = &subject.curve.report.as_ref().unwrap().events;
    let limits = subject.curve.shown_limits();
    for (i, limit) in limits.iter().enumerate() {
        let What::Limit { control: Control::Displacement, number, of, .. } = at(*limit) else {
            panic!("{:?}", at(*limit))
        };
        assert_eq!((number, of), (i + 1, limits.len()));
    }
    let first = [
        events[0].before.as_ref().unwrap().approach,
        events[0].before.as_ref().unwrap().force,
        events[0].before.as_ref().unwrap().contact_radius,
    ];
    assert!(at(first).text().ends_with(&format!("of {}, event 1", limits.len())), "{}", at(first).text());
    let after = events[1].after.clone().unwrap();
    assert_eq!(at([after.approach, after.force, after.contact_radius]), What::Landing(2));
    let (control, other) = &subject.curve.other_limits[0];
    let quantities = [other.approach, other.force, other.contact_radius];
    assert!(matches!(at(quantities), What::Limit { control: found, number: 1, .. } if found == *control));
    // The point of the pinned curve farthest from this curve and from every mark.
    let pinned = &subject.pins[0].curve.points[30];
    let quantities = [pinned.approach, pinned.force, pinned.contact_radius];
    assert_eq!(at(quantities), What::Pin(1));
    // Halfway between two states of this curve, the curve counts, though a state of the pinned one may be nearer.
    let count = subject.curve.points.len();
    for pair in subject.curve.points.windows(2).take(count / 8) {
        let [(x, y), (u, v)] = [&pair[0], &pair[1]]
            .map(|point| scale.place(view, [point.approach, point.force, point.contact_radius]));
        let close = Bounds { x: [x - 0.02, x + 0.02], y: [y - 0.5, y + 0.5] };
        let found = nearest(&subject, view, &close, (0.5 * (x + u), 0.5 * (y + v))).unwrap();
        assert!(!matches!(found.what, What::Pin(_)), "{found:?}");
    }
    // From far away the nearest point of a curve counts, not a mark.
    let far = (bounds.x[0], bounds.y[1]);
    let found = nearest(&subject, view, &bounds, far).unwrap();
    assert!(matches!(found.what, What::Curve { .. } | What::Pin(_)), "{found:?}");
}

#[test]
fn among_pins_the_curve_is_named_by_what_differs() {
    let mut session = Session::new("wavy-sphere");
    assert_eq!(Subject::of(&session.model).unwrap().own_name(), None);
    session.does(Id::Pin);
    assert_eq!(Subject::of(&session.model).unwrap().own_name(), None);
    session.does(Command::Set { key: "gap.amplitude".into(), text: "0.0035".to_owned() });
    assert_eq!(Subject::of(&session.model).unwrap().own_name().unwrap(), "A 0.0035");
    session.does(Id::Pin);
    session.does(Command::Set { key: "gap.wavelength".into(), text: "0.06".to_owned() });
    let subject = Subject::of(&session.model).unwrap();
    // The amplitude differs from that of the first pin but not from that of the second.
    assert_eq!(subject.own_name().unwrap(), "A 0.0035, lambda 0.06");
    let chart = subject.figure(View::ForceApproach);
    let names: Vec<String> = chart.naming("A 0.0035").lines.into_iter().map(|line| line.name).collect();
    assert!(
        names.iter().any(|name| name == "A 0.0035, stable") && !names.iter().any(|name| name == "stable")
    );
    assert!(names.iter().any(|name| name == "A 0.0025, lambda 0.05"), "{names:?}");
}

#[test]
fn the_inside_of_a_state_is_drawn_with_its_edge_and_crests() {
    let mut session = Session::new("wavy-sphere");
    session.does(Command::Overlay(Overlay::Exact)).does(Id::NextEvent).does(Id::Jump);
    let node = session.model.walker().unwrap();
    let case: &Case = &session.model.curve.as_ref().unwrap().case;
    let radius = node.state.contact_radius / case.reduced.gap.feature_length().unwrap();
    let pressure = session.figure(View::Pressure);
    assert_eq!((count(&pressure, Role::Body), count(&pressure, Role::Exact)), (1, 1));
    assert_eq!(pressure.x.symbol, "r/λ");
    // Every crest r = mλ inside, and no other.
    let crests = signs(&pressure, Sign::Crest) as f64;
    assert!(crests <= radius && crests + 1.0 > radius && signs(&pressure, Sign::Edge) == 1);
    // At the edge the pull goes beyond what is shown at first.
    let body = pressure.lines.iter().find(|line| line.role == Role::Body).unwrap();
    let least = body.points.iter().map(|at| at.1).fold(f64::INFINITY, f64::min);
    assert!(least < pressure.bounds.y[0] && is_fit(&pressure));

    let gap = session.figure(View::Gap);
    assert_eq!(
        (count(&gap, Role::Contact), count(&gap, Role::Body), count(&gap, Role::Undeformed)),
        (1, 1, 1)
    );
    let body = gap.lines.iter().find(|line| line.role == Role::Body).unwrap();
    assert!(body.points[0].1.abs() < 1e-3 * gap.bounds.y[1], "closed at the edge: {:?}", body.points[0]);
    assert!(body.points.iter().skip(1).all(|at| at.1 > -1e-4 * gap.bounds.y[1]));
    assert!(signs(&gap, Sign::Crest) >= 2 && is_fit(&gap));

    let energy = session.figure(View::Energy);
    assert_eq!((energy.y.symbol.as_str(), count(&energy, Role::Body)), ("U", 1));
    // The walker sits on the landscape, in a minimum.
    let at = energy.here().unwrap();
    let mut minima = energy.marks.iter().filter(|mark| mark.sign == Sign::Minimum);
    assert!(minima.any(|mark| (mark.at.0 - at.0).abs() < 1e-6 * at.0), "{:?} {at:?}", energy.marks);
    session.does(Id::Axes);
    assert_eq!(session.figure(View::Pressure).y.unit, "stress");

    // When the bodies are apart there is no interior, and no figure of the previous one.
    for _ in 0..8 {
        session.does(Id::NextEvent).does(Id::Jump);
    }
    assert!(session.figure(View::Pressure).missing.unwrap().contains("apart"));
}

#[test]
fn the_barrier_appears_shrinks_and_is_gone_at_the_limit_point() {
    let mut session = Session::new("wavy-sphere");
    session.does(Id::NextEvent).does(Id::Jump);
    let mut heights = Vec::new();
    for _ in 0..100 {
        session.does(Id::Step);
        let figure = session.figure(View::Energy);
        if session.model.limit_number().is_some() {
            assert_eq!(signs(&figure, Sign::Barrier), 0);
            break;
        }
        let Some(mark) = figure.marks.iter().find(|mark| mark.sign == Sign::Barrier) else { continue };
        assert_eq!(count(&figure, Role::Barrier), 1);
        assert!(figure.notes[0].starts_with("barrier "), "{:?}", figure.notes);
        // Inward of the walker, and above it.
        let walker = figure.here().unwrap();
        assert!(mark.at.0 < walker.0 && mark.at.1 > walker.1, "{mark:?} {walker:?}");
        heights.push(mark.at.1 - walker.1);
    }
    assert!(session.model.limit_number().is_some());
    assert!(heights.len() > 3 && heights.windows(2).all(|pair| pair[1] < pair[0]), "{heights:?}");
}

/// The start is an end of the curve: whether rounding puts its radius within or beyond, it is a minimum with a barrier.
#[test]
fn the_energy_at_the_start_has_its_barrier_in_all_units() {
    for preset in ["fig-9", "fig-9-si"] {
        let session = Session::new(preset);
        let figure = session.figure(View::Energy);
        let found = [Sign::Minimum, Sign::Maximum, Sign::Barrier].map(|sign| signs(&figure, sign));
        assert_eq!(found, [2, 1, 1], "{preset} {:?}", figure.marks);
    }
}

#[test]
fn differences_are_those_of_the_curves_at_equal_radius_and_at_equal_approach() {
    let mut session = Session::new("wavy-sphere");
    session.does(Id::Pin).does(Command::Overlay(Overlay::Exact));
    session.does(Command::Assign(vec![("gap.amplitude".into(), "0.0025001".into())]));
    let figure = session.figure(View::Differences);
    let scale = Subject::of(&session.model).unwrap().scale();
    let of = |role: Role, is_broken: bool| {
        let mut lines = figure.lines.iter().filter(|line| line.role == role && line.is_broken == is_broken);
        lines.next().unwrap().points.clone()
    };
    // The basis is exact: it differs from the exact solution only by rounding, at equal s and at equal δ.
    let largest = |points: &[(f64, f64)]| {
        let found = || points.iter().map(|(_, y)| y.abs()).filter(|y| y.is_finite());
        (found().count(), found().fold(0.0, f64::max))
    };
    for is_broken in [false, true] {
        let (count, most) = largest(&of(Role::Exact, is_broken));
        assert!(count > 100 && most < 1e-6, "{is_broken}: {count} points, {most}");
    }
    // It differs from the pin by the effect of the amplitude on P at a radius.
    let pin = session.model.pins.all()[0].curve.clone();
    let ours = session.model.curve.clone().unwrap();
    let points = of(Role::Pin(1), false);
    for (at, (x, y)) in pin.points.iter().zip(&points).step_by(97).filter(|(_, (_, y))| y.is_finite()) {
        assert!((x - scale.radius(at.contact_radius)).abs() < 1e-12);
        let s = at.contact_radius / ours.case.units().length;
        let point = ours.base.curve.equilibrium.explicit(s).unwrap();
        let force = ours.base.curve.equilibrium.state(&point).force * ours.case.units().force;
        assert!((y - scale.force(force - at.force)).abs() < 1e-9, "{x}: {y}");
    }
    assert!(is_fit(&figure) && figure.here().is_some());
    // The value at the walker belongs to its own state, far from a limit point and on it; checked against a closed form.
    session.does(Id::NextEvent);
    let figure = session.figure(View::Differences);
    let jkr = session.model.curve.as_ref().unwrap().case.smooth().unwrap();
    let node = session.model.history.current().unwrap();
    let state = node.state.in_units(node.setting.units());
    let scale = Subject::of(&session.model).unwrap().scale();
    let expected = scale.force(state.force - jkr.force(state.contact_radius));
    assert!((figure.here().unwrap().1 - expected).abs() < 1e-12 * expected.abs(), "{expected}");
    session.does(Id::Undo);
    let (count, most) = largest(&of(Role::Pin(1), true));
    assert!(count > 100 && most > 0.0 && most < 1e-2, "{count} points, {most}");
    session.does(Command::Unpin(None)).does(Command::Overlay(Overlay::Exact));
    session.does(Command::Overlay(Overlay::Smooth));
    assert!(session.figure(View::Differences).missing.is_some());
}

#[test]
fn a_pin_in_other_units_is_not_drawn_on_axes_to_which_it_does_not_belong() {
    let mut session = Session::new("wavy-sphere");
    session.does(Id::Pin).does(Command::OpenWith { name: "fig-9-si".to_owned(), assignments: Vec::new() });
    assert_eq!(session.model.pins.all().len(), 1);
    for view in [View::ForceApproach, View::ForceRadius, View::Differences] {
        let figure = session.figure(view);
        assert!(!figure.lines.iter().any(|line| matches!(line.role, Role::Pin(_))), "{view:?}");
        let is_told = figure.notes.iter().any(|note| note.contains("D has other units"));
        assert!(is_told || figure.missing.is_some(), "{view:?}: {:?}", figure.notes);
    }
    // It is back beside a preset in its own units.
    session.does(Command::OpenWith { name: "fig-9".to_owned(), assignments: Vec::new() });
    assert!(count(&session.figure(View::ForceApproach), Role::Pin(1)) > 0);
}
