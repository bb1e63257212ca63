//! The command `backcast locate`.

use std::path::PathBuf;
use std::process::ExitCode;

use answers::ScanAnswer;
use command_line::{LOST_DATA, wrong_use};
use offline::{Accepted, Options, Progress, Session};
use recording::RecordingError;

use super::object::Object;
use super::particles::{Particles, ParticlesOptions};

/// Options of `backcast locate`.
#[derive(Debug, Clone, clap::Args)]
pub struct Config {
    /// The recording: an MCAP file, or a bag of rosbag2 (its folder, or .db3); several files are
    /// read as one, and a map among them is taken for that of --map
    #[arg(value_name = "FILE", required_unless_present = "bag")]
    recordings: Vec<PathBuf>,

    /// Another way to name a recording
    #[arg(long, value_name = "FILE")]
    bag: Vec<PathBuf>,

    /// Print JSON, one object per line
    #[arg(long)]
    json: bool,

    /// The maps of a building, searched together: a folder of maps, or a file that
    /// lists them with names and floors, see docs/maps.md
    #[arg(long, value_name = "FOLDER|FILE", conflicts_with = "map")]
    maps: Option<PathBuf>,

    /// Search only these maps of several, by the names of maps or of floors
    #[arg(long, value_name = "NAME,NAME", value_delimiter = ',')]
    on: Vec<String>,

    #[command(flatten)]
    particles: ParticlesOptions,

    #[command(flatten)]
    options: Options,
}

/// Prints a line for each scan, for a rejected one with the reason. A scan that cannot be decoded
/// is lost, and is reported on standard error.
pub fn run(config: &Config) -> anyhow::Result<ExitCode> {
    let (options, files) = config.options.sorted(&config.recordings);
    let config = &Config {
        options,
        ..config.clone()
    };
    config.options.check_settings()?;
    let files = [&files[..], &config.bag].concat();
    let set = config.maps.as_deref();
    if let (Some(set), Some(map)) = (set, config.options.map.first()) {
        let (set, map) = (set.display(), map.display());
        let usage =
            format!("{map} is a map, and --maps {set} names others: allowed is one of both");
        return Err(wrong_use(usage));
    }
    let maps = config.options.load_set(set, &config.on, &files)?;
    let map = match maps.is_empty() {
        true => config.options.load_map(&files)?,
        false => None,
    };
    let recording = config.options.open(&files)?;
    let mut session = match maps.is_empty() {
        true => Session::open(&recording, &config.options, map.as_ref())?,
        false => Session::open_on(&recording, &config.options, &maps)?,
    };
    let progress = Progress::new("locating", session.scans.total());
    let mut code = ExitCode::SUCCESS;
    let mut accepted = Accepted::default();
    let mut frame = None;
    while let Some(scan) = session.scans.next() {
        match scan {
            Ok(scan) => {
                let reply = session.ask(&scan)?;
                accepted.count(&reply);
                let particles = Particles::draw(&config.particles, &scan, &reply)?;
                let object = Object::new(&scan, &reply).with(particles);
                let of = object.frame();
                let line = match config.json {
                    true => command_line::json::object(&object),
                    false if frame.replace(of) == Some(of) => object.text(),
                    false => format!("{}\n{}", ScanAnswer::header(of), object.text()),
                };
                for note in session.take_notes() {
                    progress.say(&note);
                }
                if progress.print(&line)?.is_break() {
                    break;
                }
            }
            Err(error @ RecordingError::Message { .. }) => {
                progress.say(&error.to_string());
                code = ExitCode::from(LOST_DATA);
            }
            Err(error) => return Err(error.into()),
        }
        progress.step();
    }
    accepted.check(recording.path())?;
    Ok(code)
}
