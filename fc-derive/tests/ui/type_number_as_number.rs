//! A number that is to travel as one.

use fc_derive::Message;

#[derive(Message)]
struct Station {
    #[fc(wire = "number")]
    x: f64,
}

fn main() {}
