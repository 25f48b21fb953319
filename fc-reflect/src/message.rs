//! A message that has been read.

use crate::tree::Node;
use crate::write;
use fc_runtime::json::BodyError;

/// The keys of a message.
#[derive(Clone, Debug)]
pub struct Message<'m> {
    /// Those of the envelope, in the order in which they came.
    pub envelope: Vec<Node<'m>>,
    /// Its own and unknown ones, in the order in which they came; or what is wrong with them: a refusal that carries
    /// nothing but an envelope is still understood.
    pub body: Result<Vec<Node<'m>>, BodyError>,
}

impl Message<'_> {
    /// Its text in canonical form, as the generated packages write it.
    ///
    /// # Errors
    /// What is wrong with the body; `out_of_range` of NaN and infinities, which only a change can bring.
    pub fn canonical(&self) -> Result<String, BodyError> {
        match &self.body {
            Ok(body) => write::object(&[&self.envelope, body]),
            Err(error) => Err(error.clone()),
        }
    }
}
