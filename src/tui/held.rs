//! Which presses come from a key held down: a terminal reports no release, so the time between presses has to tell.

use crossterm::event::KeyEvent;
use std::time::{Duration, Instant};

/// A held key repeats within this time; a hand is slower.
const AGAIN: Duration = Duration::from_millis(110);
/// Its first repetition comes within this time: the longest usual delay.
const FIRST: Duration = Duration::from_millis(700);

/// The last key pressed.
#[derive(Debug, Default)]
pub(super) struct Held {
    last: Option<(KeyEvent, Instant)>,
    /// How long after the previous press of the same key it came.
    gap: Option<Duration>,
}

impl Held {
    /// How many presses before this one belong to the same hold of the key: 0 for a press by hand.
    pub(super) fn before(&mut self, key: KeyEvent, now: Instant) -> usize {
        let last = self.last.replace((key, now)).filter(|(last, _)| *last == key);
        let gap = last.map(|(_, at)| now.saturating_duration_since(at));
        let before = std::mem::replace(&mut self.gap, gap);
        match (before, gap) {
            // Only now is it certain that the previous press was not a second one by hand.
            (Some(before), Some(gap)) if gap <= AGAIN && before > AGAIN && before <= FIRST => 2,
            (_, Some(gap)) if gap <= AGAIN => 1,
            _ => 0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crossterm::event::KeyCode;

    #[test]
    fn a_key_held_is_told_from_presses_by_hand() {
        let (mut held, mut now) = (Held::default(), Instant::now());
        let mut press = |after: u64, c: char| {
            now += Duration::from_millis(after);
            held.before(KeyCode::Char(c).into(), now)
        };
        // By hand, then held, then another key, held from its first press on.
        let presses =
            [(0, ' '), (300, ' '), (300, ' '), (500, ' '), (33, ' '), (33, ' '), (33, 'n'), (33, 'n')];
        assert_eq!(presses.map(|(after, c)| press(after, c)), [0, 0, 0, 0, 2, 1, 0, 1]);
        assert_eq!([(5000, ' '), (900, ' '), (30, ' ')].map(|(after, c)| press(after, c)), [0, 0, 1]);
    }
}
