//! A problem, and everything that is computed for it.

use crate::arrays::arrays_ready;
use crate::document::Document;
use crate::errors;
use crate::running::long;
use numpy::{PyArray1, PyReadonlyArray1};
use pulloff::store::file::{LARGEST, read_bytes, read_text};
use pulloff::store::{FILES, Overwrite, write_atomically};
use pulloff_engine::case::{Case, CaseError};
use pulloff_engine::disc::exact::FAR;
use pulloff_engine::disc::{Basis, ExactBasis, outside};
use pulloff_engine::gap::shapes::{MeasuredGap, ProfileGap, ProfileRows, Smoothing};
use pulloff_engine::gap::{Gap, Shape};
use pulloff_engine::measured::PointsFile;
use pulloff_engine::preset::measured::SHIPPED_DATA;
use pulloff_engine::preset::read::{HeldFiles, read_holding, read_in};
use pulloff_engine::preset::{Preset, Value, profile, shipped, write};
use pulloff_engine::problem::Control;
use pulloff_engine::problem::Turn;
use pulloff_engine::progress::Progress;
use pulloff_engine::quasistatic::Losses;
use pulloff_engine::report::map::Ordinate;
use pulloff_engine::report::path::Extent;
use pulloff_engine::report::pull::AskedPulls;
use pulloff_engine::report::{MapReport, PathReport, PullReport, StabilityReport, TraceReport};
use pulloff_engine::stability::{COMPLIANCE, MapAxis};
use pulloff_engine::text::{closest, quote, show_path};
use pulloff_engine::theory;
use pulloff_engine::units::Unit;
use pyo3::exceptions::PyOverflowError;
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyBytes, PyDict, PyFloat, PyInt, PyString};
use std::hash::{DefaultHasher, Hash, Hasher};
use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The names and titles of the presets that come with the package.
#[pyfunction]
pub fn presets(py: Python<'_>) -> PyResult<Bound<'_, PyDict>> {
    let all = PyDict::new(py);
    for preset in shipped::SHIPPED {
        all.set_item(preset.name, find(py, preset.name)?.title)?;
    }
    Ok(all)
}

/// The preset of this name that comes with the package.
fn find(py: Python<'_>, name: &str) -> PyResult<Preset> {
    let names = || shipped::SHIPPED.iter().map(|shipped| shipped.name);
    let Some(found) = shipped::find(name) else {
        let meant = closest(name, names()).map_or_else(
            || format!("there are {}", names().collect::<Vec<_>>().join(", ")),
            |meant| format!("did you mean {meant}?"),
        );
        return Err(errors::of_source(py, &format!("no preset is called \"{}\"; {meant}", quote(name))));
    };
    preset_of(py, None, found.name, found.text)
}

fn preset_of(py: Python<'_>, folder: Option<&Path>, name: &str, text: &str) -> PyResult<Preset> {
    read_in(FILES, folder, name, text, &[] as &[&str]).map_err(|error| errors::of_reading(py, &error))
}

/// The value of a key, as given in Python.
fn value(preset: &Preset, key: &str, given: &Bound<'_, PyAny>) -> PyResult<Value> {
    let py = given.py();
    let other = || {
        let kind = given.get_type().name().map_or_else(|_| "an object".to_owned(), |name| name.to_string());
        errors::of_type(
            py,
            key,
            &format!("{} must be a number or a string, not {}", quote(key), quote(&kind)),
        )
    };
    // Those of numpy would be converted to a number.
    let kind = given.getattr("dtype").and_then(|dtype| dtype.getattr("kind")?.extract::<String>());
    if given.is_instance_of::<PyBool>() || kind.is_ok_and(|kind| kind == "b" || kind == "c") {
        return Err(other());
    }
    if given.is_instance_of::<PyString>() {
        let text: String = given.extract()?;
        let Some(row) = preset.row(key) else { return Ok(Value::Text(text)) };
        return preset.read(&row, &text).map_err(|error| errors::of_value(py, &error));
    }
    if !given.is_instance_of::<PyFloat>()
        && (given.is_instance_of::<PyInt>() || given.hasattr("__index__")?)
        && let Ok(n) = given.extract::<i64>()
    {
        return Ok(Value::Integer(n));
    }
    let number = given.extract::<f64>().map(Value::Number);
    number.map_err(|error| {
        let is_large = error.is_instance_of::<PyOverflowError>(py);
        let text = format!("{} is out of range: it must be at most 1e30", quote(key));
        if is_large { errors::of_type(py, key, &text) } else { other() }
    })
}

/// `preset` with these changes, checked as a whole.
fn changed(mut preset: Preset, changes: Option<&Bound<'_, PyDict>>) -> PyResult<Preset> {
    let Some(changes) = changes.filter(|changes| !changes.is_empty()) else { return Ok(preset) };
    let py = changes.py();
    let mut values = Vec::new();
    for (key, given) in changes {
        let Ok(key) = key.extract::<String>() else {
            return Err(errors::of_source(
                py,
                "the keys of changes must be strings, such as \"gap.amplitude\"",
            ));
        };
        let given = value(&preset, &key, &given)?;
        values.push((key, given));
    }
    let laid = preset.set_all(values.iter().map(|(key, value)| (key.as_str(), value.clone())));
    laid.map_err(|error| errors::of_value(py, &error))?;
    Ok(preset)
}

type Array<'py> = Bound<'py, PyArray1<f64>>;

/// A profile as Python keeps it: name, folder, r, h, unit, notes.
type HeldRows<'py> = (String, Option<PathBuf>, Array<'py>, Array<'py>, Option<String>, Vec<String>);
/// A measured curve as Python keeps it: name, folder, bytes.
type HeldPoints<'py> = (String, Option<PathBuf>, Bound<'py, PyBytes>);
/// The whole state of a problem.
type State<'py> = (String, Option<HeldRows<'py>>, Option<HeldPoints<'py>>);

