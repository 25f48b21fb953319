//! The attribute without a list.

use fc_derive::Message;

#[derive(Message)]
struct Station {
    #[fc]
    id: i32,
}

fn main() {}
