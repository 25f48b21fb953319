//! `fcproto git stage`.

use std::collections::BTreeSet;
use std::path::Path;

use fc_codegen::output::{MANIFEST, generated};

use super::{git, git_line, git_with, known, line};
use crate::generate;
use crate::lang::both;
use crate::outcome::{Failure, Status};
use crate::project::Project;
use crate::project_dirs::ProjectDirs;

/// Options of `fcproto git stage`.
#[derive(Debug, clap::Args)]
pub struct Options {
    #[arg(
        long,
        help = both("把暂存的全部修改并入上一次提交", "Add all staged changes to the last commit")
    )]
    amend: bool,
}

pub fn run(dirs: &ProjectDirs, options: &Options) -> Result<Status, Failure> {
    let project = Project::find(dirs)?;
    let root = &project.root;
    let before = generated(root)?;
    let status = generate::run(dirs, &generate::Options::default())?;
    if status != Status::Fine {
        return Ok(status);
    }
    let mut mine: BTreeSet<String> = before.into_iter().chain(generated(root)?).collect();
    mine.insert(MANIFEST.to_owned());
    let known = known(root)?;
    let paths = known.intersection(&mine);
    let paths: String = paths.flat_map(|path| [path, "\0"]).collect();
    let add = ["update-index", "--add", "--remove", "-z", "--stdin"];
    git(root, &add, &paths)?;
    let is_staged = !git(root, &["diff", "--cached", "--name-only"], "")?.is_empty();
    if options.amend && is_staged {
        amend(root)?;
    }
    Ok(Status::Fine)
}

/// Repeats the last commit with the staged files. `git commit --amend` refuses this while the hook of a merge runs.
fn amend(root: &Path) -> Result<(), Failure> {
    let of_last = |format: &str| {
        let format = format!("--format={format}");
        git_line(root, &["log", "-1", "--date=raw", &format])
    };
    let tree = git_line(root, &["write-tree"])?;
    let parents = of_last("%P")?;
    let mut make = vec!["commit-tree", &tree, "-F", "-"];
    for parent in parents.split_whitespace() {
        make.extend(["-p", parent]);
    }
    let raw = git(root, &["cat-file", "commit", "HEAD"], "")?;
    let mut head = raw.lines().take_while(|line| !line.is_empty());
    if head.any(|line| line.starts_with("gpgsig")) {
        make.push("-S");
    }
    let author = [
        ("GIT_AUTHOR_NAME", of_last("%an")?),
        ("GIT_AUTHOR_EMAIL", of_last("%ae")?),
        ("GIT_AUTHOR_DATE", of_last("%ad")?),
    ];
    let message = of_last("%B")? + "\n";
    let last = git_line(root, &["rev-parse", "HEAD"])?;
    let commit = git_with(root, &make, &message, &author)?;
    let why = "fcproto git stage --amend";
    let update = ["update-ref", "-m", why, "HEAD", line(&commit), &last];
    git(root, &update, "")?;
    Ok(())
}
