//! Measures the latency of an app while hostile peers attack the robot.

use crate::apps::{config, connect, latencies};
use crate::attacks::{FEW, frame, from};
use crate::environment::number;
use crate::fault::Fault;
use crate::measure::{forget_peak, machine, peak, quantile, resident};
use crate::robot::{Places, Robot};
use fc_generated::{Fc, GetRobotSnRequest};
use fc_runtime::{Command as _, Connection};
use std::net::Ipv4Addr;
use std::process::Stdio;
use std::time::Duration;
use tokio::io::{AsyncReadExt, AsyncWriteExt};
use tokio::process::Child;
use tokio::time::{sleep, timeout};

/// The attacks, each with its description in the table and the honest work to compare it with.
const ATTACKS: &[(&str, &str, &str)] = &[
    (
        "bombs",
        "gzip bombs: 64 MiB of nothing in 64 KiB, and one that lies about it",
        "large",
    ),
    (
        "keys",
        "gzip bombs of keys: 64 and 36 MiB of `\"a\":[],`, and as many as are read",
        "large",
    ),
    ("lengths", "lying lengths: 0, 34, 2^32-1", "visitors"),
    ("slow", "1,000 slow senders: a byte each second", "idle"),
    (
        "held",
        "64 frames of 16 MiB of which the last comes at 2 KiB a second",
        "large",
    ),
    ("codes", "a flood of unknown codes, answers read", "calls"),
    (
        "deaf",
        "a flood of unknown codes, answers not read",
        "calls",
    ),
    ("frames", "a flood of damaged frames", "calls"),
    (
        "panics",
        "a flood of requests whose handler panics",
        "calls",
    ),
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
    (
        "silent",
        "an address that fills both ports with silent connections",
        "idle",
    ),
];

/// Reports that the robot pushes to all apps each second. The texts in [`ATTACKS`] and [`HONEST`] repeat this number.
const REPORTS: u32 = 20;

/// A process that attacks or does honest work. It has the lowest priority, so that its own CPU time does not slow the
/// app down.
struct Neighbour(Child);

impl Neighbour {
    async fn start(kind: &str, robot: &mut Robot) -> Result<Self, Fault> {
        let child = tokio::process::Command::new("chrt")
            .args(["--idle", "0"])
            .arg(std::env::current_exe()?)
            .args([
                "attack",
                kind,
                &robot.port.to_string(),
                &robot.data.to_string(),
            ])
            .stdin(Stdio::null())
            .kill_on_drop(true)
            .spawn()
            .map_err(|error| format!("neighbours are started by `chrt` of util-linux: {error}"))?;
        // Time for opening all connections and sending the held frames.
        let begun = if matches!(kind, "held" | "silent") {
            5000
        } else {
            1500
        };
        sleep(Duration::from_millis(begun)).await;
        if matches!(kind, "reports" | "listeners") {
            robot.tell(&format!("push {REPORTS}")).await?;
            // Time until the limit of reports in flight is reached and the robot repeats them.
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

/// Address of a client that has no connection yet.
const NEWCOMER: Ipv4Addr = Ipv4Addr::new(127, 0, 0, 2);

/// Returns `true` if both ports serve a client from another address within five seconds.
async fn newcomer(robot: &Robot) -> bool {
    let (command, data) = (robot.port, robot.data);
    let come = async {
        let dial = move || from(NEWCOMER, command);
        let app = Connection::<Fc>::connect_by(dial, config(command)).await?;
        app.call(&GetRobotSnRequest::default()).await?;
        // The data port refuses a command, but its response shows that the robot serves the client.
        let mut stream = from(NEWCOMER, data).await?;
        stream
            .write_all(&frame(GetRobotSnRequest::CODE, b"{}")?)
            .await?;
        stream.read_u8().await?;
        Ok::<_, Fault>(())
    };
    matches!(timeout(Duration::from_secs(5), come).await, Ok(Ok(())))
}

/// Returns the median and the 99th percentile of an app's latency, in seconds.
async fn latency(app: &Connection<Fc>) -> Result<[f64; 2], Fault> {
    let mut times = latencies(app, 3000).await?;
    Ok([0.5, 0.99].map(|share| quantile(&mut times, share).as_secs_f64()))
}

fn median(mut ratios: Vec<f64>) -> f64 {
    ratios.sort_unstable_by(f64::total_cmp);
    ratios.get(ratios.len() / 2).copied().unwrap_or_default()
}

/// Compares an app's latency during each attack, and during honest work, with its latency without either.
pub async fn compare() -> Result<(), Fault> {
    println!("\n## Hostile peers\n\n{}\n", machine());
    println!(
        "An app calls one command after the other. Beside it are, in turns, nobody, honest neighbours and"
    );
    println!(
        "attackers, processes of their own at the lowest priority. Ratios are of latencies to those in the"
    );
    println!(
        "quiet before and after, medians over the rounds; in brackets those beside the honest. The peak is that"
    );
    println!(
        "of the robot's memory beside attackers. A newcomer from another address is one who is served at both"
    );
    println!("ports within five seconds meanwhile, in so many of the rounds.\n");
    println!(
        "| attack (honest work) | median | 99 % | robot's memory, MiB more | its peak, MiB | newcomers |\n|---|--:|--:|--:|--:|--:|"
    );
    let rounds = number("FC_ROUNDS", 5)?;
    let only = std::env::var("FC_ATTACK").ok();
    let chosen = |kind: &str| only.as_ref().is_none_or(|only| only == kind);
    for (kind, what, honest) in ATTACKS.iter().filter(|(kind, ..)| chosen(kind)) {
        let places = if *kind == "silent" { FEW } else { Places::MANY };
        let mut robot = Robot::start(places).await?;
        let app = connect(robot.port).await?;
        latencies(&app, 2000).await?;
        let before = resident(robot.process)?;
        let (mut most, mut highest, mut served) = (before, 0, 0);
        // By neighbour (attack, honest work), then by figure (median, 99 %).
        let mut ratios: [[Vec<f64>; 2]; 2] = Default::default();
        let mut quiet = latency(&app).await?;
        for _ in 0..rounds {
            for (who, ratios) in [kind, honest].into_iter().zip(&mut ratios) {
                forget_peak(robot.process)?;
                let neighbour = Neighbour::start(who, &mut robot).await?;
                let loud = latency(&app).await?;
                if who == kind {
                    most = most.max(resident(robot.process)?);
                    highest = highest.max(peak(robot.process)?);
                    served += usize::from(newcomer(&robot).await);
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
            "| {what} ({honest}) | {p50:.2} ({honest_p50:.2}) | {p99:.2} ({honest_p99:.2}) | {:.1} | {:.1} | {served} of {rounds} |",
            (most - before) as f64 / 1024.0,
            highest as f64 / 1024.0
        );
        robot.end().await?;
    }
    println!("\nhonest work: {HONEST}");
    Ok(())
}

const HONEST: &str = "`calls`, a flood of calls on four connections; `large`, the same with 64 KiB each; \
    `visitors`, a flood of connections with a call each; `idle`, 1,000 connections; `listeners`, 100 apps \
    that acknowledge 20 reports a second";
