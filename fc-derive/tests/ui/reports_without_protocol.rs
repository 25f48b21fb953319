//! Reports of no protocol.

use fc_derive::Dispatch;
use fc_runtime::RawReport;

#[derive(Dispatch)]
enum AnyReport {
    #[fc(unknown)]
    Unknown(RawReport),
}

fn main() {}
