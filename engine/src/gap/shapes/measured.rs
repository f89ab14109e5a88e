//! A measured profile together with the file it came from.

use super::profile::{InvalidProfile, ProfileGap, Smoothing};
use crate::units::{Quantity, Unit, UnitSystem};
use std::path::PathBuf;
use std::sync::Arc;

/// The prefix of the names of data that come with the program.
pub const SHIPPED_DATA: &str = "shipped:";

/// The rows of a file, in one unit of length. Two are equal when the names and the rows are.
#[derive(Debug, Clone, Default)]
pub struct ProfileRows {
    /// The file name as the user wrote it.
    pub name: String,
    /// The folder that a relative `name` starts from.
    pub folder: Option<PathBuf>,
    /// r, ascending.
    pub radii: Vec<f64>,
    /// h.
    pub gaps: Vec<f64>,
    /// The unit of both, where the file names one.
    pub unit: Option<Unit>,
    /// What was corrected, in words.
    pub notes: Vec<String>,
}

impl ProfileRows {
    /// Whether the rows come with the program.
    pub fn is_shipped(&self) -> bool {
        self.name.starts_with(SHIPPED_DATA)
    }

    /// Where the file is.
    pub fn path(&self) -> PathBuf {
        self.folder.as_ref().map_or_else(|| PathBuf::from(&self.name), |folder| folder.join(&self.name))
    }

    /// The rows as a preset in these units holds them: in SI, in metres. Rows without a unit are taken to be in metres,
    /// with a note.
    pub fn held_in(self: Arc<Self>, units: &UnitSystem) -> Arc<Self> {
        if *units == UnitSystem::Reduced {
            return self;
        }
        let metre = Unit::parse("m", 0).ok();
        if self.unit.is_some() && self.unit == metre {
            return self;
        }
        let length = |unit: &&Unit| unit.dimension() == Quantity::Length.dimension();
        let unit = self.unit.as_ref().filter(length);
        let scaled = |column: &[f64]| column.iter().map(|x| unit.map_or(*x, |unit| unit.to_si(*x))).collect();
        let mut notes = self.notes.clone();
        if unit.is_none() {
            notes.push(format!(
                "{}: names no unit of length, so its columns are taken to be in m; a header such as r [um], \
                 h [nm] names units",
                self.name
            ));
        }
        Arc::new(Self {
            radii: scaled(&self.radii),
            gaps: scaled(&self.gaps),
            unit: metre,
            name: self.name.clone(),
            folder: self.folder.clone(),
            notes,
        })
    }
}

impl PartialEq for ProfileRows {
    fn eq(&self, other: &Self) -> bool {
        (&self.name, &self.radii, &self.gaps, &self.unit)
            == (&other.name, &other.radii, &other.gaps, &other.unit)
    }
}

/// A measured profile as a gap, with its rows. Two are equal when what the user sees is equal: the name, the rows, the
/// smoothing.
#[derive(Debug, Clone)]
pub struct MeasuredGap {
    rows: Arc<ProfileRows>,
    smoothing: Smoothing,
    profile: ProfileGap,
}

impl MeasuredGap {
    /// The gap of `rows`.
    ///
    /// # Errors
    /// [`InvalidProfile`].
    pub fn new(rows: Arc<ProfileRows>, smoothing: Smoothing) -> Result<Self, InvalidProfile> {
        let profile = ProfileGap::new(&rows.radii, &rows.gaps, smoothing)?;
        Ok(Self { rows, smoothing, profile })
    }

    /// The same gap with the file named `name`.
    #[must_use]
    pub fn named(self, name: String) -> Self {
        Self { rows: Arc::new(ProfileRows { name, ..ProfileRows::clone(&self.rows) }), ..self }
    }

    /// The rows.
    pub fn rows(&self) -> &Arc<ProfileRows> {
        &self.rows
    }

    /// The smoothing as chosen.
    pub fn smoothing(&self) -> Smoothing {
        self.smoothing
    }

    /// The curve through the rows.
    pub fn profile(&self) -> &ProfileGap {
        &self.profile
    }

    /// The curve through the same rows in half as many cells. Events that differ on it are decided by the cells and not
    /// by the gap. None where every row is a knot.
    pub fn coarser(&self) -> Option<ProfileGap> {
        self.profile.coarser(&self.rows.radii, &self.rows.gaps)
    }
}

impl PartialEq for MeasuredGap {
    fn eq(&self, other: &Self) -> bool {
        // The curve follows from the rows and the smoothing; shared rows need no comparison.
        self.smoothing == other.smoothing && (Arc::ptr_eq(&self.rows, &other.rows) || self.rows == other.rows)
    }
}
