//! All faults are found in one run.

use fc_derive::Message;

#[derive(Message)]
struct Station {
    #[fc(key = 5)]
    id: i32,
    #[fc(pattern = "(")]
    serial: String,
    #[fc(min = 2, max = 1, colour = "red")]
    level: u8,
}

fn main() {}
