//! A connection from start to end. The robot goes away while it carries out a command and comes
//! back, and the app finds out what happened. The guide of the same name explains it.
//!
//! ```text
//! cargo run --example connection
//! ```

#![allow(clippy::print_stdout, reason = "an example talks to its reader")]

use fc_generated::{
    Client, Fc, GetRechargeStatusRequest, GetRechargeStatusResponse, PartialRobot, RobotService,
    StartRechargeRequest, StartRechargeResponse,
};
use fc_runtime::{
    Backoff, CallError, CallOptions, ClientConfig, ConnectionState, Context, Message, Refusal,
    Server, ServerConfig, ServerHandle,
};
use std::error::Error;
use std::net::Ipv4Addr;
use std::sync::Arc;
use std::time::Duration;
use tokio::sync::Notify;
use tokio::task::JoinHandle;

type Fault = Box<dyn Error + Send + Sync>;

// #region connect
async fn connect(port: u16) -> Result<Client, Fault> {
    let config = ClientConfig::new()
        .host("127.0.0.1")
        .command_port(port)
        .reconnect(Backoff {
            first: Duration::from_millis(50),
            longest: Duration::from_secs(2),
            attempts: None,
        });
    Ok(Client::connect(config).await?)
}
// #endregion connect

// #region refresh
/// 每次连上都重新查询状态，直到连接永久关闭。
/// Queries the state again after each connect, until the connection is closed for good.
async fn follow(client: Client, asked: Arc<Notify>) {
    let mut states = client.states();
    while let Some(state) = states.recv().await {
        match state {
            ConnectionState::Connected { connects } => {
                let request = GetRechargeStatusRequest::default();
                match client.get_recharge_status(&request).await {
                    Ok(answer) => println!(
                        "app: connection {connects}, recharging is at {:?}",
                        answer.data.recharge_status
                    ),
                    Err(error) => println!("app: the state is unknown: {error}"),
                }
                asked.notify_one();
            }
            // 界面上可以显示原因 `why`。
            // A user interface can show the reason `why`.
            ConnectionState::Connecting { .. } => {}
            ConnectionState::Closed { connects, .. } => {
                println!("app: closed after {connects} connections");
            }
        }
    }
}
// #endregion refresh

// #region lost
/// 运动指令只发送一次。结果未知时不重发，先查询状态。
/// A motion command is sent only once. If the outcome is unknown, query the state, do not resend.
async fn start(client: &Client) -> Result<(), CallError> {
    match client
        .start_recharge(&StartRechargeRequest::default())
        .await
    {
        Ok(_) => println!("app: the robot has accepted it"),
        Err(error @ (CallError::Lost(_) | CallError::Timeout)) => {
            println!("app: {}, the outcome is unknown", error.name());
        }
        Err(error) => return Err(error),
    }
    Ok(())
}
// #endregion lost

// #region repeat
/// 读取类指令断线后自动重发，在超时之内等到新的连接。这里改为不重发。
/// After a loss, a read command is resent and waits for the new connection within its timeout. This
/// call is not resent.
async fn once(client: &Client) -> Result<(), CallError> {
    let options = CallOptions {
        timeout: Some(Duration::from_secs(1)),
        repeat: Some(false),
    };
    let request = GetRechargeStatusRequest::default();
    client
        .get_recharge_status(&request)
        .with_options(options)
        .await?;
    Ok(())
}
// #endregion repeat

/// A robot that never finishes `start_recharge`, but reports its state.
struct Busy {
    started: Arc<Notify>,
}

impl PartialRobot for Busy {
    async fn start_recharge(
        &self,
        _: Context<Fc>,
        _: StartRechargeRequest,
    ) -> Result<StartRechargeResponse, Refusal> {
        self.started.notify_one();
        std::future::pending().await
    }

    async fn get_recharge_status(
        &self,
        _: Context<Fc>,
        _: GetRechargeStatusRequest,
    ) -> Result<GetRechargeStatusResponse, Refusal> {
        Ok(GetRechargeStatusResponse::example())
    }
}

struct Robot {
    handle: ServerHandle<Fc>,
    running: JoinHandle<()>,
    started: Arc<Notify>,
    port: u16,
}

// #region serve
async fn robot(port: u16) -> Result<Robot, Fault> {
    let config = ServerConfig::new()
        .address(Ipv4Addr::LOCALHOST)
        .command_port(port)
        .data_port(0)
        .idle_timeout(Some(Duration::from_secs(600)));
    // #endregion serve
    let started = Arc::<Notify>::default();
    let busy = Busy {
        started: Arc::clone(&started),
    };
    let server = Server::bind(config, RobotService::new(busy)).await?;
    Ok(Robot {
        handle: server.handle(),
        port: server.command_addr().port(),
        running: tokio::spawn(server.run()),
        started,
    })
}

impl Robot {
    // #region shutdown
    /// 停止接受连接和请求，正在处理的请求最多再等 `grace`，之后断开。
    /// Accepts no more connections and requests. Requests in progress get at most `grace`, then the
    /// connections are closed.
    async fn stop(self, grace: Duration) -> Result<(), Fault> {
        self.handle.shutdown(grace).await;
        self.running.await?;
        Ok(())
    }
    // #endregion shutdown
}

#[tokio::main(flavor = "current_thread")]
async fn main() -> Result<(), Fault> {
    let first = robot(0).await?;
    let port = first.port;
    let client = connect(port).await?;
    let asked = Arc::<Notify>::default();
    let following = tokio::spawn(follow(client.clone(), Arc::clone(&asked)));
    asked.notified().await;

    // The robot goes away while it carries out the command.
    let started = Arc::clone(&first.started);
    let goes = async {
        started.notified().await;
        first.stop(Duration::ZERO).await
    };
    tokio::try_join!(async { Ok(start(&client).await?) }, goes)?;

    let second = robot(port).await?;
    asked.notified().await;
    once(&client).await?;

    // #region close
    client.connection().close();
    // #endregion close
    following.await?;
    second.stop(Duration::from_secs(1)).await?;
    Ok(())
}
