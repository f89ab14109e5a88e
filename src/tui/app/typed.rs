//! The lines typed on the command line, kept so that they can be recalled.

/// The most lines remembered.
const MOST: usize = 100;

/// The lines typed so far.
#[derive(Debug, Clone, Default)]
pub struct Typed {
    /// The lines, oldest first.
    pub(super) lines: Vec<String>,
    /// The index of the line shown; the number of lines for a new one.
    pub(super) at: usize,
    /// The new line, while an old one is shown.
    draft: String,
}

impl Typed {
    pub(super) fn remember(&mut self, line: &str) {
        self.lines.retain(|old| old != line);
        self.lines.push(line.to_owned());
        if self.lines.len() > MOST {
            self.lines.remove(0);
        }
    }

    /// The line before the one shown, or the one after it; `now` is the present text.
    pub(super) fn recall(&mut self, older: bool, now: &str) -> Option<String> {
        if self.at == self.lines.len() {
            now.clone_into(&mut self.draft);
        }
        let at = if older { self.at.checked_sub(1)? } else { self.at + 1 };
        if at > self.lines.len() {
            return None;
        }
        self.at = at;
        Some(self.lines.get(at).unwrap_or(&self.draft).clone())
    }
}
