//! Commands as text: scripts, the line typed on the screen, and the journal share one grammar.
//!
//! A line is the name of a command from the [table](super::table::ROWS), followed by what it takes, as words separated
//! by spaces. A word that is empty or contains spaces or quotes is put in double quotes, in which `\"` and `\\` mean a
//! quote and a backslash; a quote may begin inside a word (`gap.wavelength="3 um"`). A word that begins with `#` begins
//! a comment.
//!
//! | line | does |
//! |---|---|
//! | `open PRESET [KEY=VALUE ...]` | opens a preset, by name or path, with other values |
//! | `set KEY=VALUE ...`, `set KEY VALUE` | other values, as one change; a bare number is SI in an SI preset |
//! | `control displacement`, `force`, `stiffness=K`, or nothing | what is controlled, or the next of them |
//! | `step [N]`, `step-length X`, `halve-step`, `double-step`, `reverse` | steps, their length, their direction |
//! | `next-event`, `run [N]`, `jump`, `restart` | as the keys with these names |
//! | `undo [N]`, `redo [N]` | N commands undone or redone |
//! | `undo N states`, `redo N states` | N single states along the walk, with their values |
//! | `move-to A`, `move-to event N`, `move-to S` | to the largest pull, an event of the path, a contact radius |
//! | `events`, `pin`, `pins D`, `pins all` | whose events are listed; curves pinned and removed |
//! | `export WHAT FILE [replace]` | writes `curve`, `walk`, `events`, `script`, `pull` or `study` |
//! | `export figure FILE [VIEW] [replace]`, `export screen FILE [replace]` | draws a view, the screen |
//! | `save [replace]`, `save-as NAME [with-data] [replace]` | saves the preset |
//! | `quit` | ends the script |
//!
//! A script refuses commands that change only what a screen shows (panels, views, the cross-hair, the help), and those
//! that depend on a selection there (`more`, `edit`). A line that begins with `try` may fail without ending the script.
//!
//! | file | what lives there |
//! |---|---|
//! | `lexer` | a line → words with their columns, and the quoting |
//! | [`arguments`] | what commands take, and how it is read |
//! | `keys` | short names of keys |
//! | [`offers`] | what can be typed there |
//! | `parse` | words → a command |
//! | `read` | the lines of a whole script |
//! | `print` | a command → its line |
//! | `fault` | what can be wrong with a line |
//! | `palette` | the list of what a line could become |
//! | [`mod@play`] | a script run on a model, without a terminal |
//! | `permissions` | where a script may write |

pub mod arguments;
mod fault;
mod keys;
mod lexer;
pub mod offers;
mod palette;
mod parse;
mod permissions;
pub mod play;
mod print;
mod read;

pub use fault::{LONGEST, ScriptFault};
pub(super) use keys::key_called;
/// The first line of a script that a session writes.
pub(super) const HEAD: &str =
    "# A session of pulloff: `pulloff run` walks it again, `pulloff run -v` tells every step.";
pub use palette::{PaletteEntry, palette};
pub use parse::{for_script, parse};
pub use permissions::Permission;
pub use play::{Failed, play};
pub use print::line;
pub use read::{LARGEST, MOST_LINES, ScriptError, ScriptLine, read};

#[cfg(test)]
mod tests;
