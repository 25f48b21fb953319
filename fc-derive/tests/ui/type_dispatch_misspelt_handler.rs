//! A partial robot whose handler has another name than its command.

#[path = "../protocol/mod.rs"]
mod protocol;

use fc_derive::dispatch;
use fc_runtime::{Context, RawAnswer, RawRequest, Refusal};
use protocol::{Drive, Driven, Fc};

#[dispatch(protocol = Fc, service = CartService, partial = PartialCart)]
trait Cart: Send + Sync + 'static {
    async fn drive(&self, context: Context<Fc>, request: Drive) -> Result<Driven, Refusal>;

    #[fc(unknown)]
    async fn unknown(&self, _: Context<Fc>, _: RawRequest) -> Result<RawAnswer, Refusal>;
}

struct Wheels;

impl PartialCart for Wheels {
    async fn drvie(&self, _: Context<Fc>, _: Drive) -> Result<Driven, Refusal> {
        Ok(Driven {})
    }
}

fn main() {}
