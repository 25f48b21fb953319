use fc_generated::prelude::*;
use std::error::Error;

#[tokio::main]
async fn main() -> Result<(), Box<dyn Error>> {
    let mut config = ClientConfig::new().host("127.0.0.1");
    if let Some(port) = std::env::args().nth(1) {
        config = config.command_port(port.parse()?);
    }
    let client = Client::connect(config).await?;
    let answer = client.get_robot_sn(&GetRobotSnRequest::new()).await?;
    println!("{}", answer.data.robot_sn);
    Ok(())
}
