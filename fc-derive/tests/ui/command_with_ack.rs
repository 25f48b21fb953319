//! An acknowledged command.

use fc_derive::{Command, Message};
use fc_runtime::Empty;

#[derive(Message, Command)]
#[fc(code = 0x0A03, name = "get_station", effect = "read", response = Empty)]
#[fc(ack(timeout_ms = 1, retries = 1))]
struct GetStation {}

fn main() {}
