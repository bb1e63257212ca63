//! A set of maps, divided over servers.

use engine::peaks::{PeakConfig, Place};
use locate_server::{
    LocateError, OverMaps, PART, PART_ANSWER, Part, SearchedMap, Shard, Workspace, ask_shards,
};
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
    shard_with(tag, set, shard, &[])
}

/// A server of a shard with further options.
fn shard_with(tag: &str, set: &tempfile::TempDir, shard: &str, options: &[&str]) -> Server {
    let set = set.path().to_str().unwrap();
    let common = ["--maps", set, "--name", "malaga", "--shard", shard];
    Server::of(tag, &[&common[..], &["--workers", "1"], options].concat())
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
    let connect = first.endpoint();
    let tag = format!("replica{number}");
    shard_with(&tag, set, "2/2", &["--connect", &connect])
}

#[test]
fn shards_that_judge_by_another_score_are_not_merged() {
    let set = list();
    let by_votes = shard_with("by_votes", &set, "1/1", &["--score", "votes"]);
    let scan = &scans_of("malaga_courtyard", 40)[0];
    let error = ask_all(&caller(&[&by_votes]), scan, TIMEOUT).unwrap_err();
    let says = error.to_string();
    assert!(says.contains("another --score than the caller"), "{says}");
    by_votes.process.stop();
}

/// What one shard answers to a question of this number.
fn ask_part(session: &Session, question: (u64, u64), scan: &Scan) -> Part {
    let preamble = Preamble {
        sender: 1,
        sequence: 1,
        clock_ns: 0,
    };
    let scan = network_payload::encode::<topic::Scan>(&preamble, &scan.0, &scan.1).unwrap();
    let replies = session
        .get("backcast/locate/malaga.1-of-2?deadline_ms=60000")
        .payload(postcard::to_allocvec(&(question, scan)).unwrap())
        .encoding(Encoding::from(PART))
        .timeout(TIMEOUT)
        .wait()
        .unwrap();
    let sample = replies.recv().unwrap().into_result().unwrap();
    assert_eq!(sample.encoding().to_string(), PART_ANSWER);
    postcard::from_bytes(&sample.payload().to_bytes()).unwrap()
}

#[test]
fn a_shard_leaves_out_what_has_too_few_votes_beside_what_it_is_told() {
    let set = list();
    let server = shard("told", &set, "1/2");
    let session = caller(&[&server]);
    let scan = &scans_of("malaga_courtyard", 40)[0];
    let tell = |bytes: Vec<u8>| {
        let key = "backcast/locate/malaga.1-of-2/lead";
        session.put(key, bytes).wait().unwrap();
    };
    // The places that have not half of all votes that are possible.
    let low = |part: &Part| {
        let value = serde_json::to_value(part).unwrap();
        let places = value["places"].as_array().unwrap().clone();
        let votes = |place: &serde_json::Value, key: &str| place[key].as_u64().unwrap();
        let is_low =
            |place: &&serde_json::Value| 2 * votes(place, "intensity") < votes(place, "possible");
        places.iter().filter(is_low).count()
    };
    let alone = ask_part(&session, (7, 1), scan);
    assert!(low(&alone) > 0 && alone.beside != (1, 1), "{alone:?}");
    // A pose with all votes that are possible, of another shard. Where a question has the number
    // of another one, it is beside what is known of that.
    let lead = postcard::to_allocvec(&((7u64, 2u64), (1u16, 1u16))).unwrap();
    tell(lead);
    for _ in 0..2 {
        let part = ask_part(&session, (7, 2), scan);
        assert_eq!((low(&part), part.beside), (0, (1, 1)));
    }
    assert_eq!(ask_part(&session, (7, 3), scan).beside, alone.beside);
    let health = server.graph.subscriber::<topic::Health>().unwrap();
    tell(vec![0xff]);
    wait_for_health(&server.graph, &health, |report| report.refused == 1);
    server.process.stop();
}

#[test]
fn a_server_that_is_asked_again_is_told_again_what_the_others_have() {
    let set = list();
    let server = shard("tells", &set, "1/2");
    // One that says that it has the other shard, and has none.
    let isolated = Isolated::new("standin");
    let there = endpoint(&isolated);
    let other = session(std::slice::from_ref(&there), &[]);
    let (said, leads) = unbounded();
    let _leads = other
        .declare_subscriber("backcast/locate/malaga.2-of-2/lead")
        .callback(move |sample| said.send(sample.payload().to_bytes().into_owned()).unwrap())
        .wait()
        .unwrap();
    let (_silent, kept) = stand_silent(&other, "backcast/locate/malaga.2-of-2");
    let me = other.zid();
    let token = format!("backcast/locate/malaga.2-of-2/{me}/ff/ff/1");
    let _token = other.liveliness().declare_token(token).wait().unwrap();
    let session = session(&[], &[server.endpoint(), there]);
    let scan = &scans_of("malaga_courtyard", 40)[0];
    std::thread::scope(|scope| {
        let asking = scope.spawn(|| ask_all(&session, scan, TIMEOUT));
        let first = kept.recv_timeout(TIMEOUT).unwrap();
        let lead = leads.recv_timeout(TIMEOUT).expect("the first shard has it");
        // Another server would take over.
        drop(first);
        let again = leads.recv_timeout(TIMEOUT).expect("it is sent again");
        assert_eq!(again, lead);
        // All that are under way.
        while !asking.is_finished() {
            if let Ok(query) = kept.recv_timeout(Duration::from_millis(10)) {
                let _ = query.reply_err("enough").encoding(REFUSED).wait();
            }
        }
        let answer = asking.join().unwrap();
        assert!(matches!(answer, Err(LocateError::Refused { .. })));
    });
    server.process.stop();
}
