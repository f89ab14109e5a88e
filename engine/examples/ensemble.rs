//! The enhancement of rough spheres: mean and spread over a hundred surfaces.

use pulloff_engine::sweep::{Cell, Spec, ensemble::at_points};
use pulloff_engine::{Unwatched, preset};
use std::error::Error;

const SPEC: &str =
    "preset = 'random-waves'\nquantities = ['enhancement']\nensemble = { members = 100, seed = 7 }";

fn main() -> Result<(), Box<dyn Error>> {
    let presets = |name: &str, _: &[&str]| preset::read_shipped(name).ok_or("no such preset".to_owned());
    let spec = Spec::read(&presets, "spec", SPEC)?;
    let found = (0..spec.rows).filter_map(|row| spec.measure(row, &Unwatched)?.cells[0]);
    let values: Vec<f64> =
        found.filter_map(|cell| if let Cell::Number(x) = cell { Some(x) } else { None }).collect();
    let rough = at_points(&values, 1, 7)[0].ok_or("no member has a value")?;
    println!("{:.4} ± {:?}, spread {:?}", rough.mean, rough.mean_error, rough.deviation);
    Ok(())
}
