//! Neither a complete service nor a partial one.

#![allow(dead_code)]

#[path = "../protocol/mod.rs"]
mod protocol;

use fc_derive::dispatch;
use fc_runtime::{Context, RawAnswer, RawRequest, Refusal};
use protocol::{Drive, Driven, Fc, Steer};

#[dispatch(protocol = Fc, service = RobotService, partial = PartialRobot)]
trait Robot: Send + Sync + 'static {
    async fn drive(&self, _: Context<Fc>, _: Drive) -> Result<Driven, Refusal>;
    #[fc(unknown)]
    async fn unknown(&self, _: Context<Fc>, _: RawRequest) -> Result<RawAnswer, Refusal>;
}

struct Wheels;

fn main() {
    let _ = (RobotService::new(Wheels), std::mem::size_of::<Steer>());
}
