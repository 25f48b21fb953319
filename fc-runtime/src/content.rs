//! The content of a stream frame, by type.

use crate::frame::Body;
use crate::json::{Allowance, BodyError, decode};
use crate::message::Message;

/// The content of a stream frame: the raw bytes as a [`Body`], or a JSON object without an envelope as a [`Message`].
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not what a stream carries",
    note = "a stream carries a `Body` or a type with `derive(Message)`"
)]
pub trait StreamContent: Sized + Send + 'static {
    /// Reads the data of a frame within this allowance.
    ///
    /// # Errors
    /// The error of the JSON. Raw bytes have no errors.
    fn read(data: Body, allowance: Allowance) -> Result<Self, BodyError>;
}

impl StreamContent for Body {
    fn read(data: Body, _: Allowance) -> Result<Self, BodyError> {
        Ok(data)
    }
}

#[diagnostic::do_not_recommend]
impl<M: Message> StreamContent for M {
    fn read(data: Body, allowance: Allowance) -> Result<Self, BodyError> {
        decode(&data, allowance)
    }
}
