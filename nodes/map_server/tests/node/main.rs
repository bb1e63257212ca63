//! Tests of the node as a process, while its map files change.
#![allow(
    clippy::unwrap_used,
    reason = "the lint spares test functions but not what they share"
)]

mod sets;

use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};

use messages::{HealthHeader, NodeState, topic};
use recording::write::{Packing, RecordingWriter};
use recording::{Message, Recording};
use ros::TfMessage;
use tempfile::TempDir;
use transport::testing::{Isolated, NodeProcess, wait_for_health, wait_until, wait_until_ready};
use transport::{Graph, Subscriber};

struct World {
    node: Option<NodeProcess>,
    folder: TempDir,
    graph: Graph,
    _isolated: Isolated,
}

impl World {
    fn new(test: &str, row: &[u8]) -> World {
        let isolated = Isolated::new(test);
        let world = World {
            node: None,
            folder: tempfile::tempdir().unwrap(),
            graph: isolated.join("test"),
            _isolated: isolated,
        };
        fs::write(world.at("map.pgm"), image(row)).unwrap();
        world.describe(0.05);
        world
    }

    fn at(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn describe(&self, resolution: f64) {
        let text = format!(
            "image: map.pgm\nresolution: {resolution}\norigin: [1, 2, 0.5]\nnegate: 0\n\
             occupied_thresh: 0.65\nfree_thresh: 0.196\n"
        );
        self.replace("map.yaml", text.as_bytes());
    }

    /// Replaces a file by renaming a new one, as careful writers do.
    fn replace(&self, name: &str, bytes: &[u8]) {
        fs::write(self.at("new"), bytes).unwrap();
        fs::rename(self.at("new"), self.at(name)).unwrap();
    }

    fn start(&mut self) {
        self.start_with(&[]);
    }

    fn start_with(&mut self, options: &[&OsStr]) {
        let map = self.at("map.yaml");
        let map = [OsStr::new("--map"), map.as_os_str()];
        self.node = Some(NodeProcess::start(
            env!("CARGO_BIN_EXE_map_server"),
            &self.graph,
            map.iter().chain(options),
        ));
    }

    fn wait<T: messages::Topic>(
        &self,
        subscriber: &Subscriber<T>,
        wanted: impl FnMut(&T::Header, &[T::Item]) -> bool,
    ) {
        wait_until(&self.graph, subscriber, wanted);
    }

    fn wait_for_cells(&self, maps: &Subscriber<topic::Map>, counter: u64, cells: &[u8]) {
        self.wait(maps, |header, items| {
            assert!(header.stamp.counter <= counter, "{header:?}");
            if header.stamp.counter == counter {
                assert_eq!(items, cells);
            }
            header.stamp.counter == counter
        });
    }

    fn wait_for_state(
        &self,
        health: &Subscriber<topic::Health>,
        state: NodeState,
    ) -> (HealthHeader, String) {
        wait_for_health(&self.graph, health, |report| report.state == state as u32)
    }

    fn stop(&mut self) -> String {
        self.node.take().unwrap().stop_with_log()
    }
}

fn image(row: &[u8]) -> Vec<u8> {
    [format!("P5\n{} 1\n255\n", row.len()).as_bytes(), row].concat()
}

#[test]
fn the_map_is_served_also_to_those_who_join_late() {
    let mut world = World::new("late", &[0, 255, 205]);
    let health = world.graph.subscriber::<topic::Health>().unwrap();
    world.start();
    world.wait_for_state(&health, NodeState::Ready);
    let maps = world.graph.subscriber::<topic::Map>().unwrap();
    world.wait(&maps, |header, cells| {
        assert_eq!(
            (header.width, header.height, header.resolution_m),
            (3, 1, 0.05)
        );
        assert_eq!(
            (header.map_from_grid.x, header.map_from_grid.yaw),
            (1.0, 0.5)
        );
        let expected = map::load(world.at("map.yaml")).unwrap();
        assert_eq!((header.map_id, cells), (expected.id(), &expected.cells[..]));
        true
    });
    world.stop();
}

#[test]
fn the_map_of_a_recording_is_preferred_where_it_holds_one() {
    let file = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../../recordings/malaga_corridor/recording.mcap"
    );
    let recording = Recording::open(file).unwrap();
    let (_, recorded) = recording.maps().unwrap().last().unwrap().unwrap();
    let recorded = recorded.to_grid().unwrap();
    let mut world = World::new("recorded", &[0, 255]);
    let maps = world.graph.subscriber::<topic::Map>().unwrap();
    world.start_with(&[OsStr::new("--recorded"), OsStr::new(file)]);
    world.wait(&maps, |header, cells| {
        assert_eq!((header.map_id, cells), (recorded.id(), &recorded.cells[..]));
        true
    });
    world.stop();

