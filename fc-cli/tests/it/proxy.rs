//! `fcproto proxy` between `fcproto call` and `fcproto mock`.

use crate::support::Project;
use crate::support::robot::Robot;

#[test]
fn each_frame_is_forwarded_and_shown() {
    let project = Project::new();
    let mock = Robot::mock(&project, &[]);
    let proxy = mock.proxy(&project, &["--lang", "en"]);
    let run = proxy
        .call(&project, &["get_level", "--lang", "en"])
        .expect(0);
    assert!(run.stdout.contains("get_level  0 fine"), "{run:?}");
    let shown = proxy.stop("-INT").expect(0).stdout;
    for part in [
        "get_level request",
        "get_level response",
        "ms after the request",
    ] {
        assert!(shown.contains(part), "{part}: {shown}");
    }
}

#[test]
fn faults_strike_and_are_shown() {
    let project = Project::new();
    let mock = Robot::mock(&project, &[]);
    let args = ["--fault", "unknown-key:get_level", "--format", "json"];
    let proxy = mock.proxy(&project, &args);
    let run = proxy
        .call(&project, &["get_level", "--format", "json"])
        .expect(0);
    assert!(run.stdout.contains("\"unknownKey\":true"), "{run:?}");
    let shown = proxy.stop("-TERM").expect(0).stdout;
    let lines: Result<Vec<serde_json::Value>, _> =
        shown.lines().map(serde_json::from_str).collect();
    let faults = lines.expect("lines of JSON");
    let faults = faults
        .iter()
        .filter(|line| line["faults"][0] == "unknown-key");
    assert_eq!(faults.count(), 2, "{shown}");
}

#[test]
fn a_cut_connection_ends_the_call() {
    let project = Project::new();
    let mock = Robot::mock(&project, &[]);
    let proxy = mock.proxy(
        &project,
        &["--fault", "cut:get_level:only=1", "--seed", "1"],
    );
    proxy.call(&project, &["get_level"]).expect(4);
}

#[test]
fn a_robot_that_is_not_there_is_named() {
    let project = Project::new();
    let mock = Robot::mock(&project, &[]);
    let proxy = mock.proxy(&project, &[]);
    drop(mock);
    proxy.call(&project, &["get_level"]).expect(4);
}

#[test]
fn wrong_faults_are_refused() {
    let project = Project::new();
    let run = project
        .fc(&["proxy", "--to", "127.0.0.1:1", "--fault", "explode"])
        .expect(2);
    assert!(
        run.stderr.contains("there is no fault `explode`"),
        "{run:?}"
    );
}
