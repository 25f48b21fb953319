//! Reads recorded bytes and describes each frame in them.
//!
//! ```text
//! file ──input──► bytes of each direction ──scan──► pieces ──Decoder──► Records ──text, json──► output
//! ```

mod error_text;
mod filter;
mod hex;
mod input;
mod json;
mod pair;
mod scan;
mod source;
mod text;

pub use error_text::text as error_text;
pub use filter::Filter;
pub use input::Format;
pub use json::line as json;
pub(crate) use json::milliseconds;
pub use pair::Request;
pub use source::{DecodeError, Source, read};
pub(crate) use text::{clipped, clock, scalar, side};
pub use text::{hex, line, tree as text};

use crate::answer::result_code;
use crate::capture::Flow;
use fc_reflect::{Error, Frame, FrameFault, FrameId, HeaderValue, Message, Reflector};
use fc_spec::model::{FrameKind, Operation};
use scan::{Piece, Scanner};
use std::collections::HashMap;
use std::time::Duration;

/// Directions of connections that are read at the same time.
const FLOWS: usize = 2048;

/// The bytes of all incomplete frames together, in frames of the longest kind.
const INCOMPLETE_FRAMES: usize = 4;

/// A frame or damaged bytes, with all that the spec tells about them.
#[derive(Debug)]
pub struct Record<'m> {
    /// The direction of a connection, or `None` if the input has no connections.
    pub flow: Option<Flow>,
    /// The time since 1970, or since midnight if the input has no dates.
    pub time: Option<Duration>,
    /// The position of the first byte in the input, or in its direction of the connection.
    pub offset: u64,
    /// The number of bytes. Damaged bytes end at the next frame.
    pub length: u64,
    /// The bytes of the frame. Of damaged bytes, only as many as a header has.
    pub bytes: Vec<u8>,
    /// The identity of the frame, as far as its header shows it.
    pub id: Option<FrameId>,
    /// The kind of the frame, or `None` if the spec has none with this value.
    pub kind: Option<&'m FrameKind>,
    /// The operation, or `None` if the spec has none with this code.
    pub operation: Option<&'m Operation>,
    /// The fields of the header. Their positions are relative to `offset`.
    pub header: Vec<HeaderValue<'m>>,
    /// The frame, or `None` if it is invalid.
    pub frame: Option<Frame<'m>>,
    /// The message, or `None` for an invalid frame, an unreadable envelope or a stream without JSON.
    pub message: Option<Message<'m>>,
    /// The error, or `None` if the frame and its body are valid. The first failed check determines it.
    pub error: Option<Error>,
    /// The request, if this is its response.
    pub request: Option<Request>,
}

impl Record<'_> {
    /// Returns the result of a response, if its envelope has one.
    #[must_use]
    pub fn result(&self) -> Option<i64> {
        result_code(self.message.as_ref()?)
    }
}

/// The state of a flow.
struct State<'r, 'm> {
    scanner: Scanner<'r, 'm>,
    /// The time of the last bytes.
    time: Option<Duration>,
}

/// Describes the frames of all connections of an input. Memory is bounded.
pub struct Decoder<'r, 'm> {
    reflector: &'r Reflector<'m>,
    flows: HashMap<Option<Flow>, State<'r, 'm>>,
    pairs: pair::Pairs,
    /// The limit for the bytes of all incomplete frames.
    room: usize,
}

impl<'r, 'm> Decoder<'r, 'm> {
    /// Creates a decoder.
    #[must_use]
    pub fn new(reflector: &'r Reflector<'m>) -> Self {
        let longest = usize::try_from(reflector.model().limits.frame_bytes).unwrap_or(usize::MAX);
        Self {
            reflector,
            flows: HashMap::new(),
            pairs: pair::Pairs::default(),
            room: longest.saturating_mul(INCOMPLETE_FRAMES),
        }
    }

    /// Returns the bytes of memory that the buffers of all flows take.
    #[must_use]
    pub fn memory(&self) -> usize {
        let memory = |state: &State<'_, '_>| state.scanner.memory();
        self.flows.values().map(memory).sum()
    }

