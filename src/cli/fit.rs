//! `pulloff fit`: the values of a problem that fit a measured curve, with their errors.

mod arguments;
mod done;
mod files;
mod summary;
mod table;
mod together;

use self::arguments::{of_file, refused, with_points};
use self::done::FinishedFits;
use super::Failure;
use super::watch::StopSignal;
use crate::store::Loaded;
use crate::sweep::in_order;
pub use arguments::FitArguments;
use pulloff_engine::fit::{AdhesionModel, Models, Options, fit_models};
use pulloff_engine::preset::Value;
use pulloff_engine::progress::Progress;
use std::path::Path;
use std::process::ExitCode;

/// How many fits may wait for an earlier one.
const WINDOW: u64 = 256;

pub fn run(arguments: &FitArguments) -> Result<ExitCode, Failure> {
    let messages = arguments.messages;
    let console = messages.open();
    let (files, loaded, options) = arguments.read(&console)?;
    let sinks = arguments.sinks(&files, &loaded)?;
    let stop = StopSignal::catch()?;
    let said = arguments.said()?;
    let rates = arguments.several.rates(&files, &loaded.preset)?;
    if arguments.several.together {
        return together::run(
            arguments,
            (&files, &loaded, &options),
            (&said, &rates),
            &console,
            &sinks,
            &stop,
        );
    }
    let mut done = FinishedFits::new(arguments, &console, sinks);
    let left = done.left(&files);
    let many = files.len() > 1;
    let compute = |index: u64| {
        let path = usize::try_from(index).ok().and_then(|index| left.get(index))?;
        // Each of many files is a small share of the whole and soon done.
        let bar = (!many).then(|| messages.bar(Some(&stop)));
        let progress = bar.as_ref().map_or(&stop as &dyn Progress, |bar| bar);
        let said = of_file(&said, files.iter().position(|file| file == path), &rates);
        Some(one(path, &loaded, &said, (&options, &arguments.model), progress))
    };
    let bar = console.bar(None);
    let (all, mut paths) = (left.len() as u64, left.iter());
    in_order(0..all, arguments.jobs.count(), WINDOW, &compute, &stop, |found| {
        let Some((found, path)) = found.and_then(|found| Some((found, paths.next()?))) else { return Ok(()) };
        if many {
            bar.report(1.0 - paths.len() as f64 / all as f64);
        }
        match found {
            Ok(found) => done.keep(path, &found, &stop),
            // It was stopped before there was any result.
            Err(_) if stop.signal().is_some() => Ok(()),
            Err(failure) if many => done.refuse(path, &failure),
            Err(failure) => Err(failure),
        }
    })?;
    drop(bar);
    done.end(many, &loaded, &stop)
}

/// The fit to one file, or to the curve of the preset itself.
fn one(
    path: &Path,
    loaded: &Loaded,
    said: &[(&'static str, Value)],
    (options, models): (&Options, &[AdhesionModel]),
    progress: &dyn Progress,
) -> Result<Models, Failure> {
    let preset = with_points(path, loaded, said)?;
    fit_models(&preset, models, options, progress).map_err(|error| refused(path, &preset, &error))
}
