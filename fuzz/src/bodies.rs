//! Compares the JSON reader of every generated message with `serde_json`.
//!
//! Input: two bytes that choose the message, then the text of a body.

use crate::input::Input;
use fc_generated::for_each_message;
use fc_runtime::{Allowance, BodyError, BodyErrorKind, Message, read_enveloped, transcode};
use serde::de::{Deserialize, Deserializer, IgnoredAny, MapAccess, Visitor};
use serde_json::Value;
use serde_json::value::RawValue;
use std::collections::HashMap;
use std::fmt;

type Transcode = fn(&[u8]) -> Result<Vec<u8>, BodyError>;
type Enveloped = fn(&[u8], Allowance) -> Result<bool, BodyError>;

/// One message of the spec, with the functions that read and write its bodies.
pub struct Row {
    /// Name of the type in Rust.
    pub name: &'static str,
    /// Example body from the spec.
    pub example: &'static str,
    transcode: Transcode,
    enveloped: Enveloped,
}

impl Row {
    /// Reads an envelope and the body in it. Returns `true` if the body is valid.
    ///
    /// # Errors
    /// If the envelope is invalid.
    pub fn enveloped(&self, text: &[u8], allowance: Allowance) -> Result<bool, BodyError> {
        (self.enveloped)(text, allowance)
    }
}

/// Reads an envelope and the body in it. Returns `true` if the body is valid.
fn enveloped<M: Message>(text: &[u8], allowance: Allowance) -> Result<bool, BodyError> {
    read_enveloped::<fc_generated::RequestEnvelope, M>(text, allowance)
        .map(|read| read.body.is_ok())
}

macro_rules! rows {
    ($($message:ident;)*) => {
        /// Every message of the spec.
        pub const MESSAGES: &[Row] = &[$(Row {
            name: stringify!($message),
            example: <fc_generated::$message as Message>::EXAMPLE,
            transcode: transcode::<fc_generated::$message>,
            enveloped: enveloped::<fc_generated::$message>,
        },)*];
    };
}

for_each_message!(rows);

/// Checks that the reader and `serde_json` agree on which texts are JSON.
///
/// A body that the reader accepts is written as JSON. Reading and writing that JSON once more must not change it.
pub fn bodies(data: &[u8]) {
    let mut input = Input::new(data);
    let row = &MESSAGES[usize::from(input.u16()) % MESSAGES.len()];
    let text = input.rest();
    let sent: &[u8] = if text.is_empty() { b"{}" } else { text };
    // `RawValue` checks only the grammar. Numbers outside the range of f64 and lone surrogates are valid JSON. The
    // reader keeps them as text if no field uses them.
    let grammar = serde_json::from_slice::<&RawValue>(sent);
    let _ = row.enveloped(text, Allowance::DEFAULT);
    match (row.transcode)(text) {
        Ok(first) => {
            assert!(grammar.is_ok(), "{}: read, {grammar:?}", row.name);
            let again = (row.transcode)(&first);
            assert_eq!(again.as_ref(), Ok(&first), "{}: not canonical", row.name);
            none_collapsed(row.name, sent, &first);
        }
        Err(error) => {
            assert!(error.offset() <= text.len());
            match error.kind() {
                BodyErrorKind::BadJson | BodyErrorKind::NotUtf8 => {
                    assert!(grammar.is_err(), "{}: {error} of a JSON text", row.name);
                }
                // The reader stops at the limit, so the rest of the text may be invalid.
                BodyErrorKind::TooDeep => {}
                // `Value` reads every string, so it must find the lone surrogate too.
                BodyErrorKind::LoneSurrogate => {
                    let value = serde_json::from_slice::<Value>(sent);
                    assert!(grammar.is_ok() && value.is_err(), "{}: {error}", row.name);
                }
                _ => assert!(grammar.is_ok(), "{}: {error}, {grammar:?}", row.name),
            }
        }
    }
}

/// Checks that no repeated key loses some of its values.
///
/// A repeated key is written as often as it was read, or not at all where unknown keys are skipped.
fn none_collapsed(name: &str, sent: &[u8], written: &[u8]) {
    let (sent, written) = (Members::of(sent), Members::of(written));
    for (key, count) in &sent.0 {
        let kept = written.0.get(key).copied().unwrap_or(0);
        assert!(
            *count == 1 || kept == *count || kept == 0,
            "{name}: `{key}` came {count} times, went out {kept} times"
        );
    }
}

/// The keys of an object, each with its number of occurrences.
struct Members(HashMap<String, usize>);

impl Members {
    fn of(text: &[u8]) -> Self {
        serde_json::from_slice(text).expect("an object that has been read")
    }
}

impl<'de> Deserialize<'de> for Members {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_map(Self(HashMap::new()))
    }
}

impl<'de> Visitor<'de> for Members {
    type Value = Self;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("an object")
    }

    fn visit_map<A: MapAccess<'de>>(mut self, mut map: A) -> Result<Self, A::Error> {
        while let Some(key) = map.next_key()? {
            let _: IgnoredAny = map.next_value()?;
            *self.0.entry(key).or_default() += 1;
        }
        Ok(self)
    }
}
