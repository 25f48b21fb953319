//! A condition that asks for what cannot be compared, and one that asks for another type.

use fc_derive::Message;

#[derive(Message)]
struct Station {
    height: f64,
    kind: u8,
    #[fc(when(height = 1))]
    fraction: Option<u8>,
    #[fc(when(kind = "one"))]
    text: Option<u8>,
}

fn main() {}
