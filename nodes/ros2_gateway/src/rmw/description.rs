//! The type hash of a message or service, from the text of its definition, by the rule of REP-2011
//! (`RIHS01`): SHA-256 over the names and types of its fields, and those of the types that it
//! contains.
//!
//! Constants and defaults do not count.

use std::collections::BTreeMap;
use std::fmt;

use hiroz_schema::{
    FieldDescription, FieldTypeDescription, TypeDescription, TypeDescriptionMsg, TypeId,
    calculate_hash, dds_from_canonical,
};
use ros::RosMessage;

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

/// Field that ROS puts into a message without fields.
const DUMMY: &str = "uint8 structure_needs_at_least_one_member";

/// Definition of the event that each service publishes about its calls.
const EVENT_INFO: &str = "\
================================================================================
MSG: service_msgs/ServiceEventInfo
uint8 event_type
builtin_interfaces/Time stamp
char[16] client_gid
int64 sequence_number
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
";

pub(super) fn of_message<M: RosMessage>() -> Result<TypeInfo, GatewayError> {
    let mut parts = parts(M::SCHEMA, M::DEFINITION)?;
    let main = parts.remove(M::SCHEMA).unwrap_or_default();
    info(M::SCHEMA, described(M::SCHEMA, main), parts)
}

/// Returns name and hash of a service type whose request and response have these fields.
pub(super) fn of_service(
    name: &str,
    request: &str,
    response: &str,
) -> Result<TypeInfo, GatewayError> {
    let [requests, responses, events] =
        ["Request", "Response", "Event"].map(|part| format!("{name}_{part}"));
    let mut all = parts(&requests, request)?;
    all.append(&mut parts(&responses, response)?);
    // The text before the first part has no name, and is empty.
    all.append(&mut parts("", EVENT_INFO)?);
    all.remove("");
    let sequence = TypeId::NESTED_TYPE_BOUNDED_SEQUENCE;
    let event = vec![
        nested(
            "info",
            TypeId::NESTED_TYPE,
            0,
            "service_msgs/msg/ServiceEventInfo",
        ),
        nested("request", sequence, 1, &requests),
        nested("response", sequence, 1, &responses),
    ];
    all.insert(events.clone(), event);
    let main = vec![
        nested("request_message", TypeId::NESTED_TYPE, 0, &requests),
        nested("response_message", TypeId::NESTED_TYPE, 0, &responses),
        nested("event_message", TypeId::NESTED_TYPE, 0, &events),
    ];
    info(name, described(name, main), all)
}

fn info(
    name: &str,
    main: TypeDescription,
    parts: BTreeMap<String, Vec<FieldDescription>>,
) -> Result<TypeInfo, GatewayError> {
    let unknown = || GatewayError::Definition {
        name: name.to_owned(),
        line: name.to_owned(),
    };
    let dds = dds_from_canonical(name).ok_or_else(unknown)?;
    let parts = parts.into_iter();
    let hash = calculate_hash(&TypeDescriptionMsg {
        type_description: main,
        // Sorted by name, as the rule wants them.
        referenced_type_descriptions: parts.map(|(name, f)| described(&name, f)).collect(),
    });
    Ok(TypeInfo {
        name: dds,
        hash: hash.to_rihs_string(),
    })
}

fn described(name: &str, fields: Vec<FieldDescription>) -> TypeDescription {
    TypeDescription {
        type_name: name.to_owned(),
        fields,
    }
}

fn nested(name: &str, id: u8, capacity: u64, of: &str) -> FieldDescription {
    FieldDescription {
        name: name.to_owned(),
        field_type: FieldTypeDescription::nested_array(id, capacity, of),
        default_value: String::new(),
    }
}

/// Returns the fields of a type and of all types that it contains, by name.
fn parts(
    name: &str,
    definition: &str,
) -> Result<BTreeMap<String, Vec<FieldDescription>>, GatewayError> {
    let separator = "=".repeat(80);
    let mut parts = BTreeMap::new();
    for (number, part) in definition.split(separator.as_str()).enumerate() {
        let (name, lines) = match part.trim_start().strip_prefix("MSG: ") {
            Some(part) if number > 0 => part.split_once('\n').unwrap_or((part, "")),
            _ => (name, part),
        };
        let name = canonical(name.trim());
        let fields = fields(&name, lines)?;
        parts.insert(name, fields);
    }
    Ok(parts)
}

/// Expands `std_msgs/Header` to `std_msgs/msg/Header`.
fn canonical(name: &str) -> String {
    match name.split_once('/') {
        Some((package, kind)) if !kind.contains('/') => format!("{package}/msg/{kind}"),
        _ => name.to_owned(),
    }
}

