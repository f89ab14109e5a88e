//! The adhesion at which each contact of a wavy sphere becomes unstable.

use pulloff_engine::report::StabilityReport;
use pulloff_engine::{Unwatched, preset};
use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    let wavy = preset::read_shipped("fig-9").ok_or("no such preset")?;
    let law = StabilityReport::compute(&wavy, 20, &Unwatched)?;
    println!("work of adhesion {:.6}; stable where the critical one is larger", law.work_of_adhesion);
    for row in &law.rows {
        println!("s = {:.4}  {:?}", row.contact_radius, row.critical.displacement);
    }
    Ok(())
}
