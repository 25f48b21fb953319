//! The runtime is found where the attribute says.

use fc_derive::{Command, Message, OneOf, OpenEnum, Report};
use fc_runtime as engine;

mod inner {
    pub use fc_runtime as renamed;
}

#[derive(Message, Command)]
#[fc(crate = inner::renamed, code = 1, name = "a", effect = "config", response = Left)]
struct Left {
    id: Status,
}

#[derive(Message, Report)]
#[fc(crate = engine, code = 2, name = "b", ack(timeout_ms = 1, retries = 1))]
struct Moved {
    left: Option<Left>,
}

#[derive(Message)]
#[fc(crate = engine)]
struct Right {}

#[derive(OneOf)]
#[fc(crate = engine)]
enum Choice {
    Left(Left),
    Right(Right),
}

#[derive(OpenEnum)]
#[fc(crate = inner::renamed, repr = u8)]
enum Status {
    #[fc(value = 0)]
    Idle,
}

fn main() {
    let _ = (Moved { left: None }, Choice::Left(Left { id: Status::Idle }), Choice::Right(Right {}));
}
