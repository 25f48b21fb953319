//! An acknowledgement that says too much.

use fc_derive::{Message, Report};

#[derive(Message, Report)]
#[fc(code = 0x0B01, name = "arrived", ack(timeout_ms = 1, retries = 3, wait = 1))]
struct Arrived {}

fn main() {}
