//! The spec of a sweep: TOML text → preset, axes, quantities, and the values of each row.

use super::MOST_ROWS;
use super::axis::{AxisValues, Distribution, SweepAxis, overrides};
use super::document::{SpecEntry, SpecError, SpecSection, SpecText};
use super::ensemble::MEMBERS;
use super::fault::Fault;
use super::measure::{MeasuredQuantities, measure};
use super::quantity::{QuantityColumn, USUAL};
use crate::gap::shapes::split_mix::SplitMix64;
use crate::preset::called::key_called;
use crate::preset::schema::{CHOOSERS, Fallback};
use crate::preset::{Preset, Value, groups};
use crate::problem::Begin;
use crate::progress::Progress;
use crate::text::{closest, quote};
use crate::units::number::short;
use std::borrow::Cow;
use std::collections::BTreeSet;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// The source of the preset of a spec. Given the name in the spec and the `KEY=VALUE` assignments over it, it returns
/// the preset, or why there is none, in words that are safe to show.
pub type Presets<'a> = &'a dyn Fn(&str, &[&str]) -> Result<Preset, String>;

/// How the axes make rows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Design {
    /// Every value with every other one; the last axis runs fastest.
    Grid,
    /// All first values together, then all second ones, …
    Pairs,
    /// Drawn at random.
    Random {
        /// Number of rows.
        draws: u64,
        /// The seed of all random numbers.
        seed: u64,
    },
    /// Members drawn at random at every point of the other axes: all points of the first member, then those of the second, …
    Ensemble {
        /// Number of members.
        members: u64,
        /// The seed of all random numbers.
        seed: u64,
        /// Whether the points are pairs rather than a grid.
        in_pairs: bool,
    },
}

impl Design {
    /// How the axes that are not drawn make the points of an ensemble; any other design is returned as it is.
    #[must_use]
    pub fn of_points(self) -> Self {
        match self {
            Self::Ensemble { in_pairs: true, .. } => Self::Pairs,
            Self::Ensemble { in_pairs: false, .. } => Self::Grid,
            other => other,
        }
    }
}

/// A sweep: what is computed, and for which problems.
#[derive(Debug, Clone)]
pub struct Spec {
    /// The preset that every row starts from.
    pub preset: Preset,
    /// The axes; at least one. In an ensemble those that its members draw come after the others.
    pub axes: Vec<SweepAxis>,
    /// How they make rows.
    pub design: Design,
    /// The quantities wanted; at least one.
    pub columns: Vec<QuantityColumn>,
    /// The number of rows, from 1 to [`MOST_ROWS`].
    pub rows: u64,
}

/// What `set` must be.
const ASSIGNMENTS: &str = "an array of strings \"KEY=VALUE\"";
/// The possible values of `combine`.
const DESIGNS: [&str; 2] = ["grid", "pairs"];
/// The key that tells one random surface from another.
const SEED: &str = "gap.seed";

