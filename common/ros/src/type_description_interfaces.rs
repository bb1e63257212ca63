//! `type_description_interfaces`: the service that returns the fields of a node's types.

use super::Nothing;

declare! {
    /// Request for the description of a type.
    call GetTypeDescriptionRequest {
        /// Full name, such as `std_msgs/msg/String`.
        type_name: String,
        /// Hash of the type: `RIHS01_` and 64 hexadecimal digits.
        type_hash: String,
        /// True to request the source files as well.
        include_type_sources: bool,
    }

    /// Reason for a failure. The other fields are those of a description, and stay empty.
    call GetTypeDescriptionResponse {
        successful: bool,
        failure_reason: String,
        described_name: String,
        described_fields: Vec<Nothing>,
        referenced_type_descriptions: Vec<Nothing>,
        type_sources: Vec<Nothing>,
        extra_information: Vec<Nothing>,
    }

    service GetTypeDescription = "type_description_interfaces/srv/GetTypeDescription":
        GetTypeDescriptionRequest -> GetTypeDescriptionResponse;
}
