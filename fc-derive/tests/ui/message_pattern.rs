//! A pattern that is no regular expression.

use fc_derive::Message;

#[derive(Message)]
struct Station {
    #[fc(pattern = "[0-9")]
    serial: String,
}

fn main() {}
