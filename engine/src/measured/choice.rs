//! Which columns of a table are used, as its header or the user specifies.

use super::error::CurveReadError;
use super::header::Header;
use super::names::{named, squashed};
use super::role::{ColumnPlace, ColumnRole, ColumnSpec, ColumnSpecError, Said, Segment, unit_of};
use super::words::{is_grouped, is_number};
use crate::cells::ColumnHead;
use crate::text::{quote, sanitize};
use crate::units::Unit;

/// A column that is looked for in each row.
#[derive(Debug, Clone)]
pub(super) struct WantedColumn {
    pub role: ColumnRole,
    pub at: usize,
    pub unit: Option<Unit>,
    /// Whether the user names it: it must then be present in each row.
    pub is_said: bool,
}

/// A column whose name is known.
struct NamedColumn {
    at: usize,
    role: ColumnRole,
    rank: u8,
    side: Option<Segment>,
    unit: Result<Option<Unit>, ColumnSpecError>,
}

/// The columns whose names are known, with the unit of each checked.
fn candidates(header: &Header) -> Vec<NamedColumn> {
    let of = |(at, (name, unit)): (usize, &ColumnHead)| {
        let named = named(name)?;
        let text = unit.as_deref().or(named.unit.as_deref());
        let read = |role| text.map(|text| unit_of(role, text)).transpose();
        // A deflection in units of force is the force, and a column called an area may give the diameter.
        let (role, unit) = match (named.role, read(named.role)) {
            (ColumnRole::Deflection, Err(_)) if read(ColumnRole::Force).is_ok() => {
                (ColumnRole::Force, read(ColumnRole::Force))
            }
            (role, unit) => (role, unit),
        };
        Some(NamedColumn { at, role, rank: named.rank, side: named.side, unit })
    };
    header.heads.iter().enumerate().filter_map(of).collect()
}

/// The units that a header gives to columns whose names are known, each with the place of its column.
pub(super) fn units_of(header: &Header) -> Vec<(usize, Unit)> {
    let known = candidates(header).into_iter();
    known.filter_map(|column| Some((column.at, column.unit.ok().flatten()?))).collect()
}

/// The columns of approach and retraction, where they stand side by side: each with an x and a force, in the same
/// units. A column that belongs to neither is used for both.
pub(super) fn sides(header: &Header) -> Option<[Vec<WantedColumn>; 2]> {
    let known = candidates(header);
    let [mut approach, mut retraction] = [Segment::Approach, Segment::Retraction].map(|segment| {
        let mut wanted: Vec<WantedColumn> = Vec::new();
        let of = |side: Option<Segment>| known.iter().filter(move |column| column.side == side);
        for column in of(Some(segment)).chain(of(None)) {
            let is_new = wanted.iter().all(|other| other.role != column.role);
            if let (true, Ok(unit)) = (is_new && column.role != ColumnRole::Segment, &column.unit) {
                wanted.push(WantedColumn {
                    role: column.role,
                    at: column.at,
                    unit: unit.clone(),
                    is_said: false,
                });
            }
        }
        wanted
    });
    let has = |wanted: &[WantedColumn], is: &dyn Fn(ColumnRole) -> bool| {
        wanted.iter().any(|column| is(column.role))
    };
    // A time of one branch alone says nothing about the other.
    if has(&approach, &is_time) != has(&retraction, &is_time) {
        for side in [&mut approach, &mut retraction] {
            side.retain(|column| !is_time(column.role));
        }
    }
    let is_whole =
        |wanted: &[WantedColumn]| has(wanted, &ColumnRole::is_way) && has(wanted, &ColumnRole::is_force);
    let has_side = |segment| known.iter().any(|column| column.side == Some(segment) && column.unit.is_ok());
    let same = |column: &WantedColumn| {
        retraction.iter().any(|other| other.role == column.role && other.unit == column.unit)
    };
    let is_both = has_side(Segment::Approach) && has_side(Segment::Retraction);
    let fits =
        is_both && is_whole(&approach) && approach.len() == retraction.len() && approach.iter().all(same);
    fits.then_some([approach, retraction])
}

