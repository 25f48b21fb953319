//! `fcproto git merge`.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use fc_codegen::output::{MANIFEST, generated, merge_manifests};
use fc_spec::merge::merge;

use super::spec_file;
use crate::lang::said;
use crate::outcome::{Failure, Status};
use crate::place::Place;
use crate::print;
use crate::project::Project;

/// Merge a file for git, as its merge driver.
///
/// A generated file is never left in conflict: where both sides have changed the same lines, those of this branch
/// stand until the file is generated again, which `fcproto git stage` does. In a file of the spec, what both sides have added at
/// the same place is kept: commands, reports, streams, types, values of an enum, changes. Where both have changed the same
/// thing, and in all other files, the conflict is git's own.
#[derive(Debug, clap::Args)]
pub struct Options {
    /// File with what both sides began with (%O); empty if there was nothing
    #[arg(value_name = "BASE")]
    base: PathBuf,
    /// File with this branch's version (%A), in which the result is left
    #[arg(value_name = "OURS")]
    ours: PathBuf,
    /// File with the other branch's version (%B)
    #[arg(value_name = "THEIRS")]
    theirs: PathBuf,
    /// What the file is called (%P), from the root of the working tree
    #[arg(value_name = "PATH")]
    path: PathBuf,
}

pub fn run(place: &Place, options: &Options) -> Result<Status, Failure> {
    let project = Project::around(place, &options.path)?;
    let inside = project.as_ref().and_then(|project| {
        let path = options.path.strip_prefix(&project.root);
        let path = path.unwrap_or(&options.path).to_str()?;
        Some((project, path))
    });
    let Some((project, path)) = inside else {
        return options.by_lines(&[]);
    };
    if path == MANIFEST {
        let [base, ours, theirs] = options.texts()?;
        if let Some(merged) = merge_manifests(&base, &ours, &theirs) {
            return options.write(&merged);
        }
    }
    let mine = generated(&project.root).unwrap_or_default();
    if mine.iter().any(|mine| mine == path) {
        // What git cannot merge stays as this branch has it, which is right until it is written again.
        let _ = options.by_lines(&["--ours"])?;
        return Ok(Status::Fine);
    }
    if !spec_file(project, Path::new(path)) {
        return options.by_lines(&[]);
    }
    let [base, ours, theirs] = options.texts()?;
    let status = options.by_lines(&[])?;
    if status == Status::Fine {
        return Ok(status);
    }
    match merge(&base, &ours, &theirs) {
        Some(merged) => {
            print::message(&said!(
                "{path}：双方新增的内容都保留\n",
                "Keeping what both sides have added to {path}\n"
            ))?;
            options.write(&merged)
        }
        None => Ok(status),
    }
}

impl Options {
    fn texts(&self) -> Result<[String; 3], Failure> {
        let read = |path: &Path| {
            fs::read_to_string(path).map_err(|error| {
                let path = path.display();
                said!(
                    "无法读取 `{path}`：{error}",
                    "cannot read `{path}`: {error}"
                )
            })
        };
        Ok([read(&self.base)?, read(&self.ours)?, read(&self.theirs)?])
    }

    fn write(&self, text: &str) -> Result<Status, Failure> {
        fs::write(&self.ours, text).map_err(|error| {
            let path = self.ours.display();
            said!(
                "无法写入 `{path}`：{error}",
                "cannot write `{path}`: {error}"
            )
        })?;
        Ok(Status::Fine)
    }

    /// Merges the lines as git itself does. What it cannot merge it leaves as it is, and with marks around conflicts.
    fn by_lines(&self, arguments: &[&str]) -> Result<Status, Failure> {
        let output = Command::new("git")
            .args(["merge-file", "--quiet"])
            .args(["-L", "ours", "-L", "base", "-L", "theirs"])
            .args(arguments)
            .args([&self.ours, &self.base, &self.theirs])
            .output()
            .map_err(|error| said!("无法运行 git：{error}", "cannot run git: {error}"))?;
        Ok(if output.status.success() {
            Status::Fine
        } else {
            Status::Faulty
        })
    }
}