impl Spec {
    /// Reads a spec from text, called `name` in messages; its preset comes from `presets`.
    ///
    /// # Errors
    /// The first mistake, with its line.
    pub fn read(presets: Presets<'_>, name: &str, text: &str) -> Result<Self, SpecError> {
        let document = SpecText { name, text };
        let table = document.parse()?;
        let section = document.section(&table);
        section.only(&["preset", "set", "combine", "random", "ensemble", "quantities", "axis"])?;
        let preset = preset(presets, &section)?;
        let assigned = assigned(&section, &preset)?;
        let design = design(&section)?;
        let wanted = "one or more tables [[axis]]";
        // A single surface with error bars needs no axis.
        let axes = match section.get("axis") {
            None if matches!(design, Design::Ensemble { .. }) => None,
            _ => Some(section.need("axis", wanted)?),
        };
        let given = axes.as_ref().map_or_else(|| Ok(Vec::new()), |axes| axes.array(wanted))?;
        let tables: Vec<SpecSection<'_>> =
            given.iter().map(|entry| entry.section("a table [[axis]]")).collect::<Result<_, _>>()?;
        let key = |table: &SpecSection<'_>| {
            table.get("key").and_then(|entry| key_called(&preset, entry.value.as_str()?).ok())
        };
        let fixed = !tables.iter().filter_map(key).any(|key| CHOOSERS.contains(&&*key));
        let mut read: Vec<SweepAxis> = Vec::new();
        for table in &tables {
            let axis = SweepAxis::read(table, &preset, fixed)?;
            if let Some(other) =
                read.iter().map(|other| &*other.key).find(|other| groups::are_rivals(&axis.key, other))
            {
                return Err(table.fault(&format!("the axis {} conflicts with the axis {other}", axis.key)));
            }
            if let Some((entry, key)) = assigned.iter().find(|(_, key)| overrides(&axis.key, key)) {
                let what = format!(
                    "set gives {} a value that no row uses: the axis {} gives every row its own; remove one of them",
                    quote(key),
                    axis.key
                );
                return Err(entry.fault(&what));
            }
            read.push(axis);
        }
        if let (Some(axes), true) = (&axes, read.is_empty()) {
            return Err(axes.fault("axis must be one or more tables [[axis]]"));
        }
        let mut rows = rows(design, &read, &tables)?;
        if let (Design::Ensemble { members, .. }, Some(entry)) = (design, section.get("ensemble")) {
            let fixed = assigned.iter().any(|(_, key)| key == SEED);
            read = drawn(read, &preset, fixed).map_err(|what| entry.fault(&what))?;
            let points = rows;
            rows = points.checked_mul(members).filter(|rows| *rows <= MOST_ROWS).ok_or_else(|| {
                entry.fault(&format!(
                    "{points} points x {members} members are out of range: at most {MOST_ROWS} rows"
                ))
            })?;
        }
        Ok(Self { preset, axes: read, design, columns: columns(&section)?, rows })
    }

    /// The number of points at which there are members; for other designs, the number of rows.
    pub fn points(&self) -> u64 {
        match self.design {
            Design::Ensemble { members, .. } => self.rows / members,
            _ => self.rows,
        }
    }

    /// Whether every point has many members, and so statistics.
    pub fn is_ensemble(&self) -> bool {
        matches!(self.design, Design::Ensemble { .. })
    }

    /// The values of the axes in a row, which is below [`rows`](Self::rows), in the order of the axes.
    pub fn values(&self, row: u64) -> Vec<Value> {
        values(&self.axes, self.design, row)
    }

    /// The preset of a row.
    ///
    /// # Errors
    /// A value that the preset does not accept.
    pub fn problem(&self, row: u64) -> Result<Preset, Fault> {
        let mut preset = self.preset.clone();
        let keys = self.axes.iter().map(|axis| &*axis.key);
        preset.set_all(keys.zip(self.values(row))).map_err(|invalid| Fault::of_value(&invalid))?;
        Ok(preset)
    }

    /// The values without a default in a row's preset that nobody gave: another shape brings those that it needs.
    fn brought(&self, preset: &Preset) -> Vec<String> {
        let is_given = |key: &str| {
            self.preset.get(key).is_some() || self.axes.iter().any(|axis| overrides(&axis.key, key))
        };
        let values = preset.values().into_iter();
        let brought = values.filter(|(row, _)| row.fallback == Fallback::Required && !is_given(&row.key));
        brought.map(|(row, value)| format!("{} = {value}", row.key)).collect()
    }

    /// The quantities of a row; `None` when `progress` said stop. Whatever goes wrong is a fault of the row.
    ///
    /// ```
    /// use pulloff_engine::{Unwatched, preset, sweep::Spec};
    ///
    /// let text = "preset = 'fig-9'\nquantities = ['snaps']\n[[axis]]\nkey = 'gap.amplitude'\nvalues = [1e-4, 2.5e-3]";
    /// let presets = |name: &str, _: &[&str]| preset::read_shipped(name).ok_or("no such preset".to_owned());
    /// let spec = Spec::read(&presets, "spec", text)?;
    /// let snaps: Vec<_> = (0..spec.rows).filter_map(|row| spec.measure(row, &Unwatched)?.cells[0]).collect();
    /// assert_eq!(snaps.iter().map(ToString::to_string).collect::<Vec<_>>(), ["1", "7"]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn measure(&self, row: u64, progress: &dyn Progress) -> Option<MeasuredQuantities> {
        match self.problem(row) {
            Ok(preset) => measure(&preset, &self.columns, progress),
            Err(fault) => Some(self.lost(fault)),
        }
    }

    /// What holds for the sweep as a whole, in words: numbers that another shape brings, gaps that are too steep, and unloadings
    /// beside loops.
    pub fn warnings(&self) -> Vec<String> {
        let mut warnings = Vec::new();
        let rows = self.looked_at();
        if self.axes.iter().any(|axis| CHOOSERS.contains(&&*axis.key)) {
            let brought = rows.iter().filter_map(|row| Some(self.brought(&self.problem(*row).ok()?)));
            let brought: BTreeSet<String> = brought.flatten().collect();
            if !brought.is_empty() {
                let all = brought.into_iter().collect::<Vec<_>>().join(", ");
                warnings.push(format!("numbers that nobody gave, which another shape or law brings: {all}"));
            }
        }
        let count = rows.len() as u64;
        let slope = |row| Some((row, self.problem(row).ok()?.steep_slope()?));
        let steep: Vec<(u64, f64)> = rows.into_iter().filter_map(slope).collect();
        if let Some((row, slope)) = steep.iter().max_by(|a, b| a.1.total_cmp(&b.1)) {
            let values = self.axes.iter().zip(self.values(*row));
            let values: Vec<String> = values.map(|(axis, value)| format!("{} = {value}", axis.key)).collect();
            let of =
                if count < self.rows { format!("{count} rows looked at") } else { format!("{count} rows") };
            warnings.push(format!(
                "in {} of {of} the gap is too steep, with slopes of up to {} at {}: this theory is for slopes small \
                 beside 1",
                steep.len(),
                short(*slope, 3),
                values.join(", ")
            ));
        }
        for axis in &self.axes {
            let blind = self.columns.iter().filter(|column| column.is_blind_to(&axis.key));
            let names: Vec<String> = blind.map(QuantityColumn::name).collect();
            if !names.is_empty() {
                warnings.push(format!(
                    "{}: of an infinitely slow path, the same for every {}; of a pull at a rate are peak_force, \
                     last_contact_time, dissipated, tension_peaks and top_edge_speed",
                    names.join(", "),
                    axis.key
                ));
            }
        }
        let of_unloading = self.columns.iter().filter(|column| column.is_of_unloading());
        let names: Vec<String> = of_unloading.map(QuantityColumn::name).collect();
        let turns = self.axes.iter().any(|axis| axis.key.starts_with("path.turn_"));
        if !names.is_empty() && (turns || self.preset.path.begin == Begin::Apart) {
            warnings.push(format!(
                "{}: of the unloading from the start, not of the loop; of the loop are cycle_loss, cycle_largest_pull and \
                 cycle_snaps",
                names.join(", ")
            ));
        }
        warnings
    }

    /// The rows that are looked at for their slopes: some, evenly, and the corners of a grid, where slopes are steepest.
    fn looked_at(&self) -> BTreeSet<u64> {
        const EVENLY: u64 = 64;
        /// A grid of more axes has too many corners.
        const AXES: usize = 5;
        let count = self.rows.min(EVENLY);
        let evenly = (0..count).map(|i| if count > 1 { i * (self.rows - 1) / (count - 1) } else { 0 });
        let mut rows: BTreeSet<u64> = evenly.collect();
        if self.design == Design::Grid && self.axes.len() <= AXES {
            for corner in 0..1_u64 << self.axes.len() {
                // Counted as in `point`.
                let digits = self.axes.iter().enumerate().map(|(at, axis)| {
                    let count = axis.count().unwrap_or(1).max(1);
                    (count, if corner >> at & 1 == 1 { count - 1 } else { 0 })
                });
                rows.insert(digits.fold(0, |row, (count, digit)| row * count + digit));
            }
        }
        rows
    }

    /// A row without any quantities.
    pub fn lost(&self, fault: Fault) -> MeasuredQuantities {
        MeasuredQuantities { cells: vec![None; self.columns.len()], fault: Some(fault) }
    }
}

