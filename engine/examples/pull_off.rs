//! The pull-off of a smooth sphere under three devices, in units of the critical force.

use pulloff_engine::{Control, Extent, PathReport, Unwatched, preset};
use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    let mut smooth = preset::read_shipped("fig-3-jkr").ok_or("no such preset")?;
    let critical = 1.5 * std::f64::consts::PI * smooth.material.work_of_adhesion;
    for control in [Control::Displacement, Control::Stiffness(0.5), Control::Force] {
        smooth.path.control = control;
        let path = PathReport::unload(&smooth, Extent::default(), &Unwatched)?;
        let last = path.totals.last_contact.ok_or("it never lets go")?;
        println!("{control:?}: P = {:.4} P_c at s = {:.4}", last.force / critical, last.contact_radius);
    }
    Ok(())
}
