//! A line → words with their columns, and the quoting that makes a text one word again.

use super::fault::{LONGEST, ScriptFault};
use pulloff_engine::text::is_unsafe;

/// A word of a line.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Word {
    pub text: String,
    /// Where it begins, counted in characters from 1.
    pub column: usize,
}

/// The words of a line, without its comment.
pub(super) fn split(line: &str) -> Result<Vec<Word>, ScriptFault> {
    if line.chars().nth(LONGEST).is_some() {
        return Err(ScriptFault::new(LONGEST + 1, format!("a line has at most {LONGEST} characters")));
    }
    let mut words = Vec::new();
    let mut word: Option<Word> = None;
    let mut quote: Option<usize> = None;
    let mut chars = line.chars().zip(1..);
    while let Some((c, column)) = chars.next() {
        if is_unsafe(c) && (c != '\t' || quote.is_some()) {
            return Err(ScriptFault::new(column, "a control or invisible character"));
        }
        match (c, quote) {
            ('#', None) if word.is_none() => break,
            (' ' | '\t', None) => words.extend(word.take()),
            _ => {
                let word = word.get_or_insert_with(|| Word { text: String::new(), column });
                match (c, quote) {
                    ('"', None) => quote = Some(column),
                    ('"', Some(_)) => quote = None,
                    ('\\', Some(_)) => match chars.next() {
                        Some((c @ ('"' | '\\'), _)) => word.text.push(c),
                        _ => {
                            return Err(ScriptFault::new(column, "in quotes \\ may only precede \" or \\"));
                        }
                    },
                    (c, _) => word.text.push(c),
                }
            }
        }
    }
    if let Some(column) = quote {
        return Err(ScriptFault::new(column, "the quote is not closed"));
    }
    words.extend(word);
    Ok(words)
}

/// `text` as a word, or as the rest of one; `None` if no line can contain it.
pub(super) fn quoted(text: &str) -> Option<String> {
    if text.chars().any(is_unsafe) {
        return None;
    }
    let plain = !text.is_empty() && !text.starts_with('#') && !text.contains([' ', '"']);
    Some(if plain {
        text.to_owned()
    } else {
        format!("\"{}\"", text.replace('\\', "\\\\").replace('"', "\\\""))
    })
}
