//! Builds and runs the example programs, and reads their output.

use std::io::{BufRead, BufReader, Read};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStderr, ChildStdout, Command, ExitStatus, Stdio};

/// Builds examples with these features of the crate, in addition to the default ones. Returns their paths.
pub fn examples<const N: usize>(names: [&str; N], features: &str) -> [PathBuf; N] {
    let test = std::env::current_exe().unwrap();
    let profile = test
        .parent()
        .and_then(|deps| deps.parent())
        .expect("target/profile/deps");
    let mut cargo = super::nested::command();
    // `--workspace` gives dependencies the same features as a test of the whole workspace, so nothing compiles twice.
    cargo.args(["build", "--quiet", "--offline", "--workspace"]);
    for feature in features.split_whitespace() {
        cargo.args(["--features", &format!("fc-generated/{feature}")]);
    }
    for name in names {
        cargo.args(["--example", name]);
    }
    cargo.arg("--target-dir");
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
    names.map(|name| {
        profile
            .join("examples")
            .join(format!("{name}{}", std::env::consts::EXE_SUFFIX))
    })
}

/// A program that is killed at the end of its test.
pub struct Running {
    child: Child,
    output: BufReader<ChildStdout>,
}

impl Running {
    /// Starts the program.
    pub fn start(program: &Path, args: &[&str]) -> Self {
        let mut child = Command::new(program)
            .args(args)
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let output = BufReader::new(child.stdout.take().unwrap());
        Self { child, output }
    }

    /// Returns its next line.
    pub fn line(&mut self) -> String {
        let mut line = String::new();
        self.output.read_line(&mut line).unwrap();
        line.trim_end().to_owned()
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        // The program may have ended, so errors do not matter.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// A running robot, which is killed at the end of its test.
pub struct Robot {
    pub child: Child,
    pub output: BufReader<ChildStdout>,
    pub log: BufReader<ChildStderr>,
    /// Its ports: first for commands, then for streams.
    pub ports: [u16; 2],
    /// Its port for metrics, if it has one.
    pub metrics: Option<u16>,
}

impl Robot {
    /// Starts the robot at free ports with its whole log, and waits until it prints the ports.
    pub fn start(program: &PathBuf, args: &[&str]) -> Self {
        let mut child = Command::new(program)
            .args(["--command-port", "0", "--data-port", "0"])
            .args(args)
            .env("RUST_LOG", "debug")
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let mut output = BufReader::new(child.stdout.take().unwrap());
        let log = BufReader::new(child.stderr.take().unwrap());
        let mut first = String::new();
        output.read_line(&mut first).unwrap();
        let words: Vec<&str> = first.split_whitespace().collect();
        let (commands, data, metrics) = match words.as_slice() {
            ["commands", commands, "data", data] => (commands, data, None),
            ["commands", commands, "data", data, "metrics", metrics] => {
                (commands, data, Some(metrics))
            }
            _ => panic!("{first}"),
        };
        let port = |address: &str| {
            let port = address.strip_prefix("127.0.0.1:");
            port.expect("a local port").parse().unwrap()
        };
        let ports = [port(commands), port(data)];
        Self {
            child,
            output,
            log,
            ports,
            metrics: metrics.map(|address| port(address)),
        }
    }

    /// Reads its log up to a line with `words`, and returns that line.
    pub fn logs(&mut self, words: &str) -> String {
        let mut lines = String::new();
        loop {
            let before = lines.len();
            assert!(
                self.log.read_line(&mut lines).unwrap() > 0,
                "no {words} in\n{lines}"
            );
            let line = lines.split_at(before).1;
            if line.contains(words) {
                return line.to_owned();
            }
        }
    }

    /// Sends SIGTERM to it, as systemd does.
    #[cfg(unix)]
    pub fn terminate(&self) {
        let kill = format!("kill -TERM {}", self.child.id());
        let asked = Command::new("sh").args(["-c", &kill]).status().unwrap();
        assert!(asked.success());
    }

    /// Waits for its end. Returns its exit status, the rest of its output and the rest of its log.
    pub fn wait(mut self) -> (ExitStatus, String, String) {
        let (mut rest, mut log) = (String::new(), String::new());
        self.output.read_to_string(&mut rest).unwrap();
        self.log.read_to_string(&mut log).unwrap();
        (self.child.wait().unwrap(), rest, log)
    }
}

impl Drop for Robot {
    fn drop(&mut self) {
        // The robot may have ended, so errors do not matter.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