fn is_time(role: ColumnRole) -> bool {
    role == ColumnRole::Time
}

/// Which columns are used, in a file whose first row is in the line `row`.
pub(super) fn wanted(
    spec: &ColumnSpec,
    header: Option<&Header>,
    row: usize,
    cells: usize,
    notes: &mut Vec<String>,
) -> Result<Vec<WantedColumn>, CurveReadError> {
    let line = header.map_or(row, |header| header.line);
    let known = || header.map_or_else(String::new, |header| listed(&header.heads));
    let mut refused = Vec::new();
    let wanted = match header {
        _ if !spec.0.is_empty() => of_person(spec, header, line, cells)?,
        Some(header) => {
            let wanted = of_header(header, notes, &mut refused);
            notes.extend(unused_length(header, &wanted));
            wanted
        }
        None if cells == 2 => {
            notes.push(
                "there is no header: the first column is taken as the approach, the second as the force"
                    .to_owned(),
            );
            let of = |(at, role)| WantedColumn { role, at, unit: None, is_said: false };
            [(0, ColumnRole::Approach), (1, ColumnRole::Force)].map(of).into()
        }
        None => Vec::new(),
    };
    let has = |is: &dyn Fn(ColumnRole) -> bool| wanted.iter().any(|column: &WantedColumn| is(column.role));
    if spec.0.is_empty() && cells == 2 && !has(&ColumnRole::is_force) && header.is_some_and(is_profile) {
        return Err(CurveReadError::Profile { line, names: known() });
    }
    let heads = header.map_or(&[][..], |header| &header.heads);
    let numbers = heads.iter().filter(|(name, _)| is_grouped(name) || is_number(name)).count();
    let grouped =
        heads.iter().find(|(name, _)| is_grouped(name)).filter(|_| numbers > 1 && spec.0.is_empty());
    if let Some((grouped, _)) = grouped {
        return Err(CurveReadError::NotNumber { line, text: quote(grouped) });
    }
    for (is, missing) in [
        (&ColumnRole::is_force as &dyn Fn(ColumnRole) -> bool, "force or the deflection"),
        (&ColumnRole::is_way, "approach, the position or the contact radius"),
    ] {
        // If a column of that name has a unit of another quantity, that is the reason.
        if let (false, Some((_, error))) = (has(is), refused.iter().find(|(role, _)| is(*role))) {
            return Err(error.clone());
        }
        if !wanted.is_empty() && !has(is) {
            return Err(CurveReadError::Lacks { line, missing, known: known() });
        }
    }
    if wanted.is_empty() {
        // A row with a word in it is taken for a header.
        let is_number = |(name, _): &&ColumnHead| name.parse::<f64>().is_ok();
        if let (true, Some((word, _))) =
            (heads.iter().any(|head| is_number(&head)), heads.iter().find(|head| !is_number(head)))
        {
            return Err(CurveReadError::NotNumber { line, text: quote(word) });
        }
        return Err(CurveReadError::Unknown { line, cells, names: known() });
    }
    notes.extend(refused.iter().filter_map(|(_, error)| match error {
        CurveReadError::Unit { cause, .. } => Some(format!("{cause}: the column is left out")),
        _ => None,
    }));
    Ok(wanted)
}

