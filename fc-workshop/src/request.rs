//! Composes messages from a person's values: the request of a call, or a frame.

use crate::arguments::{Arguments, json};
use crate::error::InputError;
use crate::{facts, paths};
use fc_reflect::sample::Profile;
use fc_reflect::{BodyError, Direction, Error, Packing, Reflector};
use fc_spec::model::{Kind, Model, Operation, Side, Value};
use fc_spec::text;

/// The values of a body.
#[derive(Clone, Debug)]
pub enum Values {
    /// `key=value` with the keys and names of the spec.
    Arguments(Vec<String>),
    /// A JSON object.
    Json(Value),
}

impl Values {
    /// Reads a JSON object.
    ///
    /// # Errors
    /// [`InputError`] if the text is anything else.
    pub fn json(text: &str) -> Result<Self, InputError> {
        let value = json(text).filter(|value| matches!(value, Value::Object(_)));
        value.map(Self::Json).ok_or_else(|| {
            InputError(text!(
                "`--json` 应为一个 JSON 对象",
                "`--json` needs a JSON object"
            ))
        })
    }

    fn is_empty(&self) -> bool {
        matches!(self, Self::Arguments(arguments) if arguments.is_empty())
    }
}

/// A request that is ready to be sent.
#[derive(Clone, Debug)]
pub struct Request<'m> {
    /// The operation, or `None` for bytes to a code that the spec does not have.
    pub operation: Option<&'m Operation>,
    /// Kind of the frame.
    pub kind: u8,
    /// Command code.
    pub code: u16,
    /// Data of the frame. Empty for a stream of the robot.
    pub data: Vec<u8>,
}

impl<'m> Request<'m> {
    /// Composes the request of a command, or the message of a stream, and checks it against the spec.
    ///
    /// # Errors
    /// [`InputError`] if the spec has no such operation, or if the request breaks the spec.
    pub fn named(
        reflector: &Reflector<'m>,
        name: &str,
        values: Values,
    ) -> Result<Self, InputError> {
        let model = reflector.model();
        let is_callable = |operation: &&Operation| operation.kind() != Kind::Report;
        let operation = model.operation(name).filter(is_callable).ok_or_else(|| {
            InputError(text!(
                "没有指令 `{name}`；`fcproto call --list` 列出全部指令",
                "there is no command `{name}`; `fcproto call --list` shows all"
            ))
        })?;
        let Some(id) = reflector.id(operation, Direction::Request, 0) else {
            return Err(InputError(text!(
                "`{name}` 还没有功能码，不能发送",
                "`{name}` has no code yet, so it cannot be sent"
            )));
        };
        let request = |data| Self {
            operation: Some(operation),
            kind: id.kind,
            code: id.code,
            data,
        };
        let is_stream = operation.kind() == Kind::Stream;
        if is_stream && operation.sender == Side::Robot {
            if !values.is_empty() {
                return Err(InputError(text!(
                    "`{name}` 由机器人发送，不接受参数",
                    "the robot sends `{name}`, so it takes no arguments"
                )));
            }
            return Ok(request(Vec::new()));
        }
        let body = operation.body(Direction::Request);
        if is_stream && body.is_none() {
            return Err(InputError(text!(
                "`{name}` 的内容是字节，`call` 只发送 JSON",
                "`{name}` has bytes, and `call` sends only JSON"
            )));
        }
        let body = match (values, body) {
            (Values::Json(value), _) => value,
            (Values::Arguments(arguments), Some(body)) => {
                let arguments = arguments.iter().map(String::as_str);
                Arguments::new(model).object(&body.ty, arguments)?
            }
            (Values::Arguments(_), None) => Value::Object(Vec::new()),
        };
        let mut message = enveloped(reflector, operation, Direction::Request, body);
        if !is_stream {
            facts::stamp(model, Direction::Request, &mut message);
        }
        let data = message.to_string();
        let checked = reflector.message(Some(operation), Direction::Request, data.as_bytes());
        let text = checked.and_then(|message| message.canonical());
        let text = text.map_err(|error| invalid(model, operation, &error))?;
        Ok(request(text.into_bytes()))
    }

