//! Which file a path leads to, whatever it is called: through symbolic links, hard links, descriptors.

use super::atomic::{folder_of, follow};
use super::stream::STANDARD;
use std::ffi::OsString;
use std::fs::Metadata;
use std::os::unix::fs::MetadataExt;
use std::path::Path;

/// Where a path leads.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum FilePlace {
    /// An existing file.
    Node { device: u64, inode: u64, is_file: bool },
    /// Nothing yet: a name in a folder.
    Name { device: u64, inode: u64, name: OsString },
}

impl FilePlace {
    /// The place of what is written to `path`, where `-` is standard output; `None` where it leads nowhere.
    pub fn written(path: &Path) -> Option<Self> {
        if path == Path::new(STANDARD) {
            return behind(rustix::stdio::stdout());
        }
        if let Ok(metadata) = path.metadata() {
            return Some(Self::node(&metadata));
        }
        let target = follow(path).ok()?;
        let folder = folder_of(&target).metadata().ok()?;
        let name = target.file_name()?.to_owned();
        Some(Self::Name { device: folder.dev(), inode: folder.ino(), name })
    }

    /// The place of what is read from `path`, where `-` is standard input; `None` where there is no regular file.
    pub fn read(path: &Path) -> Option<Self> {
        let node = if path == Path::new(STANDARD) {
            behind(rustix::stdio::stdin())
        } else {
            path.metadata().ok().map(|metadata| Self::node(&metadata))
        };
        node.filter(|node| matches!(node, Self::Node { is_file: true, .. }))
    }

    fn node(metadata: &Metadata) -> Self {
        Self::Node { device: metadata.dev(), inode: metadata.ino(), is_file: metadata.is_file() }
    }
}

/// The file behind an open descriptor.
fn behind(descriptor: rustix::fd::BorrowedFd<'_>) -> Option<FilePlace> {
    // A duplicate descriptor, which is closed again.
    let file = std::fs::File::from(rustix::io::dup(descriptor).ok()?);
    file.metadata().ok().map(|metadata| FilePlace::node(&metadata))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;
    use std::os::unix::fs::symlink;

    #[test]
    fn a_file_is_the_same_under_all_its_names() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        fs::create_dir(at("inner")).unwrap();
        fs::write(at("file"), "text").unwrap();
        fs::write(at("twin"), "text").unwrap();
        fs::hard_link(at("file"), at("hard")).unwrap();
        symlink("file", at("soft")).unwrap();
        symlink("later", at("dangling")).unwrap();
        let file = FilePlace::written(&at("file"));
        assert!(file.is_some() && file == FilePlace::read(&at("file")));
        for same in ["hard", "soft", "inner/../file"] {
            assert_eq!(FilePlace::written(&at(same)), file, "{same}");
        }
        assert_ne!(FilePlace::written(&at("twin")), file);
        // What does not exist yet is a name in its folder.
        let later = FilePlace::written(&at("later"));
        assert!(matches!(later, Some(FilePlace::Name { .. })));
        assert_eq!(FilePlace::written(&at("dangling")), later);
        assert_eq!(FilePlace::written(&at("inner/../later")), later);
        assert_ne!(FilePlace::written(&at("inner/later")), later);
        assert_eq!(FilePlace::written(&at("none/later")), None);
        // A folder or a device is not a file to be read.
        assert!(
            [folder.path(), Path::new("/dev/null"), &at("later")]
                .map(FilePlace::read)
                .iter()
                .all(Option::is_none)
        );
    }
}
