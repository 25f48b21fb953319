//! Messages whose type is unknown, for codes without a type, logs and proxies.

use crate::json::{Allowance, BodyError, Json, MAX_DEPTH};
use crate::message::{Empty, Message, read_enveloped};
use crate::protocol::{Protocol, ResponseEnvelope as _};
use std::fmt;

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
