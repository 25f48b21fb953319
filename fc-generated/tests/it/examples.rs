//! The two example programs against each other, as somebody tries them out.

use crate::support::programs::{Robot, examples};
use fc_generated::descriptors::OPERATIONS;
use fc_runtime::{OperationInfo, OperationKind};
use std::process::Command;

#[test]
fn the_app_tours_the_robot_and_the_robot_ends_with_it() {
    let [robot, app] = examples(["robot", "app"], "");
    let robot = Robot::start(&robot, &["--once"]);
    let [command, data] = robot.ports.map(|port| port.to_string());
    let tour = Command::new(app)
        .args(["--command-port", &command, "--data-port", &data])
        .args(["--lang", "zh"])
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

    let (status, rest, log) = robot.wait();
    assert!(status.success(), "{rest}{log}");
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
