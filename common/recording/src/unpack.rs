//! Decompresses messages and files that rosbag2 has compressed with zstd.

use std::borrow::Cow;
use std::fs::File;
use std::io::{BufReader, Read, Seek, Write};
use std::path::Path;

use tempfile::NamedTempFile;
use zstd::stream::read::Decoder;

use crate::content::is_packed;
use crate::{MAX_CHUNK_BYTES, RecordingError};

/// A file may decompress to at most `MAX_FACTOR` times its size plus `MAX_BESIDE` bytes. A sound
/// recording compresses to no less than a few hundredths of its size; the claims of a damaged or
/// malicious one must not fill the disk.
const MAX_FACTOR: u64 = 1000;
const MAX_BESIDE: u64 = 1 << 30;

const STEP_BYTES: usize = 1 << 20;

/// Returns a message in CDR, decompressed if necessary. Compressed messages are recognized by their
/// first bytes, because CDR in either byte order never starts with the magic of zstd.
pub(crate) fn message(bytes: &[u8]) -> Result<Cow<'_, [u8]>, String> {
    match is_packed(bytes) {
        true => within(bytes, MAX_CHUNK_BYTES).map(Cow::Owned),
        false => Ok(Cow::Borrowed(bytes)),
    }
}

fn within(packed: &[u8], most: u64) -> Result<Vec<u8>, String> {
    let mut unpacked = Vec::new();
    Decoder::with_buffer(packed)
        .and_then(|decoder| decoder.take(most + 1).read_to_end(&mut unpacked))
        .map_err(|error| format!("it is packed with zstd, and does not unpack: {error}"))?;
    match unpacked.len() as u64 <= most {
        true => Ok(unpacked),
        false => Err(too_much(most)),
    }
}

fn too_much(most: u64) -> String {
    format!("it unpacks to more than {most} bytes, the most that are allowed")
}

/// Saves what comes through a pipe to a temporary file that is deleted when it is dropped.
pub(crate) fn saved(path: &Path) -> Result<NamedTempFile, RecordingError> {
    let source = match path == Path::new("-") {
        true => Path::new("/dev/stdin"),
        false => path,
    };
    let mut stream = File::open(source).map_err(RecordingError::open(path))?;
    let mut sink = NamedTempFile::new().map_err(no_room(path))?;
    std::io::copy(&mut stream, &mut sink).map_err(no_room(path))?;
    Ok(sink)
}

/// Decompresses a file to a temporary one that is deleted when it is dropped. `allows` checks the
/// first bytes before the rest is decompressed.
pub(crate) fn file(
    path: &Path,
    allows: impl FnOnce(&[u8]) -> Result<(), RecordingError>,
) -> Result<NamedTempFile, RecordingError> {
    let unreadable = RecordingError::open(path);
    let packed = File::open(path).map_err(unreadable)?;
    let size = packed.metadata().map_err(unreadable)?.len();
    let most = size.saturating_mul(MAX_FACTOR).saturating_add(MAX_BESIDE);
    let broken = |error: std::io::Error| refused(path, format!("its zstd is broken: {error}"));
    let mut decoder = Decoder::new(BufReader::new(packed)).map_err(broken)?;
    let mut sink = NamedTempFile::new().map_err(no_room(path))?;
    let mut step = Vec::with_capacity(STEP_BYTES);
    let mut allows = Some(allows);
    let mut unpacked = 0;
    loop {
        step.clear();
        let mut taken = decoder.by_ref().take(STEP_BYTES as u64);
        taken.read_to_end(&mut step).map_err(broken)?;
        if let Some(allows) = allows.take() {
            allows(&step)?;
        }
        if step.is_empty() {
            break;
        }
        unpacked += step.len() as u64;
        if unpacked > most {
            return Err(refused(path, too_much(most)));
        }
        sink.write_all(&step).map_err(no_room(path))?;
    }
    sink.rewind().map_err(no_room(path))?;
    Ok(sink)
}

fn refused(path: &Path, reason: String) -> RecordingError {
    RecordingError::Unpack {
        path: path.to_owned(),
        reason,
    }
}

fn no_room(path: &Path) -> impl Fn(std::io::Error) -> RecordingError {
    move |error| {
        let folder = std::env::temp_dir();
        let folder = folder.display();
        let reason = format!("a temporary file in {folder} (TMPDIR names another place): {error}");
        refused(path, reason)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::write::Packing;
    use crate::{Recording, sample};

    #[test]
    fn a_pipe_is_read_to_its_end() {
        use std::os::fd::AsRawFd;
        let bytes = sample::bytes(Packing::Zstd);
        let direct = Recording::from_bytes("r.mcap", bytes.clone()).unwrap();
        let (reader, mut writer) = std::io::pipe().unwrap();
        let path = format!("/proc/self/fd/{}", reader.as_raw_fd());
        let fed = std::thread::spawn(move || writer.write_all(&bytes));
        let piped = Recording::open(path).unwrap();
        fed.join().unwrap().unwrap();
        assert_eq!(piped.messages(), direct.messages());
    }

    fn packed(bytes: &[u8]) -> Vec<u8> {
        zstd::encode_all(bytes, 3).unwrap()
    }

    #[test]
    fn a_message_that_unpacks_to_too_much_is_refused() {
        let packed = packed(&[0; 1000]);
        assert_eq!(within(&packed, 1000).unwrap(), [0; 1000]);
        let reason = message(&packed[..packed.len() - 1]).unwrap_err();
        assert!(reason.contains("does not unpack"), "{reason}");
        let reason = within(&packed, 999).unwrap_err();
        assert!(
            reason.starts_with("it unpacks to more than 999"),
            "{reason}"
        );
    }
}
