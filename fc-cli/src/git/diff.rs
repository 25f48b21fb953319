//! `fcproto git diff`.

use std::fs;
use std::path::{Path, PathBuf};

use fc_codegen::output::unified;
use fc_diff::{FileVersion, file_diff};

use crate::lang::{both, lang, said};
use crate::outcome::{Failure, Status, unreadable};
use crate::print;
use crate::project::Project;
use crate::project_dirs::ProjectDirs;
use crate::versions::{compared, today};

/// The name that git gives to a missing file.
const NOTHING: &str = "/dev/null";

/// Options of `fcproto git diff`.
#[derive(Debug, clap::Args)]
pub struct Options {
    #[arg(
        value_name = "PATH",
        help = both("文件的路径，从工作区根目录算起", "Path of the file from the root of the working tree")
    )]
    path: PathBuf,
    #[arg(
        value_name = "VERSIONS",
        num_args = 0..=8,
        help = both("git 传入的新旧两个版本", "Both versions, as git passes them")
    )]
    versions: Vec<String>,
}

/// A version of the file.
struct Side {
    /// The path, relative to the root of the working tree.
    path: PathBuf,
    /// The text, or `None` if the file is missing.
    text: Option<String>,
    /// The id of the object. It is all zeros if git does not have the object.
    hex: String,
}

pub fn run(dirs: &ProjectDirs, options: &Options) -> Result<Status, Failure> {
    let path = options.path.display();
    let [old_file, old_hex, _, new_file, new_hex, _, renamed @ ..] = options.versions.as_slice()
    else {
        print::result(&said!(
            "* 有冲突的文件 {path}\n",
            "* Unmerged path {path}\n"
        ))?;
        return Ok(Status::Fine);
    };
    let new_path = renamed.first().map(PathBuf::from);
    let new_path = new_path.unwrap_or_else(|| options.path.clone());
    let old = Side::read(&options.path, old_file, old_hex)?;
    let new = Side::read(&new_path, new_file, new_hex)?;
    let mut shown = format!(
        "diff --{} a/{path} b/{}\n",
        super::attributes::DRIVER,
        new_path.display()
    );
    match in_words(dirs, &old, &new)? {
        Some(words) if !words.is_empty() => shown += &words,
        words => {
            if words.is_some() {
                shown += &said!("内容没有变化\n", "no change in meaning\n");
            }
            let name = |sign, side: &Side| match side.text {
                Some(_) => format!("{sign}/{}", side.path.display()),
                None => NOTHING.to_owned(),
            };
            let text = |side: &Side| side.text.clone().unwrap_or_default();
            let lines = unified(&name('a', &old), &name('b', &new), &text(&old), &text(&new));
            shown += &print::diff(&lines);
        }
    }
    print::result(&shown)?;
    // Git takes anything else for a failure of its driver.
    Ok(Status::Fine)
}

impl Side {
    fn read(path: &Path, file: &str, hex: &str) -> Result<Self, Failure> {
        let text = if file == NOTHING {
            None
        } else {
            let bytes = fs::read(file).map_err(unreadable(Path::new(file)))?;
            Some(String::from_utf8_lossy(&bytes).into_owned())
        };
        Ok(Self {
            path: path.to_owned(),
            text,
            hex: hex.to_owned(),
        })
    }

    /// Returns the file as part of the project's spec, if it belongs to it.
    fn in_spec(&self, project: &Project) -> Option<FileVersion<'_>> {
        Some(FileVersion {
            path: project.spec_file(&self.path)?.to_owned(),
            text: self.text.as_deref(),
            object: &self.hex,
        })
    }
}

/// Returns a description of the change, empty for no change. Returns `None` if no spec fits both versions of the file.
fn in_words(dirs: &ProjectDirs, old: &Side, new: &Side) -> Result<Option<String>, Failure> {
    let Some(project) = Project::around(dirs, &new.path)? else {
        return Ok(None);
    };
    let (Some(old), Some(new)) = (old.in_spec(&project), new.in_spec(&project)) else {
        return Ok(None);
    };
    let diff = file_diff(compared(&project), [&old, &new], &today(None));
    Ok(diff.map(|diff| diff.text(lang())))
}
