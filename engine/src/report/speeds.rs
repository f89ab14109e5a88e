//! The energy release rate of measured rows beside the speed of the edge, as a document.
//!
//! ```text
//! K = g(s) − δ      G = E* K²/2πs      δ = P/(2E* s) + ∫₀ˢ g / s   of P and s;      v = −ds/dt
//! ```
//!
//! It contains no law of adhesion, only E* and the gap. G follows from any two of force, approach and contact radius;
//! from force and approach, s follows first: at a held approach the force falls with s where the edge pulls, and of several
//! such stretches `branch` takes one. From approach and
//! radius, G does not depend on the force, unless the way is that of the other end of a spring. D. Maugis and M.
//! Barquins, J. Phys. D 11, 1989 (1978).

mod branch;
mod offset;
mod reading;

use self::branch::BranchReading;
pub use self::branch::SpeedRow;
use self::offset::{FoundOffset, doubt_of_baseline, doubt_of_offset};
pub use self::reading::MeasuredPair;
use self::reading::{RowReading, attached, radius_of};
use super::columns::columns;
use super::problem::Head;
use super::rows::{ReportTable, RowsError};
use crate::case::{Case, CaseError};
use crate::fit::doubt_of_wave;
use crate::measured::branches::MeasuredPoint;
use crate::measured::points::Turned;
use crate::measured::{Abscissa, Branches, Instrument};
use crate::preset::Preset;
use crate::problem::Control;
use crate::progress::Progress;
use crate::quasistatic::admissible::Judge;
use crate::text::counted;
use crate::units::Quantity;
use crate::units::number::said;
use serde::Serialize;

/// Why there are no speeds.
#[derive(Debug, thiserror::Error)]
pub enum SpeedsError {
    /// The preset could not be made ready.
    #[error(transparent)]
    Case(#[from] CaseError),
    /// The preset has no measured curve.
    #[error("the preset has no measured curve: name a file, or set data.file")]
    NoData,
    /// Its file gives no points: why, in words.
    #[error("{0}")]
    Data(String),
    /// A column is missing.
    #[error("G cannot be computed from {}: the file has no {missing}", .pair.words())]
    Lacks {
        /// What was asked for.
        pair: MeasuredPair,
        /// What is missing.
        missing: &'static str,
    },
    /// No row of it is in contact, or none at a radius for which the gap is known.
    #[error("no row is in contact, or none has a contact radius for which the gap is known")]
    Nothing,
}

/// Said where no row has a speed.
pub const UNTIMED: &str = "no row has a time that can be used, so none has a speed";

/// The columns as CSV; they never change, new ones come after them.
pub const COLUMNS: &[&str] = columns!(
    time contact_radius speed energy_release_rate error speed_error window segment row
);

/// G at every row in contact, and how fast the edge goes there.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct SpeedsReport {
    /// The head of the document.
    #[serde(flatten)]
    pub head: Head,
    /// What to be careful about.
    pub warnings: Vec<String>,
    /// What was found and assumed.
    pub notes: Vec<String>,
    /// What G is computed from.
    pub from: &'static str,
    /// σ of x, of P and of s, in that order; null for what is not measured.
    pub sigma: [Option<f64>; 3],
    /// The rows, branch by branch in the order of measurement.
    pub rows: Vec<SpeedRow>,
}

