//! A figure as SVG. The library provides axes, ticks, legend and the document itself; the appearance of the roles is ours.

use super::Width;
use super::ink::{self, Stroke};
use crate::figure::{Axis, AxisScale, Bounds, Figure, Line, Mark, Meaning, Role, Sign};
use kuva::plot::fill_pattern::FillPattern;
use kuva::plot::legend::{LegendEntry, LegendPosition, LegendShape};
use kuva::plot::{LinePlot, LineStyle, ScatterPlot};
use kuva::prelude::{Layout, Plot, SvgBackend, TextAnnotation, Theme, TickAlign};
use kuva::render::color::Color;
use kuva::render::layout::{ComputedLayout, TickFormat};
use kuva::render::plots::Plot as Drawn;
use kuva::render::render::{PathData, Primitive, Scene, render_multiple};
use pulloff_engine::problem::Control;
use pulloff_engine::report::number::{printed, short};
use std::fmt::Write;
use std::sync::Arc;

/// The library counts in units of 1/96 inch.
const UNITS_PER_MM: f64 = 96.0 / 25.4;
/// The library leaves more room below the axis and below the legend than a figure on paper needs.
const NEARER: f64 = 8.0;
const CROPPED: f64 = 18.0;
/// The height of the plot area over its width.
const ASPECT: f64 = 0.72;
/// The same for a map, whose colour scale takes some of the width.
const MAP_ASPECT: f64 = 0.9;
/// Font sizes of 8 and 7 points in the library's units.
const LETTERS: u32 = 11;
const SMALL_LETTERS: u32 = 9;
/// The font size of a subscript.
const SUBSCRIPT: u32 = 8;
/// Font families of similar width; the library's estimates assume the first.
const FONT: &str = "DejaVu Sans, Verdana, Helvetica, Arial, sans-serif";
/// The distance of a letter from its point, as a share of the plot area.
const BESIDE: f64 = 0.035;
/// The name of the plot area's outline in the document; the library's own name would change from figure to figure.
const FIELD: &str = "field";

/// An axis whose largest number is in this range has plain numbers.
const PLAIN: (f64, f64) = (2e-3, 1e5);

/// `figure` as an SVG document of this width; the height follows from the size of the legend.
pub fn svg(figure: &Figure, width: Width) -> String {
    let wide = width.get() * UNITS_PER_MM;
    let legend = legend(figure);
    // The surroundings of the plot area do not depend on the height, so one trial gives them.
    let trial = ComputedLayout::from_layout(&layout(figure, &legend, wide, wide));
    let high = (wide - trial.plot_height() + aspect(figure) * trial.plot_width()).round();
    let layout = layout(figure, &legend, wide, high);
    let field = ComputedLayout::from_layout(&layout);
    let mut scene = render_multiple(plots(figure), layout);
    hatch(figure, &field, &mut scene);
    finish(&scene, cropped(&legend))
}

/// The height of the plot area over its width; where both axes have the same scale, a circle looks round.
fn aspect(figure: &Figure) -> f64 {
    let [x, y] = [figure.bounds.x, figure.bounds.y].map(|[lo, hi]| hi - lo);
    if figure.is_even { (y / x).clamp(0.2, 2.0) } else { ASPECT }
}

/// The amount cropped below the legend.
pub(super) fn cropped(legend: &[LegendEntry]) -> f64 {
    if legend.is_empty() { 0.0 } else { CROPPED }
}

/// The frame of a map over two ranges, with the scale of its colours, where it has one, beside it over `values`.
pub(super) fn frame(
    width: Width,
    titles: [String; 2],
    ranges: [[f64; 2]; 2],
    runs: [AxisScale; 2],
    values: Option<[f64; 2]>,
    legend: &[LegendEntry],
) -> Layout {
    let [x, y] = titles;
    let axis = |title: String, k: usize| Axis::pure(title).running(runs[k]);
    let bounds = Bounds { x: ranges[0], y: ranges[1] };
    let figure = Figure { bounds, ..Figure::of(axis(x, 0), axis(y, 1), Vec::new()) };
    let wide = width.get() * UNITS_PER_MM;
    let beside_colors = |high: f64| {
        let mut layout = layout(&figure, legend, wide, high);
        if let Some(values) = values {
            layout.show_colorbar = true;
            layout.colorbar_tick_format = ticks(values);
        }
        layout
    };
    let trial = ComputedLayout::from_layout(&beside_colors(wide));
    beside_colors((wide - trial.plot_height() + MAP_ASPECT * trial.plot_width()).round())
}

