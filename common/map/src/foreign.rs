//! Maps of other programs, which hold no occupancy grid to read: recognized by their first bytes, or
//! else by their ending, to be refused with the commands that make a map of them.

use std::ffi::OsStr;
use std::fs::File;
use std::io::Read;
use std::path::Path;

use crate::MapError;

/// Number of bytes read; an SQLite file has the names of its tables in them.
const HEAD_BYTES: u64 = 64 << 10;

const SQLITE: &[u8] = b"SQLite format 3\0";

const BAG_TABLE: &[u8] = b"CREATE TABLE topics";

/// Names, first bytes (or a table, in SQLite), endings, and advice, in which SAVER stands for [`SAVER`].
const ALL: [(&str, &[u8], &str, &str); 5] = [
    (
        "a state of Cartographer",
        b"\xdb\x01\xf5\x5b\x7b\x1f\x1d\x7b",
        "pbstream",
        "`ros2 run cartographer_ros cartographer_pbstream_to_ros_map -pbstream_filename FILE \
         -map_filestem BARE` makes a map of it",
    ),
    (
        "a pose graph of slam_toolbox",
        b"\x16\0\0\0\0\0\0\0serialization::archive",
        "posegraph",
        "load it in slam_toolbox (`map_file_name: BARE`), then SAVER",
    ),
    (
        "a point cloud",
        b"# .PCD",
        "pcd",
        "publish it (`ros2 run pcl_ros pcd_to_pointcloud --ros-args -p file_name:=FILE`), project \
         it with octomap_server between the heights that the laser sees, then SAVER",
    ),
    (
        "an octomap",
        b"# Octomap OcTree",
        "bt",
        "publish it (`ros2 run octomap_server octomap_server_node --ros-args -p \
         octomap_path:=FILE`), then SAVER",
    ),
    (
        "a database of RTAB-Map",
        b"CREATE TABLE Node",
        "db",
        "load it (`ros2 launch rtabmap_launch rtabmap.launch.py localization:=true \
         database_path:=FILE`) or export its grid with rtabmap-databaseViewer, then SAVER",
    ),
];

const SAVER: &str = "`ros2 run nav2_map_server map_saver_cli -t TOPIC_OF_ITS_GRID -f BARE` makes a \
                     map of it";

/// Checks that a file given as a map is not one of another program. A file that cannot be read
/// passes.
///
/// # Errors
/// It is one; the error names it, and the commands that make a map of it.
pub fn check_kind(path: &Path) -> Result<(), MapError> {
    let mut head = Vec::new();
    // A pipe could not be read again.
    if let (true, Ok(file)) = (path.is_file(), File::open(path)) {
        // What was read before an error is judged.
        let _ = file.take(HEAD_BYTES).read_to_end(&mut head);
    }
    let has_table =
        |of: &[u8]| head.starts_with(SQLITE) && head.windows(of.len()).any(|part| part == of);
    let is_bag = has_table(BAG_TABLE);
    let ending = path.extension().map(OsStr::to_ascii_lowercase);
    let is_ended =
        |of: &str| path.is_file() && !is_bag && ending.as_deref() == Some(OsStr::new(of));
    let by_start = ALL
        .iter()
        .find(|(_, start, ..)| head.starts_with(start) || has_table(start));
    let found = by_start.or_else(|| ALL.iter().find(|(.., of, _)| is_ended(of)));
    let Some((name, _, _, advice)) = found else {
        return Ok(());
    };
    let (file, bare) = (path.display(), path.with_extension(""));
    let advice = advice
        .replace("SAVER", SAVER)
        .replace("FILE", &file.to_string());
    let advice = advice.replace("BARE", &bare.display().to_string());
    Err(MapError::invalid(path, format!("is {name}: {advice}")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn maps_of_other_programs_are_named_by_content_or_ending() {
        let folder = tempfile::tempdir().unwrap();
        for (name, head, expected) in [
            (
                "a.pbstream",
                "",
                "a.pbstream is a state of Cartographer: `ros2 run",
            ),
            ("b.posegraph", "", "/b`), then `ros2 run nav2_map_server"),
            (
                "c",
                "\x16\0\0\0\0\0\0\0serialization::archive",
                "a pose graph",
            ),
            ("d.PCD", "", "a point cloud"),
            ("e.yaml", "# .PCD v.7 - Point Cloud", "/e.yaml`), project"),
            ("f.bt", "# Octomap OcTree binary file", "an octomap"),
            ("g", "SQLite format 3\0..CREATE TABLE Node", "RTAB-Map"),
            ("h.db", "SQLite format 3\0", "RTAB-Map"),
        ] {
            let path = folder.path().join(name);
            std::fs::write(&path, head).unwrap();
            let said = check_kind(&path).unwrap_err().to_string();
            assert!(said.contains(expected), "{said}");
        }
        let bag = folder.path().join("h.db");
        std::fs::write(&bag, "SQLite format 3\0..CREATE TABLE topics").unwrap();
        assert!(check_kind(&bag).is_ok() && check_kind(folder.path()).is_ok());
    }
}
