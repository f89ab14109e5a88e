//! The keys in the order in which a reader meets them, and their table as Markdown, for the manual.

use super::family;
use super::groups;
use super::schema::{PARAMETERS, Parameter};
use std::fmt::Write;

/// All keys; those of families by examples, such as `gap.waves.N.phase`.
pub fn keys() -> impl Iterator<Item = Parameter> {
    let shape = PARAMETERS.iter().rposition(|row| row.table() == Some("gap")).map_or(0, |last| last + 1);
    let (before, after) = PARAMETERS.split_at(shape);
    before
        .iter()
        .cloned()
        .chain(family::examples())
        .chain(after.iter().cloned())
        .chain(groups::GROUPS.iter().cloned())
}

/// What a key means, with its dimension.
pub fn meaning(row: &Parameter) -> String {
    if row.dimension.is_empty() {
        row.meaning.to_string()
    } else {
        format!("{} ({})", row.meaning, row.dimension)
    }
}

/// One row per key: key, symbol, meaning with its dimension, values, default.
pub fn key_table() -> String {
    let mut text = String::from("| key | on screen | meaning | values | default |\n|---|---|---|---|---|\n");
    for row in keys() {
        // Writing to a string cannot fail.
        let _ = writeln!(
            text,
            "| `{}` | {} | {} | {} | {} |",
            row.key,
            row.label,
            meaning(&row),
            row.allowed(),
            row.fallback_text()
        );
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_key_has_a_row_of_five_cells() {
        let text = key_table();
        assert_eq!(
            text.lines().count(),
            PARAMETERS.len() + family::examples().count() + groups::GROUPS.len() + 2
        );
        assert!(text.lines().all(|line| line.matches('|').count() == 6), "{text}");
    }
}