impl SpeedsReport {
    /// The report on the measured curve of `preset`, with its E*, gap, device and what it says about the instrument,
    /// from two of its columns: force and radius where no others are asked for, and force and approach for a file
    /// without radii.
    ///
    /// # Errors
    /// [`SpeedsError`].
    pub fn compute(
        preset: &Preset,
        pair: Option<MeasuredPair>,
        progress: &dyn Progress,
    ) -> Result<Self, SpeedsError> {
        let source = preset.data.source.as_ref().ok_or(SpeedsError::NoData)?;
        let branches = source.branches(&preset.reading()).map_err(SpeedsError::Data)?;
        let case = Case::prepare(preset, progress)?;
        let mut notes = preset.notes_of_reading().map_err(SpeedsError::Data)?;
        notes.extend(doubt_of_wave(preset, &branches));
        notes.extend(branches.notes.iter().cloned());
        let [sigma_x, sigma_force, _] = branches.noise.sigma;
        let of_file: Vec<MeasuredPoint> = attached(&branches).copied().collect();
        let pair = measured_pair(pair, branches.abscissa, &of_file)?;
        let reach = wanted(&case, &branches);
        let mut reading = RowReading {
            panels: case.table.up_to(reach).map_err(|_| SpeedsError::Nothing)?,
            units: *case.units(),
            abscissa: branches.abscissa,
            pair,
            control: if branches.abscissa == Abscissa::Position {
                case.control
            } else {
                Control::Displacement
            },
            instrument: preset.data.instrument(&branches),
            sigma: [sigma_x, sigma_force],
            judge: Judge::new(&case.reduced, &case.table),
        };
        let unknown = pair != MeasuredPair::ForceRadius && preset.data.offset.is_none();
        let found = if unknown { FoundOffset::of(&reading, preset, &branches, progress) } else { None };
        reading.instrument.offset = found.as_ref().map_or(reading.instrument.offset, FoundOffset::used);
        reading.widen(&of_file, &case, reach, progress);
        let doubt = if unknown { doubt_of_offset(&reading, preset, &branches, found.as_ref()) } else { None };
        notes.push(used(&reading, preset, branches.turned));
        let mut rows = Vec::new();
        let mut noises = Vec::new();
        let [mut ambiguous, mut hidden, mut contrary] = [0; 3];
        for branch in &branches.list {
            let read = BranchReading::of(&reading, branch);
            ambiguous += read.ambiguous;
            hidden += read.hidden;
            contrary += read.contrary;
            let (of_branch, noise) = read.rows();
            rows.extend(of_branch);
            noises.extend(noise);
        }
        if rows.is_empty() {
            return Err(SpeedsError::Nothing);
        }
        let largest = rows.iter().map(|row| row.contact_radius).fold(0.0, f64::max);
        let mut warnings = case.warnings_of_problem(largest / case.units().length);
        warnings.extend(branches.swapped().into_iter().chain(branches.doubt()).chain(doubt));
        warnings.extend(doubt_of_baseline(&reading, preset, &branches));
        warnings.extend(doubts_of_rows(of_file.len() - rows.len() - hidden, ambiguous, hidden, contrary));
        if rows.iter().all(|row| row.speed.is_none()) {
            notes.push(UNTIMED.to_owned());
        }
        let of_radius = if branches.abscissa == Abscissa::Radius { None } else { Some(sigma_x) };
        Ok(Self {
            head: Head::new("speeds", preset, &case),
            warnings,
            notes,
            from: pair.words(),
            sigma: [of_radius, Some(sigma_force), noises.into_iter().reduce(f64::max)],
            rows,
        })
    }

    /// The rows under the names of their columns.
    ///
    /// # Errors
    /// As [`ReportTable::of`].
    pub fn table(&self) -> Result<ReportTable, RowsError> {
        ReportTable::of(COLUMNS, &self.rows)
    }
}

/// Sentences on rows without a contact, on those that have several, and on those whose contact noise has taken away.
fn doubts_of_rows(without: usize, ambiguous: usize, hidden: usize, contrary: usize) -> Vec<String> {
    let doubts = [
        (without, "row", "in contact left out: no contact with tension at its edge has the force there"),
        (
            ambiguous,
            "row",
            "with the force and the approach of several contacts: those are taken between which the radius jumps least, and \
             G may be wrong. A column of contact radii would tell",
        ),
        (hidden, "row", "left out: no contact is near that of the rows before and after, as noise hides it"),
        (
            contrary,
            "jump",
            "of the contact radius against the direction of its branch: noise hides the contact of some rows, and their G \
             is that of another one. A column of contact radii would tell",
        ),
    ];
    let found = doubts.into_iter().filter(|(count, ..)| *count > 0);
    found.map(|(count, noun, words)| format!("{} {words}", counted(count, noun))).collect()
}

