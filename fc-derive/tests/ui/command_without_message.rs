//! A command that is no message.

use fc_derive::Command;
use fc_runtime::Empty;

#[derive(Command)]
#[fc(code = 0x0A03, name = "get_station", effect = "read", response = Empty)]
struct GetStation {}

fn main() {}
