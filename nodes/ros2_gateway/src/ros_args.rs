//! Translation of ROS arguments to options of the gateway. Pure.
//!
//! ```text
//! ros2_gateway --as amcl --ros-args -r __ns:=/r2 -r /tf:=tf -p use_sim_time:=true --params-file FILE
//! ```
//!
//! The rules are those of <https://design.ros2.org/articles/ros_command_line_arguments.html>:
//! arguments between `--ros-args` and `--` are for ROS.

use std::ffi::OsString;

/// Flags of ROS without effect here: the gateway logs to standard error and, in AMCL's place, to
/// `/rosout`.
const IDLE: [&str; 6] = [
    "--enable-rosout-logs",
    "--disable-rosout-logs",
    "--enable-stdout-logs",
    "--disable-stdout-logs",
    "--enable-external-lib-logs",
    "--disable-external-lib-logs",
];

/// Names that can be remapped, and the options that do so.
const NAMES: [(&str, &str); 11] = [
    ("scan", "--scan"),
    ("odom", "--odom"),
    ("map", "--map"),
    ("tf", "--tf"),
    ("tf_static", "--tf-static"),
    ("amcl_pose", "--amcl-pose"),
    ("initialpose", "--initial-pose"),
    ("hypotheses", "--hypotheses"),
    ("localization", "--localization"),
    ("diagnostics", "--diagnostics"),
    ("reinitialize_global_localization", "--reinitialize"),
];

/// Translates a command line, whose first word is the name of the program.
pub fn translated(words: impl Iterator<Item = OsString>) -> Result<Vec<String>, String> {
    let text = |word: OsString| {
        let refused = |word: OsString| format!("{word:?}: allowed is text in UTF-8");
        word.into_string().map_err(refused)
    };
    let words = words.map(text).collect::<Result<Vec<String>, String>>()?;
    let mut words = words.into_iter();
    let mut found = Vec::new();
    let mut is_for_ros = false;
    while let Some(word) = words.next() {
        match &*word {
            "--ros-args" => is_for_ros = true,
            "--" if is_for_ros => is_for_ros = false,
            _ if !is_for_ros => found.push(word),
            "-r" | "--remap" => remap(&following(&word, words.next())?, &mut found)?,
            "-p" | "--param" => {
                let rule = following(&word, words.next())?;
                if let Some(rule) = of_this_node(&rule) {
                    found.extend(["--parameter".to_owned(), rule.to_owned()]);
                }
            }
            "--params-file" | "--log-level" => {
                found.extend([word.clone(), following(&word, words.next())?]);
            }
            "-e" | "--enclave" | "--log-config-file" | "--log-file-name" => {
                following(&word, words.next())?;
            }
            flag if IDLE.contains(&flag) => {}
            other => {
                return Err(format!(
                    "{other:?} after --ros-args: allowed are -r, -p, --params-file and --log-level"
                ));
            }
        }
    }
    Ok(found)
}

fn following(flag: &str, next: Option<String>) -> Result<String, String> {
    next.ok_or_else(|| format!("{flag} ends the arguments: a value must follow"))
}

/// Removes the name of the node from a rule. The gateway is one node and takes rules for any node
/// as its own: launch files give each process its own rules.
fn of_this_node(rule: &str) -> Option<&str> {
    let name = rule.split(":=").next()?;
    match name.split_once(':') {
        Some((node, _)) => rule.get(node.len() + 1..),
        None => Some(rule),
    }
}

fn remap(rule: &str, found: &mut Vec<String>) -> Result<(), String> {
    let rule = of_this_node(rule).unwrap_or(rule);
    let (from, to) = rule
        .split_once(":=")
        .ok_or_else(|| format!("the remapping {rule:?} has no :=, as in scan:=front/scan"))?;
    let option = match from {
        "__node" | "__name" => "--node",
        "__ns" => "--namespace",
        _ => {
            let from = from.trim_start_matches('/').trim_start_matches("~/");
            let known = NAMES.iter().find(|(name, _)| *name == from);
            let (_, option) = known.ok_or_else(|| {
                let names = NAMES.map(|(name, _)| name).join(", ");
                format!("the remapping of {from:?}: allowed are __node, __ns, {names}")
            })?;
            option
        }
    };
    found.push(format!("{option}={to}"));
    Ok(())
}

#[cfg(test)]
mod tests {
    use std::os::unix::ffi::OsStringExt;

    use super::*;

    fn of(line: &str) -> Result<String, String> {
        let words = line.split_whitespace().map(OsString::from);
        translated(words).map(|found| found.join(" "))
    }

    #[test]
    fn what_launch_files_hand_to_amcl_is_understood() {
        let found = of(
            "g --as amcl --ros-args --log-level info --ros-args -r __node:=amcl -r __ns:=/r2 \
             --params-file /tmp/a -r /tf:=tf -r tf_static:=/tf_static -p use_sim_time:=true",
        );
        assert_eq!(
            found.unwrap(),
            "g --as amcl --log-level info --node=amcl --namespace=/r2 --params-file /tmp/a \
             --tf=tf --tf-static=/tf_static --parameter use_sim_time:=true"
        );
    }

    #[test]
    fn what_follows_two_dashes_is_the_gateways_own() {
        let found = of("g --ros-args -p amcl:max_beams:=3 --enable-rosout-logs -- --domain 4");
        assert_eq!(found.unwrap(), "g --parameter max_beams:=3 --domain 4");
    }

    #[test]
    fn words_that_are_no_text_are_refused() {
        let word = OsString::from_vec(vec![b'g', 0xff]);
        let error = translated([word].into_iter()).unwrap_err();
        assert!(error.contains("allowed is text in UTF-8"), "{error}");
    }

    #[test]
    fn what_is_not_understood_is_named_with_what_would_be() {
        for (line, expected) in [
            ("g --ros-args -r", "a value must follow"),
            ("g --ros-args -r scan", "has no :="),
            ("g --ros-args -r cloud:=c", "\"cloud\": allowed are __node"),
            ("g --ros-args --domain 3", "\"--domain\" after --ros-args"),
        ] {
            let error = of(line).unwrap_err();
            assert!(error.contains(expected), "{line}: {error}");
        }
    }
}
