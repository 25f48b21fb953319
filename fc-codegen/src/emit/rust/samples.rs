//! How each operation is called and answered, as the pages of the documentation show it. The same
//! text stands in a test of the generated crate, so no sample can rot.

use super::context::Context;
use super::names::{free, ident, integer, literal, pascal};
use super::protocol::type_name;
use super::robot::signature;
use super::source::Source;
use crate::sample::{Profile, Samples};
use fc_spec::model::{
    Direction, EnumType, Kind, Model, Number, OneOf, Operation, Scalar, StructType, Type,
    TypeShape, Value,
};

/// Columns that a value may take on one line.
const WIDTH: usize = 72;

/// What makes the samples of a model.
pub struct Snippets<'m> {
    context: Context<'m>,
    samples: Samples<'m>,
    protocol: String,
}

impl<'m> Snippets<'m> {
    /// Indexes the model.
    #[must_use]
    pub fn new(model: &'m Model) -> Self {
        let context = Context::new(model, None);
        let protocol = type_name(&context);
        Self {
            context,
            samples: Samples::new(model),
            protocol,
        }
    }

    /// What an app does: calls a command, or takes a report. `None` without a code.
    #[must_use]
    pub fn app(&self, operation: &Operation) -> Option<String> {
        operation.code.value?;
        let method = self.context.method(operation);
        let ty = operation.request.ty.as_deref()?;
        match operation.kind {
            Kind::Command => {
                let request = self.message(operation, Direction::Request)?;
                Some(format!(
                    "{}let answer = client.{method}(&request).await?;\nprintln!(\"{{answer:?}}\");\n",
                    assign("request", &request)
                ))
            }
            Kind::Report => Some(format!(
                "while let Some(report) = reports.recv().await {{\n    \
                     if let AnyReport::{ty}(report) = report? {{\n        \
                         println!(\"{{report:?}}\");\n    \
                     }}\n\
                 }}\n"
            )),
            Kind::Stream => None,
        }
    }

    /// What a robot does: answers a command, or pushes a report. `None` without a code.
    #[must_use]
    pub fn robot(&self, operation: &Operation) -> Option<String> {
        operation.code.value?;
        let method = self.context.method(operation);
        match operation.kind {
            Kind::Command => {
                let (request, response) = (
                    operation.request.ty.as_deref()?,
                    operation.response.ty.as_deref()?,
                );
                let answer = self.message(operation, Direction::Response)?;
                let context = self.context.runtime("Context");
                let context = format!("context: {context}<{}>", self.protocol);
                let request = format!("request: {request}");
                let refusal = self.context.runtime("Refusal");
                let (open, params, close) =
                    signature(&method, &context, &request, response, &refusal);
                let mut out = Source::default();
                out.list(&open, &params, &format!("{close} {{"));
                let lines = format!(
                    "println!(\"{{}} asks: {{request:?}}\", context.peer);\nOk({})\n",
                    answer.spelled(0)
                );
                out.line(indented(&lines));
                out.line("}");
                Some(out.finish())
            }
            Kind::Report => {
                let report = self.message(operation, Direction::Request)?;
                let audience = self.context.runtime("Audience");
                Some(format!(
                    "{}for acknowledgement in reporter.{method}({audience}::All, &report).await? {{\n    \
                         println!(\"{{acknowledgement:?}}\");\n\
                     }}\n",
                    assign("report", &report)
                ))
            }
            Kind::Stream => None,
        }
    }

    /// The example body of one side.
    fn message(&self, operation: &Operation, direction: Direction) -> Option<Expression> {
        let body = match direction {
            Direction::Request => &operation.request,
            Direction::Response => &operation.response,
        };
        let name = body.ty.as_deref()?;
        let value = self.samples.body(operation, direction, Profile::Example);
        self.named(name, &value)
    }

    fn named(&self, name: &str, value: &Value) -> Option<Expression> {
        match &self.context.type_named(name)?.shape {
            TypeShape::Struct(shape) => self.structure(name, shape, value),
            TypeShape::Enum(shape) => Some(Expression::Atom(enum_value(name, shape, value)?)),
            TypeShape::OneOf(shape) => self.choice(name, shape, value),
        }
    }

