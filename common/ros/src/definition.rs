//! Text of message definitions, concatenated at compile time.
//!
//! Types that several messages share are defined here once.

/// Fields of a message, then each type that it uses: a shared type by its name, which includes the
/// types that it uses itself, or any other by its name and fields.
macro_rules! definition {
    ($fields:literal $(, $part:tt)+ $(,)?) => {
        concat!($fields $(, $crate::definition::part!($part))+)
    };
}

/// Definition of a type, with the separator line above it.
macro_rules! part {
    (Header) => {
        definition!(
            "",
            "\
std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
",
            Time
        )
    };
    (Time) => {
        $crate::definition::part!(
            "\
builtin_interfaces/Time
int32 sec
uint32 nanosec
"
        )
    };
    (PoseWithCovariance) => {
        definition!(
            "",
            "\
geometry_msgs/PoseWithCovariance
geometry_msgs/Pose pose
float64[36] covariance
",
            Pose
        )
    };
    (Pose) => {
        definition!(
            "",
            "\
geometry_msgs/Pose
geometry_msgs/Point position
geometry_msgs/Quaternion orientation
",
            "\
geometry_msgs/Point
float64 x
float64 y
float64 z
",
            Quaternion
        )
    };
    (Quaternion) => {
        $crate::definition::part!(
            "\
geometry_msgs/Quaternion
float64 x 0
float64 y 0
float64 z 0
float64 w 1
"
        )
    };
    (Vector3) => {
        $crate::definition::part!(
            "\
geometry_msgs/Vector3
float64 x
float64 y
float64 z
"
        )
    };
    (Pose2D) => {
        $crate::definition::part!(
            "\
geometry_msgs/Pose2D
float64 x
float64 y
float64 theta
"
        )
    };
    (State) => {
        $crate::definition::part!(
            "\
lifecycle_msgs/State
uint8 id
string label
"
        )
    };
    (Transition) => {
        $crate::definition::part!(
            "\
lifecycle_msgs/Transition
uint8 id
string label
"
        )
    };
    (ParameterValue) => {
        $crate::definition::part!(
            "\
rcl_interfaces/ParameterValue
uint8 type
bool bool_value
int64 integer_value
float64 double_value
string string_value
byte[] byte_array_value
bool[] bool_array_value
int64[] integer_array_value
float64[] double_array_value
string[] string_array_value
"
        )
    };
    (Parameter) => {
        definition!(
            "",
            "\
rcl_interfaces/Parameter
string name
rcl_interfaces/ParameterValue value
",
            ParameterValue
        )
    };
    (SetParametersResult) => {
        $crate::definition::part!(
            "\
rcl_interfaces/SetParametersResult
bool successful
string reason
"
        )
    };
    ($name_and_fields:literal) => {
        concat!(
            "\
================================================================================
MSG: ",
            $name_and_fields
        )
    };
}

pub(super) use {definition, part};
