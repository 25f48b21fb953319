//! A form that does not exist.

use fc_derive::Message;

#[derive(Message)]
struct Station {
    #[fc(wire = "text")]
    x: f64,
}

fn main() {}
