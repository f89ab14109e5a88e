//! What the lines and letters of a figure mean; and the cross-hair in words.

use crate::explorer::{Model, View, pins};
use crate::figure::{Bounds, Figure, Role, Sign, Subject, map, nearest, reading, study};
use crate::tui::chart::LegendRow;
use crate::tui::marks::{glyph, letter, look, rank, style};
use crate::tui::theme::Theme;

/// What is in the window of a figure, the most important first: the curve, pins, the walk, the marks, theory, the rest.
pub fn legend(figure: &Figure, bounds: &Bounds, theme: Theme) -> Vec<LegendRow> {
    let mut words: Vec<(u8, LegendRow)> = Vec::new();
    let mut add = |rank: u8, entry: LegendRow| {
        if !words.iter().any(|(_, other)| other.meaning == entry.meaning) {
            words.push((rank, entry));
        }
    };
    // A line can cross the window without a point in it.
    let meets = |[lo, hi]: [f64; 2], a: f64, b: f64| a.min(b) <= hi && a.max(b) >= lo;
    let crosses =
        |pair: &[(f64, f64)]| meets(bounds.x, pair[0].0, pair[1].0) && meets(bounds.y, pair[0].1, pair[1].1);
    let is_seen = |points: &[(f64, f64)]| points.windows(2).any(crosses);
    for line in figure.lines.iter().filter(|line| !line.name.is_empty() && is_seen(&line.points)) {
        let style = look(line.role, theme).style;
        let meaning = theme.symbols(&line.name);
        add(rank(line.role, theme), LegendRow { glyph: glyph(line.role, theme), style, meaning });
    }
    for mark in figure.marks.iter().filter(|mark| bounds.share(mark.at).is_some()) {
        if let Some((rank, word)) = meaning(mark.sign) {
            let glyph = match mark.sign {
                Sign::Event(1..=9) | Sign::Passing(1..=9) | Sign::LastContact(1..=9) => "1-9".to_owned(),
                Sign::Snaps(_) => "0-9".to_owned(),
                Sign::OfCrest(_) => "c1".to_owned(),
                sign => letter(sign, theme),
            };
            add(rank, LegendRow { glyph, style: style(mark.sign, theme), meaning: word.to_owned() });
        }
    }
    // Entries of equal rank keep the order of the figure; pins are ordered by number.
    words.sort_by_key(|(rank, _)| *rank);
    words.into_iter().map(|(_, entry)| entry).collect()
}

/// What a sign means, and its rank in the legend.
fn meaning(sign: Sign) -> Option<(u8, &'static str)> {
    Some(match sign {
        Sign::Stray | Sign::Value | Sign::Letter(_) => return None,
        Sign::OtherLimit(_) | Sign::Limit => (9, "limit off the path"),
        Sign::Event(1..=9) | Sign::Passing(1..=9) | Sign::LastContact(1..=9) => (4, "event"),
        Sign::Event(_) | Sign::Passing(_) => (7, "event from 10 on"),
        Sign::LastContact(_) => (7, "last contact"),
        Sign::LargestPull => (5, "largest pull"),
        Sign::Farthest => (5, "farthest"),
        Sign::Landing => (7, "landing"),
        Sign::Touch => (5, "touch"),
        Sign::Turn => (5, "turn"),
        Sign::Crest => (8, "crest"),
        Sign::Edge => (8, "edge"),
        Sign::Minimum => (5, "minimum"),
        Sign::Maximum => (5, "maximum"),
        Sign::Barrier => (5, "barrier"),
        Sign::Walker => (8, "here"),
        Sign::Preset => (3, "now"),
        Sign::Cusp => (5, "cusp"),
        Sign::Swallowtail => (5, "swallowtail"),
        Sign::Snaps(_) => (0, "snaps"),
        Sign::OfCrest(_) => (4, "crest"),
        Sign::Measured { loading: true, apart: false } => (4, "measured approach"),
        Sign::Measured { loading: false, apart: false } => (4, "measured retraction"),
        Sign::Measured { loading: true, apart: true } => (4, "measured approach, apart"),
        Sign::Measured { loading: false, apart: true } => (4, "measured retraction, apart"),
    })
}

/// Whether the cross-hair of a view reads the nearest of its lines.
fn has_lines(view: View) -> bool {
    matches!(
        view,
        View::Pressure | View::Gap | View::Energy | View::Unloading | View::Cycle | View::Differences
    )
}

/// Where the cross-hair at `at` belongs: on the line of a view that has one value for each place of its axis.
pub fn on_its_line(subject: &Subject<'_>, view: View, figure: &Figure, at: (f64, f64)) -> (f64, f64) {
    let on = match (view, &subject.study) {
        (View::Study, Some(Ok(data))) => study::place(data, subject.preset, figure, at.0),
        (View::ForceTime, _) => reading::on_line(figure, Role::Pull, at.0),
        (view, _) if has_lines(view) => reading::on_nearest_line(figure, at).map(|(on, _)| on),
        _ => None,
    };
    on.unwrap_or(at)
}

/// The cross-hair in words: on a curve the nearest state, then both coordinates.
pub fn reading(model: &Model) -> Option<String> {
    let (share, view) = (model.cross?, model.view);
    if view.is_table() {
        return None;
    }
    let subject = Subject::of(model)?;
    let figure = subject.figure(view).on_screen();
    if figure.lines.is_empty() && figure.marks.is_empty() {
        // It is not computed yet, or there is none.
        return None;
    }
    let bounds = figure.bounds.part(&model.window(view));
    let at = on_its_line(&subject, view, &figure, bounds.at(share));
    let here = reading::coordinates(&bounds, [&figure.x, &figure.y], at);
    if let (View::Study, Some(Ok(data))) = (view, &subject.study) {
        return study::reading(data, subject.preset, subject.axes, figure.values_at(at).0);
    }
    let snaps = match (view, subject.map) {
        (View::Map, Some(Ok(report))) => map::count(report, subject.preset, figure.values_at(at)),
        _ => None,
    };
    if let Some(snaps) = snaps {
        return Some(format!("{snaps}; + {here}"));
    }
    Some(match nearest(&subject, view, &bounds, at) {
        // The state comes first: it is new information, and narrow screens cut off the end.
        Some(nearest) => format!("* {}; + {here}", nearest.text(subject.scale())),
        None => match reading::on_nearest_line(&figure, at).filter(|_| has_lines(view)) {
            Some((_, line)) if figure.lines.len() > 1 && !line.name.is_empty() => {
                let pin = if let Role::Pin(number) = line.role {
                    format!("{} ", pins::letter(number))
                } else {
                    String::new()
                };
                format!("+ {here} on {pin}{}", line.name)
            }
            _ => format!("+ {here}"),
        },
    })
}
