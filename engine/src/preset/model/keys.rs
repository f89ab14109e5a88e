//! The preset by dotted key: its values and its rows.

use super::{BasisSpec, Preset, start_key, turn_key};
use crate::measured::asked::signs_text;
use crate::preset::family;
use crate::preset::groups;
use crate::preset::invalid::Invalid;
use crate::preset::rows::parameter;
use crate::preset::schema::{
    ADHESION, Applies, CHOOSERS, DISPLAY, EXACT, FORMAT, LIQUID_KEYS, PARAMETERS, Parameter, RANGE_KEYS, Row,
    SYSTEMS, WORK_OF_ADHESION,
};
use crate::preset::shape;
use crate::preset::value::Value;
use crate::preset::values::Values;
use crate::preset::{data, edge};
use crate::problem::{Adhesion, Control, StatedCohesion};
use crate::text::closest_key;
use crate::text::quote;
use crate::units::UnitSystem;

impl Preset {
    /// The value of a dotted key; `None` if the key is unknown, does not apply to this preset, or is left to follow
    /// from others.
    pub fn get(&self, key: &str) -> Option<Value> {
        let Self { title, units, material, gap, basis, path, edge, data, files: _ } = self;
        Some(match key {
            "format" => FORMAT.into(),
            "title" => title.as_str().into(),
            // A preset that does not name its units is in reduced units.
            "units" => match units {
                UnitSystem::Reduced => return None,
                UnitSystem::Si(_) => SYSTEMS[1].into(),
            },
            key if key.starts_with("display.") => {
                let (_, quantity) = DISPLAY.iter().find(|(known, _)| *known == key)?;
                units.unit(*quantity)?.ascii().as_str().into()
            }
            "material.effective_modulus" => material.effective_modulus.into(),
            // For a liquid bridge it follows from the liquid.
            "material.work_of_adhesion" => match material.adhesion {
                Adhesion::Capillary { .. } => return None,
                _ => material.work_of_adhesion.into(),
            },
            "material.range_of_action" => material.range_of_action?.into(),
            key if edge::KEYS.contains(&key) => return edge.get(key),
            // A preset that does not name its adhesion is short-range.
            ADHESION => match material.adhesion {
                Adhesion::ShortRange => return None,
                other => other.name().into(),
            },
            key if adhesion_keys().contains(&key) => adhesion_value(material.adhesion, key)?.into(),
            key if key.starts_with("gap.") => return shape::get(gap, key),
            "basis.kind" => match basis {
                BasisSpec::Rings { .. } => "rings".into(),
                BasisSpec::Exact => EXACT.into(),
            },
            "basis.rings" => match basis {
                BasisSpec::Rings { rings, .. } => i64::try_from(*rings).ok()?.into(),
                BasisSpec::Exact => return None,
            },
            "basis.grading" => match basis {
                BasisSpec::Rings { grading, .. } => grading.name().into(),
                BasisSpec::Exact => return None,
            },
            key if groups::row(key).is_some() => return groups::get(self, key),
            "path.control" => path.control.into(),
            "path.control.stiffness" => match path.control {
                Control::Stiffness(k) => k.into(),
                Control::Displacement | Control::Force => return None,
            },
            "path.begin" => path.begin.name().into(),
            "path.contact" => path.contact.name().into(),
            "path.end_contact_radius" => path.end_contact_radius?.into(),
            data::FILE => Value::Points(std::sync::Arc::clone(data.source.as_ref()?)),
            data::COLUMNS => Some(&*data.columns).filter(|columns| !columns.is_empty())?.into(),
            data::FREE => Some(&*data.free).filter(|free| !free.is_empty())?.into(),
            data::UNCERTAIN => Some(&*data.uncertain).filter(|given| !given.is_empty())?.into(),
            data::SETTINGS => data.is_alone.then_some(data::SETTINGS_OF[1])?.into(),
            data::SEGMENT => data.segment?.name().into(),
            data::FREE_PART => Some(&*data.free_part).filter(|text| !text.is_empty())?.into(),
            data::SIGNS => Value::Text(signs_text(data.turned?)),
            data::SKIP => {
                Some(data.skip).filter(|skip| *skip > 0).and_then(|skip| i64::try_from(skip).ok())?.into()
            }
            data::OFFSET => data.offset?.into(),
            data::BASELINE => data.baseline?.into(),
            data::TARE => data.tare?.into(),
            data::TILT => data.tilt?.into(),
            key if path.turn.and_then(turn_key) == Some(key) => path.turn?.value().into(),
            key if key == start_key(path.start) => path.start.value().into(),
            _ => return None,
        })
    }

    /// The rows of this preset, in the order in which files and screens show them: those of the table, and those that
    /// the preset adds itself.
    pub fn rows(&self) -> impl Iterator<Item = Row> {
        let after = PARAMETERS.iter().rposition(|row| row.table() == Some("gap")).map_or(0, |last| last + 1);
        let (before, rest) = PARAMETERS.split_at(after);
        let own = shape::rows(&self.gap).into_iter().map(Row::Owned);
        let rest = rest.iter().map(|row| edge::own(self.path.control, row));
        before.iter().map(|row| shape::own(&self.gap, row)).chain(own).chain(rest)
    }

