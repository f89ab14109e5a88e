//! What the header of a measured curve, or a person, says of its columns.

use super::error::ReadError;
use super::role::{Place, Role, Said, Segment, Spec, dimensions, unit_of};
use crate::cells::{Head, Separator, heads};
use crate::text::{quote, sanitize};
use crate::units::Unit;

/// A column that is looked for in each row.
pub(super) struct Wanted {
    pub role: Role,
    pub at: usize,
    pub unit: Option<Unit>,
}

/// A header: the names and units of the columns.
pub(super) struct Header {
    pub line: usize,
    pub heads: Vec<Head>,
}

/// The header: a line of its own, or the last remark above the rows where it has as many cells as they.
pub(super) fn headed(
    header: Option<(usize, &str)>,
    units: Option<&str>,
    candidate: Option<(usize, &str)>,
    separator: Separator,
    cells: usize,
) -> Option<Header> {
    // A header may be parted otherwise than the rows below it.
    let read = |(line, text): (usize, &str)| {
        let of = |separator| Some(heads(text, separator, &dimensions())).filter(|heads| heads.len() == cells);
        let heads = of(separator).or_else(|| of(Separator::of(text)))?;
        Some(Header { line, heads: heads.into_iter().map(whole).collect() })
    };
    let with_units = |mut header: Header| {
        let units = units.map(|line| unit_cells(line, Separator::of(line))).unwrap_or_default();
        if units.len() == header.heads.len() {
            for (head, unit) in header.heads.iter_mut().zip(units) {
                head.1 = head.1.take().or_else(|| Some(unit.to_owned()).filter(|unit| !unit.is_empty()));
            }
        }
        header
    };
    header.and_then(read).map(with_units).or_else(|| {
        let header = candidate.and_then(read)?;
        // A remark of the right number of words need not be a header.
        let known = header.heads.iter().filter(|(name, _)| Role::of(name).is_some()).count();
        (known >= 2).then_some(header)
    })
}

/// The cells of a line of units, without brackets.
fn unit_cells(line: &str, separator: Separator) -> Vec<&str> {
    separator.cells(line).into_iter().map(|cell| cell.trim_matches(['(', ')', '[', ']'])).collect()
}

/// Whether a line has units and nothing else.
pub(super) fn is_units(line: &str) -> bool {
    let cells = unit_cells(line, Separator::of(line));
    let is_unit =
        |cell: &&str| Unit::parse(cell, 0).is_ok_and(|unit| dimensions().contains(&unit.dimension()));
    cells.iter().any(is_unit) && cells.iter().all(|cell| cell.is_empty() || *cell == "-" || is_unit(cell))
}

/// The branch that a column's name begins or ends with, and what is left of it: `Extend Z`, `force (retract)`.
fn side(name: &str) -> Option<(Segment, Role)> {
    let name = name.replace(['_', '(', ')'], " ");
    let words: Vec<&str> = name.split_whitespace().collect();
    let of = |word: &str, rest: &[&str]| {
        let segment = Segment::of(word).filter(|_| word.chars().all(char::is_alphabetic))?;
        Some((segment, Role::of(&rest.join(" "))?))
    };
    let (first, last) = (words.split_first()?, words.split_last()?);
    of(first.0, first.1).or_else(|| of(last.0, last.1))
}

/// The columns of approach and retraction, where they stand beside each other: each with a way and a force, in the same units.
pub(super) fn sides(header: &Header) -> Result<Option<[Vec<Wanted>; 2]>, ReadError> {
    let mut sides = [Segment::Approach, Segment::Retraction].map(|segment| (segment, Vec::new()));
    for (at, (name, _)) in header.heads.iter().enumerate() {
        let Some((of, role)) = side(name).filter(|_| Role::of(name).is_none()) else { continue };
        for (segment, wanted) in &mut sides {
            if *segment == of && wanted.iter().all(|column: &Wanted| column.role != role) {
                let unit = unit_in(header, at, role)?;
                wanted.push(Wanted { role, at, unit });
            }
        }
    }
    let [(_, approach), (_, retraction)] = sides;
    let is_way = |role| [Role::Approach, Role::Position, Role::Radius].contains(&role);
    let is_whole = |wanted: &[Wanted]| {
        let has = |is: &dyn Fn(Role) -> bool| wanted.iter().any(|column| is(column.role));
        has(&is_way) && has(&|role| [Role::Force, Role::Deflection].contains(&role))
    };
    let same = |column: &Wanted| {
        retraction.iter().any(|other| other.role == column.role && other.unit == column.unit)
    };
    let fits = is_whole(&approach) && approach.len() == retraction.len() && approach.iter().all(same);
    Ok(fits.then_some([approach, retraction]))
}

/// What stands in parentheses and is no unit belongs to the name: `height (measured)`.
fn whole((name, unit): Head) -> Head {
    match unit {
        Some(text) if Unit::parse(&text, 0).is_err() => {
            let longer = format!("{name} {text}");
            if Role::of(&longer).is_some() || Role::of(&name).is_none() || side(&longer).is_some() {
                (longer, None)
            } else {
                (name, Some(text))
            }
        }
        unit => (name, unit),
    }
}

