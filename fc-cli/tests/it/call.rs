//! `fcproto call` against `fcproto mock`.

use crate::support::robot::Robot;
use crate::support::{Project, Run, command};
use serde_json::{Value, json};

/// Arguments, exit status, and strings in the output or the errors.
type Case = (&'static [&'static str], i32, &'static [&'static str]);

const CASES: &[Case] = &[
    (
        &["get_level"],
        0,
        &[
            "get_level  0 fine",
            "level        40",
            "7      ID of the scene",
        ],
    ),
    (&["get_level", "--lang", "zh"], 0, &["40     亮度"]),
    (
        &["get_level", "level=1"],
        2,
        &["`level`", "send unknown keys with --json"],
    ),
    (&["get_level", "--json", "{\"more\":1}"], 0, &["fine"]),
    (
        &["get_level", "--json", "[]"],
        2,
        &["`--json` needs a JSON object"],
    ),
    (
        &["get_level", "--follow"],
        2,
        &["`get_level` sets off no reports"],
    ),
    (&["lower"], 2, &["there is no command `lower`", "--list"]),
    (&["alarm"], 2, &["there is no command `alarm`"]),
    (&["dim", "--allow", "config"], 2, &["`dim` has no code yet"]),
    (&["probe"], 2, &["effect `unknown`", "--allow motion"]),
    (&["probe", "--allow", "config"], 2, &["--allow motion"]),
    (&["probe", "--allow", "motion"], 0, &["probe  0 fine"]),
    (&["set_level"], 2, &["missing_field"]),
    (
        &["set_level", "data.level=much"],
        2,
        &["an integer from -2147483648", "found `much`"],
    ),
    (
        &["set_level", "data.depth=1"],
        2,
        &["there is no key `depth`", "the keys are level, ratio"],
    ),
    (
        &["set_level", "data.phase=dusk"],
        2,
        &["one of", "found `dusk`"],
    ),
    (&["set_level", "level"], 2, &["expected `key=value`"]),
    (&["--raw", "0x0102", "7b7d"], 0, &["get_level  0 fine"]),
    (
        &["--raw", "0x0102", "7b7"],
        2,
        &["not bytes in hexadecimal"],
    ),
    (
        &["--raw", "0x0102", "2d", "--allow", "motion"],
        3,
        &["get_level  3 wrong  Wrong: bad_json"],
    ),
    (
        &["--raw", "0x0777", "7b7d", "--allow", "motion"],
        3,
        &["0x0777"],
    ),
    (&["glow", "lux=1"], 2, &["takes no arguments"]),
    (
        &["firmware", "--allow", "motion"],
        2,
        &["`firmware` has bytes"],
    ),
    (&["--list"], 0, &["get_level  0x0102", "unassigned", "glow"]),
];

#[test]
fn each_call_has_its_status_and_its_output() {
    let project = Project::new();
    let mock = Robot::mock(&project, &[]);
    for (args, status, texts) in CASES {
        let run = mock.call(&project, args);
        let shown = format!("{}{}", run.stdout, run.stderr);
        assert_eq!(run.status, *status, "{args:?}: {shown}");
        for text in *texts {
            assert!(shown.contains(text), "{args:?} lacks {text:?}: {shown}");
        }
    }
}

#[test]
fn a_value_out_of_range_is_not_sent() {
    let project = Project::new();
    let body = json!({ "data": {
        "level": 101, "ratio": "0.5", "armed": true, "label": "lamp", "serial": "AB", "colours": [],
        "phase": 0,
    }});
    let args = [
        "call",
        "set_level",
        "--json",
        &body.to_string(),
        "--allow",
        "motion",
    ];
    // The command refuses the value before it connects, so no robot is needed.
    let run = project.fc(&args).expect(2);
    for text in [
        "data.level",
        "expected at most 100, found 101",
        "accepted: 0 … 100 %",
    ] {
        assert!(run.stderr.contains(text), "{text}: {run:?}");
    }
}

