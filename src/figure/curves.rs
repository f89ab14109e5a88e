//! The equilibrium curve in three views, with the walk, the theory and the pinned curves.

use super::bounds::Bounds;
use super::parts::{Figure, Line, Mark, Role, Sign};
use super::pull::over_curve;
use super::scale::Scale;
use super::subject::Subject;
use super::walk::{branches, events_before, walk};
use crate::explorer::View;
use crate::explorer::curve::CurvePoint;
use crate::explorer::pins::{Pin, letter};
use pulloff_engine::preset::model::BasisSpec;
use pulloff_engine::report::number::{fixed, significant};
use pulloff_engine::report::path::PathStateReport;

/// Builds a view of the curve.
pub fn figure(subject: &Subject<'_>, view: View) -> Figure {
    let scale = subject.scale();
    let [x, y] = scale.axes(view);
    let mut figure = Figure::empty(format!("{} over {}", y.title(), x.symbol), x, y);
    let points: Vec<(f64, f64)> =
        subject.curve.points.iter().map(|point| scale.place(view, place(point))).collect();
    theory(subject, scale, view, &mut figure);
    let rested = cycle(subject, scale, view, &mut figure);
    // Drawn below the curve: where a branch lies on it, the curve already shows it.
    branches(subject, scale, view, &mut figure);
    let pinned = pins(subject, view, &mut figure);
    figure.lines.extend(pieces(&subject.curve.points, &points));
    inadmissible(subject, scale, view, &mut figure);
    let width = Bounds::of(points.iter().copied()).x;
    let pulled = over_curve(subject, scale, view, &mut figure, width);
    limit_marks(subject, scale, view, &mut figure);
    device(subject, scale, view, &mut figure);
    walk(subject, scale, view, &mut figure);
    // The walker may have left the range of the curve; the figure follows it.
    let walker = figure.marks.last().filter(|mark| mark.sign == Sign::Walker).map(|mark| mark.at);
    figure.bounds = Bounds::of(points.into_iter().chain(walker).chain(pinned).chain(pulled).chain(rested));
    figure
}

/// Draws the loop, with loading and unloading separate, and the edges of each contact where radii are shown. Returns
/// the points of a resting edge for the bounds, because they lie off the curve.
fn cycle(subject: &Subject<'_>, scale: Scale<'_>, view: View, figure: &mut Figure) -> Vec<(f64, f64)> {
    let rests = subject.curve.case.closing.is_some();
    let Some(report) = subject.cycle.or(subject.path.filter(|_| rests)) else { return Vec::new() };
    let pieces = report.states.chunk_by(|a, b| {
        (a.piece, a.direction, a.state.contacts.len()) == (b.piece, b.direction, b.state.contacts.len())
    });
    // One disc of the exact equation runs along the curve, which shows it.
    let curve = subject.curve;
    let is_exact = curve.setting.preset.basis == BasisSpec::Exact && curve.case.cohesion.is_none();
    let largest = curve.case.start * curve.case.units().length * (1.0 + 1e-9);
    let is_on_curve = |piece: &[PathStateReport]| {
        let is_disc = |at: &PathStateReport| matches!(at.state.contacts[..], [[inner, outer]] if inner == 0.0 && outer <= largest);
        is_exact && !rests && piece.iter().all(is_disc)
    };
    for piece in pieces.filter(|piece| !is_on_curve(piece)) {
        let (role, name) = if piece[0].direction == "loading" {
            (Role::Loading, "loading")
        } else {
            (Role::Unloading, "unloading")
        };
        let place = |at: &PathStateReport, r: f64| scale.place(view, [at.state.approach, at.state.force, r]);
        // Without a radius on the axes there is only one line, however many contacts there are.
        let contacts = if view.is_without_radius() { 1 } else { piece[0].state.contacts.len() };
        for contact in 0..contacts {
            for edge in [1, 0] {
                let radius =
                    |at: &PathStateReport| at.state.contacts.get(contact).map_or(0.0, |edges| edges[edge]);
                if edge == 0 && (view.is_without_radius() || radius(&piece[0]) == 0.0) {
                    continue;
                }
                let points = piece.iter().map(|at| place(at, radius(at))).collect();
                figure.lines.push(Line::new(role, name, points));
            }
        }
    }
    let all = report.states.iter().filter(|_| rests);
    all.map(|at| scale.place(view, [at.state.approach, at.state.force, at.state.contact_radius])).collect()
}

/// δ, P and s of a point of the curve.
pub fn place(point: &CurvePoint) -> [f64; 3] {
    [point.approach, point.force, point.contact_radius]
}

/// The curve cut where its stability changes, with the stable parts last, so that they are drawn over the others.
pub fn pieces(points: &[CurvePoint], places: &[(f64, f64)]) -> Vec<Line> {
    let mut pieces: Vec<Line> = Vec::new();
    let mut last = None;
    for (point, at) in points.iter().zip(places) {
        if last != Some(point.stable) {
            // Extend the previous piece to here, so that no gap is left.
            if let Some(piece) = pieces.last_mut() {
                piece.points.push(*at);
            }
            let (role, name) =
                if point.stable { (Role::Stable, "stable") } else { (Role::Unstable, "unstable") };
            pieces.push(Line::new(role, name, Vec::new()));
            last = Some(point.stable);
        }
        if let Some(piece) = pieces.last_mut() {
            piece.points.push(*at);
        }
    }
    pieces.sort_by_key(|piece| piece.role);
    pieces
}

