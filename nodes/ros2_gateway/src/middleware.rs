//! Choice of the middleware that reaches the robot.

use clap::ValueEnum;
use serde::Serialize;

#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, ValueEnum, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Rmw {
    /// Fast DDS or Cyclone DDS
    Dds,
    /// rmw_zenoh (jazzy and later)
    Zenoh,
}

/// Returns the middleware of the option `--rmw`, else that of `RMW_IMPLEMENTATION`, with the reason
/// as text.
pub(crate) fn chosen(option: Option<Rmw>, implementation: &str) -> (Rmw, String) {
    if let Some(rmw) = option {
        return (rmw, "by --rmw".to_owned());
    }
    let by_name = match implementation {
        "rmw_zenoh_cpp" => Some(Rmw::Zenoh),
        "rmw_fastrtps_cpp" | "rmw_fastrtps_dynamic_cpp" | "rmw_cyclonedds_cpp" => Some(Rmw::Dds),
        _ => None,
    };
    match (by_name, implementation) {
        (Some(rmw), name) => (rmw, format!("RMW_IMPLEMENTATION is {name}")),
        (None, "") => (
            Rmw::Zenoh,
            "neither --rmw nor RMW_IMPLEMENTATION says another".to_owned(),
        ),
        (None, name) => (
            Rmw::Zenoh,
            format!("RMW_IMPLEMENTATION is {name}, which is not known"),
        ),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_option_counts_before_the_variable() {
        let of = |option, name| chosen(option, name).0;
        assert_eq!(of(None, ""), Rmw::Zenoh);
        assert_eq!(of(None, "rmw_zenoh_cpp"), Rmw::Zenoh);
        assert_eq!(of(None, "rmw_cyclonedds_cpp"), Rmw::Dds);
        assert_eq!(of(None, "rmw_fastrtps_dynamic_cpp"), Rmw::Dds);
        assert_eq!(of(Some(Rmw::Zenoh), "rmw_fastrtps_cpp"), Rmw::Zenoh);
        let (rmw, why) = chosen(None, "rmw_connextdds");
        assert_eq!(rmw, Rmw::Zenoh);
        assert_eq!(
            why,
            "RMW_IMPLEMENTATION is rmw_connextdds, which is not known"
        );
    }
}
