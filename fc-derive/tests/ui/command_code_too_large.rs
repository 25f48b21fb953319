//! A code of more than 16 bits.

use fc_derive::{Command, Message};
use fc_runtime::Empty;

#[derive(Message, Command)]
#[fc(code = 0x10A03, name = "get_station", effect = "read", response = Empty)]
struct GetStation {}

fn main() {}
