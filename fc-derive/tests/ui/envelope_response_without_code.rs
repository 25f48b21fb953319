//! A response that does not say how it went.

use fc_derive::{Envelope, Message};

#[derive(Message, Envelope)]
#[fc(envelope = "response")]
struct Common {
    #[fc(role = "time")]
    time: i64,
}

fn main() {}
