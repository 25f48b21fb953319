//! States without a variant, and states of a report.

use fc_derive::{Command, Message, Report};
use fc_runtime::Empty;

#[derive(PartialEq)]
enum Door {
    Shut,
}

#[derive(Message, Command)]
#[fc(code = 0x0A03, name = "open", effect = "motion", response = Empty)]
#[fc(accepted_in(Door()))]
struct Open {}

#[derive(Message, Report)]
#[fc(code = 0x0B01, name = "opened", accepted_in(Door(Shut)))]
struct Opened {}

fn main() {}
