//! The names by which headers say what their columns hold.

use super::role::{ColumnRole, Segment, dimensions};
use crate::units::Unit;

impl ColumnRole {
    /// What a header's name says.
    pub fn of(name: &str) -> Option<Self> {
        named(name).filter(|named| named.side.is_none()).map(|named| named.role)
    }
}

/// A column's name taken apart.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct ColumnName {
    /// What it holds.
    pub role: ColumnRole,
    /// Of several columns with the same role, the one with the lowest rank is read.
    pub rank: u8,
    /// The branch to which it is restricted.
    pub side: Option<Segment>,
    /// The unit in its name: `Defl_pN_Ex`.
    pub unit: Option<String>,
    /// Whether a device has a column of this name as often as the bodies have.
    pub is_open: bool,
}

/// Names of an approach that are as often those of the position of a device, and the reverse.
const OPEN: [&str; 4] = ["displacement", "disp", "distance", "z"];

/// The roles with the names that headers use for them, letters and digits only, in lower case, split by spaces. Names of
/// rank 1 may mean something else when others are present; names of rank 2 are what was asked for, not what was
/// reached. A long list goes on in the next row.
const NAMES: &[(ColumnRole, u8, &str)] = &[
    (ColumnRole::Approach, 0, "indentation indentationdepth delta δ penetration penetrationdepth"),
    (ColumnRole::Approach, 0, "eindringtiefe"),
    (ColumnRole::Approach, 1, "approach depth displacementintosurface displacement disp tipposition"),
    (ColumnRole::Approach, 1, "verticaltipposition tipsampleseparation tipsampledistance separation sep"),
    (ColumnRole::Approach, 1, "distance hc"),
    (ColumnRole::Position, 0, "heightmeasured measuredheight heightmeasuredsmoothed smoothedmeasuredheight"),
    (ColumnRole::Position, 0, "zsensor zsense zsnsr heightsensor sensorheight capacitivesensorheight"),
    (ColumnRole::Position, 0, "smoothedcapacitivesensorheight lvdt actuatorposition stageposition"),
    (ColumnRole::Position, 0, "measuredposition positionmeasured"),
    (
        ColumnRole::Position,
        1,
        "position height piezo z stage heightpiezo zpiezo piezoheight piezoz positionpiezo",
    ),
    (ColumnRole::Position, 1, "extension piezoposition zposition zheight zdisplacement piezodisplacement"),
    (ColumnRole::Position, 1, "stagez zstage crosshead crossheadposition crossheaddisplacement actuator weg"),
    (ColumnRole::Position, 1, "standardweg traverse calcramp ramp zscanner scannerz"),
    (ColumnRole::Position, 2, "raw rawheight targetposition setposition zdriver zcommand"),
    // "tb" is from AFM Workshop: the top of the detector minus its bottom.
    (ColumnRole::Deflection, 0, "deflection defl bending cantileverdeflection vdeflection"),
    (ColumnRole::Deflection, 0, "verticaldeflection deflectionv cantilever deflectionerror tb"),
    (ColumnRole::Force, 0, "force load normalforce normalload loadonsample appliedload appliedforce"),
    (ColumnRole::Force, 0, "loadcell verticalforce forcez zforce fz fn contactforce adhesionforce kraft"),
    (ColumnRole::Force, 0, "standardkraft prüfkraft normalkraft charge"),
    (ColumnRole::Force, 1, "p f weight last mass"),
    (ColumnRole::Force, 2, "targetforce setforce targetload rawload rawforce loadraw forceraw"),
    (ColumnRole::Radius, 0, "contactradius radiusofcontact kontaktradius"),
    (ColumnRole::Radius, 1, "radius s a"),
    (ColumnRole::Diameter, 0, "contactdiameter diameterofcontact"),
    (ColumnRole::Diameter, 1, "diameter"),
    (ColumnRole::Area, 0, "contactarea areaofcontact area kontaktfläche"),
    (ColumnRole::Time, 0, "seriestime elapsedtime totaltime"),
    (ColumnRole::Time, 1, "time t zeit standardzeit prüfzeit"),
    (ColumnRole::Segment, 0, "segment branch direction phase segmentname segmenttype"),
];

