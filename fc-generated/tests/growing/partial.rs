//! A robot with one command, written before another was added.

#![allow(missing_docs, reason = "a test")]

use fc_generated::{
    Choice, ChoiceByLevel, Lamp, PartialRobot, RobotService, SetLevelRequest, SetLevelResponse,
    SetLevelResponseData,
};
use fc_runtime::{Context, Refusal, Service};

struct Desk;

impl PartialRobot for Desk {
    async fn set_level(
        &self,
        _: Context<Lamp>,
        _: SetLevelRequest,
    ) -> Result<SetLevelResponse, Refusal> {
        let level = ChoiceByLevel::new(1);
        let choice = Choice::ByLevel(level);
        let data = SetLevelResponseData::new(choice);
        Ok(SetLevelResponse::new().with_data(data))
    }
}

#[test]
fn a_partial_robot_is_served() {
    fn serves(_: impl Service<Lamp>) {}
    serves(RobotService::new(Desk));
}
