//! `fcproto proxy --view`, on a terminal that `script` provides.

use crate::support::Project;
use std::io::Write as _;
use std::process::{Command, Stdio};

#[test]
fn a_person_leaves_the_view() {
    let project = Project::new();
    let proxy = "proxy --view --to 127.0.0.1:9 --command-port 0 --data-port 0 --lang en";
    let program = env!("CARGO_BIN_EXE_fcproto");
    let mut script = Command::new("script")
        .args([
            "-qefc",
            &format!("stty rows 24 cols 100; {program} {proxy}"),
        ])
        .arg("/dev/null")
        .current_dir(project.path(""))
        .env("TERM", "xterm")
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .expect("script runs");
    let mut keys = script.stdin.take().expect("its input");
    keys.write_all(b"q").expect("the program reads keys");
    let run = script.wait_with_output().expect("it ends");
    let shown = String::from_utf8_lossy(&run.stdout);
    assert!(run.status.success(), "{shown}");
    for part in ["commands 127.0.0.1:", "Operation", "calls 0", "q quit"] {
        assert!(shown.contains(part), "{part}: {shown}");
    }
}

#[test]
fn a_pipe_gets_lines_instead() {
    let project = Project::new();
    let proxy = ["proxy", "--view", "--to", "127.0.0.1:9", "--lang", "en"];
    let run = project.fc(&proxy).expect(2);
    assert!(run.stderr.contains("--view needs a terminal"), "{run:?}");
}
