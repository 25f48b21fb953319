//! A variant without a report.

use fc_derive::Dispatch;
use fc_runtime::RawReport;

#[derive(Dispatch)]
#[fc(protocol = Fc)]
enum AnyReport {
    Arrived,
    #[fc(unknown)]
    Unknown(RawReport),
}

fn main() {}
