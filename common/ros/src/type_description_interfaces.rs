//! `type_description_interfaces`: the service by which a node says what its types are made of.

use serde::{Deserialize, Serialize};

use super::RosService;
use super::definition::part;

/// What a field holds.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct FieldType {
    /// One of the numbers of ROS.
    pub type_id: u8,
    /// Most elements of a list.
    pub capacity: u64,
    /// Most bytes of a text.
    pub string_capacity: u64,
    /// The type, where it is one of another description.
    pub nested_type_name: String,
}

/// A field.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Field {
    /// Its name.
    pub name: String,
    /// What it holds.
    pub r#type: FieldType,
    /// What it holds where nobody says it.
    pub default_value: String,
}

/// A type and its fields.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct IndividualTypeDescription {
    /// As `std_msgs/msg/String`.
    pub type_name: String,
    /// In their order.
    pub fields: Vec<Field>,
}

/// A type and all that it is made of.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct TypeDescription {
    /// The type.
    pub type_description: IndividualTypeDescription,
    /// Those that it is made of, by name.
    pub referenced_type_descriptions: Vec<IndividualTypeDescription>,
}

/// A file that defines a type.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct TypeSource {
    /// The type.
    pub type_name: String,
    /// The form of the file, as `msg`.
    pub encoding: String,
    /// Its text.
    pub raw_file_contents: String,
}

/// A pair of texts.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct KeyValue {
    /// The name.
    pub key: String,
    /// What it holds.
    pub value: String,
}

/// `type_description_interfaces/srv/GetTypeDescription`.
#[derive(Debug)]
pub enum GetTypeDescription {}

/// Which type is asked about.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct GetTypeDescriptionRequest {
    /// As `std_msgs/msg/String`.
    pub type_name: String,
    /// Its hash, as `RIHS01_` and 64 digits.
    pub type_hash: String,
    /// Whether files are wanted, too.
    pub include_type_sources: bool,
}

/// What the type is made of, or why that is not known.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct GetTypeDescriptionResponse {
    /// Whether it is known.
    pub successful: bool,
    /// Why it is not.
    pub failure_reason: String,
    /// The type.
    pub type_description: TypeDescription,
    /// Its files.
    pub type_sources: Vec<TypeSource>,
    /// What else there is to say.
    pub extra_information: Vec<KeyValue>,
}

impl RosService for GetTypeDescription {
    const NAME: &'static str = "type_description_interfaces/srv/GetTypeDescription";
    const REQUEST: &'static str = "\
string type_name
string type_hash
bool include_type_sources true
";
    const RESPONSE: &'static str = concat!(
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
    );
    type Request = GetTypeDescriptionRequest;
    type Response = GetTypeDescriptionResponse;
}
