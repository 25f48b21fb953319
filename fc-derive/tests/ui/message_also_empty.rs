//! Other keys, but none.

use fc_derive::Message;

#[derive(Message)]
struct Station {
    #[fc(also())]
    id: i32,
}

fn main() {}