/// A scene as a document in millimetres, with `cropped` units cut off at the bottom.
pub(super) fn finish(scene: &Scene, cropped: f64) -> String {
    let own_name = scene.elements.iter().find_map(|element| match element {
        Primitive::ClipStart { id, .. } => Some(id.clone()),
        _ => None,
    });
    let mut text = SvgBackend::new().with_pretty(true).render_scene(scene);
    if let Some(name) = own_name {
        text = text.replace(&format!("\"{name}\""), &format!("\"{FIELD}\""));
        text = text.replace(&format!("#{name})"), &format!("#{FIELD})"));
    }
    // The pull-off force of the smooth sphere, written as in formulas.
    text = subscripted(&text.replace("/Pc<", "/P_c<"));
    in_millimetres(&text, scene.width, scene.height - cropped)
}

/// The document with the indices of forces as subscripts: `P_min`, `P_c`.
fn subscripted(text: &str) -> String {
    const FORCE: &str = "P_";
    /// How far below the line, in the library's units.
    const BELOW: f64 = 2.5;
    let mut parts = text.split(FORCE);
    let mut written = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let end = part.find(|c: char| !c.is_ascii_alphanumeric()).unwrap_or(part.len());
        let (index, rest) = part.split_at(end);
        // Writing to a String cannot fail.
        let _ = write!(written, "P<tspan dy=\"{BELOW}\" font-size=\"{SUBSCRIPT}\">{index}</tspan>");
        let mut behind = rest.chars();
        if let Some(first) = behind.next().filter(|first| *first != '<') {
            // Back to the baseline: the shift of the first letter applies to everything after it.
            let _ = write!(written, "<tspan dy=\"-{BELOW}\">{first}</tspan>{}", behind.as_str());
        } else {
            written.push_str(rest);
        }
    }
    written
}

/// The document with its size on paper; the library knows only its own units.
fn in_millimetres(text: &str, wide: f64, high: f64) -> String {
    let mm = |units: f64| (units / UNITS_PER_MM * 100.0).round() / 100.0;
    let (head, rest) = text.split_once('>').unwrap_or((text, ""));
    let kept = head.split(" width=").next().unwrap_or("<svg xmlns=\"http://www.w3.org/2000/svg\"");
    let mut svg = String::with_capacity(text.len() + 100);
    // Writing to a String cannot fail.
    let _ = write!(
        svg,
        r#"{kept} width="{}mm" height="{}mm" viewBox="0 0 {wide:.2} {high:.2}" font-family="{FONT}">"#,
        mm(wide),
        mm(high)
    );
    svg.push_str(rest);
    svg
}

fn layout(figure: &Figure, legend: &[LegendEntry], wide: f64, high: f64) -> Layout {
    let ([x, y], bounds) = ([&figure.x, &figure.y], &figure.bounds);
    let theme = Theme { show_grid: false, legend_border: "none".to_owned(), ..Theme::light() };
    let mut layout = Layout::new((bounds.x[0], bounds.x[1]), (bounds.y[0], bounds.y[1]))
        .with_theme(theme)
        .with_width(wide)
        .with_height(high)
        .with_x_label(plain(&x.title()))
        .with_y_label(plain(&y.title()))
        .with_label_size(LETTERS)
        .with_tick_size(SMALL_LETTERS)
        .with_body_size(SMALL_LETTERS)
        .with_font_family(FONT)
        .with_x_label_offset(0.0, -NEARER)
        .with_ticks(5)
        .with_tick_length(3.5)
        .with_tick_align(TickAlign::Inside)
        .with_axis_line_width(0.7)
        .with_tick_width(0.7)
        .with_box_axes()
        .with_show_grid(false)
        .with_x_axis_min(bounds.x[0])
        .with_x_axis_max(bounds.x[1])
        .with_y_axis_min(bounds.y[0])
        .with_y_axis_max(bounds.y[1]);
    layout = match x.run {
        AxisScale::Linear => layout.with_x_tick_format(ticks(bounds.x)),
        AxisScale::Counted => layout.with_x_tick_format(whole()),
        AxisScale::Logarithmic => layout.with_log_x().with_x_tick_format(factors(bounds.x)),
    };
    layout = match y.run {
        AxisScale::Linear => layout.with_y_tick_format(ticks(bounds.y)),
        AxisScale::Counted => layout.with_y_tick_format(whole()),
        AxisScale::Logarithmic => layout.with_log_y().with_y_tick_format(factors(bounds.y)),
    };
    if !legend.is_empty() {
        layout = layout
            .with_legend_entries(legend.to_vec())
            .with_legend_position(LegendPosition::OutsideBottomColumns)
            .with_legend_box(false);
    }
    for mark in &figure.marks {
        let (x, y) = mark.at;
        if let Sign::Letter(letter) = mark.sign {
            // To the right of its point and below it.
            let [right, down] = [bounds.x, bounds.y].map(|[lo, hi]| BESIDE * (hi - lo));
            let text = TextAnnotation::new(letter.to_string(), x + right, y - down);
            layout = layout.with_annotation(text.with_font_size(LETTERS));
        }
        let text = match mark.sign {
            Sign::Snaps(count) => count.to_string(),
            Sign::OfCrest(crest) => format!("c{crest}"),
            _ => continue,
        };
        layout = layout.with_annotation(TextAnnotation::new(text, x, y).with_font_size(SMALL_LETTERS));
    }
    if let Some(reason) = &figure.missing {
        let [x, y] = [bounds.x, bounds.y].map(|[lo, hi]| 0.5 * lo + 0.5 * hi);
        layout =
            layout.with_annotation(TextAnnotation::new(plain(reason), x, y).with_font_size(SMALL_LETTERS));
    }
    layout
}

