//! Scenarios: the behaviour of a mock, and the requests that it expects from an app.
//!
//! ```yaml
//! on:
//!   - request: get_level
//!     times: 1
//!     refuse: wrong
//!   - request: get_level
//!     answer: { level: 7 }
//! expect: [get_level, get_level]
//! ```

mod play;
mod read;

pub(crate) use play::Play;

use fc_spec::model::{Text, Value};
use std::time::Duration;

/// Time in which the app must have caused all events, without `within_ms`.
const WITHIN: Duration = Duration::from_secs(30);

/// A scenario.
#[derive(Clone, Debug, PartialEq)]
pub struct Scenario {
    /// Rules for requests. The first that fits decides.
    pub rules: Vec<Rule>,
    /// Events that the app must cause, in this order. Others may come between them.
    pub expect: Vec<Expected>,
    /// Names of the commands that the app must not send.
    pub never: Vec<String>,
    /// Time in which the app must have caused all events.
    pub within: Duration,
}

impl Scenario {
    /// Returns the scenario of an app that sends these commands, each with its example.
    #[must_use]
    pub fn of_commands(names: impl IntoIterator<Item = String>) -> Self {
        let expect = names.into_iter();
        Self {
            rules: Vec::new(),
            expect: expect
                .map(|name| Expected::Request(name, Value::Null))
                .collect(),
            never: Vec::new(),
            within: WITHIN,
        }
    }
}

/// A rule for the requests of a command.
#[derive(Clone, Debug, PartialEq)]
pub struct Rule {
    /// Name of the command.
    pub request: String,
    /// Values that the request must have; null for any request.
    pub with: Value,
    /// The number of requests for which the rule counts; `None` for all.
    pub times: Option<u32>,
    /// The response.
    pub action: Action,
}

/// The response to a request, and the reports after it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Action {
    /// Values that replace those of the example.
    pub answer: Option<Value>,
    /// Paths of wire keys that the response lacks, as with an old firmware.
    pub omit: Vec<Vec<String>>,
    /// Result code of a refusal.
    pub refuse: Option<i64>,
    /// Time before the response.
    pub delay: Duration,
    /// `true` if there is no response.
    pub silent: bool,
    /// `true` if the digest of the response is wrong.
    pub bad_digest: bool,
    /// `true` if the connection ends after the response.
    pub disconnect: bool,
    /// Reports after the response, instead of those of the process.
    pub reports: Option<Vec<ScriptedReport>>,
}

/// A report of a scenario.
#[derive(Clone, Debug, PartialEq)]
pub struct ScriptedReport {
    /// Name of the report.
    pub report: String,
    /// Values that replace those of the example.
    pub body: Value,
    /// Time after the report before, or after the response.
    pub after: Duration,
}

/// An event that the app must cause.
#[derive(Clone, Debug, PartialEq)]
pub enum Expected {
    /// A request with these values; null for any values.
    Request(String, Value),
    /// The acknowledgement of a report.
    Acknowledgement(String),
}

/// The state of the expectations of a scenario.
#[derive(Clone, Debug, PartialEq)]
pub enum Verdict {
    /// The app has caused all events.
    Met,
    /// This event is missing.
    Missing(Expected),
    /// The app has sent this command, which it must not send.
    Forbidden(String),
}

impl Verdict {
    /// Returns the message in both languages.
    #[must_use]
    pub fn text(&self) -> Text {
        match self {
            Self::Met => fc_spec::text!("app 符合场景", "the app did what the scenario expects"),
            Self::Missing(Expected::Request(name, Value::Null)) => {
                fc_spec::text!("app 没有发送 `{name}`", "the app did not send `{name}`")
            }
            Self::Missing(Expected::Request(name, with)) => fc_spec::text!(
                "app 没有发送含 {with} 的 `{name}`",
                "the app did not send `{name}` with {with}"
            ),
            Self::Missing(Expected::Acknowledgement(name)) => fc_spec::text!(
                "app 没有应答 `{name}`",
                "the app did not acknowledge `{name}`"
            ),
            Self::Forbidden(name) => fc_spec::text!(
                "app 发送了不应发送的 `{name}`",
                "the app sent `{name}`, which it must not send"
            ),
        }
    }
}

/// Returns `true` if the value has all these values. Null fits any value.
pub(crate) fn fits(with: &Value, value: &Value) -> bool {
    match (with, value) {
        (Value::Null, _) => true,
        (Value::Object(keys), _) => keys
            .iter()
            .all(|(key, with)| value.get(key).is_some_and(|value| fits(with, value))),
        (Value::Array(with), Value::Array(items)) => {
            with.len() == items.len() && with.iter().zip(items).all(|(with, item)| fits(with, item))
        }
        (Value::Number(with), Value::Number(number)) => with.compare(number).is_eq(),
        _ => with == value,
    }
}

/// Returns the path of the first value that differs from the wanted one, with both. Null fits any value.
///
/// The recursion is as deep as the wanted value.
pub(crate) fn difference<'v>(
    with: &'v Value,
    value: Option<&'v Value>,
    path: &str,
) -> Option<(String, &'v Value, Option<&'v Value>)> {
    match (with, value) {
        (Value::Object(keys), Some(value)) => keys.iter().find_map(|(key, with)| {
            let path = if path.is_empty() {
                key.clone()
            } else {
                format!("{path}.{key}")
            };
            difference(with, value.get(key), &path)
        }),
        (Value::Null, _) => None,
        (_, Some(value)) if fits(with, value) => None,
        _ => Some((path.to_owned(), with, value)),
    }
}

/// Removes a key from a message. Returns `false` if the message lacks it.
pub(crate) fn omit(message: &mut Value, path: &[String]) -> bool {
    let Some((last, path)) = path.split_last() else {
        return false;
    };
    let object = path
        .iter()
        .try_fold(message, |value, key| value.get_mut(key));
    let Some(Value::Object(entries)) = object else {
        return false;
    };
    let before = entries.len();
    entries.retain(|(key, _)| key != last);
    entries.len() < before
}

/// Puts values into a message. Objects are merged, and other values replaced.
pub(crate) fn merge(message: &mut Value, values: &Value) {
    let Value::Object(entries) = values else {
        message.clone_from(values);
        return;
    };
    if !matches!(message, Value::Object(_)) {
        *message = Value::Object(Vec::new());
    }
    for (key, value) in entries {
        match message.get_mut(key) {
            Some(there) => merge(there, value),
            None => message.set(key, value.clone()),
        }
    }
}
