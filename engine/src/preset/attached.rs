//! The table `[data]` of a preset as it is read, and its points.

use super::data::{
    self, BASELINE, COLUMNS, DataSpec, FILE, FREE, FREE_PART, OFFSET, SEGMENT, SEGMENTS, SETTINGS,
    SETTINGS_OF, SIGNS, SKIP, TARE, TILT, UNCERTAIN,
};
use super::given::GivenValues;
use super::invalid::Invalid;
use super::model::Preset;
use super::value::Value;
use crate::measured::asked::{AskedError, signs};
use crate::measured::points::{SPRING, TIP, Turned, overridden, stiffness, tip_radius};
use crate::measured::role::ColumnRole;
use crate::measured::source::Reading;
use crate::measured::{Asked, Branches, FreePart, Measured, PointsFile, Segment};
use crate::problem::Control;
use crate::text::show_path;
use crate::units::{Quantity, UnitSystem, parse_quantity};
use std::sync::Arc;

impl GivenValues<'_> {
    /// The measured curve. If the control is not given, it becomes the spring that the file states. The gap has the
    /// curvature radius `radius`.
    pub(super) fn data(&mut self, control: &mut Control, radius: Option<f64>) -> DataSpec {
        let optional = |given: &mut Self, key| given.values.contains_key(key).then(|| given.number(key));
        let segment = self.values.contains_key(SEGMENT).then(|| self.text(SEGMENT));
        let source = match self.values.get(FILE) {
            Some(Value::Points(source)) => Some(Arc::clone(source)),
            Some(value @ Value::Text(name)) if !value.is_none() => match (self.files.points)(None, name) {
                Ok(bytes) => Some(Arc::new(PointsFile::new(name.clone(), None, bytes.into()))),
                Err(cause) => {
                    self.faults.push(Invalid::Made { key: FILE.into(), cause });
                    None
                }
            },
            _ => None,
        };
        let (free_part, apart) = self.free_part();
        let spec = DataSpec {
            source,
            free_part,
            apart,
            turned: self.turned(),
            skip: usize::try_from(self.integer(SKIP)).unwrap_or_default(),
            columns: self.text(COLUMNS),
            is_alone: self.values.contains_key(SETTINGS) && self.text(SETTINGS) == SETTINGS_OF[1],
            offset: optional(self, OFFSET),
            baseline: optional(self, BASELINE),
            tare: optional(self, TARE),
            tilt: optional(self, TILT),
            free: self.text(FREE),
            uncertain: self.text(UNCERTAIN),
            segment: segment
                .map(|word| if word == SEGMENTS[0] { Segment::Approach } else { Segment::Retraction }),
        };
        let Some(source) = &spec.source else { return spec };
        let has_control = self.values.contains_key("path.control");
        let found = source.measured(&spec.columns).and_then(|measured| {
            let words = |error: crate::measured::PointsError| error.to_string();
            measured.check_units(&self.units).map_err(words)?;
            if spec.is_alone {
                return Ok(None);
            }
            tip_radius(measured.radius, radius, &self.units).map_err(words)?;
            stiffness(measured.stiffness, *control, &self.units).map_err(words)
        });
        match found {
            Ok(Some(k)) if !has_control => *control = Control::Stiffness(k),
            Ok(_) => {}
            Err(cause) => self.faults.push(Invalid::Made {
                key: FILE.into(),
                cause: format!("{}: {}", super::measured::shown_file(source), cause.replace('\n', "; ")),
            }),
        }
        spec
    }
}

impl GivenValues<'_> {
    /// Which rows are apart, as given and in base units.
    fn free_part(&mut self) -> (String, FreePart) {
        let text = self.text(FREE_PART);
        let units = self.units.clone();
        let number = |text: &str| {
            let typed = parse_quantity(text).map_err(|error| error.to_string())?;
            let found = match units {
                UnitSystem::Reduced => typed.pure(),
                UnitSystem::Si(_) => typed.in_si(Quantity::Length, None),
            };
            found.map_err(|error| error.to_string())
        };
        let found = FreePart::parse(&text, &number);
        let apart = self.asked(FREE_PART, found);
        (text, apart)
    }

    /// Whether the signs of x and P are reversed, if given.
    fn turned(&mut self) -> Option<Turned> {
        let text = self.text(SIGNS);
        let found = (!text.trim().is_empty()).then(|| signs(&text)).transpose();
        self.asked(SIGNS, found)
    }

    /// What is specified about the rows; a fault if it is not understood.
    fn asked<T: Default>(&mut self, key: &'static str, found: Result<T, AskedError>) -> T {
        found.unwrap_or_else(|error| {
            self.faults.push(Invalid::Made { key: key.into(), cause: error.to_string() });
            T::default()
        })
    }
}