    fn structure(&self, name: &str, shape: &StructType, value: &Value) -> Option<Expression> {
        let (mut required, mut optional) = (Vec::new(), Vec::new());
        for field in &shape.fields {
            let held = value.get(&field.wire).filter(|held| **held != Value::Null);
            let made = match (&field.ty, held, field.optional) {
                (_, None, true) => continue,
                // Taken as it stands where a text is wanted.
                (Type::String, Some(Value::String(text)), _) => Expression::Atom(literal(text)),
                (ty, held, _) => self.value(ty, held.unwrap_or(&Value::Null))?,
            };
            let name = ident(&field.name).trim_start_matches("r#").to_owned();
            if field.optional {
                optional.push((name, made));
            } else {
                required.push((name, made));
            }
        }
        Some(Expression::Struct(name.to_owned(), required, optional))
    }

    fn choice(&self, name: &str, shape: &OneOf, value: &Value) -> Option<Expression> {
        let taken = self.samples.variant_of(shape, value)?;
        let variant = shape.variants.iter().find(|variant| {
            self.samples
                .struct_named(&variant.ty)
                .is_some_and(|ty| std::ptr::eq(ty, taken))
        })?;
        let inner = self.structure(&variant.ty, taken, value)?;
        Some(inner.inside(&format!("{name}::{}(", pascal(&variant.name)), ")"))
    }

    fn value(&self, ty: &Type, value: &Value) -> Option<Expression> {
        let atom = match (ty, value) {
            (Type::Array(item), Value::Array(items)) => {
                let items: Option<Vec<_>> =
                    items.iter().map(|value| self.value(item, value)).collect();
                return Some(Expression::List(items?));
            }
            (Type::Named(name), value) => return self.named(name, value),
            (Type::Json, value) => format!("serde_json::json!({value}).into()"),
            (Type::Base64, Value::String(text)) => bytes(text)?,
            (Type::String, Value::String(text)) if text.is_empty() => "String::new()".to_owned(),
            (Type::String, Value::String(text)) => format!("{}.to_owned()", literal(text)),
            (Type::Bool, Value::Bool(value)) => value.to_string(),
            // Numbers and bools inside JSON strings are written as such.
            (Type::Bool, Value::String(text)) => text.clone(),
            (Type::Float(_), Value::Number(Number::Int(value))) => format!("{value}.0"),
            (_, Value::Number(Number::Int(value))) => integer(*value),
            (_, Value::Number(Number::Float(value))) => format!("{value:?}"),
            (Type::Float(_), Value::String(text)) => format!("{:?}", text.parse::<f64>().ok()?),
            (_, Value::String(text)) => integer(text.parse().ok()?),
            _ => return None,
        };
        Some(Expression::Atom(atom))
    }
}

fn enum_value(name: &str, shape: &EnumType, value: &Value) -> Option<String> {
    let same = |wire: &Scalar| match (wire, value) {
        (Scalar::String(wire), Value::String(value)) => wire == value,
        (Scalar::Number(wire), Value::Number(value)) => wire == value,
        (Scalar::Number(Number::Int(wire)), Value::String(value)) => wire.to_string() == *value,
        _ => false,
    };
    let known = shape
        .values
        .iter()
        .find(|candidate| same(&candidate.wire))?;
    Some(format!("{name}::{}", pascal(&known.name)))
}

/// Values with the names of their fields.
type Fields = Vec<(String, Expression)>;

/// A Rust value, before it is laid out.
enum Expression {
    Atom(String),
    /// Around another: `Some(`, `)`.
    Inside(String, Box<Expression>, String),
    /// `vec![…]`.
    List(Vec<Expression>),
    /// A struct: what its `new` takes, and the fields that are set besides.
    Struct(String, Fields, Fields),
}

impl Expression {
    fn inside(self, open: &str, close: &str) -> Self {
        Self::Inside(open.to_owned(), Box::new(self), close.to_owned())
    }

