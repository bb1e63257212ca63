//! Commands of this executable that print JSON, run two at a time.

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::atomic::{AtomicUsize, Ordering};

use anyhow::{Context, anyhow, bail};
use offline::Progress;
use serde_json::Value;

/// Lines of JSON that a command printed.
pub(super) type Lines = Vec<Value>;

/// Commands to run.
#[derive(Debug, Default)]
pub(super) struct Runs(Vec<Vec<OsString>>);

impl Runs {
    /// Adds `backcast evaluate`; returns the number of the run.
    pub(super) fn evaluate(&mut self, options: &[&str], files: &[PathBuf]) -> usize {
        let files = files.iter().map(PathBuf::as_path);
        self.add("evaluate", options, files)
    }

    /// Adds `backcast locate` on another map; returns the number of the run.
    pub(super) fn locate(&mut self, options: &[&str], scans: &Path, map: &Path) -> usize {
        let arguments = [Path::new("--bag"), scans, Path::new("--map"), map];
        self.add("locate", options, arguments.into_iter())
    }

    fn add<'a>(
        &mut self,
        command: &str,
        options: &[&str],
        files: impl Iterator<Item = &'a Path>,
    ) -> usize {
        let options = [command, "--json"]
            .into_iter()
            .chain(options.iter().copied());
        let arguments = options.map(OsString::from).chain(files.map(OsString::from));
        self.0.push(arguments.collect());
        self.0.len() - 1
    }

    /// Runs all, this many at the same time; returns what each printed.
    pub(super) fn run(&self, at_once: usize) -> anyhow::Result<Vec<Lines>> {
        let progress = Progress::counting("measuring", "runs", self.0.len() as u64);
        let next = AtomicUsize::new(0);
        let work = || -> anyhow::Result<Vec<(usize, Lines)>> {
            let mut done = Vec::new();
            while let number = next.fetch_add(1, Ordering::Relaxed)
                && let Some(arguments) = self.0.get(number)
            {
                done.push((number, lines(arguments)?));
                progress.step();
            }
            Ok(done)
        };
        let mut found = vec![Lines::new(); self.0.len()];
        std::thread::scope(|scope| {
            let workers: Vec<_> = (0..at_once).map(|_| scope.spawn(work)).collect();
            for worker in workers {
                let done = worker.join().map_err(|_| anyhow!("a thread panicked"))??;
                for (number, lines) in done {
                    found[number] = lines;
                }
            }
            Ok(found)
        })
    }
}

fn lines(arguments: &[OsString]) -> anyhow::Result<Lines> {
    let executable = std::env::current_exe().context("cannot find this executable")?;
    let shown = arguments.join(" ".as_ref());
    let shown = format!("backcast {}", shown.display());
    let output = Command::new(executable).args(arguments).output();
    let output = output.with_context(|| format!("cannot run {shown}"))?;
    if !output.status.success() {
        let said = String::from_utf8_lossy(&output.stderr);
        bail!("{shown}: {}: {}", output.status, said.trim());
    }
    let lines = output.stdout.split(|&byte| byte == b'\n');
    let lines = lines.filter(|line| !line.is_empty());
    let parse = |line| serde_json::from_slice(line).with_context(|| format!("{shown}: no JSON"));
    lines.map(parse).collect()
}
