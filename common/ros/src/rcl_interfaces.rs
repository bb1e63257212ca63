//! `rcl_interfaces`: the parameters of a node, and the services that read and set them.

use serde::{Deserialize, Serialize};

use super::definition::{definition, part};
use super::{RosMessage, RosService, Time};

/// `rcl_interfaces/msg/ParameterType`: what a parameter holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u8)]
pub enum ParameterType {
    /// Nothing: there is no such parameter.
    NotSet = 0,
    /// True or false.
    Bool = 1,
    /// A whole number.
    Integer = 2,
    /// A number.
    Double = 3,
    /// A text.
    String = 4,
    /// Bytes.
    ByteArray = 5,
    /// A list of true and false.
    BoolArray = 6,
    /// A list of whole numbers.
    IntegerArray = 7,
    /// A list of numbers.
    DoubleArray = 8,
    /// A list of texts.
    StringArray = 9,
}

impl ParameterType {
    /// The type with this number, if there is one.
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

/// `rcl_interfaces/msg/ParameterValue`: the field that `type` names counts.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct ParameterValue {
    /// A [`ParameterType`].
    pub r#type: u8,
    /// True or false.
    pub bool_value: bool,
    /// A whole number.
    pub integer_value: i64,
    /// A number.
    pub double_value: f64,
    /// A text.
    pub string_value: String,
    /// Bytes.
    pub byte_array_value: Vec<u8>,
    /// A list of true and false.
    pub bool_array_value: Vec<bool>,
    /// A list of whole numbers.
    pub integer_array_value: Vec<i64>,
    /// A list of numbers.
    pub double_array_value: Vec<f64>,
    /// A list of texts.
    pub string_array_value: Vec<String>,
}

/// `rcl_interfaces/msg/Parameter`.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Parameter {
    /// Its name; a dot stands between levels.
    pub name: String,
    /// What it holds.
    pub value: ParameterValue,
}

/// `rcl_interfaces/msg/ParameterDescriptor`.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct ParameterDescriptor {
    /// Its name.
    pub name: String,
    /// A [`ParameterType`].
    pub r#type: u8,
    /// What it means.
    pub description: String,
    /// What is allowed, in words.
    pub additional_constraints: String,
    /// Whether it cannot be set while the node runs.
    pub read_only: bool,
    /// Whether its type may change.
    pub dynamic_typing: bool,
    /// What a number may be; at most one.
    pub floating_point_range: Vec<FloatingPointRange>,
    /// What a whole number may be; at most one.
    pub integer_range: Vec<IntegerRange>,
}

/// `rcl_interfaces/msg/FloatingPointRange`.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct FloatingPointRange {
    /// The least.
    pub from_value: f64,
    /// The most.
    pub to_value: f64,
    /// From one allowed number to the next; 0 where all are allowed.
    pub step: f64,
}

/// `rcl_interfaces/msg/IntegerRange`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct IntegerRange {
    /// The least.
    pub from_value: i64,
    /// The most.
    pub to_value: i64,
    /// From one allowed number to the next; 0 where all are allowed.
    pub step: u64,
}

/// `rcl_interfaces/msg/SetParametersResult`.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct SetParametersResult {
    /// Whether it was set.
    pub successful: bool,
    /// Why not.
    pub reason: String,
}

/// `rcl_interfaces/msg/ListParametersResult`.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct ListParametersResult {
    /// Names of parameters.
    pub names: Vec<String>,
    /// What stands before their last dots.
    pub prefixes: Vec<String>,
}

/// `rcl_interfaces/msg/ParameterEvent`: what became of a node's parameters.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct ParameterEvent {
    /// When.
    pub stamp: Time,
    /// The node's whole name.
    pub node: String,
    /// Those that there were not before.
    pub new_parameters: Vec<Parameter>,
    /// Those that hold something else.
    pub changed_parameters: Vec<Parameter>,
    /// Those that there are no more.
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

/// Names of parameters: the request of several services.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct ParameterNames {
    /// The names.
    pub names: Vec<String>,
}

/// Parameters to be set: the request of two services.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct SetParametersRequest {
    /// Names and values.
    pub parameters: Vec<Parameter>,
}