/// One problem, immutable.
#[pyclass(frozen, module = "pulloff._engine")]
pub struct Problem {
    pub preset: Preset,
}

#[pymethods]
impl Problem {
    /// A preset that comes with the package.
    #[staticmethod]
    fn shipped(py: Python<'_>, name: &str) -> PyResult<Self> {
        Ok(Self { preset: find(py, name)? })
    }

    /// The text of a preset; its files are relative to the current folder.
    #[staticmethod]
    fn of_text(py: Python<'_>, text: &str) -> PyResult<Self> {
        Ok(Self { preset: preset_of(py, None, "the text", text)? })
    }

    /// A preset file.
    #[staticmethod]
    fn of_file(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        let (text, _) =
            read_text(&path, LARGEST).map_err(|error| errors::of_source(py, &error.to_string()))?;
        Ok(Self { preset: preset_of(py, path.parent(), &path.to_string_lossy(), &text)? })
    }

    /// A preset from its text, whose profile has these rows in its own unit of length: in metres if it is `in_si`.
    #[staticmethod]
    fn of_rows(
        py: Python<'_>,
        text: &str,
        r: PyReadonlyArray1<'_, f64>,
        h: PyReadonlyArray1<'_, f64>,
        in_si: bool,
    ) -> PyResult<Self> {
        let rows = ProfileRows {
            name: "arrays".to_owned(),
            radii: r.as_slice()?.to_vec(),
            gaps: h.as_slice()?.to_vec(),
            unit: Unit::parse("m", 0).ok().filter(|_| in_si),
            ..ProfileRows::default()
        };
        let read =
            read_holding(FILES, "from_gap", text, HeldFiles { rows: Arc::new(rows), ..HeldFiles::default() });
        Ok(Self { preset: read.map_err(|error| errors::of_reading(py, &error))? })
    }

