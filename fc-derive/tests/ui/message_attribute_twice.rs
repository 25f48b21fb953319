//! An attribute that is given twice.

use fc_derive::Message;

#[derive(Message)]
struct Station {
    #[fc(min = 0, max = 5)]
    #[fc(min = 1)]
    id: i32,
}

fn main() {}
