//! `type_description_interfaces`: the service that returns the fields of a node's types.

use super::definition::ShortString;

declare! {
    /// Type of a field.
    part FieldType = "type_description_interfaces/FieldType" [] {
        /// Number of the type in ROS.
        type_id: u8 = 0,
        /// Largest number of elements of a sequence.
        capacity: u64,
        /// Largest size of a string, in bytes.
        string_capacity: u64,
        /// Name of the type, if it has a description of its own.
        nested_type_name: ShortString,
    }

    part Field = "type_description_interfaces/Field" [FieldType] {
        name: String,
        r#type: FieldType,
        default_value: String,
    }

    part IndividualTypeDescription = "type_description_interfaces/IndividualTypeDescription"
        [Field] {
        /// Full name, such as `std_msgs/msg/String`.
        type_name: ShortString,
        fields: Vec<Field>,
    }

    /// A type and all types that it uses.
    part TypeDescription = "type_description_interfaces/TypeDescription"
        [IndividualTypeDescription] {
        type_description: IndividualTypeDescription,
        /// Types that it uses, by name.
        referenced_type_descriptions: Vec<IndividualTypeDescription>,
    }

    /// A file that defines a type.
    part TypeSource = "type_description_interfaces/TypeSource" [] {
        type_name: String,
        /// Format of the file, such as `msg`.
        encoding: String,
        raw_file_contents: String,
    }

    part KeyValue = "type_description_interfaces/KeyValue" [] {
        key: String,
        value: String,
    }

    /// Request for the description of a type.
    call GetTypeDescriptionRequest [] {
        /// Full name, such as `std_msgs/msg/String`.
        type_name: String,
        /// Hash of the type: `RIHS01_` and 64 hexadecimal digits.
        type_hash: String,
        /// True to request the source files as well.
        include_type_sources: bool = true,
    }

    /// Description of the type, or the reason for the failure.
    call GetTypeDescriptionResponse [TypeDescription, TypeSource, KeyValue] {
        successful: bool,
        failure_reason: String,
        type_description: TypeDescription,
        type_sources: Vec<TypeSource>,
        extra_information: Vec<KeyValue>,
    }

    service GetTypeDescription = "type_description_interfaces/srv/GetTypeDescription":
        GetTypeDescriptionRequest -> GetTypeDescriptionResponse;
}
