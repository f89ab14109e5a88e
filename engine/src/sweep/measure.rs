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

/// The quantities of a preset.
#[derive(Debug, Clone, PartialEq)]
pub struct MeasuredQuantities {
    /// One for each wanted column; `None` if it is undefined or could not be computed.
    pub cells: Vec<Option<Cell>>,
    /// Why the first missing quantity could not be computed.
    pub fault: Option<Fault>,
}

/// What has been computed for a preset so far: each part once, when the first quantity needs it.
struct Workings<'a> {
    preset: &'a Preset,
    ground: PresetValues,
    start: Option<Result<StartState, Fault>>,
    line: Option<Result<CurveMinima, Fault>>,
    paths: Vec<(Control, ContactKind, Result<OnPath, Fault>)>,
    loops: Vec<(Control, Result<OnPath, Fault>)>,
    pull: Option<Result<RunReport, Fault>>,
    fitting: Option<Result<Fitting, Fault>>,
    progress: &'a dyn Progress,
}

/// The `wanted` quantities of `preset`; `progress` is asked now and then, and the result is `None` if it said stop.
pub fn measure(
    preset: &Preset,
    wanted: &[QuantityColumn],
    progress: &dyn Progress,
) -> Option<MeasuredQuantities> {
    let ground = PresetValues::new(preset);
    let (paths, loops) = (Vec::new(), Vec::new());
    let mut work = Workings {
        preset,
        ground,
        start: None,
        line: None,
        paths,
        loops,
        pull: None,
        fitting: None,
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
        measured.cells.push(cell.map(|cell| work.shown(cell, column.quantity)));
    }
    Some(measured)
}

