//! The command line: one file per subcommand, the exit statuses, and what goes to which stream.
//!
//! The exit statuses are [`Status`]. Results go to standard output, everything else to standard error. A reader that
//! goes away early (`| head`) ends the program quietly.

mod assigned;
mod completions;
mod computed;
mod console;
mod explore;
mod failure;
mod figures;
mod fit;
mod format;
mod jobs;
mod man;
mod map;
mod measured;
mod output;
mod path;
mod plot;
mod presets;
mod problem;
mod pull;
mod run;
mod sessions;
mod speeds;
mod sweep;
mod sweep_status;
mod trace;
mod verify;
mod watch;

pub use failure::{Failure, Status};

use clap::{CommandFactory, FromArgMatches, Parser, Subcommand};
use problem::ProblemArguments;
use signal_hook::consts::SIGXFSZ;
use signal_hook::flag;
use std::io::Write;
use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::Arc;

/// Explore adhesive contact: how two bodies stick, and by which jumps they come apart.
#[derive(Debug, Parser)]
#[command(name = "pulloff", version, args_conflicts_with_subcommands = true, max_term_width = 100)]
struct Cli {
    #[command(subcommand)]
    command: Option<ProgramCommand>,
    #[command(flatten)]
    problem: ProblemArguments,
    /// Go on with a session that was left or cut off: the newest, or the one with this name
    #[arg(long, value_name = "NAME", num_args = 0..=1, default_missing_value = "",
          conflicts_with_all = ["preset", "assignments", "control"])]
    resume: Option<String>,
    /// Take the settings of the explorer from this file; pulloff/config.toml in the configuration folder when left out
    #[arg(long, value_name = "FILE")]
    config: Option<PathBuf>,
    #[command(flatten)]
    flags: crate::tui::look::LookWish,
}

#[derive(Debug, Subcommand)]
enum ProgramCommand {
    /// Trace the equilibrium curve and write its points
    Trace(trace::TraceArguments),
    /// Unload quasi-statically and write every instability
    Unload(path::UnloadArguments),
    /// Load from the first touch to a turn and back until the bodies are apart, with rings of contact
    Cycle(path::CycleArguments),
    /// Pull one disc at a rate, with an edge that has a speed
    Pull(pull::PullArguments),
    /// Find where snaps begin: lines in two numbers of a preset, or its limit points over one
    Map(map::MapArguments),
    /// Fit values of a preset to measured curves
    Fit(fit::FitArguments),
    /// Compute the energy release rate of a measured curve along with the speed of its edge
    Speeds(speeds::SpeedsArguments),
    /// Draw a view as a figure for print
    Plot(plot::PlotArguments),
    /// Compute the figures of the paper again: pictures, numbers and captions
    Figures(figures::FiguresArguments),
    /// Compute one preset over many values of its keys, on all cores, into a CSV file
    Sweep(sweep::SweepArguments),
    /// Check this program's numbers against theory
    Verify(verify::VerifyArguments),
    /// Run a script of the explorer's commands
    Run(run::RunArguments),
    /// List, show and delete presets
    #[command(subcommand)]
    Presets(presets::PresetsCommand),
    /// List, show and delete sessions of the explorer
    #[command(subcommand)]
    Sessions(sessions::SessionsCommand),
    /// Write the completions of a shell to standard output
    Completions(completions::CompletionsArguments),
    /// Write the manual page to standard output
    Man,
}

/// Turns the file-size limit into an error of the write that meets it, as with a full disk, instead of a signal that kills.
fn outlive_the_limit() {
    // A caught signal lets the write return. If it cannot be caught, it kills as usual.
    let _ = flag::register(SIGXFSZ, Arc::default());
}

/// Runs the command line of this process.
pub fn run() -> ExitCode {
    outlive_the_limit();
    match completions::answered(command) {
        Ok(true) => return Status::Done.into(),
        Ok(false) => {}
        Err(failure) => return ended(&failure),
    }
    let matches = command().try_get_matches();
    let cli = match matches.and_then(|matches| Cli::from_arg_matches(&matches)) {
        Ok(cli) => cli,
        Err(error) => {
            // Help and version are not errors; clap knows the stream and status of each.
            let _ = error.print();
            return if error.use_stderr() { Status::Mendable } else { Status::Done }.into();
        }
    };
    let result = match &cli.command {
        None => explore::run(&cli.problem, cli.resume.as_deref(), cli.config.as_deref(), cli.flags),
        Some(ProgramCommand::Trace(arguments)) => trace::run(arguments),
        Some(ProgramCommand::Unload(arguments)) => path::unload(arguments),
        Some(ProgramCommand::Cycle(arguments)) => path::cycle(arguments),
        Some(ProgramCommand::Pull(arguments)) => pull::run(arguments),
        Some(ProgramCommand::Map(arguments)) => map::run(arguments),
        Some(ProgramCommand::Fit(arguments)) => fit::run(arguments),
        Some(ProgramCommand::Speeds(arguments)) => speeds::run(arguments),
        Some(ProgramCommand::Plot(arguments)) => plot::run(arguments),
        Some(ProgramCommand::Figures(arguments)) => figures::run(arguments),
        Some(ProgramCommand::Sweep(arguments)) => sweep::run(arguments),
        Some(ProgramCommand::Verify(arguments)) => verify::run(arguments),
        Some(ProgramCommand::Run(arguments)) => run::run(arguments),
        Some(ProgramCommand::Completions(arguments)) => completions::run(arguments),
        Some(ProgramCommand::Man) => man::run(command()),
        Some(ProgramCommand::Presets(command)) => presets::run(command),
        Some(ProgramCommand::Sessions(command)) => sessions::run(command),
    };
    match result {
        Ok(code) => code,
        Err(failure) => ended(&failure.or_stopped(watch::signal())),
    }
}

/// Reports the failure and returns its exit status.
fn ended(failure: &Failure) -> ExitCode {
    if let Some(text) = failure.text() {
        let _ = writeln!(std::io::stderr(), "{text}");
    }
    failure.status().into()
}

/// The value names of options that take numbers.
const NUMBERS: [&str; 10] =
    ["FORCE", "I/N", "LENGTH", "N", "RADIUS", "RATE", "RATE,...", "SEED", "TIME", "WIDTH"];

/// The whole command line, as the help, the completions and the book use it.
pub fn command() -> clap::Command {
    /// An option that takes a number is followed by its value, which may have a sign, so that a bad value gets its own message.
    fn with_signs(command: clap::Command) -> clap::Command {
        let names = |arg: &clap::Arg| arg.get_value_names().unwrap_or_default().to_vec();
        let signed = |arg: clap::Arg| {
            let is_number =
                !arg.is_positional() && names(&arg).iter().any(|name| NUMBERS.contains(&name.as_str()));
            if is_number { arg.allow_hyphen_values(true) } else { arg }
        };
        command.mut_args(signed).mut_subcommands(with_signs)
    }
    with_signs(Cli::command())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_command_line_is_consistent() {
        let mut command = command();
        command.clone().debug_assert();
        command.build();
        let names: Vec<&str> = command.get_subcommands().map(clap::Command::get_name).collect();
        assert_eq!(names, problem::SUBCOMMANDS);
    }
}
