//! `fcproto mock`.

use crate::support::robot::Robot;
use crate::support::{Project, command};
use std::io::{BufRead as _, BufReader, Write as _};
use std::process::{Command, Stdio};

#[test]
fn a_mock_ends_on_each_signal() {
    let project = Project::new();
    for signal in ["-INT", "-TERM"] {
        Robot::mock(&project, &[]).stop(signal).expect(0);
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

/// A scenario, the calls of an app that does not follow it, and the error of the mock.
const FAULTY: &[(&str, &[&str], &str)] = &[
    (
        "on: [{ request: probe, reports: [alarm] }]\n\
         expect: [probe, { acknowledged: alarm }]\nwithin_ms: 1000\n",
        &["probe", "--allow", "motion"],
        "the app did not acknowledge `alarm`",
    ),
    (
        "on: [{ request: get_level, times: 1, refuse: wrong }]\n\
         expect: [get_level, get_level]\nwithin_ms: 1000\n",
        &["get_level"],
        "the app did not send `get_level`",
    ),
    (
        "expect: [get_level]\nnever: [probe]\n",
        &["probe", "--allow", "motion"],
        "the app sent `probe`, which it must not send",
    ),
];

#[test]
fn a_faulty_app_is_caught() {
    let project = Project::new();
    for (scenario, call, error) in FAULTY {
        project.write("s.yaml", scenario);
        let mock = Robot::mock(
            &project,
            &["--scenario", "s.yaml", "--expect", "--lang", "en"],
        );
        // The robot may end before its response.
        mock.call(&project, call);
        let run = mock.end().expect(1);
        assert!(run.stderr.contains(error), "{error}: {run:?}");
    }
}

#[test]
fn an_app_and_a_robot_meet_the_same_scenario() {
    let project = Project::new();
    for (scenario, _, _) in FAULTY {
        project.write("s.yaml", scenario);
        let options = [
            "--scenario",
            "s.yaml",
            "--expect",
            "--pace",
            "1",
            "--lang",
            "en",
        ];
        let mock = Robot::mock(&project, &options);
        let app = mock.app(&project, &[&options[..], &["--allow", "motion"]].concat());
        assert!(
            app.expect(0)
                .stdout
                .ends_with("the robot did what the scenario expects\n")
        );
        let run = mock.end().expect(0);
        assert!(
            run.stdout.contains("the app did what the scenario expects"),
            "{run:?}"
        );
    }
}

#[test]
fn an_app_finds_deviations_of_a_robot() {
    let project = Project::new();
    let mock = Robot::mock(&project, &[]);
    let options = ["--expect", "--pace", "1", "--lang", "en"];
    // Without a scenario, the app sends each command that only reads.
    let run = mock.app(&project, &options).expect(0);
    assert!(run.stdout.contains("get_level  0 fine"), "{run:?}");
    assert!(!run.stdout.contains("probe"), "{run:?}");
    for (scenario, deviation) in [
        (
            "on: [{ request: get_level, refuse: wrong }]\nexpect: [get_level]\n",
            "`get_level`: expected result 3, found 0",
        ),
        (
            "on: [{ request: get_level, answer: { level: 7 } }]\nexpect: [get_level]\n",
            "`get_level`: `level`: expected 7, found 40",
        ),
        (
            "on: [{ request: get_level, silent: true }]\nexpect: [get_level]\n",
            "`get_level`: a response, and the scenario has none",
        ),
        (
            "expect: [{ acknowledged: level_changed }]\nwithin_ms: 50\n",
            "`level_changed`: the robot has sent nothing for",
        ),
    ] {
        project.write("s.yaml", scenario);
        let scenario = ["--scenario", "s.yaml"];
        let run = mock
            .app(&project, &[&options[..], &scenario].concat())
            .expect(1);
        assert!(run.stderr.contains(deviation), "{deviation}: {run:?}");
    }
}

#[test]
fn an_app_sends_only_allowed_commands() {
    let project = Project::new();
    project.write("s.yaml", "expect: [get_level, probe]\n");
    // The app refuses the command before it connects, so no robot is needed.
    let app = [
        "mock",
        "--as",
        "app",
        "--to",
        "127.0.0.1:9",
        "--scenario",
        "s.yaml",
    ];
    let run = project.fc(&app).expect(2);
    assert!(run.stderr.contains("--allow motion"), "{run:?}");
    project.fc(&["mock", "--as", "app"]).expect(2);
    project.fc(&["mock", "--to", "127.0.0.1:9"]).expect(2);
}

#[test]
fn many_robots_have_their_ports() {
    let project = Project::new();
    // The robots need more open files than this limit. The mock raises it.
    let mut mock = Command::new("sh")
        .args(["-c", "ulimit -Sn 60 && exec \"$0\" mock --count 50"])
        .arg(command(&[]).get_program())
        .current_dir(project.path(""))
        .stdout(Stdio::piped())
        .spawn()
        .expect("a shell");
    let lines = BufReader::new(mock.stdout.take().expect("its output")).lines();
    let lines: Vec<String> = lines.take(50).map(|line| line.expect("a line")).collect();
    assert_eq!(lines.len(), 50);
    for line in lines.iter().step_by(7) {
        let robot = line.split_whitespace().nth(1).expect("an address");
        project.fc(&["call", "get_level", "--to", robot]).expect(0);
    }
    mock.kill().expect("it still runs");
    mock.wait().expect("its end");
}

#[test]
fn robots_without_files_or_ports_are_an_error() {
    let project = Project::new();
    let few = Command::new("sh")
        .args([
            "-c",
            "ulimit -n 60 && exec \"$0\" mock --count 50 --lang en",
        ])
        .arg(command(&[]).get_program())
        .current_dir(project.path(""))
        .output()
        .expect("a shell");
    let errors = String::from_utf8(few.stderr).expect("UTF-8");
    assert!(
        errors.contains("the system allows 60; raise the limit"),
        "{errors}"
    );
    let run = project
        .fc(&["mock", "--count", "2", "--data-port", "7"])
        .expect(2);
    assert!(run.stderr.contains("--count"), "{run:?}");
}

/// Writes recorded traffic: a request, its response with this level, and optionally a report with its acknowledgement.
fn record(project: &Project, level: u8, has_report: bool) {
    let body = format!("{{\"level\":{level},\"stands\":[],\"others\":[]}}");
    let mut text = String::new();
    let frames = [
        &["get_level"][..],
        &["get_level", "--side", "response", "--json", &body],
        &["level_changed", "--id", "2"],
        &["level_changed", "--id", "2", "--side", "response"],
    ];
    for args in &frames[..if has_report { 4 } else { 2 }] {
        text += &project.fc(&[&["encode"], *args].concat()).expect(0).stdout;
        text.push('\n');
    }
    project.write("run.hex", &text);
}

#[test]
fn recorded_traffic_is_replayed_as_either_side() {
    let project = Project::new();
    record(&project, 77, true);
    let replay = [
        "--replay", "run.hex", "--expect", "--pace", "1", "--lang", "en",
    ];
    let mock = Robot::mock(&project, &replay);
    let run = mock.app(&project, &replay).expect(0);
    assert!(run.stdout.contains("get_level  0 fine"), "{run:?}");
    mock.end().expect(0);

    // The other robot responds with another level.
    record(&project, 77, false);
    let other = Robot::mock(&project, &[]);
    let run = other.app(&project, &replay).expect(1);
    let deviation = "`get_level`: `level`: expected 77, found 40";
    assert!(run.stderr.contains(deviation), "{run:?}");
}

#[test]
fn an_app_waits_for_each_step() {
    let project = Project::new();
    record(&project, 77, true);
    let replay = ["--replay", "run.hex", "--pace", "1", "--lang", "en"];
    let mock = Robot::mock(&project, &replay);
    let mut app = mock
        .app_command(&project, &[&replay[..], &["--expect", "--step"]].concat())
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the command can be run");
    let mut steps = app.stdin.take().expect("its input");
    let mut prompts = BufReader::new(app.stderr.take().expect("its messages"));
    let mut responses = BufReader::new(app.stdout.take().expect("its output"));
    let mut prompt = String::new();
    prompts.read_line(&mut prompt).expect("a prompt");
    assert_eq!(prompt, "next: `get_level`, press Enter to send it\n");
    steps.write_all(b"\n").expect("the app reads steps");
    let mut response = String::new();
    responses.read_line(&mut response).expect("a response");
    assert!(response.contains("get_level"), "{response}");
    // At the end of its input, the app continues without steps.
    drop(steps);
    assert!(app.wait().expect("it ends").success());
}
