//! Reads and writes frames and bodies of any protocol at run time.
//!
//! A generated package knows one spec at compile time. This crate takes any spec that [`fc_spec`] has loaded. It reads
//! frames into named and described values with their positions, and builds frames from JSON. It behaves like the
//! generated packages: it accepts the same input, writes the same bytes, and reports errors with the same names and
//! paths.
//!
//! ```text
//! bytes ──frame──► Frame: header fields, operation, data ──message──► Message: envelope and body as trees of Nodes
//! JSON ──message──► Message ──canonical──► text ──seal──► bytes
//! examples of the spec ──samples──► JSON; a request's Frame ──answer──► bytes
//! ```
//!
//! ```
//! # use fc_spec::{diagnostic::Faults, load::load, source::Sources};
//! # let files = [
//! #     ("spec/protocol.yaml", include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/small/protocol.yaml"))),
//! #     ("spec/commands/lamp.yaml", include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/small/commands/lamp.yaml"))),
//! # ];
//! # let sources = Sources::from_texts(files.map(|(path, text)| (path.to_owned(), text.to_owned())));
//! # let model = load(&sources, &mut Faults::new()).model().expect("a model");
//! use fc_reflect::{Direction, Packing, Reflector, walk};
//!
//! let reflector = Reflector::new(&model);
//! let operation = model.operation("dimmed").expect("the spec has it");
//! let id = reflector.id(operation, Direction::Request, 7).expect("it has a code");
//! let bytes = reflector.encode(id, br#"{"at":1,"lux":2,"new":[]}"#, Packing::Plain)?;
//!
//! let message = reflector.decode(&bytes)?.message.expect("not a stream");
//! let mut shown = Vec::new();
//! walk(&message.body.clone()?, &mut |path, node| {
//!     let text = node.text().map_or("unknown", |text| &text.en);
//!     shown.push(format!("{path} at {:?}: {text}", node.span));
//! });
//! assert_eq!(shown, ["lux at 14..17: Illuminance", "new at 24..26: unknown"]);
//! assert_eq!(message.canonical()?, r#"{"at":1,"lux":2.0,"new":[]}"#);
//!
//! // Without a robot, the example of the spec or any of its results is the response.
//! let answer = reflector.answer(&reflector.frame(&bytes)?, None, Packing::Plain).expect("a report")?;
//! let answer = reflector.frame(&answer)?;
//! assert_eq!(answer.id, id.answer());
//! assert_eq!(answer.data, r#"{"at":1700000000000,"rc":0,"say":"好"}"#.as_bytes());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! **Architecture invariant.** This crate does no I/O and contains no fact about a protocol, because all facts come
//! from the model. Errors have the names of [`FrameFault`] and [`BodyErrorKind`]. [`Limits`] bound all memory.

mod constraint;
mod error;
mod frame;
mod id;
mod limits;
mod message;
mod plan;
mod read;
pub mod sample;
mod tree;
mod write;

pub use error::{Error, FrameError, FrameFault};
pub use fc_runtime::json::{BodyError, BodyErrorKind};
pub use fc_spec::model::Direction;
pub use frame::{Frame, HeaderContent, HeaderValue, Packing};
pub use id::FrameId;
pub use limits::Limits;
pub use message::Message;
pub use tree::{About, Key, Leniency, Node, Value, walk};

use fc_spec::model::{EncodingRole, HeaderRole, Kind, Model, Operation, ResultCode, ResultRole};
use plan::Plan;
use sample::Samples;

/// Reads and writes the frames and bodies of a protocol.
pub struct Reflector<'m> {
    plan: Plan<'m>,
    samples: Samples<'m>,
    limits: Limits,
}

impl<'m> Reflector<'m> {
    /// Prepares a model.
    #[must_use]
    pub fn new(model: &'m Model) -> Self {
        Self {
            plan: Plan::new(model),
            samples: Samples::new(model),
            limits: Limits::of(model),
        }
    }

    /// Sets the limits of a frame and its body.
    #[must_use]
    pub fn limits(mut self, limits: Limits) -> Self {
        self.limits = limits;
        self
    }

