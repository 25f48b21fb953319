//! No length is possible.

use fc_derive::Message;

#[derive(Message)]
struct Station {
    #[fc(length = 5..=1)]
    name: String,
}

fn main() {}
