//! Commands named in sentences, which are written where the keys are not known.
//!
//! A sentence holds the command itself ([`Id::named`]). Whatever shows it knows what the command is called there: the
//! terminal its key, a script its name.

use super::Id;

/// Encloses the name of a command. No text from outside contains it: it is a control character, and those are replaced.
const MARK: char = '\u{1}';

impl Id {
    /// This command within a sentence.
    pub fn named(self) -> String {
        format!("{MARK}{}{MARK}", self.name())
    }
}

/// The sentence as shown, with what each of its commands is called.
pub fn spelled(sentence: &str, called: impl Fn(Id) -> String) -> String {
    let mut parts = sentence.split(MARK);
    let mut text = parts.next().unwrap_or_default().to_owned();
    // A name and the text after it, in turn.
    while let Some(name) = parts.next() {
        match Id::called(name) {
            Some(id) => text.push_str(&called(id)),
            None => text.push_str(name),
        }
        text.push_str(parts.next().unwrap_or_default());
    }
    text
}

/// A sentence with the names of its commands, for places without keys.
pub fn by_name(sentence: &str) -> String {
    spelled(sentence, |id| id.name().to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;
    use pulloff_engine::text::sanitize;

    #[test]
    fn commands_are_called_what_the_reader_calls_them() {
        let sentence = format!("{} goes back, {} restarts", Id::Undo.named(), Id::Restart.named());
        assert_eq!(by_name(&sentence), "undo goes back, restart restarts");
        let key = |id| if id == Id::Undo { "u".to_owned() } else { ":restart".to_owned() };
        assert_eq!(spelled(&sentence, key), "u goes back, :restart restarts");
        for plain in ["", "no command", "{undo} is a file's name"] {
            assert_eq!(spelled(plain, key), plain);
        }
        // Text from outside names no command.
        assert_eq!(spelled(&sanitize("a\u{1}undo\u{1}b", 40), key), "a\u{fffd}undo\u{fffd}b");
    }
}
