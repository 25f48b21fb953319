//! Messages whose type is not known: what a code without a type, a log or a proxy works with.

use crate::json::{Allowance, BodyError, Json, MAX_DEPTH};
use crate::message::{Empty, Message, read_enveloped};
#[cfg(feature = "net")]
use crate::protocol::ResponseEnvelope as _;
use crate::protocol::{Command, DeclaredError, Protocol, ResultText};
use std::fmt;

/// A refusal: the result code and text that a handler answers with, or that a peer has answered
/// with.
///
/// Make one with [`Refusal::new`], or from one of the protocol's result codes or of the command's declared errors.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Refusal {
    /// Result code; not the one of success.
    pub code: i64,
    /// Text for people. Never rely on it.
    pub text: String,
}

impl Refusal {
    /// A refusal with this result code and text.
    #[must_use]
    pub fn new(code: impl Into<i64>, text: impl Into<String>) -> Self {
        Self {
            code: code.into(),
            text: text.into(),
        }
    }

    /// Which of the errors that the command declares it is; `None` for any other result.
    #[must_use]
    pub fn declared<C: Command>(&self) -> Option<C::Error> {
        C::Error::of(self.code)
    }

    /// What a response says has gone wrong, if it says so.
    #[cfg(feature = "net")]
    pub(crate) fn of<P: Protocol>(response: &P::Response) -> Option<Self> {
        let code = response.result_code()?;
        (code != P::RESULTS.success.code).then(|| Self::new(code, response.result_text()))
    }

    /// The request breaks a rule that no constraint of the spec states.
    #[must_use]
    pub fn invalid<P: Protocol>(why: impl fmt::Display) -> Self {
        Self::with(P::RESULTS.invalid, why)
    }

    /// The command is not served.
    #[must_use]
    pub fn unknown<P: Protocol>() -> Self {
        P::RESULTS.protocol.into()
    }

    /// The spec has the command, but this robot does not carry it out.
    #[cfg(feature = "server")]
    pub(crate) fn not_implemented<P: Protocol>() -> Self {
        Self::with(P::RESULTS.protocol, "not implemented")
    }

    /// What it takes to answer did not come in time.
    #[must_use]
    pub fn timeout<P: Protocol>() -> Self {
        P::RESULTS.timeout.into()
    }

    /// The handler has panicked; how far it had come is not known.
    #[cfg(feature = "server")]
    pub(crate) fn panicked<P: Protocol>() -> Self {
        Self::with(P::RESULTS.protocol, "the handler panicked")
    }

    /// Too many handlers of this kind are at work; nothing has been done.
    #[cfg(feature = "server")]
    pub(crate) fn too_many<P: Protocol>() -> Self {
        Self::with(P::RESULTS.protocol, "too many handlers are still at work")
    }

    /// Nobody may call this from the app's address.
    #[cfg(feature = "server")]
    pub(crate) fn forbidden<P: Protocol>() -> Self {
        Self::with(P::RESULTS.protocol, "not allowed from this address")
    }

    fn with(result: ResultText, why: impl fmt::Display) -> Self {
        Self {
            code: result.code,
            text: format!("{}: {why}", result.text),
        }
    }
}

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "refused with result {}: {}", self.code, self.text)
    }
}

impl std::error::Error for Refusal {}

impl From<ResultText> for Refusal {
    fn from(result: ResultText) -> Self {
        Self::new(result.code, result.text)
    }
}

impl<E: DeclaredError> From<E> for Refusal {
    fn from(error: E) -> Self {
        error.result().into()
    }
}

/// A report as received.
///
/// Shows no text in its `Debug` form: bodies may hold what must not be logged.
#[derive(Clone, PartialEq, Eq)]
pub struct RawReport {
    /// Command code.
    pub code: u16,
    /// Message id.
    pub id: u32,
    /// The whole JSON text, envelope included.
    pub text: Vec<u8>,
}

impl RawReport {
    /// Reads it as a typed report. What a connection hands over has been checked before, to the
    /// depth of nesting that is configured there, and reads as what its code says.
    ///
    /// # Errors
    ///
    /// What is wrong with the text, or with an own key of `R`.
    pub fn read<P: Protocol, R: Message>(&self) -> Result<R, BodyError> {
        read_enveloped::<P::Request, R>(&self.text, Self::allowance::<P>())?.body
    }

    /// What reading it may cost: the protocol's default, and any depth that its connection allowed.
    pub(crate) fn allowance<P: Protocol>() -> Allowance {
        Allowance {
            depth: MAX_DEPTH,
            ..P::DEFAULTS.limits.json()
        }
    }

    /// Reads its envelope alone.
    ///
    /// # Errors
    ///
    /// What is wrong with the text, or with a key of the envelope.
    pub fn envelope<P: Protocol>(&self) -> Result<P::Request, BodyError> {
        let enveloped = read_enveloped::<P::Request, Empty>(&self.text, Self::allowance::<P>())?;
        Ok(enveloped.envelope)
    }
}

impl fmt::Debug for RawReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("RawReport")
            .field("code", &format_args!("0x{:04X}", self.code))
            .field("id", &self.id)
            .field("bytes", &self.text.len())
            .finish()
    }
}

/// A response as received.
#[derive(Clone, PartialEq)]
pub struct RawResponse<P: Protocol> {
    /// The keys of the envelope.
    pub envelope: P::Response,
    /// The whole JSON text, envelope included.
    pub text: Vec<u8>,
}

impl<P: Protocol> fmt::Debug for RawResponse<P> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        use crate::protocol::ResponseEnvelope;
        f.debug_struct("RawResponse")
            .field("result_code", &self.envelope.result_code())
            .field("bytes", &self.text.len())
            .finish_non_exhaustive()
    }
}

/// A request as received, but known to be a JSON object.
#[derive(Clone, PartialEq)]
pub struct RawRequest {
    /// Command code.
    pub code: u16,
    /// The whole JSON text, envelope included.
    pub text: Json,
}

impl fmt::Debug for RawRequest {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("RawRequest")
            .field("code", &format_args!("0x{:04X}", self.code))
            .field("bytes", &self.text.as_str().len())
            .finish()
    }
}

/// The answer to a [`RawRequest`]: a JSON object of the response's own keys.
///
/// A key of the envelope in it, such as the result code that it was given elsewhere, is sent as it is;
/// the envelope of success supplies those that it lacks. What is then no response is answered with the
/// protocol's own refusal, and logged.
#[derive(Clone, PartialEq)]
pub struct RawAnswer(pub Json);

impl fmt::Debug for RawAnswer {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "RawAnswer({} bytes)", self.0.as_str().len())
    }
}
