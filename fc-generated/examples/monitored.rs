//! A robot that Prometheus can monitor. It answers with the examples in the spec, and exports
//! metrics at a separate port.
//!
//! ```text
//! cargo run --example monitored --features metrics -- --metrics-port 9656
//! curl http://127.0.0.1:9656/metrics
//! ```

mod support;

use fc_generated::{ExampleRobot, RobotService};
use fc_runtime::{Effect, NetworkError, Server, ServerConfig};
use metrics_exporter_prometheus::{Matcher, PrometheusBuilder, PrometheusHandle};
use std::io;
use std::net::{IpAddr, Ipv4Addr};
use std::process::ExitCode;
use std::time::Duration;
use support::stop::Stop;
use support::{Args, Fault};
use tokio::io::{AsyncReadExt, AsyncWriteExt};
use tokio::net::{TcpListener, TcpStream};
use tokio::time::{interval, timeout};

const USAGE: &str = "\
Responds to every command with the example in the spec, and to Prometheus with metrics.

Usage: monitored [--host 127.0.0.1] [--command-port PORT] [--data-port PORT]
                 [--metrics-port PORT]

The first line says the ports; metrics are at 127.0.0.1 alone:
commands 127.0.0.1:PORT data 127.0.0.1:PORT metrics 127.0.0.1:PORT";

#[tokio::main(flavor = "current_thread")]
async fn main() -> ExitCode {
    support::main(USAGE, run).await
}

// #region recorder
/// 上限，单位秒：机器人在 2.5 秒后放弃，app 在 3 秒后放弃。
/// Upper bounds in seconds: the robot gives up after 2.5 seconds, the app after 3.
const SECONDS: [f64; 10] = [0.000_1, 0.001, 0.005, 0.01, 0.05, 0.1, 0.5, 1.0, 2.5, 3.0];

/// 先安装记录器，再建立机器人：机器人建立时登记它的指标。
/// Install the recorder before you create the robot, which registers its metrics when created.
fn recorder() -> Result<PrometheusHandle, Fault> {
    let durations = Matcher::Suffix("_duration_seconds".to_owned());
    let builder = PrometheusBuilder::new().set_buckets_for_metric(durations, &SECONDS)?;
    Ok(builder.install_recorder()?)
}
// #endregion recorder

// #region allow
/// 本机和车内网段可以调用一切；显示屏所在的网段只能查询。
/// This machine and the robot's network may call everything. The display network may only query.
fn allowed() -> Result<ServerConfig, NetworkError> {
    Ok(ServerConfig::new()
        .allow("127.0.0.0/8".parse()?, Effect::ALL)
        .allow("10.0.0.0/24".parse()?, Effect::ALL)
        .allow("10.0.7.0/24".parse()?, [Effect::Read]))
}
// #endregion allow

async fn run(args: Args) -> Result<(), Fault> {
    support::log()?;
    let metrics = recorder()?;
    let host: IpAddr = args.host.parse()?;
    let mut config = allowed()?.address(host);
    if let Some(port) = args.command_port {
        config = config.command_port(port);
    }
    if let Some(port) = args.data_port {
        config = config.data_port(port);
    }
    let server = Server::bind(config, RobotService::new(ExampleRobot::default())).await?;
    let pages = TcpListener::bind((Ipv4Addr::LOCALHOST, args.metrics_port)).await?;
    let mut stop = Stop::listen()?;
    println!(
        "commands {} data {} metrics {}",
        server.command_addr(),
        server.data_addr(),
        pages.local_addr()?
    );
    let handle = server.handle();
    let serving = tokio::spawn(server.run());
    tokio::select! {
        () = export(&pages, &metrics) => {}
        signal = stop.asked() => tracing::info!("{signal}: ending"),
    }
    handle.shutdown(Duration::from_secs(5)).await;
    serving.await?;
    Ok(())
}

// #region export
/// 一次应答一个请求，请求慢了就放弃：读取指标不能影响机器人。
/// Serves one request at a time and drops slow ones: reading metrics must not affect the robot.
async fn export(pages: &TcpListener, metrics: &PrometheusHandle) {
    // 记录的耗时要定期归并，没有人读取时也是如此，否则会一直占用内存。
    // Recorded times must be merged regularly, even if they are never read. Otherwise they use up
    // memory.
    let mut upkeep = interval(Duration::from_secs(5));
    loop {
        tokio::select! {
            _ = upkeep.tick() => metrics.run_upkeep(),
            accepted = pages.accept() => {
                let Ok((stream, _)) = accepted else {
                    tokio::time::sleep(Duration::from_millis(50)).await;
                    continue;
                };
                let _ = timeout(Duration::from_secs(1), page(stream, metrics)).await;
            }
        }
    }
}

/// HTTP，只有一个页面。
/// HTTP with a single page.
async fn page(mut stream: TcpStream, metrics: &PrometheusHandle) -> io::Result<()> {
    let mut request = Vec::new();
    while !request.ends_with(b"\r\n\r\n") && request.len() < 8192 {
        if stream.read_buf(&mut request).await? == 0 {
            return Ok(());
        }
    }
    let (status, body) = match request.split(|byte| *byte == b' ').nth(1) {
        Some(b"/metrics") => ("200 OK", metrics.render()),
        _ => ("404 Not Found", String::new()),
    };
    let head = format!(
        "HTTP/1.1 {status}\r\nContent-Type: text/plain; version=0.0.4\r\n\
         Content-Length: {}\r\nConnection: close\r\n\r\n",
        body.len()
    );
    stream.write_all(head.as_bytes()).await?;
    stream.write_all(body.as_bytes()).await?;
    stream.shutdown().await
}
// #endregion export
