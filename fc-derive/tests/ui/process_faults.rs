//! Attributes about a process belong on the operation they describe, and name fields.

use fc_derive::{Command, Message, Report};
use fc_runtime::Extra;

#[derive(Clone, Debug, PartialEq, Message)]
struct Answer {
    #[fc(extra)]
    extra: Extra,
}

#[derive(Clone, Debug, PartialEq, Message, Report)]
#[fc(code = 1, name = "moved", ack(timeout_ms = 1, retries = 0), sets_off(Moved))]
struct Moved {
    #[fc(extra)]
    extra: Extra,
}

#[derive(Clone, Debug, PartialEq, Message, Command)]
#[fc(code = 2, name = "move", effect = "motion", response = Answer, state(extra: Extra))]
struct Move {
    #[fc(extra)]
    extra: Extra,
}

#[derive(Clone, Debug, PartialEq, Message, Command)]
#[fc(code = 3, name = "turn", effect = "motion", response = Answer, sets_off(Moved(answer.job = job)))]
struct Turn {
    #[fc(extra)]
    extra: Extra,
}

#[derive(Clone, Debug, PartialEq, Message, Command)]
#[fc(code = 4, name = "lift", effect = "motion", response = Answer, sets_off(Moved(response.job = job)))]
struct Lift {
    #[fc(extra)]
    extra: Extra,
}

fn main() {}
