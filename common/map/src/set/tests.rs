use std::path::Path;

use geometry::Pose;

use super::*;

fn folder(files: &[(&str, &str)]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in files {
        let path = folder.path().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    }
    folder
}

fn names(maps: &[MapFile]) -> Vec<&str> {
    maps.iter().map(|map| &*map.name).collect()
}

#[test]
fn a_folder_of_maps_is_a_set_by_their_names() {
    let files = [
        ("b.yaml", ""),
        ("a/map.yaml", ""),
        ("c.png", ""),
        ("d/x", ""),
    ];
    let folder = folder(&files);
    let maps = set_of(folder.path()).unwrap().maps;
    assert_eq!(names(&maps), ["a", "b"]);
    assert_eq!(maps[0].yaml, folder.path().join("a/map.yaml"));
}

#[test]
fn what_names_no_image_is_no_map_of_a_folder() {
    let others = [
        ("dataflow.yaml", "nodes: [{id: m, path: map_server}]\n"),
        ("params.yaml", "/**:\n  ros__parameters: {image: 1}\n"),
        ("play.yml", "- hosts: all\n"),
    ];
    let noted = |folder: &tempfile::TempDir| {
        let mut lines = Vec::new();
        let set = set_of_noting(folder.path(), |line| lines.push(line.to_owned()));
        lines.sort();
        (set, lines)
    };
    let (set, lines) = noted(&folder(&others));
    let error = set.unwrap_err().to_string();
    assert!(error.contains("there are no maps: allowed are"), "{error}");
    assert!(error.contains("of 3 YAML files, as "), "{error}");
    assert!(lines.is_empty());

    // A file that is being written or is broken still counts as a map.
    let maps = [
        ("a.yaml", "\u{feff}image: a.pgm\n"),
        ("b.yaml", ""),
        ("c.yaml", "image: ["),
        ("d.yaml", "imag"),
        ("e/map.yaml", "resolution: 1\n"),
    ];
    let (set, lines) = noted(&folder(&[&others[..], &maps[..]].concat()));
    assert_eq!(names(&set.unwrap().maps), ["a", "b", "c", "d", "e"]);
    assert_eq!(lines.len(), 3);
    let said = "dataflow.yaml has no key image: it is taken for no map and left out";
    assert!(lines[0].ends_with(said), "{lines:?}");
}

#[test]
fn a_list_names_maps_in_its_order() {
    let list = "maps:\n  - {name: up, map: u.yaml, floor: 1}\n  - name: down\n    map: /d.yaml\n";
    let folder = folder(&[("maps.yaml", list), ("x.yaml", "")]);
    for path in [folder.path().to_owned(), folder.path().join("maps.yaml")] {
        let maps = set_of(path).unwrap().maps;
        assert_eq!(names(&maps), ["up", "down"]);
        assert_eq!(maps[0].yaml, folder.path().join("u.yaml"));
        assert_eq!(maps[0].floor.as_deref(), Some("1"));
        assert_eq!(
            (&*maps[1].yaml, &maps[1].floor),
            (Path::new("/d.yaml"), &None)
        );
    }
}

#[test]
fn maps_are_selected_by_their_names_and_by_their_floors() {
    let map = |(name, floor): (&str, Option<&str>)| MapFile {
        name: name.to_owned(),
        yaml: PathBuf::from("x.yaml"),
        floor: floor.map(str::to_owned),
    };
    let floors = [
        ("east", Some("1")),
        ("west", Some("1")),
        ("roof", Some("2")),
    ];
    let maps: Vec<MapFile> = floors
        .into_iter()
        .chain([("yard", None)])
        .map(map)
        .collect();
    let check = |on: &[&str], expected: &[&str]| {
        let on: Vec<String> = on.iter().map(|&name| name.to_owned()).collect();
        let set = MapSet::without_transitions(maps.clone());
        assert_eq!(names(&set.select(&on).unwrap().maps), expected, "{on:?}");
    };
    check(&[], &["east", "west", "roof", "yard"]);
    check(&["yard", "west"], &["west", "yard"]);
    check(&["1"], &["east", "west"]);
    check(&["2", "east", "2", "roof"], &["east", "roof"]);
    for wrong in ["3", "", "Yard"] {
        let on = ["1".to_owned(), wrong.to_owned()];
        let set = MapSet::without_transitions(maps.clone());
        let error = set.select(&on).unwrap_err().to_string();
        assert!(error.contains(&format!("{wrong:?} is neither")), "{error}");
        let there = "east (floor 1), west (floor 1), roof (floor 2), yard";
        assert!(error.contains(there), "{error}");
    }
}

