//! Deviations as JSON, one line each.

use super::Deviation;
use fc_spec::model::Direction;
use serde::Serialize;

/// A deviation in the output. Optional keys are absent if they do not apply.
#[derive(Serialize)]
struct Line<'d> {
    deviation: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    name: Option<&'d str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    code: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    direction: Option<&'static str>,
    #[serde(skip_serializing_if = "str::is_empty")]
    path: &'d str,
    #[serde(skip_serializing_if = "str::is_empty")]
    value: &'d str,
    count: u64,
    /// Seconds since 1970, or since midnight for input without dates.
    #[serde(skip_serializing_if = "Option::is_none")]
    time: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    connection: Option<String>,
    offset: u64,
    #[serde(skip_serializing_if = "str::is_empty")]
    example: &'d str,
    #[serde(skip_serializing_if = "str::is_empty")]
    expected: &'d str,
    #[serde(skip_serializing_if = "Option::is_none")]
    spec: Option<Spec<'d>>,
}

/// The place of the operation in the spec.
#[derive(Serialize)]
struct Spec<'d> {
    file: &'d str,
    line: usize,
}

/// Returns a deviation as one line of JSON, without the end of the line.
#[must_use]
pub fn line(deviation: &Deviation<'_>) -> String {
    let place = &deviation.place;
    let line = Line {
        deviation: place.kind.name(),
        name: deviation.operation.map(|it| it.name.as_str()),
        code: place.code.map(|(_, code)| format!("0x{code:04X}")),
        direction: place.direction.map(Direction::name),
        path: &place.path,
        value: &place.value,
        count: deviation.count,
        time: deviation.time.map(|time| time.as_secs_f64()),
        connection: deviation.flow.map(|flow| flow.to_string()),
        offset: deviation.offset,
        example: &deviation.example,
        expected: &deviation.expected,
        spec: deviation.operation.map(|operation| Spec {
            file: &operation.location.file,
            line: operation.location.line,
        }),
    };
    // Strings and numbers cannot fail to serialize.
    serde_json::to_string(&line).unwrap_or_default()
}