/// What G is computed with, in words.
fn used(reading: &RowReading, preset: &Preset, turned: Turned) -> String {
    let units = &preset.units;
    let gap = preset.gap.radius_of_curvature().map_or_else(
        || format!("the gap {}", preset.gap.name()),
        |radius| format!("R = {}", said(units, Quantity::Length, radius)),
    );
    let Instrument { offset, baseline, tilt } = reading.instrument.turned(turned);
    let mut words =
        vec![format!("E* = {}", said(units, Quantity::Stress, preset.material.effective_modulus)), gap];
    if reading.pair != MeasuredPair::ForceRadius {
        words.push(format!("data.offset = {}", said(units, Quantity::Length, offset)));
    }
    words.push(format!("data.baseline = {}", said(units, Quantity::Force, baseline)));
    if tilt != 0.0 {
        words.push(format!("data.tilt = {}", said(units, Quantity::ForcePerLength, tilt)));
    }
    format!("G is computed from {} with {}", reading.pair.words(), words.join(", "))
}

/// What G is computed from: `asked`, or what the file has.
fn measured_pair(
    asked: Option<MeasuredPair>,
    abscissa: Abscissa,
    points: &[MeasuredPoint],
) -> Result<MeasuredPair, SpeedsError> {
    let is_measured = points.iter().all(|point| radius_of(abscissa, point).is_some());
    let usual = if is_measured { MeasuredPair::ForceRadius } else { MeasuredPair::ForceApproach };
    let pair = asked.unwrap_or(usual);
    if pair != MeasuredPair::ForceApproach && !is_measured {
        return Err(SpeedsError::Lacks { pair, missing: "contact radius at every row" });
    }
    if pair != MeasuredPair::ForceRadius && abscissa == Abscissa::Radius {
        return Err(SpeedsError::Lacks { pair, missing: "approach" });
    }
    Ok(pair)
}

