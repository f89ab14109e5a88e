//! Computes the wanted quantities of one preset and nothing else: no curve if only groups are wanted, no losses if none
//! are asked for.

use super::fault::Fault;
use super::quantity::{QuantityColumn, Stage, SweepQuantity};
use super::stage::{Cell, CurveMinima, Fitting, OnPath, PresetValues, StartState};
use crate::case::Case;
use crate::preset::Preset;
use crate::problem::{ContactKind, Control};
use crate::progress::Progress;
use crate::quasistatic::Detail;
use crate::quasistatic::overlap::passed;
use crate::quasistatic::path::{Losses, PathSetting, PathStop};
use crate::report::PullReport;
use crate::report::pull::{AskedPulls, RunReport};
use crate::units::Quantity;
use std::cell::OnceCell;

/// The quantities of a preset.
#[derive(Debug, Clone, PartialEq)]
pub struct MeasuredQuantities {
    /// One for each wanted column; `None` if it is undefined or could not be computed.
    pub cells: Vec<Option<Cell>>,
    /// Why the first missing quantity could not be computed.
    pub fault: Option<Fault>,
}

/// The unloading under a control with these contacts; the whole loop under it where none are named.
type AskedPath = (Control, Option<ContactKind>);

/// What has been computed for a preset so far: each part once, when the first quantity needs it.
struct Workings<'a> {
    preset: &'a Preset,
    ground: PresetValues,
    start: OnceCell<Result<StartState, Fault>>,
    line: OnceCell<Result<CurveMinima, Fault>>,
    paths: Vec<(AskedPath, Result<OnPath, Fault>)>,
    pull: OnceCell<Result<RunReport, Fault>>,
    fitting: OnceCell<Result<Fitting, Fault>>,
    progress: &'a dyn Progress,
}

/// What is in `cell`, made first if it is empty.
fn once<T>(cell: &OnceCell<Result<T, Fault>>, make: impl FnOnce() -> Result<T, Fault>) -> Result<&T, Fault> {
    cell.get_or_init(make).as_ref().map_err(Clone::clone)
}

/// The `wanted` quantities of `preset`; `progress` is asked now and then, and the result is `None` if it said stop.
pub fn measure(
    preset: &Preset,
    wanted: &[QuantityColumn],
    progress: &dyn Progress,
) -> Option<MeasuredQuantities> {
    let mut work = Workings {
        preset,
        ground: PresetValues::new(preset),
        start: OnceCell::new(),
        line: OnceCell::new(),
        paths: Vec::new(),
        pull: OnceCell::new(),
        fitting: OnceCell::new(),
        progress,
    };
    let mut measured = MeasuredQuantities { cells: Vec::with_capacity(wanted.len()), fault: None };
    for column in wanted {
        let cell = work.cell(column).unwrap_or_else(|fault| {
            measured.fault.get_or_insert(fault);
            None
        });
        if progress.stop() {
            return None;
        }
        let shown = cell.map(|cell| work.shown(cell, column.quantity));
        // A ratio to nothing, such as that to the pull of a sphere without adhesion, is no value.
        measured.cells.push(shown.filter(|cell| !matches!(cell, Cell::Number(x) if !x.is_finite())));
    }
    Some(measured)
}

