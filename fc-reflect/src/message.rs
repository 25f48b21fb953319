//! A message that has been read.

use crate::tree::Node;
use crate::write;
use fc_runtime::json::BodyError;

/// The keys of a message.
#[derive(Clone, Debug)]
pub struct Message<'m> {
    /// The keys of the envelope, in the order of the message.
    pub envelope: Vec<Node<'m>>,
    /// The other keys, in the order of the message, or the error in them. A refusal with only an envelope is still
    /// readable.
    pub body: Result<Vec<Node<'m>>, BodyError>,
}

impl Message<'_> {
    /// Returns the canonical text, as the generated packages write it.
    ///
    /// # Errors
    /// The error in the body, or `out_of_range` for NaN and infinities. Only a changed message can contain these.
    pub fn canonical(&self) -> Result<String, BodyError> {
        match &self.body {
            Ok(body) => write::object(&[&self.envelope, body]),
            Err(error) => Err(error.clone()),
        }
    }
}