const FLOORS: &str = "maps:
  - {name: cellar, map: c.yaml}
  - {name: ground, map: g.yaml}
  - {name: first, map: f.yaml}
";

#[test]
fn transitions_are_between_each_two_of_their_maps() {
    let lift = "transitions:
  - name: lift
    size: [1.6, 2]
    at: {ground: [12, 3.5, 0], cellar: [1, 2, -90], first: [-1.5, '3', 90]}
";
    let folder = folder(&[("maps.yaml", &format!("{FLOORS}{lift}"))]);
    let set = set_of(folder.path()).unwrap();
    let maps: Vec<[usize; 2]> = set.transitions.iter().map(|t| t.maps).collect();
    assert_eq!(maps, [[0, 2], [0, 1], [2, 1]]);
    let [_, down, up] = &set.transitions[..] else {
        panic!("three pairs of three maps");
    };
    assert_eq!((&*up.name, up.size_m), ("lift", [1.6, 2.0]));
    let quarter = std::f64::consts::FRAC_PI_2;
    assert_eq!(down.map_from_region[0], Pose::new(1.0, 2.0, -quarter));
    assert_eq!(up.map_from_region[0], Pose::new(-1.5, 3.0, quarter));
    // A selection keeps the transitions between its maps, with the new indices.
    let on = ["ground".to_owned(), "first".to_owned()];
    let some = set.select(&on).unwrap();
    assert_eq!(names(&some.maps), ["ground", "first"]);
    let maps: Vec<[usize; 2]> = some.transitions.iter().map(|t| t.maps).collect();
    assert_eq!(maps, [[1, 0]]);
}

#[test]
fn what_is_no_transition_is_refused_with_what_is_allowed() {
    let check = |lift: &str, expected: &str| {
        let list = format!("{FLOORS}transitions:\n  - {{name: lift, {lift}}}\n");
        let folder = folder(&[("maps.yaml", &list)]);
        let error = set_of(folder.path()).unwrap_err().to_string();
        assert!(error.contains(expected), "{lift}: {error}");
    };
    let two = "at: {ground: [1, 2, 3], first: [1, 2, 3]}";
    check(&format!("size: [0, 2], {two}"), "above 0 and up to 100 m");
    check(&format!("size: [1, 101], {two}"), "\"1\" x \"101\"");
    check(&format!("size: [1, 2, 3], {two}"), "3");
    check(&format!("size: [1, 2], sice: 3, {two}"), "sice");
    check("size: [1, 2], at: {ground: [1, 2, 3]}", "needed are two");
    check(
        "size: [1, 2], at: {ground: [1, 2, 3], roof: [1, 2, 3]}",
        "transition \"lift\": there is no map \"roof\": allowed are cellar, ground, first",
    );
    check(
        "size: [1, 2], at: {ground: [1, 2, x], first: [1, 2, 3]}",
        "its place on \"ground\" is not x and y",
    );
}

#[test]
fn what_is_no_set_is_refused_with_what_is_allowed() {
    let check = |list: &str, expected: &str| {
        let folder = folder(&[("maps.yaml", list)]);
        let error = set_of(folder.path()).unwrap_err().to_string();
        assert!(error.contains(expected), "{error}");
    };
    check("maps: []", "there are no maps");
    check(
        "maps:\n  - {name: a/b, map: x.yaml}",
        "1 to 64 of a-z A-Z 0-9",
    );
    check(
        "maps:\n  - {name: a, map: x.yaml}\n  - {name: a, map: y.yaml}",
        "both called \"a\"",
    );
    check("maps:\n  - {name: a, mapp: x.yaml}", "mapp");
    check("mapps: []", "mapps");
    let empty = folder(&[]);
    assert!(
        set_of(empty.path())
            .unwrap_err()
            .to_string()
            .contains("no maps")
    );
    assert!(set_of(empty.path().join("nowhere")).is_err());
    let twice = [PathBuf::from("a/x.yaml"), PathBuf::from("b/x.yaml")];
    assert!(set_of_files(&twice).is_err());
}
