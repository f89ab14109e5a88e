//! An offset of x, or a baseline of the force, that is not given: what the rows say of it, and what it does to G.

use super::reading::{RowReading, attached};
use crate::elementary::ln;
use crate::fit::{AdhesionModel, Options, Verdict, fit_own};
use crate::measured::branches::{MeasuredPoint, median};
use crate::measured::{Branches, Instrument, Segment};
use crate::preset::Preset;
use crate::preset::data::OFFSET;
use crate::preset::edge::CLOSING_ADHESION;
use crate::progress::Progress;
use crate::units::Quantity;
use crate::units::number::{said, short, with_unit};

/// An offset of x that is not given, in the signs of the points.
pub(super) struct FoundOffset {
    value: f64,
    error: f64,
    /// Where it is from.
    by: &'static str,
    /// Whether the rows agree with it.
    is_sure: bool,
}

/// Offsets within this many errors are the same, and one that changes by less than this share of itself over the radii
/// is one.
const SAME: f64 = 3.0;
const DRIFT: f64 = 0.1;

impl FoundOffset {
    const BY_RADII: &'static str = "the contact radii and the forces";

    /// By the contact radii and the forces, which give the approach whatever G is; without radii, by a fit with one G.
    pub(super) fn of(
        reading: &RowReading,
        preset: &Preset,
        branches: &Branches,
        progress: &dyn Progress,
    ) -> Option<Self> {
        let offsets: Vec<f64> = attached(branches).filter_map(|point| reading.offset(point)).collect();
        if let Some(value) = median(offsets.clone()) {
            let off = median(offsets.iter().map(|offset| (offset - value).abs()).collect())?;
            // The standard error of a median of normal values.
            let error = 1.4826 * 1.2533 * off / (offsets.len() as f64).sqrt();
            // Where E* or the gap is wrong, each radius has an offset of its own.
            let third = offsets.len().div_ceil(3);
            let ends = [&offsets[..third], &offsets[offsets.len() - third..]].map(|end| median(end.to_vec()));
            let drift = (ends[0]? - ends[1]?).abs();
            let is_sure = drift <= (DRIFT * value.abs()).max(2.0 * SAME * error);
            return Some(Self { value, error, by: Self::BY_RADII, is_sure });
        }
        let mut alone = preset.clone();
        // E* is that of the preset, as it is for G.
        alone.data.uncertain.clear();
        // G is computed with the force as it is, and so must the offset be.
        if branches.baseline.is_none() {
            alone.data.baseline.get_or_insert(alone.data.tare.unwrap_or(0.0));
        }
        let has = |segment| branches.list.iter().any(|branch| branch.segment == segment);
        let mut free = ["material.work_of_adhesion", OFFSET].map(str::to_owned).to_vec();
        if has(Segment::Approach) && has(Segment::Retraction) {
            free.push(CLOSING_ADHESION.to_owned());
        }
        let (alone, free) = AdhesionModel::ShortRange.laid(&alone, &free);
        let options = Options { free, bootstrap: Some((0, 0)), ..Options::default() };
        let fit = fit_own(&alone, &options, progress).ok()?;
        let found = fit.parameters.iter().find(|parameter| parameter.key == OFFSET)?;
        let [sign, ..] = Instrument::signs(branches.turned);
        Some(Self {
            value: sign * found.value,
            error: found.standard_error.unwrap_or(f64::INFINITY),
            by: "a fit with one G at all rows",
            is_sure: fit.verdict == Verdict::Describes && fit.turned == branches.turned,
        })
    }

    /// The offset that is used: 0 unless the rows refute it.
    pub(super) fn used(&self) -> f64 {
        if self.is_sure && self.value.abs() > SAME * self.error { self.value } else { 0.0 }
    }
}

/// A share of G that does not matter.
const LITTLE: f64 = 0.05;

/// How much G changes, as the logarithm of a ratio.
fn change((_, here, there): (usize, f64, f64)) -> f64 {
    ln(there / here).abs()
}

