//! What the groups say, and the page that shows it.

mod page;

pub use fc_bench_report::*;
pub use page::page;
