//! Options of a transcript.

use messages::FrameName;

/// Names of frames that have none in the graph.
#[derive(Debug, Clone, clap::Args)]
pub struct Options {
    /// Name of the map frame in messages of ROS
    #[arg(long, value_name = "FRAME", default_value = "map", value_parser = frame)]
    pub map_frame: String,

    /// Name of the robot's frame in messages of ROS, if the laser's mount is known
    #[arg(long, value_name = "FRAME", default_value = "base_link", value_parser = frame)]
    pub base_frame: String,
}

fn frame(text: &str) -> Result<String, String> {
    match text.len() {
        1..=FrameName::CAPACITY => Ok(text.into()),
        bytes => Err(format!(
            "it has {bytes} bytes, allowed are 1 to {}",
            FrameName::CAPACITY
        )),
    }
}
