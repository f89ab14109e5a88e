//! What presets take from files: the rows of measured profiles, and measured curves, as they were, since the files may
//! change.

use crate::store::path::SavedPath;
use pulloff_engine::gap::shapes::ProfileRows;
use pulloff_engine::gap::shapes::measured::SHIPPED_DATA;
use pulloff_engine::measured::PointsFile;
use pulloff_engine::preset::read::HeldFiles;
use pulloff_engine::units::Unit;
use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use std::env::current_dir;
use std::fmt::Write;
use std::path::Path;
use std::sync::Arc;

/// The first line of the rows of a profile.
const HEADER: &str = "r,h";

/// What can be kept in a file of its own.
#[derive(Debug, Clone)]
pub enum Aside {
    Profile(Arc<ProfileRows>),
    Curve(Arc<PointsFile>),
}

impl Aside {
    /// Its bytes in that file: the columns of a profile with every digit; a curve as its own file is.
    pub fn bytes(&self) -> Cow<'_, [u8]> {
        match self {
            Self::Profile(rows) => Cow::Owned(text(rows).into_bytes()),
            Self::Curve(source) => Cow::Borrowed(&source.bytes),
        }
    }

    /// Whether both are the same, which is known at once if they are the same object.
    pub fn is_same(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Profile(a), Self::Profile(b)) => {
                Arc::ptr_eq(a, b) || (a == b && (&a.folder, &a.notes) == (&b.folder, &b.notes))
            }
            (Self::Curve(a), Self::Curve(b)) => Arc::ptr_eq(a, b) || (a == b && a.folder == b.folder),
            _ => false,
        }
    }

    /// Puts it among what the files of a preset contain.
    pub(super) fn put(&self, files: &mut HeldFiles) {
        match self {
            Self::Profile(rows) => files.rows = Arc::clone(rows),
            Self::Curve(source) => files.points = Arc::clone(source),
        }
    }
}

/// What a preset takes from a file, in its written form.
#[derive(Debug, Serialize, Deserialize)]
pub struct SavedFile {
    pub name: String,
    folder: Option<SavedPath>,
    /// The current folder, where the name starts from it: the session may be resumed in another one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    current: Option<SavedPath>,
    /// The unit and the notes of a profile; a measured curve has neither.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    profile: Option<(Option<String>, Vec<String>)>,
    /// The hash that names the file of its own, if it is in one,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub data: Option<String>,
    /// and otherwise the content, once the document is written.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    text: Option<String>,
    /// The content, unless it has only been read.
    #[serde(skip)]
    pub held: Option<Aside>,
}

impl SavedFile {
    pub(super) fn of(file: &Aside) -> Self {
        let (name, folder, profile) = match file {
            Aside::Profile(rows) => {
                let unit = rows.unit.as_ref().map(Unit::ascii);
                (&rows.name, &rows.folder, Some((unit, rows.notes.clone())))
            }
            Aside::Curve(source) => (&source.name, &source.folder, None),
        };
        let folder = folder.as_deref().map(SavedPath::of);
        let is_file = !name.starts_with(SHIPPED_DATA);
        let starts_here = is_file && folder.is_none() && Path::new(name).is_relative();
        let current = if starts_here { current_dir().ok().as_deref().map(SavedPath::of) } else { None };
        Self {
            name: name.clone(),
            folder,
            current,
            profile,
            data: None,
            text: None,
            held: Some(file.clone()),
        }
    }

    /// Writes the content into the document, unless it is in a file of its own.
    pub(super) fn lay_within(&mut self) {
        if let (None, Some(held)) = (&self.data, &self.held) {
            // It has been parsed, so it is text.
            self.text = Some(String::from_utf8_lossy(&held.bytes()).into_owned());
        }
    }

