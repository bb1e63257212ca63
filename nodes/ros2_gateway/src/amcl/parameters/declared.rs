//! The parameters of AMCL: types, defaults and meanings here; some have no meaning.

use std::borrow::Cow;

use super::Value;

#[derive(Debug, Clone)]
pub(super) struct Declared {
    pub(super) name: &'static str,
    pub(super) default: Value,
    pub(super) meaning: &'static str,
    pub(super) counts: Counts,
    /// Smallest and largest value of a number.
    pub(super) range: Option<(f64, f64)>,
}

/// When a parameter takes effect.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Counts {
    Always,
    /// At the start of the node; it cannot be set later.
    AtStart,
    /// Never; `meaning` says why.
    Never,
}

use Value::{Bool, Double, Integer};

const PARTICLES: &str = "no particles are drawn to localize: all poses are searched";
const MOTION: &str = "how odometry errs is learned from scans, not set";
const SENSOR: &str = "how scans are judged is set at the nodes of the graph (--help of each)";
const EVERY_SCAN: &str = "every scan counts";

/// File of the saved pose; it cannot be set over the network, so that other nodes name no files.
pub(crate) const FILE: &str = "saved_pose_filepath";

/// All parameters, sorted by name.
#[rustfmt::skip]
pub(super) const ALL: &[Declared] = &[
    never("alpha1", Double(0.2), MOTION),
    never("alpha2", Double(0.2), MOTION),
    never("alpha3", Double(0.2), MOTION),
    never("alpha4", Double(0.2), MOTION),
    never("alpha5", Double(0.2), MOTION),
    always("always_reset_initial_pose", Bool(false), "each activation begins with initial_pose, not the first alone"),
    start("autostart_node", Bool(false), "the node configures and activates itself, with no lifecycle manager"),
    start("base_frame_id", text("base_footprint"), "the frame whose pose is published"),
    never("beam_skip_distance", Double(0.5), SENSOR),
    never("beam_skip_error_threshold", Double(0.9), SENSOR),
    never("beam_skip_threshold", Double(0.3), SENSOR),
    ranged(start("bond_heartbeat_period", Double(0.1), "seconds between signs of life; 0 for none"), (0.0, 60.0)),
    never("do_beamskip", Bool(false), SENSOR),
    always("first_map_only", Bool(false), "maps after the first are not taken"),
    never("freespace_downsampling", Bool(false), PARTICLES),
    start("global_frame_id", text("map"), "the map's frame"),
    ranged(always("initial_pose.x", Double(0.0), "metres; see set_initial_pose"), FINITE),
    ranged(always("initial_pose.y", Double(0.0), "metres; see set_initial_pose"), FINITE),
    ranged(always("initial_pose.yaw", Double(0.0), "radians; see set_initial_pose"), FINITE),
    never("initial_pose.z", Double(0.0), "the robot is in the plane"),
    always("initialize_at_saved_pose", Bool(false), "a tracker that has no pose starts with the saved one, which a scan must confirm"),
    never("lambda_short", Double(0.1), SENSOR),
    never("laser_likelihood_max_dist", Double(2.0), SENSOR),
    ranged(always("laser_max_range", Double(100.0), "readings beyond are no returns, metres; below 0 the laser's own limit"), FINITE),
    ranged(always("laser_min_range", Double(-1.0), "readings below are no returns, metres; below 0 the laser's own limit"), FINITE),
    never("laser_model_type", text("likelihood_field"), SENSOR),
    start("map_topic", text("map"), "where the map comes from"),
    never("max_beams", Integer(60), SENSOR),
    never("max_particles", Integer(2000), PARTICLES),
    never("min_particles", Integer(500), PARTICLES),
    start("odom_frame_id", text("odom"), "the odometry's frame, on /tf"),
    never("pf_err", Double(0.05), PARTICLES),
    never("pf_z", Double(0.99), PARTICLES),
    never("random_seed", Integer(-1), "nothing is random"),
    never("recovery_alpha_fast", Double(0.0), PARTICLES),
    never("recovery_alpha_slow", Double(0.0), PARTICLES),
    never("resample_interval", Integer(1), PARTICLES),
    never("robot_model_type", text("nav2_amcl::DifferentialMotionModel"), MOTION),
    ranged(always("save_pose_rate", Double(0.5), "how often the pose is saved at most, hertz; never at 0 and below"), FINITE),
    start(FILE, text("/tmp/amcl_saved_pose"), "the file of the saved pose; empty for none"),
    start("scan_topic", text("scan"), "where scans come from; --scan counts before it"),
    always("set_initial_pose", Bool(false), "the first activation begins with initial_pose, which a scan must confirm"),
    never("sigma_hit", Double(0.2), SENSOR),
    always("tf_broadcast", Bool(true), "the transform from map to odometry is published"),
    ranged(always("transform_tolerance", Double(1.0), "seconds that it is dated ahead"), (0.0, 10.0)),
    never("update_min_a", Double(0.2), EVERY_SCAN),
    never("update_min_d", Double(0.25), EVERY_SCAN),
    start("use_sim_time", Bool(false), "what is sent between scans is dated by /clock"),
    never("z_hit", Double(0.5), SENSOR),
    never("z_max", Double(0.05), SENSOR),
    never("z_rand", Double(0.5), SENSOR),
    never("z_short", Double(0.05), SENSOR),
];

const FINITE: (f64, f64) = (-1e9, 1e9);

const fn text(value: &'static str) -> Value {
    Value::Text(Cow::Borrowed(value))
}

const fn of(name: &'static str, default: Value, meaning: &'static str, counts: Counts) -> Declared {
    Declared {
        name,
        default,
        meaning,
        counts,
        range: None,
    }
}

const fn always(name: &'static str, default: Value, meaning: &'static str) -> Declared {
    of(name, default, meaning, Counts::Always)
}

const fn start(name: &'static str, default: Value, meaning: &'static str) -> Declared {
    of(name, default, meaning, Counts::AtStart)
}

const fn never(name: &'static str, default: Value, meaning: &'static str) -> Declared {
    of(name, default, meaning, Counts::Never)
}

const fn ranged(mut declared: Declared, range: (f64, f64)) -> Declared {
    declared.range = Some(range);
    declared
}
