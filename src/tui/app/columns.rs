//! The columns of a measured curve whose header does not say what they are, chosen from lists: which is x, which is the
//! force, which one names the branch, and the units where none are given.

use super::state::App;
use crate::explorer::Effect;
use crate::explorer::data::Foreign;
use crate::tui::overlay::{Choice, Choosing, ColumnQuestion, Item};
use pulloff_engine::measured::{ColumnRole, SeenColumn};
use pulloff_engine::units::{Unit, UnitSystem};
use std::sync::Arc;

/// The units offered for a column without one.
const LENGTHS: [&str; 5] = ["nm", "um", "mm", "m", "in"];
const FORCES: [&str; 7] = ["pN", "nN", "uN", "mN", "N", "gf", "kgf"];
const AREAS: [&str; 4] = ["um^2", "mm^2", "m^2", "nm^2"];

/// What a role is, in a few words.
fn meaning(role: ColumnRole) -> &'static str {
    match role {
        ColumnRole::Approach => "approach δ, or indentation",
        ColumnRole::Position => "position of a piezo or stage, behind a spring",
        ColumnRole::Radius => "contact radius",
        ColumnRole::Diameter => "contact diameter",
        ColumnRole::Area => "contact area",
        ColumnRole::Force => "force",
        ColumnRole::Deflection => "deflection of the spring",
        ColumnRole::Segment => "branch: approach or retraction",
        ColumnRole::Time => "time",
    }
}

/// Whether a column can have this role: one with a unit of another quantity cannot, nor one of words unless it names
/// the branch.
fn may_be(seen: &SeenColumn, role: ColumnRole) -> bool {
    let is_number = |cell: &String| cell.is_empty() || cell.contains(|letter: char| letter.is_ascii_digit());
    match &seen.unit {
        Some(unit) => Unit::parse(unit, 0).is_ok_and(|unit| role.dimension() == Some(unit.dimension())),
        None => role == ColumnRole::Segment || seen.first.iter().any(is_number),
    }
}

impl App {
    /// Asks what the columns of a file are.
    pub(super) fn choose_columns(&mut self, foreign: Foreign) {
        let foreign = Arc::new(foreign);
        let said = Vec::new();
        self.ask_columns(&Choosing { foreign, step: ColumnQuestion::X, said, unit: None, taken: Vec::new() });
    }

    fn ask_columns(&mut self, choosing: &Choosing) -> Vec<Effect> {
        if let Some((role, number)) = choosing.unit {
            return self.ask_unit(choosing, role, number);
        }
        let taking = |role: ColumnRole, seen: &SeenColumn| {
            let mut next = choosing.clone();
            next.taken.push(seen.number);
            let has_unit = seen.unit.is_some() || self.model.preset.units == UnitSystem::Reduced;
            if role == ColumnRole::Segment || has_unit {
                next.says(role, seen.number, None);
            } else {
                next.unit = Some((role, seen.number));
            }
            next
        };
        let mut items = Vec::new();
        let mut selected = None;
        let free = |seen: &&SeenColumn| !choosing.taken.contains(&seen.number);
        for role in choosing.step.roles() {
            for seen in choosing.foreign.seen.iter().filter(free).filter(|seen| may_be(seen, *role)) {
                if seen.role == Some(*role) && selected.is_none() {
                    selected = Some(items.len());
                }
                let name = if seen.name.is_empty() { String::new() } else { format!(" \"{}\"", seen.name) };
                let text = format!(
                    "{:<10} column {}{name}: {} ...",
                    role.word(),
                    seen.number,
                    seen.first.join(", ")
                );
                items.push(Item::new(text, Choice::Columns(Box::new(taking(*role, seen)))));
            }
        }
        let title = match choosing.step {
            ColumnQuestion::X => "What is x: approach, position or contact radius",
            ColumnQuestion::Force => "What is the force",
            ColumnQuestion::Segment => "Does a column name the branch",
        };
        if choosing.step == ColumnQuestion::Segment {
            let text = "none: the turn separates approach and retraction".to_owned();
            items.insert(0, Item::new(text, Choice::Command(choosing.done())));
            selected = selected.map(|at| at + 1);
        }
        self.choose(&format!("{title} ({})", choosing.foreign.shown), items, selected.unwrap_or(0))
    }

    /// Asks for the unit of a column that names none.
    fn ask_unit(&mut self, choosing: &Choosing, role: ColumnRole, number: usize) -> Vec<Effect> {
        let units: &[&str] = match role {
            ColumnRole::Force => &FORCES,
            ColumnRole::Area => &AREAS,
            _ => &LENGTHS,
        };
        let item = |unit: &&str| {
            let mut next = choosing.clone();
            next.says(role, number, Some(unit));
            Item::new((*unit).to_owned(), Choice::Columns(Box::new(next)))
        };
        let title = format!("Unit of column {number}, {}", meaning(role));
        self.choose(&title, units.iter().map(item).collect(), 0)
    }

    /// Continues with what was chosen.
    pub(super) fn columns_chosen(&mut self, choosing: &Choosing) -> Vec<Effect> {
        let has_more = |choosing: &Choosing| {
            let free = |seen: &SeenColumn| !choosing.taken.contains(&seen.number) && seen.unit.is_none();
            choosing.step != ColumnQuestion::Segment || choosing.foreign.seen.iter().any(free)
        };
        if choosing.is_done() || !has_more(choosing) {
            let command = choosing.done();
            return self.run(command);
        }
        self.ask_columns(choosing)
    }
}
