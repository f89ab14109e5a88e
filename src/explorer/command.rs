//! Commands: their identities, of the one [`list`] of them, and what they carry.
//!
//! | file | what lives there |
//! |---|---|
//! | `list` | the rows, of which the identities here and the [table](super::table) are made |
//! | `named` | commands in sentences |

pub mod list;
mod named;

use list::each_command;
pub use named::{by_name, spelled};

use super::view::{Home, Overlay, ScreenPanel, View};
use pulloff_engine::preset::Key;
use pulloff_engine::sweep::QuantityColumn;
use std::path::PathBuf;

/// Makes [`Id`] of the list.
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
            /// All, in the order of the help.
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
    /// The command of a name.
    pub fn called(name: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|id| id.name() == name)
    }
}

/// A key and the text of its value.
pub type Assignment = (Key, String);

/// Most steps that one command takes.
pub const MOST_STEPS: usize = 9999;

/// The first step length: a fiftieth of the range of every quantity.
pub const FIRST_LENGTH: f64 = 0.02;

/// The step lengths a person can choose.
pub const LENGTHS: std::ops::RangeInclusive<f64> = 1e-4..=0.2;

/// States a second of a run, at first.
pub const FIRST_PACE: f64 = 20.0;

/// The paces a person can choose: each half or twice the next.
pub const PACES: std::ops::RangeInclusive<f64> = 1.25..=160.0;

/// A command with its argument.
#[derive(Debug, Clone, PartialEq)]
pub enum Command {
    /// A command without an argument.
    Plain(Id),
    Steps(usize),
    /// A step by a key that may be held down: undo takes it back with so many before it.
    HeldStep(usize),
    /// A run that ends after so many states, if it meets nothing before.
    RunOf(usize),
    /// The longest step by hand, in the scaled unknowns.
    StepLength(f64),
    /// The walker to the event of this number, from 1, among those shown.
    SelectEvent(usize),
    /// Other values for some keys, as one change; as on a command line a bare number is SI in an SI preset.
    Assign(Vec<Assignment>),
    Set {
        key: Key,
        text: String,
    },
    /// Another value for a key while it is typed: what was there before can be taken back.
    Try {
        key: Key,
        text: String,
    },
    /// Back to the values before those tried.
    TakeBack,
    /// List the files for this key in this folder; without one, in that of the preset's own file.
    Browse {
        key: Key,
        folder: Option<PathBuf>,
    },
    Pick {
        panel: ScreenPanel,
        line: Option<usize>,
    },
    /// Go to the state of this contact radius, in the user's units.
    MoveTo(f64),
    /// Closer to a place of a view, or further away.
    Zoom {
        view: View,
        closer: bool,
        /// The place that stays where it is, in shares of the window.
        about: (f64, f64),
    },
    /// Show the map of this key, and what stands up it: another, or what limit points have.
    Map {
        x: Key,
        y: Option<Key>,
    },
    /// Show this view, whether it has something to show or not.
    Show(View),
    /// Go to this place.
    Go(Home),
    /// Show this quantity over the range of the selected value.
    Study(QuantityColumn),
    /// Draw this theory over the curve, or no longer.
    Overlay(Overlay),
    /// So many commands taken back ([`Id::Undo`]) or done again ([`Id::Redo`]).
    Travel {
        id: Id,
        count: usize,
        /// Whether single states along the walk are counted instead, as scripts of earlier versions did.
        states: bool,
    },
    /// The value of a key turned; which one was selected when the key was pressed, before what it waits for.
    Turn {
        id: Id,
        key: Key,
    },
    /// Go to the last state walked with exactly these δ, P and s (reduced).
    GoToState([f64; 3]),
    /// Go to this node of the walk.
    GoTo {
        node: usize,
        /// [`History::numbering`](super::History::numbering) when it was asked for.
        numbering: u64,
    },
    /// Take away the pinned curve of this number, or all.
    Unpin(Option<usize>),
    Open(String),
    /// Open this preset with other values for some keys.
    OpenWith {
        name: String,
        assignments: Vec<Assignment>,
    },
    /// Delete the person's own preset of this name, for good.
    Delete(String),
    SaveAs {
        name: String,
        /// Whether a preset of that name is to be replaced.
        replace: bool,
        /// Whether the data of a profile are copied beside it.
        with_data: bool,
    },
    /// Save although the file was changed by somebody else meanwhile.
    SaveAnyway,
    /// Write the screen to a file ending in `.txt`, or a figure to one whose ending chooses its format.
    ExportPage {
        page: super::export::Page,
        path: String,
        /// Whether a file of that name is to be replaced.
        replace: bool,
    },
    /// Write what is seen: whoever draws makes an [`ExportPage`](Self::ExportPage) of it.
    Picture {
        picture: super::export::Picture,
        path: String,
        /// Whether a file of that name is to be replaced.
        replace: bool,
    },
    /// Export to a file, its ending chooses CSV or JSON.
    Export {
        what: super::export::ExportKind,
        path: String,
        /// Whether a file of that name is to be replaced.
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
            Self::Study(_) => Id::Study,
            Self::Overlay(_) => Id::Overlays,
            Self::Map { .. } => Id::Map,
            Self::GoTo { .. } | Self::GoToState(_) => Id::Branches,
            Self::Unpin(_) => Id::Pins,
            Self::Open(_) | Self::OpenWith { .. } | Self::Delete(_) => Id::Open,
            Self::SaveAs { .. } => Id::SaveAs,
            Self::SaveAnyway => Id::Save,
            Self::Export { .. } | Self::ExportPage { .. } | Self::Picture { .. } => Id::Export,
        }
    }
}
