//! A robot that drives as one was recorded, on Fast DDS but for its transforms, which are on
//! Cyclone DDS; the engine and the tracker; and us in AMCL's place.

use tests::world::World;

use super::cyclone::cyclone;
use super::*;

/// The recorded robot's laser ahead of its base, metres.
const MOUNT_M: f64 = 0.78;

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
    domain: String,
    /// Step of the drive at which the robot starts again: it has not moved.
    step: u64,
}

impl Driven {
    /// The graph waits for the robot, which has not begun to drive.
    fn new(tag: &str) -> Option<Self> {
        let domain = domain();
        let options = ["--as", "amcl", "--mount", "0.78,0,0"];
        let joined = join_in(&domain, tag, "/", &options)?;
        let mut driven = Driven {
            nodes: start_nodes(&joined.graph, &NODES),
            transforms: cyclone(&domain, "/")?,
            joined,
            domain,
            step: 0,
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
        self.joined.robot.order("step", json!({}));
        self.step = self.joined.robot.wait_for("step")["step"].as_u64().unwrap();
        self.joined.robot = robot(&self.domain, "/").unwrap();
        self.transforms = cyclone(&self.domain, "/").unwrap();
        self.prepare();
    }

    /// Activates us.
    fn bring_up(&mut self) {
        let robot = &mut self.joined.robot;
        robot.order("bring_up", json!({}));
        assert_eq!(robot.wait_for("brought_up")["label"], "active");
    }

    /// Begins to drive, or goes on.
    fn drive(&mut self) {
        let file = World::of("malaga_corridor").recording();
        let how = json!({ "file": file, "mount": MOUNT_M, "start": self.step });
        self.joined.robot.order("replay", how);
    }

    /// The next pose: when it came, and how many metres it is from the true one. A pose that is
    /// wrong, by the metre from which a pose is called so, has a covariance that says so: after a gap
    /// in odometry it is that of metres.
    fn pose(&mut self) -> (i64, f64) {
        let pose = self.joined.robot.wait_for("pose");
        let number = |name: &str| pose[name].as_f64().unwrap();
        let (metres, deviation) = (number("metres"), number("deviation"));
        // Of 3000 normally distributed errors in the plane, one is beyond four deviations.
        assert!(metres < f64::max(1.0, 4.0 * deviation), "{pose}");
        (pose["at"].as_i64().unwrap(), metres)
    }

    /// When the first pose after `begin` came that is as near as most answers on this recording
    /// are. While odometry and laser disagree, as they do in it at times, one may be off.
    fn right_pose(&mut self, begin: i64) -> i64 {
        loop {
            let (at, metres) = self.pose();
            if at > begin && metres < 0.3 {
                return at;
            }
        }
    }

    fn stop(mut self) {
        self.nodes.drain(..).for_each(NodeProcess::stop);
        self.joined.stop();
    }
}

#[test]
fn a_robot_that_drives_gets_its_pose_whichever_side_starts_anew() {
    let Some(mut driven) = Driven::new("dds-drive") else {
        return;
    };
    for round in 0..=2 * rounds(1) {
        let robot_is_new = round % 2 == 1 || round == 0;
        match round {
            0 => {}
            _ if robot_is_new => driven.restart_robot(),
            _ => restart_gateway(&mut driven.joined),
        }
        driven.bring_up();
        // From when both are there.
        let begin = monotonic_ns();
        if robot_is_new {
            driven.drive();
        }
        let order = json!({ "off": [0.3, -0.2, 0.1] });
        driven.joined.robot.order("navigate", order);
        let took = driven.joined.robot.wait_for("navigating");
        let pose = driven.right_pose(begin);
        eprintln!(
            "round {round}: navigating after {:.2} s, pose after {:.2} s",
            took["seconds"].as_f64().unwrap(),
            (pose - begin) as f64 * 1e-9
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
    driven.drive();
    driven.right_pose(0);
    let point = |driven: &mut Driven, off: [f64; 3], clicks: usize, seconds: f64| {
        let order = json!({ "off": off, "clicks": clicks, "seconds": seconds });
        driven.transforms.order("gap", json!({}));
        driven.transforms.wait_for("gap");
        driven.joined.robot.order("point", order);
        driven.joined.robot.wait_for("pointed");
        // Of scans since.
        for _ in 0..8 {
            // Half of the way to the nearest of the wrong places.
            let (_, metres) = driven.pose();
            assert!(metres < 3.0, "{off:?} × {clicks}: {metres}");
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
