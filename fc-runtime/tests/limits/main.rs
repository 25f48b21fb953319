//! Every limit one below, at and one beyond it.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::indexing_slicing,
    clippy::cast_possible_truncation,
    reason = "a test may"
)]

#[path = "../common/mod.rs"]
mod common;
mod messages;
mod numbers;
mod times;

use common::Echo;

/// One below a limit, the limit, one beyond it; and whether that is within.
fn around(limit: usize) -> [(usize, bool); 3] {
    [(limit - 1, true), (limit, true), (limit + 1, false)]
}

fn echo(text: &str) -> Echo {
    Echo {
        text: text.to_owned(),
    }
}
