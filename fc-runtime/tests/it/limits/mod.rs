//! Every limit one below, at and one beyond it.

mod messages;
mod numbers;
mod times;

use crate::common::Echo;

/// One below a limit, the limit, one beyond it; and whether that is within.
fn around(limit: usize) -> [(usize, bool); 3] {
    [(limit - 1, true), (limit, true), (limit + 1, false)]
}

fn echo(text: &str) -> Echo {
    Echo {
        text: text.to_owned(),
    }
}
