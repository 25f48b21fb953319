//! What a frame of a stream carries, by type.

use crate::frame::Body;
use crate::json::{Allowance, BodyError, decode};
use crate::message::Message;

/// What a frame of a stream carries: a [`Body`], the bytes as they are; or a [`Message`], a JSON object whose keys stand
/// alone, without an envelope.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not what a stream carries",
    note = "a stream carries a `Body` or a type with `derive(Message)`"
)]
pub trait StreamContent: Sized + Send + 'static {
    /// Reads the data of a frame, within this allowance.
    ///
    /// # Errors
    /// What is wrong with the JSON; raw bytes are always right.
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