impl Preset {
    /// How the points of a measured curve are obtained for this preset.
    pub fn reading(&self) -> Reading {
        let spring = match self.path.control {
            Control::Stiffness(k) => Some(k),
            Control::Displacement | Control::Force => None,
        };
        let DataSpec { skip, segment, apart: free, turned, .. } = self.data;
        let asked = Asked { skip, segment, free, turned, ..Asked::default() };
        Reading { columns: self.data.columns.clone(), units: self.units.clone(), spring, asked }
    }

    /// What `before` says of its own measured curve and this preset no longer says, in a sentence; `None` where there is nothing.
    pub fn dropped_of(&self, before: &Self) -> Option<String> {
        let source = before.data.source.as_ref()?;
        let is_dropped = |key: &&str| before.get(key).is_some() && self.get(key).is_none();
        let dropped: Vec<&str> = data::OF_FILE.into_iter().filter(is_dropped).collect();
        let verb = if dropped.len() > 1 { "are" } else { "is" };
        (!dropped.is_empty() && self.data.source != before.data.source)
            .then(|| format!("{} of {} {verb} dropped", dropped.join(", "), show_path(&source.path())))
    }

    /// What was assumed in reading its measured curve, and what the file states but the preset overrides, in sentences;
    /// none without a curve.
    ///
    /// # Errors
    /// Why it cannot be read, in words.
    pub fn notes_of_reading(&self) -> Result<Vec<String>, String> {
        let Some(source) = &self.data.source else { return Ok(Vec::new()) };
        let measured = source.measured(&self.data.columns)?;
        let mut notes = measured.notes.clone();
        let doubtful = self.other_reading()?.filter(|other| other.is_doubtful);
        notes.extend(doubtful.map(|OtherReading { x, meanings: [own, other], columns, .. }| {
            format!(
                "{x} is read as the {own}: if it is the {other}, set --columns or data.columns to {columns}; the device is at \
                 the far end of the spring"
            )
        }));
        notes.extend(self.note_of_units());
        if self.data.is_alone {
            let spring = match self.path.control {
                Control::Stiffness(k) => Some(k),
                Control::Displacement | Control::Force => None,
            };
            let of_file = [
                overridden(measured.stiffness, spring, &self.units, SPRING),
                overridden(measured.radius, self.gap.radius_of_curvature(), &self.units, TIP),
            ];
            let left_out = of_file.into_iter().flatten();
            notes.extend(left_out.map(|what| format!("{what} is left out: data.settings = \"preset\"")));
        }
        Ok(notes)
    }

    /// Which columns of its measured curve have no unit, and how they are read; `None` where none lacks one.
    pub fn note_of_units(&self) -> Option<String> {
        let source = self.data.source.as_ref().filter(|_| self.units != UnitSystem::Reduced)?;
        let measured = source.measured(&self.data.columns).ok()?;
        without_unit(&measured)
    }

    /// The other way to read its x, where that is possible and a spring makes a difference.
    ///
    /// # Errors
    /// Why the file cannot be read, in words.
    pub(crate) fn other_reading(&self) -> Result<Option<OtherReading>, String> {
        let (Some(source), Control::Stiffness(_)) = (&self.data.source, self.path.control) else {
            return Ok(None);
        };
        let measured = source.measured(&self.data.columns)?;
        let role = |role| match role {
            ColumnRole::Approach => ColumnRole::Position,
            ColumnRole::Position => ColumnRole::Approach,
            role => role,
        };
        let is_position = measured.used.iter().any(|used| used.role == ColumnRole::Position);
        let meanings = ["approach of the bodies", "position of the device"];
        let meanings = if is_position { [meanings[1], meanings[0]] } else { meanings };
        let columns = measured.used.iter().map(|used| format!("{}={}", role(used.role).word(), used.number));
        let columns = columns.collect::<Vec<_>>().join(",");
        Ok(measured.open.clone().map(|(x, is_doubtful)| OtherReading { x, is_doubtful, meanings, columns }))
    }

