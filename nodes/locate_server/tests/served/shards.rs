//! A set of maps, divided over servers.

use engine::peaks::{PeakConfig, Place};
use locate_server::{LocateError, OverMaps, SearchedMap, Shard, Workspace, ask_shards};
use messages::Verdict;

use super::*;

/// The maps that are shipped, in the order of the set.
const MAPS: [&str; 3] = ["malaga_campus", "malaga_corridor", "malaga_courtyard"];

/// A folder with the list of the maps.
fn list() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let mut text = "maps:\n".to_owned();
    for name in MAPS {
        let map = World::of(name).map();
        text += &format!("  - {{name: {name}, map: {}}}\n", map.display());
    }
    std::fs::write(folder.path().join("maps.yaml"), text).unwrap();
    folder
}

fn shard(tag: &str, set: &tempfile::TempDir, shard: &str) -> Server {
    let set = set.path().to_str().unwrap();
    Server::of(
        tag,
        &[
            "--maps",
            set,
            "--name",
            "malaga",
            "--shard",
            shard,
            "--workers",
            "1",
        ],
    )
}

/// Every so many-th scan of a recording.
fn scans_of(name: &str, every: usize) -> Vec<Scan> {
    let recorded = World::of(name).scans().into_iter().zip(0..);
    recorded
        .step_by(every)
        .map(|(scan, counter)| (as_the_graph_has_it(&scan, counter), scan.ranges))
        .collect()
}

fn ask_all(session: &Session, scan: &Scan, deadline: Duration) -> Result<OverMaps, LocateError> {
    let asked = (&scan.0, scan.1.as_slice());
    ask_shards(session, "malaga", asked, deadline, &PeakConfig::default())
}

/// All maps in one process.
fn whole() -> Locator {
    let maps = (0..).zip(MAPS).map(|(number, name)| {
        let map = map::load(World::of(name).map()).unwrap();
        let named = (number, name.to_owned());
        SearchedMap::new(named, &map, Default::default(), Default::default()).unwrap()
    });
    let names = MAPS.map(str::to_owned).into();
    Locator::of_set(maps.collect(), (Shard::WHOLE, names), 0.0)
}

#[test]
fn shards_that_are_merged_answer_as_one_server_that_has_all_maps() {
    let set = list();
    let servers = [
        shard("shard_one", &set, "1/2"),
        shard("shard_two", &set, "2/2"),
    ];
    let session = caller(&[&servers[0], &servers[1]]);
    let (locator, mut workspace) = (whole(), Workspace::default());
    let mut found = [0; 3];
    for (name, every) in [("malaga_corridor", 6), ("malaga_courtyard", 40)] {
        for scan in scans_of(name, every) {
            let asked = (&scan.0, scan.1.as_slice());
            let merged = ask_all(&session, &scan, TIMEOUT).unwrap();
            let expected = locator.locate(&mut workspace, asked, &|| false).unwrap();
            let (header, hypotheses) = expected.unwrap();
            let best: &Place = &merged.places.places[0];
            assert_eq!(
                Some(&*merged.maps[best.map as usize]),
                locator.name_of(header.map_id)
            );
            // To the last bit: both come of the same search.
            assert_eq!(
                messages::Pose2::from(best.map_from_laser),
                hypotheses[0].map_from_laser
            );
            assert_eq!(best.score as f32, hypotheses[0].score);
            assert_eq!(merged.places.verdict as u32, header.verdict);
            assert_eq!(merged.not_searched, Vec::<String>::new());
            found[best.map as usize] += 1;
        }
    }
    assert!(found[1] > 3, "{found:?}");
    for server in servers {
        server.process.stop();
    }
}

#[test]
fn a_shard_that_nobody_holds_is_named_and_nothing_is_unique_then() {
    let set = list();
    let first = shard("shard_left", &set, "1/2");
    let second = shard("shard_gone", &set, "2/2");
    let session = caller(&[&first, &second]);
    let scan = &scans_of("malaga_courtyard", 40)[0];
    assert_eq!(
        ask_all(&session, scan, TIMEOUT).unwrap().not_searched.len(),
        0
    );
    second.process.kill();
    // Long enough for the shard that is there.
    let found = ask_all(&session, scan, Duration::from_secs(5)).unwrap();
    assert_eq!(found.not_searched, ["malaga_corridor"]);
    assert!(!found.places.places.is_empty());
    assert_ne!(found.places.verdict, Verdict::Unique);
    first.process.stop();
    let error = ask_all(&session, scan, Duration::from_millis(300)).unwrap_err();
    assert!(matches!(error, LocateError::Late { .. }), "{error}");
}

#[test]
fn a_shard_with_another_server_loses_no_question_when_one_is_killed() {
    // How often one is killed; more where somebody waits for it.
    let kills = std::env::var("BACKCAST_TEST_KILLS");
    let kills: usize = kills.map_or(5, |text| text.parse().unwrap());
    assert!(kills > 0);
    let set = list();
    let first = shard("shard_only", &set, "1/2");
    let session = session(&[], &[first.endpoint()]);
    let scans = scans_of("malaga_corridor", 1);
    let mut scan = scans.iter().cycle();
    let mut held = shard_of(&first, &set, 0);
    for kill in 1..=kills {
        let mut next = shard_of(&first, &set, kill);
        // Which of both is killed is random, with a fixed seed: the one that takes the requests,
        // which has run longer, or the other one.
        if kill.wrapping_mul(0x9e37_79b9) >> 16 & 1 == 0 {
            std::mem::swap(&mut held, &mut next);
        }
        // Both hold it now; which one answers is not known.
        std::thread::scope(|scope| {
            let asked: Vec<&Scan> = scan.by_ref().take(4).collect();
            let session = &session;
            let asking = scope.spawn(move || {
                for scan in asked {
                    let found = ask_all(session, scan, TIMEOUT).unwrap();
                    assert_eq!(found.not_searched, Vec::<String>::new());
                    assert_eq!(found.map(), Some("malaga_corridor"));
                }
            });
            std::mem::replace(&mut held, next).process.kill();
            asking.join().unwrap();
        });
    }
    held.process.stop();
    first.process.stop();
}

/// A server of the other shard that meets its callers and its replicas at the first one.
fn shard_of(first: &Server, set: &tempfile::TempDir, number: usize) -> Server {
    let (set, connect) = (set.path().to_str().unwrap(), first.endpoint());
    let arguments = [
        "--maps",
        set,
        "--name",
        "malaga",
        "--shard",
        "2/2",
        "--workers",
        "1",
    ];
    let connect = ["--connect", &connect];
    Server::of(
        &format!("replica{number}"),
        &[&arguments[..], &connect].concat(),
    )
}
