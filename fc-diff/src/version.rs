//! Loads a version of a spec from a directory, a dump, a release or git.

use crate::git::git;
use crate::release::{NoRelease, Number, Releases};
use fc_spec::diagnostic::Faults;
use fc_spec::index::{Definitions, definitions};
use fc_spec::load::Trees;
use fc_spec::model::{Dump, DumpError, Languages, Model, ProjectionError, Text};
use fc_spec::source::Sources;
use fc_spec::syntax::{is_spec_file, read_dir};
use fc_spec::{text, text_error};
use std::io::Read as _;
use std::path::Path;

/// The prefix of a version in git: `git:main`.
const GIT: &str = "git:";
/// The maximum total size of the files of a version, in bytes.
const MOST: u64 = 256 << 20;

/// A version of a spec.
#[derive(Debug)]
pub struct Version {
    /// The name that the caller gave.
    pub name: String,
    /// The model.
    pub model: Model,
    /// The files; none for a dump.
    pub sources: Sources,
    /// The place of each definition in the files.
    pub places: Definitions,
}

/// The reason why a version cannot be loaded.
#[derive(Debug)]
pub enum VersionError {
    /// The spec has errors.
    Faulty {
        /// The name that the caller gave.
        name: String,
        /// The files of the spec.
        sources: Sources,
        /// The errors, in a box because they are large and rare.
        faults: Box<Faults>,
    },
    /// The dump has a format that this program cannot read.
    Dump(String, DumpError),
    /// The file or directory cannot be read.
    Unreadable(String, std::io::Error),
    /// git is missing or fails. The second value is its message.
    Git(String, String),
    /// The path is neither a file nor a directory with a spec.
    NoSpec(String),
    /// There is no release with this number.
    NoRelease(NoRelease),
    /// The files are too large.
    TooLarge(String),
    /// The dump of a release is a directory, a pipe or a device.
    NotAFile(String),
    /// A file is not UTF-8.
    NotUtf8(String),
}

impl VersionError {
    /// The sentence for the user.
    #[must_use]
    pub fn text(&self) -> Text {
        match self {
            Self::Faulty { name, .. } => {
                text!("`{name}` 的规范有错误", "the spec of `{name}` has errors")
            }
            Self::Dump(name, error) => {
                text!(
                    "`{name}`：{error}",
                    "`{name}`: {error}",
                    error = error.text()
                )
            }
            Self::Unreadable(name, error) => {
                text!(
                    "无法读取 `{name}`：{error}",
                    "cannot read `{name}`: {error}"
                )
            }
            Self::Git(name, why) => text!(
                "git 无法读取 `{name}`：{why}",
                "git cannot read `{name}`: {why}"
            ),
            Self::NoSpec(name) => text!(
                "`{name}` 应为规范的目录、`fcproto inspect` 的输出、发布版本或 git:REF",
                "`{name}` is not a directory with a spec, an output of `fcproto inspect`, a release or git:REF"
            ),
            Self::NoRelease(error) => error.text(),
            Self::NotAFile(path) => {
                text!("`{path}` 不是普通文件", "`{path}` is not a regular file")
            }
            Self::NotUtf8(name) => text!("`{name}` 不是 UTF-8", "`{name}` is not UTF-8"),
            Self::TooLarge(name) => {
                let most = MOST >> 20;
                text!(
                    "`{name}` 超过 {most} MiB",
                    "`{name}` is larger than {most} MiB"
                )
            }
        }
    }
}

text_error!(VersionError);

impl Version {
    /// Loads a version by name. The name is one of these:
    ///
    /// - the directory of a project or of a spec; `spec` leads from a project to its spec
    /// - a file from `fcproto inspect`
    /// - the number of a release in `project`; it takes precedence over a file with that name
    /// - `git:REF` for a revision in git
    ///
    /// # Errors
    ///
    /// [`VersionError`].
    pub fn read(name: &str, project: &Path, spec: &Path) -> Result<Self, VersionError> {
        if name.starts_with(GIT) {
            return Self::of(name, Self::sources_of(name, project, spec)?, Faults::new());
        }
        let unreadable = |error| VersionError::Unreadable(name.to_owned(), error);
        let releases = Releases::beside(&project.join(spec)).map_err(unreadable)?;
        // `./2026.12` names a directory that is called like a release.
        let release = releases.named(name);
        let path = release.unwrap_or(Path::new(name));
        if release.is_none() && name.parse::<Number>().is_ok() && !path.exists() {
            return Err(VersionError::NoRelease(releases.without(name)));
        }
        // Opening a pipe would wait for its writer.
        if release.is_some() && path.metadata().is_ok_and(|found| !found.is_file()) {
            return Err(VersionError::NotAFile(path.display().to_string()));
        }
        if !path.is_dir() {
            let mut file = std::fs::File::open(path)
                .map_err(unreadable)?
                .take(MOST + 1);
            let mut bytes = Vec::new();
            let read = file.read_to_end(&mut bytes).map_err(unreadable)?;
            if u64::try_from(read).is_ok_and(|read| read > MOST) {
                return Err(VersionError::TooLarge(name.to_owned()));
            }
            let text =
                String::from_utf8(bytes).map_err(|_| VersionError::NotUtf8(name.to_owned()))?;
            let model =
                Dump::read(&text).map_err(|error| VersionError::Dump(name.to_owned(), error))?;
            return Ok(Self {
                name: name.to_owned(),
                model,
                sources: Sources::new(),
                places: Definitions::default(),
            });
        }
        // Looks for the spec of a project first, then for a spec in the directory itself.
        let inside = [spec, Path::new("")];
        let has_spec = |inside: &&Path| path.join(inside).join("protocol.yaml").is_file();
        let Some(inside) = inside.into_iter().find(has_spec) else {
            return Err(VersionError::NoSpec(name.to_owned()));
        };
        let mut faults = Faults::new();
        let sources = read_dir(path, inside, &mut faults);
        Self::of(name, sources, faults)
    }

