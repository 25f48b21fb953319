//! `fc schema`.

use crate::{Failure, Status, print};

pub fn run() -> Result<Status, Failure> {
    print::result(&fc_spec::schema::schema())?;
    Ok(Status::Fine)
}
