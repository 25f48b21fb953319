//! `fcproto git`: drivers and hooks that teach git the spec.

mod attributes;
pub mod check;
pub mod diff;
pub mod merge;
pub mod setup;
pub mod stage;

use std::collections::BTreeSet;
use std::io::Write as _;
use std::path::Path;
use std::process::{Command, Stdio};

use crate::lang::said;
use crate::outcome::{Failure, Status};
use crate::project_dirs::ProjectDirs;

/// Options of `fcproto git`.
#[derive(Debug, clap::Args)]
pub struct Options {
    #[command(subcommand)]
    command: Action,
}

/// A command with its options.
#[derive(Debug, clap::Subcommand)]
enum Action {
    Setup(setup::Options),
    Check,
    Stage(stage::Options),
    Diff(diff::Options),
    Merge(merge::Options),
}

pub fn run(dirs: &ProjectDirs, options: &Options) -> Result<Status, Failure> {
    match &options.command {
        Action::Setup(options) => setup::run(dirs, options),
        Action::Check => check::run(dirs),
        Action::Stage(options) => stage::run(dirs, options),
        Action::Diff(options) => diff::run(dirs, options),
        Action::Merge(options) => merge::run(dirs, options),
    }
}

/// Runs git in a directory and returns its output.
fn git(directory: &Path, arguments: &[&str], input: &str) -> Result<String, Failure> {
    git_with(directory, arguments, input, &[])
}

/// Runs git in a directory and returns its output without the end of the line.
fn git_line(directory: &Path, arguments: &[&str]) -> Result<String, Failure> {
    Ok(line(&git(directory, arguments, "")?).to_owned())
}

/// Returns a text without the end of its last line.
fn line(text: &str) -> &str {
    text.trim_end_matches(['\r', '\n'])
}

/// Returns the files below a directory that git does not ignore.
fn known(directory: &Path) -> Result<BTreeSet<String>, Failure> {
    let list = [
        "ls-files",
        "-z",
        "--cached",
        "--others",
        "--exclude-standard",
    ];
    let known = git(directory, &list, "")?;
    Ok(parts(&known).map(str::to_owned).collect())
}

/// Runs git with additional environment variables.
fn git_with(
    directory: &Path,
    arguments: &[&str],
    input: &str,
    environment: &[(&str, String)],
) -> Result<String, Failure> {
    let cannot = |error: std::io::Error| said!("无法运行 git：{error}", "cannot run git: {error}");
    let mut child = Command::new("git")
        .args(arguments)
        .envs(environment.iter().map(|(name, value)| (name, value)))
        .current_dir(directory)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .map_err(cannot)?;
    let mut stdin = child.stdin.take();
    let output = std::thread::scope(|scope| {
        // A separate thread writes, so that reading and writing do not block each other. Input that git does not read
        // is not needed.
        scope.spawn(move || {
            stdin
                .as_mut()
                .map(|stdin| stdin.write_all(input.as_bytes()))
        });
        child.wait_with_output()
    })
    .map_err(cannot)?;
    if !output.status.success() {
        let why = String::from_utf8_lossy(&output.stderr);
        let command = arguments.first().copied().unwrap_or_default();
        return Err(format!("git {command}: {}", why.trim()).into());
    }
    Ok(String::from_utf8_lossy(&output.stdout).into_owned())
}

/// Splits a text with parts that end in NUL.
fn parts(text: &str) -> impl Iterator<Item = &str> {
    text.split('\0').filter(|part| !part.is_empty())
}
