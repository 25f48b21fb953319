//! The output of calls and apps, for people or for programs.

use crate::answer::{Outcome, Response};
use crate::arguments::json;
use crate::table::{aligned, table};
use fc_reflect::{Direction, Frame, Reflector};
use fc_spec::model::{Effect, Kind, Lang, Model, Number, Operation, Value};
use fc_spec::text;
use std::time::Duration;

/// The format of the output. All texts end with a new line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Transcript {
    /// Aligned tables in a language.
    Text(Lang),
    /// One line of JSON per message.
    Json,
}

impl Transcript {
    /// Shows a response with its values.
    #[must_use]
    pub fn response(self, response: &Response<'_, '_>) -> String {
        let Self::Text(lang) = self else {
            return response_line(response);
        };
        let nodes = response.message.body.as_deref().unwrap_or_default();
        self.result(response) + &table(nodes, lang)
    }

    /// Shows the result of a response.
    #[must_use]
    pub fn result(self, response: &Response<'_, '_>) -> String {
        let Self::Text(lang) = self else {
            return response_line(response);
        };
        format!("{}\n", summary(&name(response), &response.outcome, lang))
    }

    /// Shows the times of several calls. In JSON, each response has its own.
    #[must_use]
    pub fn times(self, mut times: Vec<Duration>) -> String {
        times.sort();
        let (Self::Text(lang), [first, .., last]) = (self, times.as_slice()) else {
            return String::new();
        };
        let count = times.len();
        let median = times.get((count - 1) / 2).unwrap_or(last);
        let [first, median, last] = [first, median, last].map(|it| tenths(*it));
        let text = text!(
            "{count} 次响应：最短 {first} ms，中位 {median} ms，最长 {last} ms\n",
            "{count} responses: shortest {first} ms, median {median} ms, longest {last} ms\n"
        );
        lang.text(&text).to_owned()
    }

    /// Shows a report or a frame of a stream with its values.
    #[must_use]
    pub fn pushed(
        self,
        reflector: &Reflector<'_>,
        operation: &Operation,
        frame: &Frame<'_>,
    ) -> String {
        let Self::Text(lang) = self else {
            return pushed_line(operation, frame);
        };
        let title = title(operation, lang);
        if is_bytes(operation) {
            return counted(&title, frame, lang);
        }
        let message = reflector.message(Some(operation), frame.id.direction, &frame.data);
        let nodes = message.ok().and_then(|message| message.body.ok());
        let rows = table(&nodes.unwrap_or_default(), lang);
        format!("{title}\n{rows}")
    }

    /// Shows the arrival of a report or of a frame of a stream.
    #[must_use]
    pub fn arrival(self, frame: &Frame<'_>) -> String {
        let code = || format!("0x{:04X}", frame.id.code);
        match (self, frame.operation) {
            (Self::Json, Some(operation)) => pushed_line(operation, frame),
            (Self::Json, None) => line([
                ("name", Value::String(code())),
                ("bytes", int(frame.data.len())),
            ]),
            (Self::Text(lang), Some(operation)) => {
                let title = title(operation, lang);
                match operation.kind() {
                    Kind::Report => title + "\n",
                    _ => counted(&title, frame, lang),
                }
            }
            (Self::Text(lang), None) => counted(&code(), frame, lang),
        }
    }

    /// Lists the commands and streams of a spec.
    #[must_use]
    pub fn operations(self, model: &Model) -> String {
        let operations = model.operations.iter();
        let operations = operations.filter(|operation| operation.kind() != Kind::Report);
        let effect = |operation: &Operation| operation.effect().map(Effect::name);
        match self {
            Self::Json => {
                let lines = operations.map(|it| {
                    let effect = effect(it).unwrap_or_default();
                    line([
                        ("name", Value::String(it.name.clone())),
                        ("kind", Value::String(it.kind().name().to_owned())),
                        ("code", Value::String(it.code.spelling.clone())),
                        ("effect", Value::String(effect.to_owned())),
                        ("zh", Value::String(it.title.zh.clone())),
                        ("en", Value::String(it.title.en.clone())),
                    ])
                });
                lines.collect()
            }
            Self::Text(lang) => {
                let rows = operations.map(|it| {
                    let effect = effect(it).unwrap_or_else(|| it.kind().name());
                    [
                        it.name.clone(),
                        it.code.spelling.clone(),
                        effect.to_owned(),
                        lang.text(&it.title).to_owned(),
                    ]
                });
                aligned(&rows.collect::<Vec<_>>())
            }
        }
    }
}

fn name(response: &Response<'_, '_>) -> String {
    let code = response.frame.id.code;
    let command = response.command;
    command.map_or_else(|| format!("0x{code:04X}"), |it| it.name.clone())
}

fn response_line(response: &Response<'_, '_>) -> String {
    let Outcome { code, known, text } = &response.outcome;
    let result = known.map_or("", |known| &known.name);
    let took = Number::Float(tenths(response.took));
    line([
        ("name", Value::String(name(response))),
        ("kind", Value::String("response".to_owned())),
        ("result", code.map_or(Value::Null, int)),
        ("result_name", Value::String(result.to_owned())),
        ("result_text", Value::String(text.clone())),
        ("milliseconds", Value::Number(took)),
        ("body", body(response.frame)),
    ])
}

fn is_bytes(operation: &Operation) -> bool {
    operation.body(Direction::Request).is_none()
}

fn pushed_line(operation: &Operation, frame: &Frame<'_>) -> String {
    line([
        ("name", Value::String(operation.name.clone())),
        ("kind", Value::String(operation.kind().name().to_owned())),
        if is_bytes(operation) {
            ("bytes", int(frame.data.len()))
        } else {
            ("body", body(frame))
        },
    ])
}

/// Returns the name and the result of a response.
fn summary(name: &str, outcome: &Outcome<'_>, lang: Lang) -> String {
    let result = outcome.known.map_or("", |known| &known.name);
    let code = outcome.code.map(|code| format!("  {code} {result}"));
    // The robot sends the Chinese text of the result, sometimes with a reason behind it.
    let known = outcome.known.and_then(|known| {
        let reason = outcome.text.strip_prefix(&known.text.zh)?;
        Some(format!("{}{reason}", lang.text(&known.text)))
    });
    let text = known.unwrap_or_else(|| outcome.text.clone());
    let gap = if text.is_empty() { "" } else { "  " };
    format!("{name}{}{gap}{text}", code.unwrap_or_default())
}

fn title(operation: &Operation, lang: Lang) -> String {
    format!("{}  {}", operation.name, lang.text(&operation.title))
}

/// Returns a name with the number of bytes behind it.
fn counted(name: &str, frame: &Frame<'_>, lang: Lang) -> String {
    let unit = lang.pick("字节", "bytes");
    format!("{name}  {} {unit}\n", frame.data.len())
}

fn int(value: impl TryInto<i128>) -> Value {
    Value::Number(Number::Int(value.try_into().unwrap_or_default()))
}

/// Returns milliseconds with one digit behind the point.
fn tenths(time: Duration) -> f64 {
    (time.as_secs_f64() * 10_000.0).round() / 10.0
}

fn line<const KEYS: usize>(keys: [(&str, Value); KEYS]) -> String {
    let keys = keys.map(|(key, value)| (key.to_owned(), value));
    format!("{}\n", Value::Object(keys.into()))
}

/// Returns the data as JSON, or as a string if it is none.
fn body(frame: &Frame<'_>) -> Value {
    let text = String::from_utf8_lossy(&frame.data);
    json(&text).unwrap_or_else(|| Value::String(text.into_owned()))
}
