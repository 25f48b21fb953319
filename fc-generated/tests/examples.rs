//! The two example programs against each other, as somebody tries them out.

#![allow(
    clippy::expect_used,
    clippy::panic,
    clippy::unwrap_used,
    clippy::wildcard_imports,
    missing_docs,
    reason = "tests"
)]

use fc_generated::descriptors::OPERATIONS;
use fc_runtime::{OperationInfo, OperationKind};
use std::io::{BufRead, BufReader, Read};
use std::path::PathBuf;
use std::process::{Command, Stdio};

#[test]
fn the_app_tours_the_robot_and_the_robot_ends_with_it() {
    let [robot, app] = examples();
    let mut robot = Command::new(robot)
        .args(["--command-port", "0", "--data-port", "0", "--once"])
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    let mut output = BufReader::new(robot.stdout.take().unwrap());
    let mut first = String::new();
    output.read_line(&mut first).unwrap();
    let words: Vec<&str> = first.split_whitespace().collect();
    let ["commands", commands, "data", data] = words.as_slice() else {
        panic!("{first}")
    };
    let port = |address: &str| {
        address
            .strip_prefix("127.0.0.1:")
            .expect("a local port")
            .to_owned()
    };

    let tour = Command::new(app)
        .args([
            "--command-port",
            &port(commands),
            "--data-port",
            &port(data),
        ])
        .output()
        .unwrap();
    let table = String::from_utf8(tour.stdout).unwrap();
    assert!(
        tour.status.success(),
        "{table}\n{}",
        String::from_utf8_lossy(&tour.stderr)
    );
    // Of the data port the tour only shows the picture; a stream of the spec has no example.
    let toured = |operation: &&OperationInfo| {
        operation.code.is_some() && operation.kind != OperationKind::Stream
    };
    for operation in OPERATIONS.iter().filter(toured) {
        assert!(
            table.contains(operation.name),
            "{} is missing in\n{table}",
            operation.name
        );
    }
    assert!(table.contains("MD5 一致"), "no picture in\n{table}");

    let mut rest = String::new();
    output.read_to_string(&mut rest).unwrap();
    assert!(robot.wait().unwrap().success(), "{rest}");
    let reports = OPERATIONS
        .iter()
        .filter(|operation| operation.kind == OperationKind::Report);
    for report in reports.filter(|report| report.code.is_some()) {
        // Which number the connection has depends on which port is accepted first.
        let start = format!("{} to #", report.name);
        let acknowledged = rest
            .lines()
            .any(|line| line.starts_with(&start) && line.ends_with(": Acknowledged"));
        assert!(acknowledged, "no `{start}…: Acknowledged` in\n{rest}");
    }
}

/// The programs, built where this test was.
fn examples() -> [PathBuf; 2] {
    let test = std::env::current_exe().unwrap();
    let profile = test
        .parent()
        .and_then(|deps| deps.parent())
        .expect("target/profile/deps");
    let mut cargo = Command::new(env!("CARGO"));
    cargo.args([
        "build",
        "--quiet",
        "--offline",
        "--examples",
        "--target-dir",
    ]);
    cargo.arg(profile.parent().expect("target/profile"));
    if !cfg!(debug_assertions) {
        cargo.arg("--release");
    }
    assert!(
        cargo
            .current_dir(env!("CARGO_MANIFEST_DIR"))
            .status()
            .unwrap()
            .success()
    );
    let program = |name: &str| {
        profile
            .join("examples")
            .join(format!("{name}{}", std::env::consts::EXE_SUFFIX))
    };
    [program("robot"), program("app")]
}
