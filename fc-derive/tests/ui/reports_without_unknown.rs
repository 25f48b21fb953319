//! Reports without a place for others.

use fc_derive::Dispatch;
use fc_runtime::RawReport;

#[derive(Dispatch)]
#[fc(protocol = Fc)]
enum AnyReport {
    Arrived(RawReport),
}

fn main() {}
