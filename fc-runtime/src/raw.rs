//! Messages whose type is unknown, for codes without a type, logs and proxies.

use crate::json::{Allowance, BodyError, Json, MAX_DEPTH};
use crate::message::{Empty, Message, read_enveloped};
use crate::protocol::{Protocol, ResponseEnvelope as _};
use std::fmt;

/// A report as received.
///
/// Its `Debug` form contains no text, because bodies may contain data that must not be logged.
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
    /// Reads the report as a typed report. A report from a connection has been checked before, within the limits of the
    /// connection, so it can be read as the type of its code.
    ///
    /// # Errors
    ///
    /// The error of the text or of a key of `R`.
    pub fn read<P: Protocol, R: Message>(&self) -> Result<R, BodyError> {
        read_enveloped::<P::Request, R>(&self.text, Self::allowance::<P>())?.body
    }

    /// Returns the limits of one report: the protocol's default, but any depth, because the connection has checked the
    /// depth.
    pub(crate) fn allowance<P: Protocol>() -> Allowance {
        Allowance {
            depth: MAX_DEPTH,
            ..P::DEFAULTS.limits.json()
        }
    }

    /// Reads only the envelope.
    ///
    /// # Errors
    ///
    /// The error of the text or of a key of the envelope.
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

/// A request as received. Its text is a JSON object.
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

/// The answer to a [`RawRequest`]: a JSON object with the keys of the response.
///
/// Envelope keys in it, such as a result code from elsewhere, are sent unchanged. The envelope of success supplies the
/// missing ones. If the result is not a response, the server logs it and sends the protocol's error result.
#[derive(Clone, PartialEq)]
pub struct RawAnswer(pub Json);

impl fmt::Debug for RawAnswer {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "RawAnswer({} bytes)", self.0.as_str().len())
    }
}
