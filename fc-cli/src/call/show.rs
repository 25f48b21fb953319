//! The output of a call.

use std::time::Duration;

use fc_reflect::{BodyError, Direction, Frame, Message};
use fc_spec::model::{Kind, Model, Number, Operation, Value};
use fc_workshop::answer::Outcome;
use fc_workshop::arguments::json;
use fc_workshop::paths;
use fc_workshop::table::{aligned, table};

use crate::lang::{in_lang, lang, said};
use crate::outcome::Failure;

/// The format of the output.
#[derive(Clone, Copy)]
pub struct Format {
    /// One line of JSON per message instead of a table.
    pub json: bool,
}

impl Format {
    /// Shows a response.
    pub fn response(
        self,
        name: Option<&str>,
        frame: &Frame<'_>,
        outcome: &Outcome<'_>,
        message: &Message<'_>,
        took: Duration,
    ) -> String {
        let name = name.map_or_else(|| format!("0x{:04X}", frame.id.code), str::to_owned);
        let result = outcome.known.map_or("", |known| &known.name);
        if self.json {
            let took = Number::Float(milliseconds(took));
            let code = outcome.code.map_or(Value::Null, |code| int(code.into()));
            return line(vec![
                ("name", Value::String(name)),
                ("kind", Value::String("response".to_owned())),
                ("result", code),
                ("result_name", Value::String(result.to_owned())),
                ("result_text", Value::String(outcome.text.clone())),
                ("milliseconds", Value::Number(took)),
                ("body", body(frame)),
            ]);
        }
        let nodes = message.body.as_deref().unwrap_or_default();
        let summary = summary(&name, outcome);
        format!("{summary}\n{}", table(nodes, lang()))
    }

    /// Shows the times of several calls. In JSON, each response has its own.
    pub fn times(self, mut times: Vec<Duration>) -> String {
        times.sort();
        let at = |index: usize| times.get(index).copied().map_or(0.0, milliseconds);
        let (count, last) = (times.len(), times.len().saturating_sub(1));
        if self.json || count < 2 {
            return String::new();
        }
        let (first, median, last) = (at(0), at(last / 2), at(last));
        said!(
            "{count} 次响应：最短 {first} ms，中位 {median} ms，最长 {last} ms\n",
            "{count} responses: shortest {first} ms, median {median} ms, longest {last} ms\n"
        )
    }

    /// Shows a report or a frame of a stream.
    pub fn pushed(
        self,
        operation: &Operation,
        frame: &Frame<'_>,
        message: Option<&Message<'_>>,
    ) -> String {
        let is_bytes = operation.body(Direction::Request).is_none();
        let count = frame.data.len();
        if self.json {
            return line(vec![
                ("name", Value::String(operation.name.clone())),
                ("kind", Value::String(operation.kind().name().to_owned())),
                if is_bytes {
                    ("bytes", int(i128::try_from(count).unwrap_or(0)))
                } else {
                    ("body", body(frame))
                },
            ]);
        }
        let title = lang().text(&operation.title);
        let name = &operation.name;
        if is_bytes {
            return said!(
                "{name}  {title}  {count} 字节\n",
                "{name}  {title}  {count} bytes\n"
            );
        }
        let nodes = message.and_then(|message| message.body.as_deref().ok());
        let rows = table(nodes.unwrap_or_default(), lang());
        format!("{name}  {title}\n{rows}")
    }
}

/// Returns the name and the result of a response.
pub fn summary(name: &str, outcome: &Outcome<'_>) -> String {
    let result = outcome.known.map_or("", |known| &known.name);
    let code = outcome.code.map(|code| format!("  {code} {result}"));
    // The robot sends the Chinese text of the result, sometimes with a reason behind it.
    let known = outcome.known.and_then(|known| {
        let reason = outcome.text.strip_prefix(&known.text.zh)?;
        Some(format!("{}{reason}", lang().text(&known.text)))
    });
    let text = known.unwrap_or_else(|| outcome.text.clone());
    let text = if text.is_empty() {
        text
    } else {
        format!("  {text}")
    };
    let code = code.unwrap_or_default();
    format!("{name}{code}{text}")
}

fn int(value: i128) -> Value {
    Value::Number(Number::Int(value))
}

fn milliseconds(time: Duration) -> f64 {
    (time.as_secs_f64() * 10_000.0).round() / 10.0
}

fn line(keys: Vec<(&str, Value)>) -> String {
    let keys = keys.into_iter().map(|(key, value)| (key.to_owned(), value));
    format!("{}\n", Value::Object(keys.collect()))
}

/// Returns the data as JSON, or as a string if it is none.
fn body(frame: &Frame<'_>) -> Value {
    let text = String::from_utf8_lossy(&frame.data);
    json(&text).unwrap_or_else(|| Value::String(text.into_owned()))
}

/// Returns the list of commands and streams.
pub fn list(model: &Model, is_json: bool) -> String {
    let operations = model.operations.iter();
    let operations = operations.filter(|operation| operation.kind() != Kind::Report);
    if is_json {
        let lines = operations.map(|operation| {
            let effect = operation.effect().map_or("", |effect| effect.name());
            line(vec![
                ("name", Value::String(operation.name.clone())),
                ("kind", Value::String(operation.kind().name().to_owned())),
                ("code", Value::String(operation.code.spelling.clone())),
                ("effect", Value::String(effect.to_owned())),
                ("zh", Value::String(operation.title.zh.clone())),
                ("en", Value::String(operation.title.en.clone())),
            ])
        });
        return lines.collect();
    }
    let rows: Vec<_> = operations
        .map(|operation| {
            let effect = operation
                .effect()
                .map_or_else(|| operation.kind().name(), |effect| effect.name());
            [
                operation.name.clone(),
                operation.code.spelling.clone(),
                effect.to_owned(),
                lang().text(&operation.title).to_owned(),
            ]
        })
        .collect();
    aligned(&rows)
}

/// Returns the error of a request, with the accepted numbers of the field.
pub fn breaks_the_spec(model: &Model, operation: &Operation, error: &BodyError) -> Failure {
    let body = operation.body(Direction::Request);
    let field = body.and_then(|body| paths::field(model, &body.ty, error.path()));
    let accepted = field.and_then(|field| {
        let numbers = in_lang(&field.details().constraints.numbers()?);
        let unit = field.details().unit.as_deref().unwrap_or_default();
        let accepted = format!("{numbers} {unit}");
        let accepted = accepted.trim_end();
        Some(said!("；允许 {accepted}", "; accepted: {accepted}"))
    });
    let accepted = accepted.unwrap_or_default();
    said!(
        "请求不合规范，没有发送：{error}{accepted}",
        "the request breaks the spec and was not sent: {error}{accepted}"
    )
    .into()
}
