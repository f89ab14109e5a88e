//! A view of a session as a figure for print: zoom, pins and theory with it.

use super::{Chart, Width, svg};
use crate::explorer::{Model, View};
use crate::figure::Subject;

/// The view as SVG.
/// Errors: Why there is nothing to draw, in words.
pub fn picture(model: &Model, view: View) -> Result<String, String> {
    let subject = Subject::of(model).ok_or("there is no curve to draw yet")?;
    let figure = subject.figure(view);
    if let Some(missing) = &figure.missing {
        return Err(format!("{}: {missing}", view.name()));
    }
    let chart = Chart::of(&figure, &model.window(view));
    let own_name = subject.own_name().filter(|_| view.is_curve());
    let chart = if let Some(name) = own_name { chart.naming(&name) } else { chart };
    Ok(svg::svg(&chart, Width::ONE_COLUMN))
}
