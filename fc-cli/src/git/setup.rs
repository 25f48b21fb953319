//! `fcproto git setup`.

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

use super::attributes::{DRIVER, missing};
use super::{git, git_line};
use crate::lang::{both, said};
use crate::outcome::{Failure, Status, unwritable};
use crate::print;
use crate::project::{Project, is_there};
use crate::project_dirs::ProjectDirs;

/// Options of `fcproto git setup`.
#[derive(Debug, clap::Args)]
pub struct Options {
    #[arg(
        long,
        help = both("也安装 `pre-commit` 和 `post-merge` 钩子", "Also install the hooks `pre-commit` and `post-merge`")
    )]
    hooks: bool,
}

/// The line that identifies a hook of this program.
const MARK: &str = "# Written by `fcproto git setup --hooks`.";

/// The line in hooks from the time when the program was called `fc`. Their path to the program is no longer valid.
const OLD_MARK: &str = "# Written by `fc git setup --hooks`.";

/// The hooks and their commands. `FC` is the placeholder for this program.
const HOOKS: [(&str, &str); 2] = [
    ("pre-commit", "FC git check\n"),
    (
        "post-merge",
        "\
# A merge that is not committed yet (--squash), and commits of others, stay as they are.
if [ \"$1\" = 1 ]; then
  exec FC git stage --quiet
fi
case $(git reflog -1 --format=%gs) in
  *Fast-forward) ;;
  *) exec FC git stage --quiet --amend ;;
esac
",
    ),
];

pub fn run(dirs: &ProjectDirs, options: &Options) -> Result<Status, Failure> {
    let project = Project::find(dirs)?;
    let root = &project.root;
    let command = this_command()?;
    let hooks = if options.hooks {
        hooks(root, &command)?
    } else {
        Vec::new()
    };
    let settings = [
        (
            format!("diff.{DRIVER}.command"),
            format!("{command} git diff"),
        ),
        (
            format!("merge.{DRIVER}.name"),
            "files of a protocol spec, and what is generated from it".to_owned(),
        ),
        (
            format!("merge.{DRIVER}.driver"),
            format!("{command} git merge %O %A %B %P"),
        ),
    ];
    for (name, value) in &settings {
        git(root, &["config", "--local", name, value], "")?;
    }
    for (path, text) in &hooks {
        write_hook(path, text)?;
    }
    let set_up = print::good(&said!("已配置", "set up"));
    let mut text = said!("{set_up} diff 和 merge\n", "{set_up} diff and merge\n");
    for (path, _) in &hooks {
        let (wrote, path) = (print::good(&said!("已写入", "wrote")), path.display());
        // Writing to a String cannot fail.
        let _ = writeln!(text, "{wrote} {path}");
    }
    print::done(&text)?;
    let lines = missing(&project)?;
    if !lines.is_empty() {
        let file = root.join(".gitattributes");
        let lines = lines.join("\n");
        let file = file.display();
        print::result(&said!(
            "在 {file} 中加入：\n{lines}\n",
            "add to {file}:\n{lines}\n"
        ))?;
    }
    Ok(Status::Fine)
}

/// Returns the command that runs this program from a shell. It is an absolute path, because git may run with another
/// `PATH`.
fn this_command() -> Result<String, Failure> {
    let path = std::env::current_exe().map_err(|error| {
        said!(
            "无法得知本程序的位置：{error}",
            "cannot find this program: {error}"
        )
    })?;
    Ok(format!(
        "'{}'",
        path.to_string_lossy().replace('\'', r"'\''")
    ))
}

/// Returns the hooks to write. Fails if a hook of another program exists.
fn hooks(root: &Path, command: &str) -> Result<Vec<(PathBuf, String)>, Failure> {
    let directory = root.join(git_line(root, &["rev-parse", "--git-path", "hooks"])?);
    let prefix = git_line(root, &["rev-parse", "--show-prefix"])?;
    let prefix = prefix.trim_end_matches('/');
    // Git runs hooks at the root of the working tree.
    let enter = if prefix.is_empty() {
        String::new()
    } else {
        // With `GIT_DIR` alone, git uses the current directory as the root.
        let root = "[ -z \"$GIT_DIR\" ] || export GIT_WORK_TREE=\"$PWD\"\n";
        format!("{root}cd '{}' || exit\n", prefix.replace('\'', r"'\''"))
    };
    let mut hooks = Vec::new();
    for (name, action) in HOOKS {
        let path = directory.join(name);
        let is_other = match fs::read(&path) {
            Ok(bytes) => {
                let text = String::from_utf8_lossy(&bytes);
                !text.contains(MARK) && !text.contains(OLD_MARK)
            }
            // The path is a directory or a dangling link.
            Err(_) => is_there(&path),
        };
        if is_other {
            let action = action.replace("FC", "fcproto");
            let (path, action) = (path.display(), action.trim_end());
            return Err(said!(
                "已有钩子 `{path}`；把它移走，或在其中加入：\n{action}",
                "the hook `{path}` exists; move it away, or add to it:\n{action}"
            )
            .into());
        }
        let action = action.replace("FC", command);
        hooks.push((path, format!("#!/bin/sh\n{MARK}\n{enter}{action}")));
    }
    Ok(hooks)
}

fn write_hook(path: &Path, text: &str) -> Result<(), Failure> {
    let directory = path.parent().map_or(Ok(()), fs::create_dir_all);
    let written = directory.and_then(|()| fs::write(path, text));
    #[cfg(unix)]
    let written = written.and_then(|()| {
        use std::os::unix::fs::PermissionsExt as _;
        fs::set_permissions(path, fs::Permissions::from_mode(0o755))
    });
    written.map_err(unwritable(path))
}
