//! Which names a user's preset may have.

use super::shipped;
use pulloff_engine::text::quote;
use thiserror::Error;

/// The longest name.
const LONGEST: usize = 64;

/// Why a preset cannot have a name. The name in the error is already safe to show.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum NameError {
    /// It contains other characters, or too many.
    #[error(
        "\"{name}\" is not a preset name: use a-z, 0-9, - and _, first a letter or digit, at most {LONGEST} \
         characters (a path, which has a / or ends in .toml, is only read)"
    )]
    Malformed { name: String },
    /// It is the name of a command.
    #[error("\"{name}\" is a command, so no preset can have that name")]
    Command { name: String },
    /// It is the name of a preset that comes with the program.
    #[error("\"{name}\" comes with the program and is read-only: choose another name")]
    Shipped { name: String },
}

/// Whether a name has the form of a preset name: `[a-z0-9][a-z0-9_-]{0,63}`.
pub fn is_well_formed(name: &str) -> bool {
    let plain = |b: u8| b.is_ascii_lowercase() || b.is_ascii_digit();
    name.len() <= LONGEST
        && name.bytes().next().is_some_and(plain)
        && name.bytes().all(|b| plain(b) || b == b'-' || b == b'_')
}

/// Checks a name under which a preset is to be saved.
pub fn check<S: AsRef<str>>(name: &str, commands: &[S]) -> Result<(), NameError> {
    let shown = quote(name);
    if !is_well_formed(name) {
        Err(NameError::Malformed { name: shown })
    } else if commands.iter().any(|command| command.as_ref() == name) {
        Err(NameError::Command { name: shown })
    } else if shipped::find(name).is_some() {
        Err(NameError::Shipped { name: shown })
    } else {
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names() {
        for good in ["a", "9", "my-wave_2", &"x".repeat(64)] {
            assert_eq!(check(good, &["trace"]), Ok(()), "{good}");
        }
        for bad in ["", "-a", "_a", "A", "ä", "a b", "a.b", "..", "a/b", "a\n", &"x".repeat(65)] {
            assert!(matches!(check(bad, &["trace"]), Err(NameError::Malformed { .. })), "{bad:?}");
        }
        assert!(matches!(check("trace", &["trace"]), Err(NameError::Command { .. })));
        assert!(matches!(check("fig-9", &["trace"]), Err(NameError::Shipped { .. })));
        assert!(shipped::SHIPPED.iter().all(|shipped| is_well_formed(shipped.name)));
    }
}
