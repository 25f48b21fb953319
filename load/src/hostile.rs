//! Peers that do not mean well, and what they cost the others.

use crate::Fault;
use crate::apps::{connect, latencies};
use crate::measure::{machine, quantile, resident};
use crate::robot::Robot;
use fc_generated::Fc;
use fc_runtime::{Encoder, FrameId, Gzip, Header, Protocol, digest};
use std::process::Stdio;
use std::time::Duration;
use tokio::io::{AsyncReadExt, AsyncWriteExt};
use tokio::net::TcpStream;
use tokio::time::{sleep, timeout};

/// Each attack and what it is called in the table.
const ATTACKS: &[(&str, &str)] = &[
    ("bombs", "gzip bombs: 64 MiB of nothing in 64 KiB, and one that lies about it"),
    ("lengths", "lying lengths: 0, 34, 2^32-1"),
    ("slow", "1,000 slow senders: a byte each second"),
    ("codes", "a flood of unknown codes, answers read"),
    ("deaf", "a flood of unknown codes, answers not read"),
    ("frames", "a flood of damaged frames"),
    ("reports", "100 apps that acknowledge nothing, 20,000 reports pushed"),
    ("connections", "a flood of connections, opened and closed"),
];

type Head = <Fc as Protocol>::Header;

fn id(code: u16) -> FrameId {
    FrameId { response: false, kind: Fc::COMMAND, code, id: 7 }
}

fn frame(code: u16, body: &[u8]) -> Result<Vec<u8>, Fault> {
    let mut out = Vec::new();
    Encoder::<Fc>::new().bytes(&mut out, id(code), body)?;
    Ok(out)
}

/// Compares an app's latency under each attack with that before and after it.
pub async fn compare() -> Result<(), Fault> {
    println!("\n## Hostile peers\n\n{}\n", machine());
    println!("An app calls one command after the other; attackers are a process of their own at the lowest");
    println!("priority. Ratios are of latencies under attack to those in the quiet just before and after.\n");
    println!("| attack | median | 99 % | robot's memory, MiB more |\n|---|--:|--:|--:|");
    let rounds = crate::number("FC_ROUNDS", 3)?;
    for (kind, what) in ATTACKS {
        let mut robot = Robot::start().await?;
        let app = connect(robot.port).await?;
        latencies(&app, 2000).await?;
        let before = resident(robot.process)?;
        let (mut most, mut quiet, mut loud) = (before, Vec::new(), Vec::new());
        for _ in 0..rounds {
            quiet.append(&mut latencies(&app, 3000).await?);
            let mut attacker = tokio::process::Command::new("nice")
                .arg("-n19")
                .arg(std::env::current_exe()?)
                .args(["attack", kind, &robot.port.to_string()])
                .stdin(Stdio::null())
                .kill_on_drop(true)
                .spawn()?;
            sleep(Duration::from_millis(1500)).await;
            if *kind == "reports" {
                robot.tell("push 20000").await?;
            }
            loud.append(&mut latencies(&app, 3000).await?);
            most = most.max(resident(robot.process)?);
            if let Some(status) = attacker.try_wait()? {
                return Err(format!("the attacker has given up: {status}").into());
            }
            attacker.kill().await?;
            sleep(Duration::from_millis(500)).await;
        }
        quiet.append(&mut latencies(&app, 3000).await?);
        let mut ratio = |share| {
            quantile(&mut loud, share).as_secs_f64() / quantile(&mut quiet, share).as_secs_f64()
        };
        println!(
            "| {what} | {:.2} | {:.2} | {:.1} |",
            ratio(0.5),
            ratio(0.99),
            (most - before) as f64 / 1024.0
        );
        robot.end().await?;
    }
    Ok(())
}

/// Attacks until it is killed.
pub async fn attack(kind: &str, port: u16) -> Result<(), Fault> {
    match kind {
        "bombs" => bombs(port).await,
        "lengths" => lengths(port).await,
        "slow" => slow(port).await,
        "codes" => flood(port, frame(0xEEEE, b"{}")?, true).await,
        "deaf" => deaf(port).await,
        "frames" => {
            let mut damaged = frame(0x0A01, b"{}")?;
            if let Some(last) = damaged.last_mut() {
                *last ^= 1;
            }
            flood(port, damaged, true).await
        }
        "reports" => {
            let mut idle = Vec::new();
            for _ in 0..100 {
                idle.push(reach(port).await?);
            }
            std::future::pending().await
        }
        "connections" => loop {
            let mut some = Vec::new();
            for _ in 0..100 {
                some.push(reach(port).await?);
            }
        },
        other => Err(format!("no such attack: {other}").into()),
    }
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
    let mut tasks = tokio::task::JoinSet::new();
    for _ in 0..4 {
        let many = many.clone();
        let (mut from, mut to) = reach(port).await?.into_split();
        tasks.spawn(async move {
            let mut sink = vec![0; 64 * 1024];
            while read && from.read(&mut sink).await.is_ok_and(|n| n > 0) {}
            std::future::pending::<()>().await;
        });
        tasks.spawn(async move {
            while to.write_all(&many).await.is_ok() {}
        });
    }
    while tasks.join_next().await.is_some() {}
    Ok(())
}

async fn deaf(port: u16) -> Result<(), Fault> {
    let many = frame(0xEEEE, b"{}")?.repeat(1000);
    loop {
        let mut kept = Vec::new();
        for _ in 0..20 {
            let mut stream = reach(port).await?;
            // As much as is taken; then the robot has stopped reading.
            while timeout(Duration::from_millis(20), stream.write_all(&many)).await.is_ok_and(|sent| sent.is_ok()) {}
            kept.push(stream);
        }
    }
}

async fn bombs(port: u16) -> Result<(), Fault> {
    let most = Fc::DEFAULTS.limits.inflated_bytes as usize;
    let mut bomb = Vec::new();
    let mut encoder = Encoder::<Fc>::new().gzip(Gzip { from_bytes: 0, level: 9 });
    encoder.bytes(&mut bomb, id(0x0A01), &vec![b' '; most])?;
    let mut liar = bomb.clone();
    let (front, data) = liar.split_at_mut(Head::LEN);
    let mut header = Head::read(front).ok_or("no header")?;
    header.seal(header.total_length(), 100, digest(data));
    header.write(front);
    flood(port, [bomb, liar].concat(), true).await
}

async fn lengths(port: u16) -> Result<(), Fault> {
    let honest = frame(0x0A01, b"{}")?;
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
    let bytes = frame(0x0A01, &[b' '; 200])?;
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