/// One format for all numbers of an axis: plain, or with the power of ten of the largest one.
fn ticks([lo, hi]: [f64; 2]) -> TickFormat {
    let largest = lo.abs().max(hi.abs());
    // A remainder of rounding is shown as zero.
    let clean = move |x: f64| if x.abs() < 1e-9 * largest { 0.0 } else { x };
    if largest == 0.0 || (PLAIN.0..PLAIN.1).contains(&largest) {
        return TickFormat::Custom(Arc::new(move |x| printed(&short(clean(x), 6))));
    }
    let power = largest.log10().floor();
    TickFormat::Custom(Arc::new(move |x| match short(clean(x) / 10.0_f64.powf(power), 6) {
        zero if zero == "0" => zero,
        mantissa => printed(&format!("{mantissa}e{power}")),
    }))
}

/// The same for an axis of counts: a tick between two whole numbers has no label.
fn whole() -> TickFormat {
    TickFormat::Custom(Arc::new(|x| if (x - x.round()).abs() < 1e-6 { short(x, 6) } else { String::new() }))
}

/// The same for a logarithmic axis.
fn factors([lo, hi]: [f64; 2]) -> TickFormat {
    if PLAIN.0 <= lo && hi < PLAIN.1 {
        return TickFormat::Custom(Arc::new(|x| short(x, 3)));
    }
    TickFormat::Custom(Arc::new(|x| {
        let power = x.log10().floor();
        let text = printed(&format!("{}e{power}", short(x / 10.0_f64.powf(power), 3)));
        text.strip_prefix("1×").map_or(text.clone(), str::to_owned)
    }))
}

/// A text as it is: the library takes a dollar sign as the start of a formula, and no document may contain control characters.
pub(super) fn plain(text: &str) -> String {
    text.chars().filter(|c| !c.is_control()).collect::<String>().replace('$', "\\$")
}

pub(super) fn entry(name: &str, color: &str, shape: LegendShape, dashes: &str) -> LegendEntry {
    let dasharray = (!dashes.is_empty()).then(|| dashes.to_owned());
    LegendEntry { label: plain(name), color: color.to_owned(), shape, dasharray }
}

