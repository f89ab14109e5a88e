//! The amplitudes at which a wavy sphere begins to snap, crest by crest.

use pulloff_engine::report::map::{MapReport, Ordinate};
use pulloff_engine::{Unwatched, preset, stability::MapAxis};
use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    let wavy = preset::read_shipped("fig-9").ok_or("no such preset")?;
    let amplitudes = MapAxis::new("gap.amplitude", [1e-5, 4e-3], false, 1.0)?;
    let folds = MapReport::compute(&wavy, amplitudes, &Ordinate::Control, [0, 0], &Unwatched)?;
    for cusp in folds.rows.iter().filter(|row| row.kind == "cusp") {
        println!("crest {:?}: A = {:?}", cusp.crest, cusp.x);
    }
    Ok(())
}
