//! Bodies that are kept, to be sent often with envelopes of their own.

use super::digest::Midstate;
use crate::json::{BodyError, to_vec};
use crate::message::Message;
use std::fmt;
use std::marker::PhantomData;
use std::sync::Arc;

/// A response that is encoded and digested once and sent to any number of apps: a map or a picture that
/// many ask for. Cheap to clone.
///
/// Only the header and the keys of the envelope are made for each answer, and follow those of the
/// response. It is never compressed, whatever the connection does otherwise: the envelope would have to be
/// packed with it.
///
/// [`Request::handle_prepared`](crate::Request::handle_prepared) sends it.
pub struct PreparedResponse<M> {
    kept: Arc<Kept>,
    message: PhantomData<fn() -> M>,
}

/// A JSON object without its closing brace.
pub(crate) struct Kept {
    text: Vec<u8>,
    midstate: Midstate,
}

/// The rest of an object, and the digest of the whole.
pub(super) struct Tail {
    pub(super) text: Vec<u8>,
    pub(super) digest: [u8; 16],
}

impl<M: Message> PreparedResponse<M> {
    /// Encodes and digests a response.
    ///
    /// # Errors
    ///
    /// The response breaks a constraint of the spec: `out_of_range`, `bad_length` or `bad_pattern`.
    pub fn new(response: &M) -> Result<Self, BodyError> {
        response.check()?;
        let mut text = to_vec(response);
        text.pop();
        let midstate = Midstate::after(&text);
        Ok(Self {
            kept: Arc::new(Kept { text, midstate }),
            message: PhantomData,
        })
    }

    pub(crate) fn kept(&self) -> &Kept {
        &self.kept
    }
}

impl<M> Clone for PreparedResponse<M> {
    fn clone(&self) -> Self {
        Self {
            kept: Arc::clone(&self.kept),
            message: PhantomData,
        }
    }
}

/// Shows the length alone: bodies may hold what must not be logged.
impl<M> fmt::Debug for PreparedResponse<M> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "PreparedResponse({} bytes)", self.kept.text.len())
    }
}

impl Kept {
    pub(super) fn text(&self) -> &[u8] {
        &self.text
    }

    /// What makes it a whole body: the keys of an envelope.
    pub(super) fn tail<E: Message>(&self, envelope: &E) -> Tail {
        let mut text = to_vec(envelope);
        if self.text.len() > 1 {
            // In place of the opening brace.
            if let Some(first) = text.first_mut() {
                *first = b',';
            }
        } else {
            text.remove(0);
        }
        Tail {
            digest: self.midstate.digest(&text),
            text,
        }
    }
}
