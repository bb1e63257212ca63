//! Names and hashes of the types of messages and services, as other nodes compare them.
//!
//! A hash is that of REP-2011 (`RIHS01`): SHA-256 over the names and types of the fields, and over
//! those of the types that they contain. ROS publishes the hashes of its types with them. The tests
//! with a robot of other libraries compare each one with the hash that these make of the definition.

use std::fmt;

use crate::GatewayError;

/// Type name and hash, in the form that all middlewares use.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct TypeInfo {
    /// Name, such as `std_msgs::msg::dds_::String_`.
    pub(super) name: String,
    /// Hash: `RIHS01_` and 64 digits.
    pub(super) hash: String,
}

impl fmt::Display for TypeInfo {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.name, self.hash)
    }
}

#[rustfmt::skip]
const HASHES: [(&str, &str); 29] = [
    ("backcast_msgs/msg/Localization", "54798799c773940db42bfa44236b5f3da93c8460bc340fdaf6044ac49036447c"),
    ("bond/msg/Status", "87eaccffa254ffffadc0b61600452e8251740f06c25659a2dbda4927fdb1f70a"),
    ("diagnostic_msgs/msg/DiagnosticArray", "5a8a36efb05fb25070fa0fb3810290c0e6cd4862b54a8fb975a1ee8dc55a333e"),
    ("geometry_msgs/msg/PoseArray", "af0cc36d190e104d546d168d6b39df04fa4b4ccecf59cb4c9ed328d3d5004aa0"),
    ("geometry_msgs/msg/PoseWithCovarianceStamped", "26432f9803e43727d3c8f668d1fdb3c630f548af631e2f4e31382371bfea3b6e"),
    ("lifecycle_msgs/msg/TransitionEvent", "d5f8873a2f0146498f812d7885c7327ce27e463d36811d8792f35ee38c0d6c38"),
    ("lifecycle_msgs/srv/ChangeState", "356fe34f0475a43acf54542013af4167b0e729f77ea22ffb045c6ad8e20668e5"),
    ("lifecycle_msgs/srv/GetAvailableStates", "00a07d79d2207d71e81a8cbc1880e5d924cc16d4688ea8e8e06e443dc8f8aa1d"),
    ("lifecycle_msgs/srv/GetAvailableTransitions", "59b7ecefce0982a8a844b9f2c4f14764c1c4543cc55e72924e2aa4adad83e9bc"),
    ("lifecycle_msgs/srv/GetState", "800a0a5aae599782b02932de0caf563f6dc4e7e94b794eadde075ba2cbef9795"),
    ("nav2_msgs/msg/ParticleCloud", "193d8cb88ca2b98cd81ece15342744f054bb398ebfa8f6369914432303f42b11"),
    ("nav2_msgs/srv/SetInitialPose", "1f818551d505d16d89c8bf9b07121a6408de4408b7889dfda9a0db326c296153"),
    ("nav_msgs/msg/OccupancyGrid", "8d348150c12913a31ee0ec170fbf25089e4745d17035792a1ba94d6f0bc0cfc7"),
    ("nav_msgs/msg/Odometry", "3cc97dc7fb7502f8714462c526d369e35b603cfc34d946e3f2eda2766dfec6e0"),
    ("rcl_interfaces/msg/Log", "e28ce254ca8abc06abf92773b74602cdbf116ed34fbaf294fb9f81da9f318eac"),
    ("rcl_interfaces/msg/ParameterEvent", "043e627780fcad87a22d225bc2a037361dba713fca6a6b9f4b869a5aa0393204"),
    ("rcl_interfaces/srv/DescribeParameters", "845b484d71eb0673dae682f2e3ba3c4851a65a3dcfb97bddd82c5b57e91e4cff"),
    ("rcl_interfaces/srv/GetParameterTypes", "da199c878688b3e530bdfe3ca8f74cb9fa0c303101e980a9e8f260e25e1c80ca"),
    ("rcl_interfaces/srv/GetParameters", "bf9803d5c74cf989a5de3e0c2e99444599a627c7ff75f97b8c05b01003675cbc"),
    ("rcl_interfaces/srv/ListParameters", "3e6062bfbb27bfb8730d4cef2558221f51a11646d78e7bb30a1e83afac3aad9d"),
    ("rcl_interfaces/srv/SetParameters", "56eed9a67e169f9cb6c1f987bc88f868c14a8fc9f743a263bc734c154015d7e0"),
    ("rcl_interfaces/srv/SetParametersAtomically", "0e192ef259c07fc3c07a13191d27002222e65e00ccec653ca05e856f79285fcd"),
    ("rosgraph_msgs/msg/Clock", "692f7a66e93a3c83e71765d033b60349ba68023a8c689a79e48078bcb5c58564"),
    ("sensor_msgs/msg/LaserScan", "64c191398013af96509d518dac71d5164f9382553fce5c1f8cca5be7924bd828"),
    ("sensor_msgs/msg/PointCloud2", "9198cabf7da3796ae6fe19c4cb3bdd3525492988c70522628af5daa124bae2b5"),
    ("std_msgs/msg/String", "df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18"),
    ("std_srvs/srv/Empty", "5888399dedec5ccc85ea6451949fd2c9f97bfdf963f9a588821639fcd31b5d19"),
    ("tf2_msgs/msg/TFMessage", "e369d0f05a23ae52508854b66f6aa0437f3449d652e8cbf22d5abe85d020f087"),
    ("type_description_interfaces/srv/GetTypeDescription", "69b9c19c1021405984cc60dbbb1edceb147a6538b411d812ba6afabeed962cd5"),
];

impl TypeInfo {
    /// Returns name and hash of a type by its name in ROS, such as `std_msgs/msg/String`.
    pub(super) fn of(name: &str) -> Result<Self, GatewayError> {
        let hash = HASHES.iter().find(|(known, _)| *known == name);
        let ends = name.rsplit_once('/');
        match (hash, ends) {
            (Some((_, hash)), Some((before, kind))) => Ok(TypeInfo {
                name: format!("{}::dds_::{kind}_", before.replace('/', "::")),
                hash: format!("RIHS01_{hash}"),
            }),
            _ => Err(GatewayError::Refused(format!(
                "the hash of the type {name} is not known"
            ))),
        }
    }
}