    /// Sends bytes in hexadecimal to a code, without a check against the spec.
    ///
    /// # Errors
    /// [`InputError`] if the text is not hexadecimal.
    pub fn raw(model: &'m Model, code: u16, hex: &str) -> Result<Self, InputError> {
        let data = bytes(hex).ok_or_else(|| {
            InputError(text!(
                "`{hex}` 不是十六进制字节，例如 `7b7d`",
                "`{hex}` is not bytes in hexadecimal, such as `7b7d`"
            ))
        })?;
        let is_it = |operation: &&Operation| {
            operation.kind() == Kind::Command && operation.code.value == Some(code)
        };
        Ok(Self {
            operation: model.operations.iter().find(is_it),
            kind: model.frame.kinds.command.value,
            code,
            data,
        })
    }
}

/// Builds a frame of one side of an operation. Without values, it has the example of the spec.
///
/// # Errors
/// [`InputError`] if the spec has no such operation, or if the body breaks the spec.
pub fn frame(
    reflector: &Reflector<'_>,
    name: &str,
    (direction, id): (Direction, u32),
    values: Values,
    packing: Packing,
) -> Result<Vec<u8>, InputError> {
    let model = reflector.model();
    let Some(operation) = model.operation(name) else {
        return Err(InputError::unknown_operation(name));
    };
    let Some(id) = reflector.id(operation, direction, id) else {
        return Err(InputError(text!(
            "`{name}` 还没有功能码，不能组成一帧",
            "`{name}` has no code yet, so it has no frame"
        )));
    };
    let body = match values {
        Values::Json(value) => Some(value),
        Values::Arguments(arguments) if arguments.is_empty() => None,
        Values::Arguments(arguments) => {
            let Some(body) = operation.body(direction) else {
                return Err(InputError(text!(
                    "`{name}` 这一侧没有 JSON 正文，不能带值",
                    "this side of `{name}` has no JSON body; leave out the values"
                )));
            };
            let arguments = arguments.iter().map(String::as_str);
            Some(Arguments::new(model).object(&body.ty, arguments)?)
        }
    };
    let data = match body {
        None => reflector.samples().data(operation, direction),
        Some(body) => {
            let message = enveloped(reflector, operation, direction, body);
            message.to_string().into()
        }
    };
    let frame = reflector.encode(id, &data, packing);
    frame.map_err(|error| match error {
        Error::Body { error, .. } => InputError(text!(
            "正文不合规范：{error}",
            "the body breaks the spec: {error}"
        )),
        Error::Frame(error) => InputError(text!("{error}", "{error}")),
    })
}

/// Returns a body with the example of its envelope. A stream has no envelope.
fn enveloped(
    reflector: &Reflector<'_>,
    operation: &Operation,
    direction: Direction,
    body: Value,
) -> Value {
    if operation.kind() == Kind::Stream {
        return body;
    }
    let samples = reflector.samples();
    samples.enveloped(direction, body, Profile::Example)
}

/// Returns the error of a request, with the accepted numbers of the field.
fn invalid(model: &Model, operation: &Operation, error: &BodyError) -> InputError {
    let body = operation.body(Direction::Request);
    let field = body.and_then(|body| paths::field(model, &body.ty, error.path()));
    let accepted = field.and_then(|field| {
        let numbers = field.details().constraints.numbers()?;
        let unit = field.details().unit.as_deref();
        let unit = unit.map_or_else(String::new, |unit| format!(" {unit}"));
        Some(text!(
            "；允许 {numbers}{unit}",
            "; accepted: {numbers}{unit}",
            numbers = numbers,
            unit = unit
        ))
    });
    InputError(text!(
        "请求不合规范，没有发送：{error}{accepted}",
        "the request breaks the spec and was not sent: {error}{accepted}",
        error = error.to_string(),
        accepted = accepted.unwrap_or_default()
    ))
}

/// Reads bytes in hexadecimal, with any white space.
fn bytes(hex: &str) -> Option<Vec<u8>> {
    let digits: Vec<u8> = hex
        .chars()
        .filter(|it| !it.is_whitespace())
        .map(|it| it.to_digit(16).and_then(|digit| u8::try_from(digit).ok()))
        .collect::<Option<_>>()?;
    let pairs = digits.chunks_exact(2);
    if !pairs.remainder().is_empty() {
        return None;
    }
    let byte = |pair: &[u8]| pair.iter().fold(0, |byte, digit| byte << 4 | digit);
    Some(pairs.map(byte).collect())
}