/// The row in which G changes as much as in half of all rows, if the instrument is `there` and not that of the reading:
/// its number and both G.
fn middle_change(reading: &RowReading, branches: &Branches, there: Instrument) -> Option<(usize, f64, f64)> {
    let energies = |point: &MeasuredPoint| {
        let [here, there] =
            [reading.instrument, there].map(|instrument| reading.energy_with(point, instrument));
        Some((point.row, here?, there?))
    };
    let mut all: Vec<(usize, f64, f64)> = attached(branches).filter_map(energies).collect();
    all.sort_by(|a, b| change(*a).total_cmp(&change(*b)));
    all.get(all.len() / 2).copied()
}

/// A sentence on a baseline that nothing shows, with what a tare would do: nothing where it would do little.
pub(super) fn doubt_of_baseline(
    reading: &RowReading,
    preset: &Preset,
    branches: &Branches,
) -> Option<String> {
    /// Less than with an offset: a tare may be larger than is assumed here.
    const LITTLE: f64 = 0.01;
    if preset.data.baseline.or(branches.baseline).or(preset.data.tare).is_some() {
        return None;
    }
    let tare = branches.tare();
    let there = Instrument { baseline: tare, ..reading.instrument };
    let middle = middle_change(reading, branches, there).filter(|middle| change(*middle) >= LITTLE)?;
    let (row, here, there) = middle;
    let energy = |g: f64| said(&preset.units, Quantity::EnergyPerArea, g);
    let [_, sign, _] = Instrument::signs(branches.turned);
    Some(format!(
        "no row is apart and data.baseline is not given, so the force is used as it is: in row {row} G is {}, and with a \
         baseline of {} it is {}. Fit it first, or give it with --set data.baseline=",
        energy(here),
        said(&preset.units, Quantity::Force, sign * tare),
        energy(there)
    ))
}

/// A sentence on an offset that is not given, with what another one would do: nothing where it would do little.
pub(super) fn doubt_of_offset(
    reading: &RowReading,
    preset: &Preset,
    branches: &Branches,
    found: Option<&FoundOffset>,
) -> Option<String> {
    /// A share of the range of x.
    const SHARE: f64 = 0.01;
    let [sign, ..] = Instrument::signs(branches.turned);
    let length = |x: f64| said(&preset.units, Quantity::Length, sign * x);
    let here = reading.instrument.offset;
    if let Some(found) = found.filter(|found| found.used() != 0.0) {
        let FoundOffset { value, error, by, .. } = found;
        let unless = if *by == FoundOffset::BY_RADII {
            "they hold for the E* and the gap of the preset"
        } else {
            "if G changes with the speed of the edge, this offset hides it: fit it with --model rate"
        };
        return Some(format!(
            "data.offset is not given: x = {} ± {} is taken as no approach, by {by}; {unless}. --set data.offset= sets \
             another",
            length(*value),
            with_unit(&preset.units, Quantity::Length, *error, true, |x| short(x, 2))
        ));
    }
    if found.is_some_and(|found| found.is_sure) {
        return None;
    }
    let other = found.map_or(here + SHARE * branches.ranges[0], |found| found.value);
    let there = Instrument { offset: other, ..reading.instrument };
    let middle = middle_change(reading, branches, there);
    if middle.is_some_and(|middle| change(middle) < LITTLE) {
        return None;
    }
    // A fit with one G would find the offset at which G changes least.
    let model = if attached(branches).any(|point| point.time.is_finite()) { " --model rate" } else { "" };
    let effect = middle.map_or_else(String::new, |(row, here, there)| {
        let energy = |g: f64| said(&preset.units, Quantity::EnergyPerArea, g);
        let of = found.map_or_else(String::new, |found| format!(", which is that of {},", found.by));
        format!(": in row {row} G is {}, and with {}{of} {}", energy(here), length(other), energy(there))
    });
    Some(format!(
        "data.offset is not given, so x is taken as the approach: with another offset G is another{effect}. Fit it first \
         (pulloff fit{model} with data.offset free), or give it with --set data.offset="
    ))
}
