//! Role of the gateway on the robot, and the options of the AMCL role.

use std::path::PathBuf;

use clap::ValueEnum;
use messages::InitialPoseKind;

use crate::GatewayError;

/// Options of the gateway in AMCL's place.
#[derive(Debug, Clone, clap::Args)]
#[command(next_help_heading = "In AMCL's place")]
pub struct Options {
    /// Role of the gateway on the robot
    #[arg(long = "as", value_name = "ROLE", default_value = "seed")]
    pub role: Role,

    /// Parameter file in the format of ROS, such as that of nav2_amcl; later files override earlier
    /// ones; with --as amcl
    #[arg(long, value_name = "FILE")]
    pub params_file: Vec<PathBuf>,

    /// A parameter, such as `use_sim_time:=true`, which overrides those of files; with --as amcl
    #[arg(long, value_name = "NAME:=VALUE")]
    pub parameter: Vec<String>,

    /// Start active, for robots without a lifecycle manager; with --as amcl
    #[arg(long)]
    pub autostart: bool,

    /// Believe initial poses of initialpose, set_initial_pose and the parameters at once, without a
    /// scan that confirms them; with --as amcl
    #[arg(long)]
    pub believe_initial_pose: bool,
}

impl Options {
    /// Returns the kind of an initial pose that a user or another node gives.
    pub(crate) fn kind(&self) -> InitialPoseKind {
        match self.believe_initial_pose {
            true => InitialPoseKind::Believed,
            false => InitialPoseKind::Hint,
        }
    }

    /// Rejects options of the AMCL role in the other role.
    pub(crate) fn check(&self) -> Result<(), GatewayError> {
        let given = [
            (!self.params_file.is_empty(), "params-file"),
            (!self.parameter.is_empty(), "parameter"),
            (self.autostart, "autostart"),
            (self.believe_initial_pose, "believe-initial-pose"),
        ];
        match given.into_iter().find(|(is_given, _)| *is_given) {
            Some((_, option)) if self.role != Role::Amcl => Err(GatewayError::Option {
                option,
                reason: "allowed with --as amcl".to_owned(),
            }),
            _ => Ok(()),
        }
    }
}

/// Role of the gateway on the robot.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Role {
    /// Next to a particle filter, which gets its initial pose
    Seed,
    /// In place of nav2_amcl
    Amcl,
}

#[cfg(test)]
mod tests {
    use clap::Parser;

    use crate::Config;

    #[test]
    fn options_of_amcls_place_are_refused_elsewhere() {
        let parse = |words: &[&str]| Config::parse_from(["ros2_gateway"].iter().chain(words));
        let options: [&[&str]; 4] = [
            &["--autostart"],
            &["--params-file", "a"],
            &["--parameter", "a:=1"],
            &["--believe-initial-pose"],
        ];
        for words in options {
            let error = parse(words).amcl.check().unwrap_err().to_string();
            assert_eq!(error, format!("{}: allowed with --as amcl", words[0]));
            let with = [words, &["--as", "amcl"]].concat();
            parse(&with).amcl.check().unwrap();
        }
    }
}
