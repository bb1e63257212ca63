//! `backcast init`: writes a descriptor.

use std::ffi::OsStr;
use std::fs::Permissions;
use std::io;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::Context;
use clap::ArgGroup;
use command_line::{output, say, stdout, wrong_use};
use geometry::Mount;
use launcher::descriptor::{self, Builds};
use recording::{Kind, Recording};

use crate::init::descriptor::{Served, Source, descriptor_of};
use crate::init::robot::{self, Lasers, Robot};

pub(crate) const NOTES: &str = "\
Examples:
  backcast init --laser 192.168.0.1 --map map.yaml --mount 0.2,0,0 --out graph.yaml
  backcast init --laser 192.168.0.1 --maps building/ --out graph.yaml
  backcast init --serial /dev/ttyUSB0 --map map.yaml --out graph.yaml
  backcast init --ros2 --out graph.yaml
  backcast init --ros2 tcp/192.168.0.5:7447 --out graph.yaml
  backcast init --replay drive.mcap --map map.yaml --out graph.yaml

Exit codes: 0 written, 1 the laser, the robot, the map or the recording cannot be used, 2 wrong use";

/// Error of a graph without a map.
const NEEDED: &str = "--map is missing, the map of the building, a YAML file beside its image; or \
                      --maps, a folder of several";

/// Options of `backcast init`.
#[derive(Debug, clap::Args)]
#[command(group = ArgGroup::new("source").required(true))]
pub(crate) struct Config {
    /// A SICK laser on the network, as 192.168.0.1, HOST:PORT or tcp://HOST:PORT; its protocol is
    /// detected
    #[arg(long, value_name = "ADDRESS", group = "source")]
    laser: Option<String>,

    /// A SICK LMS2xx on a serial line, e.g. /dev/ttyUSB0
    #[arg(long, value_name = "DEVICE", group = "source")]
    serial: Option<String>,

    /// A ROS 2 robot. Its nodes are looked for on DDS and Zenoh, or only through its Zenoh router,
    /// e.g. tcp/192.168.0.5:7447; if none is found, it is assumed to use rmw_zenoh with this graph
    /// as its router
    #[arg(long, value_name = "ROUTER", group = "source", num_args = 0..=1)]
    ros2: Option<Option<String>>,

    /// A recording, played in place of a laser
    #[arg(long, value_name = "FILE", group = "source")]
    replay: Option<PathBuf>,

    /// The map of the building, a YAML file of map_server of ROS 2; by default a ROS 2 robot
    /// publishes its own, and a recording is played on the one that it holds
    #[arg(long, value_name = "FILE")]
    map: Option<PathBuf>,

    /// Several maps instead of one, such as the floors of a building: a folder, or a file that
    /// lists them; all are searched
    #[arg(long, value_name = "FOLDER|FILE", conflicts_with = "map")]
    maps: Option<PathBuf>,

    /// Mount of the laser on the robot: metres ahead, metres to the left, degrees counter-clockwise
    #[arg(long, value_name = "X,Y,YAW_DEG", allow_hyphen_values = true)]
    mount: Option<String>,

    /// Write without contacting the laser or looking for the robot
    #[arg(long)]
    no_probe: bool,

    /// File to write; paths in it are relative to its folder
    #[arg(long, value_name = "FILE", default_value = descriptor::DEFAULT_FILE)]
    out: PathBuf,

    /// Overwrite the file
    #[arg(long)]
    force: bool,
}

pub(crate) fn run(config: &Config) -> anyhow::Result<ExitCode> {
    // A laser or a robot takes seconds to answer, so it is asked last.
    let recording = config.replay.as_ref().map(Recording::open).transpose()?;
    let played = config.replay.as_deref().zip(recording.as_ref());
    let map = match (&config.map, &config.maps, played) {
        (Some(file), ..) => Some(Served::Map(used_map(file)?)),
        (None, Some(set), _) => Some(Served::Set(used_set(set)?)),
        (None, None, Some(played)) => Some(Served::Recorded(used_recording(played)?)),
        (None, None, None) => None,
    };
    output::prepare(&config.out, config.force)?;
    let source = source(config, played)?;
    let text = descriptor_of(&source, map.as_ref());
    let written = write(&config.out, &text);
    written.with_context(|| format!("cannot write {}", config.out.display()))?;
    descriptor::load(&config.out, Builds::Run)?;
    stdout::print(&format!(
        "{file}: {source}\n\nbackcast check {file}\nbackcast run {file}\n",
        file = config.out.display(),
        source = source.title,
    ))?;
    Ok(ExitCode::SUCCESS)
}

fn write(file: &Path, text: &str) -> io::Result<()> {
    let folder = output::folder_of(file);
    let mut written = tempfile::Builder::new()
        .permissions(Permissions::from_mode(0o644))
        .tempfile_in(folder)?;
    io::Write::write_all(&mut written, text.as_bytes())?;
    written.persist(file)?;
    Ok(())
}

