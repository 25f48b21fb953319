//! Two ranges that share a code.

#![allow(unused_imports)]

#[path = "../protocol/mod.rs"]
mod protocol;

use fc_derive::dispatch;
use fc_runtime::{Context, RawAnswer, RawRequest, Refusal};
use protocol::{Drive, Driven, Fc, Steer};

#[dispatch(protocol = Fc, service = RobotService)]
trait Robot: Send + Sync + 'static {
    #[fc(range = 0x0200..=0x0300)]
    async fn upper(&self, _: Context<Fc>, _: RawRequest) -> Result<RawAnswer, Refusal>;
    #[fc(range = 0x0300..=0x0400)]
    async fn lower(&self, _: Context<Fc>, _: RawRequest) -> Result<RawAnswer, Refusal>;
    #[fc(unknown)]
    async fn unknown(&self, _: Context<Fc>, _: RawRequest) -> Result<RawAnswer, Refusal>;
}

fn main() {}
