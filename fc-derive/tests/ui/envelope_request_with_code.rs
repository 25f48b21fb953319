//! A request that says how it went.

use fc_derive::{Envelope, Message};

#[derive(Message, Envelope)]
#[fc(envelope = "request")]
struct Common {
    #[fc(role = "result_code")]
    code: i32,
}

fn main() {}
