//! `pulloff man`: the manual page, made from the command line and the command table.

use super::{Failure, Status, output};
use crate::explorer::table::ROWS;
use clap::Command;
use clap_mangen::Man;
use clap_mangen::roff::{Roff, bold, roman};
use std::io;
use std::process::ExitCode;

/// Writes the manual page of `command`.
pub fn run(command: Command) -> Result<ExitCode, Failure> {
    let page =
        page(command).map_err(|cause| Failure::System { what: "the manual page".to_owned(), cause })?;
    output::print(page)?;
    Ok(ExitCode::SUCCESS)
}

fn page(mut command: Command) -> io::Result<Vec<u8>> {
    command.build();
    let mut page = Vec::new();
    Man::new(command.clone()).render(&mut page)?;
    for subcommand in command.get_subcommands().filter(|subcommand| subcommand.get_name() != "help") {
        write_subcommand(subcommand, &mut page)?;
    }
    statuses().to_writer(&mut page)?;
    commands().to_writer(&mut page)?;
    Ok(page)
}

/// Writes the sections of a subcommand, one level below those of the page.
fn write_subcommand(subcommand: &Command, page: &mut Vec<u8>) -> io::Result<()> {
    let name = subcommand.get_bin_name().unwrap_or(subcommand.get_name()).to_uppercase();
    Roff::new().control("SH", [&*name]).to_writer(page)?;
    let man = Man::new(subcommand.clone());
    let mut sections = Vec::new();
    man.render_synopsis_section(&mut sections)?;
    man.render_description_section(&mut sections)?;
    if subcommand.get_arguments().next().is_some() {
        man.render_options_section(&mut sections)?;
    }
    if subcommand.has_subcommands() {
        man.render_subcommands_section(&mut sections)?;
    }
    let text = String::from_utf8_lossy(&sections).into_owned();
    // Each section repeats the preamble, which the page needs only once.
    for line in text.lines().filter(|line| !line.starts_with(".ie ") && !line.starts_with(".el ")) {
        let line = line.strip_prefix(".SH ").map_or_else(|| line.to_owned(), |title| format!(".SS {title}"));
        page.extend(line.bytes());
        page.push(b'\n');
    }
    Ok(())
}

/// The exit statuses.
fn statuses() -> Roff {
    let mut roff = Roff::new();
    roff.control("SH", ["EXIT STATUS"]);
    for status in Status::ALL {
        roff.control("TP", []);
        roff.text([bold(status.code().to_string())]);
        roff.text([roman(status.meaning())]);
    }
    roff
}

/// The commands of the explorer and of scripts, with the user's key bindings.
fn commands() -> Roff {
    let (mut roff, keys) = (Roff::new(), keys());
    roff.control("SH", ["COMMANDS OF THE EXPLORER"]);
    roff.text([roman("Their names in scripts, in the settings and after the key of command-line.")]);
    for row in ROWS {
        let argument = Some(row.takes.what).filter(|what| !what.is_empty());
        let argument = argument.map_or_else(String::new, |what| format!(" [{what}]"));
        roff.control("TP", []);
        roff.text([bold(row.name), roman(argument), roman(keys(row.id))]);
        roff.text([roman(row.help)]);
    }
    roff
}

/// The keys of a command, in brackets.
fn keys() -> impl Fn(crate::explorer::Id) -> String {
    let keymap = super::explore::settings(None).unwrap_or_default().keymap;
    move |id| match keymap.keys(id) {
        [] => String::new(),
        keys => format!(" ({})", keys.iter().map(|key| key.label()).collect::<Vec<_>>().join(", ")),
    }
}