    /// The row of a key, with the range and the quantity that this preset gives it, if any.
    pub fn row(&self, key: &str) -> Option<Row> {
        self.rows()
            .find(|row| row.key == key)
            .or_else(|| parameter(key))
            .or_else(|| groups::row(key).map(Row::Borrowed))
    }

    /// The rows that can be turned and typed on a screen: all but the format, the units, the ranges of parameters, the
    /// waves after the first [`WAVE_KNOBS`](family::WAVE_KNOBS), which contacts are followed, and how an edge moves.
    /// Those are set by their keys; the others fill 40 rows. Edge keys that have a value are included.
    pub fn knobs(&self) -> impl Iterator<Item = Row> {
        self.rows().filter(|row| {
            row.key != "format"
                && row.key != "path.contact"
                && (!edge::KEYS.contains(&&*row.key) || self.edge.get(&row.key).is_some())
                && !is_of_units(&row.key)
                && !shape::is_range(&row.key)
                && family::has_knob(&row.key)
                && self.has_adhesion_knob(row)
        })
    }

    /// Whether a row has nothing to do with adhesion with a range, or belongs to the adhesion in use.
    fn has_adhesion_knob(&self, row: &Row) -> bool {
        let adhesion = self.material.adhesion;
        let is_own =
            row.key == ADHESION || matches!(row.applies, Applies::With { key, .. } if key == ADHESION);
        let has_range = adhesion != Adhesion::ShortRange;
        !is_own || row.fits(ADHESION, adhesion.name()) && (has_range || row.key == WORK_OF_ADHESION)
    }

    /// The rows that have a value in this preset, in the order of [`rows`](Self::rows), with their values.
    pub fn values(&self) -> Vec<(Row, Value)> {
        self.rows().filter_map(|row| self.get(&row.key).map(|value| (row, value))).collect()
    }

    pub(in crate::preset) fn unknown_key(&self, key: &str) -> Invalid {
        let rows: Vec<Row> = self.rows().chain(groups::GROUPS.iter().map(Row::Borrowed)).collect();
        unknown_among(
            key,
            rows.iter().map(AsRef::as_ref).filter(|row| row.fits(CHOOSERS[0], self.gap.name())),
        )
    }

    pub(in crate::preset) fn keyed(&self) -> Values {
        self.values()
            .into_iter()
            .filter(|(row, _)| !row.is_part())
            .map(|(row, v)| (row.key.clone(), v))
            .collect()
    }
}

/// The keys of adhesion with a range, except for the word that chooses it.
fn adhesion_keys() -> [&'static str; 5] {
    let ([strength, range], [tension, radius, angle]) = (RANGE_KEYS, LIQUID_KEYS);
    [strength, range, tension, radius, angle]
}

/// The value that an adhesion has for one of them.
fn adhesion_value(adhesion: Adhesion, key: &str) -> Option<f64> {
    match adhesion {
        Adhesion::Dugdale(StatedCohesion::Strength(x)) => (key == RANGE_KEYS[0]).then_some(x),
        Adhesion::Dugdale(StatedCohesion::Range(x)) => (key == RANGE_KEYS[1]).then_some(x),
        Adhesion::Capillary { surface_tension, kelvin_radius, contact_angle } => {
            let at = LIQUID_KEYS.iter().position(|known| *known == key)?;
            Some([surface_tension, kelvin_radius, contact_angle][at])
        }
        Adhesion::ShortRange | Adhesion::Dugdale(StatedCohesion::Action) => None,
    }
}

/// Whether a key concerns units rather than the problem.
pub fn is_of_units(key: &str) -> bool {
    key == CHOOSERS[2] || DISPLAY.iter().any(|(known, _)| *known == key)
}

/// The error for a key without a row, in a preset whose gap has the shape `shape`, if that is known: keys of other
/// shapes are not suggested.
pub(in crate::preset) fn unknown_key(key: &str, shape: Option<&str>) -> Invalid {
    unknown_among(key, PARAMETERS.iter().filter(|row| shape.is_none_or(|shape| row.fits(CHOOSERS[0], shape))))
}

fn unknown_among<'a>(key: &str, rows: impl Iterator<Item = &'a Parameter>) -> Invalid {
    if key.starts_with("groups.") {
        let known: Vec<&str> = groups::GROUPS.iter().map(|row| &*row.key).collect();
        return Invalid::UnknownGroup { key: quote(key), known: known.join(", ") };
    }
    let meant = closest_key(key, rows.map(|row| (&*row.key, &*row.label)));
    Invalid::UnknownKey { key: quote(key), meant: meant.map(|key| key.to_owned().into()) }
}
