//! The first call, from both sides. A robot has one command so far, and an app calls it and
//! receives a report. They connect over loopback. The guide of the same name explains it.
//!
//! ```text
//! cargo run --example first_call
//! ```

#![allow(clippy::print_stdout, reason = "an example talks to its reader")]

// #region imports
use fc_generated::{
    AnyReport, Client, Fc, GetRobotSnRequest, GetRobotSnResponse, PartialRobot, RechargeProgress,
    RechargeStatus, Reporter, RobotService,
};
use fc_runtime::{Audience, ClientConfig, Context, Message, Refusal, Server, ServerConfig};
// #endregion imports
use std::error::Error;
use std::net::Ipv4Addr;
use std::time::Duration;

type Fault = Box<dyn Error + Send + Sync>;

// #region robot
/// 目前只实现 `get_robot_sn`，其余指令以“未实现”拒绝。
/// Implements only `get_robot_sn` so far. All other commands are refused as not implemented.
struct MyRobot;

impl PartialRobot for MyRobot {
    async fn get_robot_sn(
        &self,
        _context: Context<Fc>,
        _request: GetRobotSnRequest,
    ) -> Result<GetRobotSnResponse, Refusal> {
        // 其余字段先用规范中的示例。
        // The other fields come from the spec's example for now.
        let mut response = GetRobotSnResponse::example();
        response.data.robot_sn = "100132007654321".into();
        Ok(response)
    }
}
// #endregion robot

// #region serve
async fn robot() -> Result<Server<Fc>, Fault> {
    // 端口 0：由系统分配。不写就是协议规定的端口。
    // Port 0: the system assigns a free port. The default is the protocol's port.
    let config = ServerConfig::new()
        .address(Ipv4Addr::LOCALHOST)
        .command_port(0)
        .data_port(0);
    Ok(Server::bind(config, RobotService::new(MyRobot)).await?)
}
// #endregion serve

// #region report
async fn report(reporter: &Reporter) -> Result<(), Fault> {
    let mut report = RechargeProgress::example();
    report.data.recharge_status = RechargeStatus::AtUndockPoint;
    // 等到每个 app 应答，或重发次数用完。
    // Waits until every app has acknowledged the report, or the retries are used up.
    let acknowledgements = reporter.recharge_progress(Audience::All, &report).await?;
    println!("robot: {} app has acknowledged", acknowledgements.len());
    Ok(())
}
// #endregion report

// #region app
async fn app(client: &Client) -> Result<(), Fault> {
    let answer = client.get_robot_sn(&GetRobotSnRequest::default()).await?;
    println!("app: the robot is {}", answer.data.robot_sn);
    Ok(())
}
// #endregion app

// #region listen
async fn listen(client: &Client) -> Result<(), Fault> {
    let mut reports = client.reports();
    while let Some(report) = reports.recv().await {
        if let AnyReport::RechargeProgress(report) = report? {
            println!("app: recharging is at {:?}", report.data.recharge_status);
            break;
        }
    }
    Ok(())
}
// #endregion listen

#[tokio::main(flavor = "current_thread")]
async fn main() -> Result<(), Fault> {
    let server = robot().await?;
    let port = server.command_addr().port();
    let handle = server.handle();
    let serving = tokio::spawn(server.run());

    // #region connect
    let config = ClientConfig::new().host("127.0.0.1").command_port(port);
    let client = Client::connect(config).await?;
    // #endregion connect

    app(&client).await?;
    let reporter = Reporter::new(handle.clone());
    tokio::try_join!(listen(&client), report(&reporter))?;

    drop(client);
    handle.shutdown(Duration::from_secs(1)).await;
    serving.await?;
    Ok(())
}