/// Draws the inadmissible parts over the curve, so that their stability still shows beneath.
pub fn inadmissible(subject: &Subject<'_>, scale: Scale<'_>, view: View, figure: &mut Figure) {
    let lines = subject.curve.base.inadmissible.iter().flatten().map(|part| {
        let points = part.places.iter().map(|at| scale.place(view, *at));
        Line::new(Role::Inadmissible, "inadmissible", points.collect())
    });
    figure.lines.extend(lines);
}

/// Draws the line of the loading device, where it is shown; it has no radius.
fn device(subject: &Subject<'_>, scale: Scale<'_>, view: View, figure: &mut Figure) {
    if let (true, Some(ends)) = (view.is_without_radius(), subject.device) {
        let points = ends.map(|(approach, force)| scale.place(view, [approach, force, 0.0]));
        figure.lines.push(Line::new(Role::Device, "device", points.to_vec()));
    }
}

/// Draws the overlays that are on and exist, and notes what the envelope says.
fn theory(subject: &Subject<'_>, scale: Scale<'_>, view: View, figure: &mut Figure) {
    let theory = &subject.curve.base.theory;
    let line = |role, name: &str, places: &[[f64; 3]]| {
        Line::new(role, name, places.iter().map(|at| scale.place(view, *at)).collect())
    };
    if subject.overlays.smooth && !theory.smooth.is_empty() {
        figure.lines.push(line(Role::Smooth, theory.smooth_name, &theory.smooth));
    }
    if let (Some(envelope), true) = (&theory.envelope, subject.overlays.envelope) {
        for side in [&envelope.unloading, &envelope.loading] {
            figure.lines.push(line(Role::Envelope, "envelope", side));
        }
        // The estimate is the force under a dead load, over P_c; the smallest force of the path itself is given beside it.
        let critical = subject.curve.base.critical_force;
        let ours = subject.curve.report.as_ref().and_then(|report| report.totals.pull());
        let ours = ours.map(|state| -state.force / critical);
        figure.notes.push(format!(
            "Kesari-Lew peak {}, here {}, n = s/λ = {}",
            significant(envelope.peak, 4),
            ours.map_or_else(|| "-".to_owned(), |ours| significant(ours, 4)),
            fixed(envelope.waves, 1)
        ));
    }
    if subject.overlays.exact && !theory.exact.is_empty() {
        figure.lines.push(line(Role::Exact, theory.exact_name, &theory.exact));
    }
}

/// The divisors of a pinned curve: the same as those of the current curve.
pub fn pinned_scale<'a>(subject: &Subject<'a>, pin: &Pin) -> Scale<'a> {
    subject.scale().of_other(&pin.curve, subject.axes)
}

/// Draws the pinned curves; returns their points for the bounds.
fn pins(subject: &Subject<'_>, view: View, figure: &mut Figure) -> Vec<(f64, f64)> {
    let mut all = Vec::new();
    let others = subject.other_pins.iter();
    figure.notes.extend(others.map(|number| format!("pin {} has other units", letter(*number))));
    let units =
        subject.pins.iter().filter_map(|pin| subject.scale().unlike(&pin.curve, subject.axes, view)).max();
    figure.notes.extend(units.map(|units| format!("pins in the present {units}")));
    for pin in &subject.pins {
        let scale = pinned_scale(subject, pin);
        let points: Vec<(f64, f64)> =
            pin.curve.points.iter().map(|point| scale.place(view, place(point))).collect();
        let name = pin.name(subject.preset);
        let parts = pieces(&pin.curve.points, &points).into_iter();
        figure.lines.extend(parts.map(|part| {
            Line::new(Role::Pin(pin.number), name.clone(), part.points).broken(part.role == Role::Unstable)
        }));
        all.extend(points);
    }
    all
}

/// Marks the events of the path, A and B, and the limit points off the path; these come last, as the least important.
fn limit_marks(subject: &Subject<'_>, scale: Scale<'_>, view: View, figure: &mut Figure) {
    let curve = subject.curve;
    let events: Vec<Mark> = events_before(subject, scale, view).collect();
    let totals = subject.path.map(|path| &path.totals);
    let pull = totals.and_then(|totals| totals.pull());
    let far = totals.and_then(|totals| totals.farthest.as_ref());
    let ends = [(Sign::LargestPull, pull), (Sign::Farthest, far)];
    let ends = ends.into_iter().filter_map(|(sign, at)| {
        let at = at?;
        Some(Mark { sign, at: scale.place(view, [at.approach, at.force, at.contact_radius]) })
    });
    let own = curve.shown_limits().into_iter();
    let own = own.map(|at| Mark { sign: Sign::Limit, at: scale.place(view, at) });
    let is_off = |mark: &Mark| !events.iter().any(|event| is_near(mark.at, event.at));
    let others = curve.other_limits.iter();
    let others =
        others.map(|(control, p)| Mark { sign: Sign::OtherLimit(*control), at: scale.place(view, place(p)) });
    figure.marks.extend(events.iter().copied().chain(ends).chain(own.filter(is_off)).chain(others));
}

/// Whether two places are the same limit point, found in two ways.
fn is_near(a: (f64, f64), b: (f64, f64)) -> bool {
    const SAME: f64 = 1e-6;
    let near = |a: f64, b: f64| (a - b).abs() <= SAME * a.abs().max(b.abs());
    near(a.0, b.0) && near(a.1, b.1)
}
