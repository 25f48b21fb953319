//! Pictures in messages, and the schemas of the types that viewers know.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use fc_reflect::{Node, Value as Content, walk};
use serde_json::{Value, json};

/// The first bytes of a picture, and its format.
const FORMATS: [(&[u8], &str); 2] = [(b"\x89PNG\r\n\x1A\n", "png"), (b"\xFF\xD8\xFF", "jpeg")];

/// A picture.
pub(super) struct Picture<'b> {
    bytes: &'b [u8],
    /// Its format, as viewers name it.
    pub(super) format: &'static str,
}

impl Picture<'_> {
    pub(super) fn base64(&self) -> String {
        STANDARD.encode(self.bytes)
    }
}

/// Returns the pictures in a message.
pub(super) fn pictures<'b>(nodes: &'b [Node<'_>]) -> Vec<Picture<'b>> {
    let mut pictures = Vec::new();
    walk(nodes, &mut |_, node| {
        if let Content::Bytes(bytes) = &node.value {
            let mut formats = FORMATS.iter();
            if let Some((_, format)) = formats.find(|(start, _)| bytes.starts_with(start)) {
                pictures.push(Picture { bytes, format });
            }
        }
    });
    pictures
}

fn timestamp() -> Value {
    json!({
        "type": "object",
        "properties": { "sec": { "type": "integer" }, "nsec": { "type": "integer" } },
    })
}

/// Returns the schema of `foxglove.CompressedImage`.
pub(super) fn image() -> Value {
    json!({
        "title": "foxglove.CompressedImage",
        "type": "object",
        "properties": {
            "timestamp": timestamp(),
            "frame_id": { "type": "string" },
            "data": { "type": "string", "contentEncoding": "base64" },
            "format": { "type": "string" },
        },
    })
}

/// Returns the schema of `foxglove.Log`.
pub(super) fn log() -> Value {
    json!({
        "title": "foxglove.Log",
        "type": "object",
        "properties": {
            "timestamp": timestamp(),
            "level": { "type": "integer" },
            "message": { "type": "string" },
            "name": { "type": "string" },
            "file": { "type": "string" },
            "line": { "type": "integer" },
        },
    })
}
