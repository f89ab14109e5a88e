//! What the axes of a map show: two numbers, or one number and a quantity of limit points.

use super::script::key_called;
use pulloff_engine::gap::Gap;
use pulloff_engine::preset::schema::Kind;
use pulloff_engine::preset::{Key, Parameter, Preset};
use pulloff_engine::report::map::Ordinate;
use pulloff_engine::stability::{COMPLIANCE, MapAxis};
use pulloff_engine::units::range_ends;
use serde::{Deserialize, Serialize};

/// The groups on the axes, for a gap with one wave.
const AMPLITUDE: &str = "groups.amplitude_over_wavelength";
const ADHESIONS: [&str; 2] = ["groups.adhesion", "material.work_of_adhesion"];

/// Decades of adhesion on either side of the preset's value.
const DECADES: f64 = 1.0;

/// A/λ at the end of an axis if the preset's value is zero.
const FROM_ZERO: f64 = 0.05;

/// An end of an axis that is no valid value moves towards the preset's value, halving the distance at most this many
/// times.
const HALVINGS: usize = 20;

/// What the axes of a map show.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct MapAxes {
    /// A key, a group, or [`COMPLIANCE`], alone or with a range as in [`typed`].
    pub x: String,
    /// Another of these, or a quantity of limit points: `control`, `approach` or `force`.
    pub y: String,
}

/// The quantities of limit points, over one number.
pub const CURVES: [(&str, Ordinate); 3] =
    [("control", Ordinate::Control), ("approach", Ordinate::Approach), ("force", Ordinate::Force)];

impl MapAxes {
    /// The usual axes: A/λ, or the compliance unless there is exactly one wave, and the adhesion.
    #[must_use]
    pub fn usual(preset: &Preset) -> Self {
        let has = |key: &str| preset.get(key).is_some();
        let x = if has(AMPLITUDE) { AMPLITUDE } else { COMPLIANCE };
        let y = if has(ADHESIONS[0]) { ADHESIONS[0] } else { ADHESIONS[1] };
        Self { x: x.to_owned(), y: y.to_owned() }
    }

    /// The limit points over a key; over the device's own compliance, the control would be two quantities.
    #[must_use]
    pub fn over(key: &Key) -> Self {
        let y = if is_device(key) { "force" } else { "control" };
        Self { x: axis_of(key), y: y.to_owned() }
    }

    /// The map of a key and the adhesion, or of the adhesion and the key usually shown with it.
    #[must_use]
    pub fn beside_adhesion(key: &Key, preset: &Preset) -> Self {
        let usual = Self::usual(preset);
        if ADHESIONS.contains(&&**key) {
            return Self { x: usual.x, y: key.to_string() };
        }
        Self { x: axis_of(key), y: usual.y }
    }

    /// The axes with their ranges around the values of `preset`.
    /// Errors: In words.
    pub(super) fn ranges(&self, preset: &Preset) -> Result<(MapAxis, Ordinate), String> {
        let axis = |text: &str| if text.contains('=') { typed(preset, text) } else { range(preset, text) };
        let x = axis(&self.x)?;
        let curve = CURVES.iter().find(|(name, _)| *name == self.y).map(|(_, curve)| curve.clone());
        let y = curve.map_or_else(|| axis(&self.y).map(Ordinate::Key), Ok)?;
        Ok((x, y))
    }
}

/// The key of an axis, without its range.
pub fn key_of(axis: &str) -> &str {
    axis.split('=').next().unwrap_or(axis)
}

fn is_device(axis: &str) -> bool {
    axis.starts_with("path.control") || key_of(axis) == COMPLIANCE
}

fn axis_of(axis: &Key) -> String {
    if axis.starts_with("path.control") { COMPLIANCE.to_owned() } else { axis.to_string() }
}