fn fields(name: &str, lines: &str) -> Result<Vec<FieldDescription>, GatewayError> {
    let code = |line: &'_ str| line.split('#').next().unwrap_or("").trim().to_owned();
    let is_constant = |line: &str| line.split_whitespace().skip(1).any(|w| w.contains('='));
    let mut fields = Vec::new();
    for line in lines.lines().map(code) {
        if !line.is_empty() && !is_constant(&line) {
            let wrong = || GatewayError::Definition {
                name: name.to_owned(),
                line: line.clone(),
            };
            fields.push(field(&line).ok_or_else(wrong)?);
        }
    }
    if fields.is_empty() {
        fields.extend(field(DUMMY));
    }
    Ok(fields)
}

fn field(line: &str) -> Option<FieldDescription> {
    let mut words = line.split_whitespace();
    let (kind, name) = (words.next()?, words.next()?);
    let (kind, offset, capacity) = match kind.split_once('[') {
        None => (kind, 0, 0),
        Some((kind, "]")) => (kind, TypeId::UNBOUNDED_SEQUENCE_OFFSET, 0),
        Some((kind, bound)) if bound.starts_with("<=") => {
            let most = bound.strip_prefix("<=")?.strip_suffix(']')?.parse().ok()?;
            (kind, TypeId::BOUNDED_SEQUENCE_OFFSET, most)
        }
        Some((kind, length)) => {
            let length = length.strip_suffix(']')?.parse().ok()?;
            (kind, TypeId::ARRAY_OFFSET, length)
        }
    };
    let (kind, string_capacity) = match kind.split_once("<=") {
        Some((text, most)) => (text, most.parse().ok()?),
        None => (kind, 0),
    };
    let primitive = match (kind, string_capacity) {
        ("string", 1..) => Some(TypeId::BOUNDED_STRING),
        (_, 1..) => return None,
        (_, 0) => primitive(kind),
    };
    let field_type = FieldTypeDescription {
        type_id: primitive.unwrap_or(TypeId::NESTED_TYPE) + offset,
        capacity,
        string_capacity,
        nested_type_name: match primitive {
            Some(_) => String::new(),
            // Our definitions name the package of each type.
            None => kind.contains('/').then(|| canonical(kind))?,
        },
    };
    Some(FieldDescription {
        name: name.to_owned(),
        field_type,
        default_value: String::new(),
    })
}

