//! Whether there is a terminal to draw on.

use std::{
    env,
    ffi::OsStr,
    io::{self, IsTerminal},
    path::{Path, PathBuf},
};

/// Families of terminals that understand the sequences used here, by the part of TERM before the first `-`, `.` or `+`.
///
/// A machine reached over SSH often has no description of the user's terminal, so the description alone cannot decide.
const FAMILIES: &str = "\
    alacritty ansi contour cygwin dvtm eterm foot ghostty gnome iterm iterm2 jfbterm kitty konsole linux \
    mintty mlterm ms nsterm putty rio rxvt screen st stterm teraterm terminator termite tmux vscode \
    vt100 vt102 vt220 vt320 vt420 vt520 vte wezterm xfce xterm zellij";

/// Names that mean "nothing is known", whatever the machine's descriptions say.
const NAMELESS: &[&str] = &["", "dumb", "unknown", "network", "dialup", "emacs", "lpr", "printer"];

/// Why the program cannot run on this terminal, as one line for standard error; `None` if it can.
///
/// Standard input and output must be a terminal, and TERM must name one that moves its cursor. Nothing is written and
/// nothing is asked of the terminal.
pub fn refuse_reason() -> Option<String> {
    let why = if !io::stdin().is_terminal() {
        "standard input is not one".to_owned()
    } else if !io::stdout().is_terminal() {
        "standard output is not one".to_owned()
    } else {
        unfit(env::var_os("TERM").as_deref(), described)?
    };
    Some(format!("{} needs a terminal: {why}", env!("CARGO_PKG_NAME")))
}

/// Whether the locale says that the terminal shows UTF-8; if not, draw with ASCII only.
pub fn utf8_locale() -> bool {
    // The first one that is set and not empty decides, as in setlocale(3).
    let locale = ["LC_ALL", "LC_CTYPE", "LANG"]
        .iter()
        .filter_map(env::var_os)
        .find(|value| !value.is_empty())
        .unwrap_or_default()
        .to_string_lossy()
        .to_ascii_lowercase();
    locale.contains("utf-8") || locale.contains("utf8")
}

/// Why a TERM cannot be used; `None` if it can.
fn unfit(term: Option<&OsStr>, described: impl Fn(&str) -> bool) -> Option<String> {
    let Some(term) = term else {
        return Some("TERM is not set".to_owned());
    };
    let term = term.to_string_lossy();
    let family = term.split(['-', '.', '+']).next().unwrap_or_default().to_ascii_lowercase();
    let is_known = FAMILIES.split_whitespace().any(|name| name == family);
    if NAMELESS.contains(&family.as_str()) || !(is_known || described(&term)) {
        // The value is foreign text: shown escaped and shortened.
        let shown: String = term.chars().take(40).flat_map(char::escape_default).collect();
        return Some(format!("TERM is \"{shown}\", which it does not know how to draw on"));
    }
    None
}

/// Whether the machine has a terminfo description of that name; its contents are not read.
fn described(term: &str) -> bool {
    let Some(first) = term.chars().next().filter(char::is_ascii_alphanumeric) else {
        return false;
    };
    if term.contains('/') {
        return false;
    }
    let own = env::var_os("TERMINFO").map(PathBuf::from);
    let home = env::var_os("HOME").map(|home| Path::new(&home).join(".terminfo"));
    let common = ["/etc/terminfo", "/lib/terminfo", "/usr/share/terminfo", "/usr/local/share/terminfo"];
    own.into_iter().chain(home).chain(common.map(PathBuf::from)).any(|root| {
        // Some systems name the directory by the letter, others by its code.
        [first.to_string(), format!("{:x}", u32::from(first))]
            .iter()
            .any(|directory| root.join(directory).join(term).is_file())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_families_and_described_terminals_are_accepted() {
        for term in [
            "xterm-256color",
            "tmux-256color",
            "screen.xterm-256color",
            "linux",
            "vt100",
            "xterm-kitty",
            "st",
        ] {
            assert_eq!(unfit(Some(OsStr::new(term)), |_| false), None, "{term}");
        }
        assert_eq!(unfit(Some(OsStr::new("wy60")), |_| true), None);
    }

    #[test]
    fn nameless_and_unknown_terminals_are_refused() {
        assert_eq!(unfit(None, |_| true).unwrap(), "TERM is not set");
        for term in ["", "dumb", "dumb-emacs", "unknown"] {
            assert!(unfit(Some(OsStr::new(term)), |_| true).is_some(), "{term}");
        }
        assert!(unfit(Some(OsStr::new("nonesuch-9")), |_| false).is_some());
    }

    #[test]
    fn a_hostile_name_is_shown_escaped_and_short() {
        let shown = unfit(Some(OsStr::new(&format!("\x1b]0;x\x07{}", "y".repeat(500)))), |_| false).unwrap();
        assert!(!shown.contains('\x1b') && shown.len() < 200, "{shown}");
    }

    #[test]
    fn a_name_with_a_path_in_it_is_not_looked_up() {
        assert!(!described("x/../x/xterm"));
        assert!(!described(""));
    }
}
