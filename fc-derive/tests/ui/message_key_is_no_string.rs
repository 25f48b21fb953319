//! A key without quotes.

use fc_derive::Message;

#[derive(Message)]
struct Station {
    #[fc(key = stationId)]
    id: i32,
}

fn main() {}
