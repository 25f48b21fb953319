//! The JSON readers of every generated message beside `serde_json`.
//!
//! Input: two bytes that choose the message, then the text of a body.

use crate::input::Input;
use fc_generated::for_each_message;
use fc_runtime::{Allowance, BodyError, BodyErrorKind, Message, read_enveloped, transcode};
use serde_json::Value;

type Transcode = fn(&[u8]) -> Result<Vec<u8>, BodyError>;
type Enveloped = fn(&[u8], Allowance) -> Result<bool, BodyError>;

/// One message: its name, and how its bodies are read and written.
pub struct Row {
    /// Name in Rust.
    pub name: &'static str,
    /// The spec's example.
    pub example: &'static str,
    transcode: Transcode,
    enveloped: Enveloped,
}

impl Row {
    /// Whether the body beside an envelope can be read within an allowance.
    ///
    /// # Errors
    /// What keeps the envelope from being read.
    pub fn enveloped(&self, text: &[u8], allowance: Allowance) -> Result<bool, BodyError> {
        (self.enveloped)(text, allowance)
    }
}

/// Whether the body beside an envelope could be read.
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

/// A text is refused as no JSON exactly where `serde_json` refuses it; what is read is written as
/// JSON, and that is read and written the same again.
pub fn bodies(data: &[u8]) {
    let mut input = Input::new(data);
    let row = &MESSAGES[usize::from(input.u16()) % MESSAGES.len()];
    let text = input.rest();
    let oracle = serde_json::from_slice::<Value>(if text.is_empty() { b"{}" } else { text });
    let _ = row.enveloped(text, Allowance::DEFAULT);
    match (row.transcode)(text) {
        Ok(first) => {
            // serde_json refuses numbers beyond f64; here they are kept as their text.
            assert!(
                oracle.as_ref().map_or_else(beyond, |_| true),
                "{}: read, {oracle:?}",
                row.name
            );
            let again = (row.transcode)(&first);
            assert_eq!(again.as_ref(), Ok(&first), "{}: not canonical", row.name);
            if oracle.is_ok() {
                let written = serde_json::from_slice::<Value>(&first);
                assert!(
                    matches!(written, Ok(Value::Object(_))),
                    "{}: {written:?}",
                    row.name
                );
            }
        }
        Err(error)
            if matches!(
                error.kind(),
                BodyErrorKind::BadJson | BodyErrorKind::NotUtf8
            ) =>
        {
            assert!(oracle.is_err(), "{}: {error} of a JSON text", row.name);
        }
        Err(error) => {
            let deep = error.kind() == BodyErrorKind::TooDeep;
            assert!(
                deep || oracle.as_ref().map_or_else(beyond, |_| true),
                "{}: {error}, {oracle:?}",
                row.name
            );
            assert!(error.offset() <= text.len());
        }
    }
}

fn beyond(error: &serde_json::Error) -> bool {
    error.to_string().starts_with("number out of range")
}
