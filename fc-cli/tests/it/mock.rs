//! `fcproto mock`.

use crate::support::Project;
use crate::support::robot::Robot;

#[test]
fn a_mock_ends_on_each_signal() {
    let project = Project::new();
    for signal in ["-INT", "-TERM"] {
        let (status, _) = Robot::mock(&project, &[]).stop(signal);
        assert_eq!(status, Some(0), "{signal}");
    }
}

#[test]
fn a_taken_port_is_an_error_that_names_it() {
    let project = Project::new();
    let mock = Robot::mock(&project, &[]);
    let port = mock.commands.rsplit_once(':').expect("a port").1;
    let run = project
        .fc(&["mock", "--command-port", port, "--data-port", "0"])
        .expect(2);
    assert!(run.stderr.contains(&mock.commands), "{run:?}");
}
