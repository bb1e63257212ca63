//! `rcl_interfaces`: parameters of a node, and the services that read and set them.

use serde::{Deserialize, Serialize};

use super::definition::{definition, part};
use super::service::service;
use super::{RosMessage, Time};

/// `rcl_interfaces/msg/ParameterType`: type of a parameter's value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u8)]
pub enum ParameterType {
    /// No such parameter.
    NotSet = 0,
    Bool = 1,
    Integer = 2,
    Double = 3,
    String = 4,
    ByteArray = 5,
    BoolArray = 6,
    IntegerArray = 7,
    DoubleArray = 8,
    StringArray = 9,
}

impl ParameterType {
    /// Returns the type with this number, if there is one.
    #[must_use]
    pub fn from_code(code: u8) -> Option<Self> {
        [
            Self::NotSet,
            Self::Bool,
            Self::Integer,
            Self::Double,
            Self::String,
            Self::ByteArray,
            Self::BoolArray,
            Self::IntegerArray,
            Self::DoubleArray,
            Self::StringArray,
        ]
        .into_iter()
        .find(|kind| *kind as u8 == code)
    }
}

/// `rcl_interfaces/msg/ParameterValue`: `type` selects the field that holds the value.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct ParameterValue {
    /// A [`ParameterType`].
    pub r#type: u8,
    pub bool_value: bool,
    pub integer_value: i64,
    pub double_value: f64,
    pub string_value: String,
    pub byte_array_value: Vec<u8>,
    pub bool_array_value: Vec<bool>,
    pub integer_array_value: Vec<i64>,
    pub double_array_value: Vec<f64>,
    pub string_array_value: Vec<String>,
}

/// `rcl_interfaces/msg/Parameter`.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Parameter {
    /// Name; dots separate its levels.
    pub name: String,
    pub value: ParameterValue,
}

/// `rcl_interfaces/msg/ParameterDescriptor`.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct ParameterDescriptor {
    pub name: String,
    /// A [`ParameterType`].
    pub r#type: u8,
    pub description: String,
    /// Description of further constraints.
    pub additional_constraints: String,
    /// True if it cannot be set while the node runs.
    pub read_only: bool,
    /// True if its type may change.
    pub dynamic_typing: bool,
    /// Allowed range of a floating-point number; at most one.
    pub floating_point_range: Vec<FloatingPointRange>,
    /// Allowed range of an integer; at most one.
    pub integer_range: Vec<IntegerRange>,
}

/// `rcl_interfaces/msg/FloatingPointRange`.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct FloatingPointRange {
    pub from_value: f64,
    pub to_value: f64,
    /// Step between allowed values; 0 if all are allowed.
    pub step: f64,
}

/// `rcl_interfaces/msg/IntegerRange`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct IntegerRange {
    pub from_value: i64,
    pub to_value: i64,
    /// Step between allowed values; 0 if all are allowed.
    pub step: u64,
}

/// `rcl_interfaces/msg/SetParametersResult`.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct SetParametersResult {
    /// True if the parameter was set.
    pub successful: bool,
    /// Reason if it was not.
    pub reason: String,
}

/// `rcl_interfaces/msg/ListParametersResult`.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct ListParametersResult {
    pub names: Vec<String>,
    /// Prefixes of the names, up to their last dots.
    pub prefixes: Vec<String>,
}

/// `rcl_interfaces/msg/ParameterEvent`: changes of a node's parameters.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct ParameterEvent {
    pub stamp: Time,
    /// Full name of the node.
    pub node: String,
    pub new_parameters: Vec<Parameter>,
    pub changed_parameters: Vec<Parameter>,
    pub deleted_parameters: Vec<Parameter>,
}

impl RosMessage for ParameterEvent {
    const SCHEMA: &'static str = "rcl_interfaces/msg/ParameterEvent";
    const DEFINITION: &'static str = definition!(
        "\
builtin_interfaces/Time stamp
string node
rcl_interfaces/Parameter[] new_parameters
rcl_interfaces/Parameter[] changed_parameters
rcl_interfaces/Parameter[] deleted_parameters
",
        Time,
        Parameter,
    );
}

/// Request of several services: names of parameters.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct ParameterNames {
    pub names: Vec<String>,
}

/// Request of two services: parameters to set.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct SetParametersRequest {
    pub parameters: Vec<Parameter>,
}

const NAMES: &str = "string[] names\n";
const PARAMETERS: &str = definition!("rcl_interfaces/Parameter[] parameters\n", Parameter);

/// Values of parameters, in the order of the request.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct GetParametersResponse {
    pub values: Vec<ParameterValue>,
}

service!(
    GetParameters,
    "rcl_interfaces/srv/GetParameters",
    ParameterNames: NAMES,
    GetParametersResponse: definition!("rcl_interfaces/ParameterValue[] values\n", ParameterValue),
);

/// Types of parameters, in the order of the request.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct GetParameterTypesResponse {
    /// Values of [`ParameterType`].
    pub types: Vec<u8>,
}

service!(
    GetParameterTypes,
    "rcl_interfaces/srv/GetParameterTypes",
    ParameterNames: NAMES,
    GetParameterTypesResponse: "uint8[] types\n",
);

/// Result for each parameter, in the order of the request.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct SetParametersResponse {
    pub results: Vec<SetParametersResult>,
}

service!(
    SetParameters,
    "rcl_interfaces/srv/SetParameters",
    SetParametersRequest: PARAMETERS,
    SetParametersResponse: definition!(
        "rcl_interfaces/SetParametersResult[] results\n",
        SetParametersResult
    ),
);

/// Result for all parameters: either all are set or none.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct SetParametersAtomicallyResponse {
    pub result: SetParametersResult,
}

service!(
    SetParametersAtomically,
    "rcl_interfaces/srv/SetParametersAtomically",
    SetParametersRequest: PARAMETERS,
    SetParametersAtomicallyResponse: definition!(
        "rcl_interfaces/SetParametersResult result\n",
        SetParametersResult
    ),
);

/// Request for names of parameters.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct ListParametersRequest {
    /// Prefixes of the names, up to a dot; empty for all parameters.
    pub prefixes: Vec<String>,
    /// Number of levels below the prefixes; 0 for all levels.
    pub depth: u64,
}

#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct ListParametersResponse {
    pub result: ListParametersResult,
}

service!(
    ListParameters,
    "rcl_interfaces/srv/ListParameters",
    ListParametersRequest: "string[] prefixes\nuint64 depth\n",
    ListParametersResponse: definition!(
        "rcl_interfaces/ListParametersResult result\n",
        "\
rcl_interfaces/ListParametersResult
string[] names
string[] prefixes
",
    ),
);

/// Descriptions of parameters, in the order of the request.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct DescribeParametersResponse {
    pub descriptors: Vec<ParameterDescriptor>,
}

service!(
    DescribeParameters,
    "rcl_interfaces/srv/DescribeParameters",
    ParameterNames: NAMES,
    DescribeParametersResponse: concat!(
        "rcl_interfaces/ParameterDescriptor[] descriptors\n",
        part!(
            "\
rcl_interfaces/ParameterDescriptor
string name
uint8 type
string description
string additional_constraints
bool read_only false
bool dynamic_typing false
rcl_interfaces/FloatingPointRange[<=1] floating_point_range
rcl_interfaces/IntegerRange[<=1] integer_range
"
        ),
        part!(
            "\
rcl_interfaces/FloatingPointRange
float64 from_value
float64 to_value
float64 step
"
        ),
        part!(
            "\
rcl_interfaces/IntegerRange
int64 from_value
int64 to_value
uint64 step
"
        ),
    ),
);
