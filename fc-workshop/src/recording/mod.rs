//! Recordings in MCAP: the messages as JSON for viewers, the frames as bytes, and the spec.
//!
//! | Topic | Content |
//! |---|---|
//! | `/fc/frames` | Each frame as sent, in a channel for each direction of a connection |
//! | `/NAME/request`, `/NAME/response` | Messages as JSON, with a JSON Schema |
//! | `/NAME/picture` | PNG and JPEG pictures in messages, as `foxglove.CompressedImage` |
//! | `/errors` | Errors in frames and messages, as `foxglove.Log` |

mod picture;
mod schema;

use crate::capture::Flow;
use crate::capture::mcap::{FRAMES, FROM, TO};
use crate::decode::Record;
use fc_spec::model::{Direction, Model};
use mcap::records::{MessageHeader, Metadata};
use mcap::{Attachment, McapResult, WriteOptions, Writer};
use serde_json::{Value, json};
use std::borrow::Cow;
use std::collections::{BTreeMap, HashMap};
use std::io::{Seek, Write};
use std::time::Duration;

/// The size of a chunk. A recording that ends early loses one chunk at most.
const CHUNK: u64 = 64 << 10;

/// The connections with channels of frames for each direction. Later ones share a channel without addresses.
const CONNECTIONS: usize = 16_384;

/// The level of an error in a `foxglove.Log`.
const ERROR: u32 = 4;

/// The description of a recording.
#[derive(Clone, Debug)]
pub struct Origin {
    /// The spec as a dump.
    pub dump: String,
    /// The fingerprint of the spec.
    pub fingerprint: String,
    /// Name and version of the program.
    pub program: String,
}

/// Writes a recording.
pub struct Recorder<'m, W: Write + Seek> {
    model: &'m Model,
    writer: Writer<W>,
    /// The channels by their topics. There are two for each operation at most, and some more.
    channels: HashMap<String, u16>,
    /// The channels of frames.
    frames: HashMap<Option<Flow>, u16>,
    sequence: u32,
}

impl<'m, W: Write + Seek> Recorder<'m, W> {
    /// Begins a recording with the spec.
    ///
    /// # Errors
    /// Writing fails.
    pub fn new(model: &'m Model, writer: W, origin: &Origin) -> McapResult<Self> {
        let options = WriteOptions::new()
            .compression(None)
            .library(&origin.program)
            .chunk_size(Some(CHUNK));
        let mut writer = options.create(writer)?;
        writer.attach(&Attachment {
            log_time: 0,
            create_time: 0,
            name: "spec.json".to_owned(),
            media_type: "application/json".to_owned(),
            data: Cow::Borrowed(origin.dump.as_bytes()),
        })?;
        let metadata = [
            ("protocol", &model.protocol.id),
            ("version", &model.protocol.version),
            ("fingerprint", &origin.fingerprint),
        ];
        let metadata = metadata.map(|(key, value)| (key.to_owned(), value.clone()));
        writer.write_metadata(&Metadata {
            name: "spec".to_owned(),
            metadata: BTreeMap::from(metadata),
        })?;
        Ok(Self {
            model,
            writer,
            channels: HashMap::new(),
            frames: HashMap::new(),
            sequence: 0,
        })
    }

    /// Adds a frame, or bytes that are none.
    ///
    /// # Errors
    /// Writing fails.
    pub fn add(&mut self, record: &Record<'m>) -> McapResult<()> {
        let time = record.time.unwrap_or_default();
        let frames = self.frames(record.flow)?;
        self.write(frames, time, &record.bytes)?;
        if let Some(error) = &record.error {
            let log = json!({
                "timestamp": stamp(time),
                "level": ERROR,
                "name": error.name(),
                "message": format!("{} {}", error.path(), error.detail()).trim(),
                "file": record.operation.map_or("", |operation| &operation.name),
                "line": record.offset,
            });
            let errors =
                self.channel("/errors", |_| ("foxglove.Log".to_owned(), picture::log()))?;
            self.write(errors, time, log.to_string().as_bytes())?;
        }
        self.add_message(record, time)
    }

    fn add_message(&mut self, record: &Record<'m>, time: Duration) -> McapResult<()> {
        let (Some(operation), Some(id), Some(message)) =
            (record.operation, record.id, &record.message)
        else {
            return Ok(());
        };
        let Ok(text) = message.canonical() else {
            return Ok(());
        };
        let side = match id.direction {
            Direction::Request => "request",
            Direction::Response => "response",
        };
        let name = &operation.name;
        let channel = self.channel(&format!("/{name}/{side}"), |model| {
            let schema = schema::of(model, operation, id.direction);
            (format!("{name}.{side}"), schema)
        })?;
        self.write(channel, time, text.as_bytes())?;
        let Ok(body) = &message.body else {
            return Ok(());
        };
        for picture in picture::pictures(body) {
            let topic = format!("/{name}/picture");
            let channel = self.channel(&topic, |_| {
                ("foxglove.CompressedImage".to_owned(), picture::image())
            })?;
            let image = json!({
                "timestamp": stamp(time),
                "frame_id": name,
                "data": picture.base64(),
                "format": picture.format,
            });
            self.write(channel, time, image.to_string().as_bytes())?;
        }
        Ok(())
    }

    /// Returns the channel for the frames of a direction of a connection, and creates it at its first use.
    fn frames(&mut self, flow: Option<Flow>) -> McapResult<u16> {
        let has_room = self.frames.len() < 2 * CONNECTIONS;
        let flow = flow.filter(|flow| has_room || self.frames.contains_key(&Some(*flow)));
        if let Some(channel) = self.frames.get(&flow) {
            return Ok(*channel);
        }
        let addresses = flow.map(|Flow { from, to }| [(FROM, from), (TO, to)]);
        let addresses = addresses.into_iter().flatten();
        let metadata = addresses.map(|(key, address)| (key.to_owned(), address.to_string()));
        let channel =
            self.writer
                .add_channel(0, FRAMES, "application/octet-stream", &metadata.collect())?;
        self.frames.insert(flow, channel);
        Ok(channel)
    }

    /// Returns the channel with a topic, and creates it with its schema at its first use.
    fn channel(
        &mut self,
        topic: &str,
        schema: impl FnOnce(&Model) -> (String, Value),
    ) -> McapResult<u16> {
        if let Some(channel) = self.channels.get(topic) {
            return Ok(*channel);
        }
        let (name, schema) = schema(self.model);
        let schema = schema.to_string();
        let schema = (self.writer).add_schema(&name, "jsonschema", schema.as_bytes())?;
        let none = BTreeMap::new();
        let channel = self.writer.add_channel(schema, topic, "json", &none)?;
        self.channels.insert(topic.to_owned(), channel);
        Ok(channel)
    }

    fn write(&mut self, channel_id: u16, time: Duration, data: &[u8]) -> McapResult<()> {
        let nanoseconds = u64::try_from(time.as_nanos()).unwrap_or(u64::MAX);
        let header = MessageHeader {
            channel_id,
            sequence: self.sequence,
            log_time: nanoseconds,
            publish_time: nanoseconds,
        };
        self.sequence = self.sequence.wrapping_add(1);
        self.writer.write_to_known_channel(&header, data)
    }

    /// Ends the recording with its index.
    ///
    /// # Errors
    /// Writing fails.
    pub fn finish(mut self) -> McapResult<()> {
        self.writer.finish().map(|_| ())
    }
}

/// Returns a time as viewers read it.
fn stamp(time: Duration) -> Value {
    json!({ "sec": time.as_secs(), "nsec": time.subsec_nanos() })
}