    // Played on another map, which is served with a warning.
    world.start_with(&[OsStr::new("--played"), OsStr::new(file)]);
    let late = world.graph.subscriber::<topic::Map>().unwrap();
    world.wait(&late, |_, cells| cells == [100, 0]);
    wait_until_ready(&world.graph, "map_server");
    let log = world.stop();
    assert!(log.contains("recorded on another map"), "{log}");
    // Played on its own map, without a warning.
    let own = Path::new(file).with_file_name("map.yaml");
    let options = [
        "--map".as_ref(),
        own.as_os_str(),
        "--played".as_ref(),
        file.as_ref(),
    ];
    let node = NodeProcess::start(env!("CARGO_BIN_EXE_map_server"), &world.graph, options);
    wait_until_ready(&world.graph, "map_server");
    let log = node.stop_with_log();
    assert!(!log.contains("another map"), "{log}");

    // A recording without a map: the map of the file is served.
    let empty = world.at("empty.mcap");
    let mut writer = RecordingWriter::create(&empty, Packing::Zstd).unwrap();
    let transforms = Message::StaticTransforms(TfMessage::default());
    writer.write("/tf_static", 0, &transforms).unwrap();
    writer.finish().unwrap();
    world.start_with(&[OsStr::new("--recorded"), empty.as_os_str()]);
    let late = world.graph.subscriber::<topic::Map>().unwrap();
    world.wait(&late, |_, cells| cells == [100, 0]);
    let log = world.stop();
    assert!(log.contains("holds no map"), "{log}");
}

#[test]
fn a_map_that_is_missing_or_broken_at_the_start_is_named_and_waited_for() {
    for is_missing in [true, false] {
        let mut world = World::new(if is_missing { "missing" } else { "broken" }, &[0, 255]);
        let maps = world.graph.subscriber::<topic::Map>().unwrap();
        let health = world.graph.subscriber::<topic::Health>().unwrap();
        match is_missing {
            true => fs::remove_file(world.at("map.pgm")).unwrap(),
            false => fs::write(world.at("map.pgm"), "P5\n3 1\n255\n").unwrap(),
        }
        world.start();
        world.wait(&health, |report, error| {
            let error = String::from_utf8_lossy(error);
            let is_named = error.contains("map.yaml") && error.contains("map.pgm");
            report.state == NodeState::Waiting as u32 && is_named
        });
        fs::write(world.at("map.pgm"), image(&[0, 255])).unwrap();
        world.wait_for_cells(&maps, 0, &[100, 0]);
        world.wait_for_state(&health, NodeState::Ready);
        let log = world.stop();
        assert!(log.contains("waiting for the map"), "{log}");
    }
}

#[test]
fn a_changed_map_is_served_and_a_broken_one_refused() {
    let mut world = World::new("change", &[0, 255]);
    let maps = world.graph.subscriber::<topic::Map>().unwrap();
    let health = world.graph.subscriber::<topic::Health>().unwrap();
    world.start();
    world.wait_for_cells(&maps, 0, &[100, 0]);

    // Temporary files of an editor are ignored.
    fs::write(world.at(".map.yaml.swp"), "rubbish").unwrap();
    world.replace("map.pgm", &image(&[255, 0]));
    world.wait_for_cells(&maps, 1, &[0, 100]);

    // Only the description changes.
    world.describe(0.1);
    world.wait(&maps, |header, _| header.resolution_m == 0.1);

    // A truncated image is rejected, and the previous map stays.
    let whole = image(&[255, 255, 0]);
    fs::write(world.at("map.pgm"), &whole[..whole.len() - 2]).unwrap();
    let (report, error) = world.wait_for_state(&health, NodeState::Degraded);
    assert_eq!((report.refused, report.sent), (1, 3));
    assert!(error.contains("map.pgm"), "{error}");
    let late = world.graph.subscriber::<topic::Map>().unwrap();
    world.wait_for_cells(&late, 2, &[0, 100]);

    // After the repair.
    fs::write(world.at("map.pgm"), whole).unwrap();
    world.wait_for_cells(&maps, 3, &[0, 0, 100]);
    world.wait_for_state(&health, NodeState::Ready);
    world.stop();
}
