//! axe-core, which finds accessibility problems of a page. It is not part of this repository: npm
//! fetches it when a test first needs it.

use std::path::Path;
use std::process::Command;

use serde_json::Value;

use crate::browser::Browser;
use crate::{attempt, locked_folder};

const PACKAGE: &str = "axe-core@4.14.1";

/// Returns the script, which is kept in the target folder. Concurrent tests wait for the one that
/// fetches it.
pub fn script() -> Result<String, String> {
    let (folder, _lock) = locked_folder(PACKAGE);
    let script = folder.join("package/axe.min.js");
    if let Ok(text) = std::fs::read_to_string(&script) {
        return Ok(text);
    }
    std::fs::create_dir_all(&folder).unwrap();
    run(&folder, "npm", &["pack", "--silent", PACKAGE])?;
    let archive = PACKAGE.replace('@', "-") + ".tgz";
    run(&folder, "tar", &["-xzf", &archive, "package/axe.min.js"])?;
    std::fs::read_to_string(&script).map_err(|error| format!("{}: {error}", script.display()))
}

fn run(folder: &Path, program: &str, arguments: &[&str]) -> Result<(), String> {
    attempt(Command::new(program).args(arguments).current_dir(folder))
}

/// Returns the violations of WCAG 2.2, level AA, and of axe's best practices on the current page: a
/// line for each rule and each element.
pub fn violations(browser: &Browser, script: &str) -> Vec<String> {
    let _ = browser.run(script);
    let found = browser.finish(
        "const tags = ['wcag2a', 'wcag2aa', 'wcag21a', 'wcag21aa', 'wcag22aa', 'best-practice'];
         axe.run({ runOnly: tags }).then(
             ({ passes, violations }) => done({ passes: passes.length, violations }),
             (error) => done({ error: String(error) }));",
    );
    assert_eq!(found["error"], Value::Null);
    let passes = found["passes"].as_u64().unwrap();
    assert!(passes > 10, "it looked at a page: {passes} rules");
    let text = |value: &Value| value.as_str().unwrap_or_default().to_owned();
    let of_rule = |rule: &Value| {
        let id = text(&rule["id"]);
        let nodes = rule["nodes"].as_array().cloned().unwrap_or_default();
        nodes.into_iter().map(move |node| {
            let why = text(&node["failureSummary"]).replace('\n', " ");
            format!("{id}: {}: {why}", text(&node["html"]))
        })
    };
    let violations = found["violations"].as_array().unwrap();
    violations.iter().flat_map(of_rule).collect()
}
