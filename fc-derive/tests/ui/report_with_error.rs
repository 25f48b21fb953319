//! A report is acknowledged; what refuses it is not declared.

use fc_derive::{Message, Report};

#[derive(Clone, Debug, PartialEq, Message, Report)]
#[fc(code = 0x0B01, name = "moved", error = MovedError)]
struct Moved {}

fn main() {}
