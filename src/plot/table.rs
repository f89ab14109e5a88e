//! The data of a figure as CSV: what a person needs to draw it again in another program.

use super::ink;
use crate::figure::Figure;

/// The first columns of every table; behind them are x and y, named as the axes.
const FIRST: [&str; 2] = ["name", "curve"];

/// One row a point: the curve's name, its number among the curves, x, y; an empty x and y break a curve.
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

/// Whether a file that begins with `line` is the table of a figure.
pub fn is_header(line: &str) -> bool {
    let mut reader = csv::ReaderBuilder::new().has_headers(false).from_reader(line.as_bytes());
    let record = reader.records().next().and_then(Result::ok);
    record.is_some_and(|fields| {
        fields.len() == FIRST.len() + 2 && fields.iter().zip(FIRST).all(|(a, b)| a == b)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::figure::Axis;

    #[test]
    fn a_table_is_known_by_its_first_line() {
        let axis = |title: &str| Axis::pure(title.to_owned());
        let figure = Figure::of(axis("E*, \"quoted\" (µm)"), axis("P/Pc"), Vec::new());
        let text = csv(&figure).unwrap();
        assert!(is_header(text.lines().next().unwrap()));
        for other in
            ["", "name,curve", "name,curve,x,y,z", "row,gap.amplitude,enhancement,error", "Name,curve,x,y"]
        {
            assert!(!is_header(other), "{other}");
        }
    }
}
