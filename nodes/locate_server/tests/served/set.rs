//! Tests of several maps on one server.

use super::*;

/// Shipped maps, in the order of the set.
const MAPS: [&str; 3] = ["malaga_campus", "malaga_corridor", "malaga_courtyard"];

#[test]
fn a_server_of_several_maps_answers_as_one_search_of_all_of_them() {
    let folder = tempfile::tempdir().unwrap();
    let mut text = "maps:\n".to_owned();
    for name in MAPS {
        let map = World::of(name).map();
        text += &format!("  - {{name: {name}, map: {}}}\n", map.display());
    }
    std::fs::write(folder.path().join("maps.yaml"), text).unwrap();
    let set = folder.path().to_str().unwrap();
    let server = Server::of("set", &["--maps", set, "--name", "malaga"]);
    let session = caller(&[&server]);
    let map = |name| map::load(World::of(name).map()).unwrap();
    let maps = MAPS.map(|name| searched(name, &map(name)));
    let (locator, mut workspace) = (Locator::of_set(maps.into()).unwrap(), Workspace::default());
    let mut on_the_right_map = 0;
    let scans = World::of("malaga_corridor").scans();
    for (scan, counter) in scans.into_iter().zip(0..).step_by(6) {
        let header = as_the_graph_has_it(&scan, counter);
        let asked = (&header, scan.ranges.as_slice());
        let answer = ask(&session, "malaga", asked, TIMEOUT).unwrap();
        let expected = locator.locate(&mut workspace, asked, &|| false).unwrap();
        let (header, hypotheses) = expected.unwrap();
        assert_eq!(answer.header.map_id, header.map_id);
        assert_eq!(answer.header.verdict, header.verdict);
        assert_eq!(answer.items, hypotheses);
        let name = locator.name_of(header.map_id);
        on_the_right_map += usize::from(name == Some("malaga_corridor"));
    }
    assert!(on_the_right_map > 3, "{on_the_right_map}");
    server.process.stop();
}
