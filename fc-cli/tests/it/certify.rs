//! `fcproto certify` against `fcproto mock`.

use crate::support::Project;
use crate::support::robot::Robot;

#[test]
fn a_mock_gets_a_certificate() {
    let project = Project::new();
    let mock = Robot::mock(&project, &["--no-preconditions"]);
    let certify = ["certify", "--robot", &mock.commands, "--lang", "en"];
    let trials = ["--only", "call", "--only", "frame", "--out", "certificate"];
    let run = project.fc(&[&certify[..], &trials].concat()).expect(0);
    assert!(run.stdout.contains("passed  call.get_level"), "{run:?}");
    assert!(
        run.stdout
            .contains("skipped  call.probe: its effect is `unknown`"),
        "{run:?}"
    );
    let json = project.read("certificate/certificate.json");
    let json: serde_json::Value = serde_json::from_str(&json).expect("JSON");
    assert_eq!(json["passed"], true);
    assert!(
        json["fingerprint"]
            .as_str()
            .is_some_and(|it| !it.is_empty())
    );
    assert!(
        project
            .read("certificate/certificate.html")
            .contains("通过")
    );
}

#[test]
fn an_unwritable_certificate_is_named() {
    let project = Project::new();
    let mock = Robot::mock(&project, &[]);
    project.write("taken", "");
    let certify = ["certify", "--robot", &mock.commands, "--lang", "en"];
    let out = ["--only", "call.get_level", "--out", "taken/certificate"];
    let run = project.fc(&[&certify[..], &out].concat()).expect(2);
    assert!(run.stderr.contains("taken/certificate"), "{run:?}");
}

#[test]
fn a_faulty_link_fails_a_trial() {
    let project = Project::new();
    let mock = Robot::mock(&project, &[]);
    let proxy = mock.proxy(&project, &["--fault", "wrong-id"]);
    let certify = ["certify", "--robot", &proxy.commands, "--format", "json"];
    let run = project
        .fc(&[&certify[..], &["--only", "call.get_level"]].concat())
        .expect(1);
    let trial: serde_json::Value = serde_json::from_str(run.stdout.trim()).expect("a line");
    assert_eq!(trial["result"], "failed");
    assert!(trial["received"][0].as_str().is_some(), "{trial}");
}

#[test]
fn a_device_that_is_not_there_has_no_certificate() {
    let project = Project::new();
    let mock = Robot::mock(&project, &[]);
    let address = mock.commands.clone();
    drop(mock);
    project.fc(&["certify", "--robot", &address]).expect(4);
}

#[test]
fn without_an_app_there_is_no_certificate() {
    let project = Project::new();
    let ports = ["--command-port", "0", "--data-port", "0"];
    let certify = ["certify", "--app", "--wait", "1", "--lang", "en"];
    let run = project.fc(&[&certify[..], &ports].concat()).expect(1);
    assert!(run.stderr.contains("no app has connected"), "{run:?}");
}
