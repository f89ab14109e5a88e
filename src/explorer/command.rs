//! Commands: their identities, which come from one [`list`], and what they carry.
//!
//! | file | what lives there |
//! |---|---|
//! | `list` | the rows, from which the identities here and the [table](super::table) are made |
//! | `named` | commands named in sentences |

pub mod list;
mod named;

use list::each_command;
pub use named::{by_name, spelled};

use super::view::{Home, Overlay, ScreenPanel, View};
use pulloff_engine::preset::Key;
use pulloff_engine::sweep::QuantityColumn;
use std::path::PathBuf;

/// Makes [`Id`] from the list.
macro_rules! identities {
    ($($section:literal { $(
        $id:ident $name:literal $keys:literal $short:literal $needs:ident $waits:ident $script:ident $(($what:literal))?
        $help:literal { $($field:ident: $value:expr),* }
    )* })*) => {
        /// A command's identity.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
        pub enum Id { $($(
            #[doc = $help]
            $id,
        )*)* }

        impl Id {
            /// All commands, in the order of the help.
            pub const ALL: &[Self] = &[$($(Self::$id,)*)*];

            /// The name in scripts, in the settings and on the command line.
            pub fn name(self) -> &'static str {
                match self { $($(Self::$id => $name,)*)* }
            }
        }
    };
}

each_command!(identities);

impl Id {
    /// The command with this name.
    pub fn called(name: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|id| id.name() == name)
    }
}

/// A key and the text of its value.
pub type Assignment = (Key, String);

/// The most steps that one command takes.
pub const MOST_STEPS: usize = 9999;

/// The first step length: a fiftieth of the range of every quantity.
pub const FIRST_LENGTH: f64 = 0.02;

/// The step lengths that can be chosen.
pub const LENGTHS: std::ops::RangeInclusive<f64> = 1e-4..=0.2;

/// The initial pace of a run, in states per second.
pub const FIRST_PACE: f64 = 20.0;

/// The paces that can be chosen: each is half or twice its neighbour.
pub const PACES: std::ops::RangeInclusive<f64> = 1.25..=160.0;

/// A command with its argument.
#[derive(Debug, Clone, PartialEq)]
pub enum Command {
    /// A command without an argument.
    Plain(Id),
    Steps(usize),
    /// A step by a key that may be held down: undo takes it back together with this many before it.
    HeldStep(usize),
    /// A run that ends after this many states, unless it meets something before.
    RunOf(usize),
    /// The longest step by hand, in the scaled unknowns.
    StepLength(f64),
    /// The walker to the event with this number, counted from 1 among those shown.
    SelectEvent(usize),
    /// Other values for some keys, as one change; as on a command line, a bare number is SI in an SI preset.
    Assign(Vec<Assignment>),
    Set {
        key: Key,
        text: String,
    },
    /// Another value for a key while it is being typed: the previous one can be restored.
    Try {
        key: Key,
        text: String,
    },
    /// Back to the values before the ones tried.
    TakeBack,
    /// List the files for this key in this folder; without a folder, in that of the preset's own file.
    Browse {
        key: Key,
        folder: Option<PathBuf>,
    },
    Pick {
        panel: ScreenPanel,
        line: Option<usize>,
    },
    /// Go to the state with this contact radius, in the user's units.
    MoveTo(String),
    /// Zoom towards a place of a view, or away from it.
    Zoom {
        view: View,
        closer: bool,
        /// The place that stays fixed, in shares of the window.
        about: (f64, f64),
    },
    /// Show the map of this key; its vertical axis is another key, or what limit points have.
    Map {
        x: Key,
        y: Option<Key>,
    },
    /// Show this view, whether it has something to show or not.
    Show(View),
    /// Go to this place.
    Go(Home),
    /// Show a quantity over the range of a value.
    Study {
        column: QuantityColumn,
        /// The key or symbol of the value that is varied; the selected one if there is none.
        over: Option<String>,
    },
    /// Draw this theory over the curve, or remove it.
    Overlay(Overlay),
    /// This many commands undone ([`Id::Undo`]) or redone ([`Id::Redo`]).
    Travel {
        id: Id,
        count: usize,
    },
    /// Turn the value of a key: the one that was selected when the key was pressed, before what the command waits for.
    Turn {
        id: Id,
        key: Key,
    },
    /// Go to this node of the walk.
    GoTo {
        node: usize,
        /// [`History::numbering`](super::History::numbering) at the time of the request.
        numbering: u64,
    },
    /// Remove the pinned curve with this number, or all.
    Unpin(Option<usize>),
    Open(String),
    /// Open this preset with other values for some keys.
    OpenWith {
        name: String,
        assignments: Vec<Assignment>,
    },
    /// Permanently delete the person's own preset of this name.
    Delete(String),
    SaveAs {
        name: String,
        /// Whether an existing preset of that name is replaced.
        replace: bool,
        /// Whether the data of a profile are copied beside it.
        with_data: bool,
    },
    /// Save although somebody else has changed the file meanwhile.
    SaveAnyway,
    /// Export to a file, whose extension chooses its format. What is seen reaches the model as a
    /// [page](super::export::Export::Page): the part that draws makes it one.
    Export {
        what: super::export::Export,
        path: String,
        /// Whether an existing file of that name is replaced.
        replace: bool,
    },
}

impl From<Id> for Command {
    fn from(id: Id) -> Self {
        Self::Plain(id)
    }
}

impl Command {
    /// Its row in the table.
    pub fn id(&self) -> Id {
        match self {
            Self::Plain(id) | Self::Travel { id, .. } => *id,
            Self::Steps(_) | Self::HeldStep(_) => Id::Step,
            Self::RunOf(_) => Id::Run,
            Self::StepLength(_) => Id::StepLength,
            Self::SelectEvent(_) | Self::MoveTo(_) => Id::MoveTo,
            Self::Assign(_) | Self::Turn { .. } => Id::Assign,
            Self::Set { .. } | Self::Try { .. } | Self::Browse { .. } => Id::Edit,
            Self::Pick { .. } => Id::NextPanel,
            Self::TakeBack => Id::Cancel,
            Self::Zoom { closer: true, .. } => Id::ZoomIn,
            Self::Zoom { closer: false, .. } => Id::ZoomOut,
            Self::Go(_) => Id::Go,
            Self::Show(_) => Id::ChooseView,
            Self::Study { .. } => Id::Study,
            Self::Overlay(_) => Id::Overlays,
            Self::Map { .. } => Id::Map,
            Self::GoTo { .. } => Id::Branches,
            Self::Unpin(_) => Id::Pins,
            Self::Open(_) | Self::OpenWith { .. } | Self::Delete(_) => Id::Open,
            Self::SaveAs { .. } => Id::SaveAs,
            Self::SaveAnyway => Id::Save,
            Self::Export { .. } => Id::Export,
        }
    }
}
