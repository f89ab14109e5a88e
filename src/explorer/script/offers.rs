//! What can be typed after the name of a command, as the screen lists it.

use super::lexer::quoted;
use crate::explorer::branches;
use crate::explorer::command::Command;
use crate::explorer::export::{Export, file_for};
use crate::explorer::look::NO_ENVELOPE;
use crate::explorer::map_axes::{CURVES, key_of};
use crate::explorer::model::Model;
use crate::explorer::pinned::Compared;
use crate::explorer::pins::{self, Pin};
use crate::explorer::reach;
use crate::explorer::view::{Home, Overlay, View};
use crate::store::shipped::{self, SHIPPED};
use pulloff_engine::preset::called::settable;
use pulloff_engine::preset::groups::GROUPS;
use pulloff_engine::preset::measured::SHIPPED_DATA;
use pulloff_engine::preset::schema::{AUTO, Kind, NONE};
use pulloff_engine::preset::{Parameter, Preset};
use pulloff_engine::report::PathReport;
use pulloff_engine::report::number::{loss, significant, with_unit};
use pulloff_engine::stability::COMPLIANCE;
use pulloff_engine::stability::axis::is_blind;
use pulloff_engine::sweep::{QUANTITIES, SweepQuantity};
use pulloff_engine::units::Quantity;

/// What a device can prescribe.
pub const CONTROLS: [&str; 3] = ["displacement", "force", "stiffness="];
/// What the device does under each of these controls.
pub const DEVICES: [&str; 3] = ["fixed grips hold δ", "a dead load holds P", "a spring holds its far end"];

/// The names of what is in a folder, which is given with its final `/`, as a line would name them; folders end with
/// `/`.
pub type FolderNames<'a> = &'a dyn Fn(&str) -> Vec<String>;

/// A line being typed.
pub struct Typing<'a> {
    pub model: &'a Model,
    /// The words between the name of the command and the last one.
    pub words: &'a [&'a str],
    /// The last word, as far as it is typed.
    pub word: &'a str,
    pub files: FolderNames<'a>,
}

/// Something that can be typed.
#[derive(Debug, Clone)]
pub struct Offer {
    pub word: String,
    /// What it is, if a list has room to say it.
    pub says: String,
    /// Whether it is already so.
    pub is_here: bool,
    /// What it does, if its word does not say so.
    pub does: Option<Command>,
}

impl Offer {
    pub(in crate::explorer) fn new(word: impl Into<String>, says: impl Into<String>) -> Self {
        Self { word: word.into(), says: says.into(), is_here: false, does: None }
    }
}

/// Words that explain themselves.
pub fn words<'a>(words: impl IntoIterator<Item = &'a str>) -> Vec<Offer> {
    words.into_iter().map(|word| Offer::new(word, "")).collect()
}

pub(in crate::explorer) fn controls(_: &Typing<'_>) -> Vec<Offer> {
    CONTROLS.iter().zip(DEVICES).map(|(word, says)| Offer::new(*word, says)).collect()
}

pub(in crate::explorer) fn places(_: &Typing<'_>) -> Vec<Offer> {
    Home::ALL.map(|home| Offer::new(home.name(), home.question())).to_vec()
}

/// All views; those with nothing to show say why.
pub(in crate::explorer) fn views(typing: &Typing<'_>) -> Vec<Offer> {
    let offer = |view: View| {
        let why = reach::why_not(typing.model, view);
        let says = why.map_or_else(|| view.meaning().to_owned(), |why| format!("- {why}"));
        Offer { is_here: view == typing.model.view, ..Offer::new(view.name(), says) }
    };
    View::ALL.map(offer).to_vec()
}

/// The quantities that can be studied.
pub(in crate::explorer) fn quantities(typing: &Typing<'_>) -> Vec<Offer> {
    if !typing.words.is_empty() {
        return if typing.words.len() > 1 { Vec::new() } else { numbers(&typing.model.preset) };
    }
    let all = QUANTITIES.iter().flat_map(SweepQuantity::columns);
    all.map(|column| {
        let name = column.name();
        let is_here = name == typing.model.studied.name();
        // Its name ends with the control, unless that is the preset's own.
        let control = name.strip_prefix(column.quantity.name).and_then(|rest| rest.strip_prefix('_'));
        let under = control.map_or_else(String::new, |control| format!(" (under {control})"));
        Offer { is_here, ..Offer::new(name, format!("{}{under}", column.quantity.meaning)) }
    })
    .collect()
}

