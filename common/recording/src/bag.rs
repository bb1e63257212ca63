//! Converts SQLite files of rosbag2 (`.db3`) to recordings.
//!
//! SQLite stores no checksums of the data: the structure of a file is checked before it is read,
//! and a damaged file is rejected as a whole, but a flipped bit within a message goes unnoticed.
//! The module `database` opens the file so that no other files are left next to it.
//!
//! | table | column | content |
//! |---|---|---|
//! | `topics` | `id`, `name`, `type`, `serialization_format` | the channels |
//! | `messages` | `topic_id`, `timestamp`, `data` | nanoseconds since 1970; the message as it was sent |
//! | `message_definitions` | `topic_type`, `encoding`, `encoded_message_definition` | the schemas' text; not in bags before ROS 2 Iron |

mod database;

use std::collections::HashMap;
use std::fs::File;
use std::io::{self, BufWriter, Seek, Write};
use std::path::Path;

use rusqlite::Row;
use rusqlite::types::ValueRef;

use crate::folder::{Listed, refused};
use crate::write::{Packing, RecordingWriter, definition_in};
use crate::{Damage, RecordingError};
use database::Database;

/// Messages with their topics. Messages with equal times are in the order of writing.
const MESSAGES: &str = "SELECT name, type, serialization_format, timestamp, data \
     FROM messages LEFT JOIN topics ON topics.id = messages.topic_id \
     ORDER BY timestamp, messages.id";

const DEFINITIONS: &str = "SELECT topic_type, encoded_message_definition \
     FROM message_definitions WHERE encoding = 'ros2msg'";

/// Converts the file at `place`, which errors call by its listed name, to a recording in an unnamed
/// temporary file that is deleted when it is closed. Also returns the damage if messages are
/// missing.
pub(crate) fn as_recording(
    listed: &Listed,
    place: &Path,
) -> Result<(File, Option<Damage>), RecordingError> {
    let sink = tempfile::tempfile().map_err(|error| write_failed(&error))?;
    let mut writer = RecordingWriter::new(BufWriter::new(sink), Packing::Plain)?;
    let database = Database::open(&listed.path, place);
    let written = database.and_then(|database| Ok((write(&database, &mut writer)?, database)));
    let (found, database) = written.map_err(|fault| fault.of(&listed.path))?;
    let damage = match listed.messages {
        Some(claimed) if claimed > found && database.lacks_log => {
            let log = database::log_of(&listed.path);
            let log = log.display();
            Some(Damage::Other(format!(
                "metadata.yaml counts {claimed} messages, {found} are there: the others are in \
                 {log}, which is missing; copy it along"
            )))
        }
        _ => None,
    };
    let buffered = writer.finish()?;
    let file = buffered
        .into_inner()
        .map_err(|error| write_failed(error.error()))?;
    Ok((file, damage))
}

fn write_failed(error: &io::Error) -> RecordingError {
    let folder = std::env::temp_dir();
    RecordingError::Write {
        reason: format!("a temporary file in {}: {error}", folder.display()),
    }
}

