//! An acknowledgement that is half said.

use fc_derive::{Message, Report};

#[derive(Message, Report)]
#[fc(code = 0x0B01, name = "arrived", ack(retries = 3))]
struct Arrived {}

fn main() {}
