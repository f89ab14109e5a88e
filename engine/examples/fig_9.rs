//! The unloading of the paper's Fig. 9: a sphere with waves, pulled off by fixed grips.

use pulloff_engine::{UnloadReport, read};
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
    let report = UnloadReport::compute(&preset)?;
    for event in &report.events {
        println!("{}: s = {:.4}, lost {:?}", event.kind, event.before.contact_radius, event.dissipated);
    }
    println!("smallest force: {:.6}", report.min_force);
    Ok(())
}
