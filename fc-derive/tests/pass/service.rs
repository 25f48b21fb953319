//! A service of every kind of method, in a crate that takes no warnings.

#![deny(warnings, missing_docs, unreachable_pub)]

#[path = "../protocol/mod.rs"]
mod protocol;

use fc_derive::dispatch;
use fc_runtime::{Context, RawAnswer, RawRequest, Refusal};
use protocol::{Drive, Driven, Fc};

/// All of them.
#[dispatch(protocol = Fc, service = RobotService)]
#[allow(dead_code)]
trait Robot: Send + Sync + 'static {
    /// A command.
    async fn drive(&self, context: Context<Fc>, request: Drive) -> Result<Driven, Refusal>;

    /// A range of codes.
    #[fc(range = 0x0200..=0x0300)]
    async fn upper(&self, context: Context<Fc>, request: RawRequest) -> Result<RawAnswer, Refusal>;

    /// Another range of codes, with a body.
    #[fc(range = 0x0301..=0x0301)]
    async fn lower(
        &self,
        context: Context<Fc>,
        RawRequest { code, .. }: RawRequest,
    ) -> Result<RawAnswer, Refusal> {
        let _ = (self, context);
        Err(Refusal::new(code, "no"))
    }

    /// Called like a method that every `Arc` has.
    #[fc(range = 0x0302..=0x0302)]
    async fn clone(&self, _: Context<Fc>, _: RawRequest) -> Result<RawAnswer, Refusal> {
        Err(Refusal::unknown::<Fc>())
    }

    /// The rest.
    #[fc(unknown)]
    async fn unknown(&self, _: Context<Fc>, _: RawRequest) -> Result<RawAnswer, Refusal> {
        Err(Refusal::unknown::<Fc>())
    }
}

struct Wheels;

impl Robot for Wheels {
    async fn drive(&self, _: Context<Fc>, _: Drive) -> Result<Driven, Refusal> {
        Ok(Driven {})
    }

    async fn upper(&self, _: Context<Fc>, _: RawRequest) -> Result<RawAnswer, Refusal> {
        Err(Refusal::new(1, ""))
    }
}

/// Some of them.
#[dispatch(protocol = Fc, service = CartService, partial = PartialCart)]
#[allow(dead_code)]
trait Cart: Send + Sync + 'static {
    /// A command.
    async fn drive(&self, context: Context<Fc>, request: Drive) -> Result<Driven, Refusal>;

    /// A range of codes, with a body.
    #[fc(range = 0x0301..=0x0301)]
    async fn lower(
        &self,
        context: Context<Fc>,
        RawRequest { code, .. }: RawRequest,
    ) -> Result<RawAnswer, Refusal> {
        let _ = (self, context);
        Err(Refusal::new(code, "no"))
    }

    /// The rest.
    #[fc(unknown)]
    async fn unknown(&self, context: Context<Fc>, request: RawRequest) -> Result<RawAnswer, Refusal>;
}

impl PartialCart for Wheels {}

fn serves(_: impl fc_runtime::Service<Fc>) {}

fn main() {
    serves(RobotService::new(Wheels));
    serves(CartService::new(Wheels));
}
