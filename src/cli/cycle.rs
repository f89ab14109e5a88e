//! `pulloff cycle`: the whole loop of loading and unloading, with rings of contact.

use super::Failure;
use super::console::Messages;
use super::format::{Format, FormatArgument};
use super::output::Destination;
use super::problem::Problem;
use super::watch::Stop;
use clap::Args;
use pulloff_engine::case::Case;
use pulloff_engine::preset::Preset;
use pulloff_engine::preset::schema::TURN_KEYS;
use pulloff_engine::problem::Control;
use pulloff_engine::problem::Turn;
use pulloff_engine::quasistatic::path::Areas;
use pulloff_engine::report::cycle::COLUMNS;
use pulloff_engine::report::{CycleReport, columns, cycle_table, json};
use std::process::ExitCode;

/// The arguments of `pulloff cycle`.
#[derive(Debug, Args)]
pub struct Arguments {
    #[command(flatten)]
    problem: Problem,
    #[command(flatten)]
    turn: TurnArguments,
    /// Compute losses by energy alone: faster, and without the balance of energy and areas
    #[arg(long)]
    no_area: bool,
    #[command(flatten)]
    format: FormatArgument,
    #[command(flatten)]
    destination: Destination,
    #[command(flatten)]
    messages: Messages,
}

/// Where the loop turns round; instead of what the preset says.
#[derive(Debug, Args)]
#[group(multiple = false)]
#[expect(clippy::struct_field_names, reason = "clap makes the flags of these names")]
struct TurnArguments {
    /// Turn round at the first stable state with at least this approach
    #[arg(long, value_name = "APPROACH", allow_hyphen_values = true)]
    to_approach: Option<String>,
    /// Turn round at the first stable state with at least this force
    #[arg(long, value_name = "FORCE", allow_hyphen_values = true)]
    to_force: Option<String>,
    /// Turn round at the first stable state whose outermost edge is at least this far out
    #[arg(long, value_name = "RADIUS")]
    to_radius: Option<String>,
    /// Turn round at this value of what is controlled: an approach, a force, or the way of the spring's other end
    #[arg(long, value_name = "VALUE", allow_hyphen_values = true)]
    to_control: Option<String>,
}

impl TurnArguments {
    /// Gives the preset the turn, where one is given; a control value is none of its keys.
    fn lay(&self, preset: &mut Preset) -> Result<Option<Turn>, Failure> {
        let given = [
            ("--to-approach", TURN_KEYS[0], &self.to_approach),
            ("--to-force", TURN_KEYS[1], &self.to_force),
            ("--to-radius", TURN_KEYS[2], &self.to_radius),
        ];
        for (flag, key, text) in given {
            if let Some(text) = text {
                preset.assign(key, text).map_err(|invalid| Failure::Usage(format!("{flag}: {invalid}")))?;
            }
        }
        let Some(text) = &self.to_control else { return Ok(None) };
        // It is typed as an approach or a force is.
        let key = TURN_KEYS[usize::from(preset.path.control == Control::Force)];
        let value = preset.row(key).map(|row| preset.number(&row, text)).transpose();
        let value = value.map_err(|invalid| Failure::Usage(format!("--to-control: {invalid}")))?;
        Ok(value.map(Turn::Control))
    }
}

pub fn run(arguments: &Arguments) -> Result<ExitCode, Failure> {
    let console = arguments.messages.open();
    let format = arguments.format.of(arguments.destination.path(), Format::Table)?;
    let loaded = arguments.problem.load(&console)?;
    let sink = arguments.destination.sink(arguments.problem.inputs(&loaded))?;
    let mut preset = loaded.preset;
    let turn = arguments.turn.lay(&mut preset)?;
    let case = Case::new(&preset)?;
    let units = case.units();
    let turn = turn.map(|turn| turn.in_units(1.0 / units.length, 1.0 / units.force, case.control));
    let areas = if arguments.no_area { Areas::No } else { Areas::Yes };
    let stop = Stop::catch()?;
    let cycle = case.cycle(case.control, turn, areas, &console.bar(Some(&stop)));
    let report = CycleReport::new(&preset, &case, &cycle?);
    console.warn(&report.warnings);
    let text = match format {
        Format::Table => cycle_table::cycle(&report),
        Format::Csv => {
            console.note(columns::units(COLUMNS, report.control, &preset.units).as_deref());
            report.csv()?
        }
        Format::Json => json(&report)?,
    };
    sink.write(text)?;
    console.end()
}
