//! `rcl_interfaces`: parameters of a node, and the services that read and set them.

use super::Time;
use super::definition::{AtMostOne, Byte};

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

declare! {
    /// `rcl_interfaces/msg/ParameterValue`: `type` selects the field that holds the value.
    part ParameterValue = "rcl_interfaces/ParameterValue" [] {
        /// A [`ParameterType`].
        r#type: u8,
        bool_value: bool,
        integer_value: i64,
        double_value: f64,
        string_value: String,
        byte_array_value: Vec<Byte>,
        bool_array_value: Vec<bool>,
        integer_array_value: Vec<i64>,
        double_array_value: Vec<f64>,
        string_array_value: Vec<String>,
    }

    part Parameter = "rcl_interfaces/Parameter" [ParameterValue] {
        /// Name; dots separate its levels.
        name: String,
        value: ParameterValue,
    }

    part ParameterDescriptor = "rcl_interfaces/ParameterDescriptor"
        [FloatingPointRange, IntegerRange] {
        name: String,
        /// A [`ParameterType`].
        r#type: u8,
        description: String,
        /// Description of further constraints.
        additional_constraints: String,
        /// True if it cannot be set while the node runs.
        read_only: bool = false,
        /// True if its type may change.
        dynamic_typing: bool = false,
        /// Allowed range of a floating-point number; at most one.
        floating_point_range: AtMostOne<FloatingPointRange>,
        /// Allowed range of an integer; at most one.
        integer_range: AtMostOne<IntegerRange>,
    }

    #[derive(Copy)]
    part FloatingPointRange = "rcl_interfaces/FloatingPointRange" [] {
        from_value: f64,
        to_value: f64,
        /// Step between allowed values; 0 if all are allowed.
        step: f64,
    }

    #[derive(Copy)]
    part IntegerRange = "rcl_interfaces/IntegerRange" [] {
        from_value: i64,
        to_value: i64,
        /// Step between allowed values; 0 if all are allowed.
        step: u64,
    }

    part SetParametersResult = "rcl_interfaces/SetParametersResult" [] {
        /// True if the parameter was set.
        successful: bool,
        /// Reason if it was not.
        reason: String,
    }

    part ListParametersResult = "rcl_interfaces/ListParametersResult" [] {
        names: Vec<String>,
        /// Prefixes of the names, up to their last dots.
        prefixes: Vec<String>,
    }

    /// `rcl_interfaces/msg/ParameterEvent`: changes of a node's parameters.
    message ParameterEvent = "rcl_interfaces/msg/ParameterEvent" [Time, Parameter] {
        stamp: Time,
        /// Full name of the node.
        node: String,
        new_parameters: Vec<Parameter>,
        changed_parameters: Vec<Parameter>,
        deleted_parameters: Vec<Parameter>,
    }

    /// Request of several services: names of parameters.
    call ParameterNames [] {
        names: Vec<String>,
    }

    /// Request of two services: parameters to set.
    call SetParametersRequest [Parameter] {
        parameters: Vec<Parameter>,
    }

    /// Values of parameters, in the order of the request.
    call GetParametersResponse [ParameterValue] {
        values: Vec<ParameterValue>,
    }

    service GetParameters = "rcl_interfaces/srv/GetParameters":
        ParameterNames -> GetParametersResponse;

    /// Types of parameters, in the order of the request.
    call GetParameterTypesResponse [] {
        /// Values of [`ParameterType`].
        types: Vec<u8>,
    }

    service GetParameterTypes = "rcl_interfaces/srv/GetParameterTypes":
        ParameterNames -> GetParameterTypesResponse;

    /// Result for each parameter, in the order of the request.
    call SetParametersResponse [SetParametersResult] {
        results: Vec<SetParametersResult>,
    }

    service SetParameters = "rcl_interfaces/srv/SetParameters":
        SetParametersRequest -> SetParametersResponse;

    /// Result for all parameters: either all are set or none.
    call SetParametersAtomicallyResponse [SetParametersResult] {
        result: SetParametersResult,
    }

    service SetParametersAtomically = "rcl_interfaces/srv/SetParametersAtomically":
        SetParametersRequest -> SetParametersAtomicallyResponse;

    /// Request for names of parameters.
    call ListParametersRequest [] {
        /// Prefixes of the names, up to a dot; empty for all parameters.
        prefixes: Vec<String>,
        /// Number of levels below the prefixes; 0 for all levels.
        depth: u64,
    }

    call ListParametersResponse [ListParametersResult] {
        result: ListParametersResult,
    }

    service ListParameters = "rcl_interfaces/srv/ListParameters":
        ListParametersRequest -> ListParametersResponse;

    /// Descriptions of parameters, in the order of the request.
    call DescribeParametersResponse [ParameterDescriptor] {
        descriptors: Vec<ParameterDescriptor>,
    }

    service DescribeParameters = "rcl_interfaces/srv/DescribeParameters":
        ParameterNames -> DescribeParametersResponse;
}
