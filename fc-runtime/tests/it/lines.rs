//! Log lines at level INFO: one line for each event of a connection, and no flood.

use crate::common::log::Log;
use crate::common::net::{Raw, Robot, app_of_raw, loopback, nowhere, service};
use crate::common::{
    Echo, Go, LIMITS, Moved, Toy, UnderWay, answer_to, command, frame, report, result, until,
};
use fc_runtime::{Backoff, ClientConfig, Command, Connection, Limits, Report};
use std::time::Duration;
use tokio::io::duplex;
use tokio::sync::mpsc;
use tracing::Level;

/// Lines of one cause and connection that a minute may bring; of connections that come and go, a second.
const LINES: usize = 5;

const MINUTE: Duration = Duration::from_secs(60);

fn has(line: &str, words: &[&str]) {
    for word in words {
        assert!(line.contains(word), "no {word} in {line}");
    }
}

fn echo() -> Echo {
    Echo { text: "x".into() }
}

#[fc_test::test(start_paused = true)]
async fn the_life_of_an_apps_connection() {
    let log = Log::listen(Level::INFO);
    // Connects, then fails three times, connects again and fails for good.
    let mut script = "+---+----".chars();
    let (pipes, mut dialled) = mpsc::channel(1);
    let dial = move || {
        let pipe = (script.next() == Some('+')).then(|| duplex(1000));
        let pipes = pipes.clone();
        async move {
            let (app, robot) = pipe.ok_or(std::io::ErrorKind::ConnectionRefused)?;
            pipes.send(robot).await.unwrap();
            Ok(app)
        }
    };
    let config = ClientConfig::new()
        .host("robot-7")
        .command_port(9000)
        .reconnect(Backoff {
            attempts: Some(4),
            ..Backoff::default()
        });
    let app = Connection::<Toy>::connect_by(dial, config).await.unwrap();
    let address = "address=\"robot-7:9000\"";
    has(
        &log.take_once(1).await[0],
        &["INFO connected", "protocol=\"toy\"", address, "connects=1"],
    );
    drop(dialled.recv().await.unwrap());
    let mut robot = Raw::new(dialled.recv().await.unwrap());
    let lines = log.take_once(3).await;
    has(
        &lines[0],
        &["WARN lost", address, "reason=\"closed_unheard\""],
    );
    // One line for an attempt after the other that fails for the same reason.
    has(
        &lines[1],
        &[
            "WARN cannot connect: connection refused protocol",
            address,
            "reason=\"unreachable\"",
        ],
    );
    has(
        &lines[2],
        &["INFO connected again", address, "connects=2", "failed=3"],
    );
    robot.send(b"HTTP/1.1").await;
    assert_eq!(app.reports().recv().await, None);
    let lines = log.take_once(3).await;
    has(&lines[0], &["WARN lost", address, "reason=\"bad_head\""]);
    has(&lines[1], &["WARN cannot connect"]);
    has(
        &lines[2],
        &["WARN given up", address, "reason=\"unreachable\""],
    );
}

#[fc_test::test]
async fn an_app_that_closes_is_no_loss() {
    let log = Log::listen(Level::INFO);
    let (app, mut robot) = app_of_raw(ClientConfig::new());
    log.take_once(1).await;
    app.close();
    assert_eq!(robot.recv().await, None);
    has(
        &log.take_once(1).await[0],
        &["INFO closed", "protocol=\"toy\""],
    );
}

