//! A robot and an app run alone for an hour of simulated time. Both restart, in order and out of order. The network
//! fails, versions differ, an app is slow, the robot has no room, and at last the robot does not return.
//!
//! After each event, the robot must serve the app again soon, and the app's states must show the event. No command may be
//! executed twice, and no report delivered twice. At the end, no resources may be left.
//!
//! The log of both at INFO and above is compared with `log.txt`. A reader must understand the hour from it. `cargo test
//! -p fc-runtime --test restarts -- --nocapture` prints it with the time of each line. `FC_WRITE_LOG=1` writes the file
//! again.
//!
//! The test failed with each of these changes:
//!
//! - No line is suppressed, or each failed attempt is logged.
//! - Motions are repeated after a loss.
//! - Waits have three times the length.
//! - States are missing, or connections stay in the robot's table.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::indexing_slicing,
    clippy::print_stdout,
    clippy::cast_possible_truncation,
    reason = "a test may"
)]

mod cable;
#[allow(
    dead_code,
    clippy::expect_used,
    clippy::indexing_slicing,
    reason = "a part of it is used here"
)]
#[path = "../it/common/mod.rs"]
mod common;
mod hour;
mod log;
mod traffic;

use common::net::Raw;
use common::{answer_to, frame};
use fc_derive::{Message, Report};
use fc_runtime::AckOutcome;
use hour::Hour;
use log::Line;
use peak_alloc::PeakAlloc;
use std::path::Path;
use std::time::Duration;
use tokio::time::sleep;

#[global_allocator]
static ALLOCATOR: PeakAlloc = PeakAlloc;

/// Memory that may remain after all events, in bytes.
const SLACK: usize = 16 * 1024;
/// Maximum number of lines for one event, with all its repetitions, of both sides.
const LINES: usize = 10;

/// Another version of [`Moved`](common::Moved).
#[derive(Clone, Debug, PartialEq, Message, Report)]
#[fc(code = 0x0B01, name = "moved")]
struct Other {
    metres: String,
}

const CLOSED: &str = "connecting closed_by_robot";
const UNREACHABLE: &str = "connecting unreachable";