    /// The same with this content; `None` if a profile has no rows in it.
    pub fn with(&self, bytes: &[u8]) -> Option<Aside> {
        let folder = self.folder.clone().map(SavedPath::path);
        let elsewhere = self.current.clone().map(SavedPath::path);
        let elsewhere = elsewhere.filter(|then| current_dir().is_ok_and(|now| now != *then));
        let name = match elsewhere.map(|then| then.join(&self.name)) {
            Some(path) => path.to_string_lossy().into_owned(),
            None => self.name.clone(),
        };
        let Some((unit, notes)) = &self.profile else {
            return Some(Aside::Curve(Arc::new(PointsFile::new(name, folder, bytes.into()))));
        };
        let [radii, gaps] = columns(bytes)?;
        let unit = unit.as_ref().and_then(|unit| Unit::parse(unit, 0).ok());
        Some(Aside::Profile(Arc::new(ProfileRows { name, folder, radii, gaps, unit, notes: notes.clone() })))
    }

    /// Its content, if it was taken back or is in the document.
    pub(super) fn back(self) -> Option<Aside> {
        let within = || self.with(self.text.as_ref()?.as_bytes());
        self.held.clone().or_else(within)
    }
}

/// The columns of a profile as text, with every digit.
fn text(rows: &ProfileRows) -> String {
    let mut text = format!("{HEADER}\n");
    for (r, h) in rows.radii.iter().zip(&rows.gaps) {
        // Writing to a String cannot fail.
        let _ = writeln!(text, "{r:?},{h:?}");
    }
    text
}

/// The inverse: the columns from their text.
fn columns(bytes: &[u8]) -> Option<[Vec<f64>; 2]> {
    let mut lines = std::str::from_utf8(bytes).ok()?.lines();
    lines.next().filter(|line| *line == HEADER)?;
    let row = |line: &str| {
        let (r, h) = line.split_once(',')?;
        Some((r.parse::<f64>().ok()?, h.parse::<f64>().ok()?))
    };
    let (radii, gaps) = lines.map(row).collect::<Option<(Vec<f64>, Vec<f64>)>>()?;
    Some([radii, gaps])
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use proptest::test_runner::RngSeed;

    #[test]
    fn a_file_of_another_current_folder_keeps_its_place() {
        let of = |name: &str, then: Option<&str>| {
            let file = PointsFile::new(name.to_owned(), None, b"x,y\n"[..].into());
            let mut saved = SavedFile::of(&Aside::Curve(Arc::new(file)));
            if let (Some(then), Some(current)) = (then, &mut saved.current) {
                *current = SavedPath::of(Path::new(then));
            }
            let Some(Aside::Curve(back)) = saved.with(b"x,y\n") else { return String::new() };
            back.name.clone()
        };
        assert_eq!(of("a/b.csv", None), "a/b.csv");
        assert_eq!(of("a/b.csv", Some("/then")), "/then/a/b.csv");
        assert_eq!(of("/a/b.csv", Some("/then")), "/a/b.csv");
        assert_eq!(of("shipped:lens.csv", Some("/then")), "shipped:lens.csv");
    }

    proptest! {
        #![proptest_config(ProptestConfig {
            cases: 200, rng_seed: RngSeed::Fixed(5), failure_persistence: None, ..ProptestConfig::default()
        })]

        #[test]
        fn every_bit_of_the_columns_comes_back(
            rows in prop::collection::vec((prop::num::f64::NORMAL | prop::num::f64::SUBNORMAL
                | prop::num::f64::ZERO, prop::num::f64::NORMAL | prop::num::f64::ZERO), 0..20),
        ) {
            let (radii, gaps): (Vec<f64>, Vec<f64>) = rows.into_iter().unzip();
            let rows = ProfileRows { radii, gaps, ..ProfileRows::default() };
            let [radii, gaps] = columns(text(&rows).as_bytes()).unwrap();
            let bits = |column: &[f64]| column.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
            prop_assert_eq!((bits(&radii), bits(&gaps)), (bits(&rows.radii), bits(&rows.gaps)));
        }
    }

    #[test]
    fn what_is_no_table_of_two_columns_gives_none() {
        for text in ["", "h,r\n", "r,h\n1\n", "r,h\n1,2,3\n", "r,h\n1,x\n", "1,2\n"] {
            assert_eq!(columns(text.as_bytes()), None, "{text}");
        }
        assert_eq!(columns(b"\xff"), None);
    }
}
