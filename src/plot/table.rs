//! The data of a figure as CSV: what is needed to draw it again in another program.

use super::ink;
use crate::figure::Figure;

/// The first columns of every table, followed by x and y, which are named as the axes.
const FIRST: [&str; 2] = ["name", "curve"];

/// One row per point: the curve's name, its number among the curves, x, y; an empty x and y break a curve.
pub fn csv(figure: &Figure) -> Result<String, csv::Error> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record([FIRST[0], FIRST[1], &figure.x.title(), &figure.y.title()])?;
    let number = |x: f64| if x.is_finite() { format!("{x:?}") } else { String::new() };
    let mut curve = 0_usize;
    let mut row = |name: &str, points: &[(f64, f64)]| {
        curve += 1;
        let curve = curve.to_string();
        points.iter().try_for_each(|(x, y)| writer.write_record([name, &curve, &number(*x), &number(*y)]))
    };
    for line in &figure.lines {
        row(&line.name, &line.points)?;
    }
    for area in &figure.areas {
        row(area.meaning.name(), &area.outline)?;
    }
    for mark in &figure.marks {
        row(ink::stamp(mark.sign).name, &[mark.at])?;
    }
    let bytes = writer.into_inner().map_err(csv::IntoInnerError::into_error)?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}
