//! The observations of a proxy as lines.

use super::Event;
use crate::decode;
use fc_spec::model::{HeaderRole, Lang, Model, Text};
use fc_spec::text;
use serde_json::json;
use std::io;

/// Returns an observation as a line for people.
#[must_use]
pub fn line(event: &Event<'_, '_>, model: &Model, lang: Lang) -> String {
    match event {
        Event::Record(record) => decode::line(record, model, lang),
        Event::Faults { flow, id, kinds } => {
            let kinds: Vec<_> = kinds.iter().map(|kind| kind.name()).collect();
            let (fault, kinds) = (lang.pick("故障", "fault"), kinds.join(", "));
            let key = model.frame.field(HeaderRole::Id);
            let key = key.map_or("id", |field| field.wire.as_str());
            let (code, id) = (id.code, id.id);
            format!("  {fault} 0x{code:04X} · {kinds} · {key} {id} · {flow}")
        }
        Event::Unreachable(address, error) => lang.text(&unreachable(address, error)).to_owned(),
    }
}

/// Returns an observation as a line of JSON.
#[must_use]
pub fn json_line(event: &Event<'_, '_>) -> String {
    match event {
        Event::Record(record) => decode::json(record),
        Event::Faults { flow, id, kinds } => {
            let kinds: Vec<_> = kinds.iter().map(|kind| kind.name()).collect();
            let (flow, code) = (flow.to_string(), format!("0x{:04X}", id.code));
            json!({ "connection": flow, "code": code, "msg_id": id.id, "faults": kinds })
                .to_string()
        }
        Event::Unreachable(address, error) => {
            json!({ "error": unreachable(address, error).en }).to_string()
        }
    }
}

/// Returns the error of a robot that accepts no connection.
#[must_use]
pub fn unreachable(address: &str, error: &io::Error) -> Text {
    text!(
        "无法连接机器人 {address}：{error}",
        "cannot connect to the robot {address}: {error}"
    )
}
