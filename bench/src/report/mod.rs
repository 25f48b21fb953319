//! The sections of the groups, and the results page.

mod page;

pub use fc_bench_report::*;
pub use page::page;
