//! An unknown attribute.

#![allow(unused_imports)]

#[path = "../protocol/mod.rs"]
mod protocol;

use fc_derive::dispatch;
use fc_runtime::{Context, RawAnswer, RawRequest, Refusal};
use protocol::{Drive, Driven, Fc, Steer};

#[dispatch(protocol = Fc, service = RobotService)]
trait Robot: Send + Sync + 'static {
    #[fc(code = 0x0A04)]
    async fn drive(&self, _: Context<Fc>, _: Drive) -> Result<Driven, Refusal>;
    #[fc(unknown)]
    async fn unknown(&self, _: Context<Fc>, _: RawRequest) -> Result<RawAnswer, Refusal>;
}

fn main() {}
