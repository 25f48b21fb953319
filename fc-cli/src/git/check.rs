//! `fcproto git check`.

use std::fs;
use std::io::ErrorKind;
use std::path::{Component, Path, PathBuf};

use fc_codegen::output::{MANIFEST, generated};
use fc_codegen::target::FILE;
use tempfile::TempDir;

use super::{git_line, git_with, known};
use crate::lang::said;
use crate::outcome::{Failure, Status};
use crate::project::{Project, is_there};
use crate::project_dirs::ProjectDirs;
use crate::{check, fmt, generate, progress};

pub fn run(dirs: &ProjectDirs) -> Result<Status, Failure> {
    let project = Project::find(dirs)?;
    let staged = Staged::of(&project)?;
    let root = staged.root();
    let is_project = [Path::new(FILE), project.spec.as_path()]
        .iter()
        .any(|path| is_there(&root.join(path)));
    if !is_project {
        // The commit has no project, or removes it.
        return Ok(Status::Fine);
    }
    let there = ProjectDirs {
        root: Some(root),
        spec: dirs.spec.clone(),
    };
    progress::quiet(true);
    let status = fmt::run(&there, &fmt::Options::checking())?;
    if status != Status::Fine {
        return Ok(status);
    }
    let status = check::run(&there, &check::Options::strict())?;
    if status != Status::Fine {
        return Ok(status);
    }
    let options = generate::Options::checking(Vec::new());
    generate::in_project(Project::find(&there)?, dirs, &options)
}

/// A copy of the staged files in a temporary directory. Dropping it removes the directory.
struct Staged {
    directory: TempDir,
    /// The project's directory, relative to the root of the working tree.
    prefix: String,
}

impl Staged {
    fn of(project: &Project) -> Result<Self, Failure> {
        let root = &project.root;
        let top = PathBuf::from(git_line(root, &["rev-parse", "--show-toplevel"])?);
        let prefix = git_line(root, &["rev-parse", "--show-prefix"])?;
        let staged = Self {
            directory: temporary()?,
            prefix,
        };
        // The tree of the next commit. It leaves out files that are only intended to be added.
        let tree = git_line(&top, &["write-tree"])?;
        let index = staged.directory.path().join("index");
        let index = [("GIT_INDEX_FILE", index.to_string_lossy().into_owned())];
        git_with(&top, &["read-tree", &tree], "", &index)?;
        let root = std::path::absolute(root)?;
        let spec = root.join(&project.spec);
        let (root, spec) = (root.to_string_lossy(), spec.to_string_lossy());
        let mut list = vec!["ls-files", "-z", "--full-name", "--", &*root];
        let is_below = |part| matches!(part, Component::Normal(_) | Component::CurDir);
        if !project.spec.components().all(is_below) {
            list.push(&*spec);
        }
        let paths = git_with(&top, &list, "", &index)?;
        let into = format!("--prefix={}/", staged.copy().to_string_lossy());
        let copy = ["checkout-index", "--quiet", &into, "-z", "--stdin"];
        git_with(&top, &copy, &paths, &index)?;
        staged.take_ignored(project)?;
        Ok(staged)
    }

    /// Returns the root of the copied working tree.
    fn copy(&self) -> PathBuf {
        self.directory.path().join("tree")
    }

    /// Returns the root of the copied project.
    fn root(&self) -> PathBuf {
        self.copy().join(&self.prefix)
    }

    /// Copies the generated files that git ignores, because no commit has them.
    fn take_ignored(&self, project: &Project) -> Result<(), Failure> {
        let known = known(&project.root)?;
        let mut mine = generated(&project.root)?;
        mine.push(MANIFEST.to_owned());
        for path in mine.iter().filter(|path| !known.contains(*path)) {
            let (from, to) = (project.root.join(path), self.root().join(path));
            let copied = to.parent().map_or(Ok(()), fs::create_dir_all);
            match copied.and_then(|()| fs::copy(&from, &to)) {
                Err(error) if error.kind() != ErrorKind::NotFound => {
                    return Err(said!(
                        "无法复制 `{path}`：{error}",
                        "cannot copy `{path}`: {error}"
                    )
                    .into());
                }
                _ => {}
            }
        }
        Ok(())
    }
}

/// Makes a directory for temporary files that other users cannot read.
fn temporary() -> Result<TempDir, Failure> {
    let mut builder = tempfile::Builder::new();
    builder.prefix("fcproto-");
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o700));
    let made = builder.tempdir();
    Ok(made.map_err(|error| {
        let path = std::env::temp_dir();
        let path = path.display();
        said!(
            "无法创建 `{path}`：{error}",
            "cannot make `{path}`: {error}"
        )
    })?)
}
