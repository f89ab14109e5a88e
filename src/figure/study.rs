//! A quantity over the range of one value, with the preset's value marked.

use super::parts::{Area, Axis, AxisScale, Figure, Line, Mark, Meaning, Role, Sign};
use super::reading::on_line;
use super::subject::Subject;
use crate::explorer::Axes;
use crate::explorer::studies::{StudyData, StudyOutcome, number};
use pulloff_engine::preset::{Preset, Row};
use pulloff_engine::report::number::{short, significant, with_unit};
use pulloff_engine::sweep::ensemble::quantiles;
use pulloff_engine::sweep::quantity::Under;
use pulloff_engine::sweep::{Cell, QuantityColumn};
use pulloff_engine::text::greek;
use pulloff_engine::units::Quantity;

/// With fewer other surfaces than this, no quantiles are drawn.
const FEWEST: usize = 5;

/// The quantity in words: its name, and the control where it differs from the preset's.
fn words(column: QuantityColumn) -> String {
    let name = column.quantity.name.replace('_', " ");
    match column.under {
        Under::Own => name,
        Under::Displacement => format!("{name} under displacement"),
        Under::Force => format!("{name} under force"),
    }
}

/// Builds the view.
pub fn figure(subject: &Subject<'_>) -> Figure {
    let none = || Axis::pure(String::new());
    let empty = |why: &str| Figure {
        missing: Some(why.to_owned()),
        ..Figure::empty("study".to_owned(), none(), none())
    };
    match &subject.study {
        Some(Ok(data)) => of(data, subject.preset, subject.axes),
        Some(Err(why)) => empty(why),
        None => empty("the study is being computed"),
    }
}

/// The row of the value that is varied.
fn row(data: &StudyData, preset: &Preset) -> Option<Row> {
    preset.row(&data.wish.key).or_else(|| data.wish.preset.row(&data.wish.key))
}

/// Whether two forces differ by more than rounding.
fn differ(a: f64, b: f64) -> bool {
    (a - b).abs() > 1e-12 * a.abs()
}

/// How the values of a study run.
fn scale_of(data: &StudyData) -> AxisScale {
    AxisScale::of(&data.wish.values.iter().filter_map(number).collect::<Vec<f64>>())
}

