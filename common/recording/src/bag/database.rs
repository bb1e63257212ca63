//! Opens a foreign database for reading, also in a read-only folder, and leaves no files next to
//! it.
//!
//! SQLite writes files next to a database in WAL mode (bytes 18 and 19 of its header are 2) even to
//! read it: the last messages may be in a log, `FILE-wal`, and readers coordinate in another file,
//! `FILE-shm`. So if there is a log with content, database and log are copied to a temporary folder
//! and opened there. Without a log, the file is complete, and SQLite is told to assume that it does
//! not change. The same holds for the journal of a writer that was killed.
//! (<https://www.sqlite.org/wal.html>, section 5, and `immutable` in
//! <https://www.sqlite.org/uri.html>.)

use std::fmt::Write;
use std::fs::File;
use std::io::{self, Read};
use std::os::unix::ffi::OsStrExt;
use std::path::{Path, PathBuf};

use rusqlite::{Connection, OpenFlags};
use tempfile::TempDir;

use super::Fault;
use crate::folder::with_ending;

pub(super) struct Database {
    pub(super) connection: Connection,
    /// True if it is in WAL mode, but there is no log.
    pub(super) lacks_log: bool,
    /// Folder of the copy, if one was needed; deleted with this value.
    _copy: Option<TempDir>,
}

pub(super) fn log_of(path: &Path) -> PathBuf {
    with_ending(path, "-wal")
}

impl Database {
    /// Opens the database at `place`, which errors call `path`, and checks its structure.
    pub(super) fn open(path: &Path, place: &Path) -> Result<Self, Fault> {
        let has_content =
            |beside: &PathBuf| std::fs::metadata(beside).is_ok_and(|found| found.len() > 0);
        let logs = ["-wal", "-journal"].map(|ending| with_ending(place, ending));
        let copy = match logs.iter().any(has_content) {
            true => Some(copied(place, &logs).map_err(no_room)?),
            false => None,
        };
        let lacks_log = copy.is_none() && is_in_wal_mode(place)?;
        let database = Database {
            connection: match &copy {
                Some(folder) => open_copy(&folder.path().join(COPY)),
                None => open_alone(place, lacks_log),
            }?,
            lacks_log,
            _copy: copy,
        };
        database.check(path, place)?;
        Ok(database)
    }

    fn check(&self, path: &Path, place: &Path) -> Result<(), Fault> {
        let connection = &self.connection;
        let ask = "PRAGMA quick_check(1)";
        let found: String = connection.query_row(ask, (), |row| row.get(0))?;
        if found != "ok" {
            return Err(Fault::damaged(&found));
        }
        self.check_tables()?;
        if self.lacks_log && !connection.table_exists(None, "messages")? {
            return Err(Fault::Content(format!(
                "its messages are in {}, which is missing: copy it along",
                log_of(path).display()
            )));
        }
        if self._copy.is_some() {
            // Its last page may be in the log.
            return Ok(());
        }
        // SQLite reads the missing bytes of a truncated last page as zeros.
        let page: u32 = connection.query_row("PRAGMA page_size", (), |row| row.get(0))?;
        match std::fs::metadata(place)?.len().checked_rem(page.into()) {
            Some(0) => Ok(()),
            _ => Err(Fault::damaged("it ends within a page")),
        }
    }

    /// Rejects views and virtual tables in place of a bag's tables, because a query of them may
    /// never end.
    fn check_tables(&self) -> Result<(), Fault> {
        let ask = "SELECT name FROM sqlite_schema WHERE name COLLATE NOCASE \
             IN ('messages', 'topics', 'message_definitions') \
             AND (type = 'view' OR sql LIKE 'CREATE VIRTUAL%')";
        let mut query = self.connection.prepare(ask)?;
        let mut names = query.query_map((), |row| row.get::<_, String>(0))?;
        match names.next().transpose()? {
            None => Ok(()),
            Some(name) => Err(Fault::Content(format!("its {name} is no table of a bag"))),
        }
    }
}

const COPY: &str = "bag.db3";

#[allow(clippy::needless_pass_by_value, reason = "it is given to map_err")]
fn no_room(error: io::Error) -> Fault {
    let folder = std::env::temp_dir();
    let folder = folder.display();
    Fault::Content(format!(
        "it cannot be copied to {folder} (TMPDIR names another place): {error}"
    ))
}

fn copied(place: &Path, logs: &[PathBuf; 2]) -> io::Result<TempDir> {
    let folder = TempDir::new()?;
    let copy = folder.path().join(COPY);
    let [log, journal] = ["-wal", "-journal"].map(|ending| with_ending(&copy, ending));
    for (from, to) in [(place, copy), (&*logs[0], log), (&*logs[1], journal)] {
        if from.is_file() {
            std::fs::copy(from, &to)?;
            writable(&to)?;
        }
    }
    Ok(folder)
}

/// Makes a copy writable; it inherits the permissions of the original.
fn writable(path: &Path) -> io::Result<()> {
    use std::os::unix::fs::PermissionsExt;
    std::fs::set_permissions(path, std::fs::Permissions::from_mode(0o600))
}

/// Opens a copy for writing, because SQLite changes it to apply a log.
fn open_copy(copy: &Path) -> rusqlite::Result<Connection> {
    let flags = OpenFlags::SQLITE_OPEN_READ_WRITE | OpenFlags::SQLITE_OPEN_NO_MUTEX;
    Connection::open_with_flags(copy, flags)
}