impl Workings<'_> {
    fn cell(&mut self, column: &QuantityColumn) -> Result<Option<Cell>, Fault> {
        match column.quantity.of {
            Stage::Preset(of) => Ok(of(&self.ground)),
            Stage::Start(of) => self.start().map(of),
            Stage::Curve(of) => of(self.line()?),
            Stage::Limits => {
                let control = self.control(column)?;
                Ok(Some(Cell::Count(self.line()?.curve.limit_points(control).len())))
            }
            Stage::Unloading(of) => {
                let contact = self.start()?.case.setting_of_unloading().contact;
                self.on_path(of, self.control(column)?, Some(contact))
            }
            Stage::Least(of, what) => {
                let contact = Some(self.start()?.case.setting_of_unloading().contact);
                let control = self.control(column)?;
                let found = self.on_path(of, control, contact)?;
                let kept = self.paths.iter().find(|(asked, _)| *asked == (control, contact));
                let path = kept.and_then(|(_, on)| on.as_ref().ok()).map(|on| &on.path);
                let case = &self.start()?.case;
                if path.is_some_and(|path| case.is_cut_off(path, what)) {
                    return Err(Fault::small_start());
                }
                if path.is_some_and(|path| case.ends_early(path, what)) {
                    return Err(Fault::early_end());
                }
                Ok(found)
            }
            Stage::Passed => self.inadmissible_share(self.control(column)?),
            Stage::Loop(of) => self.on_path(of, self.control(column)?, None),
            Stage::Pull(of) => self.pull().map(of),
            Stage::Fit(of) => self.fitting().map(of),
        }
    }

    /// A quantity of a path: one that stopped early has no answer.
    fn on_path(
        &mut self,
        of: fn(&OnPath) -> Option<Cell>,
        control: Control,
        contact: Option<ContactKind>,
    ) -> Result<Option<Cell>, Fault> {
        let path = self.path(control, contact)?;
        let (found, stop) = (of(path), path.path.stop);
        if matches!(stop, PathStop::Apart | PathStop::End) {
            return Ok(found);
        }
        Err(Fault::incomplete(&stop.words(&self.start()?.case.printer())))
    }

    /// The control of a column, reduced.
    fn control(&self, column: &QuantityColumn) -> Result<Control, Fault> {
        let stiffness = self.start()?.case.units().stiffness;
        Ok(column.under.control(self.preset.path.control).in_units(stiffness))
    }

    fn start(&self) -> Result<&StartState, Fault> {
        once(&self.start, || {
            let case = Case::with_range(self.preset, self.progress).map_err(|e| Fault::of_case(&e))?;
            Ok(StartState { case })
        })
    }

    fn line(&self) -> Result<&CurveMinima, Fault> {
        once(&self.line, || {
            CurveMinima::new(&self.start()?.case, self.progress).map_err(|e| Fault::of_case(&e))
        })
    }

    /// A path as [`Workings::paths`] keeps it.
    fn path(&mut self, control: Control, contact: Option<ContactKind>) -> Result<&OnPath, Fault> {
        let key = (control, contact);
        let at = self.paths.iter().position(|(known, _)| *known == key).unwrap_or_else(|| {
            self.paths.push((key, self.followed(control, contact)));
            self.paths.len() - 1
        });
        self.paths[at].1.as_ref().map_err(Clone::clone)
    }

    fn followed(&self, control: Control, contact: Option<ContactKind>) -> Result<OnPath, Fault> {
        let case = &self.start()?.case;
        let (losses, detail) = (Losses::Once, Detail::Borders);
        let path = if let Some(contact) = contact {
            let setting = PathSetting { control, contact, losses, detail, ..case.setting_of_unloading() };
            match case.unload_in_zone(&setting, self.progress).transpose() {
                Some(path) => path,
                None => case.unload(&self.line()?.curve, &setting, self.progress),
            }
        } else {
            let setting = PathSetting { control, losses, detail, ..case.setting() };
            case.cycle(None, &setting, self.progress)
        };
        Ok(OnPath { path: path.map_err(|e| Fault::of_case(&e))? })
    }

    fn pull(&self) -> Result<&RunReport, Fault> {
        once(&self.pull, || {
            let asked = AskedPulls::default();
            let report =
                PullReport::compute(self.preset, &asked, self.progress).map_err(|e| Fault::of_pull(&e))?;
            let run = report.runs.into_iter().next().ok_or_else(|| Fault::incomplete("no pull"))?;
            let is_asked_for = self.preset.path.contact == ContactKind::OneDisc;
            if run.overlaps_at.is_some() && !is_asked_for { Err(Fault::overlapping_start()) } else { Ok(run) }
        })
    }

    fn fitting(&self) -> Result<&Fitting, Fault> {
        once(&self.fitting, || Fitting::new(self.preset, self.progress))
    }

    fn inadmissible_share(&mut self, control: Control) -> Result<Option<Cell>, Fault> {
        let pieces = self.path(control, Some(ContactKind::OneDisc))?.path.pieces();
        let passed = passed(&self.line()?.curve, &pieces, self.progress);
        let length = |sum: f64, [from, to]: [f64; 2]| sum + (from - to);
        let whole = pieces.iter().copied().fold(0.0, length);
        let lost =
            passed.unwrap_or_default().iter().map(|overlap| [overlap.from, overlap.to]).fold(0.0, length);
        Ok((whole > 0.0).then(|| Cell::Number(lost / whole)))
    }

    /// A cell in the user's units: what comes from the preset alone, or from a report, is in them already.
    fn shown(&self, cell: Cell, quantity: &SweepQuantity) -> Cell {
        let (Cell::Number(x), Some(Ok(start)), false) = (
            cell,
            self.start.get(),
            matches!(quantity.of, Stage::Preset(_) | Stage::Pull(_) | Stage::Fit(_)),
        ) else {
            return cell;
        };
        let units = start.case.units();
        Cell::Number(match quantity.unit {
            Quantity::Length => x * units.length,
            Quantity::Force => x * units.force,
            Quantity::Energy => x * units.energy,
            _ => x,
        })
    }
}