/// What can be drawn over the curve.
pub(in crate::explorer) fn theories(typing: &Typing<'_>) -> Vec<Offer> {
    let theory = typing.model.curve.as_ref().map(|curve| &curve.base.theory);
    let offer = |overlay: Overlay| {
        let says = match (overlay, theory) {
            (Overlay::Smooth, theory) => {
                format!(
                    "smooth sphere{}",
                    theory.map_or_else(String::new, |t| format!(" ({})", t.smooth_name))
                )
            }
            (Overlay::Exact, theory) => {
                format!(
                    "exact solution{}",
                    theory.map_or_else(String::new, |t| format!(" ({})", t.exact_name))
                )
            }
            (Overlay::Envelope, Some(theory)) if theory.envelope.is_none() => {
                format!("envelope of small waves: {NO_ENVELOPE}")
            }
            (Overlay::Envelope, _) => "envelope of small waves (Kesari-Lew)".to_owned(),
            (Overlay::Device, _) => "the line of the loading device through the walker".to_owned(),
        };
        let on = if typing.model.is_over(overlay) { 'x' } else { ' ' };
        Offer::new(overlay.name(), format!("[{on}] {says}"))
    };
    Overlay::ALL.map(offer).to_vec()
}

pub(in crate::explorer) fn pins_of(typing: &Typing<'_>) -> Vec<Offer> {
    let model = typing.model;
    let pins = model.pins.all().iter();
    let outcome = |preset: &Preset, path: &PathReport| {
        let totals = &path.totals;
        let pull = model.force_in_words(preset, totals.pull()?.force, 4);
        let lost = totals.dissipated.unwrap_or(totals.dissipated_before_last_contact);
        let fall = if totals.dissipated.is_none() { "+" } else { "" };
        let lost = with_unit(&preset.units, Quantity::Energy, lost, false, loss);
        Some(format!("A {pull}, lost {lost}{fall}"))
    };
    let says = |pin: &Pin| {
        let name = pin.name(&model.preset);
        let outcomes = Compared::of(model, pin)
            .and_then(|paths| Some((outcome(pin.preset(), paths.pin)?, outcome(&model.preset, paths.now)?)));
        outcomes.map_or(name.clone(), |(of_pin, here)| format!("{name}: {of_pin} (here {here})"))
    };
    let numbered = pins.map(|pin| Offer::new(pins::letter(pin.number), says(pin)));
    // A letter means a pin, and neither a word that begins with it nor a description.
    let is_letter = typing.word.chars().count() == 1;
    let is_meant = |offer: &Offer| !is_letter || offer.word.eq_ignore_ascii_case(typing.word);
    numbered.chain(words(["all"])).filter(is_meant).collect()
}

/// The branches of the walk: how many steps, where each ended, and in which values it differs from the current ones.
pub(in crate::explorer) fn branches_of(typing: &Typing<'_>) -> Vec<Offer> {
    let history = &typing.model.history;
    let all = branches::branches(history).into_iter().filter_map(|branch| {
        let node = branch.last()?;
        let state = node.seen();
        let place = if node.is_apart() {
            "the bodies are apart".to_owned()
        } else {
            let units = &node.setting.preset.units;
            let length = |x| with_unit(units, Quantity::Length, x, false, |x| significant(x, 4));
            let [delta, s] = [state.approach, state.contact_radius].map(length);
            format!("δ {delta} P {} s {s}", typing.model.force_in_words(&node.setting.preset, state.force, 4))
        };
        let differs = pins::name(&node.setting.preset, &typing.model.preset);
        let word = if branch.is_here { "here" } else { "" };
        Some(Offer {
            is_here: branch.is_here,
            does: Some(Command::GoTo { node: branch.end, numbering: history.numbering() }),
            ..Offer::new(word, format!("step {:<5} {place}  {differs}", node.step))
        })
    });
    all.collect()
}

