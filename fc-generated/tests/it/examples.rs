//! Runs the example robot and the example app against each other, and the app against a mock.

use crate::support::programs::{Robot, examples};
use fc_generated::descriptors::OPERATIONS;
use fc_runtime::{OperationInfo, OperationKind};
use fc_spec::diagnostic::Faults;
use fc_spec::load::load;
use fc_spec::model::Model;
use fc_spec::syntax::read_dir;
use fc_workshop::mock::{Mock, Settings};
use fc_workshop::scenario::{Scenario, Verdict};
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Duration;

#[test]
fn the_app_tours_the_robot_and_the_robot_ends_with_it() {
    let [robot, app] = examples(["robot", "app"], "");
    let robot = Robot::start(&robot, &["--once"]);
    tour(&app, robot.ports);

    let (status, rest, log) = robot.wait();
    assert!(status.success(), "{rest}{log}");
    let reports = OPERATIONS
        .iter()
        .filter(|operation| operation.kind == OperationKind::Report);
    for report in reports.filter(|report| report.code.is_some()) {
        // The number of the connection depends on which port accepts first.
        let start = format!("{} to #", report.name);
        let acknowledged = rest
            .lines()
            .any(|line| line.starts_with(&start) && line.ends_with(": Acknowledged"));
        assert!(acknowledged, "no `{start}…: Acknowledged` in\n{rest}");
    }
}

#[test]
fn the_app_tours_a_mock_of_the_spec() {
    let [app] = examples(["app"], "");
    let settings = Settings {
        pace: Duration::from_millis(1),
        // The example robot also sends its picture after this command.
        stream_after: vec!["get_map_image".to_owned()],
        // The app calls every command once, in the order of the spec, so preconditions may not hold.
        ignores_preconditions: true,
        ..Settings::default()
    };
    let mock = Mock::start(spec(), settings).unwrap();
    tour(&app, [mock.commands().port(), mock.data().port()]);
}

#[test]
fn an_app_that_breaks_a_scenario_is_caught() {
    let [app] = examples(["app"], "");
    let mut commands = OPERATIONS
        .iter()
        .filter(|operation| operation.kind == OperationKind::Command && operation.code.is_some());
    // The app sends all commands.
    let forbidden = commands.next().unwrap().name.to_owned();
    let scenario = Scenario {
        never: vec![forbidden.clone()],
        ..Scenario::of_commands(commands.map(|command| command.name.to_owned()))
    };
    let settings = Settings {
        scenario: Some(scenario),
        expect: true,
        ..Settings::default()
    };
    let mock = Mock::start(spec(), settings).unwrap();
    let mut app = Command::new(app)
        .args(["--command-port", &mock.commands().port().to_string()])
        .args(["--data-port", &mock.data().port().to_string()])
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let verdict = mock.verdict();
    // The app may still wait for the robot, which has ended.
    app.kill().unwrap();
    app.wait().unwrap();
    assert_eq!(verdict, Some(Verdict::Forbidden(forbidden)));
}

/// Returns the model of the spec.
fn spec() -> Model {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let mut faults = Faults::new();
    let sources = read_dir(&root, Path::new("spec"), &mut faults);
    load(&sources, &mut faults).model().expect("a valid spec")
}

/// Lets the app call every command, and checks its table.
fn tour(app: &Path, ports: [u16; 2]) {
    let [command, data] = ports.map(|port| port.to_string());
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
    // On the data port, the tour shows only the picture. Streams of the spec have no example.
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
}
