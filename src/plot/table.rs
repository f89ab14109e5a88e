//! The data of a chart as CSV: what a person needs to draw it again in another program.

use super::chart::Chart;
use super::ink;

/// One row a point: the curve's name, its number among the curves, x, y; an empty x and y break a curve.
///
/// # Errors
/// When a row cannot be encoded, which no name can cause.
pub fn csv(chart: &Chart) -> Result<String, csv::Error> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(["name", "curve", &chart.x.title, &chart.y.title])?;
    let number = |x: f64| if x.is_finite() { format!("{x:?}") } else { String::new() };
    let mut curve = 0_usize;
    let mut row = |name: &str, points: &[(f64, f64)]| {
        curve += 1;
        let curve = curve.to_string();
        points.iter().try_for_each(|(x, y)| writer.write_record([name, &curve, &number(*x), &number(*y)]))
    };
    for line in &chart.lines {
        row(&line.name, &line.points)?;
    }
    for area in &chart.areas {
        row("energy lost", &area.outline)?;
    }
    for mark in &chart.marks {
        row(ink::stamp(mark.sign).name, &[mark.at])?;
    }
    let bytes = writer.into_inner().map_err(csv::IntoInnerError::into_error)?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}
