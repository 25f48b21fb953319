//! Peers that do not mean well, and what they cost the others.

use crate::Fault;
use crate::apps::{connect, latencies};
use crate::measure::{machine, quantile, resident};
use crate::robot::Robot;
use fc_generated::{Fc, GetRobotSnRequest};
use fc_runtime::{Command as _, Connection, Encoder, FrameId, Gzip, Header, Protocol, digest};
use std::process::Stdio;
use std::time::Duration;
use tokio::io::{AsyncReadExt, AsyncWriteExt};
use tokio::net::TcpStream;
use tokio::process::Child;
use tokio::task::JoinSet;
use tokio::time::{sleep, timeout};

/// An attack, what it is called in the table, and the honest work it is compared with.
const ATTACKS: &[(&str, &str, &str)] = &[
    (
        "bombs",
        "gzip bombs: 64 MiB of nothing in 64 KiB, and one that lies about it",
        "large",
    ),
    ("lengths", "lying lengths: 0, 34, 2^32-1", "visitors"),
    ("slow", "1,000 slow senders: a byte each second", "idle"),
    ("codes", "a flood of unknown codes, answers read", "calls"),
    (
        "deaf",
        "a flood of unknown codes, answers not read",
        "calls",
    ),
    ("frames", "a flood of damaged frames", "calls"),
    (
        "reports",
        "100 apps that acknowledge nothing, 20 reports a second",
        "listeners",
    ),
    (
        "connections",
        "a flood of connections, opened and closed",
        "visitors",
    ),
];

type Head = <Fc as Protocol>::Header;

/// Reports that a robot pushes each second to all apps; [`ATTACKS`] and [`HONEST`] say how many, too.
const REPORTS: u32 = 20;

/// No command has this code.
const UNKNOWN: u16 = 0xEEEE;

fn id(code: u16) -> FrameId {
    FrameId {
        response: false,
        kind: Fc::COMMAND,
        code,
        id: 7,
    }
}

fn frame(code: u16, body: &[u8]) -> Result<Vec<u8>, Fault> {
    let mut out = Vec::new();
    Encoder::<Fc>::new().bytes(&mut out, id(code), body)?;
    Ok(out)
}

/// A process that attacks, or does honest work, at the lowest priority: its own need for the
/// processor is not what is measured.
struct Neighbour(Child);

impl Neighbour {
    async fn start(kind: &str, robot: &mut Robot) -> Result<Self, Fault> {
        let child = tokio::process::Command::new("chrt")
            .args(["--idle", "0"])
            .arg(std::env::current_exe()?)
            .args(["attack", kind, &robot.port.to_string()])
            .stdin(Stdio::null())
            .kill_on_drop(true)
            .spawn()
            .map_err(|error| format!("neighbours are started by `chrt` of util-linux: {error}"))?;
        sleep(Duration::from_millis(1500)).await;
        if matches!(kind, "reports" | "listeners") {
            robot.tell(&format!("push {REPORTS}")).await?;
            // Until as many are in flight as may be, and are sent again and again.
            sleep(Duration::from_secs(10)).await;
        }
        Ok(Self(child))
    }

    async fn end(mut self, robot: &mut Robot) -> Result<(), Fault> {
        robot.tell("push 0").await?;
        if let Some(status) = self.0.try_wait()? {
            return Err(format!("a neighbour has given up: {status}").into());
        }
        self.0.kill().await?;
        sleep(Duration::from_millis(500)).await;
        Ok(())
    }
}

/// Median and 99th percentile of an app's latency.
async fn latency(app: &Connection<Fc>) -> Result<[f64; 2], Fault> {
    let mut times = latencies(app, 3000).await?;
    Ok([0.5, 0.99].map(|share| quantile(&mut times, share).as_secs_f64()))
}

fn median(mut ratios: Vec<f64>) -> f64 {
    ratios.sort_unstable_by(f64::total_cmp);
    ratios.get(ratios.len() / 2).copied().unwrap_or_default()
}

