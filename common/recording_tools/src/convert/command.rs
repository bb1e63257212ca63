//! The command `backcast convert`.

use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::thread;

use anyhow::bail;
use command_line::{finished, output, say, wrong_use};
use recording::write::{Packing, RecordingWriter};
use recording::{Kind, Recording, is_bag, is_stream};
use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::iterator::Signals;
use signal_hook::low_level::emulate_default_handler;
use tempfile::TempPath;

use super::file::{self, ending};
use super::report::Report;
use super::to_recording::{self, Rules};

/// Text below the options in the help.
pub const NOTES: &str = "\
.log, .clf and .txt are CARMEN's laser logs, which may be packed with gzip (.log.gz); .mcap is a
recording with ROS 2 messages, .db3 (or a folder of such) a bag of rosbag2 in SQLite, of which all
topics are converted. The content decides if the name does not.

Exit codes: 0 done, 1 failed or nothing to convert, which leaves no file, 2 wrong use, 3 done but
something could not be read";

/// Options of `backcast convert`.
#[derive(Debug, clap::Args)]
pub struct Config {
    /// The file to read: .log, .clf, .txt or .db3, or the folder of a bag
    #[arg(value_name = "FROM")]
    from: PathBuf,

    /// The file to write: .mcap
    #[arg(value_name = "TO")]
    to: PathBuf,

    /// Overwrite the file
    #[arg(long)]
    force: bool,

    /// The log's laser poses are corrected: write them as /ground_truth
    #[arg(long)]
    truth: bool,

    /// Ranges from this value on are no returns, metres, if the log does not say
    #[arg(long, value_name = "METRES", default_value_t = 80.0, value_parser = range)]
    range_max: f32,
}

fn range(text: &str) -> Result<f32, String> {
    match text.parse() {
        Ok(range) if (0.1..=10_000.0).contains(&range) => Ok(range),
        _ => Err("allowed are 0.1 to 10000 m".to_owned()),
    }
}

/// Converts one file.
pub fn run(config: &Config) -> anyhow::Result<ExitCode> {
    let none = || no_conversion(&ending(&config.from), &config.to);
    if ending(&config.to) != "mcap" || ends_packed(&config.to) {
        return Err(none());
    }
    let from = &config.from;
    if is_stream(from) {
        let from = from.display();
        return Err(wrong_use(format!(
            "{from} is no file, and is read twice: save it to one first"
        )));
    }
    let convert = match file::is_log(from).map_err(failed("read", from))? {
        true => log_to_recording,
        false if is_bag(from) => bag_to_recording,
        false => {
            if file::RECORDINGS.contains(&ending(from).as_str()) {
                // An unreadable file is reported by the code that reads recordings.
                Recording::open(from)?;
            }
            return Err(none());
        }
    };
    let (file, unfinished) = create(&config.to, config.force)?;
    let report = convert(config, file)?;
    if report.scans == 0 && report.messages == 0 {
        let (from, reason) = (config.from.display(), report.why_nothing());
        bail!("nothing in {from} could be converted, and no file was written: {reason}");
    }
    unfinished.keep()?;
    Ok(print_report(&report, &config.to))
}

fn no_conversion(from: &str, to: &Path) -> anyhow::Error {
    let to = to.extension().unwrap_or_default().to_string_lossy();
    wrong_use(format!(
        "from .{from} to .{to} is not a conversion; allowed are .log, .clf, .txt and .db3 to .mcap"
    ))
}

fn ends_packed(path: &Path) -> bool {
    path.extension()
        .is_some_and(|e| e.eq_ignore_ascii_case("gz"))
}

fn print_report(report: &Report, to: &Path) -> ExitCode {
    let Report {
        scans, odometry, ..
    } = report;
    let to = to.display();
    if report.messages > 0 {
        say(&format!("{} messages of all topics", report.messages));
    }
    say(&format!(
        "{to}: {scans} scans, {odometry} poses of the odometry"
    ));
    report.remarks.iter().for_each(|remark| say(remark));
    if report.moved_mounts > 0 {
        say(&format!(
            "{} scans were taken where the laser sat elsewhere than at first; poses that were \
             corrected need --truth",
            report.moved_mounts
        ));
    }
    if report.missing_readings > 0 {
        say(&format!(
            "{} readings are not numbers, and their beams are missing",
            report.missing_readings
        ));
    }
    if let Some(left_out) = report.left_out() {
        say(&left_out);
    }
    let losses = report.losses();
    losses.iter().for_each(|loss| say(loss));
    finished(!losses.is_empty())
}

fn log_to_recording(config: &Config, to: BufWriter<File>) -> anyhow::Result<Report> {
    let rules = Rules {
        truth: config.truth,
        range_max_m: config.range_max,
    };
    let log = file::open(&config.from).map_err(failed("read", &config.from))?;
    let mut writer = RecordingWriter::new(to, Packing::Zstd)?;
    let report = to_recording::convert(log, &rules, &mut writer)?;
    finish(writer, config)?;
    Ok(report)
}

fn bag_to_recording(config: &Config, to: BufWriter<File>) -> anyhow::Result<Report> {
    let mut writer = RecordingWriter::new(to, Packing::Zstd)?;
    let messages = recording::write_bag(&config.from, &mut writer)?;
    finish(writer, config)?;
    // Reading it again also checks that it is readable.
    let recording = Recording::open(&config.to)?;
    let of = |kind| {
        let channels = recording.channels().filter(|c| c.kind == Some(kind));
        channels.map(|channel| channel.messages).sum()
    };
    Ok(Report {
        scans: of(Kind::Scan),
        odometry: of(Kind::Odometry),
        messages,
        ..Report::default()
    })
}

fn finish(writer: RecordingWriter<BufWriter<File>>, config: &Config) -> anyhow::Result<()> {
    let flushed = writer.finish()?.flush();
    flushed.map_err(failed("write", &config.to))
}

/// Creates the file, which is deleted on drop unless it is kept, and by a signal that ends the
/// command.
fn create(path: &Path, overwrites: bool) -> anyhow::Result<(BufWriter<File>, TempPath)> {
    output::prepare(path, overwrites)?;
    let mut signals = Signals::new([SIGINT, SIGTERM]).map_err(failed("create", path))?;
    let unfinished = path.to_owned();
    thread::spawn(move || {
        for signal in signals.forever() {
            // The command ends anyway.
            let _ = std::fs::remove_file(&unfinished);
            let _ = emulate_default_handler(signal);
        }
    });
    let file = File::create(path).map_err(failed("create", path))?;
    let unfinished = TempPath::try_from_path(path).map_err(failed("create", path))?;
    Ok((BufWriter::new(file), unfinished))
}

fn failed<'p>(
    action: &'static str,
    path: &'p Path,
) -> impl FnOnce(std::io::Error) -> anyhow::Error + 'p {
    let text = format!("cannot {action} {}", path.display());
    move |source| anyhow::Error::new(source).context(text)
}