/// The values of the axes in a row, in the order of the axes.
pub fn values(axes: &[SweepAxis], design: Design, row: u64) -> Vec<Value> {
    let draws = |seed, row| {
        let mut random = SplitMix64::row(seed, row);
        // Drawn in the order of the axes.
        let draw = move |axis: &SweepAxis| match &axis.points {
            AxisValues::Drawn(distribution) => Some(distribution.draw(&mut random)),
            _ => None,
        };
        axes.iter().filter_map(draw)
    };
    match design {
        Design::Grid | Design::Pairs => point(axes, design, row),
        Design::Random { seed, .. } => draws(seed, row).collect(),
        Design::Ensemble { seed, .. } => {
            let own = design.of_points();
            let points = points(axes, own);
            let mut values = point(axes, own, row % points);
            values.extend(draws(seed, row / points));
            values
        }
    }
}

/// How many points the axes make that are not drawn; at least one.
pub fn points(axes: &[SweepAxis], design: Design) -> u64 {
    let mut counts = axes.iter().filter_map(SweepAxis::count);
    let count = if design == Design::Grid { counts.product() } else { counts.next().unwrap_or(1) };
    count.max(1)
}

/// The values of the axes that are not drawn, at a point of a grid or of pairs.
fn point(axes: &[SweepAxis], design: Design, mut index: u64) -> Vec<Value> {
    let mut values: Vec<Value> = Vec::with_capacity(axes.len());
    // Counted from the last axis, which runs fastest.
    for axis in axes.iter().rev() {
        let count = axis.count().unwrap_or(1).max(1);
        let own = if design == Design::Grid { index % count } else { index };
        values.extend(axis.value(own));
        index = if design == Design::Grid { index / count } else { index };
    }
    values.reverse();
    values
}

