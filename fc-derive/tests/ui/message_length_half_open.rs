//! A range that leaves its end out.

use fc_derive::Message;

#[derive(Message)]
struct Station {
    #[fc(length = 1..5)]
    name: String,
}

fn main() {}
