//! Recording of a running graph on request: its recorder is started and stopped.

use std::env;
use std::path::{Path, PathBuf};
use std::time::{Instant, SystemTime};

use command_line::output::{folder_of, numbered};
use dataflow::Node;
use nix::unistd::{AccessFlags, access};

use super::arguments::{set, value};
use super::control::Recording;
use super::crew::Crew;
use super::process::executable;
use super::record::{self, RECORDER};
use crate::descriptor::Descriptor;

pub(super) struct Recorder {
    /// Recorder of the descriptor or of `--record`; else one that only requests start.
    node: Node,
    executable: PathBuf,
    folder: PathBuf,
}

impl Recorder {
    pub(super) fn of(descriptor: &Descriptor) -> Self {
        let Descriptor {
            dataflow,
            file,
            folder,
        } = descriptor;
        let node = dataflow.node(RECORDER).cloned();
        let node = node.unwrap_or_else(|| record::node(dataflow, file, folder));
        let current = env::current_dir().unwrap_or_default();
        let output = value(&node, "--output").map(|output| current.join(folder).join(output));
        Recorder {
            executable: executable(&node, folder),
            folder: output.map_or(current, |output| folder_of(&output).to_owned()),
            node,
        }
    }

    pub(super) fn status(&self, crew: &Crew) -> Recording {
        let keeps = value(&self.node, "--keep").is_some();
        let node = crew.active(&self.node.id).filter(|_| !keeps);
        let output = node.and_then(|node| value(node, "--output"));
        let file = output.map(|output| newest(&self.folder.join(output)));
        let found = file.as_ref().and_then(|file| file.metadata().ok());
        Recording {
            file: file.map(|file| file.display().to_string()),
            size_mb: found.map(|found| found.len() as f64 / 1e6),
            refused: match keeps {
                true => Some("the recorder keeps the last minutes (--keep): save those".into()),
                false => self.refused(),
            },
        }
    }

    /// Starts a recording to a new file; returns the file, or the reason for a refusal.
    pub(super) fn start(
        &self,
        crew: &mut Crew,
        now: Instant,
    ) -> anyhow::Result<Result<String, String>> {
        let Recording { file, refused, .. } = self.status(crew);
        let already = file.map(|file| format!("{file} is being recorded already"));
        if let Some(why) = already.or(refused) {
            return Ok(Err(why));
        }
        let time = humantime::format_rfc3339_seconds(SystemTime::now()).to_string();
        let name = format!("backcast_{}.mcap", time.replace(':', "-"));
        let file = self.folder.join(name).display().to_string();
        let mut node = self.node.clone();
        set(&mut node, "--output", Some(&file));
        crew.start(node, now)?;
        Ok(Ok(file))
    }

    /// Has the recorder finish its file; returns the file, or the reason for a refusal.
    pub(super) fn stop(&self, crew: &mut Crew) -> anyhow::Result<Result<String, String>> {
        let Some(file) = self.status(crew).file else {
            return Ok(Err("nothing is being recorded".to_owned()));
        };
        crew.end(&self.node.id)?;
        Ok(Ok(file))
    }

    fn refused(&self) -> Option<String> {
        let (executable, folder) = (self.executable.display(), self.folder.display());
        if !self.executable.is_file() {
            return Some(format!("there is no {executable}"));
        }
        let written = access(&self.folder, AccessFlags::W_OK);
        let why = written.err()?.desc();
        Some(format!("cannot write into {folder}: {why}"))
    }
}

/// Returns the file that was written last: `output`, or one with a number after its name.
fn newest(output: &Path) -> PathBuf {
    let written = |file: &PathBuf| file.metadata().and_then(|found| found.modified()).ok();
    let last = numbered(output).into_iter().max_by_key(written);
    last.unwrap_or_else(|| output.to_owned())
}
