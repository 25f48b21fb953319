//! A role that does not exist.

use fc_derive::{Envelope, Message};

#[derive(Message, Envelope)]
#[fc(envelope = "response")]
struct Common {
    #[fc(role = "result_code")]
    code: i32,
    #[fc(role = "result_message")]
    text: String,
}

fn main() {}
