use fc_generated::blocking::Client;
use fc_generated::prelude::{ClientConfig, GetRobotSnRequest};
use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    let mut config = ClientConfig::new().host("127.0.0.1");
    if let Some(port) = std::env::args().nth(1) {
        config = config.command_port(port.parse()?);
    }
    let client = Client::connect(config)?;
    let answer = client.get_robot_sn(&GetRobotSnRequest::new())?;
    println!("{}", answer.data.robot_sn);
    Ok(())
}