    /// Reads the frame at the start of `bytes` and its body. Both must be valid. For the parts of an invalid frame,
    /// call [`frame`](Self::frame) and [`message`](Self::message).
    ///
    /// # Errors
    /// The error in the frame, the envelope or the body.
    pub fn decode(&self, bytes: &[u8]) -> Result<Decoded<'m>, Error> {
        let frame = self.frame(bytes)?;
        if !frame.is_json() {
            return Ok(Decoded {
                frame,
                message: None,
            });
        }
        let id = frame.id;
        let fault = |error| Error::Body { frame: id, error };
        let message = self.message(frame.operation, id.direction, &frame.data);
        let message = message.map_err(fault)?;
        if let Err(error) = message.body {
            return Err(fault(error));
        }
        Ok(Decoded {
            frame,
            message: Some(message),
        })
    }

    /// Reads the frame at the start of `bytes`. Ignores the bytes after it.
    ///
    /// # Errors
    /// The error in the frame.
    pub fn frame(&self, bytes: &[u8]) -> Result<Frame<'m>, FrameError> {
        frame::read(&self.plan, &self.limits, bytes)
    }

    /// Returns the length of the frame that begins at the start of `bytes`, or `None` while too few bytes show it. The
    /// frame itself may be incomplete.
    ///
    /// # Errors
    /// `bad_head`, `frame_too_long` or `short_frame`, as soon as the bytes show it.
    pub fn length(&self, bytes: &[u8]) -> Result<Option<usize>, FrameError> {
        let announced = frame::announced(&self.plan.frame, &self.limits, bytes)?;
        Ok(announced.map(|(length, _)| length))
    }

    /// Returns the header fields at the start of `bytes`, without any check. It ends before the first field whose bytes
    /// are missing. Tools show the header of an invalid frame with it.
    #[must_use]
    pub fn header(&self, bytes: &[u8]) -> Vec<HeaderValue<'m>> {
        frame::header(&self.plan.frame, bytes)
    }

    /// Reads the text of a message of one side of an operation. Empty text counts as `{}`. Without an operation, all
    /// keys outside the envelope are unknown. A stream has no envelope.
    ///
    /// # Errors
    /// The error that prevents reading the envelope. The message contains an error of the body.
    pub fn message(
        &self,
        operation: Option<&Operation>,
        direction: Direction,
        text: &[u8],
    ) -> Result<Message<'m>, BodyError> {
        let is_response = direction == Direction::Response;
        let operation = operation.and_then(|operation| self.plan.named(&operation.name));
        let own = operation.map_or(&[][..], |operation| self.plan.body(operation, is_response));
        let is_stream = operation.is_some_and(|plan| plan.operation.kind() == Kind::Stream);
        let envelope = if is_stream {
            &[]
        } else {
            self.plan.envelope(is_response)
        };
        read::message(&self.plan, envelope, own, text, &self.limits)
    }

    /// Returns the operation of a frame, or `None` if the spec has none with this kind and code.
    #[must_use]
    pub fn operation(&self, id: FrameId) -> Option<&'m Operation> {
        let plan = self.plan.with_code(id.kind, id.code)?;
        Some(plan.operation)
    }

    /// Returns the header fields for a message of an operation, or `None` while the operation has no code. `id` is cut
    /// to the low bits that fit its field.
    #[must_use]
    pub fn id(&self, operation: &Operation, direction: Direction, id: u32) -> Option<FrameId> {
        let (kind, code) = self.plan.named(&operation.name)?.place()?;
        let width = self.plan.frame.layout.field(HeaderRole::Id)?.ty.size();
        let unused = 32_u32.saturating_sub(8 * u32::try_from(width).unwrap_or(4));
        Some(FrameId {
            direction,
            kind,
            code,
            id: id << unused >> unused,
        })
    }

    /// Builds a frame from the text of a JSON object with wire keys, including those of the envelope.
    /// [`message`](Self::message) reads the object, and the frame contains its canonical form. The data of a stream is
    /// sent unchanged, unless the spec defines its keys.
    ///
    /// # Errors
    /// The error that a receiver would report for the body, or `frame_too_long`.
    pub fn encode(&self, id: FrameId, data: &[u8], packing: Packing) -> Result<Vec<u8>, Error> {
        let operation = self.operation(id);
        let is_json = operation.is_some_and(|operation| operation.body(id.direction).is_some());
        if self.plan.frame.is_stream(id.kind) && !is_json {
            return Ok(self.seal(id, data, packing)?);
        }
        let fault = |error| Error::Body { frame: id, error };
        let message = self.message(operation, id.direction, data).map_err(fault)?;
        let text = message.canonical().map_err(fault)?;
        Ok(self.seal(id, text.as_bytes(), packing)?)
    }

    /// Builds a frame around any data, with header, lengths and digest.
    ///
    /// # Errors
    /// `frame_too_long`.
    pub fn seal(&self, id: FrameId, data: &[u8], packing: Packing) -> Result<Vec<u8>, FrameError> {
        frame::write(&self.plan.frame, &self.limits, id, data, packing)
    }

    /// Puts a header with this encoding and plain length before `sent`. It checks nothing, so that tests of receivers
    /// can build invalid frames.
    #[must_use]
    pub fn seal_as_sent(
        &self,
        id: FrameId,
        encoding: EncodingRole,
        sent: &[u8],
        plain_length: usize,
    ) -> Vec<u8> {
        frame::around(&self.plan.frame, id, encoding, sent, plain_length)
    }

    /// Overwrites the integer in the header field with this role, if the field exists. The value is cut to its low
    /// bytes. Tests of receivers build invalid frames with it.
    pub fn overwrite(&self, frame: &mut [u8], role: HeaderRole, value: u64) {
        frame::overwrite(&self.plan.frame, frame, role, value);
    }

    /// Returns the model.
    #[must_use]
    pub fn model(&self) -> &'m Model {
        self.samples.model()
    }

    /// Returns the samples, which compose messages from the examples of the model.
    #[must_use]
    pub fn samples(&self) -> &Samples<'m> {
        &self.samples
    }

    /// Returns a frame with the example of one side of an operation, or `None` while the operation has no code.
    ///
    /// # Errors
    /// `frame_too_long` if the limits are too small for the example.
    #[must_use]
    pub fn sample(
        &self,
        operation: &Operation,
        direction: Direction,
        id: u32,
        packing: Packing,
    ) -> Option<Result<Vec<u8>, FrameError>> {
        let id = self.id(operation, direction, id)?;
        Some(self.seal(id, &self.samples.data(operation, direction), packing))
    }

    /// Returns the frame that answers a request with the same id: a response to a command, or an acknowledgement of a
    /// report. Without a `result`, the answer is the example of the operation. With a refusal, it is the envelope
    /// alone.
    ///
    /// Returns `None` for a response or a stream, and without a `result` for an unknown code. Also returns `None` for a
    /// refusal if the envelope has no result code.
    ///
    /// # Errors
    /// The same as [`sample`](Self::sample).
    #[must_use]
    pub fn answer(
        &self,
        request: &Frame<'_>,
        result: Option<&ResultCode>,
        packing: Packing,
    ) -> Option<Result<Vec<u8>, FrameError>> {
        if request.id.direction == Direction::Response || request.is_stream() {
            return None;
        }
        let is_refusal = result.is_some_and(|result| result.role != Some(ResultRole::Success));
        if is_refusal && self.samples.model().envelope.result_code().is_none() {
            return None;
        }
        let data = match (request.operation, result) {
            (operation, Some(result)) => {
                self.samples.response(operation, result).to_string().into()
            }
            (Some(operation), None) => self.samples.data(operation, Direction::Response),
            (None, None) => return None,
        };
        Some(self.seal(request.id.answer(), &data, packing))
    }
}

/// A frame and its message.
#[derive(Clone, Debug)]
pub struct Decoded<'m> {
    /// The frame.
    pub frame: Frame<'m>,
    /// The message, or `None` for a stream without JSON. [`Frame::data`] has its bytes.
    pub message: Option<Message<'m>>,
}

/// Compiles the examples of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
