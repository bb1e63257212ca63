//! Every topic within one process: its types, its limits, its graph.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use bytemuck::{bytes_of, bytes_of_mut, cast_slice, cast_slice_mut};
use messages::{MapHeader, ScanHeader, Topic, topic};
use transport::testing::Isolated;
use transport::{Graph, Publisher, Subscriber, TransportError};

fn pair<T: Topic>(graph: &Graph) -> (Publisher<T>, Subscriber<T>) {
    (graph.publisher().unwrap(), graph.subscriber().unwrap())
}

fn fill(bytes: &mut [u8], seed: u8) {
    for (i, byte) in bytes.iter_mut().enumerate() {
        *byte = (i as u8).wrapping_mul(7).wrapping_add(seed);
    }
}

fn round_trip<T: Topic>() {
    let isolated = Isolated::new(T::NAME.get(..11).unwrap_or(T::NAME));
    let graph = isolated.join("tester");
    let (publisher, subscriber) = pair::<T>(&graph);
    assert!(subscriber.receive().unwrap().is_none());
    // The second of equal size gets memory that the first has written to.
    for (seed, items) in [(1, 0), (2, 1), (3, 1000), (4, 1000), (5, 3)] {
        let mut loan = publisher.loan(items).unwrap();
        assert!(bytes_of(loan.header_mut()).iter().all(|&b| b == 0));
        assert_eq!(loan.items_mut().len(), items);
        let zero = cast_slice::<_, u8>(loan.items_mut())
            .iter()
            .all(|&b| b == 0);
        assert!(zero, "{items} items");
        fill(bytes_of_mut(loan.header_mut()), seed);
        fill(cast_slice_mut(loan.items_mut()), seed + 100);
        let header = bytes_of(loan.header_mut()).to_vec();
        let payload = cast_slice::<_, u8>(loan.items_mut()).to_vec();
        loan.send().unwrap();

        let sample = subscriber.receive().unwrap().unwrap();
        assert_eq!(bytes_of(sample.header()), header);
        assert_eq!(sample.items().len(), items);
        assert_eq!(cast_slice::<_, u8>(sample.items()), payload);
        assert!(subscriber.receive().unwrap().is_none());
    }
}

macro_rules! round_trips {
    ($($test:ident: $topic:ty),+ $(,)?) => {
        $(
            #[test]
            fn $test() {
                round_trip::<$topic>();
            }
        )+

        #[test]
        fn every_topic_is_tried() {
            assert_eq!([$(<$topic>::NAME),+], topic::NAMES);
        }
    };
}

round_trips! {
    scan_arrives: topic::Scan,
    odometry_arrives: topic::OdometryTopic,
    map_arrives: topic::Map,
    boundary_arrives: topic::Boundary,
    sets_of_maps_arrive: topic::Maps,
    votes_by_map_arrive: topic::VotesByMap,
    votes_arrive: topic::Votes,
    readings_arrive: topic::Readings,
    field_arrives: topic::Field,
    hypotheses_arrive: topic::Hypotheses,
    particles_arrive: topic::Particles,
    poses_arrive: topic::Tracked,
    attention_arrives: topic::Attention,
    initial_poses_arrive: topic::InitialPoseTopic,
    beams_arrive: topic::Beams,
    ground_truth_arrives: topic::GroundTruthTopic,
    regions_arrive: topic::Region,
    requests_to_save_arrive: topic::Save,
    health_arrives: topic::Health,
    log_arrives: topic::Log,
}

#[test]
fn graphs_side_by_side_do_not_receive_each_other() {
    let (here, there) = (Isolated::new("here"), Isolated::new("there"));
    let one = here.join("one");
    let other = there.join("other");
    let (publisher, subscriber) = pair::<topic::Scan>(&one);
    let stranger = other.subscriber::<topic::Scan>().unwrap();
    let lonely = other.publisher::<topic::Map>().unwrap();

    publisher.loan(10).unwrap().send().unwrap();

    assert!(subscriber.receive().unwrap().is_some());
    assert!(stranger.receive().unwrap().is_none());
    assert!(!lonely.has_subscribers());
    assert!(publisher.has_subscribers());
}