    /// On one line.
    fn flat(&self, out: &mut String) {
        let comma = |index| if index > 0 { ", " } else { "" };
        match self {
            Self::Atom(text) => out.push_str(text),
            Self::Inside(open, inner, close) => {
                out.push_str(open);
                inner.flat(out);
                out.push_str(close);
            }
            Self::List(items) => {
                out.push_str("vec![");
                for (index, item) in items.iter().enumerate() {
                    out.push_str(comma(index));
                    item.flat(out);
                }
                out.push(']');
            }
            Self::Struct(name, required, optional) => {
                out.extend([name, "::new("]);
                for (index, (_, value)) in required.iter().enumerate() {
                    out.push_str(comma(index));
                    value.flat(out);
                }
                out.push(')');
                for (field, value) in optional {
                    out.extend([".with_", field, "("]);
                    value.flat(out);
                    out.push(')');
                }
            }
        }
    }

    /// On one line if that is short enough, `used` columns being taken.
    fn spelled(&self, used: usize) -> String {
        let mut flat = String::new();
        self.flat(&mut flat);
        if used + flat.len() <= WIDTH {
            return flat;
        }
        match self {
            Self::Atom(_) => flat,
            Self::Inside(open, inner, close) => {
                format!("{open}{}{close}", inner.spelled(used + open.len()))
            }
            Self::List(items) => {
                let mut inside = String::new();
                for item in items {
                    inside.extend([&item.spelled(used + 4), ",\n"]);
                }
                ["vec![\n", &indented(&inside), "]"].concat()
            }
            Self::Struct(name, required, optional) => made(name, required, optional, used),
        }
    }
}

/// Arguments up to which nobody asks which is which.
const FEW: usize = 2;

/// A struct on several lines, as rustfmt lays out a chain of calls.
fn made(name: &str, required: &Fields, optional: &Fields, used: usize) -> String {
    let mut arguments = String::new();
    for (index, (_, value)) in required.iter().enumerate() {
        if index > 0 {
            arguments.push_str(", ");
        }
        value.flat(&mut arguments);
    }
    let mut out = format!("{name}::new(");
    let is_short = used + out.len() + arguments.len() < WIDTH;
    if is_short {
        out.push_str(&arguments);
    } else {
        let mut inside = String::new();
        for (field, value) in required {
            let value = value.spelled(used + 4);
            inside.extend([&value, ","]);
            if required.len() > FEW && !value.contains('\n') {
                inside.extend([" // ", field]);
            }
            inside.push('\n');
        }
        out.extend(["\n", &indented(&inside)]);
    }
    out.push(')');
    let mut setters = String::new();
    for (field, value) in optional {
        let value = value.spelled(used + field.len() + 12);
        setters.extend(["\n.with_", field, "(", &value, ")"]);
    }
    out.push_str(&if is_short {
        indented(&setters)
    } else {
        setters
    });
    out.trim_end().to_owned()
}

/// Bytes in the base64 text of an example.
fn bytes(text: &str) -> Option<String> {
    const DIGITS: &str = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut decoded = String::new();
    let (mut bits, mut held) = (0_u32, 0);
    for digit in text.trim_end_matches('=').chars() {
        bits = (bits << 6) | u32::try_from(DIGITS.find(digit)?).ok()?;
        held += 6;
        if held >= 8 {
            held -= 8;
            let byte = u8::try_from((bits >> held) & 0xFF).ok()?;
            decoded.extend(std::ascii::escape_default(byte).map(char::from));
        }
    }
    Some(format!("Bytes64(b\"{decoded}\".to_vec())"))
}

fn assign(name: &str, value: &Expression) -> String {
    format!("let {name} = {};\n", value.spelled(name.len() + 8))
}

/// Every line one level deeper.
fn indented(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for line in text.lines() {
        if !line.is_empty() {
            out.push_str("    ");
        }
        out.push_str(line);
        out.push('\n');
    }
    out
}

/// The test that compiles and runs every sample.
#[must_use]
pub fn file(model: &Model, krate: &str) -> String {
    let snippets = Snippets::new(model);
    let context = &snippets.context;
    let commands = context.coded(Kind::Command);
    let reports = context.coded(Kind::Report);
    let taken = |name: &str| context.type_named(name).is_some();
    let robot = free(&["SampleRobot", "RobotOfTheSamples"], taken);
    let mut out = Source::default();
    out.line(
        "\
//! The samples that the documentation shows, compiled and run: every command is called, every
//! report pushed and taken.

#![allow(deprecated, reason = \"a robot still answers what is withdrawn\")]
#![allow(
    clippy::approx_constant,
    clippy::print_stdout,
    clippy::similar_names,
    clippy::too_many_lines,
    clippy::unreadable_literal,
    clippy::wildcard_imports,
    missing_docs,
    unused_imports,
    reason = \"samples are as the spec's examples are\"
)]",
    );
    out.blank();
    out.line(format!("use {krate}::*;"));
    let names = ["Audience", "Bytes64", "Context", "Refusal"];
    let names: Vec<&str> = names.into_iter().filter(|name| !taken(name)).collect();
    out.import("fc_runtime", &names);
    out.blank();
    out.line(format!("struct {robot};"));
    robot_of_samples(&mut out, &snippets, &robot, &commands);
    functions(&mut out, &snippets, &commands, &reports);
    test_of_samples(&mut out, &robot, &commands, &reports);
    out.finish()
}

