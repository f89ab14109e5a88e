//! The table of commands, made from the [list](super::command::list): the footer, the help, the command line,
//! completion, scripts, the manual page and the book's key table are derived from it.

use super::availability::{
    Available, always, branches, curve, jump, parameter, pins, redo, turns, undo, walker, walker_or_no_curve,
    zoomed,
};
use super::command::list::each_command;
use super::command::{Command, Id, MOST_STEPS};
use super::effect::Effect;
use super::fit::{fit, mark};
use super::job::Job;
use super::model::Model;
use super::requests::file;
use super::script::arguments::{
    Takes, assigned, axes, destination, exported, pin, place, preset, quantity, saved, saved_as, takes,
    theory, travelled, view,
};
use super::script::offers::{
    Offer, assignments_of, axes_of, branches_of, controls, curves, documents, names, pins_of, places,
    presets, quantities, theories, views, words,
};
use super::update::files::save_back;
use super::update::places::to_largest_pull;
use super::update::selection::{arrow, cancel, next_panel};
use super::update::travel::travel;
use super::update::values::turn;
use super::update::walk::{next_event, restart, run_or_stop, scale_length, scale_pace, turn_round, walk};
use super::view::ScreenPanel;
use super::walk::Action;
use super::{look, reach};
use pulloff_engine::preset::data;

/// One row of the table.
#[derive(Debug, Clone, Copy)]
pub struct CommandRow {
    pub id: Id,
    pub name: &'static str,
    pub section: &'static str,
    /// The usual keys, separated by spaces, the one for the footer first; a command without a key is typed.
    pub keys: &'static str,
    /// A word or two for the footer.
    pub short: &'static str,
    /// What it does.
    pub help: &'static str,
    /// Other words by which someone may look for it.
    pub words: &'static str,
    /// What may be typed after it.
    pub takes: Takes,
    /// What it requires before it can be run.
    pub needs: fn(&Model) -> Available,
    pub waits: Waits,
    pub script: Script,
    /// What it does to what is displayed, by itself.
    pub look: fn(&mut Model),
    /// What it does, by itself, and the work that it requests.
    pub run: fn(&mut Model) -> Vec<Effect>,
}

/// What a command waits for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Waits {
    /// Nothing: it concerns only what is displayed.
    Nothing,
    /// Only for the commands before it, and the walk they began.
    InOrder,
    /// Also for the newest curve, and the walker's state on it.
    Curve,
}

/// Whether a script may say a command.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Script {
    Yes,
    /// With this after it.
    Needs(&'static str),
    /// It concerns what is selected on the screen; a script says this instead.
    Selected(&'static str),
    /// It only changes what a screen shows.
    Screen,
}

impl CommandRow {
    /// A command that does nothing by itself.
    pub const PLAIN: Self = Self {
        id: Id::Cancel,
        name: "",
        section: "",
        keys: "",
        short: "",
        help: "",
        words: "",
        takes: Takes::NOTHING,
        needs: always,
        waits: Waits::Nothing,
        script: Script::Yes,
        look: |_| (),
        run: |_| Vec::new(),
    };

    /// Runs it, with nothing after it.
    pub(super) fn does(&self, model: &mut Model) -> Vec<Effect> {
        (self.look)(model);
        (self.run)(model)
    }
}

/// Makes the table from the list.
macro_rules! rows {
    ($($section:literal { $(
        $id:ident $name:literal $keys:literal $short:literal $needs:ident $waits:ident $script:ident $(($what:literal))?
        $help:literal { $($field:ident: $value:expr),* }
    )* })*) => {
        /// The rows in the order of the help, which is the order of [`Id`].
        pub static ROWS: &[CommandRow] = &[$($(
            CommandRow {
                id: Id::$id,
                name: $name,
                section: $section,
                keys: $keys,
                short: $short,
                help: $help,
                needs: $needs,
                waits: Waits::$waits,
                script: Script::$script$(($what))?,
                $($field: $value,)*
                ..CommandRow::PLAIN
            },
        )*)*];
    };
}

each_command!(rows);

/// The row of a command.
pub fn row_of(id: Id) -> &'static CommandRow {
    &ROWS[id as usize]
}

/// The row with this name.
pub fn called(name: &str) -> Option<&'static CommandRow> {
    Id::called(name).map(row_of)
}

/// Whether a command can be run now.
pub fn is_available(model: &Model, id: Id) -> bool {
    (row_of(id).needs)(model).is_ok()
}

/// Why a command cannot be run now; empty if it can.
pub(super) fn why_unavailable(model: &Model, id: Id) -> String {
    (row_of(id).needs)(model).err().unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    #[test]
    fn every_id_has_one_row_with_a_name_of_its_own() {
        let names: HashSet<&str> = ROWS.iter().map(|row| row.name).collect();
        assert_eq!(names.len(), ROWS.len());
        for row in ROWS {
            assert_eq!((row_of(row.id).name, row.id.name()), (row.name, row.name));
            assert!(!row.short.is_empty() && !row.help.is_empty(), "{}", row.name);
        }
    }

    #[test]
    fn commands_that_are_no_values_presets_or_files_stay_few() {
        let counted =
            ROWS.iter().filter(|row| !matches!(row.section, "Change the problem" | "Presets and files"));
        assert!(counted.count() <= 45);
    }
}
