//! The streams in the stubs: an app subscribes to the robot's streams, and both sides send streams.

use super::context::Context;
use super::source::Source;
use crate::package::facts;
use fc_spec::model::{Operation, Side};

/// The maximum width of a chain of calls on one line, as in rustfmt.
const CHAIN_WIDTH: usize = 60;

/// Returns `true` if the stubs have any streams.
pub fn are_any(context: &Context<'_>) -> bool {
    !context.package.streams.is_empty()
}

/// Returns `true` if any stream from one of these senders carries a message type.
pub fn has_type(context: &Context<'_>, senders: &[Side]) -> bool {
    let mut sent = streams(context).filter(|stream| senders.contains(&stream.sender));
    sent.any(|stream| context.content(stream).is_some())
}

/// Returns the runtime types that streams in the app's stub need.
pub fn imports_of_app(context: &Context<'_>) -> Vec<&'static str> {
    let mut names = Vec::new();
    for stream in streams(context) {
        if stream.sender == Side::App {
            names.push("DataError");
        } else {
            names.push("Subscription");
            names.extend(context.content(stream).is_none().then_some("Body"));
        }
    }
    names
}

/// Returns the runtime types that streams in the robot's stub need.
pub fn imports_of_robot(context: &Context<'_>) -> Vec<&'static str> {
    let mut own = streams(context).filter(|stream| stream.sender == Side::Robot);
    match own.next() {
        Some(_) => vec!["Audience", "PushError"],
        None => Vec::new(),
    }
}

/// Writes `Streams`, in the app's stub.
pub fn app(out: &mut Source, context: &Context<'_>, protocol: &str) {
    out.template("streams", &[("protocol", protocol)]);
    out.deeper(1, |out| {
        for stream in streams(context) {
            let code = &stream.code.spelling;
            let name = &stream.name;
            out.documented(&facts::method_docs(context, stream, |_| ()));
            if stream.sender == Side::Robot {
                let carried = content(context, stream).unwrap_or_else(|| "Body".to_owned());
                out.line("#[must_use]");
                let open = format!("pub fn subscribe_{name}(");
                let close = format!(") -> Subscription<{carried}> {{");
                out.list(&open, &["&self".to_owned()], &close);
                out.line(format!("    self.data.subscribe({code})"));
            } else {
                let (method, parameter) = sent(context, stream, "send", "send_json");
                let params = ["&self".to_owned(), "id: u32".to_owned(), parameter];
                let open = format!("pub async fn send_{name}(");
                out.list(&open, &params, ") -> Result<(), DataError> {");
                out.line(format!("    self.data.{method}({code}, id, content).await"));
            }
            out.line("}");
        }
    });
    out.line("}");
}

/// Writes `Streamer`, in the robot's stub.
pub fn robot(out: &mut Source, context: &Context<'_>, protocol: &str) {
    out.template("streamer", &[("protocol", protocol)]);
    out.deeper(1, |out| {
        for stream in streams(context).filter(|stream| stream.sender == Side::Robot) {
            let code = &stream.code.spelling;
            let mut docs = facts::method_docs(context, stream, |_| ());
            docs.paragraph("Returns the number of data connections that took it.");
            let (method, parameter) = sent(context, stream, "send_stream", "send_stream_json");
            let params = [
                "&self".to_owned(),
                "audience: Audience".to_owned(),
                "id: u32".to_owned(),
                parameter,
            ];
            out.documented(&docs);
            let open = format!("pub async fn send_{}(", stream.name);
            out.list(&open, &params, ") -> Result<usize, PushError> {");
            let sending = format!("{method}(audience, {code}, id, content)");
            let chain = format!("self.handle.{sending}.await");
            if chain.len() <= CHAIN_WIDTH {
                out.line(format!("    {chain}"));
            } else {
                out.line(format!(
                    "    self.handle\n        .{sending}\n        .await"
                ));
            }
            out.line("}");
        }
    });
    out.line("}");
}

/// Returns the streams that have a code.
fn streams<'c>(context: &'c Context<'_>) -> impl Iterator<Item = &'c Operation> {
    context.package.streams.iter().map(|stream| stream.of)
}

/// Returns the type of a stream's content; `None` for raw bytes.
fn content(context: &Context<'_>, stream: &Operation) -> Option<String> {
    Some(format!("messages::{}", context.content(stream)?))
}

/// Returns the sending method of the runtime, and the parameter with the content.
fn sent<'n>(
    context: &Context<'_>,
    stream: &Operation,
    bytes: &'n str,
    json: &'n str,
) -> (&'n str, String) {
    match content(context, stream) {
        Some(ty) => (json, format!("content: &{ty}")),
        None => (bytes, "content: &[u8]".to_owned()),
    }
}
