//! Sends SIGTERM to the example robot, at work and idle.

#![cfg(unix)]

use crate::support::programs::{Robot, examples};
use fc_generated::Fc;
use fc_generated::descriptors::OPERATIONS;
use fc_runtime::{ClientConfig, Connection, OperationKind, Protocol, ResponseEnvelope};
use std::path::PathBuf;

fn robot() -> PathBuf {
    let [robot] = examples(["robot"], "");
    robot
}

/// Returns the code of a command and the example of its request.
fn command() -> (u16, &'static [u8]) {
    OPERATIONS
        .iter()
        .filter(|operation| operation.kind == OperationKind::Command)
        .find_map(|operation| Some((operation.code?, operation.request.example.as_bytes())))
        .expect("a command")
}

#[tokio::test(flavor = "multi_thread", worker_threads = 1)]
async fn sigterm_waits_for_running_calls() {
    let mut robot = Robot::start(&robot(), &["--delay", "1500"]);
    let [port, _] = robot.ports;
    let config = ClientConfig::new().host("127.0.0.1").command_port(port);
    let app = Connection::<Fc>::connect(config).await.unwrap();
    let (code, example) = command();
    let call = tokio::spawn(async move { app.call_raw(code, example).await });

    tokio::task::block_in_place(|| {
        robot.logs(" request ");
        robot.terminate();
        robot.logs("SIGTERM: ending within 5s");
        robot.logs("shutting down");
    });
    let answered_before = call.is_finished();
    let answer = call.await.unwrap().expect("an answer");
    let result = answer.envelope.result_code();
    assert_eq!(result, Some(Fc::RESULTS.success.code));
    assert!(!answered_before, "nothing was in flight");

    let (status, _, log) = robot.wait();
    assert_eq!(status.code(), Some(0), "{log}");
    let order = ["ended protocol", "ended"].map(|words| log.rfind(words));
    assert!(
        order.iter().all(Option::is_some) && order.is_sorted(),
        "{log}"
    );
    assert!(log.contains(r#"reason="drained""#), "{log}");
}

#[test]
fn sigterm_while_idle_ends_it_with_success() {
    let robot = Robot::start(&robot(), &[]);
    robot.terminate();
    let (status, _, log) = robot.wait();
    assert_eq!(status.code(), Some(0), "{log}");
    assert!(!log.contains("WARN"), "{log}");
}

/// A second signal ends the calls that still run.
#[tokio::test(flavor = "multi_thread", worker_threads = 1)]
async fn a_second_signal_ends_it_at_once() {
    let mut robot = Robot::start(&robot(), &["--delay", "600000"]);
    let [port, _] = robot.ports;
    let config = ClientConfig::new().host("127.0.0.1").command_port(port);
    let app = Connection::<Fc>::connect(config.reconnect(None))
        .await
        .unwrap();
    let (code, example) = command();
    let call = tokio::spawn(async move { app.call_raw(code, example).await });
    tokio::task::block_in_place(|| {
        robot.logs(" request ");
        robot.terminate();
        robot.logs("shutting down");
        robot.terminate();
        robot.logs("SIGTERM again: ending at once");
    });
    assert!(call.await.unwrap().is_err());
    let (status, _, log) = robot.wait();
    assert_eq!(status.code(), Some(0), "{log}");
}
