//! A running `fcproto mock`.

use super::{Project, Run, command};
use std::io::{BufRead as _, BufReader, Read as _};
use std::process::{Child, ChildStdout, Command, Stdio};

/// A mock on free ports. It ends when it is dropped.
pub struct Mock {
    child: Child,
    stdout: BufReader<ChildStdout>,
    /// Address of the command port.
    pub commands: String,
    /// Address of the data port.
    pub data: String,
}

impl Mock {
    /// Starts a mock with further arguments, and waits for its ports.
    pub fn start(project: &Project, args: &[&str]) -> Self {
        let free = ["mock", "--command-port", "0", "--data-port", "0"];
        let mut child = command(&[&free, args].concat())
            .current_dir(project.path(""))
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
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

    /// Runs `fcproto call` against the mock.
    pub fn call(&self, project: &Project, args: &[&str]) -> Run {
        project.fc(&[&["call", "--to", &self.commands], args].concat())
    }

    /// Sends a signal and returns the exit status.
    pub fn stop(mut self, signal: &str) -> Option<i32> {
        let id = self.child.id().to_string();
        let sent = Command::new("kill").args([signal, &id]).status();
        assert!(sent.is_ok_and(|sent| sent.success()));
        self.end()
    }

    /// Waits for the end of the mock and returns its exit status.
    pub fn end(&mut self) -> Option<i32> {
        let mut rest = String::new();
        self.stdout.read_to_string(&mut rest).expect("its output");
        self.child.wait().expect("its end").code()
    }
}

impl Drop for Mock {
    fn drop(&mut self) {
        // It may have ended already.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
