//! `pulloff run`: a script of the explorer's commands, without a terminal.

use super::Failure;
use super::console::Messages;
use super::output::{Inputs, Outputs, Replacing};
use super::problem::{Changes, ProblemArguments, store};
use crate::explorer::command::{Command, by_name};
use crate::explorer::files::target;
use crate::explorer::script::{self, Permission, ScriptLine, play};
use crate::explorer::{Inline, Model, open};
use crate::store::place::FilePlace;
use crate::store::stream::{self, STANDARD};
use crate::store::{Loaded, Store};
use crate::tui::copy::drawn_alone;
use clap::Args;
use pulloff_engine::preset::shipped;
use pulloff_engine::text::sanitize;
use std::ffi::OsString;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// The arguments of `pulloff run`.
#[derive(Debug, Args)]
pub struct RunArguments {
    /// The script, one command per line; - reads standard input
    script: PathBuf,
    /// The preset to start with, by name or file; - reads standard input; the wavy sphere when left out
    #[arg(long, value_name = "PRESET|FILE.toml")]
    preset: Option<OsString>,
    #[command(flatten)]
    changes: Changes,
    #[command(flatten)]
    replacing: Replacing,
    /// Let the script write files outside the current folder
    #[arg(long)]
    anywhere: bool,
    /// Report on standard error what became of each line
    #[arg(long, short, conflicts_with = "quiet")]
    verbose: bool,
    #[command(flatten)]
    messages: Messages,
}

/// The longest report on a line.
const ACCOUNT: usize = 200;

pub fn run(arguments: &RunArguments) -> Result<ExitCode, Failure> {
    if arguments.script == Path::new(STANDARD)
        && arguments.preset.as_ref().is_some_and(|name| name == STANDARD)
    {
        let text = "standard input holds the script or the preset, not both: name a file for one of them";
        return Err(Failure::Usage(text.to_owned()));
    }
    let named = arguments.script.to_str().filter(|name| shipped::find(name).is_some());
    if let Some(name) = named.filter(|_| !arguments.script.exists()) {
        let text = format!(
            "{name} is a preset, and run takes a script of commands: pulloff {name} opens the explorer on it"
        );
        return Err(Failure::Usage(text));
    }
    let (name, text) = stream::read_given(&arguments.script, script::LARGEST)?;
    let lines = script::read(&name, &text).map_err(|error| Failure::Usage(error.to_string()))?;
    let console = arguments.messages.open();
    let chosen = arguments.preset.is_some() || !arguments.changes.is_empty();
    if chosen && lines.first().is_some_and(|line| script::play::opens(&line.command)) {
        let text = format!("{name}: opens a preset of its own: --preset, --set and --control would be lost");
        return Err(Failure::Usage(text));
    }
    let problem = ProblemArguments { preset: arguments.preset.clone(), changes: arguments.changes.clone() };
    let loaded = problem.load(&console)?;
    let inputs = problem.inputs(&loaded).with("the script", &arguments.script);
    look(&name, &lines, inputs, arguments.replacing)?;
    let (mut model, effects) = open(loaded);
    let permission = Permission { overwrite: arguments.replacing.overwrite, anywhere: arguments.anywhere };
    let (shown, mut done) = (console.lines(lines.len()), 0);
    let mut told = |line: &ScriptLine, model: &Model| {
        done += 1;
        shown.done(done, || {
            if arguments.verbose {
                account(line, model);
            }
        });
    };
    play(&mut model, &Inline::new(store()), effects, &lines, permission, &drawn_alone, &mut told)
        .map_err(|failed| Failure::Script { text: format!("{name}:{failed}"), reason: failed.reason })?;
    drop(shown);
    console.end()
}

/// Checks all files that the lines of a script name, before any line is run.
fn look(name: &str, lines: &[ScriptLine], inputs: Inputs, replacing: Replacing) -> Result<(), Failure> {
    let store = store();
    let opened = lines.iter().filter_map(|line| opened(&store, &line.command));
    let mut outputs =
        Outputs::beside(opened.fold(inputs, |all, preset| all.with_problem(None, &preset)), replacing);
    let mut written = Vec::new();
    for line in lines {
        let Command::Export { path, replace, .. } = &line.command else { continue };
        let option = format!("{name}:{}: {}", line.number, line.command.id().name());
        let path = target(path);
        // A line may replace what an earlier line of the script wrote, where it says so.
        let place = FilePlace::written(&path);
        if *replace && written.contains(&place) {
            continue;
        }
        written.push(place);
        if line.may_fail {
            outputs.tried(&option, &path)?;
        } else {
            outputs.file(&option, &path)?;
        }
    }
    Ok(())
}

/// The preset that a line of a script opens, if it can be opened now.
fn opened(store: &Store, command: &Command) -> Option<Loaded> {
    let (Command::Open(name) | Command::OpenWith { name, .. }) = command else { return None };
    store.load(&store.resolve(name).ok()?, &[] as &[&str]).ok()
}

/// Reports what became of a line, in one line.
fn account(line: &ScriptLine, model: &Model) {
    let command = script::line(&line.command).unwrap_or_default();
    let text = format!("{}: {command}: {}", line.number, by_name(&model.status().1));
    // Nobody may be listening.
    let _ = writeln!(io::stderr(), "{}", sanitize(&text, ACCOUNT));
}
