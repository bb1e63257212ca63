//! Detects changes of a map's two files without reading the image.
//!
//! Polling, unlike listening for events, works on every file system, including network ones, and
//! with every way in which editors replace files. The contents are not checked here.

use std::fs;
use std::io::Read;
use std::os::unix::fs::MetadataExt;
use std::path::{Path, PathBuf};

use serde::Deserialize;

/// Number of bytes read of a description; a valid one has a few hundred.
const MAX_YAML_BYTES: u64 = 64 << 10;

/// Identity of a file's state.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct Fingerprint {
    pub(crate) device: u64,
    /// Inode number; it changes if another file takes the place by renaming.
    pub(crate) inode: u64,
    pub(crate) size: u64,
    pub(crate) modified_s: i64,
    pub(crate) modified_ns: i64,
}

/// State of both files at one moment; `None` for a missing file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Seen {
    pub(crate) yaml: Option<Fingerprint>,
    pub(crate) image: Option<Fingerprint>,
}

#[derive(Debug)]
pub(crate) struct Files {
    yaml: PathBuf,
    yaml_read: Option<Fingerprint>,
    image: Option<PathBuf>,
}

#[derive(Deserialize)]
struct Named {
    image: String,
}

impl Files {
    pub(crate) fn new(yaml: &Path) -> Self {
        Files {
            yaml: yaml.into(),
            yaml_read: None,
            image: None,
        }
    }

    /// Returns the current state of the files. While the description cannot be read, the image
    /// named before is watched.
    pub(crate) fn look(&mut self) -> Seen {
        let yaml = fingerprint(&self.yaml);
        if yaml != self.yaml_read {
            self.yaml_read = yaml;
            self.image = named_image(&self.yaml).or(self.image.take());
        }
        Seen {
            yaml,
            image: self.image.as_deref().and_then(fingerprint),
        }
    }
}

pub(crate) fn fingerprint(path: &Path) -> Option<Fingerprint> {
    let metadata = fs::metadata(path).ok()?;
    Some(Fingerprint {
        device: metadata.dev(),
        inode: metadata.ino(),
        size: metadata.size(),
        modified_s: metadata.mtime(),
        modified_ns: metadata.mtime_nsec(),
    })
}

fn named_image(yaml: &Path) -> Option<PathBuf> {
    let mut text = String::new();
    let file = fs::File::open(yaml).ok()?;
    file.take(MAX_YAML_BYTES).read_to_string(&mut text).ok()?;
    let text = text.strip_prefix('\u{feff}').unwrap_or(&text);
    let named: Named = serde_saphyr::from_str(text).ok()?;
    Some(yaml.parent()?.join(named.image.trim()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sees_both_files_change_and_follows_the_name() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        let mut files = Files::new(&at("a.yaml"));
        let nothing = files.look();
        assert_eq!((nothing.yaml, nothing.image), (None, None));

        fs::write(at("a.yaml"), "image: one.pgm\nresolution: 0.05\n").unwrap();
        fs::write(at("one.pgm"), "1").unwrap();
        let one = files.look();
        assert_eq!(one.image.unwrap().size, 1);
        assert_eq!(files.look(), one);

        fs::write(at("one.pgm"), "22").unwrap();
        let grown = files.look();
        assert_eq!((grown.yaml, grown.image.unwrap().size), (one.yaml, 2));

        // Another file of the same size with the same name.
        fs::write(at("new"), "33").unwrap();
        fs::rename(at("new"), at("one.pgm")).unwrap();
        assert_ne!(files.look(), grown);

        fs::write(at("two.pgm"), "4444").unwrap();
        fs::write(at("a.yaml"), "image: two.pgm\n").unwrap();
        assert_eq!(files.look().image.unwrap().size, 4);
        // With a broken description, the image named before is still watched.
        fs::write(at("a.yaml"), "image: [").unwrap();
        assert_eq!(files.look().image.unwrap().size, 4);
    }
}