/// Every name once, lines before marks; a mark out of sight needs none.
fn legend(figure: &Figure) -> Vec<LegendEntry> {
    let mut named: Vec<&Line> = figure.lines.iter().filter(|line| !line.name.is_empty()).collect();
    // The computed curve first, as on the screen; of a curve in two strokes that of its stable parts.
    named.sort_by_key(|line| match line.role {
        Role::Pin(number) => (1, std::cmp::Reverse(Role::Pin(usize::MAX - number)), line.is_broken),
        role => (0, std::cmp::Reverse(role), line.is_broken),
    });
    let mut entries: Vec<LegendEntry> = Vec::new();
    let mut add = |entry: LegendEntry| {
        if !entries.iter().any(|other| other.label == entry.label) {
            entries.push(entry);
        }
    };
    for line in named {
        let Stroke { color, dashes, .. } = stroke(line);
        add(entry(&line.name, color, LegendShape::Line, dashes));
    }
    let shown = figure.marks.iter().filter(|mark| figure.bounds.share(mark.at).is_some());
    let own = own_limit(figure);
    for (sign, stamp) in shown.map(|mark| (mark.sign, ink::stamp(mark.sign))) {
        let name = if matches!(sign, Sign::Limit | Sign::Event(_)) { own } else { stamp.name };
        if !name.is_empty() {
            add(entry(name, stamp.color, LegendShape::Marker(stamp.shape), ""));
        }
    }
    // What is written on a map.
    let is_written = |is: fn(Sign) -> bool| figure.marks.iter().any(|mark| is(mark.sign));
    if is_written(|sign| matches!(sign, Sign::Snaps(_))) {
        add(entry("1, 2, …: number of snaps", "none", LegendShape::Line, ""));
    }
    if is_written(|sign| matches!(sign, Sign::OfCrest(_))) {
        add(entry("c1, c2, …: crest of the line", "none", LegendShape::Line, ""));
    }
    for area in &figure.areas {
        add(match area.meaning {
            Meaning::Lost => hatched(Meaning::Lost.name()),
            meaning => entry(meaning.name(), tint(meaning), LegendShape::Rect, ""),
        });
    }
    entries
}

/// The name of a limit point of the control: by what is controlled, where limit points of the other control make that necessary.
fn own_limit(figure: &Figure) -> &'static str {
    let has = |wanted: Control| figure.marks.iter().any(|mark| mark.sign == Sign::OtherLimit(wanted));
    match (has(Control::Force), has(Control::Displacement)) {
        (true, false) => ink::stamp(Sign::OtherLimit(Control::Displacement)).name,
        (false, true) => ink::stamp(Sign::OtherLimit(Control::Force)).name,
        _ => ink::stamp(Sign::Limit).name,
    }
}

/// The hatching of an area.
const PATTERN: FillPattern = FillPattern::DiagonalForward;
/// The tint under the hatching of an energy.
const LOST: &str = "#f3d9e6";
/// The tint of contact, without hatches.
const CONTACT: &str = "#b9d7ea";
/// The tint of contact in which the bodies pull.
const TENSION: &str = "#f6cfb5";
/// The ranges of 90 % and of half of an ensemble; distinguishable in a grey print.
const MOST: &str = "#d9e8f3";
const HALF: &str = "#93bedd";

/// The fill of an area without hatching, or the background of the hatching.
fn tint(meaning: Meaning) -> &'static str {
    match meaning {
        Meaning::Lost => LOST,
        Meaning::Contact => CONTACT,
        Meaning::Tension => TENSION,
        Meaning::Most => MOST,
        Meaning::Half => HALF,
    }
}

pub(super) fn hatched(name: &str) -> LegendEntry {
    entry(name, &format!("url(#{})", PATTERN.id()), LegendShape::Rect, "")
}

fn plots(figure: &Figure) -> Vec<Plot> {
    // The dots of the exact solution lie on the line that they agree with.
    let (exact, others): (Vec<&Line>, Vec<&Line>) =
        figure.lines.iter().partition(|line| line.role == Role::Exact);
    // Measured points are drawn behind everything.
    let is_measured = |mark: &&Mark| matches!(mark.sign, Sign::Measured { .. });
    // Numbers of snaps are written, not drawn as marks.
    let stamped = figure.marks.iter().filter(|mark| !matches!(mark.sign, Sign::Snaps(_)));
    let (behind, mut above): (Vec<Mark>, Vec<Mark>) = stamped.partition(is_measured);
    // The smaller a mark, the later it is drawn, so that all are visible where they meet: A and B are limit points too.
    above.sort_by_key(|mark| match mark.sign {
        Sign::LargestPull | Sign::Farthest => 0,
        Sign::OtherLimit(_) => 2,
        _ => 1,
    });
    let of = |some: &[Mark]| some.chunk_by(|a, b| a.sign == b.sign).filter_map(marks).collect::<Vec<_>>();
    let mut plots: Vec<Drawn> = of(&behind);
    plots.extend(others.into_iter().chain(exact).flat_map(line));
    plots.extend(of(&above));
    if plots.is_empty() {
        // With nothing to draw, the library draws no axes either.
        plots.push(LinePlot::new().into());
    }
    plots
}

