//! A time that is no number.

use fc_derive::{Envelope, Message};

#[derive(Message, Envelope)]
#[fc(envelope = "request")]
struct Common {
    #[fc(role = "time")]
    time: String,
}

fn main() {}
