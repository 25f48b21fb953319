//! Follows a command from its response to its end. The robot returns to its charging dock and
//! reports each step, and the app follows. They connect over loopback.
//!
//! ```text
//! cargo run --example follow
//! ```

#![allow(clippy::print_stdout, reason = "an example talks to its reader")]

use fc_generated::{
    Client, Fc, PartialRobot, RechargeError, RechargeProgress, RechargeStatus, Reporter,
    RobotService, StartRechargeRequest, StartRechargeResponse,
};
use fc_runtime::{
    Audience, ClientConfig, Context, Followed, Message, Refusal, Server, ServerConfig,
};
use std::error::Error;
use std::net::Ipv4Addr;
use std::sync::Arc;
use std::time::Duration;
use tokio::sync::Notify;

type Fault = Box<dyn Error + Send + Sync>;

/// A robot that accepts `start_recharge` and wakes `drive`.
struct Docking(Arc<Notify>);

impl PartialRobot for Docking {
    async fn start_recharge(
        &self,
        _context: Context<Fc>,
        _request: StartRechargeRequest,
    ) -> Result<StartRechargeResponse, Refusal> {
        self.0.notify_one();
        Ok(StartRechargeResponse::default())
    }
}

/// Waits for the command, reports the way to the dock, and fails there.
async fn drive(asked: &Notify, reporter: &Reporter) -> Result<(), Fault> {
    asked.notified().await;
    let mut report = RechargeProgress::example();
    for status in [RechargeStatus::Navigating, RechargeStatus::AtUndockPoint] {
        report.data.recharge_status = status;
        reporter.recharge_progress(Audience::All, &report).await?;
    }
    report.data.error_status = RechargeError::Failed;
    reporter.recharge_progress(Audience::All, &report).await?;
    Ok(())
}

// #region follow
/// 一条上报最多等多久；由 app 自己决定。
/// Longest wait for a report. Each app chooses its own.
const PATIENCE: Duration = Duration::from_secs(60);

async fn recharge(client: &Client) -> Result<(), Fault> {
    let request = StartRechargeRequest::default();
    let mut following = client.start_recharge(&request).follow().await?;
    println!("app: the robot has answered");
    while let Some(next) = tokio::time::timeout(PATIENCE, following.recv()).await? {
        match next? {
            Followed::Going(report) if report.data.recharge_status == RechargeStatus::Charging => {
                println!("app: charging");
                // 不再跟踪。
                // Stops following.
                break;
            }
            Followed::Going(report) => println!("app: {:?}", report.data.recharge_status),
            Followed::Ended(report) => println!("app: ended at {:?}", report.data.recharge_status),
            Followed::Failed(_) => println!("app: failed"),
            Followed::Missed(reports) => println!("app: {reports} reports missed"),
            Followed::Interrupted(why) => println!("app: {why}; waiting"),
            Followed::Resumed => println!("app: connected again"),
        }
    }
    Ok(())
}
// #endregion follow

#[tokio::main(flavor = "current_thread")]
async fn main() -> Result<(), Fault> {
    let config = ServerConfig::new()
        .address(Ipv4Addr::LOCALHOST)
        .command_port(0)
        .data_port(0);
    let asked = Arc::new(Notify::new());
    let robot = RobotService::new(Docking(Arc::clone(&asked)));
    let server = Server::<Fc>::bind(config, robot).await?;
    let port = server.command_addr().port();
    let handle = server.handle();
    let serving = tokio::spawn(server.run());
    let client = Client::connect(ClientConfig::new().host("127.0.0.1").command_port(port)).await?;

    let reporter = Reporter::new(handle.clone());
    tokio::try_join!(recharge(&client), drive(&asked, &reporter))?;

    drop(client);
    handle.shutdown(Duration::from_secs(1)).await;
    serving.await?;
    Ok(())
}
