//! The unloading of the paper's Fig. 9: a sphere with waves, pulled off by fixed grips.

use pulloff_engine::{Extent, PathReport, Unwatched, read};
use std::error::Error;

const FIG_9: &str = r#"
    [material]
    effective_modulus = 1.0
    work_of_adhesion = 0.0039788735772973835

    [gap]
    shape = "wavy-sphere"
    radius_of_curvature = 1.0
    amplitude = 0.0025
    wavelength = 0.05
"#;

fn main() -> Result<(), Box<dyn Error>> {
    let preset = read("fig-9", FIG_9)?;
    let report = PathReport::unload(&preset, Extent::default(), &Unwatched)?;
    for event in &report.events {
        println!(
            "{} {}: {} = {:.4}, lost {:?}",
            event.number, event.kind, report.control, event.control, event.dissipated
        );
    }
    if let Some(state) = report.totals.largest_pull {
        println!("largest pull: {:.6} at s = {:.4}", state.force, state.contact_radius);
    }
    Ok(())
}
