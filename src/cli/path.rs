//! `pulloff unload` and `pulloff cycle`: what happens on the path of the device, event by event.

use super::Failure;
use super::computed::{Computed, Opened};
use super::format::Format;
use super::watch::StopSignal;
use clap::{Args, ValueEnum};
use pulloff_engine::case::CaseError;
use pulloff_engine::preset::Preset;
use pulloff_engine::preset::schema::TURN_KEYS;
use pulloff_engine::problem::{ContactKind, Control, Turn};
use pulloff_engine::progress::Progress;
use pulloff_engine::quasistatic::Losses;
use pulloff_engine::report::path::{COLUMNS, Extent, STATE_COLUMNS, STATE_ZONE_COLUMNS, ZONE_COLUMNS};
use pulloff_engine::report::{PathReport, columns, json, path_table, table};
use std::process::ExitCode;

/// The arguments of `pulloff unload`.
#[derive(Debug, Args)]
pub struct UnloadArguments {
    #[command(flatten)]
    path: PathArguments,
}

/// The arguments of `pulloff cycle`.
#[derive(Debug, Args)]
pub struct CycleArguments {
    #[command(flatten)]
    turn: TurnArguments,
    #[command(flatten)]
    path: PathArguments,
}

/// The arguments that both commands share.
#[derive(Debug, Args)]
struct PathArguments {
    /// Follow only one disc of contact, as path.contact=one-disc does; states in which the bodies would overlap are marked
    #[arg(long)]
    one_disc: bool,
    /// Compute losses from energy only: faster, but without the balance of energy and areas
    #[arg(long)]
    no_area: bool,
    /// What the rows of a table or of CSV are; JSON has both
    #[arg(long, value_enum, default_value_t = PathRows::Events)]
    rows: PathRows,
    #[command(flatten)]
    computed: Computed,
}

/// What one row describes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum PathRows {
    /// The events, in order
    Events,
    /// The stable states, one row per contact
    States,
}

/// Where the loop turns round, instead of where the preset says.
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
    /// Turn round at this value of what is controlled: an approach, a force, or the position of the spring's far end
    #[arg(long, value_name = "VALUE", allow_hyphen_values = true)]
    to_control: Option<String>,
}

impl TurnArguments {
    /// Sets the turn in the preset, where one is given; the preset has no key for a control value.
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
        // It is typed in the same way as an approach or a force.
        let key = TURN_KEYS[usize::from(preset.path.control == Control::Force)];
        let value = preset.row(key).map(|row| preset.number(&row, text)).transpose();
        let value = value.map_err(|invalid| Failure::Usage(format!("--to-control: {invalid}")))?;
        Ok(value.map(Turn::Control))
    }
}

pub fn unload(arguments: &UnloadArguments) -> Result<ExitCode, Failure> {
    arguments
        .path
        .run(|_| Ok(None), &|preset, _, extent, progress| PathReport::unload(preset, extent, progress))
}

pub fn cycle(arguments: &CycleArguments) -> Result<ExitCode, Failure> {
    arguments.path.run(|preset| arguments.turn.lay(preset), &PathReport::cycle)
}

/// How a path is computed.
type Compute<'a> = &'a dyn Fn(&Preset, Option<Turn>, Extent, &dyn Progress) -> Result<PathReport, CaseError>;

impl PathArguments {
    /// Checks that the path can be written, then computes and writes it.
    fn run(
        &self,
        turn: impl FnOnce(&mut Preset) -> Result<Option<Turn>, Failure>,
        path: Compute<'_>,
    ) -> Result<ExitCode, Failure> {
        let mut opened = self.computed.open(Format::Table)?;
        let turn = turn(&mut opened.preset)?;
        if self.one_disc {
            opened.preset.path.contact = ContactKind::OneDisc;
        }
        let losses = if self.no_area { Losses::Once } else { Losses::Twice };
        let stop = StopSignal::catch()?;
        let extent = Extent { losses, ..Extent::default() };
        let report = path(&opened.preset, turn, extent, &opened.console.bar(Some(&stop)))?;
        self.written(opened, &report)
    }

    fn written(&self, opened: Opened, report: &PathReport) -> Result<ExitCode, Failure> {
        let Opened { console, format, sink, .. } = opened;
        console.warn(&report.warnings);
        let units = &report.head.units.shown;
        let text = match (format, self.rows) {
            (Format::Table, PathRows::Events) => path_table::path(report),
            (Format::Table, PathRows::States) => table::rows(&report.states_table()?),
            (Format::Csv, rows) => {
                let (columns, of_zone, table) = match rows {
                    PathRows::Events => (COLUMNS, ZONE_COLUMNS, report.table()?),
                    PathRows::States => (STATE_COLUMNS, STATE_ZONE_COLUMNS, report.states_table()?),
                };
                let has_zone = report.states.iter().any(|at| at.state.zone_radius.is_some());
                let columns = if has_zone { [columns, of_zone].concat() } else { columns.to_vec() };
                console.note(columns::units(&columns, report.control, units).as_deref());
                table.csv()?
            }
            (Format::Json, _) => json(report)?,
        };
        sink.write(text)?;
        if report.has_reached_its_end {
            return console.end();
        }
        Err(Failure::Incomplete(format!(
            "the path stopped early, its {} events were written: {}",
            report.events.len(),
            report.stop
        )))
    }
}
