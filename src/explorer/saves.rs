//! Saves that follow each other faster than they are answered.
//!
//! A save requires that the file be as the session knows it, and the session learns from the answer how the save has
//! left it. When the next save is requested before that, the file is as our own last save left it: nobody else changed
//! it.

use super::files;
use super::job::{Done, Job};
use crate::store::{Fingerprint, Overwrite, Source, Store};

/// The last saves to one file.
#[derive(Debug, Default)]
pub(super) struct Saves {
    /// The file, and the state in which the last save left it.
    last: Option<(Source, Fingerprint)>,
    /// The state before each of the saves that the session may not know of yet.
    before: Vec<Fingerprint>,
}

impl Saves {
    pub(super) fn run(&mut self, store: &Store, mut job: Job) -> Done {
        let mut known = None;
        if let Job::Save { source, overwrite: Overwrite::IfUnchanged(asked), .. } = &mut job {
            *asked = self.renewed(source, *asked);
            known = Some((source.clone(), *asked));
        }
        let done = files::run(store, job);
        if let (Some((source, before)), Done::Saved { fingerprint, .. }) = (known, &done) {
            self.before.push(before);
            self.last = Some((source, *fingerprint));
        }
        done
    }

    /// The state the file must be in when the session knew it as `asked`.
    fn renewed(&mut self, source: &Source, asked: Fingerprint) -> Fingerprint {
        match &self.last {
            Some((saved, now)) if saved == source && self.before.contains(&asked) => *now,
            _ => {
                self.before.clear();
                asked
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::store::{read, shipped};
    use pulloff_engine::preset::Preset;
    use std::fs;

    #[test]
    fn saves_in_a_row_are_not_taken_for_somebody_elses() {
        let folder = tempfile::tempdir().unwrap();
        let store = Store::at(folder.path(), &[]);
        let wavy = read("wavy-sphere", shipped::find("wavy-sphere").unwrap().text).unwrap();
        let called = |title: &str| Preset { title: title.to_owned(), ..wavy.clone() };
        let (source, first) = store.save("mine", &wavy, None, Overwrite::Never).unwrap();
        let mut saves = Saves::default();
        let mut save = |title: &str, known| {
            let (source, preset) = (source.clone(), Box::new(called(title)));
            saves.run(&store, Job::Save { source, preset, overwrite: Overwrite::IfUnchanged(known) })
        };
        // Three saves that know only the first file, the answer to the last, and one save that knows it.
        let mut last = first;
        for title in ["one", "two", "three"] {
            let Done::Saved { fingerprint, .. } = save(title, first) else { panic!("{title} was refused") };
            last = fingerprint;
        }
        assert!(matches!(save("four", last), Done::Saved { .. }));
        // A change made by somebody else is still found, whatever was known before.
        let path = source.path().unwrap();
        fs::write(path, "theirs").unwrap();
        assert!(matches!(save("five", first), Done::Conflict));
        assert!(matches!(save("five", last), Done::Conflict));
        assert_eq!(fs::read_to_string(path).unwrap(), "theirs");
    }
}
