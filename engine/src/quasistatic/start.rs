//! The state a path starts from.

use super::monotone::Monotone;
use crate::disc::{Basis, ExactSolution, Solution, Table, TableError};
use crate::elementary::cbrt;
use crate::problem::{Control, Printer, Reduced, Start};
use crate::progress::{Progress, Stopped};

/// Why a start state was not found. All numbers are reduced.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error("{}", self.words(&Printer::reduced()))]
pub enum StartError {
    /// The basis has no equilibrium at the radius.
    NoEquilibrium(f64),
    /// No contact carries the value.
    OutOfReach {
        /// `approach` or `force`.
        name: &'static str,
        /// The value asked for.
        value: f64,
        /// The smallest on the curve.
        smallest: f64,
    },
    /// The value is beyond what is known of the gap.
    NotKnown {
        /// `approach` or `force`.
        name: &'static str,
        /// The value asked for.
        value: f64,
        /// The largest radius tried.
        searched: f64,
        /// The largest radius known.
        known: f64,
    },
    /// The curve was not found to rise above the value.
    NotReached {
        /// `approach` or `force`.
        name: &'static str,
        /// The value asked for.
        value: f64,
        /// The largest radius tried.
        largest: f64,
    },
    /// The start was no longer wanted.
    Stopped(#[from] Stopped),
}

impl StartError {
    /// What is wrong, in words.
    pub fn words(&self, printer: &Printer) -> String {
        let radius = |s| printer.length(s);
        let of = |name, x| if name == "force" { printer.force(x) } else { printer.length(x) };
        match *self {
            Self::NoEquilibrium(s) => format!("there is no equilibrium at the contact radius {}", radius(s)),
            Self::OutOfReach { name, value, smallest } => {
                let (value, smallest) = (of(name, value), of(name, smallest));
                format!("no contact has the {name} {value}; the smallest on the curve is {smallest}")
            }
            Self::NotKnown { name, value, searched, known } => {
                let (value, searched, known) = (of(name, value), radius(searched), radius(known));
                format!(
                    "no contact up to the radius {searched} has the {name} {value}, and the gap is known only up to \
                     the radius {known}"
                )
            }
            Self::NotReached { name, value, largest } => {
                let (value, largest) = (of(name, value), radius(largest));
                format!("no contact up to the radius {largest} reaches the {name} {value}")
            }
            Self::Stopped(stopped) => stopped.to_string(),
        }
    }
}

/// How far out a start is looked for, as a multiple of the radius where a paraboloid of the reference length takes the value.
const FARTHEST: f64 = 1e12;

/// A search ends when it takes more panels than this.
const MOST_PANELS: usize = 100_000;

/// A curve that stays above the value over this factor in radius is not searched further out.
const ABOVE: f64 = 2.0;

/// The contact radius of the start state.
///
/// For an approach or a preload the curve is searched further and further out, until it stays above the value over a
/// factor of two in radius. The start is the outermost state that takes the value and is stable under the control.
/// Where the gap is known only up to some radius, it is the outermost such state within that radius.
///
/// # Errors
/// [`StartError`] when there is none.
pub fn contact_radius(
    problem: &Reduced,
    basis: &dyn Basis,
    start: Start,
    progress: &dyn Progress,
) -> Result<f64, StartError> {
    let (control, value, name) = match start {
        Start::ContactRadius(s) => {
            return basis.equilibrium(problem, s).map(|_| s).ok_or(StartError::NoEquilibrium(s));
        }
        Start::Approach(value) => (Control::Displacement, value, "approach"),
        Start::Force(value) => (Control::Force, value, "force"),
    };
    // The radii at which a paraboloid of R = 1 takes the value, with and without adhesion.
    let elastic = if control == Control::Force { cbrt(value.abs()) } else { value.abs().sqrt() };
    let adhesive = cbrt(problem.work_of_adhesion);
    let unit = elastic.max(adhesive).max(f64::MIN_POSITIVE);
    let largest = FARTHEST * unit;
    let most = problem.largest_contact();
    let from = 1e-3 * unit.min(most);
    let mut reach = (2.0 * unit).min(most);
    loop {
        let solution = basis.solution(problem, from, reach, progress)?;
        if let Some(solution) = &solution {
            let monotone = Monotone::of(&**solution, control);
            let stretches = &monotone.stretches;
            let last = stretches.iter().rposition(|stretch| stretch.rising && stretch.takes(value));
            // What lies further out is above the value: over a factor of two, or to where the gap ends.
            let outer = if reach < most { reach / ABOVE } else { reach * (1.0 - 1e-9) };
            let above = stretches.iter().all(|stretch| {
                let lowest = stretch.values[0].min(stretch.values[1]);
                let inside = stretch.radii[1] <= outer || Some(stretch) == last.map(|at| &stretches[at]);
                inside || lowest > value || stretch.radii[0] < outer && !stretch.takes(value)
            });
            // Where the curve still falls, it may reach the value further out.
            let ends = stretches.last().is_some_and(|stretch| stretch.rising && stretch.values[1] > value);
            let found = last.map(|at| {
                let place = monotone.solve(&**solution, &stretches[at], value);
                solution.radius(place)
            });
            let known = found.is_some() && reach >= most;
            if known || ends && above && found.is_none_or(|s| s <= outer) {
                let smallest =
                    stretches.iter().flat_map(|stretch| stretch.values).fold(f64::INFINITY, f64::min);
                return found.ok_or(StartError::OutOfReach { name, value, smallest });
            }
        }
        if reach >= most {
            let known = problem.gap.largest_radius().unwrap_or(most);
            return Err(StartError::NotKnown { name, value, searched: reach, known });
        }
        let panels = solution.map_or(usize::MAX, |solution| solution.len());
        if reach >= largest || panels > MOST_PANELS {
            return Err(StartError::NotReached { name, value, largest: reach });
        }
        reach = (2.0 * reach).min(most);
    }
}

/// The contact radius, a reduced length, at which a path of one disc ends that starts at `start`: the one that is
/// `given`, or else a fixed fraction of the start, or less where a smaller contact is still stable in fixed grips.
///
/// # Errors
/// [`Stopped`] if `progress` said stop.
pub fn end_contact_radius(
    problem: &Reduced,
    table: &Table,
    start: f64,
    given: Option<f64>,
    progress: &dyn Progress,
) -> Result<f64, Stopped> {
    /// Of the start.
    const SHARE: f64 = 0.004;
    /// Of the radius below which nothing is stable.
    const BELOW: f64 = 0.5;
    /// Radii at which it is asked first whether anything is: each a share of the one before.
    const ASKED: usize = 16;
    const STEP: f64 = 0.75;
    if let Some(end) = given {
        return Ok(end);
    }
    let usual = SHARE * start;
    let panels = match table.up_to_while(start, 0, progress) {
        Err(TableError::Stopped(stopped)) => return Err(stopped),
        // Whoever needs the gap up to the start says why it has no table.
        Err(_) => return Ok(usual),
        Ok(panels) => panels,
    };
    let exact = ExactSolution::new(panels, problem.work_of_adhesion);
    let asked = std::iter::successors(Some(usual), |s| Some(STEP * s)).take(ASKED);
    if !asked.filter_map(|s| exact.place(s)).any(|place| exact.at(place).slopes[0] > 0.0) {
        return Ok(usual);
    }
    let last = exact.place(usual).map_or(exact.len(), |place| place.panel + 1);
    let monotone = Monotone::on(&exact, Control::Displacement, 0..last);
    let rising = monotone.stretches.iter().find(|stretch| stretch.rising);
    // Without adhesion, the contact is stable until it vanishes.
    let unstable = rising.map_or(f64::INFINITY, |stretch| stretch.radii[0]);
    Ok(if unstable > 0.0 { usual.min(BELOW * unstable) } else { usual })
}
