//! The file of a measured curve as a preset holds it: its bytes, parsed once for each way of reading them.

use super::asked::{Asked, FreePart};
use super::branches::Branches;
use super::points::Points;
use super::read::{Measured, parse};
use super::role::ColumnSpec;
use crate::units::UnitSystem;
use std::fmt;
use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};

/// How the points of a file are obtained.
#[derive(Debug, Clone, PartialEq)]
pub struct Reading {
    /// What the user says about the columns; empty leaves it to the header.
    pub columns: String,
    /// The units of the problem.
    pub units: UnitSystem,
    /// The stiffness of its device, if that is a spring, in base units.
    pub spring: Option<f64>,
    /// Which points are used.
    pub asked: Asked,
}

/// A file of measured points. Two are equal when the names and the bytes are.
pub struct PointsFile {
    /// The file name as the user wrote it.
    pub name: String,
    /// The folder that a relative `name` starts from.
    pub folder: Option<PathBuf>,
    /// The whole content.
    pub bytes: Arc<[u8]>,
    columns: Mutex<Option<(String, Arc<Measured>)>>,
    branches: Mutex<Option<(Reading, Arc<Branches>)>>,
}

impl PointsFile {
    /// The file `name`, relative to `folder`, that holds `bytes`.
    #[must_use]
    pub fn new(name: String, folder: Option<PathBuf>, bytes: Arc<[u8]>) -> Self {
        Self { name, folder, bytes, columns: Mutex::default(), branches: Mutex::default() }
    }

    /// The same points from a file named `name`.
    #[must_use]
    pub fn named(&self, name: String, folder: Option<PathBuf>) -> Self {
        Self::new(name, folder, Arc::clone(&self.bytes))
    }

    /// Where the file is.
    pub fn path(&self) -> PathBuf {
        self.folder.as_ref().map_or_else(|| PathBuf::from(&self.name), |folder| folder.join(&self.name))
    }

    /// Its columns, as `columns` specifies or as its header says.
    ///
    /// # Errors
    /// What is wrong with `columns` or with the file, in words.
    pub fn measured(&self, columns: &str) -> Result<Arc<Measured>, String> {
        let mut last = self.columns.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, measured)) = last.as_ref().filter(|(of, _)| of == columns) {
            return Ok(Arc::clone(measured));
        }
        let spec = ColumnSpec::parse(columns).map_err(|error| error.to_string())?;
        let measured = Arc::new(parse(&self.bytes, &spec).map_err(|error| error.to_string())?);
        *last = Some((columns.to_owned(), Arc::clone(&measured)));
        Ok(measured)
    }

    /// Its points in the units of a problem, in the order of the file.
    ///
    /// # Errors
    /// As [`measured`](Self::measured) and [`Measured::points`].
    pub fn points(&self, reading: &Reading) -> Result<Points, String> {
        let measured = self.measured(&reading.columns)?;
        measured.points(&reading.units, reading.spring).map_err(|error| error.to_string())
    }

    /// What is requested of the points. For a curve that this program computed, more is known: its signs, and that no
    /// row is apart whose force would be the zero of all others.
    ///
    /// # Errors
    /// As [`measured`](Self::measured).
    pub fn asked(&self, reading: &Reading) -> Result<Asked, String> {
        let said = reading.asked;
        if !self.measured(&reading.columns)?.is_computed {
            return Ok(said);
        }
        let free = if said.free == FreePart::Found { FreePart::None } else { said.free };
        Ok(Asked { free, turned: said.turned.or(Some([false; 2])), ..said })
    }

    /// The branches of its points.
    ///
    /// # Errors
    /// As [`points`](Self::points) and [`Points::branches`].
    pub fn branches(&self, reading: &Reading) -> Result<Arc<Branches>, String> {
        let mut last = self.branches.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, branches)) = last.as_ref().filter(|(of, _)| of == reading) {
            return Ok(Arc::clone(branches));
        }
        let points = self.points(reading)?;
        let asked = self.asked(reading)?;
        let branches = Arc::new(points.branches(&asked).map_err(|error| error.to_string())?);
        *last = Some((reading.clone(), Arc::clone(&branches)));
        Ok(branches)
    }
}

impl PointsFile {
    /// Whether it has the same content, whatever its name.
    pub fn has_bytes_of(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.bytes, &other.bytes) || self.bytes == other.bytes
    }
}

impl PartialEq for PointsFile {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name && self.has_bytes_of(other)
    }
}

impl fmt::Debug for PointsFile {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { name, folder, bytes, .. } = self;
        write!(f, "Source {{ name: {name:?}, folder: {folder:?}, {} bytes }}", bytes.len())
    }
}