    /// Whether the force of its measured curve is a deflection times the stiffness of the spring, so that all of it grows with k.
    pub(crate) fn is_of_deflection(&self) -> bool {
        let source = self.data.source.as_ref();
        let measured = source.and_then(|source| source.measured(&self.data.columns).ok());
        let has = |role| measured.iter().any(|measured| measured.used.iter().any(|used| used.role == role));
        has(ColumnRole::Deflection) && !has(ColumnRole::Force)
    }

    /// The branches of its measured curve; `None` without one.
    ///
    /// # Errors
    /// Why its points yield none, in words.
    pub fn branches(&self) -> Option<Result<Arc<Branches>, String>> {
        self.data.source.as_ref().map(|source| source.branches(&self.reading()))
    }
}

/// Another way to read x.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct OtherReading {
    /// The column, in words.
    pub(crate) x: String,
    /// Whether its heading may as well mean this.
    pub(crate) is_doubtful: bool,
    /// What it is read as, and what else it may be.
    pub(crate) meanings: [&'static str; 2],
    /// The value of `data.columns` that reads it as that.
    pub(crate) columns: String,
}

/// A sentence on the columns of numbers that have no unit and are read in SI.
fn without_unit(measured: &Measured) -> Option<String> {
    // What this program writes is in SI.
    if measured.is_computed {
        return None;
    }
    let bare = measured.used.iter().filter(|used| !used.has_unit);
    let (names, units): (Vec<_>, Vec<_>) =
        bare.filter_map(|used| Some((used.role.word(), used.role.si()?))).unzip();
    let example = measured.used.iter().map(|used| {
        let unit = match used.role {
            _ if used.has_unit => "",
            ColumnRole::Force => " [mN]",
            ColumnRole::Area => " [mm^2]",
            ColumnRole::Time => " [ms]",
            ColumnRole::Segment => "",
            _ => " [um]",
        };
        format!("{}={}{unit}", used.role.word(), used.number)
    });
    (!names.is_empty()).then(|| {
        format!(
            "no unit is given for {}, read in {}: --columns or data.columns gives others, as in \"{}\"",
            names.join(" and "),
            units.join(" and "),
            example.collect::<Vec<_>>().join(",")
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixtures::FILES;
    use crate::preset::{read_in, write};
    use std::path::Path;

    const HEAD: &str = "[material]\neffective_modulus=1\nwork_of_adhesion=0.1\n[gap]\nshape='sphere'\nradius_of_curvature=1\n";

    fn read(folder: &Path, units: &str, more: &str) -> Result<Preset, String> {
        let text = format!("{units}{HEAD}{more}");
        read_in(FILES, Some(folder), "p.toml", &text, &[] as &[&str]).map_err(|error| error.to_string())
    }

    /// A folder with a table without units, one in micrometres, and one of an instrument that states its spring.
    fn folder() -> tempfile::TempDir {
        let folder = tempfile::tempdir().unwrap();
        let rows: Vec<String> = (0..20).map(|i| format!("{}\t{}", -i, 0.1 * f64::from(i))).collect();
        let rows = rows.join("\n");
        let put = |name: &str, head: &str| {
            std::fs::write(folder.path().join(name), format!("{head}{rows}")).unwrap();
        };
        put("plain.txt", "delta\tforce\n");
        put("units.txt", "delta [um]\tforce [uN]\n");
        put(
            "curve.tab",
            "# BEGIN METADATA\n# {\n#   \"spring constant\": 0.25\n# }\n# END METADATA\n# height (measured)\tforce\n",
        );
        folder
    }

    #[test]
    fn a_curve_is_read_from_beside_its_preset_and_written_back() {
        let folder = folder();
        let more = "[data]\nfile='plain.txt'\noffset=-3\nbaseline=0.5\nsegment='retraction'\n";
        let preset = read(folder.path(), "", more).unwrap();
        let branches = preset.branches().unwrap().unwrap();
        assert_eq!(branches.list.iter().map(|branch| branch.attached.len()).sum::<usize>(), 20);
        assert_eq!(preset.data.segment, Some(Segment::Retraction));
        let back = read_in(FILES, Some(folder.path()), "p.toml", &write(&preset), &[] as &[&str]).unwrap();
        assert_eq!(back, preset);
        // The same branches are not searched for twice.
        assert!(Arc::ptr_eq(&branches, &preset.clone().branches().unwrap().unwrap()));
        let mut changed = preset.clone();
        changed.set(FILE, "none".into()).unwrap();
        assert_eq!((changed.data.source.as_ref(), changed.data.offset), (None, Some(-3.0)));
        assert!(!write(&changed).contains("plain.txt"));
        changed.set(FILE, folder.path().join("plain.txt").to_str().unwrap().into()).unwrap();
        assert_eq!(changed.placed_in(folder.path()).get(FILE).unwrap().to_string(), "plain.txt");
        let error = changed.set(COLUMNS, "x=1,force=7".into()).unwrap_err().to_string();
        assert!(error.contains("there is no column 7: a row has 2"), "{error}");
        let error = read(folder.path(), "", "[data]\nfile='gone.txt'\n").unwrap_err();
        assert!(error.starts_with("p.toml:8: data.file: "), "{error}");
    }

    #[test]
    fn what_a_heading_leaves_open_is_said() {
        let folder = tempfile::tempdir().unwrap();
        let rows: Vec<String> = (0..20).map(|i| format!("{i},{},approach", i * i)).collect();
        let notes = |head: &str, control: &str, units: &str| {
            let text = format!("{head}\n{}\n", rows.join("\n"));
            std::fs::write(folder.path().join("d.csv"), text).unwrap();
            let more = format!("[path]\ncontrol={control}\n[data]\nfile='d.csv'\n");
            read(folder.path(), units, &more).unwrap().notes_of_reading().unwrap().join("; ")
        };
        let (si, spring) = ("units='SI'\n", "{stiffness=0.3}");
        let open = notes("Displacement [um], force, segment", spring, si);
        assert!(open.contains("x, headed \"Displacement\", is read as the approach of the bodies"), "{open}");
        assert!(open.contains("to position=1,force=2,segment=3"), "{open}");
        assert!(open.contains("no unit is given for force, read in N"), "{open}");
        assert!(open.contains("as in \"approach=1,force=2 [mN],segment=3\""), "{open}");
        let open = notes("z [um], force [uN], segment", spring, si);
        let said = "x, headed \"z\", is read as the position of the device: if it is the approach of the bodies, set --columns or data.columns to \
                    approach=1,force=2,segment=3";
        assert!(open.contains(said), "{open}");
        for (head, control, units) in [
            ("Displacement [um], force [uN], segment", "'force'", si),
            ("indentation [um], force [uN], segment", spring, si),
            ("position [um], force [uN], segment", spring, si),
            ("indentation, force, segment", spring, ""),
        ] {
            assert_eq!(notes(head, control, units), "", "{head} {control}");
        }
    }

    #[test]
    fn a_tare_is_that_of_its_file() {
        let folder = tempfile::tempdir().unwrap();
        let rows: Vec<String> = (0..20).map(|i| format!("{i},{},approach", i * i)).collect();
        let text = format!("indentation,force,segment\n{}\n", rows.join("\n"));
        std::fs::write(folder.path().join("d.csv"), &text).unwrap();
        let preset = read(folder.path(), "", "[data]\nfile='d.csv'\ntare=0.5\n").unwrap();
        let with = |bytes: String| {
            let mut changed = preset.clone();
            let file = PointsFile::new("e.csv".to_owned(), None, bytes.into_bytes().into());
            changed.set(FILE, Value::Points(Arc::new(file))).unwrap();
            changed.data.tare
        };
        assert_eq!((preset.data.tare, with(text.clone())), (Some(0.5), Some(0.5)));
        assert_eq!(with(format!("{text}20,400,approach\n")), None);
    }

    #[test]
    fn units_and_springs_that_contradict_the_preset_are_refused() {
        let folder = folder();
        let error = read(folder.path(), "", "[data]\nfile='units.txt'\n").unwrap_err();
        assert!(
            error.contains("the approach has a unit, um, and the problem is in reduced units"),
            "{error}"
        );
        read(folder.path(), "units='SI'\n", "[data]\nfile='units.txt'\n").unwrap();
        // A file that states its spring gives it to a preset that does not specify its device.
        let data = "[data]\nfile='curve.tab'\n";
        let preset = read(folder.path(), "units='SI'\n", data).unwrap();
        assert_eq!(preset.path.control, Control::Stiffness(0.25));
        let with = |control: &str| {
            read(folder.path(), "units='SI'\n", &format!("[path]\ncontrol={control}\n{data}"))
        };
        assert_eq!(with("{stiffness=0.25}").unwrap().path.control, Control::Stiffness(0.25));
        let error = with("{stiffness=0.3}").unwrap_err();
        assert!(
            error.contains("the file states a spring of 0.25 N/m") && error.contains("0.3 N/m"),
            "{error}"
        );
        assert!(read(folder.path(), "", data).unwrap_err().contains("reduced units"));
        // If the file is chosen later, its spring replaces a device without a stiffness, but not another spring.
        let mut preset = read(folder.path(), "units='SI'\n", "").unwrap();
        let file = folder.path().join("curve.tab");
        preset.set(FILE, file.to_str().unwrap().into()).unwrap();
        assert_eq!(preset.path.control, Control::Stiffness(0.25));
        preset.set(FILE, "none".into()).unwrap();
        preset.set("path.control.stiffness", 7.0.into()).unwrap();
        let error = preset.set(FILE, file.to_str().unwrap().into()).unwrap_err().to_string();
        assert!(error.contains("or data.settings = \"preset\" if the file's is wrong"), "{error}");
        assert_eq!(preset.data.source, None);
        // Unless only the preset counts.
        preset.set(SETTINGS, "preset".into()).unwrap();
        preset.set(FILE, file.to_str().unwrap().into()).unwrap();
        assert_eq!(preset.path.control, Control::Stiffness(7.0));
        let back = read_in(FILES, Some(folder.path()), "p.toml", &write(&preset), &[] as &[&str]).unwrap();
        assert_eq!(back, preset);
        let error = preset.set(SETTINGS, "file".into()).unwrap_err().to_string();
        assert!(error.contains("a spring of 0.25 N/m, and path.control.stiffness is 7 N/m"), "{error}");
    }

    #[test]
    fn a_tip_that_contradicts_the_gap_is_refused_with_both_radii_and_the_way_out() {
        let folder = tempfile::tempdir().unwrap();
        let rows: Vec<String> = (0..20).map(|i| format!("{i}\t{}", i * i)).collect();
        let text = format!("Tip radius (um)\t27.5\nIndentation (nm)\tLoad (uN)\n{}\n", rows.join("\n"));
        std::fs::write(folder.path().join("chiaro.txt"), text).unwrap();
        let with = |radius: &str, more: &str| {
            let head = HEAD.replace("radius_of_curvature=1", &format!("radius_of_curvature='{radius}'"));
            let text = format!("units='SI'\n{head}[data]\nfile='chiaro.txt'\n{more}");
            read_in(FILES, Some(folder.path()), "p.toml", &text, &[] as &[&str])
                .map_err(|error| error.to_string())
        };
        for radius in ["27.5 um", "27.52 um"] {
            assert!(with(radius, "").is_ok(), "{radius}");
        }
        let error = with("25 um", "").unwrap_err();
        assert!(
            error.contains("the file states a tip radius of 27.5 um, and gap.radius_of_curvature is 25 um"),
            "{error}"
        );
        assert!(error.contains("data.settings = \"preset\""), "{error}");
        let alone = with("25 um", "settings='preset'\n").unwrap();
        let notes = alone.notes_of_reading().unwrap().join("; ");
        assert!(
            notes.contains(
                "a tip radius of 27.5 um, which the file states where gap.radius_of_curvature is 25 um, is left out: data.settings = \
                 \"preset\""
            ),
            "{notes}"
        );
        // What agrees needs no note.
        let same = with("27.5 um", "settings='preset'\n").unwrap();
        assert!(!same.notes_of_reading().unwrap().join("; ").contains("left out"));
    }
}
