//! `fc schema`.

use crate::{Failure, Status};

pub fn run() -> Result<Status, Failure> {
    Err("the schema is not available in this build".into())
}