/// Fault of a bag, whose path is not known here.
#[derive(Debug, thiserror::Error)]
enum Fault {
    #[error(transparent)]
    Sqlite(#[from] rusqlite::Error),
    #[error("{0}")]
    Content(String),
    #[error(transparent)]
    Unreadable(#[from] io::Error),
    #[error(transparent)]
    Recording(#[from] RecordingError),
}

impl Fault {
    fn damaged(found: &str) -> Self {
        let advice = "what can be saved of it, `sqlite3 FILE .recover` saves";
        Fault::Content(format!("it is damaged: {}; {advice}", found.trim()))
    }

    fn of(self, path: &Path) -> RecordingError {
        match self {
            Fault::Sqlite(_) | Fault::Content(_) => refused(path, self.to_string()),
            Fault::Unreadable(error) => RecordingError::open(path)(error),
            Fault::Recording(error) => error,
        }
    }
}

fn write<W: Write + Seek>(
    database: &Database,
    writer: &mut RecordingWriter<W>,
) -> Result<u64, Fault> {
    let definitions = definitions(database)?;
    let mut query = database.connection.prepare(MESSAGES)?;
    let mut rows = query.query(())?;
    let mut messages = 0;
    while let Some(row) = rows.next()? {
        let message = message(row)?;
        let (topic, schema) = (&*message.topic, &*message.schema);
        let text = definition_in(definitions.get(schema), schema);
        let time = message.time_ns;
        writer.write_bytes(topic, schema, text, &message.encoding, time, message.data)?;
        messages += 1;
    }
    Ok(messages)
}

fn definitions(database: &Database) -> rusqlite::Result<HashMap<String, String>> {
    let connection = &database.connection;
    if !connection.table_exists(None, "message_definitions")? {
        return Ok(HashMap::new());
    }
    let mut query = connection.prepare(DEFINITIONS)?;
    query
        .query_map((), |row| Ok((row.get(0)?, row.get(1)?)))?
        .collect()
}

fn message<'r>(row: &'r Row<'_>) -> Result<Message<'r>, Fault> {
    let topic: Option<String> = row.get(0)?;
    let topic = topic.ok_or_else(|| Fault::damaged("a message of a topic that is not there"))?;
    let data = match row.get_ref(4)? {
        ValueRef::Blob(data) => data,
        other => {
            let found = other.data_type();
            let reason = format!("a message of {topic} is of type {found}; allowed: blob");
            return Err(Fault::Content(reason));
        }
    };
    Ok(Message {
        topic,
        schema: row.get(1)?,
        encoding: row.get(2)?,
        time_ns: row.get(3)?,
        data,
    })
}

struct Message<'r> {
    topic: String,
    schema: String,
    encoding: String,
    time_ns: i64,
    data: &'r [u8],
}

#[cfg(test)]
mod tests {
    use std::path::PathBuf;

    use rusqlite::Connection;
    use tempfile::TempDir;

    use super::*;
    use crate::{Record, Recording, sample};

    /// The tables as rosbag2 creates them since ROS 2 Foxy.
    const TABLES: &str = "
        CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL,
            serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL);
        CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL,
            timestamp INTEGER NOT NULL, data BLOB NOT NULL);
        CREATE INDEX timestamp_idx ON messages (timestamp ASC);";

    /// Creates a bag with the given messages, the newest first.
    fn bag(folder: &TempDir, name: &str, records: &[Record]) -> PathBuf {
        let path = folder.path().join(name);
        let database = Connection::open(&path).unwrap();
        database.execute_batch(TABLES).unwrap();
        for record in records.iter().rev() {
            let (topic, schema) = (&*record.topic, record.message.kind().schema());
            let add = "INSERT INTO topics SELECT NULL, ?1, ?2, 'cdr', '' \
                       WHERE NOT EXISTS (SELECT 1 FROM topics WHERE name = ?1)";
            database.execute(add, (topic, schema)).unwrap();
            let add = "INSERT INTO messages SELECT NULL, id, ?2, ?3 FROM topics WHERE name = ?1";
            let body = record.message.encode().unwrap();
            database
                .execute(add, (topic, record.log_time_ns, body))
                .unwrap();
        }
        path
    }

    fn read(path: &Path) -> Vec<Record> {
        let recording = Recording::open(path).unwrap();
        assert_eq!(recording.damage(), None);
        recording.records().map(Result::unwrap).collect()
    }

    fn refusal(change: &str) -> String {
        let folder = TempDir::new().unwrap();
        let path = bag(&folder, "r.db3", &sample::records());
        Connection::open(&path)
            .unwrap()
            .execute_batch(change)
            .unwrap();
        Recording::open(&path).unwrap_err().to_string()
    }

    #[test]
    fn a_bag_reads_as_the_recording_does() {
        let folder = TempDir::new().unwrap();
        let path = bag(&folder, "r.db3", &sample::records());
        let records = read(&path);
        assert_eq!(records.len(), sample::records().len());
        assert!(records.is_sorted_by_key(|record| record.log_time_ns));
        assert!(
            sample::records()
                .iter()
                .all(|record| records.contains(record))
        );
        let recording = Recording::open(&path).unwrap();
        assert_eq!(recording.path(), path);
        assert_eq!(recording.map().unwrap().unwrap(), sample::grid());
        assert_eq!(recording.ground_truths().unwrap().len(), sample::SCANS);
    }

