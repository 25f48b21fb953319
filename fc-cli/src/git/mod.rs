//! `fcproto git`: what git does better when it is told of the spec.

mod attributes;
pub mod diff;
mod merge;
mod setup;
mod stage;

use std::io::Write as _;
use std::path::Path;
use std::process::{Command, Stdio};

use crate::lang::said;
use crate::outcome::{Failure, Status};
use crate::place::Place;
use crate::project::Project;

/// Let git merge the spec and what is generated from it, and say what a change of the spec means.
///
/// `fcproto git setup` tells a clone of it once; the other commands are those that git calls, but for `stage`.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  fcproto git setup           once in a clone: merge and compare files of the spec with `fcproto`
  fcproto git setup --hooks   the same, and check each commit
  fcproto git stage           generate, and stage what has changed")]
pub struct Options {
    #[command(subcommand)]
    command: Action,
}

/// What to do.
#[derive(Debug, clap::Subcommand)]
enum Action {
    Setup(setup::Options),
    Stage(stage::Options),
    Diff(diff::Options),
    Merge(merge::Options),
}

pub fn run(place: &Place, options: &Options) -> Result<Status, Failure> {
    match &options.command {
        Action::Setup(options) => setup::run(place, options),
        Action::Stage(options) => stage::run(place, options),
        Action::Diff(options) => diff::run(place, options),
        Action::Merge(options) => merge::run(place, options),
    }
}

/// What git prints when it is called in a directory.
fn git(directory: &Path, arguments: &[&str], input: &str) -> Result<String, Failure> {
    git_with(directory, arguments, input, &[])
}

/// The same with more in its environment.
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
        // Beside the reading, so that neither waits for the other. What git does not read it does not need.
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

/// Whether a file is one of the project's spec; `path` leads there from the project's directory.
fn spec_file(project: &Project, path: &Path) -> bool {
    let Ok(path) = path.strip_prefix(&project.spec) else {
        return false;
    };
    let path = path.strip_prefix("commands").unwrap_or(path);
    path.components().count() == 1 && path.extension().is_some_and(|it| it == "yaml")
}

/// The parts of a text that end with NUL each.
fn parts(text: &str) -> impl Iterator<Item = &str> {
    text.split('\0').filter(|part| !part.is_empty())
}
