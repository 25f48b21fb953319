//! A leniency that is not said.

use fc_derive::Message;

#[derive(Message)]
struct Station {
    #[fc(lenient)]
    id: i32,
}

fn main() {}
