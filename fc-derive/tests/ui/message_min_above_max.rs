//! No number is possible.

use fc_derive::Message;

#[derive(Message)]
struct Station {
    #[fc(min = 5, max = -5)]
    id: i32,
}

fn main() {}
