//! `type_description_interfaces`: the service that returns the fields of a node's types.

use serde::{Deserialize, Serialize};

use super::definition::part;
use super::service::service;

/// Type of a field.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct FieldType {
    /// Number of the type in ROS.
    pub type_id: u8,
    /// Largest number of elements of a sequence.
    pub capacity: u64,
    /// Largest size of a string, in bytes.
    pub string_capacity: u64,
    /// Name of the type, if it has a description of its own.
    pub nested_type_name: String,
}

#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Field {
    pub name: String,
    pub r#type: FieldType,
    pub default_value: String,
}

#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct IndividualTypeDescription {
    /// Full name, such as `std_msgs/msg/String`.
    pub type_name: String,
    pub fields: Vec<Field>,
}

/// A type and all types that it uses.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct TypeDescription {
    pub type_description: IndividualTypeDescription,
    /// Types that it uses, by name.
    pub referenced_type_descriptions: Vec<IndividualTypeDescription>,
}

/// A file that defines a type.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct TypeSource {
    pub type_name: String,
    /// Format of the file, such as `msg`.
    pub encoding: String,
    pub raw_file_contents: String,
}

#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct KeyValue {
    pub key: String,
    pub value: String,
}

/// Request for the description of a type.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct GetTypeDescriptionRequest {
    /// Full name, such as `std_msgs/msg/String`.
    pub type_name: String,
    /// Hash of the type: `RIHS01_` and 64 hexadecimal digits.
    pub type_hash: String,
    /// True to request the source files as well.
    pub include_type_sources: bool,
}

/// Description of the type, or the reason for the failure.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct GetTypeDescriptionResponse {
    pub successful: bool,
    pub failure_reason: String,
    pub type_description: TypeDescription,
    pub type_sources: Vec<TypeSource>,
    pub extra_information: Vec<KeyValue>,
}

service!(
    GetTypeDescription,
    "type_description_interfaces/srv/GetTypeDescription",
    GetTypeDescriptionRequest: "\
string type_name
string type_hash
bool include_type_sources true
",
    GetTypeDescriptionResponse: concat!(
        "\
bool successful
string failure_reason
type_description_interfaces/TypeDescription type_description
type_description_interfaces/TypeSource[] type_sources
type_description_interfaces/KeyValue[] extra_information
",
        part!(
            "\
type_description_interfaces/TypeDescription
type_description_interfaces/IndividualTypeDescription type_description
type_description_interfaces/IndividualTypeDescription[] referenced_type_descriptions
"
        ),
        part!(
            "\
type_description_interfaces/IndividualTypeDescription
string<=255 type_name
type_description_interfaces/Field[] fields
"
        ),
        part!(
            "\
type_description_interfaces/Field
string name
type_description_interfaces/FieldType type
string default_value
"
        ),
        part!(
            "\
type_description_interfaces/FieldType
uint8 type_id 0
uint64 capacity
uint64 string_capacity
string<=255 nested_type_name
"
        ),
        part!(
            "\
type_description_interfaces/TypeSource
string type_name
string encoding
string raw_file_contents
"
        ),
        part!(
            "\
type_description_interfaces/KeyValue
string key
string value
"
        ),
    ),
);
