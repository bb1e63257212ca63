//! Python with third-party libraries, for comparison.

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::{attempt, locked_folder};

/// Returns a Python with these packages, in an environment called `name` in the target folder, once
/// `imports` can be imported. Concurrent tests wait for the one that makes it.
pub fn with(name: &str, packages: &[&str], imports: &str) -> Result<PathBuf, String> {
    let (folder, _lock) = locked_folder(&format!("python_{name}"));
    let python = folder.join("bin/python");
    let import = format!("import {imports}");
    if run(&python, &["-c", &import]).is_ok() {
        return Ok(python);
    }
    let folder = folder.to_str().unwrap();
    run(Path::new("python3"), &["-m", "venv", "--clear", folder])?;
    let install = ["-m", "pip", "install", "--quiet"];
    run(&python, &[&install, packages].concat())?;
    run(&python, &["-c", &import])?;
    Ok(python)
}

fn run(program: &Path, arguments: &[&str]) -> Result<(), String> {
    attempt(Command::new(program).args(arguments))
}