/// The axes of an ensemble: those of its points, then those its members draw. Each member draws a surface of its own if
/// the preset has a seed that is not `fixed`.
fn drawn(axes: Vec<SweepAxis>, preset: &Preset, fixed: bool) -> Result<Vec<SweepAxis>, String> {
    let has_seed = preset.get(SEED).is_some() && !axes.iter().any(|axis| axis.key == SEED) && !fixed;
    let (mut own, mut all): (Vec<SweepAxis>, Vec<SweepAxis>) =
        axes.into_iter().partition(|axis| axis.count().is_none());
    if has_seed {
        // Every seed is as good as any other; these are exact in a table of double-precision numbers.
        let points = AxisValues::Drawn(Distribution::Integers([0, (1 << 53) - 1]));
        own.push(SweepAxis { key: SEED.to_owned(), points });
    }
    if own.is_empty() {
        return Err(format!(
            "the members would all be the same: the preset has no {SEED} that could differ, and no axis has a \
             distribution"
        ));
    }
    all.append(&mut own);
    Ok(all)
}

/// The axes of a canonical form, which the program keeps beside results, and how they make rows.
///
/// # Errors
/// The first part that is not as the program writes it.
pub fn of_canonical(document: SpecText<'_>) -> Result<(Vec<SweepAxis>, Design), SpecError> {
    let table = document.parse()?;
    let sweep = document.section(&table).need("sweep", "a table")?.section("a table")?;
    let axes = sweep.need("axis", "tables")?.array("tables")?;
    let axes = axes.iter().map(|entry| SweepAxis::of_canonical(&entry.section("a table")?));
    Ok((axes.collect::<Result<_, _>>()?, design(&sweep)?))
}

