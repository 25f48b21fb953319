//! A limit on a string.

use fc_derive::Message;

#[derive(Message)]
struct Station {
    #[fc(min = 0)]
    name: String,
}

fn main() {}
