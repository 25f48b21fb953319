//! `fcproto git merge`.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use fc_codegen::output::{MANIFEST, generated, merge_manifests};
use fc_spec::merge::merge;

use crate::lang::{both, said};
use crate::outcome::{Failure, Status, unreadable, unwritable};
use crate::print;
use crate::project::Project;
use crate::project_dirs::ProjectDirs;

/// Options of `fcproto git merge`.
#[derive(Debug, clap::Args)]
pub struct Options {
    #[arg(
        value_name = "BASE",
        help = both("共同祖先的文件（`%O`），没有时为空", "File of the common ancestor (`%O`), empty if there is none")
    )]
    base: PathBuf,
    #[arg(
        value_name = "OURS",
        help = both("本分支的文件（`%A`），结果写在其中", "File of this branch (`%A`), which gets the result")
    )]
    ours: PathBuf,
    #[arg(
        value_name = "THEIRS",
        help = both("另一分支的文件（`%B`）", "File of the other branch (`%B`)")
    )]
    theirs: PathBuf,
    #[arg(
        value_name = "PATH",
        help = both("文件的路径（`%P`），从工作区根目录算起", "Path of the file (`%P`) from the root of the working tree")
    )]
    path: PathBuf,
}

pub fn run(dirs: &ProjectDirs, options: &Options) -> Result<Status, Failure> {
    let project = Project::around(dirs, &options.path)?;
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
        // The next `fcproto generate` rewrites the file, so this branch's lines win conflicts.
        let _ = options.by_lines(&["--ours"])?;
        return Ok(Status::Fine);
    }
    if project.spec_file(&options.path).is_none() {
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
        let read = |path: &Path| fs::read_to_string(path).map_err(unreadable(path));
        Ok([read(&self.base)?, read(&self.ours)?, read(&self.theirs)?])
    }

    fn write(&self, text: &str) -> Result<Status, Failure> {
        fs::write(&self.ours, text).map_err(unwritable(&self.ours))?;
        Ok(Status::Fine)
    }

    /// Merges by lines, as git does. Conflicts get markers.
    fn by_lines(&self, arguments: &[&str]) -> Result<Status, Failure> {
        let output = Command::new("git")
            .args(["merge-file", "--quiet"])
            .args(["-L", "ours", "-L", "base", "-L", "theirs"])
            .args(arguments)
            .args([&self.ours, &self.base, &self.theirs])
            .output()
            .map_err(|error| said!("无法运行 git：{error}", "cannot run git: {error}"))?;
        Ok(Status::fine_if(output.status.success()))
    }
}
