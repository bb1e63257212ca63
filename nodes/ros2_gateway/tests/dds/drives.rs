//! A robot that drives as one was recorded, on Fast DDS but for its transforms, which are on
//! Cyclone DDS; the engine and the tracker; and us in AMCL's place.

use tests::world::World;
use transport::Subscriber;

use super::cyclone::cyclone;
use super::*;

/// The recorded robot's laser ahead of its base, metres.
const MOUNT_M: f64 = 0.78;

const ENGINE: [&str; 4] = [
    "boundary_extractor",
    "accumulator",
    "peak_extractor",
    "tracker",
];

/// How often something is repeated: as `BACKCAST_ROUNDS` says, else `usual` times.
fn rounds(usual: usize) -> usize {
    let rounds = std::env::var("BACKCAST_ROUNDS").ok();
    rounds.map_or(usual, |text| text.parse().unwrap())
}

struct Driven {
    // Before what its nodes are in.
    nodes: Vec<NodeProcess>,
    transforms: Robot,
    joined: Joined,
}

impl Driven {
    /// The graph waits for the robot, which has not begun to drive.
    fn new(tag: &str) -> Option<Self> {
        let joined = Joined::new(tag, "/", &["--as", "amcl", "--mount", "0.78,0,0"])?;
        let transforms = cyclone(&joined.domain, "/")?;
        let start = |name: &&str| {
            let executable = executables::path(name);
            NodeProcess::start(executable.to_str().unwrap(), &joined.graph, [""; 0])
        };
        let nodes = ENGINE.iter().map(start).collect();
        let mut driven = Driven {
            nodes,
            transforms,
            joined,
        };
        driven.prepare();
        Some(driven)
    }

    fn prepare(&mut self) {
        self.transforms.order("carry_odometry", json!({}));
        self.transforms.order("watch", json!({}));
        self.joined.robot.order("track", json!({}));
    }

    fn restart_robot(&mut self) {
        self.joined.robot = robot(&self.joined.domain, "/").unwrap();
        self.transforms = cyclone(&self.joined.domain, "/").unwrap();
        self.prepare();
    }

    fn restart_gateway(&mut self) {
        self.joined.stop();
        self.joined.start();
    }

    /// Activates us.
    fn bring_up(&mut self) {
        let robot = &mut self.joined.robot;
        robot.order("bring_up", json!({}));
        assert_eq!(robot.wait_for("brought_up")["label"], "active");
    }

    /// Begins to drive at that scan of the recording.
    fn drive(&mut self, start: usize) {
        let file = World::of("malaga_corridor").recording();
        let how = json!({ "file": file, "mount": MOUNT_M, "start": start });
        self.joined.robot.order("replay", how);
    }

    /// The next pose, which is right; when it came.
    fn pose(&mut self) -> i64 {
        let pose = self.joined.robot.wait_for("pose");
        let of = |name: &str| pose[name].as_f64().unwrap();
        // As near as all answers on this recording are.
        assert!(of("metres") < 0.3 && of("radians") < 0.1, "{pose}");
        pose["at"].as_i64().unwrap()
    }

    fn stop(mut self) {
        self.nodes.drain(..).for_each(NodeProcess::stop);
        self.joined.stop();
    }
}

/// Seconds from the first scan in the graph to now or to a moment of this machine.
fn since_scan(scans: &Subscriber<topic::Scan>, at: i64) -> f64 {
    let first = scans.receive().unwrap().unwrap();
    (at - first.header().stamp.entered_ns) as f64 * 1e-9
}

#[test]
fn a_robot_that_drives_gets_its_pose_whichever_side_starts_anew() {
    let Some(mut driven) = Driven::new("dds-drive") else {
        return;
    };
    driven.bring_up();
    driven.drive(0);
    for round in 0..=2 * rounds(1) {
        if round > 0 {
            match round % 2 {
                0 => driven.restart_gateway(),
                _ => {
                    driven.restart_robot();
                    driven.drive(5 * round);
                }
            }
            driven.bring_up();
        }
        let scans = driven.joined.graph.subscriber::<topic::Scan>().unwrap();
        let order = json!({ "off": [0.3, -0.2, 0.1] });
        driven.joined.robot.order("navigate", order);
        let took = driven.joined.robot.wait_for("navigating");
        let at = driven.pose();
        eprintln!(
            "round {round}: navigating after {:.2} s, pose {:.2} s after a scan",
            took["seconds"].as_f64().unwrap(),
            since_scan(&scans, at)
        );
    }
    driven.stop();
}

#[test]
fn clicks_leave_the_pose_and_the_transform_on_dds() {
    let Some(mut driven) = Driven::new("dds-clicks") else {
        return;
    };
    driven.bring_up();
    driven.drive(0);
    driven.pose();
    let point = |driven: &mut Driven, off: [f64; 3], clicks: usize, seconds: f64| {
        let order = json!({ "off": off, "clicks": clicks, "seconds": seconds });
        driven.transforms.order("gap", json!({}));
        driven.transforms.wait_for("gap");
        driven.joined.robot.order("point", order);
        driven.joined.robot.wait_for("pointed");
        // Of scans since.
        for _ in 0..8 {
            driven.pose();
        }
        driven.transforms.order("gap", json!({}));
        let gap = driven.transforms.wait_for("gap")["seconds"].as_f64();
        eprintln!(
            "{off:?} × {clicks}: the longest gap is {:.3} s",
            gap.unwrap()
        );
    };
    for round in 0..rounds(2) {
        point(&mut driven, [0.3, -0.2, 0.1], 1, 0.1);
        let wrong = [[-12.0, 1.0, 2.0], [5.0, 4.0, -1.0]][round % 2];
        point(&mut driven, wrong, 1, 0.1);
    }
    point(&mut driven, [-6.0, 0.5, 1.0], 300, 3.0);
    driven.stop();
}
