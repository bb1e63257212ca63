//! Keys of topics and of liveliness tokens.
//!
//! The robot is a separate part of the key, so that access rules can name it.

use crate::{Wire, WireError};

/// Longest name of a robot or a map, in bytes.
pub const MAX_NAME_BYTES: usize = 64;

/// Second part of the keys of [`locate`]; a robot must not have this name.
const LOCATE: &str = "locate";

/// Checks a name that is used in keys, where `/`, `*`, `$`, `?`, `#` and `@` have special meanings.
pub fn name(text: &str) -> Result<String, WireError> {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || "-_.".contains(c);
    if (1..=MAX_NAME_BYTES).contains(&text.len()) && text.chars().all(is_plain) {
        return Ok(text.to_owned());
    }
    let found = text.chars().take(2 * MAX_NAME_BYTES).collect();
    Err(WireError::Name { found })
}

/// Checks the name of a robot.
pub fn robot(text: &str) -> Result<String, WireError> {
    if text == LOCATE {
        let found = text.to_owned();
        return Err(WireError::Taken { found });
    }
    name(text)
}

/// Returns the name of a robot without another one: that of this machine.
pub fn robot_of_host() -> String {
    named_after(&gethostname::gethostname().to_string_lossy())
}

/// Returns the host's name if it is valid in keys, else `robot`.
fn named_after(host: &str) -> String {
    robot(host).unwrap_or_else(|_| "robot".to_owned())
}

/// Returns the key of location requests on a map: `backcast/locate/<map>`.
pub fn locate(map: &str) -> String {
    format!("backcast/{LOCATE}/{map}")
}

/// Returns the key of a robot's topic: `backcast/<robot>/<topic>`.
pub fn key<T: Wire>(robot: &str) -> String {
    format!("backcast/{robot}/{}", T::NAME)
}

/// Returns the key of the liveliness token of a process of the robot,
/// `backcast/<robot>/alive/<session>`, with `/<node>` appended for that of a node.
pub fn alive(robot: &str, session: &str, node: Option<&str>) -> String {
    let session = format!("backcast/{robot}/alive/{session}");
    node.map_or_else(|| session.clone(), |node| format!("{session}/{node}"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use messages::topic;

    #[test]
    fn keys_name_robot_and_topic() {
        assert_eq!(key::<topic::Scan>("r2"), "backcast/r2/scan");
        assert_eq!(alive("r2", "a1", None), "backcast/r2/alive/a1");
        assert_eq!(
            alive("r2", "a1", Some("engine")),
            "backcast/r2/alive/a1/engine"
        );
    }

    #[test]
    fn who_is_not_named_is_called_as_the_machine() {
        assert_eq!(named_after("desk"), "desk");
        assert_eq!(named_after("a/b"), "robot");
    }

    #[test]
    fn names_that_mean_something_in_a_key_are_refused() {
        assert_eq!(robot("R2-d.2_x").unwrap(), "R2-d.2_x");
        let long = "x".repeat(MAX_NAME_BYTES + 1);
        for name in ["", "a/b", "*", "a*", "$x", "a?", "a#", "@a", "ä", &long] {
            let error = robot(name).unwrap_err().to_string();
            assert!(error.contains("1 to 64 of a-z A-Z 0-9 - _ ."), "{error}");
        }
        let error = robot("locate").unwrap_err().to_string();
        assert!(error.contains("is taken"), "{error}");
        assert_eq!(locate(&name("locate").unwrap()), "backcast/locate/locate");
    }
}
