//! Disk: the user's presets and those that come with the program, the data of profiles, saving.
//!
//! | file | what lives there |
//! |---|---|
//! | [`presets`] | the folder of the user's presets: resolve, load, list, save |
//! | [`data`] | the files of profiles, which the engine receives as rows |
//! | [`beside`] | the data of a profile copied beside a preset |
//! | [`name`] | which names a user's preset may have |
//! | [`file`](mod@file) | reading regular files of bounded size; fingerprints |
//! | [`hash`] | names derived from content |
//! | [`path`] | paths in a document, where they need not be text |
//! | [`place`] | which file a path leads to, whatever it is called |
//! | [`stream`] | standard input and output, pipes and devices, which are read and written directly |
//! | [`atomic`] | writing a file as a whole or not at all |
//! | [`temporary`] | the temporary file of a save, and what a killed save left behind |
//! | [`lock`] | one saver at a time in a folder |

pub mod atomic;
pub mod beside;
pub mod data;
pub mod file;
pub mod hash;
pub mod lock;
pub mod name;
pub mod path;
pub mod place;
pub mod presets;
pub mod stream;
pub mod temporary;

pub use atomic::{Overwrite, WriteError, write_atomically};
pub use data::{FILES, ProfileError, load, read, read_in, read_profile, read_with};
pub use file::Fingerprint;
pub use presets::{Listed, Listing, Loaded, Source, Store, StoreError, make_folder, save_file};
pub use pulloff_engine::preset::shipped;
pub use shipped::SHIPPED;
