//! Measures many apps, many calls, and the shutdown under load.

use crate::fault::Fault;
use crate::measure::{machine, quantile, resident};
use crate::robot::{Places, Robot, THINKING};
use fc_generated::{Fc, GetRobotSnRequest, GetStationRequest};
use fc_runtime::{ClientConfig, Connection, Message};
use std::collections::BTreeMap;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};
use tokio::task::JoinSet;
use tokio::time::sleep;

pub fn config(port: u16) -> ClientConfig {
    ClientConfig::new()
        .host("127.0.0.1")
        .command_port(port)
        .connect_timeout(Duration::from_secs(30))
        .call_timeout(Duration::from_secs(30))
        .reconnect(None)
}

pub async fn connect(port: u16) -> Result<Connection<Fc>, Fault> {
    Ok(Connection::connect(config(port)).await?)
}

/// Times consecutive calls, `count` of them or as many as fit into ten seconds.
pub async fn latencies(app: &Connection<Fc>, count: usize) -> Result<Vec<Duration>, Fault> {
    let request = GetRobotSnRequest::default();
    let mut times = Vec::with_capacity(count);
    let begin = Instant::now();
    while times.len() < count && begin.elapsed() < Duration::from_secs(10) {
        let start = Instant::now();
        app.call(&request).await?;
        times.push(start.elapsed());
    }
    Ok(times)
}

/// Opens `count` connections, makes one call on each, and keeps them open.
pub async fn connections(count: usize) -> Result<(), Fault> {
    println!("\n## {count} connections at once\n\n{}\n", machine());
    let robot = Robot::start(Places::MANY).await?;
    let one = connect(robot.port).await?;
    let mut alone = latencies(&one, 2000).await?;
    let (robot_before, apps_before) = (resident(robot.process)?, resident(std::process::id())?);
    let mut apps = Vec::with_capacity(count);
    let start = Instant::now();
    while apps.len() < count {
        let mut some = JoinSet::new();
        for _ in 0..100.min(count - apps.len()) {
            some.spawn(connect(robot.port));
        }
        while let Some(app) = some.join_next().await {
            apps.push(app??);
        }
    }
    let opened = start.elapsed();
    let (robot_open, apps_open) = (resident(robot.process)?, resident(std::process::id())?);
    for app in &apps {
        app.call(&GetRobotSnRequest::default()).await?;
    }
    let (robot_used, apps_used) = (resident(robot.process)?, resident(std::process::id())?);
    let mut beside = latencies(&one, 2000).await?;
    let each = |after: usize, before: usize| (after - before) as f64 / count as f64;
    println!("| memory per connection, KiB | robot | app |\n|---|--:|--:|");
    println!(
        "| open, nothing sent | {:.1} | {:.1} |",
        each(robot_open, robot_before),
        each(apps_open, apps_before)
    );
    println!(
        "| after one call | {:.1} | {:.1} |",
        each(robot_used, robot_before),
        each(apps_used, apps_before)
    );
    println!(
        "\nopened in {:.1} s; median latency of another app's calls beside them: {:.2} of that alone",
        opened.as_secs_f64(),
        quantile(&mut beside, 0.5).as_secs_f64() / quantile(&mut alone, 0.5).as_secs_f64()
    );
    drop(apps);
    robot.end().await
}

/// Makes `count` calls on four connections, with 64 in flight on each.
pub async fn calls(count: usize) -> Result<(), Fault> {
    println!("\n## {count} calls\n\n{}\n", machine());
    let mut robot = Robot::start(Places::MANY).await?;
    let left = Arc::new(AtomicUsize::new(0));
    let mut apps = Vec::new();
    for _ in 0..4 {
        apps.push(connect(robot.port).await?);
    }
    println!("| calls | robot KiB | apps KiB |\n|--:|--:|--:|");
    let mut made = 0;
    let start = Instant::now();
    for share in [count / 10, count / 2 - count / 10, count - count / 2] {
        left.store(share, Ordering::Relaxed);
        let mut callers = JoinSet::new();
        for app in &apps {
            for _ in 0..64 {
                let (app, left) = (app.clone(), Arc::clone(&left));
                callers.spawn(async move {
                    let request = GetRobotSnRequest::default();
                    let one_less = |left: usize| left.checked_sub(1);
                    while left
                        .fetch_update(Ordering::Relaxed, Ordering::Relaxed, one_less)
                        .is_ok()
                    {
                        app.call(&request).await?;
                    }
                    Ok::<_, Fault>(())
                });
            }
        }
        while let Some(caller) = callers.join_next().await {
            caller??;
        }
        made += share;
        println!(
            "| {made} | {} | {} |",
            resident(robot.process)?,
            resident(std::process::id())?
        );
    }
    println!(
        "\n{:.0} calls per second; all answered with success",
        count as f64 / start.elapsed().as_secs_f64()
    );
    let counters = robot.tell("counters").await?;
    assert!(
        counters.contains(&format!("calls_succeeded: {count},")),
        "{counters}"
    );
    robot.end().await
}

/// Shuts the robot down while 100 apps have eight slow calls each in flight, with a long and a short grace period.
pub async fn shutdown() -> Result<(), Fault> {
    println!("\n## Shutdown under load\n\n{}\n", machine());
    println!(
        "800 calls in flight on 100 connections, each handled in {} ms.\n",
        THINKING.as_millis()
    );
    println!("| grace, ms | over after, ms | how the calls ended |\n|--:|--:|---|");
    for grace in [5000, 100] {
        let mut robot = Robot::start(Places::MANY).await?;
        let mut calls = JoinSet::new();
        let mut apps = Vec::new();
        for _ in 0..100 {
            let app = connect(robot.port).await?;
            for _ in 0..8 {
                let app = app.clone();
                calls.spawn(async move { app.call(&GetStationRequest::example()).await });
            }
            apps.push(app);
        }
        sleep(THINKING / 2).await;
        let over = robot.tell(&format!("shutdown {grace}")).await?;
        let mut ends = BTreeMap::<&str, usize>::new();
        while let Some(end) = calls.join_next().await {
            *ends
                .entry(end?.map_or_else(|error| error.name(), |_| "answered"))
                .or_default() += 1;
        }
        let ends: Vec<_> = ends
            .iter()
            .map(|(end, count)| format!("{count} {end}"))
            .collect();
        println!(
            "| {grace} | {} | {} |",
            over.trim_start_matches("over "),
            ends.join(", ")
        );
        robot.end().await?;
    }
    Ok(())
}
