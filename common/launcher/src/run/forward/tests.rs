use command_line::exit_code;

use super::*;
use crate::run::testing::{options, parsed};

fn graph(replayer_args: &str, inputs: &str) -> Dataflow {
    let text = format!(
        "nodes:
  - {{id: r, path: bin/replayer, outputs: [scan, odometry, ground_truth], args: \"{replayer_args}\"}}
  - {{id: a, path: bin/accumulator, args: --beams 9, inputs: {{{inputs}}}}}
"
    );
    parsed(&text)
}

fn words(line: &str) -> Vec<String> {
    line.split(' ').map(Into::into).collect()
}

fn applied(options: &Options, mut dataflow: Dataflow) -> anyhow::Result<Vec<Vec<String>>> {
    apply(options, &mut dataflow, Path::new("g.yaml"))?;
    Ok(dataflow.nodes.into_iter().map(|n| n.args).collect())
}

#[test]
fn options_replace_what_the_descriptor_gives() {
    let options = options("--rate 2 --loop");
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
    for (line, expected) in [
        ("--replay /a.mcap", &["--recorded=/a.mcap"][..]),
        (
            "--replay /a.mcap --map /b.yaml",
            &["--map=/b.yaml", "--played=/a.mcap"],
        ),
        // Which of several recordings has the map of all is not known.
        ("--replay /a.mcap --replay /b.mcap", &[]),
    ] {
        let expected = [&["--beams", "9"], expected].concat();
        assert_eq!(map_args(&options(line)), expected, "{line}");
    }
}

#[test]
fn headings_reach_the_accumulator() {
    let fixed = options("--heading=-90");
    let args = applied(&fixed, graph("", "")).unwrap();
    assert_eq!(args[1], ["--beams", "9", "--heading=-90"]);
    let mut aged = graph("", "");
    aged.nodes[1].args = words("--heading-from=odometry --heading-max-age-s 3");
    assert_eq!(applied(&fixed, aged).unwrap()[1], ["--heading=-90"]);

    let odometry = options("--heading-from odometry --heading-offset=-1.5");
    let mut wired = graph("", "odometry: r/odometry");
    wired.nodes[1].args = words("--heading 7 --heading-max-age-s=3");
    let args = applied(&odometry, wired).unwrap();
    let expected = "--heading-max-age-s=3 --heading-from=odometry --heading-offset=-1.5";
    assert_eq!(args[1], words(expected));
    let error = applied(&odometry, graph("", "")).unwrap_err();
    let wired = "--heading-from needs the input `odometry` at node a, but";
    assert!(error.to_string().starts_with(wired), "{error}");
}

#[test]
fn the_true_heading_has_no_offset() {
    let mut options = options("--heading-from truth");
    let wired = || graph("", "odometry: r/odometry, ground_truth: r/ground_truth");
    let args = applied(&options, wired()).unwrap();
    assert_eq!(args[1], ["--beams", "9", "--heading-from=truth"]);
    options.heading.heading_offset = Some(1.0);
    let error = applied(&options, wired()).unwrap_err();
    let expected = "--heading-offset needs --heading-from odometry";
    assert_eq!(error.to_string(), expected);
}

#[test]
fn an_option_without_its_node_is_refused() {
    let mut no_replayer = graph("", "");
    no_replayer.nodes.remove(0);
    let error = applied(&options("--loop"), no_replayer).unwrap_err();
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
    for (line, expected) in [
        ("--map /b.yaml", "--map=/b.yaml"),
        ("--maps /other", "--maps=/other"),
        ("--maps /other --replay /a.mcap", "--maps=/other"),
        (
            "--map /b.yaml --replay /a.mcap",
            "--map=/b.yaml --played=/a.mcap",
        ),
        ("--replay /a.mcap", "--maps floors/ --on ground"),
    ] {
        let args = applied(&options(line), parsed(text)).unwrap();
        assert_eq!(args[0], words(expected), "{line}");
    }
}

#[test]
fn monitors_stay_unless_they_are_left_out() {
    let text = "nodes: [{id: a, path: bin/accumulator}, {id: page, path: bin/monitor}]";
    let nodes = |line| applied(&options(line), parsed(text)).unwrap().len();
    assert_eq!((nodes("--json"), nodes("--no-monitor")), (2, 1));
}

#[test]
fn a_point_cloud_goes_to_the_replayer_in_place_of_scans() {
    let mut options = options("--replay /a.mcap --cloud-topic /points --cloud-mount 0.5,0,-1,0");
    let args = applied(&options, graph("--scan-topic /scan", "")).unwrap();
    let expected = "--recording=/a.mcap --cloud-topic=/points --heights=0.2,0.6 \
                    --cloud-mount=0.5,0,-1,0,0,0";
    assert_eq!(args[0], words(expected));
    options.replay.clear();
    let refusal = applied(&options, graph("", "")).unwrap_err().to_string();
    assert!(refusal.contains("allowed with --replay"), "{refusal}");
}

#[test]
fn recordings_and_their_topics_go_to_the_replayer() {
    let line = "--replay /a.mcap --replay /b --scan-topic /front/scan --odom-topic /wheels";
    let before = "--recording x.mcap --rate=max --scan-topic /scan";
    let args = applied(&options(line), graph(before, "")).unwrap();
    let expected = "--rate=max --recording=/a.mcap --recording=/b --scan-topic=/front/scan \
                    --odom-topic=/wheels";
    assert_eq!(args[0], words(expected));
    let options = options("--replay /a.mcap --map-topic /map");
    let refusal = applied(&options, graph("", "")).unwrap_err().to_string();
    assert!(refusal.contains("from the map_server"), "{refusal}");
}