    /// Its whole state: the text of its preset, and the contents of the files that the text names.
    fn state<'py>(&self, py: Python<'py>) -> PyResult<State<'py>> {
        arrays_ready(py)?;
        let rows = match &self.preset.gap {
            Shape::Profile(measured) => Some(measured.rows()),
            _ => None,
        };
        let rows = rows.map(|rows| {
            let [radii, gaps] = [&rows.radii, &rows.gaps].map(|column| PyArray1::from_slice(py, column));
            let unit = rows.unit.as_ref().map(Unit::ascii);
            (rows.name.clone(), rows.folder.clone(), radii, gaps, unit, rows.notes.clone())
        });
        let points = self
            .preset
            .data
            .source
            .as_ref()
            .map(|source| (source.name.clone(), source.folder.clone(), PyBytes::new(py, &source.bytes)));
        Ok((write(&self.preset), rows, points))
    }

    /// The inverse of [`state`](Self::state): no file is read.
    #[staticmethod]
    #[expect(clippy::type_complexity, reason = "what Python keeps of a problem")]
    fn of_state(
        py: Python<'_>,
        text: &str,
        rows: Option<(
            String,
            Option<PathBuf>,
            PyReadonlyArray1<'_, f64>,
            PyReadonlyArray1<'_, f64>,
            Option<String>,
            Vec<String>,
        )>,
        points: Option<(String, Option<PathBuf>, Vec<u8>)>,
    ) -> PyResult<Self> {
        let mut held = HeldFiles::default();
        if let Some((name, folder, radii, gaps, unit, notes)) = rows {
            let (radii, gaps) = (radii.as_slice()?.to_vec(), gaps.as_slice()?.to_vec());
            let unit = unit.and_then(|unit| Unit::parse(&unit, 0).ok());
            held.rows = Arc::new(ProfileRows { name, folder, radii, gaps, unit, notes });
        }
        if let Some((name, folder, bytes)) = points {
            held.points = Arc::new(PointsFile::new(name, folder, bytes.into()));
        }
        let read = read_holding(FILES, "the text", text, held);
        Ok(Self { preset: read.map_err(|error| errors::of_reading(py, &error))? })
    }

    /// The same problem with its gap and its measured curve in files of these names; files that come with the package
    /// keep theirs.
    fn named(&self, rows: &str, points: &str) -> Self {
        let mut preset = self.preset.clone();
        if let Shape::Profile(measured) = &self.preset.gap
            && !measured.rows().name.starts_with(SHIPPED_DATA)
        {
            preset.gap = Shape::Profile(Arc::new(MeasuredGap::clone(measured).named(rows.to_owned())));
        }
        if let Some(source) = self.preset.data.source.as_ref().filter(|s| !s.name.starts_with(SHIPPED_DATA)) {
            preset.data.source = Some(Arc::new(source.named(points.to_owned(), None)));
        }
        Self { preset }
    }

    /// Whether it is the same problem: the same values and data, whatever files they came from.
    fn same(&self, other: &Bound<'_, Self>) -> bool {
        Content::of(&self.preset) == Content::of(&other.get().preset)
    }

    /// A hash that is equal for problems that are the same.
    fn digest(&self) -> u64 {
        let mut hasher = DefaultHasher::new();
        Content::of(&self.preset).hash(&mut hasher);
        hasher.finish()
    }

    /// The same problem with other values.
    fn replace(&self, changes: &Bound<'_, PyDict>) -> PyResult<Self> {
        Ok(Self { preset: changed(self.preset.clone(), Some(changes))? })
    }

    /// Its title.
    #[getter]
    fn title(&self) -> &str {
        &self.preset.title
    }

    /// Its values by their keys.
    fn values<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let all = PyDict::new(py);
        for (row, value) in self.preset.values() {
            match value {
                Value::Number(x) => all.set_item(&*row.key, x)?,
                Value::Integer(n) => all.set_item(&*row.key, n)?,
                Value::Control(Control::Stiffness(k)) => {
                    all.set_item(&*row.key, format!("stiffness={k:?}"))?;
                }
                other => all.set_item(&*row.key, other.to_string())?,
            }
        }
        Ok(all)
    }

    /// The equilibrium curve, with `theory` beside the exact solution.
    fn trace(&self, py: Python<'_>, theory: bool, progress: Option<Py<PyAny>>) -> PyResult<Document> {
        let made = long(py, progress, |progress| {
            let report = TraceReport::compute(&self.preset, progress)?;
            Ok(if theory { report.beside(&theory::Exact::of(&self.preset.problem())) } else { report })
        })?;
        made.map(Document::new).map_err(|error| errors::of_case(py, &error))
    }

    /// The unloading. Without `areas`, losses are by energy alone; without `admissibility`, admissibility is not
    /// checked.
    fn unload(
        &self,
        py: Python<'_>,
        areas: bool,
        admissibility: bool,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Document> {
        let losses = if areas { Losses::Twice } else { Losses::Once };
        let made = long(py, progress, |progress| {
            PathReport::unload(&self.preset, Extent { losses, admissibility }, progress)
        })?;
        made.map(Document::new).map_err(|error| errors::of_case(py, &error))
    }

    /// The loop of loading and unloading; it turns round at the control value `to_control`, if one is given.
    fn cycle(
        &self,
        py: Python<'_>,
        to_control: Option<f64>,
        areas: bool,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Document> {
        let losses = if areas { Losses::Twice } else { Losses::Once };
        let extent = Extent { losses, ..Extent::default() };
        let turn = to_control.map(Turn::Control);
        let made = long(py, progress, |progress| PathReport::cycle(&self.preset, turn, extent, progress))?;
        made.map(Document::new).map_err(|error| errors::of_case(py, &error))
    }

    /// Pulls at rates, and times to failure under dead loads.
    fn pull(
        &self,
        py: Python<'_>,
        rates: Vec<f64>,
        loads: Vec<f64>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Document> {
        let asked = AskedPulls { rates, loads };
        let made = long(py, progress, |progress| PullReport::compute(&self.preset, &asked, progress))?;
        made.map(Document::new).map_err(|error| errors::of_pull(py, &error))
    }

    /// The law of stability over the contact radius.
    fn stability(&self, py: Python<'_>, samples: usize, progress: Option<Py<PyAny>>) -> PyResult<Document> {
        let made = long(py, progress, |progress| StabilityReport::compute(&self.preset, samples, progress))?;
        made.map(Document::new).map_err(|error| errors::of_case(py, &error))
    }

    /// Where snaps begin, as lines in two numbers, or the limit points as functions of one.
    #[expect(clippy::too_many_arguments, reason = "the axes of a map as Python hands them over")]
    fn map(
        &self,
        py: Python<'_>,
        x: (String, f64, f64, bool),
        y: Option<(String, f64, f64, bool)>,
        ordinate: &str,
        columns: u32,
        rows: u32,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Document> {
        let x = self.axis(py, &x)?;
        let y = match (y, ordinate) {
            (Some(y), _) => Ordinate::Key(self.axis(py, &y)?),
            (None, "approach") => Ordinate::Approach,
            (None, "force") => Ordinate::Force,
            (None, _) => Ordinate::Control,
        };
        // How much of a map is done says nothing about how much is left.
        let made = long(py, progress, |progress| {
            MapReport::compute(&self.preset, x, &y, [columns, rows], progress)
        })?;
        made.map(Document::new).map_err(|error| errors::of_map(py, &error))
    }

    /// The approach, the pressure and the gap at the radii `r` in equilibrium at the contact radius `s`, by the exact
    /// solution. The pressure is minus infinity at an adhesive edge and NaN outside; the gap is 0 inside and NaN beyond
    /// the known part of the bodies.
    fn across<'py>(
        &self,
        py: Python<'py>,
        s: f64,
        r: PyReadonlyArray1<'py, f64>,
    ) -> PyResult<(f64, Array<'py>, Array<'py>)> {
        let radii = r.as_slice()?.to_vec();
        if !RADII.contains(&s) {
            let [lo, hi] = [RADII.start(), RADII.end()];
            let sentence =
                format!("s = {s:?} is out of range: a contact radius must be from {lo:?} to {hi:?}");
            return Err(errors::of_state(py, &sentence));
        }
        if let Some(wrong) = radii.iter().find(|r| !(**r >= 0.0 && r.is_finite())) {
            return Err(errors::of_state(
                py,
                &format!("r = {wrong} is out of range: a radius must be 0 or above"),
            ));
        }
        let state = long(py, None, |progress| Across::of(&self.preset, s, &radii, progress))?;
        let state = state.map_err(|error| errors::of_case(py, &error))?;
        let Some(state) = state else {
            let sentence = format!(
                "there is no equilibrium at the contact radius {s}: the gap is not known that far out"
            );
            return Err(errors::of_state(py, &sentence));
        };
        arrays_ready(py)?;
        let array = |values| PyArray1::from_vec(py, values);
        Ok((state.approach, array(state.pressure), array(state.gap)))
    }
}

impl Problem {
    /// An axis of a map: a number of the preset, a group, or the compliance of the device.
    fn axis(&self, py: Python<'_>, (key, from, to, log): &(String, f64, f64, bool)) -> PyResult<MapAxis> {
        let is_number = self.preset.row(key).is_some_and(|row| row.kind.is_number());
        if key != COMPLIANCE && !is_number {
            let sentence = match self.preset.clone().set(key, 1.0.into()) {
                Err(invalid) => invalid.to_string(),
                Ok(()) => {
                    format!("{}: an axis must be a number of the preset, a group, or compliance", quote(key))
                }
            };
            return Err(errors::of_axis(py, &sentence));
        }
        let unit = self.preset.gap.length().unwrap_or(1.0) * self.preset.material.effective_modulus;
        MapAxis::new(key, [*from, *to], *log, 1.0 / unit)
            .map_err(|error| errors::of_axis(py, &error.to_string()))
    }
}

/// The smooth curve through the samples (r, h), as the engine constructs it, at the radii `at`.
#[pyfunction]
pub fn between(
    r: PyReadonlyArray1<'_, f64>,
    h: PyReadonlyArray1<'_, f64>,
    at: PyReadonlyArray1<'_, f64>,
) -> PyResult<Vec<f64>> {
    let profile = ProfileGap::new(r.as_slice()?, h.as_slice()?, Smoothing::None)
        .map_err(|error| pyo3::exceptions::PyValueError::new_err(error.to_string()))?;
    Ok(at.as_slice()?.iter().map(|r| profile.jet(*r).value).collect())
}

/// Writes whole files, given by their paths, in this order: either all, or none if one exists already and must not be
/// replaced.
#[pyfunction]
pub fn write_files(py: Python<'_>, files: &Bound<'_, PyDict>, overwrite: bool) -> PyResult<()> {
    let mut all: Vec<(PathBuf, Vec<u8>)> = Vec::new();
    for (path, content) in files {
        all.push((path.extract()?, content.extract()?));
    }
    if let Some((path, _)) = all.iter().find(|(path, _)| !overwrite && path.symlink_metadata().is_ok()) {
        let sentence = format!("{}: already exists; overwrite=True replaces it", show_path(path));
        return Err(errors::of_output(py, &sentence));
    }
    let overwrite = if overwrite { Overwrite::Always } else { Overwrite::Never };
    for (path, content) in &all {
        write_atomically(path, content, overwrite)
            .map_err(|error| errors::of_output(py, &error.to_string()))?;
    }
    Ok(())
}

/// The content of a regular file of bounded size: a measured curve, or a spec.
#[pyfunction]
pub fn read_file(py: Python<'_>, path: PathBuf) -> PyResult<Bound<'_, PyBytes>> {
    let read =
        read_bytes(&path, profile::LARGEST).map_err(|error| errors::of_data(py, &error.to_string()))?;
    Ok(PyBytes::new(py, &read.0))
}

/// What makes two problems the same: the text of the preset without file names, and the contents of the files.
#[derive(PartialEq, Eq, Hash)]
struct Content {
    text: String,
    rows: Vec<u64>,
    points: Arc<[u8]>,
}

impl Content {
    fn of(preset: &Preset) -> Self {
        let (mut unnamed, mut rows, mut points) = (preset.clone(), Vec::new(), Arc::from([]));
        if let Shape::Profile(measured) = &preset.gap {
            let held = measured.rows();
            rows.extend(held.radii.iter().chain(&held.gaps).map(|x| x.to_bits()));
            unnamed.gap = Shape::Profile(Arc::new(MeasuredGap::clone(measured).named("rows".to_owned())));
        }
        if let Some(source) = &preset.data.source {
            points = Arc::clone(&source.bytes);
            unnamed.data.source = Some(Arc::new(source.named("points".to_owned(), None)));
        }
        Self { text: write(&unnamed), rows, points }
    }
}

/// The contact radii for which states may be asked: those that a preset accepts.
const RADII: RangeInclusive<f64> = 1e-30..=1e30;

/// A radius within this share of the edge counts as the edge: fractions of it are rounded, as those of `numpy.linspace`
/// are.
const AT_EDGE: f64 = 8.0 * f64::EPSILON;
/// The radii that are computed between two looks at whether to stop.
const AT_ONCE: usize = 64;

/// A state across the radius, in the units of the preset.
struct Across {
    approach: f64,
    pressure: Vec<f64>,
    gap: Vec<f64>,
}

impl Across {
    fn of(
        preset: &Preset,
        s: f64,
        radii: &[f64],
        progress: &dyn Progress,
    ) -> Result<Option<Self>, CaseError> {
        let case = Case::prepare(preset, progress)?;
        let units = case.units();
        let s = s / units.length;
        // A large contact takes long: here it can be stopped.
        case.panels_to(s, progress)?;
        let exact = ExactBasis::new(Arc::clone(&case.table), s);
        let Some(at) = exact.equilibrium(&case.reduced, s) else { return Ok(None) };
        let delta = at.approach;
        let Ok(panels) = case.table.up_to(s) else { return Ok(None) };
        let reduced: Vec<f64> = radii.iter().map(|r| r / units.length).collect();
        let stress = units.force / (units.length * units.length);
        let is_adhesive = case.reduced.work_of_adhesion > 0.0;
        let pressure = |r: &f64| {
            if (r - s).abs() <= AT_EDGE * s {
                if is_adhesive { f64::NEG_INFINITY } else { 0.0 }
            } else if *r < s {
                outside::pressure(&panels, s, delta, *r) * stress
            } else {
                f64::NAN
            }
        };
        let mut across = Self { approach: delta * units.length, pressure: Vec::new(), gap: Vec::new() };
        // Many radii take long, too.
        for radii in reduced.chunks(AT_ONCE) {
            if progress.stop() {
                return Ok(None);
            }
            // Together with the farthest radius that the table is asked for, so that no gap depends on the other radii.
            let outer: Vec<f64> = radii.iter().map(|r| r.max(s)).chain([FAR * s]).collect();
            let opened = exact.gap_outside(&case.reduced, s, delta, &outer);
            let gap = radii.iter().zip(opened).map(|(r, gap)| if *r < s { 0.0 } else { gap * units.length });
            across.pressure.extend(radii.iter().map(pressure));
            across.gap.extend(gap);
        }
        Ok(Some(across))
    }
}
