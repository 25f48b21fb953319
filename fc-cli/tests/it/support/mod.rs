//! A temporary project for each test, and runs of the command in it.

pub mod git;
#[cfg(unix)]
pub mod robot;

use std::ffi::OsString;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use tempfile::TempDir;

/// A project in a temporary directory.
pub struct Project {
    root: TempDir,
}

/// The output and exit status of a run.
#[derive(Debug)]
pub struct Run {
    pub status: i32,
    pub stdout: String,
    pub stderr: String,
}

impl Project {
    /// Creates a project with the small spec of the documentation tests. The repository's own spec would not do,
    /// because its owner may add the same things as these tests.
    pub fn new() -> Self {
        let project = Self::empty();
        let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("../fc-codegen/tests/docs");
        copy(&docs.join("spec"), &project.path("spec"));
        project
    }

    /// Creates an empty project.
    pub fn empty() -> Self {
        Self {
            root: tempfile::tempdir().expect("a directory for the test"),
        }
    }

    pub fn path(&self, path: &str) -> PathBuf {
        self.root.path().join(path)
    }

    pub fn read(&self, path: &str) -> String {
        std::fs::read_to_string(self.path(path)).expect("a file of the project")
    }

    pub fn write(&self, path: &str, text: &str) {
        let path = self.path(path);
        std::fs::create_dir_all(path.parent().expect("a directory")).expect("its directory");
        std::fs::write(path, text).expect("a file of the project");
    }

    pub fn append(&self, path: &str, text: &str) {
        self.write(path, &(self.read(path) + text));
    }

    /// Runs `fcproto` in the project's root.
    pub fn fc(&self, args: &[&str]) -> Run {
        self.fc_in("", args)
    }

    /// Runs `fcproto` in a directory of the project.
    pub fn fc_in(&self, directory: &str, args: &[&str]) -> Run {
        let output = command(args).current_dir(self.path(directory)).output();
        Run::new(&output.expect("the command can be run"))
    }

    /// Returns every file below a directory of the project, with its modification time.
    pub fn files(&self, directory: &str) -> Vec<(PathBuf, std::time::SystemTime)> {
        let mut files = Vec::new();
        visit(&self.path(directory), &mut files);
        files.sort();
        files
    }
}

impl Run {
    pub fn new(output: &Output) -> Self {
        Self {
            status: output.status.code().expect("not ended by a signal"),
            stdout: String::from_utf8(output.stdout.clone()).expect("UTF-8"),
            stderr: String::from_utf8(output.stderr.clone()).expect("UTF-8"),
        }
    }

    /// Runs a command with this text on standard input.
    pub fn with_input(command: &mut Command, input: impl AsRef<[u8]>) -> Self {
        let mut child = command
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .expect("the command can be run");
        let mut stdin = child.stdin.take().expect("its input");
        stdin.write_all(input.as_ref()).expect("it reads");
        drop(stdin);
        Self::new(&child.wait_with_output().expect("its end"))
    }

    /// Fails the test unless the run ended with this status.
    pub fn expect(self, status: i32) -> Self {
        assert_eq!(self.status, status, "{self:#?}");
        self
    }
}

/// Returns the command without environment variables for colors, the repository and the language.
pub fn command(args: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_fcproto"));
    command.args(args);
    for variable in [
        "NO_COLOR",
        "CLICOLOR",
        "CLICOLOR_FORCE",
        "TERM",
        "GITHUB_WORKSPACE",
        "LC_ALL",
        "LC_MESSAGES",
        "LANG",
    ] {
        command.env_remove(variable);
    }
    command
}

/// Returns a `PATH` that finds the command first.
pub fn path_to_command() -> OsString {
    let directory = Path::new(env!("CARGO_BIN_EXE_fcproto"))
        .parent()
        .expect("its directory");
    let others = std::env::var_os("PATH").unwrap_or_default();
    let all = std::iter::once(directory.to_owned()).chain(std::env::split_paths(&others));
    std::env::join_paths(all).expect("paths")
}

/// Copies a directory.
pub fn copy(from: &Path, to: &Path) {
    std::fs::create_dir_all(to).expect("a directory");
    for entry in std::fs::read_dir(from).expect("the spec") {
        let path = entry.expect("an entry").path();
        let target = to.join(path.file_name().expect("a name"));
        if path.is_dir() {
            copy(&path, &target);
        } else {
            std::fs::copy(&path, &target).expect("a copy");
        }
    }
}

fn visit(directory: &Path, files: &mut Vec<(PathBuf, std::time::SystemTime)>) {
    for entry in std::fs::read_dir(directory).expect("a directory") {
        let entry = entry.expect("an entry");
        if entry.path().is_dir() {
            visit(&entry.path(), files);
        } else {
            let changed = entry.metadata().and_then(|meta| meta.modified());
            files.push((entry.path(), changed.expect("a time of change")));
        }
    }
}
