//! Columns → points in SI or reduced units.

use super::read::{Column, Measured};
use super::role::{ColumnRole, Segment};
use super::stated::StatedValue;
use crate::problem::Control;
use crate::units::{Quantity, UnitSystem, number::said};
use thiserror::Error;

/// What x is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Abscissa {
    /// The approach δ.
    Approach,
    /// The position Δ = δ + P/k of the far end of a spring.
    Position,
    /// The contact radius s.
    Radius,
}

impl Abscissa {
    /// Its name in results.
    pub fn name(self) -> &'static str {
        match self {
            Self::Approach => "approach",
            Self::Position => "position",
            Self::Radius => "contact radius",
        }
    }
}

/// One point, with its signs corrected.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeasuredPoint {
    /// x.
    pub x: f64,
    /// P.
    pub force: f64,
    /// s, where it is measured besides x; NaN otherwise.
    pub radius: f64,
    /// When it was measured; NaN if unknown.
    pub time: f64,
    /// The row of the file, from 1, header not counted.
    pub row: usize,
    /// Its place in the order of measurement, from 1: the order of the file, unless the times show another.
    pub at: usize,
}

/// Whether the signs of x and of P are reversed.
pub type Turned = [bool; 2];

/// What lies between the model and the instrument: the x at which the approach is zero, the force reading of no force,
/// and its slope over x.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Instrument {
    /// δ₀.
    pub offset: f64,
    /// P₀.
    pub baseline: f64,
    /// Its slope.
    pub tilt: f64,
}

impl Instrument {
    /// The factors of offset, baseline and tilt by which numbers of the file become those of its points, and back.
    pub fn signs([x, force]: Turned) -> [f64; 3] {
        let [x, force] = [x, force].map(|turned| if turned { -1.0 } else { 1.0 });
        [x, force, x * force]
    }

    /// The numbers of the file in those of its points, or back.
    #[must_use]
    pub fn turned(self, turned: Turned) -> Self {
        let [x, force, tilt] = Self::signs(turned);
        Self { offset: x * self.offset, baseline: force * self.baseline, tilt: tilt * self.tilt }
    }
}

/// Reverses the signs of x and P.
pub(super) fn turn(points: &mut [MeasuredPoint], [x, force]: Turned) {
    for point in points {
        point.x = if x { -point.x } else { point.x };
        point.force = if force { -point.force } else { point.force };
    }
}

/// The points of a file, in its order; lengths and forces in SI or reduced units, signs as in the file.
#[derive(Debug, Clone, PartialEq)]
pub struct Points {
    /// What x is.
    pub abscissa: Abscissa,
    /// x.
    pub x: Vec<f64>,
    /// P.
    pub force: Vec<f64>,
    /// s, where it is measured besides δ or Δ.
    pub radius: Option<Vec<f64>>,
    /// The place of the last digit of x, of P and of s.
    pub steps: [f64; 3],
    /// The branch of each, where the file says it.
    pub segments: Option<Vec<Segment>>,
    /// When each was measured, in seconds or in reduced units; `None` if the file does not say.
    pub time: Option<Vec<f64>>,
    /// Whether the user, or units in the header, say which columns they are, which nothing in them refutes.
    pub is_said: bool,
    /// How many rows of the file are left out, since a column that is used has no number there.
    pub skipped: usize,
}

