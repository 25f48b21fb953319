//! A length below zero.

use fc_derive::Message;

#[derive(Message)]
struct Station {
    #[fc(length = -1)]
    name: String,
}

fn main() {}
