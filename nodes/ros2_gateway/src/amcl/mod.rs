//! The gateway in the place of `nav2_amcl`: the same node, topics, services and parameters, and a
//! pose without an initial guess.
//!
//! `lifecycle`, `parameters`, `params_file`, `hint`, `cloud` and `standing` are pure. `life` and
//! `parameter_services` offer the first two to other nodes, and `rosout` publishes the log. `body`
//! is the part that a lifecycle manager configures and activates, with `parts` while it is
//! configured.

mod body;
mod bond;
mod cloud;
mod hint;
mod hints;
mod life;
mod lifecycle;
mod outgoing;
mod parameter_services;
mod parameters;
mod params_file;
mod rosout;
mod saved_pose;
mod sim_clock;
mod standing;

use std::path::Path;
use std::time::Duration;

use transport::{Flow, Graph};
use zenoh_session::Report;

use crate::GatewayError;
use crate::config::{Config, Seed};
use crate::joined::{Joined, Results};
use crate::rmw;
use crate::topics::Topics;
use body::Body;
use life::Life;
use parameter_services::ParameterServices;
use parameters::Parameters;
use rosout::Rosout;

/// Runs in AMCL's place until the stop flag is set; takes a step at least every `tick`.
pub(crate) fn run(graph: &Graph, config: &Config, tick: Duration) -> Result<(), GatewayError> {
    let node = rmw::resolve(&config.namespace, config.node());
    let node = node.map_err(|reason| GatewayError::Option {
        option: "node",
        reason,
    })?;
    let mut parameters = Parameters::default();
    for file in &config.amcl.params_file {
        for remark in load(&mut parameters, file, &node)? {
            tracing::warn!("{remark}");
        }
    }
    for rule in &config.amcl.parameter {
        for remark in params_file::set(&mut parameters, rule, &node)? {
            tracing::warn!("{remark}");
        }
    }
    check_saved_pose_file(&mut parameters)?;
    let config = applied(config, &parameters);
    let topics = Topics::of(&config)?;
    let domain = config.domain()?;
    config.mounts()?;
    let mut report = Report::new(graph.health()?);
    let Some(member) = rmw::join(graph, &config, &mut report)? else {
        return Ok(());
    };
    let mut life = Life::open(&*member, &node)?;
    let mut services = ParameterServices::open(&*member, &node, &topics.parameter_events)?;
    let mut rosout = Rosout::open(graph, &*member, &topics.rosout, &node)?;
    let joined = Joined {
        graph,
        member: &*member,
        config: &config,
        topics: &topics,
    };
    let mut body = Body::new(joined);
    let results = Results::open(graph)?;
    tracing::info!(domain, node, "joined the robot's domain in AMCL's place");
    if config.amcl.autostart || parameters.is_on("autostart_node") {
        life.start(|change| body.change(change, &parameters));
    }
    graph.run(&results.all(), tick, |_| {
        life.serve(|change| body.change(change, &parameters), &mut report)?;
        services.serve(&mut parameters, &mut report)?;
        rosout.send(&mut report)?;
        let state = life.lifecycle.state;
        body.step(&results, state, &parameters, &mut report)?;
        report.tick()?;
        Ok(Flow::Continue)
    })
}

fn load(parameters: &mut Parameters, path: &Path, node: &str) -> Result<Vec<String>, GatewayError> {
    let file = path.display().to_string();
    let text = std::fs::read_to_string(path)
        .map_err(|error| GatewayError::Refused(format!("{file}: {error}")))?;
    params_file::load(parameters, &text, &file, node)
}

/// Rejects a file of the saved pose that another user controls. If it is the default file, the pose
/// is not saved instead: another user who occupies AMCL's default in `/tmp` does not keep the node
/// from starting.
fn check_saved_pose_file(parameters: &mut Parameters) -> Result<(), GatewayError> {
    let checked = parameters.saved_pose_file().map(saved_pose::check);
    match checked {
        Some(Err(error)) if parameters.has_default_file() => {
            parameters.clear_saved_pose_file();
            tracing::warn!(
                "{error}: the pose is not saved; {} names another file",
                parameters::FILE
            );
            Ok(())
        }
        Some(checked) => checked,
        None => Ok(()),
    }
}

/// Merges the parameters into the options. An option that was given takes precedence.
fn applied(config: &Config, parameters: &Parameters) -> Config {
    let mut config = config.clone();
    config.seed = Seed::Never;
    let text = |name: &str| parameters.text(name).to_owned();
    config.map_frame.get_or_insert(text("global_frame_id"));
    config.odom_frame.get_or_insert(text("odom_frame_id"));
    config.names.map.get_or_insert(text("map_topic"));
    if config.names.scans.is_empty() {
        config.names.scans = vec![text("scan_topic")];
    }
    config
}

#[cfg(test)]
mod tests {
    use clap::Parser;

    use super::*;

    #[test]
    fn parameters_name_frames_and_topics_where_no_option_does() {
        let mut parameters = Parameters::default();
        for (name, value) in [
            ("scan_topic", "front"),
            ("odom_frame_id", "o"),
            ("map_topic", "m"),
        ] {
            let value = parameters::Value::Text(value.into());
            assert_eq!(parameters.load(name, value).unwrap(), None);
        }
        let config = Config::parse_from(["ros2_gateway", "--as", "amcl"]);
        assert_eq!(config.node(), "amcl");
        let found = applied(&config, &parameters);
        assert_eq!(
            (found.scans(), found.map(), found.odom_frame()),
            (vec!["front".to_owned()], "m", "o")
        );
        assert_eq!(found.map_frame.as_deref(), Some("map"));
        // Options count even if they say the same as without them.
        let given = "ros2_gateway --as amcl --scan scan --scan b --map map --odom-frame odom";
        let found = applied(&Config::parse_from(given.split(' ')), &parameters);
        assert_eq!(found.scans(), ["scan", "b"]);
        assert_eq!((found.map(), found.odom_frame()), ("map", "odom"));
    }
}