/// Why columns yield no points.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum PointsError {
    /// Units in a problem without units.
    #[error(
        "{}the {role} has a unit, {unit}, and the problem is in reduced units, where columns are pure \
         numbers: remove the unit, or take a preset with units = \"SI\", such as lens",
        header.map_or_else(String::new, |line| format!("line {line}: "))
    )]
    Reduced {
        /// The line of the header.
        header: Option<usize>,
        /// Which column.
        role: &'static str,
        /// Its unit.
        unit: String,
    },
    /// A file that states its instrument in SI, in a problem without units.
    #[error(
        "the file states {what}, and the problem is in reduced units: set units = \"SI\", or data.settings = \
         \"preset\" to ignore the file's"
    )]
    ReducedSetting {
        /// What it states, safe to show.
        what: String,
    },
    /// Two stiffnesses, or two tip radii, that differ.
    #[error(
        "the file states {what} of {file}, and {key} is {preset}: set {key} to the value in the file, or \
         data.settings = \"preset\" if the file's is wrong, or data.file = none to remove the file"
    )]
    Contradicts {
        /// What is stated.
        what: &'static str,
        /// The key of the preset.
        key: &'static str,
        /// The file's, safe to show.
        file: String,
        /// The preset's, safe to show.
        preset: String,
    },
    /// A deflection or a position without a spring.
    #[error(
        "the {0} needs the stiffness of the spring: set path.control.stiffness; if the device is rigid, the column is the \
         approach: --columns or data.columns says so, as \"approach=\" with its number or name"
    )]
    NoSpring(&'static str),
    /// A column that does not vary.
    #[error("the {0} is the same in all rows")]
    Constant(&'static str),
}

/// Something a file may state about its instrument: in words, the preset key for the same thing, and its quantity.
pub type Statement = (&'static str, &'static str, Quantity);

/// The stiffness of the spring.
pub const SPRING: Statement = ("a spring", "path.control.stiffness", Quantity::ForcePerLength);
/// The radius of the tip.
pub const TIP: Statement = ("a tip radius", "gap.radius_of_curvature", Quantity::Length);

/// What a file states and a preset omits or contradicts, in words; `None` where they agree.
pub fn overridden(
    stated: Option<StatedValue>,
    preset: Option<f64>,
    units: &UnitSystem,
    statement: Statement,
) -> Option<String> {
    let (what, key, quantity) = statement;
    match compare(stated, preset, units, statement) {
        Ok(()) => {
            let value = stated.filter(|_| preset.is_none())?.value;
            Some(format!("{what} of {}, which the file states,", said(units, quantity, value)))
        }
        Err(PointsError::Contradicts { file, preset, .. }) => {
            Some(format!("{what} of {file}, which the file states where {key} is {preset},"))
        }
        Err(PointsError::ReducedSetting { what }) => Some(format!("{what}, which the file states,")),
        Err(_) => None,
    }
}

/// Compares what a file states with what a preset says, in base units, where both give a value.
fn compare(
    stated: Option<StatedValue>,
    preset: Option<f64>,
    units: &UnitSystem,
    (what, key, quantity): Statement,
) -> Result<(), PointsError> {
    let Some(stated) = stated else { return Ok(()) };
    if *units == UnitSystem::Reduced {
        let unit = quantity.si().unwrap_or_default();
        return Err(PointsError::ReducedSetting { what: format!("{what} of {:?} {unit}", stated.value) });
    }
    match preset {
        Some(preset) if !stated.is(preset) => {
            let shown = |value| said(units, quantity, value);
            Err(PointsError::Contradicts { what, key, file: shown(stated.value), preset: shown(preset) })
        }
        _ => Ok(()),
    }
}

/// The stiffness of the device, if the preset or the file states one, in the preset's base units.
///
/// # Errors
/// [`PointsError`] if both state one and they differ, or if the problem has no units.
pub fn stiffness(
    file: Option<StatedValue>,
    control: Control,
    units: &UnitSystem,
) -> Result<Option<f64>, PointsError> {
    let preset = if let Control::Stiffness(k) = control { Some(k) } else { None };
    compare(file, preset, units, SPRING)?;
    Ok(preset.or(file.map(|stated| stated.value)))
}

/// Compares the tip radius that a file states with that of the gap.
///
/// # Errors
/// [`PointsError`] if both are given and differ, or if the problem has no units.
pub fn tip_radius(
    file: Option<StatedValue>,
    gap: Option<f64>,
    units: &UnitSystem,
) -> Result<(), PointsError> {
    compare(file, gap, units, TIP)
}

impl Measured {
    /// Whether a problem in `units` can take the columns as they are.
    ///
    /// # Errors
    /// [`PointsError::Reduced`].
    pub fn check_units(&self, units: &UnitSystem) -> Result<(), PointsError> {
        // A time is left out if it has a unit and the problem has none.
        let columns = self.columns.iter().filter(|column| column.role != ColumnRole::Time);
        let named = columns.into_iter().find_map(|column| Some((column, column.unit.as_ref()?)));
        match named {
            Some((column, unit)) if *units == UnitSystem::Reduced => Err(PointsError::Reduced {
                header: self.header,
                role: column.role.word(),
                unit: unit.ascii(),
            }),
            _ => Ok(()),
        }
    }

    /// The points of a problem in `units` whose device has the stiffness `spring`, in base units.
    ///
    /// If there are an approach and a position, the approach is used; if there are a force and a deflection, the force.
    ///
    /// # Errors
    /// [`PointsError`].
    pub fn points(&self, units: &UnitSystem, spring: Option<f64>) -> Result<Points, PointsError> {
        self.check_units(units)?;
        let column = |role| self.columns.iter().find(|column| column.role == role);
        let (abscissa, x) = [
            (Abscissa::Approach, ColumnRole::Approach),
            (Abscissa::Position, ColumnRole::Position),
            (Abscissa::Radius, ColumnRole::Radius),
        ]
        .into_iter()
        .find_map(|(abscissa, role)| Some((abscissa, column(role)?)))
        .ok_or(PointsError::Constant("x"))?;
        if abscissa == Abscissa::Position && spring.is_none() {
            return Err(PointsError::NoSpring("position"));
        }
        let (x, x_step) = base(x);
        let (force, force_step) = match (column(ColumnRole::Force), column(ColumnRole::Deflection)) {
            (Some(force), _) => base(force),
            (None, Some(deflection)) => {
                let k = spring.ok_or(PointsError::NoSpring("deflection"))?;
                let (values, step) = base(deflection);
                (values.into_iter().map(|d| k * d).collect(), k * step)
            }
            (None, None) => return Err(PointsError::Constant("force")),
        };
        let radius = column(ColumnRole::Radius).map(base);
        for (values, what) in [(&x, abscissa.name()), (&force, "force")] {
            if values.iter().all(|value| value.total_cmp(&values[0]).is_eq()) {
                return Err(PointsError::Constant(what));
            }
        }
        let radius = radius.filter(|_| abscissa != Abscissa::Radius);
        let steps = [x_step, force_step, radius.as_ref().map_or(0.0, |(_, step)| *step)];
        let radius = radius.map(|(values, _)| values);
        let time =
            column(ColumnRole::Time).filter(|time| *units != UnitSystem::Reduced || time.unit.is_none());
        let time = time.map(|time| base(time).0);
        // A unit in the header has told a force from a length.
        let have_units = self.columns.iter().all(|column| column.unit.is_some());
        let (segments, is_said) = (self.segments.clone(), self.is_said || have_units);
        Ok(Points { abscissa, x, force, radius, steps, segments, time, is_said, skipped: self.skipped })
    }
}

/// The values of a column and its step in base units.
fn base(column: &Column) -> (Vec<f64>, f64) {
    match &column.unit {
        None => (column.values.clone(), column.step),
        Some(unit) => (column.values.iter().map(|x| unit.to_si(*x)).collect(), unit.to_si(column.step)),
    }
}
