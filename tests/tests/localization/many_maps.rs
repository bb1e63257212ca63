//! Several maps that are searched together: a result that is Unique on its own map stays so and
//! names that map, and no other result becomes Unique.

use std::path::{Path, PathBuf};

use geometry::Pose;
use serde_json::Value;
use tests::executables;
use tests::world::World;

/// Maps of one drive, each of which contains places of the other.
const ONE_DRIVE: [&str; 2] = ["malaga_campus", "malaga_courtyard"];

struct Building {
    name: String,
    map: PathBuf,
    scans: PathBuf,
}

fn shipped() -> Vec<Building> {
    let building = |name: &str| {
        let world = World::of(name);
        Building {
            name: name.to_owned(),
            map: world.map(),
            scans: world.recording(),
        }
    };
    let names = ["malaga_campus", "malaga_courtyard", "malaga_corridor"];
    names.map(building).into()
}

/// Returns the output of `locate` for every n-th scan on these maps.
fn locate(scans: &Path, maps: &[&Path], every: usize) -> Vec<Value> {
    let mut command = executables::backcast();
    command.args(["locate", "--json", "--every", &every.to_string()]);
    for map in maps {
        command.arg("--map").arg(map);
    }
    tests::json_lines_of(command.arg(scans))
}

fn is_near(a: &Value, b: &Value) -> bool {
    let [a, b] = [a, b].map(|found| {
        let of = |key: &str| found["laser"][key].as_f64().unwrap();
        Pose::new(of("x"), of("y"), of("yaw"))
    });
    a.is_within(b, 0.5, 10f64.to_radians())
}

/// Compares the results on all maps together with those on the own map; returns the number of scans
/// that are Unique on the own map, and how many of these are Unique on all.
fn compare(buildings: &[Building], building: &Building, every: usize) -> (usize, usize) {
    let maps: Vec<&Path> = buildings.iter().map(|other| &*other.map).collect();
    let alone = locate(&building.scans, &[&building.map], every);
    let together = locate(&building.scans, &maps, every);
    assert_eq!(alone.len(), together.len());
    let (mut certain, mut kept) = (0, 0);
    for (alone, together) in alone.iter().zip(&together) {
        let stamp = &alone["stamp_ns"];
        let map = together["map"].as_str().unwrap();
        let shares_drive = ONE_DRIVE.contains(&map) && ONE_DRIVE.contains(&&*building.name);
        if together["verdict"] == "Unique" {
            assert!(map == building.name || shares_drive, "{stamp}: {map}");
            assert!(shares_drive || is_near(alone, together), "{stamp}");
            assert!(shares_drive || alone["verdict"] == "Unique", "{stamp}");
        }
        if alone["verdict"] == "Unique" {
            certain += 1;
            assert!(map == building.name || shares_drive, "{stamp}: {map}");
            let is_kept = shares_drive || is_near(alone, together);
            assert!(is_kept, "{stamp}: another place of {map}");
            kept += usize::from(shares_drive || together["verdict"] == "Unique");
        }
    }
    (certain, kept)
}

#[test]
fn maps_that_are_searched_together_name_the_right_one() {
    let buildings = shipped();
    for (building, every) in buildings.iter().zip([40, 20, 4]) {
        let (certain, kept) = compare(&buildings, building, every);
        assert!(certain >= 3, "{}: {certain}", building.name);
        assert_eq!(kept, certain, "{}", building.name);
    }
}

#[test]
fn eight_buildings_that_are_searched_together_keep_what_is_right() {
    let test = "eight_buildings_that_are_searched_together_keep_what_is_right";
    let Some(data) = tests::evaluation_data(test) else {
        return;
    };
    let mut buildings = shipped();
    for name in ["intel", "fr079", "csail", "aces", "seattle"] {
        let scans = data.join(format!("{name}_queries.mcap"));
        buildings.push(Building {
            name: format!("{name}_queries"),
            map: scans.clone(),
            scans,
        });
    }
    let (mut certain, mut kept) = (0, 0);
    for building in &buildings[3..] {
        let found = compare(&buildings, building, 20);
        (certain, kept) = (certain + found.0, kept + found.1);
    }
    assert!(certain > 40, "{certain}");
    // Places on other maps are alternatives now; all results are right, as checked above.
    assert!(kept * 10 >= certain * 9, "{kept} of {certain}");
}

/// Makes a folder whose list names two maps, one of them with a floor.
fn hall_and_yard() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let text = format!(
        "maps:\n  - {{name: hall, map: {}, floor: 2}}\n  - {{name: yard, map: {}}}\n",
        World::of("malaga_corridor").map().display(),
        World::of("malaga_courtyard").map().display()
    );
    std::fs::write(folder.path().join("maps.yaml"), text).unwrap();
    folder
}

#[test]
fn a_set_of_maps_is_a_folder_or_a_list_of_which_a_part_may_be_searched() {
    let folder = hall_and_yard();
    let list = folder.path().join("maps.yaml");
    let world = World::of("malaga_corridor");
    let scans = world.recording();
    let locate_on = |set: &Path, options: &[&str]| {
        let mut command = executables::backcast();
        command.args(["locate", "--json", "--every", "20"]);
        command.args(options).arg("--maps").arg(set).arg(&scans);
        command
    };
    for (set, options, map) in [
        (folder.path(), &[][..], "hall"),
        (&list, &[], "hall"),
        (&list, &["--on", "2"], "hall"),
        (&list, &["--on", "yard,2"], "hall"),
        (&list, &["--on", "yard"], "yard"),
    ] {
        let found = &tests::json_lines_of(&mut locate_on(set, options))[0];
        assert_eq!(found["map"], map, "{options:?}");
        // On the yard's map alone the scan is not found.
        let is_hall = map == "hall";
        assert_eq!(found["verdict"] == "Unique", is_hall, "{options:?}");
        assert!(!is_hall || found["floor"] == "2", "{found}");
        assert!(!is_hall || found["hypotheses"][0]["map"] == map, "{found}");
    }
    let outcome = locate_on(&list, &["--on", "hall,attic"]).output().unwrap();
    assert_eq!(outcome.status.code(), Some(1));
    let said = String::from_utf8_lossy(&outcome.stderr);
    let expected = "\"attic\" is neither a map nor a floor: allowed are hall (floor 2), yard";
    assert!(said.contains(expected), "{said}");
    // A single map has no name.
    let found = locate(&scans, &[&world.map()], 20);
    assert_eq!(found[0]["map"], Value::Null);
}