fn primitive(kind: &str) -> Option<u8> {
    Some(match kind {
        "bool" => TypeId::BOOL,
        "byte" => TypeId::BYTE,
        // In definitions, `char` is an unsigned number of eight bits.
        "char" | "uint8" => TypeId::UINT8,
        "int8" => TypeId::INT8,
        "int16" => TypeId::INT16,
        "uint16" => TypeId::UINT16,
        "int32" => TypeId::INT32,
        "uint32" => TypeId::UINT32,
        "int64" => TypeId::INT64,
        "uint64" => TypeId::UINT64,
        "float32" => TypeId::FLOAT32,
        "float64" => TypeId::FLOAT64,
        "string" => TypeId::STRING,
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use ros::backcast_msgs::Localization;
    use ros::lifecycle_msgs::{ChangeState, TransitionEvent};
    use ros::nav2_msgs::{ParticleCloud, SetInitialPose};
    use ros::rcl_interfaces::{DescribeParameters, GetParameters, ParameterEvent};
    use ros::type_description_interfaces::GetTypeDescription;
    use ros::{
        BondStatus, Clock, DiagnosticArray, LaserScan, OccupancyGridMsg, Odometry, PointCloud2,
        PoseArray, PoseWithCovarianceStamped, RosService, TfMessage,
    };

    use super::*;

    fn service<S: RosService>() -> Result<TypeInfo, GatewayError> {
        of_service(S::NAME, S::REQUEST, S::RESPONSE)
    }

    /// Returns the type of a part of the response of this service.
    fn parameter_descriptor() -> Result<TypeInfo, GatewayError> {
        let name = "rcl_interfaces/msg/ParameterDescriptor";
        let whole = DescribeParameters::RESPONSE;
        let descriptor = whole.split_once("rcl_interfaces/ParameterDescriptor\n");
        let mut all = parts(name, descriptor.unwrap().1)?;
        let main = described(name, all.remove(name).unwrap());
        info(name, main, all)
    }

    fn check(types: &[(Result<TypeInfo, GatewayError>, &str, &str)]) {
        for (info, kind, hash) in types {
            let info = info.as_ref().unwrap();
            let (package, name) = kind.split_once(' ').unwrap();
            assert_eq!(info.name, format!("{package}::dds_::{name}_"));
            assert_eq!(info.hash, format!("RIHS01_{hash}"), "{name}");
        }
    }

    #[test]
    #[rustfmt::skip]
    fn types_have_the_hashes_that_ros_gives_them() {
        // ROS 2 jazzy publishes these hashes with these types.
        check(&[
            (of_message::<LaserScan>(), "sensor_msgs::msg LaserScan", "64c191398013af96509d518dac71d5164f9382553fce5c1f8cca5be7924bd828"),
            (of_message::<PointCloud2>(), "sensor_msgs::msg PointCloud2", "9198cabf7da3796ae6fe19c4cb3bdd3525492988c70522628af5daa124bae2b5"),
            (of_message::<Odometry>(), "nav_msgs::msg Odometry", "3cc97dc7fb7502f8714462c526d369e35b603cfc34d946e3f2eda2766dfec6e0"),
            (of_message::<OccupancyGridMsg>(), "nav_msgs::msg OccupancyGrid", "8d348150c12913a31ee0ec170fbf25089e4745d17035792a1ba94d6f0bc0cfc7"),
            (of_message::<TfMessage>(), "tf2_msgs::msg TFMessage", "e369d0f05a23ae52508854b66f6aa0437f3449d652e8cbf22d5abe85d020f087"),
            (of_message::<PoseWithCovarianceStamped>(), "geometry_msgs::msg PoseWithCovarianceStamped", "26432f9803e43727d3c8f668d1fdb3c630f548af631e2f4e31382371bfea3b6e"),
            (of_message::<PoseArray>(), "geometry_msgs::msg PoseArray", "af0cc36d190e104d546d168d6b39df04fa4b4ccecf59cb4c9ed328d3d5004aa0"),
            (of_message::<DiagnosticArray>(), "diagnostic_msgs::msg DiagnosticArray", "5a8a36efb05fb25070fa0fb3810290c0e6cd4862b54a8fb975a1ee8dc55a333e"),
            (of_message::<ros::Text>(), "std_msgs::msg String", "df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18"),
            (of_service("example_interfaces/srv/AddTwoInts", "int64 a\nint64 b\n", "int64 sum\n"), "example_interfaces::srv AddTwoInts", "e118de6bf5eeb66a2491b5bda11202e7b68f198d6f67922cf30364858239c81a"),
        ]);
        // `rosbags` makes these hashes of the definitions.
        check(&[
            (of_message::<ParticleCloud>(), "nav2_msgs::msg ParticleCloud", "193d8cb88ca2b98cd81ece15342744f054bb398ebfa8f6369914432303f42b11"),
            (of_message::<BondStatus>(), "bond::msg Status", "87eaccffa254ffffadc0b61600452e8251740f06c25659a2dbda4927fdb1f70a"),
            (of_message::<ParameterEvent>(), "rcl_interfaces::msg ParameterEvent", "043e627780fcad87a22d225bc2a037361dba713fca6a6b9f4b869a5aa0393204"),
            (of_message::<Clock>(), "rosgraph_msgs::msg Clock", "692f7a66e93a3c83e71765d033b60349ba68023a8c689a79e48078bcb5c58564"),
            (of_message::<Localization>(), "backcast_msgs::msg Localization", "54798799c773940db42bfa44236b5f3da93c8460bc340fdaf6044ac49036447c"),
            (of_message::<TransitionEvent>(), "lifecycle_msgs::msg TransitionEvent", "d5f8873a2f0146498f812d7885c7327ce27e463d36811d8792f35ee38c0d6c38"),
            (parameter_descriptor(), "rcl_interfaces::msg ParameterDescriptor", "52175dbfda6c51153101d33d2a9da05743f66f02d5ab2ca9ec4709b46b73d704"),
        ]);
        // `zenoh_ros2_sdk` makes these hashes of the definitions.
        check(&[
            (service::<ChangeState>(), "lifecycle_msgs::srv ChangeState", "356fe34f0475a43acf54542013af4167b0e729f77ea22ffb045c6ad8e20668e5"),
            (service::<GetParameters>(), "rcl_interfaces::srv GetParameters", "bf9803d5c74cf989a5de3e0c2e99444599a627c7ff75f97b8c05b01003675cbc"),
            (service::<DescribeParameters>(), "rcl_interfaces::srv DescribeParameters", "845b484d71eb0673dae682f2e3ba3c4851a65a3dcfb97bddd82c5b57e91e4cff"),
            // This one has bounded strings.
            (service::<GetTypeDescription>(), "type_description_interfaces::srv GetTypeDescription", "69b9c19c1021405984cc60dbbb1edceb147a6538b411d812ba6afabeed962cd5"),
            (service::<SetInitialPose>(), "nav2_msgs::srv SetInitialPose", "1f818551d505d16d89c8bf9b07121a6408de4408b7889dfda9a0db326c296153"),
        ]);
    }

    #[test]
    fn what_is_no_field_is_refused_by_name() {
        for line in [
            "float32",
            "string<=x name",
            "int8<=5 name",
            "Header header",
            "int8[x] cells",
            "int8[<=x] cells",
        ] {
            let error = of_service("a/srv/B", line, "").unwrap_err().to_string();
            assert!(error.contains(line), "{error}");
        }
    }
}