/// The figure of a study, with `preset` marked on it; on reduced axes each force is divided by `P_c` at its own value.
pub fn of(data: &StudyData, preset: &Preset, axes: Axes) -> Figure {
    let (wish, units) = (&data.wish, &data.wish.preset.units);
    let quantity = wish.column.quantity.unit;
    let row = row(data, preset);
    let shown = |x: f64| row.as_ref().map_or(x, |row| row.shown(units, x).number);
    let label = row.as_ref().map_or_else(|| wish.key.to_string(), |row| greek(&row.label));
    let unit = row.as_ref().and_then(|row| row.unit_in(units)).map_or_else(String::new, ToString::to_string);
    let x = Axis { shown: unit, ..Axis::pure(label).running(scale_of(data)) };
    let critical = data.divisors(axes);
    let in_unit = |at: usize, y: f64| {
        critical.map_or_else(|| units.shown(quantity, y).number, |critical| y / critical[at])
    };
    let unit = match critical {
        Some(critical) if critical.windows(2).any(|pair| differ(pair[0], pair[1])) => {
            format!("P/Pc at each {}", x.symbol)
        }
        Some(_) => "P/Pc".to_owned(),
        None => units.unit(quantity).map_or_else(String::new, ToString::to_string),
    };
    let y = Axis { shown: unit, ..Axis::pure(words(wish.column)) };
    let mut figure = Figure::empty(format!("{} over {}", y.title(), x.title()), x, y);
    let value = |at: usize, cell: &Cell| match cell {
        Cell::Number(y) => in_unit(at, *y),
        // Exact for every count.
        #[expect(clippy::cast_precision_loss)]
        Cell::Count(n) => *n as f64,
    };
    let places: Vec<(f64, Option<f64>)> = wish
        .values
        .iter()
        .zip(&data.outcomes)
        .enumerate()
        .filter_map(|(at, (x, outcome))| {
            let y = if let StudyOutcome::Found(cell) = outcome { Some(value(at, cell)) } else { None };
            // Without adhesion there is no P_c to divide by.
            let y = y.filter(|y| y.is_finite());
            Some((shown(number(x)?), y))
        })
        .collect();
    let is_counted =
        data.outcomes.iter().any(|outcome| matches!(outcome, StudyOutcome::Found(Cell::Count(_))));
    if is_counted {
        figure.y.run = AxisScale::Counted;
    }
    for part in places.chunk_by(|a, b| a.1.is_some() == b.1.is_some()) {
        let points: Vec<(f64, f64)> = part.iter().filter_map(|(x, y)| Some((*x, (*y)?))).collect();
        let parts = if is_counted { vec![stairs(&points)] } else { unbroken(&points) };
        for points in parts.into_iter().filter(|points| !points.is_empty()) {
            figure.lines.push(Line::new(Role::Body, words(wish.column), drawn(points)));
        }
    }
    slow_pulls(&mut figure, data, shown, in_unit);
    let bands = bands(&mut figure, data, &places, |at, y| if is_counted { y } else { in_unit(at, y) });
    let found = places.iter().filter_map(|(x, y)| Some((*x, (*y)?)));
    let ends = [places.first(), places.last()].into_iter().flatten();
    let found: Vec<(f64, f64)> = found.collect();
    let level = found.first().map_or(0.0, |(_, y)| *y);
    figure.bounds = figure.around(found.iter().copied().chain(ends.map(|(x, _)| (*x, level))).chain(bands));
    if let Some(x) = preset.get(&wish.key).and_then(|value| number(&value)).map(shown) {
        let ends = figure.bounds.y.map(|y| (x, y));
        figure.lines.insert(0, Line::new(Role::Level, "now", ends.to_vec()));
        // On the line itself, where this value was computed.
        let at = found.iter().find(|(at, _)| (at - x).abs() <= 1e-12 * x.abs());
        figure.marks.extend(at.map(|at| Mark { sign: Sign::Preset, at: *at }));
    }
    figure.missing = why_none(data);
    figure.notes.extend(notes(data, places.iter().filter(|(_, y)| y.is_none()).count()));
    figure
}

/// Why no value at all was found, once all are computed: an empty chart without a word would look as if it still were to come.
fn why_none(data: &StudyData) -> Option<String> {
    let reasons = data.outcomes.iter().map(|outcome| match outcome {
        StudyOutcome::Missing(why) => Some(why.as_str()),
        StudyOutcome::Waits | StudyOutcome::Found(_) => None,
    });
    let reasons: Option<Vec<&str>> = reasons.collect();
    reasons?.first().map(|why| format!("no value anywhere: {why}"))
}

/// What is not to be seen on the figure, where `without` places have no value.
fn notes(data: &StudyData, without: usize) -> impl Iterator<Item = String> {
    let (done, count) = (data.done(), data.outcomes.len());
    let is_unchecked = data.wish.column.is_unchecked(&data.wish.preset);
    let missing = without.saturating_sub(count - done);
    let all = [
        (done < count).then(|| format!("{done} of {count}")),
        data.wish
            .column
            .is_blind_to(&data.wish.key)
            .then(|| "the same at any speed: see peak_force".to_owned()),
        is_unchecked.then(|| "one disc, not checked".to_owned()),
        data.steep.map(|(at, slope)| {
            let slope = significant(slope, 2);
            format!("steep at {at} of {count}: slopes up to {slope}")
        }),
        (missing > 0).then(|| format!("{missing} without a value: the cross-hair says why")),
    ];
    all.into_iter().flatten()
}

