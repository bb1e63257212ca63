//! Full names of the robot's topics and services.

use messages::Name;
use ros::lasers;

use crate::config::Config;
use crate::{GatewayError, rmw};

/// Full names: those of the options, resolved, and those that are fixed.
#[derive(Debug, Clone)]
pub(crate) struct Topics {
    pub(crate) scans: Vec<Scans>,
    pub(crate) odom: String,
    pub(crate) map: String,
    pub(crate) tf: String,
    pub(crate) tf_static: String,
    pub(crate) amcl_pose: String,
    pub(crate) initial_pose: String,
    pub(crate) hypotheses: String,
    pub(crate) localization: String,
    pub(crate) diagnostics: String,
    pub(crate) reinitialize: String,
    /// For the AMCL role, like the next three; they have AMCL's names.
    pub(crate) particle_cloud: String,
    pub(crate) set_initial_pose: String,
    pub(crate) nomotion: String,
    pub(crate) bond: String,
    /// Independent of the namespace, like the next two.
    pub(crate) clock: String,
    pub(crate) parameter_events: String,
    pub(crate) rosout: String,
}

#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Scans {
    pub(crate) topic: String,
    /// Name of the laser in the graph; empty if it is the only one.
    pub(crate) laser: Name,
}

impl Topics {
    pub(crate) fn of(config: &Config) -> Result<Self, GatewayError> {
        let resolve = |option, name: &str| {
            rmw::resolve(&config.namespace, name)
                .map_err(|reason| GatewayError::Option { option, reason })
        };
        // Checked here, before anything is opened: the name becomes a part of every token.
        resolve("node", config.node())?;
        let names = &config.names;
        Ok(Topics {
            scans: named(&config.scans(), |name| resolve("scan", name))?,
            odom: resolve("odom", &names.odom)?,
            map: resolve("map", config.map())?,
            tf: resolve("tf", &names.tf)?,
            tf_static: resolve("tf-static", &names.tf_static)?,
            amcl_pose: resolve("amcl-pose", &names.amcl_pose)?,
            initial_pose: resolve("initial-pose", &names.initial_pose)?,
            hypotheses: resolve("hypotheses", &names.hypotheses)?,
            localization: resolve("localization", &names.localization)?,
            diagnostics: resolve("diagnostics", &names.diagnostics)?,
            reinitialize: resolve("reinitialize", &names.reinitialize)?,
            particle_cloud: resolve("namespace", "particle_cloud")?,
            set_initial_pose: resolve("namespace", "set_initial_pose")?,
            nomotion: resolve("namespace", "request_nomotion_update")?,
            bond: resolve("namespace", "bond")?,
            clock: "/clock".to_owned(),
            parameter_events: "/parameter_events".to_owned(),
            rosout: "/rosout".to_owned(),
        })
    }
}

/// Returns the scans with the names of their lasers. These come from the names as written, not as
/// resolved, so that a graph fits robots in any namespace.
fn named(
    names: &[String],
    resolve: impl Fn(&str) -> Result<String, GatewayError>,
) -> Result<Vec<Scans>, GatewayError> {
    let refuse = |reason| {
        Err(GatewayError::Option {
            option: "scan",
            reason,
        })
    };
    let mut found: Vec<Scans> = Vec::with_capacity(names.len());
    for name in names {
        let laser = match names.len() {
            1 => String::new(),
            _ => lasers::name_of(name),
        };
        let (bytes, most) = (laser.len(), Name::CAPACITY);
        if bytes > most {
            let reason =
                format!("the laser {laser} has a name of {bytes} bytes: allowed are {most}");
            return refuse(reason);
        }
        let (topic, laser) = (resolve(name)?, Name::new(&laser));
        if let Some(other) = found.iter().find(|other| other.laser == laser) {
            let other = &other.topic;
            return refuse(format!(
                "{other} and {topic} are both of a laser {laser}: allowed are topics that name \
                 lasers apart"
            ));
        }
        found.push(Scans { topic, laser });
    }
    Ok(found)
}

#[cfg(test)]
mod tests {
    use clap::Parser;

    use super::*;

    #[test]
    fn names_are_in_the_namespace_unless_they_begin_with_a_slash() {
        let words = ["ros2_gateway", "--namespace", "/r2", "--tf", "/tf"];
        let topics = Topics::of(&Config::parse_from(words)).unwrap();
        assert_eq!((&*topics.scans[0].topic, &*topics.tf), ("/r2/scan", "/tf"));
        assert_eq!(topics.scans[0].laser.as_str(), "");
        assert_eq!(topics.diagnostics, "/diagnostics");
    }

    #[test]
    fn several_lasers_are_called_by_their_topics_as_they_are_written() {
        let line = |scans: &[&str]| {
            let words = ["ros2_gateway", "--namespace", "/r2"];
            let scans = scans.iter().flat_map(|scan| ["--scan", scan]);
            Topics::of(&Config::parse_from(words.into_iter().chain(scans)))
        };
        let scans = line(&["front/scan", "scan_rear"]).unwrap().scans;
        let found = scans.iter().map(|s| (&*s.topic, s.laser.as_str()));
        let expected = [("/r2/front/scan", "front"), ("/r2/scan_rear", "rear")];
        assert_eq!(found.collect::<Vec<_>>(), expected);
        let error = line(&["front/scan", "scan_front"]).unwrap_err().to_string();
        assert!(
            error.contains("/r2/scan_front are both of a laser front"),
            "{error}"
        );
        let long = "l".repeat(300);
        let error = line(&["front/scan", &long]).unwrap_err().to_string();
        assert!(error.contains("of 300 bytes: allowed are"), "{error}");
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