    /// Returns the files of a spec at `git:REF`, with paths relative to `project`. They need not parse.
    ///
    /// # Errors
    ///
    /// [`VersionError::Git`], [`VersionError::TooLarge`].
    pub(crate) fn sources_of(
        name: &str,
        project: &Path,
        spec: &Path,
    ) -> Result<Sources, VersionError> {
        let reference = name.strip_prefix(GIT).unwrap_or(name);
        revision(name, reference, project, spec)
    }

    /// Loads a version from files. `faults` has the errors that were found before.
    ///
    /// # Errors
    ///
    /// [`VersionError::Faulty`].
    pub fn of(name: &str, sources: Sources, mut faults: Faults) -> Result<Self, VersionError> {
        let name = name.to_owned();
        // The project settings of another version are unknown.
        let trees = Trees::new(&sources);
        match trees.load(Languages::Any, &mut faults).model() {
            Some(model) => Ok(Self {
                name,
                model,
                places: definitions(&sources),
                sources,
            }),
            None => Err(VersionError::Faulty {
                name,
                sources,
                faults: Box::new(faults),
            }),
        }
    }
}

/// Returns both versions without the parts for other audiences. A version that does not know the audience stays whole.
///
/// # Errors
///
/// [`ProjectionError`] if neither version knows the audience.
pub fn for_audience(
    [old, new]: [Version; 2],
    audience: &str,
) -> Result<[Version; 2], ProjectionError> {
    let [of_old, of_new] = [&old, &new].map(|version| version.model.for_audience(audience));
    if let (Err(_), Err(unknown)) = (&of_old, &of_new) {
        return Err(unknown.clone());
    }
    let part = |whole: Version, part: Result<Model, _>| match part {
        Ok(model) => Version { model, ..whole },
        Err(_) => whole,
    };
    Ok([part(old, of_old), part(new, of_new)])
}

/// Reads the files of a spec at a git revision.
fn revision(
    name: &str,
    reference: &str,
    project: &Path,
    spec: &Path,
) -> Result<Sources, VersionError> {
    let fails = |why: String| VersionError::Git(name.to_owned(), why);
    let say = |arguments: &[&str]| git(project, arguments).map_err(fails);
    if reference.is_empty() || reference.starts_with('-') {
        return Err(fails(
            "expected a branch, tag or commit, such as git:main".to_owned(),
        ));
    }
    // The path is relative to the project's directory, which need not be the root of the repository.
    let tree = format!("{reference}:./{}", spec.to_string_lossy());
    let id = say(&["rev-parse", "--verify", "--end-of-options", &tree])?;
    let id = String::from_utf8_lossy(&id).trim().to_owned();
    let list = say(&["ls-tree", "-r", "-l", "-z", "--full-tree", &id])?;
    let mut files = Vec::new();
    let mut left = MOST;
    for line in String::from_utf8_lossy(&list).split('\0') {
        let Some((facts, path)) = line.split_once('\t') else {
            continue;
        };
        let mut facts = facts.split_whitespace();
        let (object, size) = (
            facts.nth(2).unwrap_or_default(),
            facts.next().unwrap_or_default(),
        );
        // Only files that a spec in a directory would consist of.
        if !is_spec_file(Path::new(path)) {
            continue;
        }
        left = match left.checked_sub(size.parse().unwrap_or(u64::MAX)) {
            Some(left) => left,
            None => return Err(VersionError::TooLarge(name.to_owned())),
        };
        let text = say(&["cat-file", "blob", object])?;
        let text = String::from_utf8(text).map_err(|_| fails(format!("{path} is not UTF-8")))?;
        let text = text.strip_prefix('\u{feff}').unwrap_or(&text).to_owned();
        files.push((format!("{}/{path}", spec.to_string_lossy()), text));
    }
    Ok(Sources::from_texts(files))
}
