//! Processes of this program that serve and drive, and what they say on their standard output.

use std::ffi::OsString;
use std::io::{BufRead as _, BufReader, Lines, Write as _};
use std::path::Path;
use std::process::{Child, ChildStdout, Command, Stdio};

/// A process that is being talked to line by line.
pub struct Process {
    child: Child,
    lines: Lines<BufReader<ChildStdout>>,
}

/// Figures of one line.
pub type Figures = Vec<f64>;

impl Process {
    /// Starts `program`, on one core if `core` says which.
    pub fn start(program: &Path, arguments: &[&str], core: Option<usize>) -> Self {
        let mut command = match core {
            Some(core) => {
                let mut command = Command::new("taskset");
                command.args([OsString::from("-c"), core.to_string().into(), program.into()]);
                command
            }
            None => Command::new(program),
        };
        let mut child = command
            .args(arguments)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .expect("a process starts; to keep one on a core takes `taskset`");
        let lines = BufReader::new(child.stdout.take().expect("its output")).lines();
        Self { child, lines }
    }

    /// The next line that it prints.
    pub fn line(&mut self) -> String {
        self.lines.next().expect("a line").expect("text")
    }

    /// The figures of the next line.
    pub fn figures(&mut self) -> Figures {
        let line = self.line();
        line.split_whitespace().map(|word| word.parse().expect("a figure")).collect()
    }

    /// Sends it a line.
    pub fn tell(&mut self, line: &str) {
        writeln!(self.child.stdin.as_mut().expect("its input"), "{line}").expect("it listens");
    }

    /// Ends its input, which tells it to come to an end, and gives the figures that it prints then.
    pub fn end(mut self) -> Figures {
        drop(self.child.stdin.take());
        let figures = self.figures();
        let _ = self.child.wait();
        figures
    }
}

/// Also when something has gone wrong.
impl Drop for Process {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// The cores for server and driver: one each, where there are two.
pub fn cores() -> (Option<usize>, Option<usize>) {
    let two = std::thread::available_parallelism().is_ok_and(|cores| cores.get() >= 2);
    if two { (Some(0), Some(1)) } else { (None, None) }
}
