//! `fc schema`.

use crate::{Failure, Status, print};

pub fn run() -> Result<Status, Failure> {
    print::result(&fc_codegen::emit::schema::schema())?;
    Ok(Status::Fine)
}
