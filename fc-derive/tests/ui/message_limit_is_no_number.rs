//! A limit in quotes.

use fc_derive::Message;

#[derive(Message)]
struct Station {
    #[fc(min = "0")]
    id: i32,
}

fn main() {}
