//! Keys and pastes → commands; replies → model; and whatever lies over the screen.
//!
//! | file | what lives there |
//! |---|---|
//! | `choose` | lists, filtered by what is typed |
//! | `columns` | the columns of a measured curve, chosen from lists |
//! | `files` | requests for names and paths: saving, exporting, copying |
//! | `gap` | the shape, the formula and the profile of the gap |
//! | `help` | the help, and searching it for a word |
//! | `line` | commands typed by name |
//! | `mouse` | clicks and the wheel |
//! | `keys` | keys, prompts, questions |
//! | `state` | the app |
//! | `typed` | the lines typed earlier |
//! | `session` | the offer of a session, the branches of the walk |

mod choose;
mod columns;
mod files;
mod gap;
mod help;
mod keys;
mod line;
mod mouse;
mod session;
mod state;
mod typed;

pub use state::App;