/// Compares an app's latency beside each attack, and beside honest work, with that in the quiet.
pub async fn compare() -> Result<(), Fault> {
    println!("\n## Hostile peers\n\n{}\n", machine());
    println!(
        "An app calls one command after the other. Beside it are, in turns, nobody, honest neighbours and"
    );
    println!(
        "attackers, processes of their own at the lowest priority. Ratios are of latencies to those in the"
    );
    println!(
        "quiet before and after, medians over the rounds; in brackets those beside the honest.\n"
    );
    println!(
        "| attack (honest work) | median | 99 % | robot's memory, MiB more |\n|---|--:|--:|--:|"
    );
    let rounds = crate::number("FC_ROUNDS", 5)?;
    let only = std::env::var("FC_ATTACK").ok();
    let chosen = |kind: &str| only.as_ref().is_none_or(|only| only == kind);
    for (kind, what, honest) in ATTACKS.iter().filter(|(kind, ..)| chosen(kind)) {
        let mut robot = Robot::start().await?;
        let app = connect(robot.port).await?;
        latencies(&app, 2000).await?;
        let before = resident(robot.process)?;
        let mut most = before;
        // Median and 99 %, of attacks and honest work.
        let mut ratios: [[Vec<f64>; 2]; 2] = Default::default();
        let mut quiet = latency(&app).await?;
        for _ in 0..rounds {
            for (who, ratios) in [kind, honest].into_iter().zip(&mut ratios) {
                let neighbour = Neighbour::start(who, &mut robot).await?;
                let loud = latency(&app).await?;
                if who == kind {
                    most = most.max(resident(robot.process)?);
                }
                neighbour.end(&mut robot).await?;
                let after = latency(&app).await?;
                for (index, ratios) in ratios.iter_mut().enumerate() {
                    ratios.push(loud[index] / f64::midpoint(quiet[index], after[index]));
                }
                quiet = after;
            }
        }
        let [[p50, p99], [honest_p50, honest_p99]] = ratios.map(|both| both.map(median));
        println!(
            "| {what} ({honest}) | {p50:.2} ({honest_p50:.2}) | {p99:.2} ({honest_p99:.2}) | {:.1} |",
            (most - before) as f64 / 1024.0
        );
        robot.end().await?;
    }
    println!("\nhonest work: {HONEST}");
    Ok(())
}

const HONEST: &str = "`calls`, a flood of calls on four connections; `large`, the same with 64 KiB each; \
    `visitors`, a flood of connections with a call each; `idle`, 1,000 connections; `listeners`, 100 apps \
    that acknowledge 20 reports a second";

