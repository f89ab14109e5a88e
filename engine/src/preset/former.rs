//! Keys and words of before: what to write for them now.
//!
//! A preset that a person keeps is theirs to change, so what it says is refused with the line to write. A session is the
//! program's own: what its presets say is read as it was meant.

use super::invalid::Invalid;
use super::schema::{CHOOSERS, EXACT};
use std::borrow::Cow;
use toml::de::DeValue;

/// The word of `basis.kind` that was [`EXACT`].
const SPECTRAL: &str = "spectral";
/// The number of eigenfunctions, which nothing has any more.
const FUNCTIONS: &str = "basis.functions";

/// Why a key of before is refused.
#[must_use]
pub fn key(key: &str) -> Option<Invalid> {
    (key == FUNCTIONS).then_some(Invalid::Former {
        was: FUNCTIONS,
        now: "is no longer needed: the exact basis resolves every gap by itself; remove it and write kind = \"exact\" \
              (basis.kind=exact in an assignment)",
    })
}

/// Why a word of before is refused as the value of `key`.
pub(super) fn word(key: &str, word: &str) -> Option<Invalid> {
    is_former_word(key, word).then_some(Invalid::Former {
        was: "basis.kind = \"spectral\"",
        now: "is called \"exact\" now: write kind = \"exact\" (basis.kind=exact in an assignment)",
    })
}

fn is_former_word(key: &str, word: &str) -> bool {
    (key, word) == (CHOOSERS[1], SPECTRAL)
}

/// The assignment `KEY=VALUE` of a session as it reads now, `None` where it says nothing any more; another text is as it
/// was.
pub fn assignment(text: &str) -> Option<Cow<'_, str>> {
    match text.split_once('=') {
        Some((FUNCTIONS, _)) => None,
        Some((key, word)) if is_former_word(key, word) => Some(format!("{key}={EXACT}").into()),
        _ => Some(text.into()),
    }
}

/// What a key and its value of before are to a preset of a session.
pub(super) enum Kept {
    /// This word.
    Word(&'static str),
    /// Nothing: what it said is no longer asked.
    Dropped,
}

/// What became of a key with this value, where that is of before.
pub(super) fn kept(key: &str, value: &DeValue<'_>) -> Option<Kept> {
    match value {
        DeValue::String(word) if is_former_word(key, word) => Some(Kept::Word(EXACT)),
        _ if key == FUNCTIONS => Some(Kept::Dropped),
        _ => None,
    }
}