impl Workings<'_> {
    fn cell(&mut self, column: &QuantityColumn) -> Result<Option<Cell>, Fault> {
        let own = self.preset.path.control;
        match column.quantity.of {
            Stage::Preset(of) => Ok(of(&self.ground)),
            Stage::Start(of) => self.start().map(of),
            Stage::Curve(of) => of(self.line()?),
            Stage::Limits => {
                let control = self.reduced(column.under.control(own))?;
                Ok(Some(Cell::Count(self.line()?.curve.limit_points(control).len())))
            }
            Stage::Unloading(of) => {
                let control = self.reduced(column.under.control(own))?;
                let path = self.path(control, None)?;
                let (found, stop) = (of(path), path.path.stop);
                self.ended(found, stop)
            }
            Stage::Passed => {
                let control = self.reduced(column.under.control(own))?;
                self.inadmissible_share(control)
            }
            Stage::Loop(of) => {
                let control = self.reduced(column.under.control(own))?;
                let path = self.whole(control)?;
                let (found, stop) = (of(path), path.path.stop);
                self.ended(found, stop)
            }
            Stage::Pull(of) => self.pull().map(of),
            Stage::Fit(of) => self.fitting().map(of),
        }
    }

    /// A quantity found on a path with this end: a path that stopped early has no answer.
    fn ended(&mut self, found: Option<Cell>, stop: PathStop) -> Result<Option<Cell>, Fault> {
        if matches!(stop, PathStop::Apart | PathStop::End) {
            return Ok(found);
        }
        let case = &self.start()?.case;
        Err(Fault::incomplete(&stop.words(&case.printer())))
    }

    fn reduced(&mut self, control: Control) -> Result<Control, Fault> {
        let stiffness = self.start()?.case.units().stiffness;
        Ok(control.in_units(stiffness))
    }

    fn start(&mut self) -> Result<&StartState, Fault> {
        let made = self.start.get_or_insert_with(|| {
            let case = Case::with_range(self.preset, self.progress).map_err(|e| Fault::of_case(&e))?;
            Ok(StartState { case })
        });
        made.as_ref().map_err(Clone::clone)
    }

    fn line(&mut self) -> Result<&CurveMinima, Fault> {
        if self.line.is_none() {
            let progress = self.progress;
            let made = self
                .start()
                .and_then(|start| CurveMinima::new(&start.case, progress).map_err(|e| Fault::of_case(&e)));
            self.line = Some(made);
        }
        match &self.line {
            Some(Ok(line)) => Ok(line),
            Some(Err(fault)) => Err(fault.clone()),
            None => Err(Fault::incomplete("no curve")),
        }
    }

    /// The unloading under a control; with the contacts of the preset if none are named.
    fn path(&mut self, control: Control, contact: Option<ContactKind>) -> Result<&OnPath, Fault> {
        let own = self.start()?.case.setting_of_unloading();
        let contact = contact.unwrap_or(own.contact);
        let known = self.paths.iter().position(|(of, with, _)| (*of, *with) == (control, contact));
        let at = known.unwrap_or_else(|| {
            let (losses, detail) = (Losses::Once, Detail::Borders);
            let setting = PathSetting { control, contact, losses, detail, ..own };
            let progress = self.progress;
            let in_zone = self.start().and_then(|start| {
                start.case.unload_in_zone(&setting, progress).map_err(|error| Fault::of_case(&error))
            });
            let made = match in_zone.transpose() {
                Some(found) => found.map(|path| OnPath { path }),
                None => self.line().map(|_| ()).and_then(|()| {
                    let (Some(Ok(start)), Some(Ok(line))) = (&self.start, &self.line) else {
                        return Err(Fault::incomplete("no curve"));
                    };
                    let path = start.case.unload(&line.curve, &setting, self.progress);
                    Ok(OnPath { path: path.map_err(|e| Fault::of_case(&e))? })
                }),
            };
            self.paths.push((control, contact, made));
            self.paths.len() - 1
        });
        self.paths[at].2.as_ref().map_err(Clone::clone)
    }

    fn whole(&mut self, control: Control) -> Result<&OnPath, Fault> {
        let known = self.loops.iter().position(|(known, _)| *known == control);
        let at = known.unwrap_or_else(|| {
            let progress = self.progress;
            let made = self.start().and_then(|start| {
                let (losses, detail) = (Losses::Once, Detail::Borders);
                let setting = PathSetting { control, losses, detail, ..start.case.setting() };
                let path = start.case.cycle(None, &setting, progress);
                Ok(OnPath { path: path.map_err(|e| Fault::of_case(&e))? })
            });
            self.loops.push((control, made));
            self.loops.len() - 1
        });
        self.loops[at].1.as_ref().map_err(Clone::clone)
    }

    fn pull(&mut self) -> Result<&RunReport, Fault> {
        let made = self.pull.get_or_insert_with(|| {
            let asked = AskedPulls::default();
            let report =
                PullReport::compute(self.preset, &asked, self.progress).map_err(|e| Fault::of_pull(&e))?;
            report.runs.into_iter().next().ok_or_else(|| Fault::incomplete("no pull"))
        });
        made.as_ref().map_err(Clone::clone)
    }

    fn fitting(&mut self) -> Result<&Fitting, Fault> {
        let made = self.fitting.get_or_insert_with(|| Fitting::new(self.preset, self.progress));
        made.as_ref().map_err(Clone::clone)
    }

    fn inadmissible_share(&mut self, control: Control) -> Result<Option<Cell>, Fault> {
        let pieces = self.path(control, Some(ContactKind::OneDisc))?.path.pieces();
        let progress = self.progress;
        let passed = passed(&self.line()?.curve, &pieces, progress);
        let length = |sum: f64, [from, to]: [f64; 2]| sum + (from - to);
        let whole = pieces.iter().copied().fold(0.0, length);
        let lost =
            passed.unwrap_or_default().iter().map(|overlap| [overlap.from, overlap.to]).fold(0.0, length);
        Ok((whole > 0.0).then(|| Cell::Number(lost / whole)))
    }

    /// A cell in the user's units: what comes from the preset alone, or from a report, is in them already.
    fn shown(&self, cell: Cell, quantity: &SweepQuantity) -> Cell {
        let (Cell::Number(x), Some(Ok(start)), false) =
            (cell, &self.start, matches!(quantity.of, Stage::Preset(_) | Stage::Pull(_) | Stage::Fit(_)))
        else {
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