const NAMES: &str = "string[] names\n";
const PARAMETERS: &str = definition!("rcl_interfaces/Parameter[] parameters\n", Parameter);

/// `rcl_interfaces/srv/GetParameters`.
#[derive(Debug)]
pub enum GetParameters {}

/// What parameters hold, in the order in which they were asked for.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct GetParametersResponse {
    /// The values.
    pub values: Vec<ParameterValue>,
}

impl RosService for GetParameters {
    const NAME: &'static str = "rcl_interfaces/srv/GetParameters";
    const REQUEST: &'static str = NAMES;
    const RESPONSE: &'static str =
        definition!("rcl_interfaces/ParameterValue[] values\n", ParameterValue);
    type Request = ParameterNames;
    type Response = GetParametersResponse;
}

/// `rcl_interfaces/srv/GetParameterTypes`.
#[derive(Debug)]
pub enum GetParameterTypes {}

/// The types of parameters, in the order in which they were asked for.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct GetParameterTypesResponse {
    /// A [`ParameterType`] each.
    pub types: Vec<u8>,
}

impl RosService for GetParameterTypes {
    const NAME: &'static str = "rcl_interfaces/srv/GetParameterTypes";
    const REQUEST: &'static str = NAMES;
    const RESPONSE: &'static str = "uint8[] types\n";
    type Request = ParameterNames;
    type Response = GetParameterTypesResponse;
}

/// `rcl_interfaces/srv/SetParameters`.
#[derive(Debug)]
pub enum SetParameters {}

/// What became of each parameter.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct SetParametersResponse {
    /// In the order in which they were to be set.
    pub results: Vec<SetParametersResult>,
}

impl RosService for SetParameters {
    const NAME: &'static str = "rcl_interfaces/srv/SetParameters";
    const REQUEST: &'static str = PARAMETERS;
    const RESPONSE: &'static str = definition!(
        "rcl_interfaces/SetParametersResult[] results\n",
        SetParametersResult
    );
    type Request = SetParametersRequest;
    type Response = SetParametersResponse;
}

/// `rcl_interfaces/srv/SetParametersAtomically`.
#[derive(Debug)]
pub enum SetParametersAtomically {}

/// What became of all parameters together.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct SetParametersAtomicallyResponse {
    /// All are set or none.
    pub result: SetParametersResult,
}

impl RosService for SetParametersAtomically {
    const NAME: &'static str = "rcl_interfaces/srv/SetParametersAtomically";
    const REQUEST: &'static str = PARAMETERS;
    const RESPONSE: &'static str = definition!(
        "rcl_interfaces/SetParametersResult result\n",
        SetParametersResult
    );
    type Request = SetParametersRequest;
    type Response = SetParametersAtomicallyResponse;
}

/// `rcl_interfaces/srv/ListParameters`.
#[derive(Debug)]
pub enum ListParameters {}

/// Asks for names of parameters.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct ListParametersRequest {
    /// What they begin with, up to a dot; empty where all are wanted.
    pub prefixes: Vec<String>,
    /// Levels below the prefixes; 0 where all are wanted.
    pub depth: u64,
}

/// Names of parameters.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct ListParametersResponse {
    /// The names.
    pub result: ListParametersResult,
}

impl RosService for ListParameters {
    const NAME: &'static str = "rcl_interfaces/srv/ListParameters";
    const REQUEST: &'static str = "string[] prefixes\nuint64 depth\n";
    const RESPONSE: &'static str = definition!(
        "rcl_interfaces/ListParametersResult result\n",
        "\
rcl_interfaces/ListParametersResult
string[] names
string[] prefixes
",
    );
    type Request = ListParametersRequest;
    type Response = ListParametersResponse;
}

/// `rcl_interfaces/srv/DescribeParameters`.
#[derive(Debug)]
pub enum DescribeParameters {}

/// What parameters mean, in the order in which they were asked for.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct DescribeParametersResponse {
    /// The descriptors.
    pub descriptors: Vec<ParameterDescriptor>,
}

impl RosService for DescribeParameters {
    const NAME: &'static str = "rcl_interfaces/srv/DescribeParameters";
    const REQUEST: &'static str = NAMES;
    const RESPONSE: &'static str = concat!(
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
    );
    type Request = ParameterNames;
    type Response = DescribeParametersResponse;
}
