//! Python with libraries of others, to compare with.

use std::path::{Path, PathBuf};
use std::process::Command;

/// A Python with these packages in an environment called `name` in the target folder,
/// where `imports` are there; `None` where it cannot be made, as without a network.
#[must_use]
pub fn with(name: &str, packages: &[&str], imports: &str) -> Option<PathBuf> {
    let test = std::env::current_exe().unwrap();
    let target = test.ancestors().nth(3).unwrap();
    let folder = target.join(format!("python_{name}"));
    let python = folder.join("bin/python");
    let run = |program: &Path, arguments: &[&str]| {
        let outcome = Command::new(program).args(arguments).output();
        outcome.is_ok_and(|outcome| outcome.status.success())
    };
    let import = format!("import {imports}");
    let is_there = || run(&python, &["-c", &import]);
    if is_there() {
        return Some(python);
    }
    let made = run(
        Path::new("python3"),
        &["-m", "venv", folder.to_str().unwrap()],
    ) && run(
        &python,
        &[&["-m", "pip", "install", "-q"], packages].concat(),
    ) && is_there();
    made.then_some(python)
}