/// The radius up to which the gap is wanted: the largest that is measured, or the start radius where that is larger.
fn wanted(case: &Case, branches: &Branches) -> f64 {
    let measured = attached(branches).map(|point| radius_of(branches.abscissa, point));
    let largest = measured.flatten().fold(0.0, f64::max) / case.units().length;
    largest.max(case.start).min(case.reduced.largest_contact())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measured::PointsFile;
    use crate::preset::{Value, data, read};
    use crate::progress::Unwatched;
    use std::f64::consts::TAU;
    use std::fmt::Write;
    use std::sync::Arc;

    const PRESET: &str = "format = 1\nunits = \"SI\"\n[material]\neffective_modulus = 1e6\nwork_of_adhesion = 0.05\n[gap]\n\
                          shape = \"sphere\"\nradius_of_curvature = 1e-3\n[path]\ncontrol = \"displacement\"\nstart_contact_radius = 1e-4\n";
    const E: f64 = 1e6;
    const R: f64 = 1e-3;

    /// A retraction of a sphere with G = 0.05 (1 + √(v/v₀)) and a v that grows as the contact recedes: s, δ, P, t, v
    /// and G of rows evenly spaced in s.
    fn rows() -> Vec<[f64; 6]> {
        let mut time = 0.0;
        let step = 5e-7;
        (0..160)
            .map(|i| {
                let s = 1.2e-4 - step * f64::from(i);
                let speed = 1e-7 * (1.2e-4 / s).powi(2);
                if i > 0 {
                    // The integral of ds/v over the step.
                    time += ((s + step).powi(3) - s.powi(3)) / (3.0 * 1e-7 * 1.2e-4_f64.powi(2));
                }
                let energy = 0.05 * (1.0 + (speed / 1e-7).sqrt());
                let approach = s * s / R - (TAU * energy * s / E).sqrt();
                let force = 2.0 * E * (approach * s - s.powi(3) / (3.0 * R));
                [s, approach, force, time, speed, energy]
            })
            .collect()
    }

    fn report(text: &str) -> SpeedsReport {
        of_text(PRESET, text)
    }

    fn of_text(preset: &str, text: &str) -> SpeedsReport {
        let mut preset = read("made", preset).unwrap();
        preset.set(data::OFFSET, Value::Number(0.0)).unwrap();
        let source = PointsFile::new("made.csv".to_owned(), None, text.as_bytes().into());
        preset.set(data::FILE, Value::Points(Arc::new(source))).unwrap();
        preset.set(data::FREE_PART, Value::Text("none".to_owned())).unwrap();
        preset.set(data::SIGNS, Value::Text("x=+,force=+".to_owned())).unwrap();
        SpeedsReport::compute(&preset, None, &Unwatched).unwrap()
    }

    #[test]
    fn force_and_radius_give_the_energy_and_the_speed_of_a_made_edge() {
        let made = rows();
        let mut text = "contact radius [m],force [N],time [s],segment\n".to_owned();
        for [s, _, force, time, ..] in &made {
            writeln!(text, "{s:e},{force:e},{time:e},retraction").unwrap();
        }
        let mut preset = read("made", PRESET).unwrap();
        let source = PointsFile::new("made.csv".to_owned(), None, text.as_bytes().into());
        preset.set(data::FILE, Value::Points(Arc::new(source))).unwrap();
        let found = SpeedsReport::compute(&preset, None, &Unwatched).unwrap();
        assert_eq!((found.from, found.rows.len()), ("force and contact radius", made.len()));
        for (row, [s, .., speed, energy]) in found.rows.iter().zip(&made) {
            assert!((row.contact_radius / s - 1.0).abs() < 1e-12, "{row:?} {s}");
            assert!((row.energy_release_rate / energy - 1.0).abs() < 1e-9, "{row:?} {energy}");
            assert!((row.speed.unwrap() / speed - 1.0).abs() < 0.02, "{row:?} {speed}");
        }
        assert!(
            found
                .table()
                .unwrap()
                .csv()
                .unwrap()
                .starts_with("time,contact_radius,speed,energy_release_rate,error,")
        );
    }

    #[test]
    fn force_and_approach_give_the_same() {
        // Before the approach turns back.
        let made = &rows()[..100];
        let mut text = "approach [m],force [N],segment\n".to_owned();
        for [_, approach, force, ..] in made {
            writeln!(text, "{approach:e},{force:e},retraction").unwrap();
        }
        let found = report(&text);
        assert_eq!((found.from, found.rows.len()), ("force and approach", made.len()));
        for row in &found.rows {
            let [s, .., energy] = made[row.row - 1];
            assert!((row.contact_radius / s - 1.0).abs() < 1e-6, "{row:?} {s}");
            assert!((row.energy_release_rate / energy - 1.0).abs() < 1e-6, "{row:?} {energy}");
            assert!(row.speed.is_none() && row.time.is_none());
        }
        assert!(found.notes.iter().any(|note| note.contains(UNTIMED)));
    }

    /// g falls with s for a while, so two discs have the force and the approach of a row; h = r² − b r⁴ + c r⁶ has
    /// g = 2s² − 8/3 b s⁴ + 16/5 c s⁶.
    #[test]
    fn of_two_contacts_with_one_force_and_approach_the_one_among_its_neighbours_is_taken() {
        let [b, c, energy] = [1.8_f64, 1.0, 7e-5];
        let made = |i: usize| {
            let s = 1.0 - 1e-3 * i as f64;
            let g = 2.0 * s.powi(2) - 8.0 / 3.0 * b * s.powi(4) + 3.2 * c * s.powi(6);
            let area = 2.0 / 3.0 * s.powi(3) - 8.0 / 15.0 * b * s.powi(5) + 3.2 / 7.0 * c * s.powi(7);
            let approach = g - (TAU * energy * s).sqrt();
            [s, approach, 2.0 * (approach * s - area)]
        };
        let mut text = "approach,force,segment\n".to_owned();
        for i in 0..100 {
            let [_, approach, force] = made(i);
            writeln!(text, "{approach:e},{force:e},retraction").unwrap();
        }
        let gap = "shape = \"formula\"\nformula = \"r^2 - 1.8*r^4 + r^6\"\n";
        let preset = format!(
            "format = 1\n[material]\neffective_modulus = 1.0\nwork_of_adhesion = 1e-4\n[gap]\n{gap}[path]\n\
             control = \"displacement\"\nstart_contact_radius = 1.0\n"
        );
        let found = of_text(&preset, &text);
        assert_eq!(found.rows.len(), 100);
        for row in &found.rows {
            let [s, ..] = made(row.row - 1);
            assert!((row.contact_radius / s - 1.0).abs() < 1e-6, "{row:?} {s}");
            assert!((row.energy_release_rate / energy - 1.0).abs() < 1e-4, "{row:?}");
        }
    }

    #[test]
    fn any_two_of_three_columns_give_the_same() {
        let made = &rows()[..100];
        let mut text = "approach [m],force [N],contact radius [m],segment\n".to_owned();
        for [s, approach, force, ..] in made {
            writeln!(text, "{approach:e},{force:e},{s:e},retraction").unwrap();
        }
        let mut preset = read("made", PRESET).unwrap();
        let source = PointsFile::new("made.csv".to_owned(), None, text.as_bytes().into());
        preset.set(data::FILE, Value::Points(Arc::new(source))).unwrap();
        preset.set(data::FREE_PART, Value::Text("none".to_owned())).unwrap();
        preset.set(data::SIGNS, Value::Text("x=+,force=+".to_owned())).unwrap();
        for pair in MeasuredPair::ALL {
            let found = SpeedsReport::compute(&preset, Some(pair), &Unwatched).unwrap();
            assert_eq!((found.from, found.rows.len()), (pair.words(), made.len()));
            for row in &found.rows {
                let [s, .., energy] = made[row.row - 1];
                assert!((row.contact_radius / s - 1.0).abs() < 1e-6, "{row:?} {s}");
                assert!((row.energy_release_rate / energy - 1.0).abs() < 1e-6, "{row:?} {energy}");
            }
        }
        // Twice the E*: twice the G from approach and radius, and a different G from the others.
        preset.set("material.effective_modulus", Value::Number(2e6)).unwrap();
        let of = |pair| SpeedsReport::compute(&preset, Some(pair), &Unwatched).unwrap().rows[50];
        let [s, .., energy] = made[of(MeasuredPair::ApproachRadius).row - 1];
        assert!((of(MeasuredPair::ApproachRadius).energy_release_rate / (2.0 * energy) - 1.0).abs() < 1e-6);
        assert!(
            (of(MeasuredPair::ForceRadius).energy_release_rate / (2.0 * energy) - 1.0).abs() > 0.1,
            "{s}"
        );
    }

    #[test]
    fn an_offset_that_is_not_given_is_found_or_doubted() {
        const OFFSET_OF_X: f64 = 3e-6;
        let of = |sign: f64, with_radii: bool, energy: &dyn Fn(f64) -> f64, offset: f64| {
            let mut text = "approach [m],force [N],contact radius [m],segment\n".to_owned();
            for i in 0..90 {
                let s = 1.2e-4 - 5e-7 * f64::from(i);
                let approach = s * s / R - (TAU * energy(s) * s / E).sqrt();
                let force = 2.0 * E * (approach * s - s.powi(3) / (3.0 * R));
                writeln!(text, "{:e},{force:e},{s:e},retraction", sign * (approach + offset)).unwrap();
            }
            let mut preset = read("made", PRESET).unwrap();
            let source = PointsFile::new("made.csv".to_owned(), None, text.as_bytes().into());
            preset.set(data::FILE, Value::Points(Arc::new(source))).unwrap();
            preset.set(data::FREE_PART, Value::Text("none".to_owned())).unwrap();
            let signs = if sign < 0.0 { "x=-,force=+" } else { "x=+,force=+" };
            preset.set(data::SIGNS, Value::Text(signs.to_owned())).unwrap();
            if !with_radii {
                let columns = "approach=1,force=2,segment=4".to_owned();
                preset.set(data::COLUMNS, Value::Text(columns)).unwrap();
            }
            preset
        };
        let even = |_| 0.05;
        let grows = |s: f64| 0.05 * (1.2e-4 / s).powf(1.5);
        let compute = |preset: &Preset| {
            SpeedsReport::compute(preset, Some(MeasuredPair::ForceApproach), &Unwatched).unwrap()
        };
        let off = |report: &SpeedsReport, energy: &dyn Fn(f64) -> f64| {
            let off = |row: &SpeedRow| {
                (row.energy_release_rate / energy(1.2e-4 - 5e-7 * (row.row - 1) as f64) - 1.0).abs()
            };
            report.rows.iter().map(off).fold(0.0, f64::max)
        };
        let doubt = |report: &SpeedsReport| {
            report.warnings.iter().find(|warning| warning.starts_with("data.offset is not given")).cloned()
        };
        for sign in [1.0, -1.0] {
            // By the radii, whatever G is; without them, where one G describes the rows.
            for (with_radii, energy) in [(true, &grows as &dyn Fn(f64) -> f64), (false, &even)] {
                let found = compute(&of(sign, with_radii, energy, OFFSET_OF_X));
                assert!(off(&found, energy) < 1e-3, "{} {}", off(&found, energy), doubt(&found).unwrap());
                let said = doubt(&found).unwrap();
                let x = if sign < 0.0 { "x = -3 um" } else { "x = 3 um" };
                assert!(said.contains(x), "{said}");
                // The right one is not doubted, given or zero.
                let mut given = of(sign, with_radii, energy, OFFSET_OF_X);
                given.set(data::OFFSET, Value::Number(sign * OFFSET_OF_X)).unwrap();
                for right in [given, of(sign, with_radii, energy, 0.0)] {
                    let found = compute(&right);
                    assert!(off(&found, energy) < 1e-5 && doubt(&found).is_none(), "{:?}", found.warnings);
                }
            }
            let found = compute(&of(sign, false, &grows, OFFSET_OF_X));
            let said = doubt(&found).unwrap();
            assert!(said.contains("x is taken as the approach") && off(&found, &grows) > 0.1, "{said}");
            assert!(
                found
                    .notes
                    .iter()
                    .any(|note| note.contains("with E* = 1000 kPa, R = 1000 um, data.offset = 0"))
            );
        }
    }

    #[test]
    fn a_baseline_that_nothing_shows_is_doubted() {
        let mut text = "contact radius [m],force [N],segment\n".to_owned();
        for [s, _, force, ..] in rows() {
            writeln!(text, "{s:e},{force:e},retraction").unwrap();
        }
        let mut preset = read("made", PRESET).unwrap();
        let source = PointsFile::new("made.csv".to_owned(), None, text.as_bytes().into());
        preset.set(data::FILE, Value::Points(Arc::new(source))).unwrap();
        let is_told = |preset: &Preset| {
            let warnings = SpeedsReport::compute(preset, None, &Unwatched).unwrap().warnings;
            warnings
                .iter()
                .any(|warning| warning.starts_with("no row is apart and data.baseline is not given"))
        };
        assert!(is_told(&preset));
        preset.set(data::BASELINE, Value::Number(0.0)).unwrap();
        assert!(!is_told(&preset));
    }

    #[test]
    fn errors_are_what_the_noise_of_the_columns_does() {
        let mut state = 7_u64;
        let mut normal = move || {
            let mut sum = -6.0;
            for _ in 0..12 {
                state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                sum += (state >> 11) as f64 / (1_u64 << 53) as f64;
            }
            sum
        };
        let mut squares = 0.0;
        let made = rows();
        let mut text = "contact radius [m],force [N],time [s],segment\n".to_owned();
        for [s, _, force, time, ..] in &made {
            let (s, force) = (s + 1e-7 * normal(), force + 2e-6 * normal());
            writeln!(text, "{s:e},{force:e},{time:e},retraction").unwrap();
        }
        let mut preset = read("made", PRESET).unwrap();
        let source = PointsFile::new("made.csv".to_owned(), None, text.as_bytes().into());
        preset.set(data::FILE, Value::Points(Arc::new(source))).unwrap();
        let found = SpeedsReport::compute(&preset, None, &Unwatched).unwrap();
        for row in &found.rows {
            let energy = made[row.row - 1][5];
            squares += ((row.energy_release_rate - energy) / row.error).powi(2) / made.len() as f64;
        }
        assert!((0.5..1.6).contains(&squares), "{squares}");
    }
}
