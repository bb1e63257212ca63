//! The command `backcast simulate`: loads the map, simulates the drive, and records it.

use std::path::PathBuf;
use std::process::ExitCode;

use command_line::{output, say, stdout};
use offline::Progress;
use recording::write::{Packing, RecordingWriter};
use recording::{GROUND_TRUTH, MAP, ODOM, TF_STATIC};
use ros::{PointCloud2, RosMessage, Time};
use simulation::{Drive, DriveConfig, Path, Wheels};

use super::lidar;
use super::messages::Messages;
use crate::messages;

const SECOND_NS: i64 = 1_000_000_000;

/// Options of `backcast simulate`.
#[derive(Debug, clap::Args)]
pub struct Config {
    /// The map, a YAML file in the format of map_server
    #[arg(long, value_name = "FILE")]
    map: PathBuf,

    /// Path of the robot's base, as corners in metres in the map: "X,Y X,Y …"
    #[arg(long, value_name = "CORNERS", allow_hyphen_values = true)]
    path: Path,

    /// The recording to write, an MCAP file
    #[arg(long, value_name = "FILE")]
    out: PathBuf,

    /// Overwrite the file
    #[arg(long)]
    force: bool,

    /// Start time of the drive, whole seconds since 1970
    #[arg(long, value_name = "SECONDS", default_value_t = 1_700_000_000, value_parser = clap::value_parser!(i64).range(0..=2_000_000_000))]
    start_time: i64,

    #[command(flatten)]
    drive: DriveConfig,
}

/// Writes the recording, and prints a summary. An impossible drive is rejected before the file is
/// touched.
pub fn run(config: &Config) -> anyhow::Result<ExitCode> {
    output::prepare(&config.out, config.force)?;
    let map = map::load_within(map::MemoryLimit::NONE, &config.map, |key| {
        say(&key.to_string());
    })?;
    let drive = Drive::new(&map, &config.path, &config.drive)?;
    let made = Messages {
        config: &config.drive,
        bearings: drive.bearings(),
        lasers: config.drive.mounts(),
    };
    let start_ns = config.start_time * SECOND_NS;
    let scans = drive.scans();
    let progress = Progress::new("simulating", scans);
    let mut writer = RecordingWriter::create(&config.out, Packing::Zstd)?;
    let start = time(start_ns);
    writer.write(MAP, start_ns, &made.map(&map, start))?;
    writer.write(TF_STATIC, start_ns, &made.mounts(start))?;
    for snapshot in drive {
        let odometry = |wheels: &Wheels| {
            let stamp = time(start_ns + wheels.time_ns);
            messages::odometry(stamp, wheels.odom_from_base, wheels.twist)
        };
        let stamp_ns = start_ns + snapshot.wheels.time_ns;
        let stamp = time(stamp_ns);
        writer.write(ODOM, stamp_ns, &odometry(&snapshot.wheels))?;
        let truth = messages::truth(stamp, snapshot.map_from_laser);
        writer.write(GROUND_TRUTH, stamp_ns, &truth)?;
        // A scan is recorded when its last beam is.
        let mut end_ns = stamp_ns;
        if let Some(wheels) = &snapshot.after {
            end_ns = start_ns + wheels.time_ns;
            writer.write(ODOM, end_ns, &odometry(wheels))?;
        }
        if let Some(cloud) = made.cloud(&snapshot, stamp) {
            let (schema, text) = (PointCloud2::SCHEMA, PointCloud2::DEFINITION);
            let body = ros::cdr::encode(&cloud)?;
            writer.write_bytes(lidar::TOPIC, schema, text, "cdr", end_ns, &body)?;
        }
        for (topic, scan) in made.scans(snapshot, stamp) {
            writer.write(&topic, end_ns, &scan)?;
        }
        progress.step();
    }
    writer.finish()?;
    drop(progress);
    stdout::print(&format!(
        "{}: {scans} scans with their true poses\n",
        config.out.display()
    ))?;
    Ok(ExitCode::SUCCESS)
}

/// Converts to a stamp; the latest start and the longest drive fit its 32 bits.
fn time(ns: i64) -> Time {
    Time::from_ns(ns).unwrap_or_default()
}
