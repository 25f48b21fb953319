//! `fcproto git diff`.

use std::fs;
use std::path::{Path, PathBuf};

use fc_codegen::output::unified;
use fc_diff::{Against, Format, Version, diff_for, render, stands_in, waive};
use fc_spec::diagnostic::Faults;
use fc_spec::source::Sources;
use fc_spec::syntax::read_dir;

use super::{git, spec_file};
use crate::lang::{both, lang, said};
use crate::outcome::{Failure, Status, unreadable};
use crate::print;
use crate::project::Project;
use crate::project_dirs::ProjectDirs;
use crate::versions::{packages, today};

/// The number of commits that are searched for a version of the file.
const COMMITS: &str = "--max-count=200";

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

    fn is_of_git(&self) -> bool {
        self.hex.chars().any(|digit| digit != '0' && digit != '.')
    }
}

/// Returns a description of the change, empty for no change. Returns `None` if no spec fits both versions of the file.
fn in_words(dirs: &ProjectDirs, old: &Side, new: &Side) -> Result<Option<String>, Failure> {
    let Some(project) = Project::around(dirs, &new.path)? else {
        return Ok(None);
    };
    let inside = |side: &Side| {
        let path = side.path.strip_prefix(&project.root).unwrap_or(&side.path);
        let is_spec = spec_file(&project, path);
        is_spec.then(|| path.to_str().map(str::to_owned)).flatten()
    };
    let (Some(old_path), Some(new_path)) = (inside(old), inside(new)) else {
        return Ok(None);
    };
    let mut rests = Rests {
        project: &project,
        read: Vec::new(),
    };
    for [old_rest, new_rest] in pairs(&project, &new_path, new) {
        let of = |name, rests: &mut Rests<'_>, rest: &str, text: Option<&String>| {
            let others = rests.get(rest)?;
            let others = others.iter().map(|(_, file)| (&file.path, &file.text));
            let others = others.filter(|(path, _)| **path != old_path && **path != new_path);
            let path = if name == 'a' { &old_path } else { &new_path };
            let files = others.chain(text.map(|text| (path, text)));
            let files = files.map(|(path, text)| (path.as_str(), text.as_str()));
            Version::of(
                &format!("{name}/{path}"),
                Sources::from_texts(files),
                Faults::new(),
            )
            .ok()
        };
        let before = of('a', &mut rests, &old_rest, old.text.as_ref());
        let Some(before) = before else { continue };
        let after = of('b', &mut rests, &new_rest, new.text.as_ref());
        let Some(after) = after else { continue };
        let versions = [&before, &after];
        let mut findings = diff_for(&before.model, &after.model, packages(&project));
        if old_rest != new_rest {
            // Other files can differ as well, and git reports them separately.
            findings.retain(|finding| {
                stands_in(finding, &old_path, versions) || stands_in(finding, &new_path, versions)
            });
        }
        waive(
            &mut findings,
            &after.model.waivers,
            &today(None),
            Against::Other,
        );
        if findings.is_empty() {
            return Ok(Some(String::new()));
        }
        return Ok(Some(render(&findings, versions, Format::Text, lang())));
    }
    Ok(None)
}

/// The working tree. The name of a git revision cannot be empty.
const HERE: &str = "";

/// Returns the sources for the other files of the spec, each for the old and the new version. Most pairs give both
/// versions the same files. The others use the files before and after the change.
fn pairs(project: &Project, path: &str, new: &Side) -> Vec<[String; 2]> {
    let pair = |old: &str, new: &str| [old.to_owned(), new.to_owned()];
    let mut pairs = vec![pair(HERE, HERE), pair("HEAD", "HEAD")];
    if !new.is_of_git() {
        pairs.push(pair("HEAD", HERE));
    }
    if let Some(commit) = commit_with(project, path, new) {
        let before = format!("{commit}^");
        pairs.push(pair(&commit, &commit));
        pairs.push(pair(&before, &before));
        pairs.push(pair(&before, &commit));
    }
    pairs
}

/// Returns the last commit that gave the file its content.
fn commit_with(project: &Project, path: &str, side: &Side) -> Option<String> {
    if !side.is_of_git() {
        return None;
    }
    let log = [
        "log",
        "--all",
        COMMITS,
        "--format=%H",
        "--raw",
        "--no-abbrev",
        "--no-renames",
        "--",
        path,
    ];
    let log = git(&project.root, &log, "").ok()?;
    let mut commit = None;
    for line in log.lines() {
        match line.strip_prefix(':') {
            // Modes first, then the object of the old and of the new file.
            Some(facts) if facts.split(' ').nth(3) == Some(&side.hex) => return commit,
            None if !line.is_empty() => commit = Some(line.to_owned()),
            _ => {}
        }
    }
    None
}

/// The files of the spec from several sources. Each source is read once.
struct Rests<'p> {
    project: &'p Project,
    read: Vec<(String, Option<Sources>)>,
}

impl Rests<'_> {
    fn get(&mut self, rest: &str) -> Option<&Sources> {
        if !self.read.iter().any(|(name, _)| name == rest) {
            let Project { root, spec, .. } = self.project;
            let sources = if rest == HERE {
                let mut faults = Faults::new();
                let sources = read_dir(root, spec, &mut faults);
                (!faults.has_errors()).then_some(sources)
            } else {
                Version::sources_of(&format!("git:{rest}"), root, spec).ok()
            };
            self.read.push((rest.to_owned(), sources));
        }
        let (_, sources) = self.read.iter().find(|(name, _)| name == rest)?;
        sources.as_ref()
    }
}