#[test]
fn an_unsent_loan_is_given_back() {
    let isolated = Isolated::new("unsent");
    let graph = isolated.join("tester");
    let (publisher, subscriber) = pair::<topic::Scan>(&graph);
    for _ in 0..100 {
        drop(publisher.loan(10).unwrap());
    }
    assert!(subscriber.receive().unwrap().is_none());
    let _first = publisher.loan(1).unwrap();
    let _second = publisher.loan(1).unwrap();
    let third = publisher.loan(1).unwrap_err();
    assert!(matches!(third, TransportError::Loan { items: 1, .. }));
}

#[test]
fn impossible_sizes_are_refused() {
    let isolated = Isolated::new("sizes");
    let graph = isolated.join("tester");
    let publisher = graph.publisher::<topic::Scan>().unwrap();
    let error = publisher.loan(usize::MAX / 2).unwrap_err();
    let is_too_large = matches!(error, TransportError::TooLarge { item_bytes: 4, .. });
    assert!(is_too_large, "{error}");
    // More than any machine's memory, yet a size that arithmetic can hold.
    let error = publisher.loan(1 << 50).unwrap_err();
    assert!(
        matches!(error, TransportError::SharedMemoryFull { needed, .. } if needed >= 1 << 52),
        "{error}"
    );
    publisher.loan(1).unwrap().send().unwrap();
}

/// Topic `map` as used by a process with another version of its header.
#[derive(Debug)]
struct OtherMap;

impl Topic for OtherMap {
    const NAME: &'static str = topic::Map::NAME;
    type Header = ScanHeader;
    type Item = u8;
}

#[test]
fn another_version_of_a_message_is_refused_by_name() {
    let isolated = Isolated::new("versions");
    let graph = isolated.join("tester");
    let _map = graph.publisher::<topic::Map>().unwrap();
    let error = graph.subscriber::<OtherMap>().unwrap_err();
    let text = error.to_string();
    let is_meant = matches!(error, TransportError::TypeMismatch { topic: "map", .. });
    assert!(is_meant, "{text}");
    // Both names have a version number and a size.
    for (whose, header, size) in [
        ("carries", "MapHeader", size_of::<MapHeader>()),
        ("expects", "ScanHeader", size_of::<ScanHeader>()),
    ] {
        let (_, rest) = text.split_once(&format!("{whose} {header}/v")).unwrap();
        let (version, rest) = rest.split_once(' ').unwrap();
        assert!(version.parse::<u32>().is_ok(), "{text}");
        let size = format!("({size} bytes) with [u8]");
        assert!(rest.starts_with(&size), "{text}");
    }
}

#[test]
fn a_topic_has_no_more_publishers_and_subscribers_than_it_allows() {
    let isolated = Isolated::new("limits");
    let graph = isolated.join("tester");
    let publishers: Vec<_> = (0..topic::Scan::MAX_PUBLISHERS)
        .map(|_| graph.publisher::<topic::Scan>().unwrap())
        .collect();
    let error = graph.publisher::<topic::Scan>().unwrap_err().to_string();
    assert!(error.contains("topic scan has 8 publishers"), "{error}");
    drop(publishers);
    graph.publisher::<topic::Scan>().unwrap();

    let subscribers: Vec<_> = (0..topic::Scan::MAX_SUBSCRIBERS)
        .map(|_| graph.subscriber::<topic::Scan>().unwrap())
        .collect();
    let error = graph.subscriber::<topic::Scan>().unwrap_err().to_string();
    assert!(error.contains("topic scan has 8 subscribers"), "{error}");
    drop(subscribers);
    graph.subscriber::<topic::Scan>().unwrap();
}

#[test]
fn names_of_nodes_are_checked() {
    let isolated = Isolated::new("names");
    for name in ["", &"x".repeat(33)] {
        let error = Graph::join_named(name, isolated.name()).unwrap_err();
        assert!(matches!(error, TransportError::NodeName { name: n } if n == name));
    }
}
