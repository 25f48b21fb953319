//! Frames and bodies by the model of a protocol, at run time.
//!
//! The generated packages know one spec when they are compiled. This crate knows any spec that [`fc_spec`] has loaded,
//! also one read a second ago: it takes frames apart into named, described values with their places, and makes frames
//! of JSON. What it accepts, what it refuses, the names and paths of errors and the bytes it writes are those of the
//! generated packages.
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
//! // What nobody is there to answer is answered with the example of the spec, or with any of its results.
//! let answer = reflector.answer(&reflector.frame(&bytes)?, None, Packing::Plain).expect("a report")?;
//! let answer = reflector.frame(&answer)?;
//! assert_eq!(answer.id, id.answer());
//! assert_eq!(answer.data, r#"{"at":1700000000000,"rc":0,"say":"好"}"#.as_bytes());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! **Architecture invariant.** No I/O, and no fact of any protocol: all comes from the model. Errors come with the
//! names of [`FrameFault`] and [`BodyErrorKind`]; nothing grows without a limit ([`Limits`]).

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

    /// Sets what a frame and its body may cost.
    #[must_use]
    pub fn limits(mut self, limits: Limits) -> Self {
        self.limits = limits;
        self
    }

    /// Takes the frame apart that `bytes` begin with, and reads its body. All of it must be right; to see the parts of
    /// what is not, ask for the [frame](Self::frame) and the [message](Self::message) one by one.
    ///
    /// # Errors
    /// What is wrong with the frame, with the envelope or with the body.
    pub fn decode(&self, bytes: &[u8]) -> Result<Decoded<'m>, Error> {
        let frame = self.frame(bytes)?;
        if is_bytes(&frame) {
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

    /// Takes the frame apart that `bytes` begin with. What comes behind it is not looked at.
    ///
    /// # Errors
    /// What is wrong with the frame.
    pub fn frame(&self, bytes: &[u8]) -> Result<Frame<'m>, FrameError> {
        frame::read(&self.plan, &self.limits, bytes)
    }

    /// Reads the text of a message of one side of an operation. No bytes are read as `{}`. Where there is no operation,
    /// the envelope is read and all other keys are unknown. What a stream carries has no envelope.
    ///
    /// # Errors
    /// What keeps even the envelope from being read. What is wrong with the body is in the message.
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

    /// What the header of a message of an operation says, of `id` as many of the low bits as it has room for; `None`
    /// while the operation has no code.
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

    /// Makes a frame of a JSON object of wire keys, those of the envelope included, such as the text of a
    /// [`fc_spec::model::Value`]: read as [`message`](Self::message) reads it, and written in canonical form. What
    /// a stream carries is sent as it is, unless the spec has its keys.
    ///
    /// # Errors
    /// What is wrong with the body: what a receiver would refuse is not sent; `frame_too_long`.
    pub fn encode(&self, id: FrameId, data: &[u8], packing: Packing) -> Result<Vec<u8>, Error> {
        let operation = self.plan.with_code(id.kind, id.code);
        let operation = operation.map(|plan| plan.operation);
        let is_json = operation.is_some_and(|operation| operation.body(id.direction).is_some());
        if self.plan.frame.is_stream(id.kind) && !is_json {
            return Ok(self.seal(id, data, packing)?);
        }
        let fault = |error| Error::Body { frame: id, error };
        let message = self.message(operation, id.direction, data).map_err(fault)?;
        let text = message.canonical().map_err(fault)?;
        Ok(self.seal(id, text.as_bytes(), packing)?)
    }

    /// Makes a frame around data as it is, whatever it holds: header, lengths and digest.
    ///
    /// # Errors
    /// `frame_too_long`.
    pub fn seal(&self, id: FrameId, data: &[u8], packing: Packing) -> Result<Vec<u8>, FrameError> {
        frame::write(&self.plan.frame, &self.limits, id, data, packing)
    }

    /// Puts a header before data that is packed already, or only said to be, and whose plain length is only said to be
    /// this. For tests of receivers: nothing is checked.
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

    /// Overwrites the integer in the header field with this role, if there is one, by its low bytes. For tests of
    /// receivers: the frame may be wrong then.
    pub fn overwrite(&self, frame: &mut [u8], role: HeaderRole, value: u64) {
        frame::overwrite(&self.plan.frame, frame, role, value);
    }

    /// The model.
    #[must_use]
    pub fn model(&self) -> &'m Model {
        self.samples.model()
    }

    /// Composes messages from the examples of the model.
    #[must_use]
    pub fn samples(&self) -> &Samples<'m> {
        &self.samples
    }

    /// A frame of the example of one side of an operation; `None` while it has no code.
    ///
    /// # Errors
    /// `frame_too_long`, where the limits are too narrow for the example.
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

    /// A frame that answers a request, with the same id: the response to a command, the acknowledgement of a report.
    /// Without a `result` it is the example of the operation; with a refusal, the envelope alone. `None` of
    /// what is not answered: a response, a stream, without a `result` a code that the spec does not have, and a
    /// refusal where no response says how it went.
    ///
    /// # Errors
    /// As of [`sample`](Self::sample).
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

/// Whether it is of a stream, and the model does not say more of its bytes.
fn is_bytes(frame: &Frame<'_>) -> bool {
    let body = frame.operation.and_then(|it| it.body(frame.id.direction));
    frame.is_stream() && body.is_none()
}

/// A frame and what it carries.
#[derive(Clone, Debug)]
pub struct Decoded<'m> {
    /// The frame.
    pub frame: Frame<'m>,
    /// The message in it; `None` of a stream that is not JSON: its bytes are [`Frame::data`].
    pub message: Option<Message<'m>>,
}

/// Its examples compile.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
