//! How long a long computation runs without asking whether it is still wanted: at most 50 ms is promised.
//!
//! `cargo bench --bench pauses` prints the longest pause of every call on every shipped preset that makes it, and on
//! some heavier ones, the longest first.

#![allow(clippy::unwrap_used, reason = "a bench that cannot be set up must stop")]

use pulloff::explorer::map_axes::MapAxes;
use pulloff::explorer::maps::MapData;
use pulloff::explorer::{CurveData, Staged};
use pulloff_engine::fit::{Options, fit_own};
use pulloff_engine::preset::shipped::SHIPPED;
use pulloff_engine::preset::{Preset, Value};
use pulloff_engine::progress::Progress;
use pulloff_engine::report::path::Extent;
use pulloff_engine::report::{PathReport, StabilityReport, TraceReport};
use pulloff_engine::sweep::{QuantityColumn, measure::measure as row};
use std::cell::Cell;
use std::time::{Duration, Instant};

/// Records the longest time between two questions.
struct Longest {
    asked: Cell<Instant>,
    longest: Cell<Duration>,
}

impl Progress for Longest {
    fn stop(&self) -> bool {
        let pause = self.asked.replace(Instant::now()).elapsed();
        self.longest.set(self.longest.get().max(pause));
        false
    }
}

/// The longest pause of one computation, in milliseconds, including those after its start and before its end.
fn longest(compute: impl FnOnce(&dyn Progress)) -> f64 {
    let watch = Longest { asked: Cell::new(Instant::now()), longest: Cell::default() };
    compute(&watch);
    watch.stop();
    watch.longest.get().as_secs_f64() * 1e3
}

/// The shipped presets, and some that take longer.
fn presets() -> Vec<(String, Preset)> {
    let shipped = |name: &str| {
        let preset = SHIPPED.iter().find(|preset| preset.name == name).unwrap();
        pulloff::store::read(preset.name, preset.text).unwrap()
    };
    let mut presets: Vec<(String, Preset)> =
        SHIPPED.iter().map(|preset| (preset.name.to_owned(), shipped(preset.name))).collect();
    let mut rings = shipped("wavy-sphere");
    rings.set("basis.kind", "rings".into()).unwrap();
    rings.set("basis.rings", Value::Integer(2000)).unwrap();
    presets.push(("wavy-sphere, 2000 rings".to_owned(), rings));
    let mut waves = shipped("random-waves");
    waves.set("gap.count", Value::Integer(1000)).unwrap();
    waves.set("path.start_contact_radius", 0.9.into()).unwrap();
    presets.push(("random-waves, 1000 waves".to_owned(), waves));
    let mut short = shipped("wavy-sphere");
    short.set("gap.wavelength", 1e-3.into()).unwrap();
    short.set("gap.amplitude", 1e-5.into()).unwrap();
    presets.push(("wavy-sphere, 500 waves".to_owned(), short));
    presets
}

fn main() {
    let mut all: Vec<(f64, String)> = Vec::new();
    for (name, preset) in presets() {
        let mut measure = |call: &str, compute: &dyn Fn(&dyn Progress)| {
            let begun = Instant::now();
            let pause = longest(compute);
            all.push((pause, format!("{call} {name}, {:.2} s", begun.elapsed().as_secs_f64())));
        };
        measure("the screen's curve of", &|progress| {
            let stop = |_| progress.stop();
            drop(CurveData::compute(&preset, &Staged::new(&stop)).map(|curve| curve.checked(progress)));
        });
        measure("trace", &|progress| drop(TraceReport::compute(&preset, progress)));
        measure("unload", &|progress| drop(PathReport::unload(&preset, Extent::default(), progress)));
        measure("stability", &|progress| drop(StabilityReport::compute(&preset, 101, progress)));
        measure("cycle", &|progress| drop(PathReport::cycle(&preset, None, Extent::default(), progress)));
        // A map of five hundred waves takes minutes.
        if SHIPPED.iter().any(|shipped| shipped.name == name) {
            let axes = MapAxes::usual(&preset);
            measure("map", &|progress| drop(MapData::of(&preset, &axes, progress)));
        }
        let wished = [
            "last_contact_force",
            "last_contact_approach",
            "snaps",
            "inadmissible_share",
            "cycle_loss",
            "fitted_modulus",
        ];
        let columns: Vec<QuantityColumn> =
            wished.iter().filter_map(|name| QuantityColumn::named(name).ok()).collect();
        measure("sweep's row of", &|progress| drop(row(&preset, &columns, progress)));
        if preset.data.source.is_some() {
            let free = ["material.effective_modulus", "material.work_of_adhesion"].map(str::to_owned);
            let options =
                Options { free: free.into(), profile: true, bootstrap: Some((200, 1)), ..Options::default() };
            measure("fit", &|progress| drop(fit_own(&preset, &options, progress)));
        }
    }
    all.sort_by(|a, b| b.0.total_cmp(&a.0));
    for (pause, what) in all {
        println!("{pause:8.1} ms  {what}");
    }
}
