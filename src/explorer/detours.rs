//! The lines of a session without the walks that were undone: a detour that nothing later needs leaves no lines.
//!
//! A line that made some states and the undo of as many states cancel each other; steps are shortened. If a later line
//! redoes what was undone, or goes to a state by its numbers, all lines stay, because it may need the states left out.

use super::command::{Command, Id};
use super::script;

/// A longer walk forgets some of its states, so an undo of N states need not take back N of those that were made.
const LONGEST: usize = 4000;

/// A line, and how many states it made; `None` if that is not known.
pub type MadeLine = (String, Option<usize>);

/// What a line does, as far as it matters here.
enum LineKind {
    /// Steps, which can be shortened.
    Steps,
    /// Another walk, which is left out whole or not at all.
    Walk,
    /// A reversal or another step length: an undo leaves it unchanged.
    Way,
    /// Values: an undo of states takes them back only if they made a state.
    Values,
    /// This many states undone.
    Undo(usize),
    /// Something that needs what was undone.
    Needs,
}

fn kind(line: &str) -> LineKind {
    let words: Vec<&str> = line.split(' ').collect();
    match (Id::called(words[0]), &words[1..]) {
        (Some(Id::Step), _) => LineKind::Steps,
        (Some(Id::Run | Id::NextEvent | Id::Jump), _) => LineKind::Walk,
        (Some(Id::Reverse | Id::StepLength), _) => LineKind::Way,
        (Some(Id::Undo), [count, "states"]) => count.parse().map_or(LineKind::Needs, LineKind::Undo),
        (Some(Id::Undo | Id::Redo | Id::Branches), _) => LineKind::Needs,
        _ => LineKind::Values,
    }
}

/// The lines without what was undone for good.
pub fn without_detours(lines: &[MadeLine]) -> Vec<String> {
    let all = || lines.iter().map(|(line, _)| line.clone()).collect();
    if lines.iter().filter_map(|(_, made)| *made).sum::<usize>() > LONGEST {
        return all();
    }
    let mut kept: Vec<(String, Option<usize>, LineKind)> = Vec::new();
    for (line, made) in lines {
        let kind = kind(line);
        if matches!(kind, LineKind::Needs) {
            return all();
        }
        match kind {
            LineKind::Undo(count) if take_back(&mut kept, count) => {}
            kind => kept.push((line.clone(), *made, kind)),
        }
    }
    kept.into_iter().map(|(line, ..)| line).collect()
}

/// Leaves out what made the last `count` states; returns false and changes nothing if that cannot be determined.
fn take_back(kept: &mut Vec<(String, Option<usize>, LineKind)>, count: usize) -> bool {
    let mut left = count;
    let mut out = Vec::new();
    let mut shortened = None;
    for (at, (_, made, kind)) in kept.iter().enumerate().rev() {
        if left == 0 {
            break;
        }
        match (kind, made) {
            (LineKind::Way, _) => {}
            (LineKind::Steps | LineKind::Walk, Some(made)) if *made <= left => {
                left -= made;
                out.push(at);
            }
            (LineKind::Steps, Some(made)) => {
                shortened = Some((at, made - left));
                left = 0;
            }
            _ => return false,
        }
    }
    if left > 0 {
        return false;
    }
    if let Some((at, steps)) = shortened
        && let Some(line) = script::line(&Command::Steps(steps))
    {
        kept[at] = (line, Some(steps), LineKind::Steps);
    }
    // From the last to the first, so that the earlier indices stay valid.
    for at in out {
        kept.remove(at);
    }
    true
}

#[cfg(test)]
mod tests {
    use super::*;

    fn without(lines: &[(&str, usize)]) -> Vec<String> {
        let lines: Vec<MadeLine> =
            lines.iter().map(|(line, made)| ((*line).to_owned(), Some(*made))).collect();
        without_detours(&lines)
    }

    #[test]
    fn what_was_taken_back_for_good_leaves_nothing() {
        assert_eq!(without(&[("step 6", 6), ("undo 2 states", 0), ("jump", 1)]), ["step 4", "jump"]);
        assert_eq!(without(&[("next-event", 9), ("jump", 1), ("undo 1 states", 0)]), ["next-event"]);
        assert_eq!(
            without(&[("next-event", 9), ("jump", 1), ("undo 10 states", 0), ("step 1", 1)]),
            ["step 1"]
        );
        // What turns the walk stays: an undo does not reverse it.
        let turned = [("step 2", 2), ("reverse", 0), ("step 3", 3), ("undo 4 states", 0)];
        assert_eq!(without(&turned), ["step 1", "reverse"]);
        assert_eq!(
            without(&[("step 1", 1), ("undo 1 states", 0), ("step 2", 2), ("undo 1 states", 0)]),
            ["step 1"]
        );
    }

    #[test]
    fn what_is_not_known_or_needed_later_stays() {
        for lines in [
            &[("step 2", 2), ("undo 1 states", 0), ("redo 1 states", 0)][..],
            // A walk is left out whole or not at all.
            &[("next-event", 9), ("undo 2 states", 0)],
            &[("step 2", 2), ("set gap.amplitude=0.003", 1), ("undo 1 states", 0)],
            &[("undo 1 states", 0)],
        ] {
            let whole: Vec<&str> = lines.iter().map(|(line, _)| *line).collect();
            assert_eq!(without(lines), whole);
        }
        assert_eq!(
            without_detours(&[("step 2".to_owned(), None), ("undo 1 states".to_owned(), Some(0))]).len(),
            2
        );
    }
}
