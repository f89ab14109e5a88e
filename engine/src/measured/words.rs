//! Words and cells: what a line says besides its numbers, and what a cell is.

use super::names::named;
use super::role::{ColumnRole, Segment, unit_named};
use crate::cells::{ColumnHead, Separator, heads};
use crate::units::Unit;

/// A line of words.
#[derive(Debug, Clone, Copy)]
pub(super) struct Words<'a> {
    /// Its number, from 1.
    pub line: usize,
    /// Its text, without the mark of a remark.
    pub text: &'a str,
    /// Whether it is a remark.
    pub is_remark: bool,
}

/// The value behind `key` in a remark such as `columns: height vDeflection`.
pub(super) fn keyed<'a>(words: &Words<'a>, key: &str) -> Option<&'a str> {
    let (before, value) = words.text.split_once(':')?;
    before.trim().eq_ignore_ascii_case(key).then(|| value.trim())
}

/// Whether a remark begins another table: JPK writes one for each segment.
pub(super) fn parts_tables(remark: &str) -> bool {
    let words = Words { line: 0, text: remark, is_remark: true };
    ["segment", "segmentIndex", "columns"].iter().any(|key| keyed(&words, key).is_some())
}

/// Whether a cell means that nothing was measured: empty, not a number, or beyond the range of the instrument.
pub(super) fn is_gap(cell: &str) -> bool {
    const WORDS: &str = "num div/0 value ref nan na n/a null none inf infinity overload overrange overflow \
         ovld ovl ol saturated sat nan(ind) 1.#qnan 1.#ind 1.#inf missing invalid";
    let cell = cell.trim_start_matches(['-', '+', '#', '*']).trim_end_matches('!');
    cell.is_empty() || WORDS.split(' ').chain(["out of range"]).any(|word| cell.eq_ignore_ascii_case(word))
}

/// Whether a cell is a number, with a decimal point or comma.
pub(super) fn is_number(cell: &str) -> bool {
    let mut digits = cell.strip_prefix(['-', '+', '\u{2212}']).unwrap_or(cell);
    if !digits.starts_with(|c: char| c.is_ascii_digit() || c == '.' || c == ',') {
        return false;
    }
    if let Some(at) = digits.find(['e', 'E', 'd', 'D']) {
        let exponent = digits[at + 1..].trim_start_matches(['-', '+']);
        if exponent.is_empty() || !exponent.bytes().all(|byte| byte.is_ascii_digit()) {
            return false;
        }
        digits = &digits[..at];
    }
    digits.bytes().filter(|byte| !byte.is_ascii_digit()).count() <= 1
        && digits.bytes().all(|byte| byte.is_ascii_digit() || byte == b'.' || byte == b',')
        && digits.bytes().any(|byte| byte.is_ascii_digit())
}

/// Whether a cell is a number whose thousands are separated.
pub(super) fn is_grouped(cell: &str) -> bool {
    let is_of_number = |c: char| c.is_ascii_digit() || matches!(c, '.' | ',' | '\'' | ' ' | '-' | '+');
    let has_digits = |part: &str| !part.is_empty() && part.bytes().all(|byte| byte.is_ascii_digit());
    let parts: Vec<&str> = cell.trim_start_matches(['-', '+']).split(['.', ',', '\'', ' ']).collect();
    cell.chars().all(is_of_number) && parts.len() > 2 && parts.into_iter().all(has_digits)
}

/// Whether a cell is the name of a branch, spelt in letters.
pub(super) fn is_branch(cell: &str) -> bool {
    cell.starts_with(char::is_alphabetic) && Segment::of(cell).is_some()
}

/// Whether a cell is a time or a date.
pub(super) fn is_stamp(cell: &str) -> bool {
    cell.starts_with(|c: char| c.is_ascii_digit())
        && cell.contains([':', '/', '-'])
        && cell.chars().all(|c| c.is_ascii_digit() || ":/-.,TZ".contains(c))
}

/// The place of the last digit of a number: 0.01 for 1.23, 1e-9 for 12e-9.
pub(super) fn last_digit(text: &str) -> f64 {
    let (mantissa, exponent) = text.split_once(['e', 'E']).unwrap_or((text, "0"));
    let decimals = mantissa.split_once('.').map_or(0, |(_, decimals)| decimals.len());
    let exponent: i32 = exponent.parse().unwrap_or(0);
    10.0_f64.powi(exponent.saturating_sub(i32::try_from(decimals).unwrap_or(i32::MAX)).clamp(-300, 300))
}

/// How many columns of a header are known.
pub(super) fn count_known(heads: &[ColumnHead]) -> usize {
    heads.iter().filter(|(name, _)| named(name).is_some()).count()
}

/// How a row with a fault in its first cell is separated, below a header with at least a force and an x.
pub(super) fn row_under(above: &[Words], text: &str) -> Option<(Separator, usize)> {
    let names =
        above.iter().rev().find(|words| !words.is_remark && !is_units(words.text, Separator::of(text)))?;
    let separator = Separator::of(names.text);
    let heads = heads(names.text, separator, &super::role::dimensions());
    let cells = separator.cells(text);
    let has = |is: &dyn Fn(ColumnRole) -> bool| {
        heads.iter().any(|(name, _)| named(name).is_some_and(|named| is(named.role)))
    };
    let is = heads.len() == cells.len()
        && has(&ColumnRole::is_force)
        && has(&ColumnRole::is_way)
        && cells.iter().any(|cell| is_number(cell));
    (is && cells.iter().skip(1).all(|cell| is_number(cell) || is_gap(cell) || Segment::of(cell).is_some()))
        .then_some((separator, cells.len()))
}

/// The cells of a line of units, with brackets removed.
pub(super) fn unit_cells(line: &str, separator: Separator) -> Vec<&str> {
    let cells = separator.cells(line);
    let cells = if cells.len() > 1 { cells } else { Separator::of(line).cells(line) };
    cells.into_iter().map(|cell| cell.trim_matches(['(', ')', '[', ']'])).collect()
}

/// Whether a line has units and nothing else: at least a length, a force or an area, and no name of a column.
pub(super) fn is_units(line: &str, separator: Separator) -> bool {
    /// The longest unit, in bytes: the other units may be of unknown quantities.
    const LONGEST: usize = 10;
    let cells = unit_cells(line, separator);
    let is_ours = |cell: &&str| {
        unit_named(cell, true).is_some_and(|unit| super::role::dimensions().contains(&unit.dimension()))
    };
    let is_unit = |cell: &&str| {
        cell.is_empty()
            || *cell == "-"
            || Unit::parse(cell, 0).is_ok()
            || is_ours(cell)
            || (cell.len() <= LONGEST && named(cell).is_none() && !cell.contains(char::is_whitespace))
    };
    cells.len() > 1 && cells.iter().any(is_ours) && cells.iter().all(is_unit)
}
