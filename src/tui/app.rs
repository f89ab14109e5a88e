//! Keys and pastes → commands; replies → model; what lies over the screen.
//!
//! | file | what lives there |
//! |---|---|
//! | `choose` | lists: what is typed filters them |
//! | `columns` | the columns of a measured curve, chosen from lists |
//! | `files` | names and paths asked for: saving, exporting, copying |
//! | `gap` | the shape, the formula and the profile of the gap |
//! | `help` | the help, and looking for a word in it |
//! | `line` | commands typed by name |
//! | `mouse` | clicks and the wheel |
//! | `state` | the app: keys, prompts, questions |
//! | `typed` | the lines typed before |
//! | `session` | the offer of a session, the branches of the walk |

mod choose;
mod columns;
mod files;
mod gap;
mod help;
mod line;
mod mouse;
mod session;
mod state;
mod typed;

pub use state::App;
