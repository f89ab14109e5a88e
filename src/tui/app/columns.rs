//! The columns of a measured curve whose header does not say what they are, chosen from lists: what is x, what is the force,
//! which column names the branch, and the units where there are none.

use super::state::App;
use crate::explorer::Effect;
use crate::explorer::data::Foreign;
use crate::tui::overlay::{Action, Choosing, Item, Step};
use pulloff_engine::measured::{Role, Seen};
use pulloff_engine::units::{Unit, UnitSystem};
use std::sync::Arc;

/// The units offered for a column without one.
const LENGTHS: [&str; 5] = ["nm", "um", "mm", "m", "in"];
const FORCES: [&str; 7] = ["pN", "nN", "uN", "mN", "N", "gf", "kgf"];
const AREAS: [&str; 4] = ["um^2", "mm^2", "m^2", "nm^2"];

/// What a role is, in a few words.
fn meaning(role: Role) -> &'static str {
    match role {
        Role::Approach => "approach δ, or indentation",
        Role::Position => "position of a piezo or stage, behind a spring",
        Role::Radius => "contact radius",
        Role::Diameter => "contact diameter",
        Role::Area => "contact area",
        Role::Force => "force",
        Role::Deflection => "deflection of the spring",
        Role::Segment => "branch: approach or retraction",
        Role::Time => "time",
    }
}

/// Whether a column can be this: one with a unit of something else cannot.
fn may_be(seen: &Seen, role: Role) -> bool {
    match &seen.unit {
        Some(unit) => Unit::parse(unit, 0).is_ok_and(|unit| role.dimension() == Some(unit.dimension())),
        None => true,
    }
}

impl App {
    /// Asks what the columns of a file are.
    pub(super) fn choose_columns(&mut self, foreign: Foreign) {
        let foreign = Arc::new(foreign);
        let said = Vec::new();
        self.ask_columns(&Choosing { foreign, step: Step::X, said, unit: None, taken: Vec::new() });
    }

    fn ask_columns(&mut self, choosing: &Choosing) {
        if let Some((role, number)) = choosing.unit {
            return self.ask_unit(choosing, role, number);
        }
        let taking = |role: Role, seen: &Seen| {
            let mut next = choosing.clone();
            next.taken.push(seen.number);
            let has_unit = seen.unit.is_some() || self.model.preset.units == UnitSystem::Reduced;
            if role == Role::Segment || has_unit {
                next.says(role, seen.number, None);
            } else {
                next.unit = Some((role, seen.number));
            }
            next
        };
        let mut items = Vec::new();
        let mut selected = None;
        let free = |seen: &&Seen| !choosing.taken.contains(&seen.number);
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
                items.push(Item::new(text, Action::Columns(Box::new(taking(*role, seen)))));
            }
        }
        let title = match choosing.step {
            Step::X => "What is x: approach, position or contact radius",
            Step::Force => "What is the force",
            Step::Segment => "Does a column name the branch",
        };
        if choosing.step == Step::Segment {
            let text = "none: approach and retraction are found by the turn".to_owned();
            items.insert(0, Item::new(text, Action::Command(choosing.done())));
            selected = selected.map(|at| at + 1);
        }
        self.choose(&format!("{title} ({})", choosing.foreign.shown), items, selected.unwrap_or(0));
    }

    /// Asks for the unit of a column that names none.
    fn ask_unit(&mut self, choosing: &Choosing, role: Role, number: usize) {
        let units: &[&str] = match role {
            Role::Force => &FORCES,
            Role::Area => &AREAS,
            _ => &LENGTHS,
        };
        let item = |unit: &&str| {
            let mut next = choosing.clone();
            next.says(role, number, Some(unit));
            Item::new((*unit).to_owned(), Action::Columns(Box::new(next)))
        };
        let title = format!("Unit of column {number}, {}", meaning(role));
        self.choose(&title, units.iter().map(item).collect(), 0);
    }

    /// Goes on with what was chosen.
    pub(super) fn columns_chosen(&mut self, choosing: &Choosing) -> Vec<Effect> {
        let has_more = |choosing: &Choosing| {
            let free = |seen: &Seen| !choosing.taken.contains(&seen.number) && seen.unit.is_none();
            choosing.step != Step::Segment || choosing.foreign.seen.iter().any(free)
        };
        if choosing.is_done() || !has_more(choosing) {
            let command = choosing.done();
            return self.run(command);
        }
        self.ask_columns(choosing);
        Vec::new()
    }
}
