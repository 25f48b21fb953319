//! An unknown attribute.

use fc_derive::Message;

#[derive(Message)]
struct Station {
    #[fc(kee = "stationId")]
    id: i32,
}

fn main() {}
