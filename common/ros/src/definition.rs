//! Types of ROS, each declared once: the struct, and the text of its definition from the same
//! fields.
//!
//! ```text
//! message Name = "package/msg/Name" with "CONSTANTS" [Used] { field: type = default, … }
//! part Name = "package/Name" with "CONSTANTS" [Used] { … }
//! call Name [Used] { … }
//! service Name = "package/srv/Name": Request -> Response;
//! ```
//!
//! `message` is a [`RosMessage`](crate::RosMessage), `part` a type that others use, and `call` the
//! request or response of a service. `Used` are the parts whose definitions follow, each with those
//! that it uses itself. A part defines a macro of its name, so parts come first.

/// An opaque byte, `byte`.
pub(crate) type Byte = u8;

/// A text of at most 255 bytes.
pub(crate) type ShortString = String;

/// A sequence of at most one element.
pub(crate) type AtMostOne<T> = Vec<T>;

/// A covariance row by row over x, y and yaw.
pub(crate) type Rows3 = [f64; 9];

/// A covariance row by row over x, y, z and the rotations about them.
pub(crate) type Rows6 = [[f64; 6]; 6];

macro_rules! declare {
    () => {};
    (
        $(#[$about:meta])*
        message $name:ident = $schema:literal $(with $constants:literal)?
        [$($used:ident),*] $fields:tt
        $($rest:tt)*
    ) => {
        structure!($(#[$about])* $name $fields);
        impl $crate::RosMessage for $name {
            const SCHEMA: &'static str = $schema;
            const DEFINITION: &'static str = concat!($($constants,)? lines!($fields [$($used),*]));
        }
        declare!($($rest)*);
    };
    (
        $(#[$about:meta])*
        part $name:ident = $ros:literal $(with $constants:literal)? [$($used:ident),*] $fields:tt
        $($rest:tt)*
    ) => {
        structure!($(#[$about])* $name $fields);
        part!($name = $ros, $($constants,)? lines!($fields [$($used),*]));
        declare!($($rest)*);
    };
    ($(#[$about:meta])* call $name:ident [$($used:ident),*] $fields:tt $($rest:tt)*) => {
        structure!($(#[$about])* $name $fields);
        impl $name {
            pub(crate) const DEFINITION: &'static str = lines!($fields [$($used),*]);
        }
        declare!($($rest)*);
    };
    (service $name:ident = $ros:literal: $request:ident -> $response:ident; $($rest:tt)*) => {
        #[derive(Debug)]
        pub enum $name {}
        impl $crate::RosService for $name {
            const NAME: &'static str = $ros;
            const REQUEST: &'static str = $request::DEFINITION;
            const RESPONSE: &'static str = $response::DEFINITION;
            type Request = $request;
            type Response = $response;
        }
        declare!($($rest)*);
    };
}

/// Defines the macro of a part: its name as a type, and its definition with the separator above.
macro_rules! part {
    ($name:ident = $ros:literal, $($text:tt)*) => {
        macro_rules! $name {
            (name) => {
                $ros
            };
            (part) => {
                concat!(
                    "\
================================================================================
MSG: ",
                    $ros, "\n", $($text)*
                )
            };
        }
    };
}

macro_rules! structure {
    ($(#[$about:meta])* $name:ident { $(
        $(#[$of:meta])* $field:ident: $kind:ident $(<$item:ident>)? $(= $default:literal)?,
    )* }) => {
        $(#[$about])*
        #[derive(Debug, Clone, PartialEq, Default, serde::Serialize, serde::Deserialize)]
        pub struct $name { $( $(#[$of])* pub $field: $kind $(<$item>)?, )* }
    };
}

/// Fields of a definition, and the parts that it uses.
macro_rules! lines {
    ({ $(
        $(#[$of:meta])* $field:ident: $kind:ident $(<$item:ident>)? $(= $default:literal)?,
    )* } [$($used:ident),*]) => {
        concat!(
            $(kind!($kind $($item)?), " ", name!($field) $(, " ", $default)?, "\n",)*
            $($used!(part),)*
        )
    };
}

macro_rules! name {
    (r#type) => {
        "type"
    };
    ($field:ident) => {
        stringify!($field)
    };
}

#[rustfmt::skip]
macro_rules! kind {
    (bool) => { "bool" };
    (Byte) => { "byte" };
    (i8) => { "int8" };
    (u8) => { "uint8" };
    (u16) => { "uint16" };
    (i32) => { "int32" };
    (u32) => { "uint32" };
    (i64) => { "int64" };
    (u64) => { "uint64" };
    (f32) => { "float32" };
    (f64) => { "float64" };
    (Rows3) => { "float64[9]" };
    (Rows6) => { "float64[36]" };
    (String) => { "string" };
    (ShortString) => { "string<=255" };
    (Vec $item:ident) => { concat!(kind!($item), "[]") };
    (AtMostOne $item:ident) => { concat!(kind!($item), "[<=1]") };
    ($part:ident) => { $part!(name) };
}
