//! The expansions do not depend on names in scope, and cause no lints.

#![deny(warnings, missing_docs, rust_2018_idioms)]
#![allow(dead_code)]

/// Names of the prelude that mean something else here.
mod shadows {
    pub struct Option;
    pub struct Result;
    pub struct Vec;
    pub struct Box;
    pub trait From {}
    pub trait TryFrom {}
    pub trait Default {}
    pub trait Clone {}
    pub trait Send {}
    pub trait Sync {}
    pub struct Arc;
    #[allow(non_camel_case_types)]
    pub struct u8x;
    pub mod core {}
    pub mod std {}
    pub mod fc_runtime {}
}

/// Messages among them.
pub mod messages {
    #[allow(unused_imports)]
    use super::shadows::*;
    use ::fc_derive::{Command, Envelope, Header, Message, OneOf, OpenEnum, RedactedDebug, Report};
    use ::fc_runtime::Extra;

    type Maybe<T> = ::core::option::Option<T>;

    /// With fields that are called what the expansion calls its own things.
    #[derive(Message, Command, RedactedDebug)]
    #[fc(code = 1, name = "a", effect = "read", response = Everything)]
    pub struct Everything {
        /// .
        #[fc(min = 0, max = 4294967295, sensitive)]
        pub reader: i64,
        /// .
        #[fc(length = 1..=5, pattern = "a+")]
        pub partial: ::std::string::String,
        /// .
        pub key: Maybe<Choice>,
        /// .
        #[fc(wire = "string")]
        pub object: f64,
        /// .
        #[fc(empty_is_absent, lenient(bool), also("b"))]
        pub writer: Maybe<bool>,
        /// .
        #[fc(wire = "number")]
        pub value: Maybe<bool>,
        /// .
        #[fc(when(reader = 1 | 2, partial = "a"))]
        pub condition: ::core::option::Option<bool>,
        /// .
        #[fc(extra)]
        pub extra: Extra,
    }

    /// .
    #[derive(Message, Report)]
    #[fc(code = 2, name = "b", ack(timeout_ms = 1000000, retries = 1))]
    pub struct Nothing {}

    /// .
    #[derive(::core::fmt::Debug, OneOf)]
    pub enum Choice {
        /// .
        One(One),
    }

    /// .
    #[derive(::core::fmt::Debug, Message)]
    pub struct One {
        /// .
        pub one: Status,
        /// .
        pub two: Mode,
    }

    /// .
    #[derive(::core::fmt::Debug, OpenEnum)]
    #[fc(repr = u32)]
    pub enum Status {
        /// .
        #[fc(value = 4294967295)]
        Idle,
        /// .
        #[fc(other)]
        Unknown(u32),
    }

    /// .
    #[derive(::core::fmt::Debug, OpenEnum)]
    #[fc(repr = str)]
    pub enum Mode {
        /// .
        #[fc(value = "a")]
        A,
        /// .
        #[fc(other)]
        Unknown(::std::string::String),
    }

    /// A closed one, with a variant called like an associated type.
    #[derive(::core::fmt::Debug, OpenEnum)]
    #[fc(repr = u8)]
    pub enum Outcome {
        /// .
        #[fc(value = 0)]
        Error,
    }

    /// .
    #[derive(Message, Envelope)]
    #[fc(envelope = "response")]
    pub struct Common {
        /// .
        #[fc(role = "result_code")]
        pub time_ms: i16,
        /// .
        #[fc(role = "result_text")]
        pub code: ::std::string::String,
        /// .
        #[fc(role = "time")]
        pub text: Maybe<i64>,
    }

    /// .
    #[derive(::core::clone::Clone, ::core::marker::Copy, Header)]
    #[fc(byte_order = "little")]
    pub struct FrameHeader {
        /// .
        #[fc(role = "head")]
        pub bytes: [u8; 2],
        /// .
        #[fc(role = "kind")]
        pub out: u8,
        /// .
        #[fc(role = "code")]
        pub head: u16,
        /// .
        #[fc(role = "id")]
        pub kind: u32,
        /// .
        #[fc(role = "encoding")]
        pub code: u8,
        /// .
        #[fc(role = "status", value = 65535)]
        pub id: u16,
        /// .
        #[fc(role = "total_length")]
        pub plain_length: u32,
        /// .
        #[fc(role = "plain_length")]
        pub total_length: u32,
        /// .
        #[fc(role = "digest")]
        pub digest: [u8; 16],
    }
}

fn main() {}
