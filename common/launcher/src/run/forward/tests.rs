use command_line::exit_code;

use super::*;
use crate::run::testing::parsed;

fn graph(replayer_args: &str, inputs: &str) -> Dataflow {
    let text = format!(
        "nodes:
  - {{id: r, path: bin/replayer, outputs: [scan, odometry, ground_truth], args: \"{replayer_args}\"}}
  - {{id: a, path: bin/accumulator, args: --beams 9, inputs: {{{inputs}}}}}
"
    );
    parsed(&text)
}

fn applied(options: &Options, mut dataflow: Dataflow) -> anyhow::Result<Vec<Vec<String>>> {
    apply(options, &mut dataflow, Path::new("g.yaml"))?;
    Ok(dataflow.nodes.into_iter().map(|n| n.args).collect())
}

#[test]
fn options_replace_what_the_descriptor_gives() {
    let options = Options {
        rate: Some(Rate::Times(2.0)),
        repeat: true,
        ..Options::default()
    };
    for before in ["x --rate max y", "x --rate=0.5 y --loop", "x y"] {
        let args = applied(&options, graph(before, "")).unwrap();
        assert_eq!(args[0], ["x", "y", "--rate=2", "--loop"], "{before}");
        assert_eq!(args[1], ["--beams", "9"]);
    }
}

#[test]
fn a_recording_is_played_on_its_own_map_unless_another_is_given() {
    let map_args = |options: &Options| {
        let mut dataflow = graph("", "");
        dataflow.nodes[1].path = "bin/map_server".to_owned();
        applied(options, dataflow).unwrap().swap_remove(1)
    };
    let mut options = Options {
        replay: vec!["/drive.mcap".into()],
        ..Options::default()
    };
    assert_eq!(
        map_args(&options),
        ["--beams", "9", "--recorded=/drive.mcap"]
    );
    options.map = Some("/other.yaml".into());
    let expected = ["--beams", "9", "--map=/other.yaml", "--played=/drive.mcap"];
    assert_eq!(map_args(&options), expected);
    // Which of several recordings has the map of all is not known.
    options.map = None;
    options.replay.push("/rest.mcap".into());
    assert_eq!(map_args(&options), ["--beams", "9"]);
}

fn with(heading: HeadingConfig) -> Options {
    Options {
        heading,
        ..Options::default()
    }
}

#[test]
fn headings_reach_the_accumulator() {
    let fixed = with(HeadingConfig {
        heading: Some(-90.0),
        ..HeadingConfig::default()
    });
    let args = applied(&fixed, graph("", "")).unwrap();
    assert_eq!(args[1], ["--beams", "9", "--heading=-90"]);
    let mut aged = graph("", "");
    aged.nodes[1].args = ["--heading-from=odometry", "--heading-max-age-s", "3"]
        .map(Into::into)
        .into();
    assert_eq!(applied(&fixed, aged).unwrap()[1], ["--heading=-90"]);

    let odometry = with(HeadingConfig {
        heading_from: Some(HeadingFrom::Odometry),
        heading_offset: Some(-1.5),
        ..HeadingConfig::default()
    });
    let mut wired = graph("", "odometry: r/odometry");
    wired.nodes[1].args = ["--heading", "7", "--heading-max-age-s=3"]
        .map(Into::into)
        .into();
    let args = applied(&odometry, wired).unwrap();
    assert_eq!(
        args[1],
        [
            "--heading-max-age-s=3",
            "--heading-from=odometry",
            "--heading-offset=-1.5"
        ]
    );
    let error = applied(&odometry, graph("", "")).unwrap_err();
    let wired = "--heading-from needs the input `odometry` at node a, but";
    assert!(error.to_string().starts_with(wired), "{error}");
}

#[test]
fn the_true_heading_has_no_offset() {
    let mut options = with(HeadingConfig {
        heading_from: Some(HeadingFrom::Truth),
        ..HeadingConfig::default()
    });
    let wired = || graph("", "odometry: r/odometry, ground_truth: r/ground_truth");
    let args = applied(&options, wired()).unwrap();
    assert_eq!(args[1], ["--beams", "9", "--heading-from=truth"]);
    options.heading.heading_offset = Some(1.0);
    let error = applied(&options, wired()).unwrap_err();
    assert_eq!(
        error.to_string(),
        "--heading-offset needs --heading-from odometry"
    );
}

#[test]
fn an_option_without_its_node_is_refused() {
    let mut no_replayer = graph("", "");
    no_replayer.nodes.remove(0);
    let options = Options {
        repeat: true,
        ..Options::default()
    };
    let error = applied(&options, no_replayer).unwrap_err();
    assert_eq!(exit_code(&error), 2);
    let said = error.to_string();
    assert!(said.contains("--loop is for the replayer"), "{said}");
    assert!(said.contains("its executables are accumulator"), "{said}");
}

#[test]
fn a_graph_on_a_set_is_run_on_another_one_on_a_map_or_on_a_recording() {
    let text = "nodes:
  - {id: m, path: bin/map_server, args: --maps floors/ --on ground}
  - {id: r, path: bin/replayer, outputs: [scan]}
";
    let map_args = |map: Option<&str>, maps: Option<&str>, replay: &[&str]| {
        let options = Options {
            map: map.map(Into::into),
            maps: maps.map(Into::into),
            replay: replay.iter().map(Into::into).collect(),
            ..Options::default()
        };
        applied(&options, parsed(text)).unwrap().swap_remove(0)
    };
    let drive = ["/drive.mcap"];
    assert_eq!(map_args(Some("/b.yaml"), None, &[]), ["--map=/b.yaml"]);
    assert_eq!(map_args(None, Some("/other"), &[]), ["--maps=/other"]);
    assert_eq!(map_args(None, Some("/other"), &drive), ["--maps=/other"]);
    assert_eq!(
        map_args(Some("/b.yaml"), None, &drive),
        ["--map=/b.yaml", "--played=/drive.mcap"]
    );
    assert_eq!(
        map_args(None, None, &drive),
        ["--maps", "floors/", "--on", "ground"]
    );
}

#[test]
fn monitors_stay_unless_they_are_left_out() {
    let text = "nodes: [{id: a, path: bin/accumulator}, {id: page, path: bin/monitor}]";
    let nodes = |no_monitor| {
        let options = Options {
            no_monitor,
            ..Options::default()
        };
        applied(&options, parsed(text)).unwrap().len()
    };
    assert_eq!((nodes(false), nodes(true)), (2, 1));
}

#[test]
fn a_point_cloud_goes_to_the_replayer_in_place_of_scans() {
    let mut options = Options {
        replay: vec!["/a.mcap".into()],
        ..Options::default()
    };
    options.cloud.cloud_topic = Some("/points".to_owned());
    options.cloud.cloud_mount = Some("0.5,0,-1,0".parse().unwrap());
    let args = applied(&options, graph("--scan-topic /scan", "")).unwrap();
    let expected = [
        "--recording=/a.mcap",
        "--cloud-topic=/points",
        "--heights=0.2,0.6",
        "--cloud-mount=0.5,0,-1,0,0,0",
    ];
    assert_eq!(args[0], expected);
    options.replay.clear();
    let refusal = applied(&options, graph("", "")).unwrap_err().to_string();
    assert!(refusal.contains("allowed with --replay"), "{refusal}");
}

#[test]
fn recordings_and_their_topics_go_to_the_replayer() {
    let options = Options {
        replay: vec!["/a.mcap".into(), "/b".into()],
        scan_topic: vec!["/front/scan".to_owned()],
        odom_topic: Some("/wheels".to_owned()),
        ..Options::default()
    };
    let before = "--recording x.mcap --rate=max --scan-topic /scan";
    let args = applied(&options, graph(before, "")).unwrap();
    let expected = [
        "--rate=max",
        "--recording=/a.mcap",
        "--recording=/b",
        "--scan-topic=/front/scan",
        "--odom-topic=/wheels",
    ];
    assert_eq!(args[0], expected);
    let options = Options {
        map_topic: Some("/map".to_owned()),
        ..options
    };
    let refusal = applied(&options, graph("", "")).unwrap_err().to_string();
    assert!(refusal.contains("from the map_server"), "{refusal}");
}
