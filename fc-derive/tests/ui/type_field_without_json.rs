//! A field of a type that does not travel.

use fc_derive::Message;

#[derive(Message)]
struct Station {
    id: std::time::Duration,
}

fn main() {}
