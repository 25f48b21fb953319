//! An effect that does not exist.

use fc_derive::{Command, Message};
use fc_runtime::Empty;

#[derive(Message, Command)]
#[fc(code = 0x0A03, name = "get_station", effect = "write", response = Empty)]
struct GetStation {}

fn main() {}