/// A note where force and contact radius are used alone, although another column may be the approach.
fn unused_length(header: &Header, wanted: &[WantedColumn]) -> Option<String> {
    let has = |is: fn(ColumnRole) -> bool| wanted.iter().any(|column| is(column.role));
    let is_length = |name: &str, unit: Option<&String>| {
        let of_name = name.rsplit(|c: char| !c.is_alphanumeric()).next().map(str::to_owned);
        unit.cloned().or(of_name).is_some_and(|unit| unit_of(ColumnRole::Approach, &unit).is_ok())
    };
    let mut heads = header.heads.iter().enumerate();
    let (at, (name, _)) = heads.find(|(at, (name, unit))| {
        wanted.iter().all(|column| column.at != *at) && is_length(name, unit.as_ref())
    })?;
    (has(ColumnRole::is_contact) && !has(ColumnRole::is_approach)).then(|| {
        format!(
            "column {number}, \"{}\", is not used: if it is the approach, head it \"indentation\", or name all columns, \
             as in --columns or data.columns \"approach={number},force=…,radius=…\"",
            quote(name),
            number = at + 1,
        )
    })
}

/// Whether two columns are a profile of the gap: a radius, or any length, and a length. A name that can only be of a
/// measured curve, such as `contact radius`, says that they are not.
fn is_profile(header: &Header) -> bool {
    let is_length =
        |head: &ColumnHead| head.1.as_ref().is_some_and(|unit| unit_of(ColumnRole::Approach, unit).is_ok());
    let is_radius = |head: &ColumnHead| ["r", "radius"].contains(&&*squashed(&head.0));
    let is_measured = |head: &ColumnHead| named(&head.0).is_some_and(|name| name.rank == 0);
    match &header.heads[..] {
        heads if heads.iter().any(is_measured) => false,
        [first, second] => is_length(first) && is_length(second) || is_radius(first) && second.1.is_none(),
        _ => false,
    }
}

/// The columns that a person names.
fn of_person(
    spec: &ColumnSpec,
    header: Option<&Header>,
    line: usize,
    cells: usize,
) -> Result<Vec<WantedColumn>, CurveReadError> {
    let column = |said: &Said| {
        let at = match &said.place {
            ColumnPlace::Number(number) => Some(number - 1).filter(|at| *at < cells),
            ColumnPlace::Name(name) => header.and_then(|header| {
                header.heads.iter().position(|(known, _)| known.eq_ignore_ascii_case(name))
            }),
        };
        let Some(at) = at else {
            let place = match &said.place {
                ColumnPlace::Number(number) => format!("{number}: a row has {cells}"),
                ColumnPlace::Name(name) => format!("\"{}\"", quote(name)),
            };
            let known = header.map_or_else(String::new, |header| listed(&header.heads));
            return Err(CurveReadError::NoColumn { line, place, known });
        };
        let head = header.and_then(|header| header.heads.get(at));
        let in_name = head.and_then(|(name, _)| named(name)?.unit);
        let text = head.and_then(|head| head.1.clone()).or(in_name);
        let unit = match (&said.unit, text) {
            (Some(unit), _) => Some(unit.clone()),
            (None, Some(text)) => {
                let unit = unit_of(said.role, &text);
                Some(unit.map_err(|cause| {
                    refusal(line, at, head.map_or("", |head| &head.0), said.role, &text, cause)
                })?)
            }
            (None, None) => None,
        };
        Ok(WantedColumn { role: said.role, at, unit, is_said: true })
    };
    spec.0.iter().map(column).collect()
}

/// Why a column is not used: a signal in volts or amperes lacks its sensitivity, anything else has the wrong unit.
fn refusal(
    line: usize,
    at: usize,
    name: &str,
    role: ColumnRole,
    unit: &str,
    cause: ColumnSpecError,
) -> CurveReadError {
    let is_signal =
        ["V", "mV", "uV", "µV", "nA", "A", "pA", "Volt", "Volts", "volt", "volts"].contains(&unit.trim());
    // Nobody measures where a device is in amperes: that is ångström.
    let is_current = unit.trim() == "A" && ![ColumnRole::Force, ColumnRole::Deflection].contains(&role);
    if is_signal && !is_current {
        let (number, name, unit) = (at + 1, quote(name), quote(unit));
        CurveReadError::Signal { line, number, name, unit, role }
    } else {
        CurveReadError::Unit { line, cause }
    }
}