/// Measured curves: those of the program, and files.
pub(in crate::explorer) fn curves(typing: &Typing<'_>) -> Vec<Offer> {
    let folder = &typing.word[..typing.word.rfind('/').map_or(0, |at| at + 1)];
    let own = shipped::CURVES.iter().map(|shipped| Offer::new(format!("{SHIPPED_DATA}{}", shipped.name), ""));
    let files = (typing.files)(folder);
    // A name with a space must be typed in quotes.
    let files = files.into_iter().filter(|name| !name.contains(' ')).map(|name| Offer::new(name, ""));
    own.chain(words([NONE])).chain(files).collect()
}

/// A preset, and then values of its keys.
pub(in crate::explorer) fn presets(typing: &Typing<'_>) -> Vec<Offer> {
    let known = &typing.model.preset_names;
    match typing.words {
        [] if known.is_empty() => words(SHIPPED.iter().map(|shipped| shipped.name)),
        [] => known.iter().filter_map(|[name, title]| Some(Offer::new(quoted(name)?, &**title))).collect(),
        _ => assignments_of(typing),
    }
}

/// What can be exported, and for a figure which view.
pub(in crate::explorer) fn documents(typing: &Typing<'_>) -> Vec<Offer> {
    match typing.words {
        [] => Export::ALL.map(|what| Offer::new(what.name(), what.meaning())).to_vec(),
        // Any name will do; these are suggestions.
        [document] => {
            let named = |endings: &[&str]| {
                let shown = if *document == "figure" { typing.model.view.name() } else { document };
                endings.iter().map(|ending| file_for(&typing.model.source, shown, ending)).collect::<Vec<_>>()
            };
            let of = Export::ALL.into_iter().filter(|what| what.name() == *document);
            of.flat_map(|what| named(what.endings()))
                .filter_map(|file| Some(Offer::new(quoted(&file)?, "")))
                .collect()
        }
        ["figure", _] => words(View::ALL.map(View::name).into_iter().chain(["replace"])),
        [_, _] => words(["replace"]),
        _ => Vec::new(),
    }
}

pub(in crate::explorer) fn names(typing: &Typing<'_>) -> Vec<Offer> {
    if typing.words.is_empty() { Vec::new() } else { words(["with-data", "replace"]) }
}

/// What an axis of a map can show.
pub(in crate::explorer) fn axes_of(typing: &Typing<'_>) -> Vec<Offer> {
    let preset = &typing.model.preset;
    if typing.words.len() > 1 {
        return Vec::new();
    }
    let is_other = |offer: &Offer| typing.words.iter().all(|word| key_of(word) != offer.word);
    let other = |offer: &Offer| is_other(offer) && !is_blind(&offer.word);
    let keys = numbers(preset).into_iter();
    let groups = GROUPS.iter().map(|row| Offer::new(&*row.key, &*row.meaning));
    let curves = if typing.words.is_empty() { Vec::new() } else { words(CURVES.map(|(name, _)| name)) };
    keys.chain(groups).chain(words([COMPLIANCE])).chain(curves).filter(other).collect()
}

/// The keys of the preset that have numbers.
fn numbers(preset: &Preset) -> Vec<Offer> {
    let rows = preset.rows().filter(|row| row.kind.is_number() && preset.get(&row.key).is_some());
    rows.map(|row| Offer::new(&*row.key, named(&row))).collect()
}

/// What a key is, after the symbol under which the screen shows it.
fn named(row: &Parameter) -> String {
    format!("{}: {}", row.label, row.meaning)
}

/// The keys of the preset, or the words that the key being typed takes.
pub(in crate::explorer) fn assignments_of(typing: &Typing<'_>) -> Vec<Offer> {
    let preset = &typing.model.preset;
    let Some((key, _)) = typing.word.split_once('=') else {
        // Those that have, or could have, a value here.
        let rows = settable(preset).filter(|row| row.key != "format");
        return rows.map(|row| Offer::new(format!("{}=", row.key), named(&row))).collect();
    };
    let row = preset.row(key);
    let values: &[&str] = match row.as_ref().map(|row| row.kind) {
        Some(Kind::Choice(words)) => words,
        Some(Kind::Smoothing) => &[AUTO, NONE],
        Some(Kind::Control) => &CONTROLS,
        _ if row.is_some_and(|row| row.is_optional() && preset.get(key).is_some()) => &[NONE],
        _ => &[],
    };
    values.iter().map(|value| Offer::new(format!("{key}={value}"), "")).collect()
}