/// Attacks until it is killed.
pub async fn attack(kind: &str, port: u16) -> Result<(), Fault> {
    match kind {
        "bombs" => bombs(port).await,
        "lengths" => lengths(port).await,
        "slow" => slow(port).await,
        "codes" => flood(port, frame(UNKNOWN, b"{}")?, true).await,
        "deaf" => deaf(port).await,
        "frames" => {
            let mut damaged = frame(GetRobotSnRequest::CODE, b"{}")?;
            if let Some(last) = damaged.last_mut() {
                *last ^= 1;
            }
            flood(port, damaged, true).await
        }
        "reports" => stay(port, 100).await,
        "idle" => stay(port, 1000).await,
        "calls" => flood(port, frame(GetRobotSnRequest::CODE, b"{}")?, true).await,
        "large" => {
            let body = format!(r#"{{"text":"{}"}}"#, "x".repeat(64 * 1024));
            flood(port, frame(GetRobotSnRequest::CODE, body.as_bytes())?, true).await
        }
        "listeners" => listen(port).await,
        "visitors" => loop {
            let mut some = JoinSet::new();
            for _ in 0..100 {
                some.spawn(async move {
                    let app = connect(port).await?;
                    Ok::<_, Fault>(app.call(&GetRobotSnRequest::default()).await?)
                });
            }
            while let Some(visit) = some.join_next().await {
                visit??;
            }
        },
        "connections" => loop {
            let mut some = Vec::new();
            for _ in 0..100 {
                some.push(reach(port).await?);
            }
        },
        other => Err(format!("no such attack: {other}").into()),
    }
}

/// Opens connections and does nothing with them.
async fn stay(port: u16, count: usize) -> Result<(), Fault> {
    let mut idle = Vec::new();
    for _ in 0..count {
        idle.push(reach(port).await?);
    }
    std::future::pending().await
}

/// Takes and acknowledges reports on 100 connections.
async fn listen(port: u16) -> Result<(), Fault> {
    let mut listening = JoinSet::new();
    for _ in 0..100 {
        let mut reports = connect(port).await?.reports();
        listening.spawn(async move { while reports.recv().await.is_some() {} });
    }
    while listening.join_next().await.is_some() {}
    Ok(())
}

async fn reach(port: u16) -> Result<TcpStream, Fault> {
    loop {
        match TcpStream::connect(("127.0.0.1", port)).await {
            Ok(stream) => {
                // No trace of a thousand connections a second.
                #[allow(deprecated, reason = "an attacker does not wait for its close")]
                stream.set_linger(Some(Duration::ZERO))?;
                return Ok(stream);
            }
            Err(_) => sleep(Duration::from_millis(5)).await,
        }
    }
}

/// Sends the same frame over and over, on four connections.
async fn flood(port: u16, frame: Vec<u8>, read: bool) -> Result<(), Fault> {
    let many = frame.repeat(32 * 1024 / frame.len().max(1) + 1);
    let mut tasks = JoinSet::new();
    for _ in 0..4 {
        let many = many.clone();
        let (mut from, mut to) = reach(port).await?.into_split();
        tasks.spawn(async move {
            let mut sink = vec![0; 64 * 1024];
            while read && from.read(&mut sink).await.is_ok_and(|n| n > 0) {}
            std::future::pending::<()>().await;
        });
        tasks.spawn(async move { while to.write_all(&many).await.is_ok() {} });
    }
    while tasks.join_next().await.is_some() {}
    Ok(())
}

async fn deaf(port: u16) -> Result<(), Fault> {
    let many = frame(UNKNOWN, b"{}")?.repeat(1000);
    loop {
        let mut kept = Vec::new();
        for _ in 0..20 {
            let mut stream = reach(port).await?;
            // As much as is taken; then the robot has stopped reading.
            while timeout(Duration::from_millis(20), stream.write_all(&many))
                .await
                .is_ok_and(|sent| sent.is_ok())
            {}
            kept.push(stream);
        }
    }
}

async fn bombs(port: u16) -> Result<(), Fault> {
    let most = Fc::DEFAULTS.limits.inflated_bytes as usize;
    let mut bomb = Vec::new();
    let mut encoder = Encoder::<Fc>::new().gzip(Gzip {
        from_bytes: 0,
        level: 9,
    });
    encoder.bytes(&mut bomb, id(GetRobotSnRequest::CODE), &vec![b' '; most])?;
    let mut liar = bomb.clone();
    let (front, data) = liar.split_at_mut(Head::LEN);
    let mut header = Head::read(front).ok_or("no header")?;
    header.seal(header.total_length(), 100, digest(data));
    header.write(front);
    flood(port, [bomb, liar].concat(), true).await
}

async fn lengths(port: u16) -> Result<(), Fault> {
    let honest = frame(GetRobotSnRequest::CODE, b"{}")?;
    let mut header = Head::read(&honest).ok_or("no header")?;
    loop {
        for length in [0, 34, u32::MAX] {
            let mut lie = honest.clone();
            header.seal(length, 2, header.digest());
            header.write(&mut lie);
            let mut stream = reach(port).await?;
            let _ = stream.write_all(&lie).await;
            let _ = timeout(Duration::from_secs(1), stream.read(&mut [0; 100])).await;
        }
    }
}

async fn slow(port: u16) -> Result<(), Fault> {
    let bytes = frame(GetRobotSnRequest::CODE, &[b' '; 200])?;
    let mut slow = Vec::new();
    for _ in 0..1000 {
        slow.push(reach(port).await?);
    }
    for byte in bytes.iter().cycle() {
        for stream in &mut slow {
            if stream.write_all(std::slice::from_ref(byte)).await.is_err() {
                *stream = reach(port).await?;
            }
        }
        sleep(Duration::from_secs(1)).await;
    }
    Ok(())
}
