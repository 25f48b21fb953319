//! Results other than success.

use crate::operation::{Command, DeclaredError, ResultText};
use crate::protocol::Protocol;
#[cfg(feature = "net")]
use crate::protocol::ResponseEnvelope as _;
use std::fmt;

/// A result code other than success, and its text: the answer of a handler or of a peer.
///
/// Create one with [`Refusal::new`], from a result code of the protocol or from a declared error of the command.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Refusal {
    /// Result code, never the code of success.
    pub code: i64,
    /// Text for people. Do not rely on it.
    pub text: String,
}

impl Refusal {
    /// Creates a refusal with this result code and text.
    #[must_use]
    pub fn new(code: impl Into<i64>, text: impl Into<String>) -> Self {
        Self {
            code: code.into(),
            text: text.into(),
        }
    }

    /// Returns the declared error of the command with this result code, or `None` if there is none.
    #[must_use]
    pub fn declared<C: Command>(&self) -> Option<C::Error> {
        C::Error::of(self.code)
    }

    /// Returns the refusal in a response, or `None` for success.
    #[cfg(feature = "net")]
    pub(crate) fn of<P: Protocol>(response: &P::Response) -> Option<Self> {
        let code = response.result_code()?;
        (code != P::RESULTS.success.code).then(|| Self::new(code, response.result_text()))
    }

    /// Creates a refusal for a request that breaks a rule without a constraint in the spec.
    #[must_use]
    pub fn invalid<P: Protocol>(why: impl fmt::Display) -> Self {
        Self::with(P::RESULTS.invalid, why)
    }

    /// Creates the refusal of an unknown command.
    #[must_use]
    pub fn unknown<P: Protocol>() -> Self {
        P::RESULTS.protocol.into()
    }

    /// Creates a refusal with the protocol's error result and a reason.
    #[cfg(feature = "server")]
    pub(crate) fn protocol<P: Protocol>(why: &str) -> Self {
        Self::with(P::RESULTS.protocol, why)
    }

    /// Creates the refusal of a request that took too long.
    #[must_use]
    pub fn timeout<P: Protocol>() -> Self {
        P::RESULTS.timeout.into()
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
