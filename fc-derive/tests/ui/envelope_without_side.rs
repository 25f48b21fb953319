//! Neither of a request nor of a response.

use fc_derive::{Envelope, Message};

#[derive(Message, Envelope)]
struct Common {
    #[fc(role = "time")]
    time: i64,
}

fn main() {}