/// Operations of a kind, with their codes.
type Coded<'m> = [(u16, &'m Operation)];

fn robot_of_samples(out: &mut Source, snippets: &Snippets<'_>, robot: &str, commands: &Coded<'_>) {
    out.blank();
    out.block(format!("impl Robot for {robot}"), |out| {
        for (_, command) in commands {
            if let Some(sample) = snippets.robot(command) {
                out.blank();
                out.line(sample);
            }
        }
    });
}

fn functions(out: &mut Source, snippets: &Snippets<'_>, commands: &Coded<'_>, reports: &Coded<'_>) {
    for (_, command) in commands {
        let Some(sample) = snippets.app(command) else {
            continue;
        };
        out.blank();
        let name = &command.name;
        out.block(
            format!(
                "async fn call_{name}(client: &Client) -> Result<(), Box<dyn std::error::Error>>"
            ),
            |out| {
                out.line(sample);
                out.line("Ok(())");
            },
        );
    }
    for (_, report) in reports {
        let (Some(app), Some(robot)) = (snippets.app(report), snippets.robot(report)) else {
            continue;
        };
        let name = &report.name;
        out.blank();
        out.block(
            format!("async fn take_{name}(mut reports: Reports) -> Result<(), Box<dyn std::error::Error>>"),
            |out| {
                out.line(app);
                out.line("Ok(())");
            },
        );
        out.blank();
        out.block(
            format!("async fn push_{name}(reporter: &Reporter) -> Result<(), Box<dyn std::error::Error>>"),
            |out| {
                out.line(robot);
                out.line("Ok(())");
            },
        );
    }
}

fn test_of_samples(out: &mut Source, robot: &str, commands: &Coded<'_>, reports: &Coded<'_>) {
    out.blank();
    out.line("#[tokio::test]");
    out.block("async fn every_sample_runs() -> Result<(), Box<dyn std::error::Error>>", |out| {
        out.line(format!(
            "\
let host = std::net::Ipv4Addr::LOCALHOST;
let config = fc_runtime::ServerConfig::new().address(host).command_port(0).data_port(0);
let server = fc_runtime::Server::bind(config, RobotService::new({robot})).await?;
let port = server.command_addr().port();
let handle = server.handle();
let serving = tokio::spawn(server.run());
let config = fc_runtime::ClientConfig::new().host(host.to_string()).command_port(port);
let client = Client::connect(config).await?;"
        ));
        for (_, command) in commands {
            out.line(format!("call_{}(&client).await?;", command.name));
        }
        if !reports.is_empty() {
            out.line("let reporter = Reporter::new(handle.clone());");
            let takers: Vec<String> =
                reports.iter().map(|(_, report)| format!("take_{}(client.reports())", report.name)).collect();
            let pushes: Vec<String> =
                reports.iter().map(|(_, report)| format!("push_{}(&reporter).await?;\n", report.name)).collect();
            out.list("let takers = async { tokio::try_join!(", &takers, ") };");
            out.enclose("let pushes = async {", "};", |out| {
                out.line(pushes.concat());
                out.line("Ok::<(), Box<dyn std::error::Error>>(())");
            });
            out.line("// An app takes reports for ever; a push is done when every app has acknowledged it.");
            out.enclose("tokio::select! {", "}", |out| {
                out.line("taken = takers => drop(taken?),");
                out.line("pushed = pushes => pushed?,");
            });
        }
        out.line("drop(client);");
        out.line("handle.shutdown(std::time::Duration::from_secs(1)).await;");
        out.line("serving.await?;");
        out.line("Ok(())");
    });
}
