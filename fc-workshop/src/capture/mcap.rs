//! Reads the frames of recordings in MCAP.

use super::Flow;
use mcap::records::{Channel, Record};
use mcap::sans_io::linear_reader::{LinearReadEvent, LinearReader, LinearReaderOptions};
use mcap::{McapError, parse_record};
use std::collections::HashMap;
use std::io::{self, BufReader, Read};
use std::time::Duration;
use thiserror::Error;

/// The topic of the frames. It has a channel for each direction of a connection.
pub const FRAMES: &str = "/fc/frames";

/// The metadata of such a channel with the address of the sender.
pub const FROM: &str = "from";

/// The metadata of such a channel with the address of the receiver.
pub const TO: &str = "to";

/// The bytes that are read at a time.
const BUFFER: usize = 64 << 10;

/// The maximum size of a record. The spec is an attachment, and a picture is base64 in JSON.
const LARGEST: usize = 256 << 20;

/// The reason why reading a recording ended early.
#[derive(Debug, Error)]
pub enum ReadError {
    /// The input cannot be read.
    #[error("cannot read the input: {0}")]
    Input(io::Error),
    /// The recording ends inside a record.
    #[error("the recording ends early")]
    Cut,
    /// A chunk is compressed.
    #[error("the recording is compressed with {0}")]
    Compressed(String),
    /// The bytes are no recording.
    #[error("the recording is damaged: {0}")]
    Damaged(McapError),
    /// The receiver has failed.
    #[error(transparent)]
    Receiver(io::Error),
}

impl From<McapError> for ReadError {
    fn from(error: McapError) -> Self {
        match error {
            McapError::UnexpectedEof | McapError::UnexpectedEoc => Self::Cut,
            McapError::UnsupportedCompression(name) => Self::Compressed(name),
            error => Self::Damaged(error),
        }
    }
}

/// Receives a frame, with its direction of a connection and its time if the recording has them.
pub type Receiver<'r> = dyn FnMut(Option<Flow>, Option<Duration>, &[u8]) -> io::Result<()> + 'r;

/// Passes each frame to `receiver`.
///
/// # Errors
/// The reason why reading ended early. All frames before it are passed on.
pub fn read(input: impl Read, receiver: &mut Receiver<'_>) -> Result<(), ReadError> {
    let options = LinearReaderOptions::default()
        .with_validate_chunk_crcs(true)
        .with_record_length_limit(LARGEST);
    let mut reader = LinearReader::new_with_options(options);
    let mut input = BufReader::with_capacity(BUFFER, input);
    let mut flows = HashMap::new();
    while let Some(event) = reader.next_event() {
        match event? {
            LinearReadEvent::ReadRequest(size) => {
                let count = match input.read(reader.insert(size)) {
                    Err(error) if error.kind() == io::ErrorKind::Interrupted => continue,
                    read => read.map_err(ReadError::Input)?,
                };
                reader.notify_read(count);
            }
            LinearReadEvent::Record { data, opcode } => match parse_record(opcode, data)? {
                Record::Channel(channel) if channel.topic == FRAMES => {
                    flows.insert(channel.id, flow(&channel));
                }
                Record::Message { header, data } => {
                    if let Some(flow) = flows.get(&header.channel_id) {
                        let time = Duration::from_nanos(header.log_time);
                        let time = Some(time).filter(|time| !time.is_zero());
                        receiver(*flow, time, &data).map_err(ReadError::Receiver)?;
                    }
                }
                _ => {}
            },
        }
    }
    Ok(())
}

/// Returns the direction of the connection that a channel records.
fn flow(channel: &Channel) -> Option<Flow> {
    let address = |key| channel.metadata.get(key)?.parse().ok();
    Some(Flow {
        from: address(FROM)?,
        to: address(TO)?,
    })
}
