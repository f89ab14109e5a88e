//! The preset: a problem, the basis it is solved in, and the path to follow.
//!
//! | file | what lives there |
//! |---|---|
//! | `keys` | the preset read by dotted key: its values and its rows |
//! | `change` | the preset changed by dotted key |

mod change;
mod keys;

pub(super) use change::put;
pub use keys::is_of_units;
pub(super) use keys::unknown_key;

use super::data::DataSpec;
use super::edge::EdgeSpec;
use super::measured::{self, Files};
use super::schema::{START_KEYS, TURN_KEYS};
use crate::gap::Shape;
use crate::gap::shapes::MeasuredGap;
use crate::problem::Turn;
use crate::problem::{Adhesion, Begin, Cohesion, ContactKind, Control, Problem, Reduced, Start};
use crate::ritz::Grading;
use crate::units::UnitSystem;
use std::path::Path;
use std::sync::Arc;

/// What a preset file says, complete and checked.
#[derive(Debug, Clone, PartialEq)]
pub struct Preset {
    /// One line that says what the preset shows.
    pub title: String,
    /// The units in which it is typed and shown; every number in it is in SI or in reduced units.
    pub units: UnitSystem,
    /// The bodies.
    pub material: Material,
    /// The gap between the undeformed bodies.
    pub gap: Shape,
    /// How the contact pressure is sought.
    pub basis: BasisSpec,
    /// Where to start, what to control, where to end.
    pub path: PathSpec,
    /// How an edge moves, and at which rate it is pulled.
    pub edge: EdgeSpec,
    /// A measured curve that belongs to it.
    pub data: DataSpec,
    /// Where the rows of another profile would come from.
    pub files: Files,
}

/// The bodies and their adhesion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Material {
    /// E*, a stress.
    pub effective_modulus: f64,
    /// γ, the work of adhesion, a stress times a length.
    pub work_of_adhesion: f64,
    /// z₀, the range of action of the adhesion, a length; `None` leaves it to [`Preset::range_of_action`].
    pub range_of_action: Option<f64>,
    /// How the adhesion acts across the gap.
    pub adhesion: Adhesion,
}

/// z₀ in metres if an SI preset does not give it: a few atoms.
const RANGE_OF_ACTION: f64 = 0.3e-9;

/// The basis of the contact pressure.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BasisSpec {
    /// Ring elements of constant pressure.
    Rings {
        /// Their number N, from 4 to 2000; with edge grading to 400.
        rings: usize,
        /// How they are spaced.
        grading: Grading,
    },
    /// No elements: exact for any gap, to rounding.
    Exact,
}

/// The path through the equilibrium states.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PathSpec {
    /// What the loading device prescribes.
    pub control: Control,
    /// The state at which the path starts.
    pub start: Start,
    /// The contact radius at which the path ends; `None` leaves it to follow the start and the last stable contact
    /// (see [`end_contact_radius`](crate::quasistatic::start::end_contact_radius)).
    pub end_contact_radius: Option<f64>,
    /// Where a walk by hand begins.
    pub begin: Begin,
    /// Which contacts a path follows.
    pub contact: ContactKind,
    /// Where a loop turns round; `None` leaves it to the contact radius at the start of the unloading.
    pub turn: Option<Turn>,
}

/// The key that gives a start.
pub fn start_key(start: Start) -> &'static str {
    match start {
        Start::ContactRadius(_) => START_KEYS[0],
        Start::Approach(_) => START_KEYS[1],
        Start::Force(_) => START_KEYS[2],
    }
}

/// The key that gives a turn; a control value has none.
pub fn turn_key(turn: Turn) -> Option<&'static str> {
    match turn {
        Turn::Approach(_) => Some(TURN_KEYS[0]),
        Turn::Force(_) => Some(TURN_KEYS[1]),
        Turn::Radius(_) => Some(TURN_KEYS[2]),
        Turn::Control(_) => None,
    }
}