    #[test]
    fn messages_that_a_missing_log_holds_are_damage() {
        let folder = TempDir::new().unwrap();
        let path = bag(&folder, "r.db3", &sample::records());
        let all = sample::records().len();
        let describe = |messages: usize| {
            let text = format!(
                "rosbag2_bagfile_information:\n  relative_file_paths: [r.db3]\n  \
                 message_count: {messages}\n"
            );
            std::fs::write(folder.path().join("metadata.yaml"), text).unwrap();
        };
        describe(all + 3);
        let lost = |path: &Path| Recording::open(path).unwrap().damage().cloned();
        assert_eq!(lost(&path), None, "it never had a log");
        Connection::open(&path)
            .unwrap()
            .query_row("PRAGMA journal_mode = WAL", (), |_| Ok(()))
            .unwrap();
        for name in [folder.path(), &path] {
            let expected = format!(
                "metadata.yaml counts {} messages, {all} are there: the others are in {}-wal, ",
                all + 3,
                path.display()
            );
            let lost = lost(name).unwrap().to_string();
            assert!(lost.starts_with(&expected), "{lost}");
        }
        describe(all);
        assert_eq!(lost(&path), None);
    }

    #[test]
    fn definitions_of_the_bag_are_kept() {
        let folder = TempDir::new().unwrap();
        let path = bag(&folder, "r.db3", &sample::records()[..2]);
        let define = "CREATE TABLE message_definitions(id INTEGER PRIMARY KEY, topic_type TEXT,
                encoding TEXT, encoded_message_definition TEXT, type_description_hash TEXT);
            INSERT INTO message_definitions VALUES
                (1, 'nav_msgs/msg/OccupancyGrid', 'ros2msg', 'of the bag', ''),
                (2, 'tf2_msgs/msg/TFMessage', 'ros2idl', 'of another kind', '');";
        Connection::open(&path)
            .unwrap()
            .execute_batch(define)
            .unwrap();
        let mut writer = RecordingWriter::in_memory(Packing::Plain).unwrap();
        assert_eq!(crate::write_bag(&path, &mut writer).unwrap(), 2);
        let bytes = writer.finish().unwrap().into_inner();
        let has = |text: &str| bytes.windows(text.len()).any(|w| w == text.as_bytes());
        assert!(has("of the bag") && !has("of another kind"));
        assert!(
            has("geometry_msgs/TransformStamped[] transforms"),
            "our own"
        );
    }

    #[test]
    fn what_is_not_sound_is_refused_with_the_reason() {
        for (change, expected) in [
            (
                "DELETE FROM topics WHERE name = '/scan'",
                "a topic that is not there",
            ),
            (
                "UPDATE messages SET data = 'text' WHERE id = 1",
                "is of type Text; allowed: blob",
            ),
            (
                "UPDATE messages SET timestamp = -1",
                "log time -1 ns is before 1970",
            ),
            ("UPDATE messages SET timestamp = 'noon'", "timestamp"),
            ("DROP TABLE messages", "no such table: messages"),
        ] {
            let refusal = refusal(change);
            assert!(refusal.contains(expected), "{change}: {refusal}");
        }
    }

    #[test]
    fn a_bag_that_is_cut_short_is_refused() {
        let folder = TempDir::new().unwrap();
        let path = bag(&folder, "r.db3", &sample::records());
        let bytes = std::fs::read(&path).unwrap();
        for length in [16, 100, 4096, bytes.len() / 2, bytes.len() - 1] {
            std::fs::write(&path, &bytes[..length]).unwrap();
            let refusal = Recording::open(&path).unwrap_err();
            assert!(
                matches!(refusal, RecordingError::Bag { .. }),
                "{length}: {refusal}"
            );
        }
    }
}