#[fc_test::test]
async fn the_life_of_a_robots_connections() {
    let log = Log::listen(Level::INFO);
    let limits = Limits {
        connections: 1,
        ..LIMITS
    };
    let robot = Robot::start(loopback().limits(limits), service).await;
    has(
        &log.take_once(1).await[0],
        &["INFO listening", &format!("command={}", robot.command)],
    );
    let mut app = robot.raw();
    let peer = format!("peer={}", nowhere());
    let line = log.take_once(1).await.remove(0);
    has(
        &line,
        &["INFO connected", "connection=1", "port=\"command\"", &peer],
    );
    // One that has sent nothing would give way to the next.
    app.send_frame(command(Echo::CODE, 1), r#"{"text":"x"}"#)
        .await;
    app.recv().await.unwrap();
    let (_other, end) = duplex(100);
    assert_eq!(robot.handle.serve(end, nowhere()), None);
    let line = log.take_once(1).await.remove(0);
    has(
        &line,
        &["WARN refused", "too many connections", "peer=127.0.0.1"],
    );
    app.send(b"HTTP/1.1").await;
    assert_eq!(app.recv().await, None);
    drop(app);
    let lines = log.take_once(2).await;
    has(&lines[0], &["WARN", "bad_head", "connection=1", &peer]);
    has(
        &lines[1],
        &["INFO ended", "reason=\"bad_head\"", "connection=1", &peer],
    );
    let data = robot.raw_data();
    has(
        &log.take_once(1).await[0],
        &["INFO connected", "port=\"data\"", &peer],
    );
    drop(data);
    has(
        &log.take_once(1).await[0],
        &["INFO ended", "port=\"data\"", &peer],
    );
    robot.handle.shutdown(Duration::from_secs(1)).await;
    has(&log.take_once(1).await[0], &["INFO shutting down"]);
}

fn damaged(id: fc_runtime::FrameId) -> Vec<u8> {
    let mut bytes = frame(id, b"x");
    *bytes.last_mut().unwrap() ^= 1;
    bytes
}

/// Contains the number of suppressed lines.
fn held(lines: &[String], times: usize) {
    assert_eq!(lines.len(), LINES + 1, "{lines:#?}");
    has(&lines[LINES], &[&format!("held={}", times - LINES)]);
}

#[fc_test::test(start_paused = true)]
async fn damaged_frames_do_not_flood_an_apps_log() {
    let log = Log::listen(Level::INFO);
    let (app, mut robot) = app_of_raw(ClientConfig::new());
    for id in 0..2000 {
        robot.send(&damaged(answer_to(command(1, id)))).await;
    }
    until(|| app.counters().bad_frames >= 2000).await;
    assert_eq!(log.with("bad_digest").len(), LINES);
    tokio::time::advance(Duration::from_secs(59)).await;
    robot.send(&damaged(answer_to(command(1, 1)))).await;
    until(|| app.counters().bad_frames >= 2001).await;
    assert_eq!(log.with("bad_digest").len(), LINES);
    tokio::time::advance(Duration::from_secs(1)).await;
    robot.send(&damaged(answer_to(command(1, 1)))).await;
    until(|| app.counters().bad_frames >= 2002).await;
    held(&log.with("bad_digest"), 2001);
}

#[fc_test::test(start_paused = true)]
async fn undelivered_reports_are_logged_with_a_limit() {
    let log = Log::listen(Level::INFO);
    let (app, mut robot) = app_of_raw(ClientConfig::new());
    let mut send = async |from: u32, count: u32| {
        for id in from..from + count {
            let body = if id % 2 == 0 { "{}" } else { r#"{"metres":1}"# };
            robot.send_frame(report(Moved::CODE, id), body).await;
        }
        let seen = || app.counters().reports_invalid + app.counters().reports_refused;
        until(|| seen() >= u64::from(from + count)).await;
    };
    send(0, 200).await;
    tokio::time::advance(MINUTE).await;
    send(200, 2).await;
    let lines = log.with("report refused");
    has(
        &lines[0],
        &["WARN", "error=\"missing_field\"", "code=2817", "msg_id=0"],
    );
    held(&lines, 100);
    let lines = log.with("report not taken");
    has(&lines[0], &["WARN", "code=2817", "msg_id=1"]);
    held(&lines, 100);
}

#[fc_test::test(start_paused = true)]
async fn calls_beyond_the_limit_are_logged_and_do_not_flood() {
    let log = Log::listen(Level::INFO);
    let limits = Limits {
        in_flight: 0,
        ..LIMITS
    };
    let (app, _robot) = app_of_raw(ClientConfig::new().limits(limits));
    for _ in 0..20 {
        assert_eq!(app.call(&echo()).await.unwrap_err().name(), "busy");
    }
    let lines = log.with("too many calls");
    has(&lines[0], &["WARN", "in_flight=0", "code=257"]);
    assert_eq!(lines.len(), LINES);
}

#[fc_test::test(start_paused = true)]
async fn neither_frames_nor_connections_flood_a_robots_log() {
    let log = Log::listen(Level::INFO);
    let limits = Limits {
        connections: 2,
        ..LIMITS
    };
    let robot = Robot::start(
        loopback().limits(limits).connections_per_address(2),
        service,
    )
    .await;
    let mut app = robot.raw();
    let mut other = robot.raw();
    for raw in [&mut app, &mut other] {
        raw.send_frame(command(Echo::CODE, 1), r#"{"text":"x"}"#)
            .await;
        raw.recv().await.unwrap();
    }
    for id in 0..100 {
        app.send(&damaged(command(Echo::CODE, id))).await;
        let (_, end) = duplex(100);
        assert_eq!(robot.handle.serve(end, nowhere()), None);
    }
    until(|| robot.handle.counters().bad_frames >= 100).await;
    assert_eq!(log.with("bad_digest").len(), LINES);
    assert_eq!(log.with("refused").len(), LINES);
    // Another connection has its own limit.
    other.send(&damaged(command(Echo::CODE, 1))).await;
    until(|| robot.handle.counters().bad_frames >= 101).await;
    assert_eq!(log.with("bad_digest").len(), LINES + 1);
}

#[fc_test::test(start_paused = true)]
async fn busy_robot_logs_the_limit() {
    let log = Log::listen(Level::INFO);
    let limits = Limits {
        in_flight: 0,
        ..LIMITS
    };
    let robot = Robot::start(loopback().limits(limits), service).await;
    let _app = robot.raw();
    until(|| !log.with("too many requests").is_empty()).await;
    has(
        &log.with("too many requests")[0],
        &["INFO", "connection=1", "in_flight=0"],
    );
}

#[fc_test::test(start_paused = true)]
async fn short_connections_are_logged_with_a_limit() {
    let log = Log::listen(Level::INFO);
    let robot = Robot::start(loopback(), service).await;
    for number in 0..50 {
        drop(robot.raw());
        until(|| robot.handle.connections().is_empty()).await;
        assert_eq!(robot.handle.counters().connections, number + 1);
    }
    assert_eq!(log.with("connected").len(), LINES);
    assert_eq!(log.with("ended").len(), LINES);
    tokio::time::advance(Duration::from_secs(1)).await;
    drop(robot.raw());
    until(|| robot.handle.connections().is_empty()).await;
    held(&log.with("connected"), 50);
    held(&log.with("ended"), 50);
}

/// Frequent state changes do not flood the log, and the line contains their number.
#[fc_test::test(start_paused = true)]
async fn reports_out_of_order_are_thinned() {
    let log = Log::listen(Level::INFO);
    let (app, mut robot) = app_of_raw(ClientConfig::new());
    let answered = async {
        let (id, _) = robot.recv().await.unwrap();
        robot.send_frame(answer_to(id), &result(7)).await;
    };
    let go = Go { metres: 3 };
    let (following, ()) = tokio::join!(app.call(&go).follow::<UnderWay>(), answered);
    let mut following = following.unwrap();
    let mut ids = 1000..;
    let mut send = async |step: &str| {
        let id = report(UnderWay::CODE, ids.next().unwrap());
        let text = format!(r#"{{"at":1,"step":"{step}"}}"#);
        robot.send_frame(id, &text).await;
        robot.result().await;
        following.recv().await.unwrap().unwrap()
    };
    let steps = ["ready", "rolling"];
    for step in steps.iter().cycle().take(20) {
        send(step).await;
    }
    // From rolling to ready, nine times, within no time at all.
    assert_eq!(app.counters().reports_out_of_order, 9);
    let soon = log.with("report out of order");
    assert!((1..=LINES).contains(&soon.len()), "{soon:#?}");
    has(&soon[0], &["INFO", "name=\"under_way\""]);
    tokio::time::advance(MINUTE).await;
    send("ready").await;
    let later = log.with("report out of order");
    let held = format!("held={}", 9 - soon.len());
    has(later.last().unwrap(), &[&held]);
}
