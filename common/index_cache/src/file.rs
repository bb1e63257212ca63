//! Format of a file: a header, followed by the sections of an index.
//!
//! | bytes | content |
//! |---|---|
//! | 8 | magic number, `BCINDEX` and a line feed in the byte order of the machine |
//! | 4 | [`SearchIndex::VERSION`] |
//! | 4 | number of sections |
//! | 16 | the key |
//! | 16 each | length and checksum of each section |
//! | 8 | checksum of all the above |
//!
//! Numbers and sections are in the byte order of the machine, which the magic number shows.
//! Checksums are XXH3 with 64 bits.

use std::hash::Hasher;
use std::io::{self, Read, Write};

use bytemuck::{Pod, Zeroable, bytes_of, bytes_of_mut};
use engine::search::{IndexKey, SECTIONS, SearchIndex};
use engine::vote_search::Preparation;
use twox_hash::XxHash3_64;

const MAGIC: u64 = u64::from_be_bytes(*b"BCINDEX\n");

/// Number of bytes read and hashed at a time, so that they stay in the CPU cache.
const PIECE: usize = 1 << 18;

/// Sizes of memory pages in bytes. Other machines may have larger ones, and ignore advice on parts
/// of them.
const PAGE: usize = 1 << 12;
const LARGE_PAGE: usize = 1 << 21;

#[derive(Debug, Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct Header {
    magic: u64,
    version: u32,
    count: u32,
    key: [u8; 16],
    sections: [Section; SECTIONS],
    checksum: u64,
}

#[derive(Debug, Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct Section {
    bytes: u64,
    checksum: u64,
}

impl Header {
    fn of(key: IndexKey, sections: &[&[u8]; SECTIONS]) -> Self {
        let mut header = Header {
            magic: MAGIC,
            version: SearchIndex::VERSION,
            count: SECTIONS as u32,
            key: key.to_bytes(),
            sections: sections.map(|section| Section {
                bytes: section.len() as u64,
                checksum: XxHash3_64::oneshot(section),
            }),
            checksum: 0,
        };
        header.checksum = header.sum();
        header
    }

    /// Returns the checksum of the header without its last field.
    fn sum(&self) -> u64 {
        let bytes = bytes_of(self);
        XxHash3_64::oneshot(&bytes[..bytes.len() - size_of::<u64>()])
    }

    fn check(&self, key: IndexKey, file_bytes: u64) -> io::Result<()> {
        let (version, known) = (self.version, SearchIndex::VERSION);
        let lengths = self.sections.iter().map(|section| section.bytes);
        let expected = lengths.fold(size_of::<Header>() as u64, u64::saturating_add);
        Err(io::Error::other(if self.magic != MAGIC {
            "not an index file".to_owned()
        } else if version != known {
            format!("it has version {version} and this is version {known}")
        } else if self.checksum != self.sum() || self.count != SECTIONS as u32 {
            "its header is damaged".to_owned()
        } else if self.key != key.to_bytes() {
            "the index is of another map or other settings".to_owned()
        } else if file_bytes != expected {
            format!("it has {file_bytes} bytes instead of {expected}")
        } else {
            return Ok(());
        }))
    }
}

pub(crate) fn size(index: &SearchIndex) -> u64 {
    let sections = index.sections().map(<[u8]>::len).into_iter().sum::<usize>();
    (size_of::<Header>() + sections) as u64
}

pub(crate) fn write(to: &mut impl Write, key: IndexKey, index: &SearchIndex) -> io::Result<()> {
    let sections = index.sections();
    to.write_all(bytes_of(&Header::of(key, &sections)))?;
    sections
        .into_iter()
        .try_for_each(|section| to.write_all(section))
}

pub(crate) fn read(
    from: &mut impl Read,
    file_bytes: u64,
    key: IndexKey,
    preparation: &Preparation,
) -> io::Result<SearchIndex> {
    let mut header = Header::zeroed();
    from.read_exact(bytes_of_mut(&mut header))?;
    header.check(key, file_bytes)?;
    let lengths = header.sections.map(|section| section.bytes);
    let unchecked = preparation.unchecked_index(lengths);
    let mut unchecked = unchecked.map_err(io::Error::other)?;
    let sections = unchecked.sections_mut().into_iter().zip(header.sections);
    for (i, (section, Section { checksum, .. })) in sections.enumerate() {
        ask_for_large_pages(section);
        if read_hashing(from, section)? != checksum {
            return Err(io::Error::other(format!("section {i} is damaged")));
        }
    }
    unchecked.check().map_err(io::Error::other)
}

