//! The type hash of a message or service, from the text of its definition, by the rule
//! of REP-2011 (`RIHS01`): SHA-256 over the fields' names and types, and those of the
//! types that it is made of.
//!
//! Constants and defaults do not count.

use std::collections::BTreeMap;

use hiroz_schema::{
    FieldDescription, FieldTypeDescription, TypeDescription, TypeDescriptionMsg, TypeId,
    calculate_hash, dds_from_canonical,
};
use ros::RosMessage;

use super::type_info::TypeInfo;
use crate::GatewayError;

/// What ROS puts into a message without fields.
const DUMMY: &str = "uint8 structure_needs_at_least_one_member";

/// What each service keeps of its calls, for who watches.
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

/// Name and hash of a message type, as keys hold them.
pub(super) fn of_message<M: RosMessage>() -> Result<TypeInfo, GatewayError> {
    let mut parts = parts(M::SCHEMA, M::DEFINITION)?;
    let main = parts.remove(M::SCHEMA).unwrap_or_default();
    info(M::SCHEMA, described(M::SCHEMA, main), parts)
}

/// Likewise of a service whose request and response have these fields.
pub(super) fn of_service(
    name: &str,
    request: &str,
    response: &str,
) -> Result<TypeInfo, GatewayError> {
    let [requests, responses, events] =
        ["Request", "Response", "Event"].map(|part| format!("{name}_{part}"));
    let mut all = parts(&requests, request)?;
    all.append(&mut parts(&responses, response)?);
    // What stands before the first part has no name, and is nothing.
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
        // By name, as the rule wants them.
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

/// The fields of a type and of all that it is made of, by name.
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

/// `std_msgs/Header` and `std_msgs/msg/Header` are one.
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
            // Ours name the package of each type.
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
        // In definitions it is a number of eight bits.
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
        BondStatus, Clock, DiagnosticArray, LaserScan, OccupancyGridMsg, Odometry, PoseArray,
        PoseWithCovarianceStamped, RosService, TfMessage,
    };

    use super::*;

    fn check(info: Result<TypeInfo, GatewayError>, name: &str, hash: &str) {
        let info = info.unwrap();
        assert_eq!(info.name, name);
        assert_eq!(info.hash, format!("RIHS01_{hash}"), "{name}");
    }

    /// The hashes are those that ROS 2 jazzy publishes with these types.
    #[test]
    fn messages_have_the_hashes_that_ros_gives_them() {
        check(
            of_message::<LaserScan>(),
            "sensor_msgs::msg::dds_::LaserScan_",
            "64c191398013af96509d518dac71d5164f9382553fce5c1f8cca5be7924bd828",
        );
        check(
            of_message::<Odometry>(),
            "nav_msgs::msg::dds_::Odometry_",
            "3cc97dc7fb7502f8714462c526d369e35b603cfc34d946e3f2eda2766dfec6e0",
        );
        check(
            of_message::<OccupancyGridMsg>(),
            "nav_msgs::msg::dds_::OccupancyGrid_",
            "8d348150c12913a31ee0ec170fbf25089e4745d17035792a1ba94d6f0bc0cfc7",
        );
        check(
            of_message::<TfMessage>(),
            "tf2_msgs::msg::dds_::TFMessage_",
            "e369d0f05a23ae52508854b66f6aa0437f3449d652e8cbf22d5abe85d020f087",
        );
        check(
            of_message::<PoseWithCovarianceStamped>(),
            "geometry_msgs::msg::dds_::PoseWithCovarianceStamped_",
            "26432f9803e43727d3c8f668d1fdb3c630f548af631e2f4e31382371bfea3b6e",
        );
        check(
            of_message::<PoseArray>(),
            "geometry_msgs::msg::dds_::PoseArray_",
            "af0cc36d190e104d546d168d6b39df04fa4b4ccecf59cb4c9ed328d3d5004aa0",
        );
        check(
            of_message::<DiagnosticArray>(),
            "diagnostic_msgs::msg::dds_::DiagnosticArray_",
            "5a8a36efb05fb25070fa0fb3810290c0e6cd4862b54a8fb975a1ee8dc55a333e",
        );
        check(
            of_message::<ros::Text>(),
            "std_msgs::msg::dds_::String_",
            "df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18",
        );
    }

    /// As `rosbags` makes them of the definitions.
    #[test]
    fn messages_in_amcls_place_have_their_hashes() {
        check(
            of_message::<ParticleCloud>(),
            "nav2_msgs::msg::dds_::ParticleCloud_",
            "193d8cb88ca2b98cd81ece15342744f054bb398ebfa8f6369914432303f42b11",
        );
        check(
            of_message::<BondStatus>(),
            "bond::msg::dds_::Status_",
            "87eaccffa254ffffadc0b61600452e8251740f06c25659a2dbda4927fdb1f70a",
        );
        check(
            of_message::<ParameterEvent>(),
            "rcl_interfaces::msg::dds_::ParameterEvent_",
            "043e627780fcad87a22d225bc2a037361dba713fca6a6b9f4b869a5aa0393204",
        );
        check(
            of_message::<Clock>(),
            "rosgraph_msgs::msg::dds_::Clock_",
            "692f7a66e93a3c83e71765d033b60349ba68023a8c689a79e48078bcb5c58564",
        );
        check(
            of_message::<Localization>(),
            "backcast_msgs::msg::dds_::Localization_",
            "54798799c773940db42bfa44236b5f3da93c8460bc340fdaf6044ac49036447c",
        );
        check(
            of_message::<TransitionEvent>(),
            "lifecycle_msgs::msg::dds_::TransitionEvent_",
            "d5f8873a2f0146498f812d7885c7327ce27e463d36811d8792f35ee38c0d6c38",
        );
        let whole = DescribeParameters::RESPONSE;
        let (_, descriptor) = whole
            .split_once("rcl_interfaces/ParameterDescriptor\n")
            .unwrap();
        let name = "rcl_interfaces/msg/ParameterDescriptor";
        let mut all = parts(name, descriptor).unwrap();
        let main = described(name, all.remove(name).unwrap());
        check(
            info(name, main, all),
            "rcl_interfaces::msg::dds_::ParameterDescriptor_",
            "52175dbfda6c51153101d33d2a9da05743f66f02d5ab2ca9ec4709b46b73d704",
        );
    }

    #[test]
    fn services_have_the_hashes_that_ros_gives_them() {
        check(
            of_service(
                "example_interfaces/srv/AddTwoInts",
                "int64 a\nint64 b\n",
                "int64 sum\n",
            ),
            "example_interfaces::srv::dds_::AddTwoInts_",
            "e118de6bf5eeb66a2491b5bda11202e7b68f198d6f67922cf30364858239c81a",
        );
    }

    /// As `zenoh_ros2_sdk` makes them of the definitions.
    #[test]
    fn services_of_a_managed_node_have_their_hashes() {
        fn of<S: RosService>() -> Result<TypeInfo, GatewayError> {
            of_service(S::NAME, S::REQUEST, S::RESPONSE)
        }
        check(
            of::<ChangeState>(),
            "lifecycle_msgs::srv::dds_::ChangeState_",
            "356fe34f0475a43acf54542013af4167b0e729f77ea22ffb045c6ad8e20668e5",
        );
        check(
            of::<GetParameters>(),
            "rcl_interfaces::srv::dds_::GetParameters_",
            "bf9803d5c74cf989a5de3e0c2e99444599a627c7ff75f97b8c05b01003675cbc",
        );
        check(
            of::<DescribeParameters>(),
            "rcl_interfaces::srv::dds_::DescribeParameters_",
            "845b484d71eb0673dae682f2e3ba3c4851a65a3dcfb97bddd82c5b57e91e4cff",
        );
        // With bounded texts.
        check(
            of::<GetTypeDescription>(),
            "type_description_interfaces::srv::dds_::GetTypeDescription_",
            "69b9c19c1021405984cc60dbbb1edceb147a6538b411d812ba6afabeed962cd5",
        );
        check(
            of::<SetInitialPose>(),
            "nav2_msgs::srv::dds_::SetInitialPose_",
            "1f818551d505d16d89c8bf9b07121a6408de4408b7889dfda9a0db326c296153",
        );
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