/// Opens the file in place; `unchanged` says that no process changes it and that it has no log.
fn open_alone(place: &Path, unchanged: bool) -> rusqlite::Result<Connection> {
    let flags = OpenFlags::SQLITE_OPEN_READ_ONLY | OpenFlags::SQLITE_OPEN_NO_MUTEX;
    match unchanged {
        true => Connection::open_with_flags(immutable(place), flags | OpenFlags::SQLITE_OPEN_URI),
        false => Connection::open_with_flags(place, flags),
    }
}

/// SQLite URI of a file, with all bytes except plain letters, digits and `/._-` percent-encoded.
fn immutable(place: &Path) -> String {
    let place = std::path::absolute(place).unwrap_or_else(|_| place.to_owned());
    let mut name = "file:".to_owned();
    for &byte in place.as_os_str().as_bytes() {
        match byte {
            b'/' | b'.' | b'_' | b'-' | b'0'..=b'9' | b'a'..=b'z' | b'A'..=b'Z' => {
                name.push(byte.into());
            }
            // Writing to a string cannot fail.
            _ => _ = write!(name, "%{byte:02x}"),
        }
    }
    name + "?immutable=1"
}

/// Write and read version of the file format that stand for WAL mode.
const WAL_VERSIONS: [u8; 2] = [2, 2];

fn is_in_wal_mode(place: &Path) -> io::Result<bool> {
    let mut header = Vec::new();
    File::open(place)?.take(20).read_to_end(&mut header)?;
    Ok(header.get(18..20) == Some(&WAL_VERSIONS[..]))
}

#[cfg(test)]
mod tests {
    use super::*;

    const TABLE: &str = "CREATE TABLE messages(id INTEGER PRIMARY KEY);
        INSERT INTO messages VALUES (1), (2);";

    fn count(database: &Database) -> i64 {
        let ask = "SELECT count(*) FROM messages";
        let count = database.connection.query_row(ask, (), |row| row.get(0));
        count.unwrap()
    }

    fn names(folder: &Path) -> Vec<String> {
        let entries = std::fs::read_dir(folder).unwrap();
        let name = |entry: std::io::Result<std::fs::DirEntry>| {
            entry.unwrap().file_name().into_string().unwrap()
        };
        let mut names: Vec<String> = entries.map(name).collect();
        names.sort();
        names
    }

    fn writer(path: &Path) -> Connection {
        let writer = Connection::open(path).unwrap();
        writer
            .query_row("PRAGMA journal_mode = WAL", (), |_| Ok(()))
            .unwrap();
        writer.execute_batch(TABLE).unwrap();
        writer
    }

    /// Creates a database in WAL mode whose rows are in its log, as a killed recorder leaves it.
    fn cut_off(folder: &Path) -> PathBuf {
        let (open, path) = (folder.join("open.db3"), folder.join("r ü.db3"));
        let writer = writer(&open);
        std::fs::copy(&open, &path).unwrap();
        std::fs::copy(log_of(&open), log_of(&path)).unwrap();
        drop(writer);
        std::fs::remove_file(open).unwrap();
        path
    }

    #[test]
    fn a_log_is_read_and_nothing_is_left_beside_it() {
        let folder = TempDir::new().unwrap();
        let path = cut_off(folder.path());
        assert_eq!(names(folder.path()), ["r ü.db3", "r ü.db3-wal"]);
        let before = std::fs::read(&path).unwrap();
        let database = Database::open(&path, &path).unwrap();
        assert_eq!((count(&database), database.lacks_log), (2, false));
        drop(database);
        assert_eq!(names(folder.path()), ["r ü.db3", "r ü.db3-wal"]);
        assert_eq!(std::fs::read(&path).unwrap(), before);
    }

    #[test]
    fn a_log_that_is_missing_is_named() {
        let folder = TempDir::new().unwrap();
        let path = cut_off(folder.path());
        std::fs::remove_file(log_of(&path)).unwrap();
        let refusal = Database::open(&path, &path).err().unwrap().to_string();
        assert!(
            refusal.ends_with("r ü.db3-wal, which is missing: copy it along"),
            "{refusal}"
        );
    }

    #[test]
    fn a_view_in_the_place_of_a_table_is_refused() {
        let folder = TempDir::new().unwrap();
        let path = folder.path().join("r.db3");
        let endless = "CREATE TABLE topics(id INTEGER PRIMARY KEY);
            CREATE VIEW Messages AS WITH RECURSIVE n(id) AS
                (SELECT 1 UNION ALL SELECT id + 1 FROM n) SELECT id FROM n;";
        Connection::open(&path)
            .unwrap()
            .execute_batch(endless)
            .unwrap();
        let refusal = Database::open(&path, &path).err().unwrap().to_string();
        assert!(
            refusal.ends_with("its Messages is no table of a bag"),
            "{refusal}"
        );
    }

    #[test]
    fn a_database_that_was_closed_needs_no_log() {
        let folder = TempDir::new().unwrap();
        let path = folder.path().join("r?mode=rwc.db3");
        drop(writer(&path));
        assert_eq!(names(folder.path()), ["r?mode=rwc.db3"]);
        let database = Database::open(&path, &path).unwrap();
        assert_eq!((count(&database), database.lacks_log), (2, true));
        assert_eq!(names(folder.path()), ["r?mode=rwc.db3"]);
    }
}
