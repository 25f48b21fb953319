//! A response whose result has a text and no code.

use fc_derive::{Envelope, Message};

#[derive(Message, Envelope)]
#[fc(envelope = "response")]
struct Common {
    #[fc(role = "time")]
    time: i64,
    #[fc(role = "result_text")]
    text: String,
}

fn main() {}
