//! A command without attributes.

#![allow(unused_imports)]

use fc_derive::{Command, Message};
use fc_runtime::Empty;

#[derive(Message, Command)]
struct GetStation {}

fn main() {}
