//! The lines of a session of before, as they read now.
//!
//! In the first version `undo` and `redo` went by single states of the walk, and `undo-command` by whole commands; in the
//! second `undo` takes a command back. A script that a session wrote says its version in its first line; a session has
//! the version in its format. A script written by hand is of the newest.

use super::lexer::{quoted, split};
use crate::explorer::command::{Id, row_of};
use pulloff_engine::preset::former::assignment;
use std::borrow::Cow;

/// The lines of a session without keys and words of before, and why they do not lead where they did, if they do not.
///
/// A line that set nothing else is left out. The state solved again there was the one before it, so walks go on from the
/// same place; only a step back over such a line would now go back over another.
pub fn without_former(lines: Vec<String>) -> (Vec<String>, Option<String>) {
    let mut left_out = None;
    let mut goes_back = false;
    let mut kept = Vec::with_capacity(lines.len());
    for line in lines {
        goes_back |= left_out.is_some() && is_travel(&line);
        match rewritten(&line) {
            Some(line) => kept.push(line.into_owned()),
            None => left_out = Some(line),
        }
    }
    let broken = left_out.filter(|_| goes_back).map(|line| {
        format!("the walk goes back over \"{line}\", which has no meaning any more: the exact basis needs no functions")
    });
    (kept, broken)
}

/// The first line of a script that a session writes.
pub const HEAD: &str = "# A session of pulloff, version 2: `pulloff run` walks it again.";
/// The same of the first version.
const FIRST_HEAD: &str = "# A session of pulloff: `pulloff run` walks it again.";
/// What the first version called the command that took a whole command back.
pub(super) const UNDO_COMMAND: &str = "undo-command";

/// Whether a script was written by a session of the first version.
pub(super) fn is_first_version(text: &str) -> bool {
    text.lines().next().is_some_and(|line| line.trim_end() == FIRST_HEAD)
}

/// A line of the first version as it reads now.
pub fn by_states(line: &str) -> Cow<'_, str> {
    let bare = line.split('#').next().unwrap_or_default();
    match bare.split_whitespace().collect::<Vec<_>>()[..] {
        [name] if name == row_of(Id::Undo).name || name == row_of(Id::Redo).name => {
            format!("{name} 1 states").into()
        }
        [UNDO_COMMAND] => row_of(Id::Undo).name.into(),
        _ => line.into(),
    }
}

/// Whether a line goes to a state made before.
fn is_travel(line: &str) -> bool {
    [Id::Undo, Id::Redo, Id::Branches]
        .into_iter()
        .any(|id| line.split(' ').next().is_some_and(|name| name == row_of(id).name))
}

/// A line with its assignments as they read now; `None` where nothing is left of it.
fn rewritten(line: &str) -> Option<Cow<'_, str>> {
    // What cannot be split was not written by a session; it is as it was.
    let Ok(words) = split(line) else { return Some(line.into()) };
    let now: Vec<Option<Cow<'_, str>>> = words.iter().map(|word| assignment(&word.text)).collect();
    if words.iter().zip(&now).all(|(word, now)| now.as_deref() == Some(&*word.text)) {
        return Some(line.into());
    }
    let has_assignment = now.iter().flatten().any(|word| word.contains('='));
    let words: Option<Vec<String>> = now.iter().flatten().map(|word| quoted(word)).collect();
    Some(words.filter(|_| has_assignment)?.join(" ").into())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn now(lines: &[&str]) -> (Vec<String>, Option<String>) {
        without_former(lines.iter().map(|line| (*line).to_owned()).collect())
    }

    #[test]
    fn words_of_before_read_as_they_do_now_and_the_others_stay() {
        let (lines, broken) = now(&[
            "step 3",
            "set basis.functions=60",
            "try set basis.functions=9",
            "set basis.kind=spectral \"title=a basis.functions=7\" basis.functions=48",
            "set \"title=basis.kind=spectral\"",
            "open fig-9 basis.functions=auto gap.amplitude=0.002",
            "next-limit",
        ]);
        assert_eq!(
            lines,
            [
                "step 3",
                "set basis.kind=exact \"title=a basis.functions=7\"",
                "set \"title=basis.kind=spectral\"",
                "open fig-9 gap.amplitude=0.002",
                "next-limit",
            ]
        );
        assert_eq!(broken, None);
    }

    #[test]
    fn undo_of_the_first_version_goes_by_states() {
        for (line, reads) in [
            ("undo", "undo 1 states"),
            (" redo  # forward", "redo 1 states"),
            ("undo-command", "undo"),
            ("set title=undo", "set title=undo"),
            ("try undo", "try undo"),
        ] {
            assert_eq!(by_states(line), reads);
        }
    }

    #[test]
    fn a_step_back_over_a_line_that_is_left_out_is_said() {
        let (lines, broken) = now(&["step 3", "undo", "set basis.functions=60", "step 2", "undo"]);
        assert_eq!(lines, ["step 3", "undo", "step 2", "undo"]);
        assert!(broken.is_some_and(|why| why.contains("set basis.functions=60")));
    }
}
