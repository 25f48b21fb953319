//! Two attributes without a comma.

use fc_derive::Message;

#[derive(Message)]
struct Station {
    #[fc(min = 0 max = 5)]
    id: i32,
}

fn main() {}
