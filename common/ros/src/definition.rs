//! Types of ROS, each declared once: the struct, and the text of its definition from the same
//! fields.
//!
//! ```text
//! message Name = "package/msg/Name" with "CONSTANTS" [Used] { field: type, … }
//! part Name = "package/Name" with "CONSTANTS" [Used] { … }
//! call Name { … }
//! service Name = "package/srv/Name": Request -> Response;
//! ```
//!
//! `message` is a [`RosMessage`](crate::RosMessage), `part` a type that others use, and `call` the
//! request or response of a service, or a part of these, of which no recording has a definition.
//! `Used` are the parts whose definitions follow, each with those
//! that it uses itself. A part defines a macro of its name, so parts come first.

/// An opaque byte, `byte`.
pub(crate) type Byte = u8;

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
    ($(#[$about:meta])* call $name:ident $fields:tt $($rest:tt)*) => {
        structure!($(#[$about])* $name $fields);
        declare!($($rest)*);
    };
    (service $name:ident = $ros:literal: $request:ident -> $response:ident; $($rest:tt)*) => {
        #[derive(Debug)]
        pub enum $name {}
        impl $crate::RosService for $name {
            const NAME: &'static str = $ros;
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
        $(#[$of:meta])* $field:ident: $kind:ident $(<$item:ident>)?,
    )* }) => {
        $(#[$about])*
        #[derive(Debug, Clone, PartialEq, Default, serde::Serialize, serde::Deserialize)]
        pub struct $name { $( $(#[$of])* pub $field: $kind $(<$item>)?, )* }
    };
}

/// Fields of a definition, and the parts that it uses.
macro_rules! lines {
    ({ $(
        $(#[$of:meta])* $field:ident: $kind:ident $(<$item:ident>)?,
    )* } [$($used:ident),*]) => {
        concat!(
            $(kind!($kind $($item)?), " ", name!($field), "\n",)*
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
    (Vec $item:ident) => { concat!(kind!($item), "[]") };
    ($part:ident) => { $part!(name) };
}