/// The stroke of a line: that of its role, or dots where it is a second, broken line of that role.
fn stroke(line: &Line) -> Stroke {
    let whole = ink::stroke(line.role);
    if line.is_broken { Stroke { dashes: "1 1.8", ..whole } } else { whole }
}

pub(super) fn line(line: &Line) -> Vec<Drawn> {
    let Stroke { color, width, dashes } = stroke(line);
    line.points
        .split(|(x, y)| !(x.is_finite() && y.is_finite()))
        .filter(|piece| piece.len() > 1)
        .map(|piece| {
            let plot =
                LinePlot::new().with_data(piece.iter().copied()).with_color(color).with_stroke_width(width);
            let style =
                if dashes.is_empty() { LineStyle::Solid } else { LineStyle::Custom(dashes.to_owned()) };
            plot.with_line_style(style).into()
        })
        .collect()
}

fn marks(marks: &[Mark]) -> Option<Drawn> {
    let stamp = ink::stamp(marks.first()?.sign);
    let places: Vec<(f64, f64)> =
        marks.iter().map(|mark| mark.at).filter(|(x, y)| x.is_finite() && y.is_finite()).collect();
    let plot = || ScatterPlot::new().with_color(stamp.color).with_size(stamp.size).with_marker(stamp.shape);
    (!places.is_empty()).then(|| plot().with_data(places).into())
}

pub(super) fn outline(points: &[(f64, f64)], field: &ComputedLayout) -> String {
    let mut data = String::new();
    for (i, (x, y)) in points.iter().filter(|(x, y)| x.is_finite() && y.is_finite()).enumerate() {
        let letter = if i == 0 { 'M' } else { 'L' };
        // Writing to a String cannot fail.
        let _ = write!(data, "{letter}{:.2},{:.2} ", field.map_x(*x), field.map_y(*y));
    }
    data.push('Z');
    data
}

/// Areas with this path data, hatched over a tint.
pub(super) fn hatches(areas: impl Iterator<Item = String>, tint: &str, scene: &mut Scene) -> Vec<Primitive> {
    scene.defs.push(PATTERN.svg_def().to_owned());
    let fills = [Color::from(tint), Color::from(format!("url(#{})", PATTERN.id()))];
    areas.flat_map(|area| fills.clone().map(|fill| filled(area.clone(), fill))).collect()
}

pub(super) fn filled(d: String, fill: Color) -> Primitive {
    Primitive::Path(Box::new(PathData {
        d,
        fill: Some(fill),
        stroke: Color::None,
        stroke_width: 0.0,
        opacity: None,
        stroke_dasharray: None,
    }))
}

