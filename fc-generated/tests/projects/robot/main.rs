use fc_generated::prelude::*;
use std::error::Error;

struct MyRobot;

impl PartialRobot for MyRobot {
    async fn get_robot_sn(
        &self,
        _: Context<Fc>,
        _: GetRobotSnRequest,
    ) -> Result<GetRobotSnResponse, Refusal> {
        let data = GetRobotSnResponseData::new("100132007654321");
        Ok(GetRobotSnResponse::new(data))
    }
}

#[tokio::main]
async fn main() -> Result<(), Box<dyn Error>> {
    let mut config = ServerConfig::new().address([127, 0, 0, 1]);
    if let Some(port) = std::env::args().nth(1) {
        config = config.command_port(port.parse()?).data_port(0);
    }
    let server = Server::bind(config, RobotService::new(MyRobot)).await?;
    println!("{}", server.command_addr());
    server.run().await;
    Ok(())
}