/// `preset` with the assignments of `set`.
fn preset(presets: Presets<'_>, section: &SpecSection<'_>) -> Result<Preset, SpecError> {
    let wanted = "the name of a preset, or a preset file (with a '/' or ending in .toml)";
    let entry = section.need("preset", wanted)?;
    let name = entry.text(wanted)?;
    let set: Vec<SpecEntry<'_>> =
        section.get("set").map_or_else(|| Ok(Vec::new()), |set| set.array(ASSIGNMENTS))?;
    let set: Vec<&str> = set.iter().map(|entry| entry.text(ASSIGNMENTS)).collect::<Result<_, _>>()?;
    // The preset itself first, so that a mistake is reported where it was made.
    let preset = presets(name, &[]).map_err(|what| entry.fault(&format!("preset: {what}")))?;
    if set.is_empty() {
        return Ok(preset);
    }
    presets(name, &set).map_err(|what| section.get("set").unwrap_or(entry).fault(&what))
}

/// The keys that `set` gives values to, each with its place.
fn assigned<'a>(
    section: &SpecSection<'a>,
    preset: &Preset,
) -> Result<Vec<(SpecEntry<'a>, String)>, SpecError> {
    let mut keys = Vec::new();
    let Some(set) = section.get("set") else { return Ok(keys) };
    for entry in set.array(ASSIGNMENTS)? {
        // Anything that is not an assignment was refused when the preset was made.
        let Some((key, text)) = entry.text(ASSIGNMENTS)?.split_once('=') else { continue };
        let value = DeValue::parse(text.trim()).ok();
        let table = value.as_ref().and_then(|value| value.get_ref().as_table());
        // An inline table may be that of a whole table, which has no short name.
        let short = key_called(preset, key.trim()).ok().filter(|_| table.is_none());
        let inner = keys_of(short.as_deref().unwrap_or(key.trim()), table);
        keys.extend(inner.into_iter().map(|key| (entry.clone(), key)));
    }
    Ok(keys)
}

/// `key`, or the keys below it that an inline table gives values to.
fn keys_of(key: &str, table: Option<&DeTable<'_>>) -> Vec<String> {
    let Some(table) = table else { return vec![key.to_owned()] };
    let below = |(name, value): (&Spanned<Cow<'_, str>>, &Spanned<DeValue<'_>>)| match &**name.get_ref() {
        // A parameter is its value, with more attached.
        "value" => vec![key.to_owned()],
        name => keys_of(&format!("{key}.{name}"), value.get_ref().as_table()),
    };
    table.iter().flat_map(below).collect()
}

fn design(section: &SpecSection<'_>) -> Result<Design, SpecError> {
    let seed = |section: &SpecSection<'_>| {
        section.need("seed", "a whole number")?.count(0..=i64::MAX.unsigned_abs())
    };
    let in_pairs = match section.get("combine") {
        Some(combine) if section.get("random").is_some() => {
            return Err(combine.fault("combine is for a grid or for pairs: [random] has neither"));
        }
        Some(combine) => is_pairs(&combine)?,
        None => false,
    };
    match (section.get("random"), section.get("ensemble")) {
        (Some(_), Some(ensemble)) => {
            Err(ensemble.fault("[ensemble] draws its members itself: it cannot be combined with [random]"))
        }
        (Some(random), None) => {
            let random = random.section("a table with draws and seed")?;
            random.only(&["draws", "seed"])?;
            let draws = random.need("draws", "the number of rows")?.count(1..=MOST_ROWS)?;
            Ok(Design::Random { draws, seed: seed(&random)? })
        }
        (None, Some(ensemble)) => {
            let ensemble = ensemble.section("a table with members and seed")?;
            ensemble.only(&["members", "seed"])?;
            let members = ensemble.need("members", "the number of members")?.count(MEMBERS)?;
            Ok(Design::Ensemble { members, seed: seed(&ensemble)?, in_pairs })
        }
        (None, None) if in_pairs => Ok(Design::Pairs),
        (None, None) => Ok(Design::Grid),
    }
}

