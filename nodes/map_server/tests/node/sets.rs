//! Tests of the node with a set of maps, while files appear and change and the robot moves from one
//! map to another.

use std::ffi::OsStr;
use std::fs;
use std::process::Command;

use messages::{MapSet, NodeState, TrackState, topic};
use transport::testing::{NodeProcess, OwnFileSystem};
use transport::{Publisher, Subscriber};

use super::{World, image};

impl World {
    fn add(&self, name: &str, row: &[u8]) {
        fs::write(self.at(&format!("{name}.pgm")), image(row)).unwrap();
        let text = format!(
            "image: {name}.pgm\nresolution: 0.1\norigin: [0, 0, 0]\nnegate: 0\n\
             occupied_thresh: 0.65\nfree_thresh: 0.196\n"
        );
        self.replace(&format!("{name}.yaml"), text.as_bytes());
    }

    fn start_on_set(&mut self) {
        let options = [OsStr::new("--maps"), self.folder.path().as_os_str()];
        let node = env!("CARGO_BIN_EXE_map_server");
        self.node = Some(NodeProcess::start(node, &self.graph, options));
    }

    fn wait_for_maps(&self, sets: &Subscriber<topic::Maps>, count: usize) -> Vec<u64> {
        let mut ids = Vec::new();
        self.wait(sets, |header, items| {
            let set = MapSet::read(header, items).unwrap();
            ids = set.maps.iter().map(|(map, _)| map.map_id).collect();
            ids.len() == count
        });
        ids
    }
}

fn send(poses: &Publisher<topic::Tracked>, map_id: u64, state: TrackState, pose_known: u32) {
    let mut loan = poses.loan(0).unwrap();
    let header = loan.header_mut();
    (header.map_id, header.state, header.pose_known) = (map_id, state as u32, pose_known);
    loan.send().unwrap();
}

#[test]
fn of_a_set_all_maps_are_served_and_the_one_that_poses_name_is_shown() {
    let mut world = World::new("of-set", &[0, 255, 205]);
    world.add("other", &[255, 0]);
    let list = "maps:\n  - {name: yard, map: other.yaml}\n  - {name: hall, map: map.yaml}\n";
    fs::write(world.at("maps.yaml"), list).unwrap();
    let poses = world.graph.publisher::<topic::Tracked>().unwrap();
    let sets = world.graph.subscriber::<topic::Maps>().unwrap();
    let shown = world.graph.subscriber::<topic::Map>().unwrap();
    let health = world.graph.subscriber::<topic::Health>().unwrap();
    world.start_on_set();
    let mut hall = 0;
    world.wait(&sets, |header, items| {
        let set = MapSet::read(header, items).unwrap();
        let named = set
            .maps
            .iter()
            .map(|(map, cells)| (map.name.to_string(), cells.len()));
        let expected = [("yard".to_owned(), 2), ("hall".to_owned(), 3)];
        assert_eq!(named.collect::<Vec<_>>(), expected);
        hall = set.maps[1].0.map_id;
        true
    });
    let wait_for_shown = |name: &str, expected: &[u8]| {
        world.wait(&shown, |map, cells| {
            assert_eq!((map.name.as_str(), cells), (name, expected));
            true
        });
    };
    wait_for_shown("yard", &[0, 100]);
    send(&poses, hall, TrackState::Unique, 1);
    wait_for_shown("hall", &[100, 0, 255]);

    // The set is served again when one of its maps changes; the displayed map stays.
    world.replace("map.pgm", &image(&[0, 0, 205]));
    world.wait(&sets, |header, items| {
        let set = MapSet::read(header, items).unwrap();
        assert_eq!(set.maps[1].1, [100, 100, 255]);
        true
    });
    wait_for_shown("hall", &[100, 100, 255]);
    // A broken list changes nothing.
    world.replace("maps.yaml", b"maps: []");
    let (_, error) = world.wait_for_state(&health, NodeState::Degraded);
    assert!(error.contains("there are no maps"), "{error}");
    assert!(sets.receive().unwrap().is_none() && shown.receive().unwrap().is_none());
    world.stop();
}

#[test]
fn without_room_a_set_and_a_map_are_not_sent_and_the_node_goes_on() {
    let test = "sets::without_room_a_set_and_a_map_are_not_sent_and_the_node_goes_on";
    match OwnFileSystem::of_test(test, "/dev/shm", "96m") {
        OwnFileSystem::Here => {}
        OwnFileSystem::Elsewhere => return,
        OwnFileSystem::Forbidden => return eprintln!("left out: {test}"),
    }
    let mut world = World::new("no-room", &[0, 255]);
    // A map of 1.2 MB.
    world.add("yard", &[255]);
    let pixels = [&b"P5\n30000 40\n255\n"[..], &[255; 1_200_000]].concat();
    fs::write(world.at("yard.pgm"), pixels).unwrap();
    let poses = world.graph.publisher::<topic::Tracked>().unwrap();
    let sets = world.graph.subscriber::<topic::Maps>().unwrap();
    let shown = world.graph.subscriber::<topic::Map>().unwrap();
    let health = world.graph.subscriber::<topic::Health>().unwrap();
    world.start_on_set();
    let maps = world.wait_for_maps(&sets, 2);
    world.wait(&shown, |map, _| map.map_id == maps[0]);
    world.wait_for_state(&health, NodeState::Ready);

    // The remaining space is enough for poses and reports, but not for a set or the yard.
    let free = "df --output=avail -B1 /dev/shm | tail -n 1";
    let fill = format!("head -c $(( $({free}) - (1 << 20) - 600000 )) /dev/zero > /dev/shm/filler");
    let filled = Command::new("sh").args(["-c", &fill]).status().unwrap();
    assert!(filled.success());
    send(&poses, maps[1], TrackState::Unique, 1);
    let (_, error) = world.wait_for_state(&health, NodeState::Degraded);
    assert!(
        error.contains("the robot is on map yard, not shown"),
        "{error}"
    );
    send(&poses, maps[0], TrackState::Unique, 1);
    world.wait_for_state(&health, NodeState::Ready);
    world.replace("map.pgm", &image(&[0, 0]));
    let (_, error) = world.wait_for_state(&health, NodeState::Degraded);
    assert!(error.contains("refused"), "{error}");
    assert!(sets.receive().unwrap().is_none() && shown.receive().unwrap().is_none());

    fs::remove_file("/dev/shm/filler").unwrap();
    send(&poses, maps[1], TrackState::Unique, 1);
    world.wait(&shown, |map, _| map.map_id == maps[1]);
    world.replace("map.pgm", &image(&[0, 255, 0]));
    world.wait_for_maps(&sets, 2);
    world.wait_for_state(&health, NodeState::Ready);
    world.stop();
}
