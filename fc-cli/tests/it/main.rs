//! All integration tests in one program. One program per file would link the crate each time.

#![allow(
    clippy::expect_used,
    clippy::indexing_slicing,
    clippy::needless_pass_by_value,
    clippy::panic,
    clippy::single_match_else,
    clippy::too_many_lines,
    reason = "tests"
)]

mod audience;
#[cfg(unix)]
mod call;
mod certify;
mod check;
mod codes;
mod decode;
mod diff;
mod drift;
mod edits;
mod explain;
mod fmt;
mod generate;
mod git_check;
mod git_diff;
mod git_merge;
mod help;
mod init;
#[cfg(unix)]
mod inputs;
mod lang;
mod languages;
mod lint;
mod lsp;
mod merge;
#[cfg(unix)]
mod mock;
mod new;
#[cfg(unix)]
mod package;
mod pre_commit;
mod progress;
mod proxy;
mod questions;
#[cfg(feature = "record")]
mod record;
mod release;
mod retire;
mod shell;
mod support;
mod targets;
#[cfg(all(unix, feature = "view"))]
mod view;
mod warnings;
mod watch;
mod where_;
