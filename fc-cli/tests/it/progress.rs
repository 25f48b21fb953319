//! The progress line appears on a terminal only and disappears at the end.

#![cfg(target_os = "linux")]

use crate::support;
use std::io::{Read, Write as _};
use std::os::unix::fs::PermissionsExt as _;
use std::process::{Command, Stdio};

use crate::support::Project;

/// Creates a project with one plugin target. The plugin waits until `gate` receives a line.
fn waiting() -> Project {
    let project = Project::new();
    project.write(
        "fc.yaml",
        "targets: { slow: { plugin: ./slow, out: slow } }\n",
    );
    project.write(
        "slow",
        "#!/bin/sh\ncat > /dev/null\nread line < gate\necho []\n",
    );
    let all = std::fs::Permissions::from_mode(0o755);
    std::fs::set_permissions(project.path("slow"), all).expect("its mode");
    let made = Command::new("mkfifo").arg(project.path("gate")).status();
    assert!(made.is_ok_and(|made| made.success()));
    project
}

/// Runs `fcproto generate` on a terminal and returns its output. The gate opens when `wanted` appears, or at once
/// without `wanted`.
fn on_a_terminal(project: &Project, options: &str, wanted: Option<&str>) -> String {
    let command = format!("{} generate {options}", env!("CARGO_BIN_EXE_fcproto"));
    let mut child = Command::new("script")
        .args([
            "--quiet",
            "--flush",
            "--return",
            "--command",
            &command,
            "/dev/null",
        ])
        .current_dir(project.path(""))
        .env("TERM", "xterm")
        .env_remove("CI")
        .env_remove("FC_CI")
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .spawn()
        .expect("`script` of util-linux");
    let mut stdout = child.stdout.take().expect("its output");
    let mut said = String::new();
    let mut bytes = [0; 256];
    let mut is_open = false;
    loop {
        if !is_open && wanted.is_none_or(|wanted| said.contains(wanted)) {
            let gate = std::fs::OpenOptions::new()
                .write(true)
                .open(project.path("gate"));
            gate.and_then(|mut gate| gate.write_all(b"\n"))
                .expect("the gate");
            is_open = true;
        }
        let read = stdout.read(&mut bytes).expect("its output");
        if read == 0 {
            break;
        }
        said += &String::from_utf8_lossy(bytes.get(..read).unwrap_or_default());
    }
    let status = child.wait().expect("its end");
    assert!(status.success(), "{said}");
    said
}

#[test]
fn progress_appears_on_a_terminal_and_vanishes() {
    let said = on_a_terminal(&waiting(), "", Some("generating"));
    let (before, result) = said.rsplit_once("\x1b[K").expect("an end of the line");
    assert!(before.contains("generating"), "{said:?}");
    assert!(result.starts_with("read "), "{said:?}");
}

#[test]
fn progress_is_hidden_when_quiet_or_piped() {
    let said = on_a_terminal(&waiting(), "-q", None);
    assert_eq!(said, "");
    let project = waiting();
    let mut child = support::command(&["generate"])
        .current_dir(project.path(""))
        .env("TERM", "xterm")
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the command can be run");
    let gate = std::fs::OpenOptions::new()
        .write(true)
        .open(project.path("gate"));
    gate.and_then(|mut gate| gate.write_all(b"\n"))
        .expect("the gate");
    let mut complaints = String::new();
    let mut stderr = child.stderr.take().expect("its other output");
    stderr.read_to_string(&mut complaints).expect("text");
    assert_eq!(complaints, "");
    assert!(child.wait().expect("its end").success());
}