/// The limit of the largest pull at low rates: the quasi-static one, and the first order as far as it holds.
fn slow_pulls(
    figure: &mut Figure,
    data: &StudyData,
    rate: impl Fn(f64) -> f64,
    force: impl Fn(usize, f64) -> f64,
) {
    /// The first order is drawn up to this share of the quasi-static pull.
    const SHARE: f64 = 1.0;
    let Some(slow) = &data.slow else { return };
    let rates: Vec<f64> = data.wish.values.iter().filter_map(number).collect();
    let level = rates.iter().enumerate().map(|(at, x)| (rate(*x), force(at, slow.force)));
    figure.lines.push(Line::new(Role::Zero, "quasi-static", level.collect()));
    let first = rates.iter().enumerate().filter_map(|(at, x)| Some((at, *x, slow.at(*x)?)));
    let first = first.take_while(|(.., pull)| (pull - slow.force).abs() <= SHARE * slow.force.abs());
    let first = first.map(|(at, x, pull)| (rate(x), force(at, pull)));
    figure.lines.push(Line::new(Role::Exact, "first order", first.collect()));
}

/// Points cut where the value jumps: where one step is much larger than the steps on either side. Nothing was computed
/// in between, and a line there would show a slope that does not exist.
fn unbroken(points: &[(f64, f64)]) -> Vec<Vec<(f64, f64)>> {
    /// A jump is this many times a neighbouring step, and at least this share of the whole range.
    const TIMES: f64 = 6.0;
    const SHARE: f64 = 0.03;
    let [lo, hi] =
        points.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[lo, hi], at| [lo.min(at.1), hi.max(at.1)]);
    let over = |at: usize| {
        let pair = points.get(at..at + 2)?;
        Some((pair[1].1 - pair[0].1).abs())
    };
    let jumps = |at: usize| {
        let beside = [at.checked_sub(1).and_then(over), over(at + 1)].into_iter().flatten();
        let beside = beside.fold(f64::NEG_INFINITY, f64::max);
        // Two points alone tell nothing.
        over(at).is_some_and(|own| beside >= 0.0 && own > SHARE * (hi - lo) && own > TIMES * beside)
    };
    let cuts: Vec<usize> = (0..points.len()).filter(|at| jumps(*at)).map(|at| at + 1).collect();
    let ends = cuts.iter().copied().chain([points.len()]);
    let starts = std::iter::once(0).chain(cuts.iter().copied());
    starts.zip(ends).map(|(from, to)| points[from..to].to_vec()).collect()
}

/// The spread of the other surfaces: areas that hold nine tenths and half of them, and their median. Returns all
/// corners of the areas.
fn bands(
    figure: &mut Figure,
    data: &StudyData,
    places: &[(f64, Option<f64>)],
    shown: impl Fn(usize, f64) -> f64,
) -> Vec<(f64, f64)> {
    let surfaces = data.surfaces();
    if surfaces < FEWEST {
        return Vec::new();
    }
    let all: Vec<(f64, Option<[f64; 5]>)> = places
        .iter()
        .zip(&data.others)
        .enumerate()
        // Only complete surfaces, so that they are the same at every value.
        .map(|(at, ((x, _), others))| {
            let all = quantiles(&others[..surfaces]).map(|all| all.map(|y| shown(at, y)));
            (*x, all.filter(|all| all[2].is_finite()))
        })
        .collect();
    let mut corners = Vec::new();
    for part in all.split(|(_, at)| at.is_none()).filter(|part| part.len() > 1) {
        let line = |of: usize| part.iter().filter_map(move |(x, at)| Some((*x, (*at)?[of])));
        for (meaning, [lower, upper]) in [(Meaning::Most, [0, 4]), (Meaning::Half, [1, 3])] {
            let outline: Vec<(f64, f64)> = line(lower).chain(line(upper).rev()).collect();
            corners.extend(outline.iter().copied());
            figure.areas.push(Area { meaning, outline, lost: None });
        }
        figure.lines.push(Line::new(Role::Smooth, "median of other surfaces", line(2).collect()));
    }
    let of = data.wish.others();
    let note = if surfaces < of {
        format!("{surfaces} of {of} other surfaces")
    } else {
        format!("{of} other surfaces")
    };
    figure.notes.push(note);
    corners
}

