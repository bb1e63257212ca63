//! The robot's topics and services by their whole names.

use crate::config::{Config, Names};
use crate::{GatewayError, ros};

/// As in [`Names`], resolved.
#[derive(Debug, Clone)]
pub(crate) struct Topics {
    pub(crate) scan: String,
    pub(crate) odom: String,
    pub(crate) map: String,
    pub(crate) tf: String,
    pub(crate) tf_static: String,
    pub(crate) amcl_pose: String,
    pub(crate) initial_pose: String,
    pub(crate) hypotheses: String,
    pub(crate) diagnostics: String,
    pub(crate) reinitialize: String,
}

impl Topics {
    pub(crate) fn of(config: &Config) -> Result<Self, GatewayError> {
        let resolve = |option, name: &str| {
            ros::resolve(&config.namespace, name)
                .map_err(|reason| GatewayError::Option { option, reason })
        };
        // Refused here, before anything is opened: it becomes a part of every token.
        resolve("node", &config.node)?;
        let Names {
            scan,
            odom,
            map,
            tf,
            tf_static,
            amcl_pose,
            initial_pose,
            hypotheses,
            diagnostics,
            reinitialize,
        } = &config.names;
        Ok(Topics {
            scan: resolve("scan", scan)?,
            odom: resolve("odom", odom)?,
            map: resolve("map", map)?,
            tf: resolve("tf", tf)?,
            tf_static: resolve("tf-static", tf_static)?,
            amcl_pose: resolve("amcl-pose", amcl_pose)?,
            initial_pose: resolve("initial-pose", initial_pose)?,
            hypotheses: resolve("hypotheses", hypotheses)?,
            diagnostics: resolve("diagnostics", diagnostics)?,
            reinitialize: resolve("reinitialize", reinitialize)?,
        })
    }
}

#[cfg(test)]
mod tests {
    use clap::Parser;

    use super::*;

    #[test]
    fn names_are_in_the_namespace_unless_they_begin_with_a_slash() {
        let words = ["ros2_gateway", "--namespace", "/r2", "--tf", "/tf"];
        let topics = Topics::of(&Config::parse_from(words)).unwrap();
        assert_eq!((&*topics.scan, &*topics.tf), ("/r2/scan", "/tf"));
        assert_eq!(topics.diagnostics, "/diagnostics");
    }

    #[test]
    fn a_wrong_name_names_its_option() {
        for [option, value] in [["--scan", "a b"], ["--namespace", "r2"], ["--node", "a/*"]] {
            let config = Config::parse_from(["ros2_gateway", option, value]);
            let error = Topics::of(&config).unwrap_err().to_string();
            assert!(
                error.starts_with("--") && error.contains("allowed"),
                "{error}"
            );
        }
    }
}
