//! Finds the project and reads its settings.

use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use fc_codegen::output::replace_spec_file;
use fc_codegen::target::{FILE, Targets};
use fc_spec::diagnostic::Faults;
use fc_spec::source::{SourceFile, Sources};
use fc_spec::syntax::{is_spec_file, read_files};

use crate::lang::{in_lang, said};
use crate::outcome::Failure;
use crate::project_dirs::ProjectDirs;

/// The file that every spec has.
const PROTOCOL: &str = "protocol.yaml";

/// A project: a directory with `fc.yaml`, or with a spec at its usual place.
#[derive(Clone)]
pub struct Project {
    /// The project's directory.
    pub root: PathBuf,
    /// The directory of the spec, relative to the root.
    pub spec: PathBuf,
    /// The targets that the project generates.
    pub targets: Targets,
}

impl Project {
    /// Returns the named project, or the nearest one upwards from the current directory.
    pub fn find(dirs: &ProjectDirs) -> Result<Self, Failure> {
        Self::at(root(dirs)?, dirs)
    }

    /// Returns the directory of the spec without `fc.yaml`, relative to the root.
    pub fn usual_spec(dirs: &ProjectDirs) -> PathBuf {
        let spec = dirs.spec.clone();
        spec.unwrap_or_else(|| Targets::default().spec.into())
    }

    /// Returns the named project, or the innermost one that contains a file. `path` is relative to the current
    /// directory.
    pub fn around(dirs: &ProjectDirs, path: &Path) -> Result<Option<Self>, Failure> {
        let root = match &dirs.root {
            Some(root) => Some(root.clone()),
            None => path.ancestors().skip(1).find_map(|above| {
                let is_here = above.as_os_str().is_empty();
                let above = if is_here { Path::new(".") } else { above };
                is_project(above, dirs).then(|| above.to_owned())
            }),
        };
        root.map(|root| Self::at(root, dirs)).transpose()
    }

    /// Like [`Self::find`], from another directory.
    pub fn find_from(dirs: &ProjectDirs, directory: &Path) -> Result<Self, Failure> {
        let root = match &dirs.root {
            Some(_) => root(dirs)?,
            None => above(dirs, directory)?,
        };
        Self::at(root, dirs)
    }

    /// Writes the files of the spec that have changed, and returns their paths.
    pub fn write_changes(&self, before: &Sources, after: &Sources) -> Result<Vec<String>, Failure> {
        let mut written = Vec::new();
        for (_, file) in changed(before, after) {
            replace_spec_file(&self.root, &file.path, &file.text)?;
            written.push(file.path.clone());
        }
        Ok(written)
    }

    /// Returns the path of a file of the spec, relative to the root, or `None` for other files. `path` is relative to the
    /// current directory, like the root.
    pub fn spec_file<'p>(&self, path: &'p Path) -> Option<&'p str> {
        let path = path.strip_prefix(&self.root).unwrap_or(path);
        let is_of_spec = path.strip_prefix(&self.spec).is_ok_and(is_spec_file);
        path.to_str().filter(|_| is_of_spec)
    }

    fn at(root: PathBuf, dirs: &ProjectDirs) -> Result<Self, Failure> {
        let targets = match settings(&root)? {
            Some(text) => Targets::read(&text)?,
            None => Targets::default(),
        };
        let spec = dirs.spec.clone();
        let spec = spec.unwrap_or_else(|| PathBuf::from(&targets.spec));
        Ok(Self {
            root,
            spec,
            targets,
        })
    }
}

/// Returns the files of a spec whose text has changed, before and after the change.
pub fn changed<'s>(
    before: &'s Sources,
    after: &'s Sources,
) -> impl Iterator<Item = (&'s SourceFile, &'s SourceFile)> {
    let pairs = before.iter().zip(after.iter());
    let pairs = pairs.map(|((_, before), (_, after))| (before, after));
    pairs.filter(|(before, after)| before.text != after.text)
}

/// Reads the text of `fc.yaml`. Returns `None` if the file does not exist.
pub fn settings(root: &Path) -> Result<Option<String>, Failure> {
    let file = root.join(FILE);
    if !is_there(&file) {
        return Ok(None);
    }
    let mut faults = Faults::new();
    let name = file.display().to_string();
    let read = read_files([(name, file.as_path())], &mut faults);
    if let Some(fault) = faults.iter().next() {
        return Err(in_lang(&fault.message).into());
    }
    Ok(read.iter().next().map(|(_, file)| file.text.clone()))
}

/// Returns `true` if a path leads to anything, be it a directory or a link to nothing.
pub fn is_there(path: &Path) -> bool {
    match path.symlink_metadata() {
        Ok(_) => true,
        // The path may exist without being readable.
        Err(error) => !matches!(error.kind(), ErrorKind::NotFound | ErrorKind::NotADirectory),
    }
}

/// Returns the directory of the project that [`Project::find`] finds. It does not read `fc.yaml`.
pub fn root(dirs: &ProjectDirs) -> Result<PathBuf, Failure> {
    if let Some(root) = &dirs.root {
        if !root.is_dir() {
            let root = root.display();
            return Err(said!("`{root}` 不是目录", "`{root}` is not a directory").into());
        }
        return Ok(root.clone());
    }
    let here = std::env::current_dir().map_err(|error| {
        said!(
            "无法得知当前目录：{error}；用 --root 指定",
            "cannot find the current directory: {error}; name one with --root"
        )
    })?;
    above(dirs, &here)
}

fn above(dirs: &ProjectDirs, here: &Path) -> Result<PathBuf, Failure> {
    here.ancestors()
        .find(|directory| is_project(directory, dirs))
        .map(PathBuf::from)
        .ok_or_else(|| {
            let protocol = protocol(dirs);
            let protocol = protocol.display();
            said!(
                "这里和上级目录中都没有 `{FILE}` 或 `{protocol}`；请进入项目目录，或用 --root 指定",
                "no `{FILE}` and no `{protocol}` here or in a directory above; go to the project, or name it with --root"
            )
            .into()
        })
}

fn is_project(directory: &Path, dirs: &ProjectDirs) -> bool {
    is_there(&directory.join(FILE)) || is_there(&directory.join(protocol(dirs)))
}

/// Returns the path of `protocol.yaml` without `fc.yaml`, relative to the project's directory.
fn protocol(dirs: &ProjectDirs) -> PathBuf {
    Project::usual_spec(dirs).join(PROTOCOL)
}

/// Returns the path from the repository to the project's root, with `/` as separator. It is empty if they are the same.
/// Code hosts need paths from the repository to show annotations. Without a repository, the path is relative to the
/// current directory.
pub fn in_repository(root: &Path) -> String {
    // Canonical paths have no links and no `..`, so that prefixes can be compared.
    let Ok(root) = root.canonicalize() else {
        return String::new();
    };
    let workspace = std::env::var_os("GITHUB_WORKSPACE").map(PathBuf::from);
    let workspace = workspace.and_then(|path| path.canonicalize().ok());
    let repository = workspace
        .filter(|path| root.starts_with(path))
        .or_else(|| {
            let mut above = root.ancestors();
            let found = above.find(|path| path.join(".git").exists());
            found.map(PathBuf::from)
        })
        .or_else(|| std::env::current_dir().ok()?.canonicalize().ok());
    let below = repository.and_then(|path| Some(slashed(root.strip_prefix(path).ok()?)));
    below.unwrap_or_default()
}

/// Returns a path with `/` as separator.
pub fn slashed(path: &Path) -> String {
    let parts: Vec<_> = path.iter().map(|part| part.to_string_lossy()).collect();
    parts.join("/")
}
