//! Which views have something to show now, why the others do not, and how to go from one to the next.

use super::command::Id;
use super::fitting::NO_POINTS;
use super::model::{Level, Model};
use super::node::Node;
use super::speeds::untimed;
use super::study::study_range;
use super::view::{Home, View};
use pulloff_engine::preset::Preset;
use pulloff_engine::problem::Control;
use pulloff_engine::report::pull::missing;

/// Why adhesion with a range has no such view.
pub const OF_SHORT_RANGE: &str = "with a range of the adhesion one radius does not fix the state: this is drawn for short-range \
                                  adhesion only";

/// Why a view has nothing to show now; `None` if it has, or will have once it is computed.
pub fn why_not(model: &Model, view: View) -> Option<String> {
    let node = model.history.current();
    match view {
        View::Stability | View::Differences | View::Energy if model.preset.cohesion().is_some() => {
            Some(OF_SHORT_RANGE.to_owned())
        }
        View::ForceApproach | View::ForceRadius | View::RadiusApproach | View::Stability => None,
        View::ForcePosition => no_spring(&model.preset),
        View::Pressure | View::Gap | View::Contact | View::Energy => {
            let apart = node.is_some_and(Node::is_apart);
            apart.then(|| "the bodies are apart: there is no contact".to_owned())
        }
        View::Unloading => {
            let unloading = model.curve.as_ref().map(|curve| &curve.unloading);
            unloading.and_then(|path| path.as_ref().err().map(|reason| format!("no path: {reason}")))
        }
        View::Cycle | View::ContactMap => {
            let cycle = model.cycle().filter(|cycle| cycle.is_of_preset(&model.preset));
            cycle.and_then(|cycle| Some(format!("no loop: {}", cycle.report.as_ref().err()?.text)))
        }
        View::ForceTime => missing(&model.preset).map(|why| why.to_string()),
        View::Map => (model.preset.material.work_of_adhesion <= 0.0)
            .then(|| "a gap without adhesion has no limit points".to_owned()),
        View::Residuals => model.preset.data.source.is_none().then(|| NO_POINTS.to_owned()),
        View::Speeds => untimed(&model.preset),
        View::Differences => (!has_others(model)).then(|| {
            format!(
                "nothing to compare with: {} pins a curve, {} draws theory",
                Id::Pin.named(),
                Id::Overlays.named()
            )
        }),
        View::Study => study_range(model).err(),
        View::Walk => (model.history.len() < 2)
            .then(|| format!("nothing walked yet: {} runs on", Id::NextEvent.named())),
    }
}

/// Why the far end of the device has no displacement of its own beside the approach; `None` if there is a spring.
pub fn no_spring(preset: &Preset) -> Option<String> {
    let is_spring = matches!(preset.path.control, Control::Stiffness(_));
    (!is_spring).then(|| {
        "the device has no spring, so its way is the approach: path.control gives it a stiffness".to_owned()
    })
}

/// Whether any other curve is drawn along with that of the preset.
fn has_others(model: &Model) -> bool {
    let theory = model.curve.as_ref().map(|curve| &curve.base.theory);
    let overlays = model.overlays;
    !model.pins.all().is_empty()
        || overlays.exact
        || overlays.smooth && theory.is_none_or(|theory| !theory.smooth.is_empty())
        || overlays.envelope && theory.is_none_or(|theory| theory.envelope.is_some())
}

/// The next view, or the one before, that has something to show.
pub fn next(model: &Model, forward: bool) -> View {
    // A view already shown beside it does not count.
    let is_beside = |view: View| model.views > 1 && model.view.is_of_force() && view == View::ForceRadius;
    let mut others = model.view.others(forward).filter(|view| !is_beside(*view));
    others.find(|view| why_not(model, *view).is_none()).unwrap_or(model.view)
}

/// Shows a view, and says so if there is nothing on it.
pub(super) fn show(model: &mut Model, view: View) {
    model.look_at(view);
    if let Some(why) = why_not(model, view) {
        model.tell(Level::Info, format!("{}: {why}", view.name()));
    }
}

/// Goes to a place: to the view last looked at there, or to one that has something to show.
pub(super) fn go(model: &mut Model, home: Home) {
    let last = model.homes[home as usize];
    let has = |view: &View| why_not(model, *view).is_none();
    let view = Some(last).filter(has).or_else(|| home.views().iter().copied().find(|view| has(view)));
    show(model, view.unwrap_or(last));
}

/// The selected line of the table of states, from 0: the walker's if none was chosen.
pub fn walk_line(model: &Model) -> usize {
    let last = model.history.path().len().saturating_sub(1);
    model.walk_line.map_or(last, |line| line.min(last))
}

/// Selects a line of the table of states; the last one follows the walker.
pub(super) fn pick_walk_line(model: &mut Model, line: usize) {
    let last = model.history.path().len().saturating_sub(1);
    model.walk_line = Some(line).filter(|line| *line < last);
}