/// Inserts the areas below the lines.
fn hatch(figure: &Figure, field: &ComputedLayout, scene: &mut Scene) {
    let begin = scene.elements.iter().position(|element| matches!(element, Primitive::ClipStart { .. }));
    let (Some(begin), false) = (begin, figure.areas.is_empty()) else { return };
    let of = |meaning| figure.areas.iter().filter(move |area| area.meaning == meaning);
    // A later area covers the earlier ones.
    let plain = [Meaning::Contact, Meaning::Tension, Meaning::Most, Meaning::Half].into_iter().flat_map(of);
    let mut paths: Vec<Primitive> =
        plain.map(|area| filled(outline(&area.outline, field), tint(area.meaning).into())).collect();
    if of(Meaning::Lost).next().is_some() {
        paths.extend(hatches(of(Meaning::Lost).map(|area| outline(&area.outline, field)), LOST, scene));
    }
    scene.elements.splice(begin + 1..=begin, paths);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn indices_stand_below_the_line_and_what_follows_on_it() {
        let index = |text: &str| format!("P<tspan dy=\"2.5\" font-size=\"8\">{text}</tspan>");
        let back = |text: &str| format!("<tspan dy=\"-2.5\">{text}</tspan>");
        assert_eq!(subscripted("<text>P/P_c</text>"), format!("<text>P/{}</text>", index("c")));
        assert_eq!(
            subscripted("<text>P_min/P_c (N)</text>"),
            format!("<text>{}{}{}{}(N)</text>", index("min"), back("/"), index("c"), back(" "))
        );
        assert_eq!(subscripted("<text>P</text>"), "<text>P</text>");
    }
    use crate::figure::Area;

    fn figure(lines: Vec<Line>) -> Figure {
        let axis = || Axis::pure(String::new());
        Figure::of(axis(), axis(), lines)
    }

    #[test]
    fn the_numbers_of_an_axis_have_one_format() {
        let all = |bounds, ticks: &[f64]| -> Vec<String> {
            let format = super::ticks(bounds);
            ticks.iter().map(|tick| format.format(*tick)).collect()
        };
        assert_eq!(all([-0.004, 0.02], &[-1e-19, 0.005, 0.01, 0.015]), ["0", "0.005", "0.01", "0.015"]);
        assert_eq!(all([0.0, 2e-5], &[0.0, 5e-6, 1e-5]), ["0", "0.5×10⁻⁵", "1×10⁻⁵"]);
        assert_eq!(all([-3e7, 1e6], &[-2e7, -5e6]), ["−2×10⁷", "−0.5×10⁷"]);
        let all = |bounds, ticks: &[f64]| -> Vec<String> {
            let format = super::factors(bounds);
            ticks.iter().map(|tick| format.format(*tick)).collect()
        };
        assert_eq!(all([0.002, 50.0], &[0.002, 0.01, 0.1, 1.0, 20.0]), ["0.002", "0.01", "0.1", "1", "20"]);
        assert_eq!(all([1e-7, 0.1], &[1e-7, 2e-5, 0.1]), ["10⁻⁷", "2×10⁻⁵", "10⁻¹"]);
    }

    #[test]
    fn nothing_a_point_and_numbers_that_are_none_are_valid_documents() {
        let nan = f64::NAN;
        let missing = Figure { missing: Some("no path: $1 <&> \u{1b}".to_owned()), ..figure(Vec::new()) };
        let broken =
            Line::new(Role::Stable, "a < b & \"c\"", vec![(0.0, 1.0), (nan, 2.0), (1.0, 2.0), (2.0, 1e300)]);
        let mut full = figure(vec![broken]);
        for meaning in [Meaning::Lost, Meaning::Contact] {
            let outline = vec![(0.0, 0.0), (nan, 1.0), (1.0, 1.0)];
            full.areas.push(Area { meaning, outline, lost: None });
        }
        full.marks.push(Mark { sign: Sign::Limit, at: (0.5, nan) });
        let log = Axis::pure(String::new()).running(AxisScale::Logarithmic);
        let negative =
            Figure::of(log.clone(), log, vec![Line::new(Role::Body, "", vec![(-1.0, 2.0), (1.0, 0.0)])]);
        for figure in [
            figure(Vec::new()),
            figure(vec![Line::new(Role::Stable, "one", vec![(1.0, 2.0)])]),
            missing,
            full,
            negative,
        ] {
            for width in [Width::ONE_COLUMN, Width::TWO_COLUMNS] {
                let text = svg(&figure, width);
                let document = roxmltree::Document::parse(&text).unwrap();
                assert_eq!(document.root_element().tag_name().name(), "svg");
                assert!(!text.contains("NaN"), "{text}");
                #[cfg(feature = "png")]
                assert!(crate::print::PictureFormat::Png.bytes(&text).unwrap().starts_with(b"\x89PNG"));
            }
        }
    }

    #[test]
    fn the_legend_names_only_the_signs_in_sight() {
        let mut figure = figure(vec![Line::new(Role::Stable, "curve", vec![(0.0, 0.0), (1.0, 1.0)])]);
        figure.marks = vec![
            Mark { sign: Sign::Limit, at: (0.8, 0.8) },
            Mark { sign: Sign::LastContact(1), at: (0.1, 0.1) },
        ];
        let names = |figure: &Figure| legend(figure).into_iter().map(|entry| entry.label).collect::<Vec<_>>();
        assert_eq!(names(&figure), ["curve", "limit point", "last contact"]);
        let close = figure.across("0.5..".parse().unwrap()).unwrap();
        assert_eq!(names(&close), ["curve", "limit point"]);
        assert_eq!(names(&close.clone().naming("A 2")), ["A 2, curve", "limit point"]);
        // Beside those of the force, they are those of the approach.
        let force = Mark { sign: Sign::OtherLimit(Control::Force), at: (0.9, 0.9) };
        let both = Figure { marks: [vec![force], close.marks.clone()].concat(), ..close };
        assert_eq!(names(&both), ["curve", "limit of P", "limit of δ"]);
    }

    #[test]
    fn a_chart_is_the_same_document_every_time() {
        let figure = figure(vec![Line::new(Role::Stable, "curve", vec![(0.0, 0.0), (1.0, 1.0)])]);
        assert_eq!(svg(&figure, Width::ONE_COLUMN), svg(&figure, Width::ONE_COLUMN));
    }
}
