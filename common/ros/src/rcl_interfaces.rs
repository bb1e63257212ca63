//! `rcl_interfaces`: parameters of a node, and the services that read and set them.

use super::Time;
use super::definition::Byte;

declare! {
    /// `rcl_interfaces/msg/ParameterValue`: `type` selects the field that holds the value.
    part ParameterValue = "rcl_interfaces/ParameterValue" [] {
        /// Number of the field behind this one that holds the value, from 1; 0 if there is none.
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

    call ParameterDescriptor {
        name: String,
        /// Type, as in [`ParameterValue`].
        r#type: u8,
        description: String,
        /// Description of further constraints.
        additional_constraints: String,
        /// True if it cannot be set while the node runs.
        read_only: bool,
        /// True if its type may change.
        dynamic_typing: bool,
        /// Allowed range of a floating-point number; at most one.
        floating_point_range: Vec<FloatingPointRange>,
        /// Allowed range of an integer; at most one.
        integer_range: Vec<IntegerRange>,
    }

    #[derive(Copy)]
    call FloatingPointRange {
        from_value: f64,
        to_value: f64,
        /// Step between allowed values; 0 if all are allowed.
        step: f64,
    }

    #[derive(Copy)]
    call IntegerRange {
        from_value: i64,
        to_value: i64,
        /// Step between allowed values; 0 if all are allowed.
        step: u64,
    }

    call SetParametersResult {
        /// True if the parameter was set.
        successful: bool,
        /// Reason if it was not.
        reason: String,
    }

    call ListParametersResult {
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
    call ParameterNames {
        names: Vec<String>,
    }

    /// Request of two services: parameters to set.
    call SetParametersRequest {
        parameters: Vec<Parameter>,
    }

    /// Values of parameters, in the order of the request.
    call GetParametersResponse {
        values: Vec<ParameterValue>,
    }

    service GetParameters = "rcl_interfaces/srv/GetParameters":
        ParameterNames -> GetParametersResponse;

    /// Types of parameters, in the order of the request.
    call GetParameterTypesResponse {
        /// Types, as in [`ParameterValue`].
        types: Vec<u8>,
    }

    service GetParameterTypes = "rcl_interfaces/srv/GetParameterTypes":
        ParameterNames -> GetParameterTypesResponse;

    /// Result for each parameter, in the order of the request.
    call SetParametersResponse {
        results: Vec<SetParametersResult>,
    }

    service SetParameters = "rcl_interfaces/srv/SetParameters":
        SetParametersRequest -> SetParametersResponse;

    /// Result for all parameters: either all are set or none.
    call SetParametersAtomicallyResponse {
        result: SetParametersResult,
    }

    service SetParametersAtomically = "rcl_interfaces/srv/SetParametersAtomically":
        SetParametersRequest -> SetParametersAtomicallyResponse;

    /// Request for names of parameters.
    call ListParametersRequest {
        /// Prefixes of the names, up to a dot; empty for all parameters.
        prefixes: Vec<String>,
        /// Number of levels below the prefixes; 0 for all levels.
        depth: u64,
    }

    call ListParametersResponse {
        result: ListParametersResult,
    }

    service ListParameters = "rcl_interfaces/srv/ListParameters":
        ListParametersRequest -> ListParametersResponse;

    /// Descriptions of parameters, in the order of the request.
    call DescribeParametersResponse {
        descriptors: Vec<ParameterDescriptor>,
    }

    service DescribeParameters = "rcl_interfaces/srv/DescribeParameters":
        ParameterNames -> DescribeParametersResponse;
}
