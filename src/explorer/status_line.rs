//! The status line: the last message, or else the state and the command that comes next.

use super::command::Id;
use super::model::{Level, Model, Walking};
use super::node::{Node, NodeKind};
use super::view::{Home, View};
use pulloff_engine::gap::wave_index;
use pulloff_engine::preset::edge;
use pulloff_engine::problem::{Begin, Control};
use pulloff_engine::quasistatic::EventKind;
use pulloff_engine::report::number::{loss, short, significant, with_unit};
use pulloff_engine::report::problem::control_word;
use pulloff_engine::units::Quantity;

/// The ways out of a state from which no walk can continue.
pub(super) fn back_or_anew() -> String {
    format!("{} goes back, {} starts again", Id::Undo.named(), Id::Restart.named())
}

/// Why nothing can be walked on a curve that stayed when a newer one was given up.
pub(super) fn of_before() -> String {
    format!(
        "the curve is the old one; {} restores its values, {} computes anew",
        Id::Undo.named(),
        Id::Restart.named()
    )
}

fn progress(model: &Model) -> String {
    let Some(stage) = model.stage else { return String::new() };
    format!(": {}; {} cancels", stage.text(), Id::Cancel.named())
}

impl Model {
    /// The message, or a hint. It may name commands; whatever shows it [spells](super::command::spelled) them.
    pub fn status(&self) -> (Level, String) {
        self.message.clone().unwrap_or_else(|| (Level::Info, hint(self)))
    }
}

/// The state and the next command; if the state is inadmissible, the reason first.
pub fn hint(model: &Model) -> String {
    let walker = model.walker().filter(|_| model.curve_error.is_none() && model.walking.is_none());
    let fault = walker.and_then(|node| fault(model, node));
    let next = next(model);
    match fault {
        Some(fault) => format!("Inadmissible: {fault}. {next}"),
        None => next,
    }
}

/// A reduced length of a state, in the user's units.
fn length(node: &Node, length: f64) -> String {
    let length = length * node.setting.units().length;
    with_unit(&node.setting.preset.units, Quantity::Length, length, false, |r| significant(r, 4))
}

/// A reduced loss.
fn energy(node: &Node, lost: f64) -> String {
    let lost = lost * node.setting.units().energy;
    with_unit(&node.setting.preset.units, Quantity::Energy, lost, false, loss)
}

/// Why a state is inadmissible, in words: the crest that would touch, or where the disc would have to pull.
fn fault(model: &Model, node: &Node) -> Option<String> {
    let (radius, crest) = node.fault_radius()?;
    let radius = length(node, radius);
    Some(match crest {
        Some(Some(number)) => format!("crest {number} would touch at r {radius}; {}", real_path(model)),
        Some(None) => format!("a crest would touch at r {radius}; {}", real_path(model)),
        None => format!("the disc would have to pull at r {radius}"),
    })
}

/// What happens instead of a state that one disc cannot be in.
fn real_path(model: &Model) -> String {
    match model.preset.path.begin {
        Begin::Apart => format!("{} leads back to the path", Id::Undo.named()),
        Begin::Disc => "begin = apart follows its rings".to_owned(),
    }
}

fn next(model: &Model) -> String {
    if let Some(error) = &model.curve_error {
        return error.text().to_owned();
    }
    let Some(node) = model.history.current() else {
        return format!("computing the equilibrium curve{}", progress(model));
    };
    if let Some(Walking { made, wanted, .. }) = model.walking {
        if model.is_running() {
            let [slower, faster] = [Id::Slower, Id::Faster].map(Id::named);
            let pace = short(model.pace, 3);
            return format!(
                "running, {pace} states a second: {slower} slower, {faster} faster, any other key pauses"
            );
        }
        let of = wanted.filter(|count| *count > 1).map_or_else(String::new, |count| format!(" of {count}"));
        let states = if made == 1 && of.is_empty() { "state" } else { "states" };
        return format!("walking, {made}{of} {states}; {} stops", Id::Cancel.named());
    }
    if let NodeKind::Stale(reason) = &node.kind {
        return format!("not solved: {reason}; {} starts again", Id::Restart.named());
    }
    if model.is_computing() {
        let waiting = match model.queue.len() {
            0 => String::new(),
            1 => ", 1 command waits for it".to_owned(),
            n => format!(", {n} commands wait for it"),
        };
        return format!("computing the curve for the new values{waiting}{}", progress(model));
    }
    let Some(control) = model.control() else { return String::new() };
    // A landing under the control before says nothing of the present one.
    if let Some(said) = happened(model, node).filter(|_| node.control == control || node.is_apart()) {
        return said;
    }
    if node.is_limit(control) {
        return limit_hint(model, node);
    }
    if let Some(said) = asks_of_pull(model).then(|| model.pull_said()).flatten() {
        return said;
    }
    if let Some(said) = (model.view.home() == Home::Data).then(|| model.fit_said()).flatten() {
        return said;
    }
    standing(model, node, control)
}

