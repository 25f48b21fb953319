//! A complete robot, written before another command was added.

#![allow(deprecated, missing_docs, reason = "a test")]

use fc_generated::{
    GetLevelRequest, GetLevelResponse, Lamp, ProbeRequest, ProbeResponse, Robot, RobotService,
    SetLevelRequest, SetLevelResponse,
};
use fc_runtime::{Context, Message, Refusal, Service};

struct Desk;

impl Robot for Desk {
    async fn set_level(
        &self,
        _: Context<Lamp>,
        _: SetLevelRequest,
    ) -> Result<SetLevelResponse, Refusal> {
        Ok(SetLevelResponse::example())
    }

    async fn get_level(
        &self,
        _: Context<Lamp>,
        _: GetLevelRequest,
    ) -> Result<GetLevelResponse, Refusal> {
        Ok(GetLevelResponse::example())
    }

    async fn probe(&self, _: Context<Lamp>, _: ProbeRequest) -> Result<ProbeResponse, Refusal> {
        Ok(ProbeResponse::example())
    }
}

#[test]
fn a_complete_robot_is_served() {
    fn serves(_: impl Service<Lamp>) {}
    serves(RobotService::new(Desk));
}
