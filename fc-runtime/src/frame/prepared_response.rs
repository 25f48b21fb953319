//! Bodies that are encoded once and sent with many envelopes.

use crate::digest::{DigestAlgorithm, Md5, Sum};
use crate::json::{BodyError, to_vec};
use crate::message::Message;
use std::fmt;
use std::marker::PhantomData;
use std::sync::Arc;

/// A response that is encoded and digested once and sent to any number of apps, such as a map or a picture. Cheap to
/// clone. `A` is the digest algorithm of the protocol, which the compiler checks where the response is sent.
///
/// For each request, only the header and the keys of the envelope are written; the envelope follows the response. A
/// prepared response is never compressed, because the envelope would have to be compressed with it.
///
/// Send it with [`Request::handle_prepared`](crate::Request::handle_prepared).
pub struct PreparedResponse<M, A: DigestAlgorithm = Md5> {
    body: Arc<PreparedBody<A>>,
    message: PhantomData<fn() -> M>,
}

/// A JSON object without its closing brace.
pub(crate) struct PreparedBody<A: DigestAlgorithm> {
    text: Vec<u8>,
    midstate: A::Midstate,
}

/// The rest of an object, and the digest of the whole.
pub(super) struct Tail {
    pub(super) text: Vec<u8>,
    pub(super) digest: Sum,
}

impl<M: Message, A: DigestAlgorithm> PreparedResponse<M, A> {
    /// Encodes and digests a response.
    ///
    /// # Errors
    ///
    /// The response violates a constraint of the spec: `out_of_range`, `bad_length` or `bad_pattern`.
    pub fn new(response: &M) -> Result<Self, BodyError> {
        response.check()?;
        let mut text = to_vec(response);
        text.pop();
        let midstate = A::after(&text);
        Ok(Self {
            body: Arc::new(PreparedBody { text, midstate }),
            message: PhantomData,
        })
    }

    pub(crate) fn body(&self) -> &PreparedBody<A> {
        &self.body
    }
}

impl<M, A: DigestAlgorithm> Clone for PreparedResponse<M, A> {
    fn clone(&self) -> Self {
        Self {
            body: Arc::clone(&self.body),
            message: PhantomData,
        }
    }
}

/// Shows only the length, because bodies may contain data that must not be logged.
impl<M, A: DigestAlgorithm> fmt::Debug for PreparedResponse<M, A> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "PreparedResponse({} bytes)", self.body.text.len())
    }
}

impl<A: DigestAlgorithm> PreparedBody<A> {
    pub(super) fn text(&self) -> &[u8] {
        &self.text
    }

    /// Returns the keys of an envelope, which complete the body.
    pub(super) fn tail<E: Message>(&self, envelope: &E) -> Tail {
        let mut text = to_vec(envelope);
        if self.text.len() > 1 {
            // The comma replaces the opening brace.
            if let Some(first) = text.first_mut() {
                *first = b',';
            }
        } else {
            text.remove(0);
        }
        Tail {
            digest: A::resume(&self.midstate, &text),
            text,
        }
    }
}