/// An axis as typed: KEY=FROM..TO or KEY=log:FROM..TO, each end as an assignment of the key.
/// Errors: In words.
pub fn typed(preset: &Preset, text: &str) -> Result<MapAxis, String> {
    let expected =
        || "expected KEY=FROM..TO or KEY=log:FROM..TO, such as groups.adhesion=log:0.001..1".to_owned();
    let (key, range) = text.split_once('=').ok_or_else(expected)?;
    let (key, range) = (key.trim(), range.trim());
    let (logarithmic, range) = range.strip_prefix("log:").map_or((false, range), |rest| (true, rest));
    let (from, to) = range_ends(range).filter(|_| !key.contains(':')).ok_or_else(expected)?;
    let called = if key == COMPLIANCE { key.to_owned() } else { key_called(preset, key)?.into_owned() };
    let key = &*called;
    let unit = preset.gap.length().unwrap_or(1.0) * preset.material.effective_modulus;
    let number = |text: &str| -> Result<f64, String> {
        if key == COMPLIANCE {
            // In SI, the compliance is in metres per newton.
            let number = text.trim().parse();
            return number.map_err(|_| "a compliance ranges from a number to a number or inf".to_owned());
        }
        let row = preset.row(key).ok_or_else(|| {
            preset.clone().set(key, 1.0.into()).err().map_or_else(expected, |invalid| invalid.to_string())
        })?;
        if !row.kind.is_number() && !matches!(row.kind, Kind::Integer { .. }) {
            return Err("a range must be of a number of the preset, a group, or compliance".to_owned());
        }
        preset.number(&row, text.trim()).map_err(|invalid| invalid.to_string())
    };
    let range = [number(&from)?, number(to)?];
    MapAxis::new(key, range, logarithmic, 1.0 / unit).map_err(|error| error.to_string())
}

/// Whether a row can be an axis: a number, or the device.
pub fn can_be_axis(row: &Parameter) -> bool {
    row.kind.is_number() || row.kind == Kind::Control
}

/// An axis of `key` around the value in `preset`.
fn range(preset: &Preset, key: &str) -> Result<MapAxis, String> {
    let axis =
        |range, logarithmic| MapAxis::new(key, range, logarithmic, 1.0).map_err(|error| error.to_string());
    if key == COMPLIANCE {
        let unit = preset.gap.reference_length() * preset.material.effective_modulus;
        return MapAxis::new(key, [0.0, f64::INFINITY], false, 1.0 / unit).map_err(|error| error.to_string());
    }
    let Some(row) = preset.row(key) else {
        // The error suggests the nearest name.
        let unknown = preset.clone().set(key, 1.0.into()).err();
        return Err(unknown.map_or_else(|| format!("this preset has no number {key}"), |e| e.to_string()));
    };
    let value = preset.get(key).and_then(|value| value.as_number()).filter(|_| row.kind.is_number());
    let Some(x) = value else { return Err(format!("{key} has no number here for an axis")) };
    if ADHESIONS.contains(&key) && x > 0.0 {
        let factor = 10f64.powf(DECADES);
        return axis([x / factor, x * factor], true);
    }
    let wavelength = preset.gap.wavelength().unwrap_or(0.0);
    let ends = match (key, row.kind) {
        (AMPLITUDE, _) if x == 0.0 => [0.0, FROM_ZERO],
        ("gap.amplitude", _) if x == 0.0 => [0.0, FROM_ZERO * wavelength],
        _ if x == 0.0 => return Err(format!("{key} is 0 and has no scale for an axis")),
        (_, Kind::NonNegative) => [0.0, 2.0 * x],
        (_, Kind::Finite) => [x - x.abs(), x + x.abs()],
        _ => [0.5 * x, 2.0 * x],
    };
    // Ends that are not valid values, such as a start beyond the gap, are moved closer.
    let [lo, hi] = ends.map(|mut end| {
        for _ in 0..HALVINGS {
            if preset.clone().set(key, end.into()).is_ok() {
                break;
            }
            end = 0.5 * (end + x);
        }
        end
    });
    axis([lo, hi], row.kind == Kind::Positive)
}