/// Requests huge pages for a section to be filled, as allocating small pages takes as long as
/// reading. It has no effect on systems without them.
fn ask_for_large_pages(section: &mut [u8]) {
    #[cfg(target_os = "linux")]
    if section.len() >= LARGE_PAGE {
        let start = section.as_ptr().align_offset(PAGE);
        let pages = &mut section[start..];
        // SAFETY: this is advice on borrowed memory; its content does not change.
        unsafe {
            libc::madvise(pages.as_mut_ptr().cast(), pages.len(), libc::MADV_HUGEPAGE);
        }
    }
}

/// Fills `into` and returns the hash of its content.
fn read_hashing(from: &mut impl Read, into: &mut [u8]) -> io::Result<u64> {
    let mut hash = XxHash3_64::new();
    for piece in into.chunks_mut(PIECE) {
        from.read_exact(piece)?;
        hash.write(piece);
    }
    Ok(hash.finish())
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::testing::preparation;

    fn file() -> Vec<u8> {
        let vote_search = preparation(1).finish().unwrap();
        let index = vote_search.search_index().unwrap();
        let mut bytes = Vec::new();
        write(&mut bytes, key(), &index).unwrap();
        assert_eq!(bytes.len() as u64, size(&index));
        bytes
    }

    fn key() -> IndexKey {
        preparation(1).key().unwrap()
    }

    fn read_back(bytes: &[u8]) -> Result<SearchIndex, String> {
        let read = read(&mut &*bytes, bytes.len() as u64, key(), &preparation(1));
        read.map_err(|error| error.to_string())
    }

    fn claiming(change: impl FnOnce(&mut Header)) -> Result<SearchIndex, String> {
        let mut bytes = file();
        let (header, _) = bytes.split_at_mut(size_of::<Header>());
        let mut claimed: Header = bytemuck::pod_read_unaligned(header);
        change(&mut claimed);
        claimed.checksum = claimed.sum();
        header.copy_from_slice(bytes_of(&claimed));
        read_back(&bytes)
    }

    #[test]
    fn a_header_that_claims_something_else_is_refused_before_room_is_made() {
        assert!(claiming(|_| ()).is_ok());
        let said = |change: fn(&mut Header), expected: &str| {
            let said = claiming(change).unwrap_err();
            assert!(said.contains(expected), "{said}");
        };
        // From the intervals to the searched cells, with the same total size.
        let moved = |header: &mut Header| {
            header.sections[5].bytes -= 48 * 3;
            header.sections[0].bytes += 48 * 3;
        };
        let moved = claiming(moved).unwrap_err();
        assert!(moved.contains("which no index of the map has"), "{moved}");
        for section in 0..SECTIONS {
            let huge = claiming(|header| header.sections[section].bytes = u64::MAX);
            assert!(huge.unwrap_err().contains("bytes instead of"));
        }
        said(|header| header.key[3] ^= 1, "another map");
        said(|header| header.count += 1, "header is damaged");
        said(|header| header.magic ^= 1, "not an index file");
        said(|header| header.version ^= 1, "this is version");
    }

    #[test]
    fn a_file_that_is_cut_or_longer_is_refused() {
        let mut bytes = file();
        let header: Header = bytemuck::pod_read_unaligned(&bytes[..size_of::<Header>()]);
        let mut ends = vec![0, 1, size_of::<Header>() - 1, size_of::<Header>()];
        for section in header.sections {
            let start = ends.last().unwrap();
            let end = start + section.bytes as usize;
            ends.extend([end.saturating_sub(1), end]);
        }
        assert_eq!(ends.pop(), Some(bytes.len()));
        for end in ends {
            assert!(read_back(&bytes[..end]).is_err(), "{end}");
            // The file is cut while it is read: fewer bytes than its size at first.
            let mut cut = &bytes[..end];
            let cut = read(&mut cut, bytes.len() as u64, key(), &preparation(1));
            let kind = cut.unwrap_err().kind();
            assert_eq!(kind, io::ErrorKind::UnexpectedEof, "{end}");
        }
        bytes.push(0);
        assert!(read_back(&bytes).unwrap_err().contains("bytes instead of"));
    }

    proptest! {
        #[test]
        fn a_file_with_other_bytes_is_refused(changes in prop::collection::vec((any::<usize>(), 1u8..), 1..4)) {
            let sound = file();
            let mut bytes = sound.clone();
            for (place, flip) in changes {
                let place = place % bytes.len();
                bytes[place] ^= flip;
            }
            prop_assert!(read_back(&bytes).is_err() || bytes == sound);
        }
    }
}
