//! Loading and unloading a wavy sphere: what each event dissipates.

use pulloff_engine::{Extent, PathReport, Unwatched, preset};
use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    let wavy = preset::read_shipped("fig-9-cycle").ok_or("no such preset")?;
    let whole = PathReport::cycle(&wavy, None, Extent::default(), &Unwatched)?;
    for event in &whole.events {
        println!(
            "{:>2} {:<12} δ = {:>9.5}  lost {:?}",
            event.number, event.kind, event.control, event.dissipated
        );
    }
    println!("lost in all: {:?}", whole.totals.dissipated);
    Ok(())
}