#[test]
fn json_output_has_a_line_per_message() {
    let project = Project::new();
    let mock = Robot::mock(&project, &[]);
    let run = mock.call(
        &project,
        &["get_level", "--format", "json", "--repeat", "3"],
    );
    let lines: Vec<Value> = run
        .stdout
        .lines()
        .map(|line| serde_json::from_str(line).expect("JSON"))
        .collect();
    assert_eq!(lines.len(), 3);
    for line in lines {
        assert_eq!(line["name"], "get_level");
        assert_eq!(line["result_name"], "fine");
        assert_eq!(line["body"]["level"], 40);
    }
}

#[test]
fn a_robot_that_is_not_there_gives_status_4() {
    let project = Project::new();
    let mock = Robot::mock(&project, &[]);
    let address = mock.commands.clone();
    mock.stop("-TERM").expect(0);
    let run = project
        .fc(&["call", "get_level", "--to", &address])
        .expect(4);
    assert!(run.stderr.contains("cannot connect"), "{run:?}");
    let run = interactive(&project, &address, "get_level\n").expect(4);
    assert!(run.stderr.contains("cannot connect"), "{run:?}");
}

#[test]
fn a_robot_that_does_not_answer_gives_status_4() {
    let project = Project::new();
    // The kernel accepts the connection, but no program reads from it.
    let silent = std::net::TcpListener::bind("127.0.0.1:0").expect("a port");
    let address = silent.local_addr().expect("its address").to_string();
    let run = project
        .fc(&["call", "get_level", "--to", &address, "--timeout", "50"])
        .expect(4);
    assert!(run.stderr.contains("no response within 50 ms"), "{run:?}");
}

#[test]
fn a_process_is_followed_to_its_end() {
    let project = Project::new();
    let mock = Robot::mock(&project, &["--pace", "5"]);
    let set_level: Vec<&str> = SET_LEVEL.split_whitespace().collect();
    let refused = mock.call(&project, &set_level).expect(3);
    assert!(
        refused.stdout.contains("send get_level first"),
        "{refused:?}"
    );
    for args in [&["get_level"][..], &["probe", "--allow", "motion"]] {
        mock.call(&project, args).expect(0);
    }
    let run = mock
        .call(&project, &[&set_level, &["--follow"][..]].concat())
        .expect(0);
    let states = ["dark (0)", "state (4)", "burning (3)"];
    let mut rest = run.stdout.as_str();
    for state in states {
        let at = rest
            .find(state)
            .unwrap_or_else(|| panic!("no {state}: {run:?}"));
        rest = &rest[at..];
    }
    // The command has started the stream `glow` on the data port.
    let run = project.fc(&["call", "glow", "--to", &mock.data]).expect(0);
    assert_eq!(run.stdout, "glow  Glow\nlux  0.5 %  Glow\n");
}

const SET_LEVEL: &str = "set_level --allow motion data.level=40 data.ratio=0.25 data.armed=true \
    data.label=lamp data.serial=AB data.colours.0.red=1 data.colours.0.green=2 data.phase=dark";

/// Runs lines of an interactive call.
fn interactive(project: &Project, to: &str, lines: &str) -> Run {
    let mut command = command(&["call", "--interactive", "--to", to, "--lang", "en"]);
    Run::with_input(command.current_dir(project.path("")), lines)
}

#[test]
fn lines_of_a_pipe_are_calls() {
    let project = Project::new();
    let mock = Robot::mock(&project, &["--pace", "5"]);
    let lines = format!(
        "get_level\n\nprobe\nprobe --allow motion\nlower\n{SET_LEVEL} --follow\n--nothing\nlabel='\n\
         get_level --to elsewhere\nset_level --json @-\n--list\n"
    );
    let run = interactive(&project, &mock.commands, &lines).expect(2);
    for part in [
        "get_level  0 fine",
        "probe  0 fine",
        "burning (3)",
        "0x0102",
    ] {
        assert!(run.stdout.contains(part), "{part}: {run:#?}");
    }
    for part in [
        "effect `unknown`",
        "there is no command `lower`",
        "unexpected argument `--nothing`",
        "a quotation mark is not closed",
        "`--to` belongs on the command line",
        "the standard input has the calls",
    ] {
        assert!(run.stderr.contains(part), "{part}: {run:#?}");
    }
}
