//! The whole graph on the recording that `cargo run` plays.

use engine::vote_search::Prior;
use geometry::Pose;
use tests::world::{World, as_engine_takes_it};
use tests::{answers, executables};

/// After a change that is meant to change results, `backcast regress --accept` writes them again;
/// review the difference before committing it.
#[test]
fn the_graph_answers_as_expected() {
    let world = World::of("malaga_corridor");
    let mut command = executables::backcast();
    command.current_dir(tests::root());
    let table = tests::text_of(command.arg("regress").arg(&world.folder));
    assert!(table.contains("malaga_corridor: 37 scans"), "{table}");
}

#[test]
fn the_graph_answers_as_the_engine_alone() {
    let world = World::of("malaga_corridor");
    let scans = world.scans();
    let answers = answers::of_graph(
        "corridor",
        &world.recording(),
        &world.map(),
        scans.len(),
        &[],
        &[],
    );

    let vote_search = world.vote_search(Prior::None);
    for (scan, (header, votes)) in scans.iter().zip(&answers.votes) {
        let outcome = vote_search
            .search(&as_engine_takes_it(scan), &|| false)
            .unwrap()
            .unwrap();
        assert_eq!(*votes, outcome.found.votes);
        assert_eq!(header.poses_evaluated, outcome.found.poses_evaluated);
    }
}

#[test]
fn with_known_headings_the_graph_finds_the_same_places() {
    let world = World::of("malaga_corridor");
    let scans = world.scans();
    let answers = answers::of_graph(
        "heading",
        &world.recording(),
        &world.map(),
        scans.len(),
        &["--heading-from", "truth"],
        &[],
    );
    let truths = world.truths();
    for (header, hypotheses) in &answers.hypotheses {
        let truth = truths[&header.stamp.measured_ns].pose;
        let best = Pose::from(hypotheses[0].map_from_laser);
        assert!(
            best.is_within(truth, 0.5, 1e-9),
            "{best:?} is not {truth:?}, whose heading was given"
        );
    }
    let vote_search = world.vote_search(Prior::Heading);
    for (scan, (header, votes)) in scans.iter().zip(&answers.votes) {
        assert_eq!(header.heading_known, 1);
        let asked =
            vote_search.search_at(&as_engine_takes_it(scan), header.known_heading, &|| false);
        let (outcome, _) = asked.unwrap().unwrap();
        assert_eq!(*votes, outcome.found.votes);
    }
}
