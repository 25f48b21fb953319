//! Records as JSON, one line each.

use super::Record;
use serde::Serialize;
use serde_json::value::RawValue;
use std::time::Duration;

/// A record in the output. Optional keys are absent if they do not apply.
#[derive(Serialize)]
struct Line<'r> {
    offset: u64,
    length: u64,
    #[serde(skip_serializing_if = "Option::is_none")]
    connection: Option<String>,
    /// Seconds since 1970, or since midnight for input without dates.
    #[serde(skip_serializing_if = "Option::is_none")]
    time: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    direction: Option<&'static str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    kind: Option<&'r str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    code: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    name: Option<&'r str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    msg_id: Option<u32>,
    #[serde(skip_serializing_if = "Option::is_none")]
    request: Option<Request>,
    #[serde(skip_serializing_if = "Option::is_none")]
    body: Option<Box<RawValue>>,
    errors: Vec<Error<'r>>,
}

/// The request of a response.
#[derive(Serialize)]
struct Request {
    offset: u64,
    #[serde(skip_serializing_if = "Option::is_none")]
    elapsed_ms: Option<f64>,
}

#[derive(Serialize)]
struct Error<'r> {
    name: &'static str,
    #[serde(skip_serializing_if = "str::is_empty")]
    path: &'r str,
    /// The position in the input for an error of the frame, and in the decompressed body for an error of the body.
    offset: u64,
    detail: &'r str,
}

/// Returns a record as one line of JSON, without the end of the line.
#[must_use]
pub fn line(record: &Record<'_>) -> String {
    let id = record.id;
    let line = Line {
        offset: record.offset,
        length: record.length,
        connection: record.flow.map(|flow| flow.to_string()),
        time: record.time.map(|time| time.as_secs_f64()),
        direction: id.map(|id| id.direction.name()),
        kind: record.kind.map(|kind| kind.name.as_str()),
        code: id.map(|id| format!("0x{:04X}", id.code)),
        name: record.operation.map(|operation| operation.name.as_str()),
        msg_id: id.map(|id| id.id),
        request: record.request.map(|request| Request {
            offset: request.offset,
            elapsed_ms: request.elapsed.map(milliseconds),
        }),
        body: body(record),
        errors: record.error.iter().map(|it| error(record, it)).collect(),
    };
    // Strings and numbers cannot fail to serialize.
    serde_json::to_string(&line).unwrap_or_default()
}

fn error<'r>(record: &Record<'_>, error: &'r fc_reflect::Error) -> Error<'r> {
    Error {
        name: error.name(),
        path: error.path(),
        offset: match error {
            fc_reflect::Error::Frame(_) => record.offset,
            fc_reflect::Error::Body { error, .. } => error.offset() as u64,
        },
        detail: error.detail(),
    }
}

/// Returns the canonical body, or the body as sent if it is invalid JSON for the spec.
fn body(record: &Record<'_>) -> Option<Box<RawValue>> {
    let frame = record.frame.as_ref()?;
    if let Some(Ok(text)) = record.message.as_ref().map(fc_reflect::Message::canonical) {
        return RawValue::from_string(text).ok();
    }
    // One line, whatever the sender has put between the values.
    let sent: serde_json::Value = serde_json::from_slice(&frame.data).ok()?;
    serde_json::value::to_raw_value(&sent).ok()
}

/// Returns a duration in milliseconds.
pub(crate) fn milliseconds(duration: Duration) -> f64 {
    duration.as_secs_f64() * 1000.0
}
