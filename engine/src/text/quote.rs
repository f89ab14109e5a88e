//! Foreign text made safe to show: no control character, no hidden and no direction-changing character gets through.

use std::fmt;
use std::path::Path;

/// How much of a foreign text a message quotes, in characters.
pub const QUOTED: usize = 40;
/// How much of a path a message shows, in characters.
pub const PATH: usize = 120;

/// Whether a character must not reach a terminal: control characters, and Unicode's invisible formatting (direction
/// overrides, zero-width characters, separators, tags).
pub fn is_unsafe(c: char) -> bool {
    c.is_control()
        || matches!(
            c,
            '\u{00AD}'
                | '\u{061C}'
                | '\u{180E}'
                | '\u{200B}'..='\u{200F}'
                | '\u{2028}'..='\u{202E}'
                | '\u{2060}'..='\u{206F}'
                | '\u{FEFF}'
                | '\u{FFF9}'..='\u{FFFB}'
                | '\u{E0000}'..='\u{E007F}'
        )
}

/// `text` with unsafe characters replaced, cut at the end to at most `max` characters.
pub fn sanitize(text: &str, max: usize) -> String {
    let safe = |c: char| if is_unsafe(c) { char::REPLACEMENT_CHARACTER } else { c };
    if text.chars().nth(max).is_none() {
        return text.chars().map(safe).collect();
    }
    let mut short: String = text.chars().take(max.saturating_sub(3)).map(safe).collect();
    short.push_str("...");
    short
}

/// A count with its noun: 1 row, 2 rows.
pub fn counted<N: fmt::Display + PartialEq + From<u8> + Copy>(count: N, noun: &str) -> String {
    if count == N::from(1) { format!("1 {noun}") } else { format!("{count} {noun}s") }
}

/// A label from the parameter table with its Greek letters.
pub fn greek(label: &str) -> String {
    label.replace("gamma", "γ").replace("lambda", "λ").replace("delta", "δ")
}

/// One fault a line: a handful of them, and how many more there are.
pub fn listed(faults: impl Iterator<Item = impl fmt::Display>) -> String {
    const MOST: usize = 5;
    let mut lines: Vec<String> = faults.map(|fault| fault.to_string()).collect();
    let more = lines.len().saturating_sub(MOST);
    lines.truncate(MOST);
    lines.extend((more > 0).then(|| format!("and {more} more")));
    lines.join("\n")
}

/// A quotation of foreign text for a message.
pub fn quote(text: &str) -> String {
    sanitize(text, QUOTED)
}

/// A path for a message; a long path keeps its end, which names the file.
pub fn show_path(path: &Path) -> String {
    show_name(&path.to_string_lossy())
}

/// A file's name for a message, shortened as in [`show_path`].
pub fn show_name(name: &str) -> String {
    let surplus = name.chars().count().saturating_sub(PATH);
    if surplus == 0 {
        return sanitize(name, PATH);
    }
    let end: String = name.chars().skip(surplus + 3).collect();
    format!("...{}", sanitize(&end, PATH))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_unsafe_and_nothing_long_leaves() {
        assert_eq!(quote("wavy"), "wavy");
        assert_eq!(quote("a\x1b[2Jb\u{202e}c\n\u{9b}"), "a\u{fffd}[2Jb\u{fffd}c\u{fffd}\u{fffd}");
        assert_eq!(quote(&"x".repeat(40)), "x".repeat(40));
        assert_eq!(quote(&"x".repeat(41)), format!("{}...", "x".repeat(37)));
        let long = format!("/{}/end.toml", "d".repeat(300));
        let shown = show_path(Path::new(&long));
        assert!(shown.ends_with("/end.toml") && shown.starts_with("...") && shown.chars().count() == PATH);
    }
}