#[fc_test::test(start_paused = true)]
async fn an_hour_alone() {
    let mut hour = Hour::begin();
    hour.event("the robot starts, and an app");
    hour.start_robot().await;
    hour.start_app();
    hour.is_served(1).await;
    assert_eq!(hour.states(), ["connected 1"]);

    hour.until(3, 10).await;
    let before = hour.held();

    hour.event("the robot is restarted, with SIGTERM, and takes four seconds");
    hour.is_moving().await;
    hour.stop_robot().await;
    sleep(Duration::from_secs(4)).await;
    hour.start_robot().await;
    hour.is_served(3).await;
    assert_eq!(hour.states(), [CLOSED, UNREACHABLE, "connected 2"]);

    hour.until(6, 10).await;
    hour.event("the robot's program crashes and is started again after a second, five times");
    for connects in 3..8 {
        hour.is_moving().await;
        hour.kill_robot();
        sleep(Duration::from_secs(1)).await;
        hour.start_robot().await;
        let again = format!("connected {connects}");
        hour.is_served(2).await;
        assert_eq!(hour.states(), [CLOSED, UNREACHABLE, &again]);
        sleep(Duration::from_secs(5)).await;
    }

    hour.until(10, 10).await;
    hour.event("the robot's power fails; it is back after forty seconds");
    hour.is_moving().await;
    hour.cut_power();
    sleep(Duration::from_secs(40)).await;
    hour.boot();
    hour.start_robot().await;
    hour.is_served(5).await;
    assert_eq!(hour.states(), ["connecting broken", "connected 8"]);

    hour.until(14, 10).await;
    hour.event("the robot's power fails; it is back after five minutes");
    hour.is_moving().await;
    hour.cut_power();
    sleep(Duration::from_secs(300)).await;
    hour.boot();
    hour.start_robot().await;
    let lost = "connecting broken";
    hour.is_served(15).await;
    assert_eq!(
        hour.states(),
        [lost, "connecting connect_timeout", "connected 9"]
    );

    hour.until(22, 10).await;
    hour.event("the network is away for eight seconds");
    hour.lose_network();
    sleep(Duration::from_secs(8)).await;
    hour.find_network();
    hour.is_served(5).await;
    assert!(hour.states().is_empty());

    hour.until(24, 10).await;
    hour.event("the network is away for a minute and a half");
    hour.lose_network();
    // Between the waits of the seventh attempt and the eighth, however long they happen to be.
    sleep(Duration::from_secs(97)).await;
    hour.find_network();
    hour.is_served(15).await;
    assert_eq!(
        hour.states(),
        [lost, "connecting connect_timeout", "connected 10"]
    );

    hour.until(28, 10).await;
    hour.event("the app is closed and started again after ten seconds");
    hour.stop_app().await;
    assert_eq!(hour.states(), ["closed closed_here"]);
    sleep(Duration::from_secs(10)).await;
    hour.start_app();
    hour.is_served(1).await;
    assert_eq!(hour.states(), ["connected 1"]);

    hour.until(30, 10).await;
    hour.event(
        "the app is switched off where the network does not reach, and on again after ten seconds",
    );
    hour.lose_network();
    hour.stop_app().await;
    assert_eq!(hour.states(), ["closed closed_here"]);
    sleep(Duration::from_secs(10)).await;
    hour.forget_app();
    hour.start_app();
    hour.is_served(1).await;
    assert_eq!(hour.states(), ["connected 1"]);

    hour.until(32, 10).await;
    hour.event("for a minute a robot of another version, whose reports the app cannot read");
    hour.stop_robot().await;
    hour.start_robot().await;
    hour.is_served(2).await;
    assert_eq!(hour.states(), [CLOSED, "connected 2"]);
    hour.hush();
    for _ in 0..20 {
        let metres = "one".to_owned();
        let outcome = hour.push(&Other { metres }).await;
        assert!(matches!(outcome, AckOutcome::Refused(_)), "{outcome:?}");
        sleep(Duration::from_secs(3)).await;
    }
    hour.stop_robot().await;
    hour.start_robot().await;
    hour.is_served(2).await;
    assert_eq!(hour.states(), [CLOSED, "connected 3"]);

    hour.until(36, 10).await;
    hour.event("for a minute a robot of another version, whose digests are wrong");
    hour.stop_robot().await;
    let mut dialled = hour.replace_robot();
    let mut robot = Raw::new(dialled.recv().await.unwrap());
    let answers = async {
        while let Some((request, _)) = robot.recv().await {
            let mut answer = frame(answer_to(request), br#"{"result":7,"number":1}"#);
            *answer.last_mut().unwrap() ^= 1;
            robot.send(&answer).await;
        }
    };
    let minute = tokio::time::timeout(Duration::from_secs(60), answers);
    minute.await.expect_err("the app stays");
    drop(robot);
    hour.start_robot().await;
    hour.is_served(2).await;
    assert_eq!(
        hour.states(),
        [CLOSED, "connected 4", CLOSED, "connected 5"]
    );

    hour.until(40, 10).await;
    hour.event("for a minute the app takes no report");
    hour.be_slow(true);
    sleep(Duration::from_secs(60)).await;
    hour.be_slow(false);
    hour.is_served(1).await;
    assert!(hour.states().is_empty());

    hour.until(44, 10).await;
    hour.event("the robot is restarted, and others take all its places for a quarter of a minute");
    hour.stop_robot().await;
    let crowd = hour.start_crowded(2).await;
    // As above.
    sleep(Duration::from_secs(15)).await;
    drop(crowd);
    hour.is_served(15).await;
    let states = hour.states();
    assert!(
        states.last().unwrap().starts_with("connected"),
        "{states:?}"
    );

    hour.until(49, 10).await;
    let after = hour.held();
    assert!(
        after <= before + SLACK,
        "{before} bytes before, {after} after"
    );
    assert_eq!(hour.left(), (1, 0), "connections and calls");

    hour.until(51, 9).await;
    hour.event("the robot is switched off for good");
    hour.stop_robot().await;
    hour.until(60, 0).await;
    let states = hour.states();
    assert_eq!(states.last().unwrap(), "closed unreachable", "{states:?}");

    let counts = hour.counts();
    let (events, lines) = hour.end();
    for line in &lines {
        println!("{line}");
    }
    let logged = lines.iter().filter(|line| !line.is_event()).count();
    println!("{events} events, {logged} lines; {counts}");
    assert!(
        logged <= LINES * events,
        "{logged} lines for {events} events"
    );
    compare(&lines);
}

/// Holds the log to `log.txt`.
fn compare(lines: &[Line]) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/restarts/log.txt");
    let mut log = String::new();
    for line in lines {
        log.push_str(&line.brief());
        log.push('\n');
    }
    let log = log.trim_start();
    if std::env::var_os("FC_WRITE_LOG").is_some() {
        std::fs::write(&path, log).unwrap();
    }
    let expected = std::fs::read_to_string(&path).unwrap_or_default();
    for (number, (line, expected)) in log.lines().zip(expected.lines()).enumerate() {
        assert_eq!(line, expected, "line {}", number + 1);
    }
    assert_eq!(log.lines().count(), expected.lines().count());
}