    /// Reads the next bytes of a flow. `sink` receives each record.
    ///
    /// # Errors
    /// The error of `sink`.
    pub fn push<E>(
        &mut self,
        flow: Option<Flow>,
        time: Option<Duration>,
        bytes: &[u8],
        sink: &mut dyn FnMut(&Record<'m>) -> Result<(), E>,
    ) -> Result<(), E> {
        let reflector = self.reflector;
        let state = self.flows.entry(flow).or_insert_with(|| State {
            scanner: Scanner::new(reflector),
            time,
        });
        state.time = time;
        state.scanner.push(bytes);
        while let Some(piece) = state.scanner.next_piece(false) {
            sink(&record(reflector, &mut self.pairs, flow, time, piece))?;
        }
        state.scanner.release();
        self.shed(sink)
    }

    /// Ends the incomplete frame of a flow whose next bytes are missing in the input.
    ///
    /// # Errors
    /// The error of `sink`.
    pub fn skip<E>(
        &mut self,
        flow: Option<Flow>,
        missing: u64,
        sink: &mut dyn FnMut(&Record<'m>) -> Result<(), E>,
    ) -> Result<(), E> {
        self.finish_flow(flow, sink)?;
        if let Some(state) = self.flows.get_mut(&flow) {
            state.scanner.skip(missing);
        }
        Ok(())
    }

    /// Ends a flow.
    ///
    /// # Errors
    /// The error of `sink`.
    pub fn close<E>(
        &mut self,
        flow: Option<Flow>,
        sink: &mut dyn FnMut(&Record<'m>) -> Result<(), E>,
    ) -> Result<(), E> {
        self.finish_flow(flow, sink)?;
        self.flows.remove(&flow);
        Ok(())
    }

    /// Ends all flows.
    ///
    /// # Errors
    /// The error of `sink`.
    pub fn finish<E>(
        &mut self,
        sink: &mut dyn FnMut(&Record<'m>) -> Result<(), E>,
    ) -> Result<(), E> {
        let mut flows: Vec<_> = self.flows.keys().copied().collect();
        flows.sort_by_key(|flow| flow.map(|flow| (flow.from, flow.to)));
        for flow in flows {
            self.close(flow, sink)?;
        }
        Ok(())
    }

    fn finish_flow<E>(
        &mut self,
        flow: Option<Flow>,
        sink: &mut dyn FnMut(&Record<'m>) -> Result<(), E>,
    ) -> Result<(), E> {
        let Some(State { scanner, time }) = self.flows.get_mut(&flow) else {
            return Ok(());
        };
        while let Some(piece) = scanner.next_piece(true) {
            sink(&record(self.reflector, &mut self.pairs, flow, *time, piece))?;
        }
        scanner.release();
        Ok(())
    }

    /// Ends the flow with the longest incomplete frame if all flows together exceed a limit.
    fn shed<E>(&mut self, sink: &mut dyn FnMut(&Record<'m>) -> Result<(), E>) -> Result<(), E> {
        // Most inputs have few connections, so counting is cheap.
        let kept = |state: &State<'_, '_>| state.scanner.kept();
        let all: usize = self.flows.values().map(kept).sum();
        let (is_full, is_crowded) = (all > self.room, self.flows.len() > FLOWS);
        let longest = self.flows.iter().max_by_key(|(_, state)| kept(state));
        let Some((&flow, _)) = longest else {
            return Ok(());
        };
        if is_crowded {
            self.close(flow, sink)?;
        } else if is_full {
            self.finish_flow(flow, sink)?;
        }
        Ok(())
    }
}

/// Describes a piece.
fn record<'m>(
    reflector: &Reflector<'m>,
    pairs: &mut pair::Pairs,
    flow: Option<Flow>,
    time: Option<Duration>,
    piece: Piece<'_, 'm>,
) -> Record<'m> {
    let mut record = Record {
        flow,
        time,
        offset: piece.offset,
        length: piece.length,
        bytes: piece.bytes.to_vec(),
        id: None,
        kind: None,
        operation: None,
        header: Vec::new(),
        frame: None,
        message: None,
        error: None,
        request: None,
    };
    match piece.frame {
        Ok(frame) => {
            record.id = Some(frame.id);
            record.kind = Some(frame.kind);
            record.operation = frame.operation;
            record.header.clone_from(&frame.header);
            record.request = pairs.pair(flow, frame.id, piece.offset, time);
            if frame.is_json() {
                let message = reflector.message(frame.operation, frame.id.direction, &frame.data);
                let error = match &message {
                    Ok(message) => message.body.as_ref().err(),
                    Err(error) => Some(error),
                };
                record.error = error.map(|error| Error::Body {
                    frame: frame.id,
                    error: error.clone(),
                });
                record.message = message.ok();
            }
            record.frame = Some(frame);
        }
        Err(error) => {
            record.id = error.frame;
            let kinds = &reflector.model().frame.kinds;
            record.kind = error.frame.and_then(|id| kinds.with_value(id.kind));
            if error.fault != FrameFault::BadHead {
                record.header = reflector.header(&piece.bytes);
            }
            record.operation = error.frame.and_then(|id| reflector.operation(id));
            record.error = Some(Error::Frame(error));
        }
    }
    record
}
