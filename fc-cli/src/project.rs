//! Where the project is, and what it makes.

use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use fc_codegen::target::{FILE, Targets};
use fc_spec::diagnostic::Faults;
use fc_spec::syntax::read_files;

use crate::lang::{in_lang, said};
use crate::outcome::Failure;
use crate::place::Place;

/// The file that every spec has.
const PROTOCOL: &str = "protocol.yaml";

/// A project: a directory with `fc.yaml`, or with a spec at its usual place.
pub struct Project {
    /// Its directory.
    pub root: PathBuf,
    /// Directory of its spec, from the root.
    pub spec: PathBuf,
    /// What is made of the spec.
    pub targets: Targets,
}

impl Project {
    /// The project that is named, or else that of the nearest directory upwards that is one.
    pub fn find(place: &Place) -> Result<Self, Failure> {
        Self::at(root(place)?, place)
    }

    /// The directory of that project, whatever its `fc.yaml` says.
    pub fn root(place: &Place) -> Result<PathBuf, Failure> {
        root(place)
    }

    /// Directory of the spec, from the root, where no `fc.yaml` says so.
    pub fn usual_spec(place: &Place) -> PathBuf {
        let spec = place.spec.clone();
        spec.unwrap_or_else(|| Targets::default().spec.into())
    }

    /// The project that is named, or else the innermost one that a file lies in; `path` leads there from the current
    /// directory.
    pub fn around(place: &Place, path: &Path) -> Result<Option<Self>, Failure> {
        let root = match &place.root {
            Some(root) => Some(root.clone()),
            None => path.ancestors().skip(1).find_map(|above| {
                let is_here = above.as_os_str().is_empty();
                let above = if is_here { Path::new(".") } else { above };
                is_project(above, place).then(|| above.to_owned())
            }),
        };
        root.map(|root| Self::at(root, place)).transpose()
    }

    /// The same from a directory other than the current one.
    pub fn find_from(place: &Place, directory: &Path) -> Result<Self, Failure> {
        let root = match &place.root {
            Some(_) => root(place)?,
            None => above(place, directory)?,
        };
        Self::at(root, place)
    }

    fn at(root: PathBuf, place: &Place) -> Result<Self, Failure> {
        let targets = match settings(&root)? {
            Some(text) => Targets::read(&text)?,
            None => Targets::default(),
        };
        let spec = place
            .spec
            .clone()
            .unwrap_or_else(|| PathBuf::from(&targets.spec));
        Ok(Self {
            root,
            spec,
            targets,
        })
    }
}

/// Reads the text of `fc.yaml`; `None` if there is none.
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
        // The system does not show it, so it may be there.
        Err(error) => !matches!(error.kind(), ErrorKind::NotFound | ErrorKind::NotADirectory),
    }
}

fn root(place: &Place) -> Result<PathBuf, Failure> {
    if let Some(root) = &place.root {
        if !root.is_dir() {
            let root = root.display();
            return Err(said!("`{root}` 不是目录", "`{root}` is not a directory").into());
        }
        return Ok(root.clone());
    }
    let here = std::env::current_dir().map_err(|error| {
        said!(
            "无法得知当前目录：{error}；用 --root 指定",
            "cannot tell the current directory: {error}; name one with --root"
        )
    })?;
    above(place, &here)
}

fn above(place: &Place, here: &Path) -> Result<PathBuf, Failure> {
    here.ancestors()
        .find(|directory| is_project(directory, place))
        .map(PathBuf::from)
        .ok_or_else(|| {
            let protocol = protocol(place);
            let protocol = protocol.display();
            said!(
                "这里和上级目录中都没有 `{FILE}` 或 `{protocol}`；请进入项目目录，或用 --root 指定",
                "no `{FILE}` and no `{protocol}` here or in a directory above; go to the project, or name it with --root"
            )
            .into()
        })
}

fn is_project(directory: &Path, place: &Place) -> bool {
    is_there(&directory.join(FILE)) || is_there(&directory.join(protocol(place)))
}

/// What leads from a project's directory to its `protocol.yaml`, where no `fc.yaml` says so.
fn protocol(place: &Place) -> PathBuf {
    Project::usual_spec(place).join(PROTOCOL)
}

/// What leads to the project's root from the repository that holds it, with `/` between its parts: code hosts show
/// faults beside the lines only where paths count from there. Empty where both are one. If there is no
/// repository, paths count from the current directory.
pub fn in_repository(root: &Path) -> String {
    // Without links and `..`, so that one can be seen to lie in the other.
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
    let below = repository.and_then(|path| Some(root.strip_prefix(path).ok()?.to_owned()));
    let parts = below.iter().flat_map(|path| path.iter());
    let parts: Vec<_> = parts.map(|part| part.to_string_lossy()).collect();
    parts.join("/")
}