fn source(config: &Config, played: Option<(&Path, &Recording)>) -> anyhow::Result<Source> {
    let mount = config.mount.as_deref().map(mount).transpose()?;
    let is_robot = config.ros2.is_some();
    let has_map = config.map.is_some() || config.maps.is_some();
    if !has_map && !is_robot && played.is_none() {
        return Err(wrong_use(NEEDED));
    }
    if let Some(device) = config.laser.as_ref().or(config.serial.as_ref()) {
        let options = reader_options(config, device)?;
        if mount.is_none() {
            say(
                "where the laser sits on the robot is not known: poses are those of the laser \
                 until --mount is given",
            );
        }
        return Ok(Source::laser(&options, mount.as_deref()));
    }
    if let Some(router) = &config.ros2 {
        let mut seen = Robot::default();
        if !config.no_probe {
            say("looking for the robot's nodes");
            // A mount is that of one laser.
            let lasers = match mount {
                Some(_) => Lasers::First,
                None => Lasers::All,
            };
            seen = robot::look(router.as_deref(), lasers)?;
            seen.said.iter().for_each(|said| say(said));
            if seen.lacks_map && !has_map {
                say(robot::NO_MAP);
            }
        }
        let (router, mount) = (router.as_deref(), mount.as_deref());
        return Ok(Source::robot(&seen, router, mount, !has_map));
    }
    if mount.is_some() {
        let reason = "--mount is not for a recording, whose /tf_static says where its laser sits";
        return Err(wrong_use(reason));
    }
    let (file, recording) = played.context("a laser, a robot or a recording is required")?;
    recording.topic(Kind::Scan)?;
    let has_odometry = recording
        .topic(Kind::Odometry)
        .is_ok_and(|topic| topic.is_some());
    Ok(Source::recording(&absolute(file)?, has_odometry))
}

/// Returns the options that the laser answers to, or those of its factory settings.
fn reader_options(config: &Config, device: &str) -> anyhow::Result<Vec<String>> {
    let is_serial = config.serial.is_some();
    if config.no_probe {
        return Ok(crate::probe::default_reader_options(device, is_serial));
    }
    say(&format!("asking the laser at {device}"));
    crate::probe::reader_options(device, is_serial).with_context(|| {
        format!(
            "the laser gives no answer; --no-probe writes the descriptor without asking it, and \
             `backcast probe {device}` says more"
        )
    })
}

/// Returns the checked mount as one word; zeros get a fourth one, which says they are meant.
fn mount(text: &str) -> anyhow::Result<String> {
    let mount: Result<Mount, _> = text.parse();
    let mount = mount.map_err(|error| wrong_use(format!("--mount {text:?}: {error}")))?;
    let word = text.replace(' ', "");
    match mount == Mount::default() && word.matches(',').count() == 2 {
        true => Ok(word + ",0"),
        false => Ok(word),
    }
}

/// Checks that a recording holds a map to serve, and returns its absolute path.
fn used_recording((file, recording): (&Path, &Recording)) -> anyhow::Result<String> {
    match recording.maps()?.last() {
        Some(map) => {
            map?;
            absolute(file)
        }
        None => Err(wrong_use(format!(
            "{NEEDED}: {} holds none",
            file.display()
        ))),
    }
}

fn used_map(file: &Path) -> anyhow::Result<String> {
    if file.extension() == Some(OsStr::new("mcap")) {
        return Err(wrong_use(format!(
            "--map {} is a recording; a map is a YAML file beside its image",
            file.display()
        )));
    }
    map::load(file)?;
    absolute(file)
}

fn used_set(path: &Path) -> anyhow::Result<String> {
    for map in map::set_of_noting(path, say)?.maps {
        map::load(map.yaml)?;
    }
    absolute(path)
}

/// Returns the whole path of a file or folder that nodes read, also again.
fn absolute(file: &Path) -> anyhow::Result<String> {
    let path = file.canonicalize().ok();
    let path = path.filter(|path| path.is_file() || path.is_dir());
    let path = path.ok_or("no file or folder, which nodes could read again: save it to one");
    let path = path.and_then(|path| path.to_str().map(str::to_owned).ok_or("no UTF-8"));
    path.map_err(|reason| wrong_use(format!("{} is {reason}", file.display())))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mount_is_kept_as_one_word() {
        assert_eq!(mount("0.2, 0,-90").unwrap(), "0.2,0,-90");
        assert_eq!(mount("0,0,0").unwrap(), "0,0,0,0");
        assert!(mount("780,0,0").is_err());
        let error = mount("1,2").unwrap_err().to_string();
        let expected = "--mount \"1,2\": expected are three";
        assert!(error.starts_with(expected), "{error}");
    }
}
