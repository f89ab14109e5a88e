//! The unloading of presets that come with it, as JSON: of those named, or of all. The bytes are those of `pulloff unload
//! --format json`.

use pulloff_engine::preset::Files;
use pulloff_engine::preset::shipped::SHIPPED;
use pulloff_engine::{Extent, PathReport, Unwatched, json, read_in};
use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    let wanted: Vec<String> = std::env::args().skip(1).collect();
    for preset in
        SHIPPED.iter().filter(|preset| wanted.is_empty() || wanted.iter().any(|name| name == preset.name))
    {
        let preset = read_in(Files::SHIPPED, None, preset.name, preset.text, &[] as &[&str])?;
        print!("{}", json(&PathReport::unload(&preset, Extent::default(), &Unwatched)?)?);
    }
    Ok(())
}