/// Whether a state that was solved again has the value of the control that the one before it had: its parent, or what was solved
/// for the values tried before, from which the walker then went on.
fn keeps_control(model: &Model, node: &Node) -> bool {
    // In the units of the states, as a spring's stiffness must be.
    let control = model.preset.path.control;
    let held = |node: &Node| {
        let state = node.state.in_units(node.setting.units());
        control.value(state.approach, state.force)
    };
    let is = held(node);
    let parent = model.history.parent();
    let tried = model.history.cursor().and_then(|at| model.history.node(at.checked_sub(1)?));
    let tried = tried.filter(|tried| tried.parent == parent);
    [parent.and_then(|parent| model.history.node(parent)), tried]
        .into_iter()
        .flatten()
        .map(held)
        .any(|was| (was - is).abs() <= 1e-9 * was.abs().max(is.abs()))
}

/// Where the walker stands and what a step or the next event does, if nothing else is to be said.
fn standing(model: &Model, node: &Node, control: Control) -> String {
    let way = if model.inward { "inward" } else { "outward" };
    let runs = if model.runs_inward(node) { "inward" } else { "outward" };
    let held = control_word(control);
    let kept = match control {
        _ if !keeps_control(model, node) => "where the walk begins".to_owned(),
        Control::Stiffness(_) => "with the spring's far end held".to_owned(),
        Control::Displacement | Control::Force => format!("at the {held} held"),
    };
    let [next, step] = [Id::NextEvent, Id::Step].map(Id::named);
    if !model.inward && model.is_at_outer_end() && node.stability.under(control) {
        let turn = Id::Reverse.named();
        return match model.preset.path.begin {
            Begin::Apart => {
                format!("Here the control turns round: {next} goes on down, {step} goes out, off the path")
            }
            Begin::Disc => {
                format!("Here the path begins: {turn} turns round, {step} goes on outward, off the path")
            }
        };
    }
    match (node.stability.under(control), &node.kind) {
        (true, NodeKind::Start) if model.preset.path.begin == Begin::Apart => {
            let is_first =
                |kind: EventKind| model.path_events().first().is_some_and(|event| event.kind == kind.name());
            if is_first(EventKind::JumpIn) {
                let contact = if node.state.contact_radius > 0.0 {
                    "into contact"
                } else {
                    "into range, without contact"
                };
                return format!("The bodies have jumped {contact}, event 1. {next} runs to the next event");
            }
            format!("The bodies have touched, event 1, and are at rest. {next} runs to the next event")
        }
        (true, NodeKind::Start) => {
            let help = Id::Help.named();
            format!("Start, stable under {held} control. {next} runs to the first event, {help} helps")
        }
        (true, NodeKind::Solved) if model.is_at_start() && !keeps_control(model, node) => {
            format!("No state of the new path has the value held: now at its start; {next} runs on")
        }
        (_, NodeKind::Solved) if node.on_path.is_some() => {
            format!("Nearest on the new path to the {held} held; {next} runs to the next event")
        }
        (true, NodeKind::Solved) => {
            format!("Solved again {kept}, stable. {next} runs to the next event")
        }
        (true, _) => {
            format!("Stable under {held} control. {step} steps {way}, {next} to the next event")
        }
        (false, NodeKind::Start | NodeKind::Moved) => {
            format!("This state is unstable under {held} control: {next} lets the edge run {runs}")
        }
        (false, NodeKind::Solved) => {
            format!("Solved again {kept}, unstable: {next} lets the edge run {runs}")
        }
        (false, _) => {
            format!("Off the path, unstable under {held} control: {next} lets the edge run {runs}")
        }
    }
}

/// Whether the person is looking at the pull: at its chart, or at a value on which only the pull depends.
fn asks_of_pull(model: &Model) -> bool {
    let is_of_edge = |key: &str| edge::KEYS.contains(&key);
    model.view == View::ForceTime || model.selected_knob().is_some_and(|(row, _)| is_of_edge(&row.key))
}