/// Words in a name that say nothing about what the column holds.
const EMPTY_WORDS: &str = "smoothed corrected filtered avg average mean ch channel sensor signal wave image untitled \
     calibrated measured";

/// Words for a branch that may be joined to a name.
const GROWN: [&str; 8] =
    ["extend", "extension", "retract", "retraction", "approach", "withdraw", "unloading", "loading"];

/// A name reduced to letters and digits, in lower case.
pub(super) fn squashed(name: &str) -> String {
    name.chars().filter(|c| c.is_alphanumeric()).flat_map(char::to_lowercase).collect()
}

/// The role and the rank of a name with nothing around it.
fn known(squashed: &str) -> Option<(ColumnRole, u8)> {
    let found = NAMES.iter().find(|(.., names)| names.split(' ').any(|name| name == squashed));
    found.map(|(role, rank, _)| (*role, *rank))
}

/// What a column's name says, including the branch, the unit and the surrounding words that carry no meaning.
pub(super) fn named(name: &str) -> Option<ColumnName> {
    /// The largest number of words in a name.
    const WORDS: usize = 12;
    let mut words: Vec<&str> =
        name.split(|c: char| !c.is_alphanumeric() && c != '°').filter(|word| !word.is_empty()).collect();
    if words.len() > WORDS {
        return None;
    }
    let (mut side, mut unit) = (None, None);
    loop {
        let whole = squashed(&words.concat());
        if let Some((role, rank)) = known(&whole) {
            return Some(ColumnName { role, rank, side, unit, is_open: OPEN.contains(&&*whole) });
        }
        let (first, last) = (*words.first()?, *words.last()?);
        if words.len() == 1 {
            return grown(&whole).map(|(role, rank, grown)| ColumnName {
                role,
                rank,
                side: side.or(grown),
                unit,
                is_open: false,
            });
        }
        let of = |word: &str| word.chars().all(char::is_alphabetic).then(|| Segment::of(word)).flatten();
        let is_unit = |word: &str| {
            let unit = Unit::parse(word, 0);
            word == "V" || unit.is_ok_and(|unit| dimensions().contains(&unit.dimension()))
        };
        let is_empty = |word: &str| {
            let lower = word.to_lowercase();
            EMPTY_WORDS.split(' ').any(|empty| empty == lower) || word.chars().all(|c| c.is_ascii_digit())
        };
        if side.is_none() && of(last).is_some() {
            side = of(last);
            words.pop();
        } else if side.is_none() && of(first).is_some() {
            side = of(first);
            words.remove(0);
        } else if unit.is_none() && is_unit(last) {
            unit = words.pop().map(str::to_owned);
        } else if is_empty(last) {
            words.pop();
        } else if is_empty(first) {
            words.remove(0);
        } else {
            return None;
        }
    }
}

/// A name after a number, as in `image0001zsnsr`, or joined to a branch, as in `extendforce`.
fn grown(squashed: &str) -> Option<(ColumnRole, u8, Option<Segment>)> {
    let behind = squashed.rfind(|c: char| c.is_ascii_digit()).map(|at| &squashed[at + 1..]);
    if let Some((role, rank)) =
        behind.and_then(known).or_else(|| known(squashed.trim_end_matches(|c: char| c.is_ascii_digit())))
    {
        return Some((role, rank, None));
    }
    GROWN.iter().find_map(|word| {
        let rest = squashed.strip_prefix(word).or_else(|| squashed.strip_suffix(word))?;
        let (role, rank) = known(rest)?;
        Some((role, rank, Segment::of(word)))
    })
}
