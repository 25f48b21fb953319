//! Where the project is, and what it makes.

use std::path::{Path, PathBuf};

use fc_codegen::target::{FILE, Targets};

use crate::lang::said;
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
        Self::at(place, root(place)?)
    }

    /// The same from a directory other than the current one.
    pub fn find_from(place: &Place, directory: &Path) -> Result<Self, Failure> {
        let root = match &place.root {
            Some(_) => root(place)?,
            None => above(place, directory)?,
        };
        Self::at(place, root)
    }

    fn at(place: &Place, root: PathBuf) -> Result<Self, Failure> {
        let file = root.join(FILE);
        let targets = if file.is_file() {
            let text = std::fs::read_to_string(&file).map_err(|error| {
                let file = file.display();
                said!(
                    "无法读取 `{file}`：{error}",
                    "cannot read `{file}`: {error}"
                )
            })?;
            Targets::read(&text)?
        } else {
            Targets::default()
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
    let spec = place
        .spec
        .clone()
        .unwrap_or_else(|| Targets::default().spec.into());
    let protocol = spec.join(PROTOCOL);
    here.ancestors()
        .find(|directory| directory.join(FILE).is_file() || directory.join(&protocol).is_file())
        .map(PathBuf::from)
        .ok_or_else(|| {
            let protocol = protocol.display();
            said!(
                "这里和上级目录中都没有 `{FILE}` 或 `{protocol}`；请进入项目目录，或用 --root 指定",
                "no `{FILE}` and no `{protocol}` here or in a directory above; go to the project, or name it with --root"
            )
            .into()
        })
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
