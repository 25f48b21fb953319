//! A running `fcproto mock` or `fcproto proxy`.

use super::{Project, Run, command};
use std::io::{self, BufRead as _, BufReader};
use std::process::{Child, ChildStdout, Command, Stdio};

/// A program that listens as a robot on free ports. Dropping it ends the program.
pub struct Robot {
    child: Child,
    stdout: BufReader<ChildStdout>,
    /// Address of the command port.
    pub commands: String,
    /// Address of the data port.
    pub data: String,
}

impl Robot {
    /// Starts a mock with further arguments.
    pub fn mock(project: &Project, args: &[&str]) -> Self {
        Self::start(project, "mock", args)
    }

    /// Starts a proxy in front of this robot, with further arguments.
    pub fn proxy(&self, project: &Project, args: &[&str]) -> Self {
        let (_, data_port) = self.data.rsplit_once(':').expect("a port");
        let to = ["--to", &self.commands, "--to-data-port", data_port];
        Self::start(project, "proxy", &[&to, args].concat())
    }

    /// Starts a program and waits for its ports.
    fn start(project: &Project, name: &str, args: &[&str]) -> Self {
        let free = [name, "--command-port", "0", "--data-port", "0"];
        let mut child = command(&[&free, args].concat())
            .current_dir(project.path(""))
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .expect("the command can be run");
        let mut stdout = BufReader::new(child.stdout.take().expect("its output"));
        let mut line = String::new();
        stdout.read_line(&mut line).expect("the first line");
        let words: Vec<&str> = line.split_whitespace().collect();
        let ["commands", commands, "data", data] = words[..] else {
            panic!("the first line is {line:?}");
        };
        Self {
            child,
            commands: commands.to_owned(),
            data: data.to_owned(),
            stdout,
        }
    }

    /// Runs `fcproto mock --as app` against this robot.
    pub fn app(&self, project: &Project, args: &[&str]) -> Run {
        let output = self.app_command(project, args).output();
        Run::new(&output.expect("the command can be run"))
    }

    /// Returns the command `fcproto mock --as app` against this robot.
    pub fn app_command(&self, project: &Project, args: &[&str]) -> Command {
        let (_, data_port) = self.data.rsplit_once(':').expect("a port");
        let to = [
            "mock",
            "--as",
            "app",
            "--to",
            &self.commands,
            "--to-data-port",
            data_port,
        ];
        let mut app = command(&[&to, args].concat());
        app.current_dir(project.path(""));
        app
    }

    /// Runs `fcproto call` against this robot.
    pub fn call(&self, project: &Project, args: &[&str]) -> Run {
        project.fc(&[&["call", "--to", &self.commands], args].concat())
    }

    /// Sends a signal and waits for the end.
    pub fn stop(self, signal: &str) -> Run {
        let id = self.child.id().to_string();
        let sent = Command::new("kill").args([signal, &id]).status();
        assert!(sent.is_ok_and(|sent| sent.success()));
        self.end()
    }

    /// Waits for the end. The returned output lacks the first line, which `start` has read.
    pub fn end(mut self) -> Run {
        let stdout = io::read_to_string(&mut self.stdout).expect("its output");
        let errors = self.child.stderr.take().expect("its errors");
        Run {
            stdout,
            stderr: io::read_to_string(errors).expect("its errors"),
            status: self
                .child
                .wait()
                .expect("its end")
                .code()
                .expect("a status"),
        }
    }
}

impl Drop for Robot {
    fn drop(&mut self) {
        // The program may have ended already.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