/// Which columns are used, in a file whose first row is in the line `row`.
pub(super) fn wanted(
    spec: &Spec,
    header: Option<&Header>,
    row: usize,
    cells: usize,
    notes: &mut Vec<String>,
) -> Result<Vec<Wanted>, ReadError> {
    let line = header.map_or(row, |header| header.line);
    let known = || header.map_or_else(String::new, |header| listed(&header.heads));
    let wanted = match header {
        _ if !spec.0.is_empty() => of_person(spec, header, line, cells)?,
        Some(header) => of_header(header, notes)?,
        None if cells == 2 => {
            notes.push(
                "there is no header: the first column is taken for the approach, the second for the force"
                    .to_owned(),
            );
            let of = |(at, role)| Wanted { role, at, unit: None };
            [(0, Role::Approach), (1, Role::Force)].map(of).into()
        }
        None => Vec::new(),
    };
    if wanted.is_empty() {
        return Err(ReadError::Unknown { line, cells, names: known() });
    }
    let has = |role| wanted.iter().any(|column: &Wanted| column.role == role);
    let lacks = |missing| Err(ReadError::Lacks { line, missing, known: known() });
    if !(has(Role::Force) || has(Role::Deflection)) {
        return lacks("force, or of the deflection");
    }
    if !(has(Role::Approach) || has(Role::Position) || has(Role::Radius)) {
        return lacks("approach, of the position or of the contact radius");
    }
    Ok(wanted)
}

/// The unit that a header names for the column `at`, of the role `role`.
fn unit_in(header: &Header, at: usize, role: Role) -> Result<Option<Unit>, ReadError> {
    let text = header.heads.get(at).and_then(|head| head.1.as_deref());
    text.map(|text| unit_of(role, text))
        .transpose()
        .map_err(|cause| ReadError::Unit { line: header.line, cause })
}

/// The columns that a person names.
fn of_person(
    spec: &Spec,
    header: Option<&Header>,
    line: usize,
    cells: usize,
) -> Result<Vec<Wanted>, ReadError> {
    let column = |said: &Said| {
        let at = match &said.place {
            Place::Number(number) => Some(number - 1).filter(|at| *at < cells),
            Place::Name(name) => header.and_then(|header| {
                header.heads.iter().position(|(known, _)| known.eq_ignore_ascii_case(name))
            }),
        };
        let Some(at) = at else {
            let place = match &said.place {
                Place::Number(number) => format!("{number}: a row has {cells}"),
                Place::Name(name) => format!("\"{}\"", quote(name)),
            };
            let known = header.map_or_else(String::new, |header| listed(&header.heads));
            return Err(ReadError::NoColumn { line, place, known });
        };
        let unit = match (&said.unit, header) {
            (Some(unit), _) => Some(unit.clone()),
            (None, Some(header)) => unit_in(header, at, said.role)?,
            (None, None) => None,
        };
        Ok(Wanted { role: said.role, at, unit })
    };
    spec.0.iter().map(column).collect()
}

/// What a column of a header is: a deflection in units of force is the force.
fn role_of(header: &Header, at: usize, name: &str) -> Option<Role> {
    let role = Role::of(name)?;
    let unit = header.heads.get(at).and_then(|head| Unit::parse(head.1.as_deref()?, 0).ok());
    let is_force =
        unit.is_some_and(|unit| Role::Force.quantity().is_some_and(|q| q.dimension() == unit.dimension()));
    Some(if role == Role::Deflection && is_force { Role::Force } else { role })
}

/// The columns whose names in the header are known.
fn of_header(header: &Header, notes: &mut Vec<String>) -> Result<Vec<Wanted>, ReadError> {
    let mut wanted: Vec<Wanted> = Vec::new();
    for (at, (name, _)) in header.heads.iter().enumerate() {
        let Some(role) = role_of(header, at, name) else { continue };
        let Some(known) = wanted.iter_mut().find(|column| column.role == role) else {
            wanted.push(Wanted { role, at, unit: None });
            continue;
        };
        // Of two heights that of the sensor is the one that was reached.
        let better = name.to_lowercase().contains("measured");
        let (taken, left) = if better { (at, known.at) } else { (known.at, at) };
        known.at = taken;
        notes.push(format!(
            "columns {} and {} are both a {}: the {} is read, the other left out",
            taken.min(left) + 1,
            taken.max(left) + 1,
            role.word(),
            if taken < left { "first" } else { "second" }
        ));
    }
    for column in &mut wanted {
        column.unit = unit_in(header, column.at, column.role)?;
    }
    Ok(wanted)
}

/// Gives columns without a unit that of SI.
pub(super) fn in_si(wanted: &mut [Wanted]) {
    for column in wanted.iter_mut().filter(|column| column.unit.is_none()) {
        let si = column.role.quantity().and_then(crate::units::Quantity::si);
        column.unit = si.and_then(|si| Unit::parse(si, 0).ok());
    }
}

/// The names of a header, safe to show.
fn listed(heads: &[Head]) -> String {
    let names: Vec<String> = heads.iter().map(|(name, _)| format!("\"{}\"", quote(name))).collect();
    sanitize(&names.join(", "), 200)
}