/// Whether `combine` asks for pairs.
fn is_pairs(combine: &SpecEntry<'_>) -> Result<bool, SpecError> {
    match combine.text("\"grid\" or \"pairs\"")? {
        "grid" => Ok(false),
        "pairs" => Ok(true),
        other => {
            let what =
                format!("combine = \"{}\" is not known: it must be \"grid\" or \"pairs\"", quote(other));
            let meant = closest(other, DESIGNS);
            Err(combine.fault(&meant.map_or(what.clone(), |meant| format!("{what}; did you mean {meant}?"))))
        }
    }
}

/// The number of rows, or of points of an ensemble; every axis must fit the design.
fn rows(design: Design, axes: &[SweepAxis], tables: &[SpecSection<'_>]) -> Result<u64, SpecError> {
    let counts: Vec<Option<u64>> = axes.iter().map(SweepAxis::count).collect();
    // The first of the axes that are not drawn; in pairs all the others must be as long as it.
    let first = axes.iter().zip(&counts).find_map(|(axis, count)| Some((axis, (*count)?)));
    let mut product = 1_u64;
    for ((axis, table), count) in axes.iter().zip(tables).zip(&counts) {
        let key = &axis.key;
        match (design, design.of_points(), count) {
            (Design::Random { .. }, _, Some(_)) => {
                return Err(table.fault(&format!("with [random] the axis {key} must have a distribution")));
            }
            (Design::Random { draws, .. }, _, None) => product = draws,
            // An axis drawn by the members goes with any points.
            (Design::Ensemble { .. }, _, None) => {}
            (_, _, None) => {
                let what = format!(
                    "the axis {key} has a distribution: it needs [random] with draws and seed, or [ensemble] with members and seed"
                );
                return Err(table.fault(&what));
            }
            (_, Design::Pairs, Some(count)) => {
                if let Some((other, first)) = first.filter(|(_, first)| first != count) {
                    let what = format!(
                        "pairs need axes of equal length: {key} has {count} values, {} has {first}",
                        other.key
                    );
                    return Err(table.fault(&what));
                }
                product = *count;
            }
            (_, _, Some(count)) => {
                product = product.checked_mul(*count).filter(|rows| *rows <= MOST_ROWS).ok_or_else(|| {
                    let counts: Vec<String> = counts.iter().flatten().map(u64::to_string).collect();
                    table.fault(&format!("{} rows are out of range: at most {MOST_ROWS}", counts.join(" x ")))
                })?;
            }
        }
    }
    Ok(product)
}

fn columns(section: &SpecSection<'_>) -> Result<Vec<QuantityColumn>, SpecError> {
    let Some(entry) = section.get("quantities") else {
        return Ok(USUAL.iter().filter_map(|name| QuantityColumn::named(name).ok()).collect());
    };
    let wanted = "an array of quantity names";
    let mut columns = Vec::new();
    for name in entry.array(wanted)? {
        let column = QuantityColumn::named(name.text(wanted)?)
            .map_err(|what| name.fault(&format!("quantities: {what}")))?;
        if columns.contains(&column) {
            return Err(name.fault(&format!("quantities: {} is listed twice", column.name())));
        }
        columns.push(column);
    }
    if columns.is_empty() {
        return Err(entry.fault("quantities is empty: leave it out for the usual ones"));
    }
    Ok(columns)
}
