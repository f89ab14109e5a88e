//! The wanted quantities of one preset, and nothing else: no curve where the groups are all, no losses where none are
//! asked for.

use super::fault::Fault;
use super::quantity::{Column, Quantity, Stage};
use super::stage::{Cell, CurveMinima, Fitting, Loop, PresetValues, StartState, UnloadingPath};
use crate::case::Case;
use crate::preset::Preset;
use crate::problem::Control;
use crate::progress::Progress;
use crate::quasistatic::overlap::passed;
use crate::quasistatic::path::Areas;
use crate::quasistatic::{Losses, PathStop};
use crate::units::Quantity as Unit;

/// The quantities of a preset.
#[derive(Debug, Clone, PartialEq)]
pub struct Measured {
    /// One for each wanted column; `None` where it is not defined or could not be had.
    pub cells: Vec<Option<Cell>>,
    /// The first reason for which one could not be had.
    pub fault: Option<Fault>,
}

/// What has been computed of a preset so far: each part once, when the first quantity needs it.
struct Work<'a> {
    preset: &'a Preset,
    ground: PresetValues,
    start: Option<Result<StartState, Fault>>,
    line: Option<Result<CurveMinima, Fault>>,
    paths: Vec<(Control, Result<UnloadingPath, Fault>)>,
    loops: Vec<(Control, Result<Loop, Fault>)>,
    fitting: Option<Result<Fitting, Fault>>,
    progress: &'a dyn Progress,
}

/// The `wanted` quantities of `preset`; `progress` is asked now and then, `None` when it said stop.
pub fn measure(preset: &Preset, wanted: &[Column], progress: &dyn Progress) -> Option<Measured> {
    let ground = PresetValues::new(preset);
    let (paths, loops) = (Vec::new(), Vec::new());
    let mut work = Work { preset, ground, start: None, line: None, paths, loops, fitting: None, progress };
    let mut measured = Measured { cells: Vec::with_capacity(wanted.len()), fault: None };
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

impl Work<'_> {
    fn cell(&mut self, column: &Column) -> Result<Option<Cell>, Fault> {
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
                let path = self.path(control)?;
                match (of(path), path.unloading.stop) {
                    // A path that stopped early has no answer.
                    (_, PathStop::Curve(stop)) => {
                        let case = &self.start()?.case;
                        let stop = PathStop::Curve(stop.in_units(case.units()));
                        Err(Fault::incomplete(&stop.words(&case.shown)))
                    }
                    (found, _) => Ok(found),
                }
            }
            Stage::Passed => {
                let control = self.reduced(column.under.control(own))?;
                self.inadmissible_share(control)
            }
            Stage::Loop(of) => {
                let control = self.reduced(column.under.control(own))?;
                self.whole(control).map(of)
            }
            Stage::Fit(of) => self.fitting().map(of),
        }
    }

    fn reduced(&mut self, control: Control) -> Result<Control, Fault> {
        let stiffness = self.start()?.case.units().stiffness;
        Ok(control.in_units(stiffness))
    }

    fn start(&mut self) -> Result<&StartState, Fault> {
        let made = self.start.get_or_insert_with(|| {
            let case = Case::prepare(self.preset, self.progress).map_err(|e| Fault::of_case(&e))?;
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

    fn path(&mut self, control: Control) -> Result<&UnloadingPath, Fault> {
        let known = self.paths.iter().position(|(known, _)| *known == control);
        let at = known.unwrap_or_else(|| {
            let made = self.line().map(|_| ()).and_then(|()| {
                let (Some(Ok(start)), Some(Ok(line))) = (&self.start, &self.line) else {
                    return Err(Fault::incomplete("no curve"));
                };
                let unloading = start.case.unload_while(&line.curve, control, Losses::Once, self.progress);
                Ok(UnloadingPath { unloading: unloading.map_err(|e| Fault::of_case(&e))? })
            });
            self.paths.push((control, made));
            self.paths.len() - 1
        });
        self.paths[at].1.as_ref().map_err(Clone::clone)
    }

    fn whole(&mut self, control: Control) -> Result<&Loop, Fault> {
        let known = self.loops.iter().position(|(known, _)| *known == control);
        let at = known.unwrap_or_else(|| {
            let progress = self.progress;
            let made = self.start().and_then(|start| {
                let cycle = start.case.cycle(control, None, Areas::No, progress);
                Ok(Loop { cycle: cycle.map_err(|e| Fault::of_case(&e))? })
            });
            self.loops.push((control, made));
            self.loops.len() - 1
        });
        self.loops[at].1.as_ref().map_err(Clone::clone)
    }

    fn fitting(&mut self) -> Result<&Fitting, Fault> {
        let made = self.fitting.get_or_insert_with(|| Fitting::new(self.preset, self.progress));
        made.as_ref().map_err(Clone::clone)
    }

    fn inadmissible_share(&mut self, control: Control) -> Result<Option<Cell>, Fault> {
        let pieces = self.path(control)?.unloading.pieces.clone();
        let progress = self.progress;
        let passed = passed(&self.line()?.curve, &pieces, progress);
        let length = |sum: f64, [from, to]: [f64; 2]| sum + (from - to);
        let whole = pieces.iter().copied().fold(0.0, length);
        let lost =
            passed.unwrap_or_default().iter().map(|overlap| [overlap.from, overlap.to]).fold(0.0, length);
        Ok((whole > 0.0).then(|| Cell::Number(lost / whole)))
    }

    /// A cell in the user's units: what comes of the preset alone, or of a fit, is in them already.
    fn shown(&self, cell: Cell, quantity: &Quantity) -> Cell {
        let (Cell::Number(x), Some(Ok(start)), false) =
            (cell, &self.start, matches!(quantity.of, Stage::Preset(_) | Stage::Fit(_)))
        else {
            return cell;
        };
        let units = start.case.units();
        Cell::Number(match quantity.unit {
            Unit::Length => x * units.length,
            Unit::Force => x * units.force,
            Unit::Energy => x * units.energy,
            _ => x,
        })
    }
}
