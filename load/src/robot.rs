//! The robot: a process of its own that is told what to do on its standard input.

use crate::Fault;
use fc_generated::{ExampleRobot, Fc, GetStationRequest, RobotService, RobotStatus};
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

/// How long the robot thinks about [`GetStationRequest`].
pub const THINKING: Duration = Duration::from_secs(1);

/// Answers with the examples, and one command only after some time.
struct Thoughtful(RobotService<ExampleRobot>);

impl Service<Fc> for Thoughtful {
    fn call(&self, request: Request<'_, Fc>) -> Handling {
        if request.code() == GetStationRequest::CODE {
            return request.handle(|_, _: GetStationRequest| async {
                sleep(THINKING).await;
                Ok(<GetStationRequest as Command>::Response::example())
            });
        }
        self.0.call(request)
    }
}

/// Serves until standard input ends. Says `listening PORT` first; understands `push A_SECOND`,
/// `counters` and `shutdown MILLISECONDS`, and answers each with a line.
pub async fn serve() -> Result<(), Fault> {
    let limits = Limits {
        connections: 20_000,
        ..Fc::DEFAULTS.limits
    };
    let config = ServerConfig::new()
        .address(Ipv4Addr::LOCALHOST)
        .command_port(0)
        .data_port(0)
        // Half of a flood's address is for others.
        .connections_per_address(19_000)
        .limits(limits);
    let server = Server::bind(
        config,
        Thoughtful(RobotService::new(ExampleRobot::default())),
    )
    .await?;
    println!("listening {}", server.command_addr().port());
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

/// Pushes a report to all apps again and again, whatever becomes of the last.
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

/// The robot as its parent sees it; ends with it.
pub struct Robot {
    child: Child,
    stdin: ChildStdin,
    lines: Lines<BufReader<ChildStdout>>,
    pub port: u16,
    pub process: u32,
}

impl Robot {
    pub async fn start() -> Result<Self, Fault> {
        let mut child = tokio::process::Command::new(std::env::current_exe()?)
            .arg("robot")
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .kill_on_drop(true)
            .spawn()?;
        let stdin = child.stdin.take().ok_or("no standard input")?;
        let stdout = child.stdout.take().ok_or("no standard output")?;
        let mut lines = BufReader::new(stdout).lines();
        let line = lines.next_line().await?.ok_or("the robot has ended")?;
        let port = line.strip_prefix("listening ").ok_or("no port")?.parse()?;
        let process = child.id().ok_or("the robot has ended")?;
        Ok(Self {
            child,
            stdin,
            lines,
            port,
            process,
        })
    }

    /// Tells the robot something and gives its answer.
    pub async fn tell(&mut self, what: &str) -> Result<String, Fault> {
        self.stdin.write_all(format!("{what}\n").as_bytes()).await?;
        Ok(self.lines.next_line().await?.ok_or("the robot has ended")?)
    }

    pub async fn end(mut self) -> Result<(), Fault> {
        self.child.kill().await?;
        Ok(())
    }
}
