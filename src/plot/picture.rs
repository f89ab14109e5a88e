//! A view of a session as a figure for print, including zoom, pins and theory.

use super::{Width, svg};
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
    let figure = figure.in_window(&model.window(view));
    let own_name = subject.own_name().filter(|_| view.is_curve());
    let figure = if let Some(name) = own_name { figure.naming(&name) } else { figure };
    Ok(svg::svg(&figure, Width::ONE_COLUMN))
}
