//! A string inside a string.

use fc_derive::Message;

#[derive(Message)]
struct Station {
    #[fc(wire = "string")]
    name: String,
}

fn main() {}
