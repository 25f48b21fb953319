//! Two fields with one role.

use fc_derive::{Envelope, Message};

#[derive(Message, Envelope)]
#[fc(envelope = "response")]
struct Common {
    #[fc(role = "result_code")]
    code: i32,
    #[fc(role = "result_code")]
    result: i32,
}

fn main() {}