/// The columns whose names in the header are known; those with a unit of another quantity are put in `refused`.
fn of_header(
    header: &Header,
    notes: &mut Vec<String>,
    refused: &mut Vec<(ColumnRole, CurveReadError)>,
) -> Vec<WantedColumn> {
    let mut wanted: Vec<(u8, WantedColumn)> = Vec::new();
    let all = candidates(header);
    // If the names mention one branch only, they apply to all rows; with two branches it is unclear which is meant.
    let side = |of| all.iter().any(|column| column.side == Some(of));
    let is_mixed = side(Segment::Approach) && side(Segment::Retraction);
    for column in all.into_iter().filter(|column| column.side.is_none() || !is_mixed) {
        let unit = match column.unit {
            Ok(unit) => unit,
            Err(cause) => {
                let (name, unit) = &header.heads[column.at];
                let unit = unit.as_deref().unwrap_or("V");
                let error = refusal(header.line, column.at, name, column.role, unit, cause);
                refused.push((column.role, error));
                continue;
            }
        };
        let new = WantedColumn { role: column.role, at: column.at, unit, is_said: false };
        let Some((rank, known)) = wanted.iter_mut().find(|(_, known)| known.role == new.role) else {
            wanted.push((column.rank, new));
            continue;
        };
        let is_better = column.rank < *rank;
        let (taken, left) = if is_better { (new.at, known.at) } else { (known.at, new.at) };
        notes.push(format!(
            "columns {} and {} both hold the {}: the {} is read, the other left out",
            taken.min(left) + 1,
            taken.max(left) + 1,
            new.role.word(),
            if taken < left { "first" } else { "second" }
        ));
        if is_better {
            (*rank, *known) = (column.rank, new);
        }
    }
    let mut wanted: Vec<WantedColumn> = wanted.into_iter().map(|(_, wanted)| wanted).collect();
    // The contact needs only one column.
    let has = |wanted: &[WantedColumn], role| wanted.iter().any(|column| column.role == role);
    for (better, other) in [
        (ColumnRole::Radius, ColumnRole::Diameter),
        (ColumnRole::Radius, ColumnRole::Area),
        (ColumnRole::Diameter, ColumnRole::Area),
    ] {
        if has(&wanted, better) {
            wanted.retain(|column| column.role != other);
        }
    }
    wanted
}

/// The column of x in words, if it may be an approach where it is taken as a position, or the reverse, and whether nothing says
/// which. Each stage of a device is headed as a position, whatever its numbers are.
pub(super) fn open(
    spec: &ColumnSpec,
    header: Option<&Header>,
    wanted: &[WantedColumn],
) -> Option<(String, bool)> {
    let [approach, position, deflection] =
        [ColumnRole::Approach, ColumnRole::Position, ColumnRole::Deflection]
            .map(|role| wanted.iter().find(|column| column.role == role));
    let x = match (approach, position) {
        (Some(x), None) => x,
        // A deflection goes with the position of the device.
        (None, Some(x)) if deflection.is_none() => x,
        _ => return None,
    };
    if !spec.0.is_empty() {
        return None;
    }
    let Some(header) = header else { return Some(("x, which has no heading,".to_owned(), true)) };
    let (name, _) = header.heads.get(x.at)?;
    let is_open = named(name)?.is_open;
    (is_open || x.role == ColumnRole::Position).then(|| (format!("x, headed \"{}\",", quote(name)), is_open))
}

/// Gives the SI unit to columns without a unit.
pub(super) fn in_si(wanted: &mut [WantedColumn]) {
    for column in wanted.iter_mut().filter(|column| column.unit.is_none()) {
        column.unit = column.role.si().and_then(|si| Unit::parse(si, 0).ok());
    }
}

/// The names of a header, safe to show.
fn listed(heads: &[ColumnHead]) -> String {
    let names: Vec<String> = heads.iter().map(|(name, _)| format!("\"{}\"", quote(name))).collect();
    sanitize(&names.join(", "), 200)
}
