//! The key table as Markdown, for the manual.

use super::schema::PARAMETERS;
use std::fmt::Write;

/// One row per key: key, symbol, meaning with its dimension, values, default.
#[must_use]
pub fn key_table() -> String {
    let mut text = String::from("| key | on screen | meaning | values | default |\n|---|---|---|---|---|\n");
    for row in PARAMETERS {
        let dimension =
            if row.dimension.is_empty() { String::new() } else { format!(" ({})", row.dimension) };
        // Writing to a string cannot fail.
        let _ = writeln!(
            text,
            "| `{}` | {} | {}{dimension} | {} | {} |",
            row.key,
            row.label,
            row.meaning,
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
        assert_eq!(text.lines().count(), PARAMETERS.len() + 2);
        assert!(text.lines().all(|line| line.matches('|').count() == 6), "{text}");
    }
}