/// What a jump led to, or what is pending where a crest touches.
fn happened(model: &Model, node: &Node) -> Option<String> {
    if let NodeKind::Jump(event) = &node.kind {
        let lost = event.dissipated.map(|lost| format!(", lost {}", energy(node, lost)));
        let next = Id::NextEvent.named();
        return Some(match event.kind {
            EventKind::Turn => format!("Here the control turns round: {next} goes on down"),
            EventKind::Depin => format!("Here the resting edge begins to move: {next} goes on"),
            EventKind::FirstTouch if event.before == event.after => {
                format!("The bodies touch within the zone: {next} goes on")
            }
            EventKind::LastContact if event.after.is_some() => {
                format!("Contact has ended, but the zone still holds: {next} goes on")
            }
            // What was lost is none of the losses of the present values.
            EventKind::LastContact | EventKind::SnapOff if !model.is_of_present_values(node) => {
                format!("The bodies came apart at other values: {} starts again", Id::Restart.named())
            }
            EventKind::LastContact | EventKind::SnapOff => {
                let what = if event.kind == EventKind::SnapOff { "Snap-off" } else { "Last contact" };
                let whole = match model.preset.path.begin {
                    Begin::Apart => "",
                    Begin::Disc => "; begin=apart: whole loop",
                };
                let start = Id::Restart.named();
                format!("{what}: apart{}. {start} restarts{whole}", lost.unwrap_or_default())
            }
            _ => {
                let turns =
                    !model.inward && model.is_at_outer_end() && model.preset.path.begin == Begin::Apart;
                let goes_on = match model.inward {
                    _ if turns => format!("Here the control turns round: {next} goes on down"),
                    true => format!("{next} runs inward to the next event"),
                    false => format!("{next} runs outward to the next event"),
                };
                let undo = Id::Undo.named();
                format!("Landed{}, stable again. {goes_on}, {undo} undoes", lost.unwrap_or_default())
            }
        });
    }
    if let NodeKind::Touch(radius) = node.kind {
        let radius = length(node, radius);
        let [next, step] = [Id::NextEvent, Id::Step].map(Id::named);
        let name = event_here(model).map_or_else(String::new, |name| format!("{name}: "));
        return Some(format!(
            "{name}a crest touches at r {radius}; {next} takes it in; {step}: inadmissible"
        ));
    }
    None
}

/// The event of the path where the walker stands, named by its number.
fn event_here(model: &Model) -> Option<String> {
    let number = model.log().here()?.number?;
    Some(format!("Event {number} of {}", model.path_events().len()))
}

/// At the limit point `node`: where the edge would run and what that would cost.
fn limit_hint(model: &Model, node: &Node) -> String {
    let name = event_here(model).unwrap_or_else(|| match model.event_beginning_here() {
        Some(number) => format!("Event {number} begins here, and the walk goes the other way"),
        None => "Off the path".to_owned(),
    });
    let [next, jump, step] = [Id::NextEvent, Id::Jump, Id::Step].map(Id::named);
    let Some(ahead) = node.ahead else {
        return format!("{name}: {next} or {jump} lets the edge run, {step} goes on along the curve");
    };
    let wavelength = node.setting.reduced.gap.wavelength();
    let wave = ahead.after.and_then(|after| wave_index(after.contact_radius, wavelength));
    let outer = node.state.contact_radius;
    let lands = match (ahead.after, wave) {
        (None, _) => "lets the bodies come apart".to_owned(),
        (Some(_), Some(wave)) if node.has_rings() && wave_index(outer, wavelength) == Some(wave) => {
            "lets an inner edge jump".to_owned()
        }
        (Some(_), Some(wave)) => format!("lets the edge snap to crest {wave}"),
        (Some(after), None) => format!("lets the edge snap to s {}", length(node, after.contact_radius)),
    };
    let lost = ahead.dissipated.map(|lost| format!(" (loses {})", energy(node, lost)));
    // The edge runs over the unstable part: walking on in the same direction leads onto it.
    let runs_inward = ahead.after.is_none_or(|after| after.contact_radius < node.state.contact_radius);
    let part = if runs_inward == model.inward { "unstable" } else { "stable" };
    if model.curve.as_ref().is_some_and(|curve| curve.along.is_some()) {
        return format!("{name}: {next} or {jump} {lands}");
    }
    // The losses of its events are in the log.
    match lost.filter(|_| model.log().here().is_none()) {
        Some(lost) => format!("{name}: {next} or {jump} {lands}{lost}"),
        None => format!("{name}: {next} or {jump} {lands}; {step} goes on, {part}"),
    }
}
