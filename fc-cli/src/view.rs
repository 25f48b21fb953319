//! The terminal of `fcproto proxy --view`.

use std::io::{self, IsTerminal as _};

use crate::lang::said;
use crate::outcome::Failure;
use crate::progress;

/// Checks that standard output is a terminal.
pub fn needs_terminal() -> Result<(), Failure> {
    progress::done();
    if io::stdout().is_terminal() {
        return Ok(());
    }
    Err(said!(
        "--view 需要终端；去掉它可得到逐行的文本",
        "--view needs a terminal; leave it out to get lines of text"
    )
    .into())
}
