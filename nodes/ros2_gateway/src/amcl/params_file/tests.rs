use geometry::Pose;

use super::*;

/// The parameters of `nav2_bringup`, along with those of other nodes.
const NAV2: &str = "
amcl:
  ros__parameters:
    use_sim_time: True
    alpha1: 0.2
    base_frame_id: \"base_footprint\"
    global_frame_id: \"map\"
    laser_max_range: 100.0
    laser_min_range: -1.0
    laser_model_type: \"likelihood_field\"
    max_particles: 2000
    odom_frame_id: \"odom\"
    robot_model_type: \"nav2_amcl::DifferentialMotionModel\"
    set_initial_pose: true
    initial_pose:
      x: 1.5
      y: -2
      yaw: 0.25
    tf_broadcast: true
    transform_tolerance: 1.0
    scan_topic: scan
bt_navigator:
  ros__parameters:
    use_sim_time: True
    plugin_lib_names:
      - nav2_compute_path_to_pose_action_bt_node
local_costmap:
  local_costmap:
    ros__parameters:
      update_frequency: 5.0
";

fn loaded(text: &str, node: &str) -> Result<(Parameters, Vec<String>), String> {
    let mut parameters = Parameters::default();
    let remarks = load(&mut parameters, text, "nav2.yaml", node).map_err(|e| e.to_string())?;
    Ok((parameters, remarks))
}

#[test]
fn the_file_of_nav2_is_taken_as_it_is() {
    let (parameters, remarks) = loaded(NAV2, "/amcl").unwrap();
    assert_eq!(parameters.initial_pose(), Pose::new(1.5, -2.0, 0.25));
    assert!(parameters.is_on("set_initial_pose") && parameters.is_on("use_sim_time"));
    let idle = [
        "alpha1",
        "laser_model_type",
        "max_particles",
        "robot_model_type",
    ];
    assert_eq!(remarks.len(), idle.len(), "{remarks:?}");
    for (remark, name) in remarks.iter().zip(idle) {
        assert!(remark.starts_with(&format!("parameter {name} has no meaning here: ")));
    }
}

#[test]
fn wildcards_and_namespaces_name_the_node() {
    let frame = |text: &str, node: &str| {
        let (parameters, _) = loaded(text, node).unwrap();
        parameters.text("odom_frame_id").to_owned()
    };
    let of = |key: &str, value: &str| {
        format!("{key}:\n  ros__parameters:\n    odom_frame_id: {value}\n")
    };
    for (key, node) in [
        ("amcl", "/amcl"),
        ("/amcl", "/amcl"),
        ("/**", "/r2/amcl"),
        ("'/*/amcl'", "/r2/amcl"),
        ("/**/amcl", "/amcl"),
        ("/r2/amcl", "/r2/amcl"),
    ] {
        assert_eq!(frame(&of(key, "found"), node), "found", "{key}");
    }
    for (key, node) in [
        ("amcl", "/r2/amcl"),
        ("other", "/amcl"),
        ("'/*'", "/r2/amcl"),
    ] {
        assert_eq!(frame(&of(key, "found"), node), "odom", "{key}");
    }
    let nested = "r2:\n  amcl:\n    ros__parameters:\n      odom_frame_id: found\n";
    assert_eq!(frame(nested, "/r2/amcl"), "found");
    // A name overrides a wildcard, no matter which comes first.
    for text in [
        of("amcl", "name") + &of("/**", "any"),
        of("/**", "any") + &of("amcl", "name"),
    ] {
        assert_eq!(frame(&text, "/amcl"), "name");
    }
}

#[test]
fn a_file_for_others_is_remarked_on() {
    let (_, remarks) = loaded(NAV2, "/r2/amcl").unwrap();
    let expected = "nav2.yaml has no parameters for /r2/amcl, but for: /amcl, /bt_navigator, \
         /local_costmap/local_costmap";
    assert_eq!(remarks, [expected]);
    let (_, remarks) =
        loaded("amcl: {ros__parameters: {colour: red, list: [1]}}", "/amcl").unwrap();
    assert!(
        remarks
            .iter()
            .all(|r| r.ends_with("is none of AMCL's, and ignored")),
        "{remarks:?}"
    );
    assert_eq!(remarks.len(), 2);
}

#[test]
fn what_is_wrong_is_named() {
    let of = |line: &str| format!("amcl:\n  ros__parameters:\n    {line}\n");
    for (text, expected) in [
        (of("transform_tolerance: soon"), "transform_tolerance"),
        (of("tf_broadcast: 1"), "tf_broadcast"),
        (of("odom_frame_id: [a]"), "odom_frame_id of /amcl"),
        (of("scan_topic: 7"), "scan_topic"),
        ("amcl: 7\n".to_owned(), "a number"),
        ("amcl: [\n".to_owned(), ""),
    ] {
        let error = loaded(&text, "/amcl").unwrap_err();
        assert!(
            error.contains(expected) && error.contains("nav2.yaml"),
            "{error}"
        );
    }
    let deep = "{a: ".repeat(40) + "1" + &"}".repeat(40);
    assert!(loaded(&deep, "/amcl").is_err());
}

#[test]
fn a_parameter_by_itself_is_one_of_a_file_with_it_alone() {
    let mut parameters = Parameters::default();
    let mut take = |rule: &str| set(&mut parameters, rule, "/r2/amcl");
    assert!(take("use_sim_time:=true").unwrap().is_empty());
    assert!(take("initial_pose.x:=1.5").unwrap().is_empty());
    let remarks = take("max_particles:=3").unwrap();
    assert!(
        remarks[0].contains("max_particles has no meaning here"),
        "{remarks:?}"
    );
    for (rule, expected) in [
        ("use_sim_time", "allowed is NAME:=VALUE"),
        ("a b:=1", "allowed is NAME:=VALUE"),
        ("use_sim_time:=7", "use_sim_time"),
    ] {
        let error = take(rule).unwrap_err().to_string();
        assert!(error.contains(expected), "{error}");
    }
    assert!(parameters.is_on("use_sim_time"));
}