impl Preset {
    /// A problem made in code, in any consistent units: the exact basis, displacement control, and for everything else
    /// what a file without the key would mean. [`Preset::check`] says what is wrong with its values.
    #[must_use]
    pub fn new(material: Material, gap: Shape, start: Start) -> Self {
        Self {
            title: String::new(),
            units: UnitSystem::Reduced,
            material,
            gap,
            basis: BasisSpec::Exact,
            path: PathSpec {
                start,
                control: Control::Displacement,
                end_contact_radius: None,
                begin: Begin::Disc,
                contact: ContactKind::Rings,
                turn: None,
            },
            edge: EdgeSpec::default(),
            data: DataSpec::default(),
            files: Files::NONE,
        }
    }

    /// The contact problem of this preset.
    pub fn problem(&self) -> Problem {
        Problem {
            effective_modulus: self.material.effective_modulus,
            work_of_adhesion: self.material.work_of_adhesion,
            shape: self.gap.clone(),
        }
    }

    /// The same in reduced units. A gap without a length of its own is reduced by the contact radius at the start, if
    /// that is given.
    pub fn reduced(&self) -> Reduced {
        let problem = self.problem();
        match (self.gap.length(), self.path.start) {
            (None, Start::ContactRadius(start)) => problem.reduced_by(start),
            _ => problem.reduced(),
        }
    }

    /// z₀, the range of action of the adhesion: the value in the preset, otherwise 0.3 nm in SI and none in reduced
    /// units.
    pub fn range_of_action(&self) -> Option<f64> {
        let usual = matches!(self.units, UnitSystem::Si(_)).then_some(RANGE_OF_ACTION);
        self.material.range_of_action.or(usual)
    }

    /// The largest slope of the gap within the disc that the path starts from, if it is not small beside 1.
    pub fn steep_slope(&self) -> Option<f64> {
        match self.path.start {
            Start::ContactRadius(start) => self.gap.steep_slope(start),
            _ => None,
        }
    }

    /// The tension and the range of the adhesion, if it has a range.
    pub fn cohesion(&self) -> Option<Cohesion> {
        self.material.adhesion.cohesion(self.material.work_of_adhesion, self.range_of_action())
    }

    /// The same preset for a file in `folder`: the file names of its profile and of its measured curve become relative
    /// to it if they lie in it or below it, otherwise absolute.
    #[must_use]
    pub fn placed_in(&self, folder: &Path) -> Self {
        self.renamed(|own, name| moved(own, name, folder))
    }

    /// The same preset with absolute names for the files relative to the current folder, so that it means the same files
    /// from any other.
    #[must_use]
    pub fn anywhere(&self) -> Self {
        self.renamed(|own, name| {
            let is_absolute = name.starts_with(measured::SHIPPED_DATA) || Path::new(name).is_absolute();
            let path = std::path::absolute(name).ok().filter(|_| own.is_none() && !is_absolute)?;
            path.to_str().map(str::to_owned)
        })
    }

    /// The same preset with its files under the names that `name` makes of their folders and names; `None` keeps one.
    fn renamed(&self, name: impl Fn(Option<&Path>, &str) -> Option<String>) -> Self {
        let mut preset = self.clone();
        if let Shape::Profile(measured) = &self.gap {
            let rows = measured.rows();
            if let Some(name) = name(rows.folder.as_deref(), &rows.name) {
                preset.gap = Shape::Profile(Arc::new(MeasuredGap::clone(measured).named(name)));
            }
        }
        if let Some(source) = &self.data.source
            && let Some(name) = name(source.folder.as_deref(), &source.name)
        {
            preset.data.source = Some(Arc::new(source.named(name, source.folder.clone())));
        }
        preset
    }
}

/// The new name, for a preset in `folder`, of the file `name` relative to `own`; `None` if it stays.
fn moved(own: Option<&Path>, name: &str, folder: &Path) -> Option<String> {
    let own = own.unwrap_or(Path::new("."));
    let is_same = std::path::absolute(own).ok() == std::path::absolute(folder).ok();
    if name.starts_with(measured::SHIPPED_DATA) || (is_same && Path::new(name).is_relative()) {
        return None;
    }
    let path = std::path::absolute(own.join(name)).ok()?;
    let name = path.strip_prefix(std::path::absolute(folder).ok()?).unwrap_or(&path).to_str()?;
    (!name.starts_with(measured::SHIPPED_DATA)).then(|| name.to_owned())
}

#[cfg(test)]
mod tests;
