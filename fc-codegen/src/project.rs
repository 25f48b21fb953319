//! A project: its directories and its targets.

use crate::output::{OutputError, replace_spec_file};
use crate::target::{FILE, TargetError, Targets};
use fc_spec::diagnostic::Faults;
use fc_spec::model::Text;
use fc_spec::source::Sources;
use fc_spec::syntax::{is_spec_file, read_files};
use fc_spec::{text, text_error};
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

/// The file that every spec has.
const PROTOCOL: &str = "protocol.yaml";

/// The directories that a user names. Without `root`, a project is found from another directory upwards.
#[derive(Clone, Debug, Default)]
pub struct ProjectDirs {
    /// The project's directory.
    pub root: Option<PathBuf>,
    /// The directory of the spec, relative to the root. It takes precedence over the one in `fc.yaml`.
    pub spec: Option<PathBuf>,
}

/// A project: a directory with `fc.yaml`, or with a spec at its usual place.
#[derive(Clone, Debug)]
pub struct Project {
    /// The project's directory.
    pub root: PathBuf,
    /// The directory of the spec, relative to the root.
    pub spec: PathBuf,
    /// The targets that the project generates.
    pub targets: Targets,
}

/// The reason why a project cannot be found or read.
#[derive(Debug)]
pub enum ProjectError {
    /// The named root is not a directory.
    NotADirectory(PathBuf),
    /// The current directory is unknown.
    NoCurrentDirectory(io::Error),
    /// No directory upwards has a project.
    NotFound {
        /// The usual path of `protocol.yaml`, relative to a root.
        protocol: PathBuf,
    },
    /// `fc.yaml` cannot be read. The text is the reason.
    Unreadable(Text),
    /// `fc.yaml` has errors.
    Targets(TargetError),
    /// The output directory is a project.
    OutputIsProject(PathBuf),
}

impl ProjectError {
    /// Returns the message for the user, in both languages.
    #[must_use]
    pub fn text(&self) -> Text {
        match self {
            Self::NotADirectory(root) => {
                let root = root.display();
                text!("`{root}` 不是目录", "`{root}` is not a directory")
            }
            Self::NoCurrentDirectory(error) => text!(
                "无法得知当前目录：{error}；用 --root 指定",
                "cannot find the current directory: {error}; name one with --root"
            ),
            Self::NotFound { protocol } => {
                let protocol = protocol.display();
                text!(
                    "这里和上级目录中都没有 `{FILE}` 或 `{protocol}`；请进入项目目录，或用 --root 指定",
                    "no `{FILE}` and no `{protocol}` here or in a directory above; go to the project, or name it with --root"
                )
            }
            Self::Unreadable(reason) => reason.clone(),
            Self::Targets(error) => error.text(),
            Self::OutputIsProject(out) => {
                let out = out.display();
                text!(
                    "`{out}` 是一个项目；用 --out 指定别的目录",
                    "`{out}` is a project; name another directory with --out"
                )
            }
        }
    }
}

text_error!(ProjectError);

impl ProjectDirs {
    /// Returns the directory of the project that [`Project::find`] finds. It does not read `fc.yaml`.
    ///
    /// # Errors
    ///
    /// [`ProjectError`] if there is no project.
    pub fn find_root(&self) -> Result<PathBuf, ProjectError> {
        if let Some(root) = &self.root {
            return named(root);
        }
        let here = std::env::current_dir().map_err(ProjectError::NoCurrentDirectory)?;
        self.nearest(&here)
    }

    /// Returns the nearest project's directory, from a directory upwards.
    fn nearest(&self, directory: &Path) -> Result<PathBuf, ProjectError> {
        let mut above = directory.ancestors();
        let root = above.find(|directory| self.is_project(directory));
        root.map(PathBuf::from)
            .ok_or_else(|| ProjectError::NotFound {
                protocol: self.protocol(),
            })
    }

    /// Returns the directory of the spec without `fc.yaml`, relative to the root.
    #[must_use]
    pub fn usual_spec(&self) -> PathBuf {
        let spec = self.spec.clone();
        spec.unwrap_or_else(|| Targets::default().spec.into())
    }

    /// Returns the usual path of `protocol.yaml`, relative to the root.
    fn protocol(&self) -> PathBuf {
        self.usual_spec().join(PROTOCOL)
    }

    fn is_project(&self, directory: &Path) -> bool {
        is_there(&directory.join(FILE)) || is_there(&directory.join(self.protocol()))
    }
}

