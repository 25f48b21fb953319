//! Child processes, which serve or drive, and the lines that they print.

use std::ffi::OsString;
use std::io::{BufRead as _, BufReader, Lines, Write as _};
use std::path::Path;
use std::process::{Child, ChildStdout, Command, Stdio};

/// A child process that reads and prints lines.
pub struct Process {
    child: Child,
    lines: Lines<BufReader<ChildStdout>>,
}

/// The numbers in one printed line.
pub type Figures = Vec<f64>;

impl Process {
    /// Starts `program`, pinned to a core if `core` is set.
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

    /// Returns the next line that the process prints.
    pub fn line(&mut self) -> String {
        self.lines.next().expect("a line").expect("text")
    }

    /// Returns the numbers in the next line.
    pub fn figures(&mut self) -> Figures {
        let line = self.line();
        line.split_whitespace().map(|word| word.parse().expect("a figure")).collect()
    }

    /// Sends a line to the process.
    pub fn tell(&mut self, line: &str) {
        writeln!(self.child.stdin.as_mut().expect("its input"), "{line}").expect("it listens");
    }

    /// Closes the input, which ends the process, and returns the last numbers that the process prints.
    pub fn end(mut self) -> Figures {
        drop(self.child.stdin.take());
        let figures = self.figures();
        let _ = self.child.wait();
        figures
    }
}

/// Kills the process, also after a panic in this program.
impl Drop for Process {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// Returns the cores for server and driver, or `None` twice on a machine with a single core.
pub fn cores() -> (Option<usize>, Option<usize>) {
    let two = std::thread::available_parallelism().is_ok_and(|cores| cores.get() >= 2);
    if two { (Some(0), Some(1)) } else { (None, None) }
}
