//! Python with third-party libraries, for comparison.

use std::fs::File;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Returns a Python with these packages, in an environment called `name` in the target folder, once
/// `imports` can be imported. Concurrent tests wait for the one that makes it.
///
/// # Errors
/// Returns the output of the first command that failed, for example without a network.
pub fn with(name: &str, packages: &[&str], imports: &str) -> Result<PathBuf, String> {
    let test = std::env::current_exe().unwrap();
    let target = test.ancestors().nth(3).unwrap();
    let folder = target.join(format!("python_{name}"));
    let lock = File::create(folder.with_extension("lock")).unwrap();
    lock.lock().unwrap();
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
    let command = format!("{} {}", program.display(), arguments.join(" "));
    let outcome = Command::new(program).args(arguments).output();
    let outcome = outcome.map_err(|error| format!("{command}: {error}"))?;
    if outcome.status.success() {
        return Ok(());
    }
    let said = String::from_utf8_lossy(&outcome.stderr);
    Err(format!("{command}: {}\n{said}", outcome.status))
}
