//! The robot, a separate process that takes orders from its standard input.

use crate::fault::Fault;
use fc_generated::{
    ExampleRobot, Fc, GetFirmwareVersionsRequest, GetStationRequest, RobotService, RobotStatus,
};
use fc_runtime::{
    Audience, Command, Handling, Limits, Message, Protocol, Request, Server, ServerConfig,
    ServerHandle, Service,
};
use std::net::Ipv4Addr;
use std::process::Stdio;
use std::time::{Duration, Instant};
use tokio::io::{AsyncBufReadExt, AsyncWriteExt, BufReader, Lines};
use tokio::process::{Child, ChildStdin, ChildStdout};
use tokio::task::JoinSet;
use tokio::time::{interval, sleep};

/// Time that the robot takes to handle a [`GetStationRequest`].
pub const THINKING: Duration = Duration::from_secs(1);

/// Answers with the examples. It handles one command slowly, and panics in the handler of another.
struct Thoughtful(RobotService<ExampleRobot>);

impl Service<Fc> for Thoughtful {
    fn call(&self, request: Request<'_, Fc>) -> Handling {
        if request.code() == GetStationRequest::CODE {
            return request.handle(|_, _: GetStationRequest| async {
                sleep(THINKING).await;
                Ok(<GetStationRequest as Command>::Response::example())
            });
        }
        if request.code() == GetFirmwareVersionsRequest::CODE {
            return request.handle(|_, _: GetFirmwareVersionsRequest| async {
                panic!("as it is asked to");
            });
        }
        self.0.call(request)
    }
}

/// Limits of the connections at each port, in total and from one address.
#[derive(Clone, Copy)]
pub struct Places {
    pub total: usize,
    pub address: usize,
}

impl Places {
    /// Enough for ten thousand apps. A flood from one address leaves 1,000 connections for other addresses.
    pub const MANY: Self = Self {
        total: 20_000,
        address: 19_000,
    };
}

/// Serves until standard input ends. Prints `listening PORT PORT` first. Accepts the orders `push A_SECOND`, `counters`
/// and `shutdown MILLISECONDS`, and prints a line after each.
pub async fn serve(places: Places) -> Result<(), Fault> {
    // Printing a panic is not part of the runtime, so it must not count.
    std::panic::set_hook(Box::new(|_| {}));
    let limits = Limits {
        connections: places.total,
        ..Fc::DEFAULTS.limits
    };
    let config = ServerConfig::new()
        .address(Ipv4Addr::LOCALHOST)
        .command_port(0)
        .data_port(0)
        .connections_per_address(places.address)
        .limits(limits);
    let server = Server::bind(
        config,
        Thoughtful(RobotService::new(ExampleRobot::default())),
    )
    .await?;
    let (command, data) = (server.command_addr().port(), server.data_addr().port());
    println!("listening {command} {data}");
    let handle = server.handle();
    tokio::spawn(server.run());
    let mut pushing = JoinSet::new();
    let mut lines = BufReader::new(tokio::io::stdin()).lines();
    while let Some(line) = lines.next_line().await? {
        match line.split_once(' ').unwrap_or((&line, "")) {
            ("push", rate) => {
                pushing.abort_all();
                let rate: u32 = rate.parse()?;
                if rate > 0 {
                    pushing.spawn(push(handle.clone(), Duration::from_secs(1) / rate));
                }
                println!("pushing");
            }
            ("counters", _) => println!("{:?}", handle.counters()),
            ("shutdown", grace) => {
                let start = Instant::now();
                handle.shutdown(Duration::from_millis(grace.parse()?)).await;
                println!("over {}", start.elapsed().as_millis());
            }
            _ => println!("what?"),
        }
    }
    Ok(())
}

/// Pushes a report to all apps at regular intervals, without waiting for earlier pushes.
async fn push(handle: ServerHandle<Fc>, every: Duration) {
    let mut turn = interval(every);
    let mut open = JoinSet::new();
    loop {
        turn.tick().await;
        while open.try_join_next().is_some() {}
        let handle = handle.clone();
        open.spawn(async move { handle.push(Audience::All, &RobotStatus::example()).await });
    }
}

/// The parent's handle to the robot. Dropping it kills the process.
pub struct Robot {
    child: Child,
    stdin: ChildStdin,
    lines: Lines<BufReader<ChildStdout>>,
    /// Port for commands.
    pub port: u16,
    /// Port for streams.
    pub data: u16,
    pub process: u32,
}

impl Robot {
    pub async fn start(places: Places) -> Result<Self, Fault> {
        let mut child = tokio::process::Command::new(std::env::current_exe()?)
            .args([
                "robot",
                &places.total.to_string(),
                &places.address.to_string(),
            ])
            // The unit in `operations/` sets this too, so that freed memory returns to the system.
            .env("MALLOC_MMAP_THRESHOLD_", "131072")
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .kill_on_drop(true)
            .spawn()?;
        let stdin = child.stdin.take().ok_or("no standard input")?;
        let stdout = child.stdout.take().ok_or("no standard output")?;
        let mut lines = BufReader::new(stdout).lines();
        let line = lines.next_line().await?.ok_or("the robot has ended")?;
        let ports = line.strip_prefix("listening ").ok_or("no port")?;
        let (port, data) = ports.split_once(' ').ok_or("no port of streams")?;
        let (port, data) = (port.parse()?, data.parse()?);
        let process = child.id().ok_or("the robot has ended")?;
        Ok(Self {
            child,
            stdin,
            lines,
            port,
            data,
            process,
        })
    }

    /// Sends an order to the robot and returns the line that it prints.
    pub async fn tell(&mut self, what: &str) -> Result<String, Fault> {
        self.stdin.write_all(format!("{what}\n").as_bytes()).await?;
        Ok(self.lines.next_line().await?.ok_or("the robot has ended")?)
    }

    pub async fn end(mut self) -> Result<(), Fault> {
        self.child.kill().await?;
        Ok(())
    }
}