impl Project {
    /// Returns the named project, or the nearest one upwards from the current directory.
    ///
    /// # Errors
    ///
    /// [`ProjectError`].
    pub fn find(dirs: &ProjectDirs) -> Result<Self, ProjectError> {
        Self::at(dirs.find_root()?, dirs)
    }

    /// Returns the named project, or the nearest one upwards from a directory.
    ///
    /// # Errors
    ///
    /// [`ProjectError`].
    pub fn find_from(dirs: &ProjectDirs, directory: &Path) -> Result<Self, ProjectError> {
        let root = match &dirs.root {
            Some(root) => named(root)?,
            None => dirs.nearest(directory)?,
        };
        Self::at(root, dirs)
    }

    /// Returns the named project, or the innermost one that contains a file. `path` is relative to the current
    /// directory.
    ///
    /// # Errors
    ///
    /// [`ProjectError`] if the settings of the project cannot be read.
    pub fn around(dirs: &ProjectDirs, path: &Path) -> Result<Option<Self>, ProjectError> {
        let root = match &dirs.root {
            Some(root) => Some(root.clone()),
            None => path.ancestors().skip(1).find_map(|above| {
                let is_here = above.as_os_str().is_empty();
                let above = if is_here { Path::new(".") } else { above };
                dirs.is_project(above).then(|| above.to_owned())
            }),
        };
        root.map(|root| Self::at(root, dirs)).transpose()
    }

    fn at(root: PathBuf, dirs: &ProjectDirs) -> Result<Self, ProjectError> {
        let targets = match read_settings(&root)? {
            Some(text) => Targets::read(&text).map_err(ProjectError::Targets)?,
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

    /// Returns the path of a file of the spec, relative to the root, or `None` for other files. `path` is relative to the
    /// current directory, like the root.
    #[must_use]
    pub fn spec_file<'p>(&self, path: &'p Path) -> Option<&'p str> {
        let path = path.strip_prefix(&self.root).unwrap_or(path);
        let is_of_spec = path.strip_prefix(&self.spec).is_ok_and(is_spec_file);
        path.to_str().filter(|_| is_of_spec)
    }

    /// Refuses a project as the directory for output, because the manifest there would let its own files be removed.
    ///
    /// # Errors
    ///
    /// [`ProjectError::OutputIsProject`].
    pub fn check_apart(&self, out: &Path) -> Result<(), ProjectError> {
        let is_root = match (out.canonicalize(), self.root.canonicalize()) {
            (Ok(out), Ok(root)) => out == root,
            // A directory that does not exist yet is not a project.
            _ => false,
        };
        if is_root || is_there(&out.join(FILE)) {
            return Err(ProjectError::OutputIsProject(out.to_owned()));
        }
        Ok(())
    }

    /// Writes the files of the spec that have changed, and returns their paths.
    ///
    /// # Errors
    ///
    /// [`OutputError`] if a file cannot be written.
    pub fn write_changes(
        &self,
        before: &Sources,
        after: &Sources,
    ) -> Result<Vec<String>, OutputError> {
        let mut written = Vec::new();
        for (_, file) in after.changes_since(before) {
            replace_spec_file(&self.root, &file.path, &file.text)?;
            written.push(file.path.clone());
        }
        Ok(written)
    }
}

/// Returns a named root if it is a directory.
fn named(root: &Path) -> Result<PathBuf, ProjectError> {
    if !root.is_dir() {
        return Err(ProjectError::NotADirectory(root.to_owned()));
    }
    Ok(root.to_owned())
}

/// Reads the text of `fc.yaml`. Returns `None` if the file does not exist.
///
/// # Errors
///
/// [`ProjectError::Unreadable`].
pub fn read_settings(root: &Path) -> Result<Option<String>, ProjectError> {
    let file = root.join(FILE);
    if !is_there(&file) {
        return Ok(None);
    }
    let mut faults = Faults::new();
    let name = file.display().to_string();
    let read = read_files([(name, file.as_path())], &mut faults);
    if let Some(fault) = faults.iter().next() {
        return Err(ProjectError::Unreadable(fault.message.clone()));
    }
    Ok(read.iter().next().map(|(_, file)| file.text.clone()))
}

/// Returns `true` if a path leads to anything, including a directory or a dangling link.
#[must_use]
pub fn is_there(path: &Path) -> bool {
    match path.symlink_metadata() {
        Ok(_) => true,
        // The path may exist without being readable.
        Err(error) => !matches!(error.kind(), ErrorKind::NotFound | ErrorKind::NotADirectory),
    }
}