/// Steps between counts, half way between the values: a count has no sloping line between them.
fn stairs(points: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let mut steps: Vec<(f64, f64)> = Vec::new();
    for (x, y) in points {
        if let Some((before, last)) = steps.last().copied().filter(|(_, last)| last.total_cmp(y).is_ne()) {
            let middle = 0.5 * (before + x);
            steps.extend([(middle, last), (middle, *y)]);
        }
        steps.push((*x, *y));
    }
    steps
}

/// A single value is drawn as a line of zero length.
fn drawn(mut points: Vec<(f64, f64)>) -> Vec<(f64, f64)> {
    if let [only] = points[..] {
        points.push(only);
    }
    points
}

/// The study's result nearest to `x` on its axis: the value and the quantity, or why there is none; a force as in [`of`].
pub fn reading(data: &StudyData, preset: &Preset, axes: Axes, x: f64) -> Option<String> {
    let units = &data.wish.preset.units;
    let row = row(data, preset)?;
    let (at, value) = taken(data, preset, x)?;
    let shown = row.shown(units, value);
    let value = shown.text(&short(shown.number, 5), false);
    let found = match data.outcomes.get(at)? {
        StudyOutcome::Waits => "is being computed".to_owned(),
        StudyOutcome::Missing(why) => format!("none: {why}"),
        StudyOutcome::Found(Cell::Count(n)) => n.to_string(),
        StudyOutcome::Found(Cell::Number(y)) => {
            let quantity: Quantity = data.wish.column.quantity.unit;
            match data.divisors(axes) {
                Some(critical) if critical[at].is_nan() => "none: there is no Pc to divide by".to_owned(),
                Some(critical) => format!("{} Pc", significant(*y / critical[at], 5)),
                None => with_unit(units, quantity, *y, false, |y| significant(y, 5)),
            }
        }
    };
    Some(format!("{} {value}: {} {found}", greek(&row.label), words(data.wish.column)))
}

/// The point of the drawn study nearest to `x`, both on the axes of its figure on the screen; `None` where `x` is
/// nearest to a value for which there is nothing.
pub fn place(data: &StudyData, preset: &Preset, figure: &Figure, x: f64) -> Option<(f64, f64)> {
    let (at, _) = taken(data, preset, figure.values_at((x, 0.0)).0)?;
    if !matches!(data.outcomes.get(at)?, StudyOutcome::Found(_)) {
        return None;
    }
    on_line(figure, Role::Body, x)
}

/// The computed value nearest to `x` on its axis, in the units of the preset, and its index in the list.
pub fn taken(data: &StudyData, preset: &Preset, x: f64) -> Option<(usize, f64)> {
    let row = row(data, preset)?;
    let units = &data.wish.preset.units;
    let all = data.wish.values.iter().enumerate().filter_map(|(i, value)| Some((i, number(value)?)));
    let scale = scale_of(data);
    let away = |value: f64| (scale.place(row.shown(units, value).number) - scale.place(x)).abs();
    all.min_by(|a, b| away(a.1).total_cmp(&away(b.1)))
}

#[cfg(test)]
mod tests {
    use super::unbroken;

    #[test]
    fn a_jump_is_cut_and_a_steep_slope_is_not() {
        let of = |y: &dyn Fn(f64) -> f64| -> Vec<usize> {
            let points: Vec<(f64, f64)> = (0..101).map(|i| f64::from(i) / 100.0).map(|x| (x, y(x))).collect();
            unbroken(&points).iter().map(Vec::len).collect()
        };
        assert_eq!(of(&|x| x + if x > 0.5 { 0.3 } else { 0.0 }), [51, 50]);
        assert_eq!(of(&|x| x * x), [101]);
        // As steep as a jump, but with points on the slope.
        assert_eq!(of(&|x| ((x - 0.5) * 60.0).clamp(-1.0, 1.0)), [101]);
        assert_eq!(of(&|x| f64::from(u8::from(x > 0.3) + u8::from(x > 0.7))), [31, 40, 30]);
        assert_eq!(of(&|_| 1.0), [101]);
        assert_eq!(unbroken(&[(0.0, 1.0), (1.0, 2.0)]).len(), 1);
        assert!(unbroken(&[]).iter().all(Vec::is_empty));
    }
}
