//! A side that does not exist.

use fc_derive::{Envelope, Message};

#[derive(Message, Envelope)]
#[fc(envelope = "report")]
struct Common {
    #[fc(role = "time")]
    time: i64,
}

fn main() {}
