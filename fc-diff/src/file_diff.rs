//! Describes the change of one file of a spec. Diff drivers of git get only this file.

use crate::diff_for;
use crate::finding::Finding;
use crate::git::git;
use crate::project::ProjectSpec;
use crate::render::{Format, render, stands_in};
use crate::version::Version;
use crate::waive::{Against, waive};
use fc_spec::diagnostic::Faults;
use fc_spec::model::Lang;
use fc_spec::source::Sources;
use fc_spec::syntax::read_dir;

/// The option for the number of commits that are searched for a version of the file.
const COMMITS: &str = "--max-count=200";

/// A version of a file of the spec.
#[derive(Clone, Debug)]
pub struct FileVersion<'t> {
    /// The path, relative to the project's root, with `/` as separator.
    pub path: String,
    /// The text, or `None` if the file is missing.
    pub text: Option<&'t str>,
    /// The id of the object in git. It is all zeros if git does not have the object.
    pub object: &'t str,
}

/// The effects of a changed file.
#[derive(Debug)]
pub struct FileDiff {
    /// The findings. There are none if the meaning is the same.
    pub findings: Vec<Finding>,
    /// The old and the new version of the spec.
    pub versions: [Version; 2],
}

impl FileDiff {
    /// Returns a description for a terminal. It is empty if there are no findings.
    #[must_use]
    pub fn text(&self, lang: Lang) -> String {
        if self.findings.is_empty() {
            return String::new();
        }
        let [old, new] = &self.versions;
        render(&self.findings, [old, new], Format::Text, lang)
    }
}

/// Compares two versions of a file, and applies the waivers of the new one as of `today`, `YYYY-MM-DD`.
///
/// The other files of the spec come from the working tree or from git. Returns `None` if no source has files that fit
/// both versions.
#[must_use]
pub fn file_diff(
    project: ProjectSpec<'_>,
    [old, new]: [&FileVersion<'_>; 2],
    today: &str,
) -> Option<FileDiff> {
    let mut others = OtherFiles {
        project,
        paths: [&old.path, &new.path],
        read: Vec::new(),
    };
    let pairs = source_pairs(project, new);
    let (is_same, versions) = pairs.into_iter().find_map(|[before, after]| {
        let old = others.around(old, 'a', &before)?;
        let new = others.around(new, 'b', &after)?;
        Some((before == after, [old, new]))
    })?;
    let [before, after] = &versions;
    let mut findings = diff_for(&before.model, &after.model, project.packages);
    if !is_same {
        // Other files can differ as well, and git reports them separately.
        findings.retain(|finding| {
            let is_in = |file: &FileVersion<'_>| stands_in(finding, &file.path, [before, after]);
            is_in(old) || is_in(new)
        });
    }
    let waivers = &after.model.waivers;
    waive(&mut findings, waivers, today, Against::Other);
    Some(FileDiff { findings, versions })
}

/// A source of the other files of the spec.
#[derive(Clone, Debug, PartialEq, Eq)]
enum Source {
    WorkingTree,
    /// A revision in git.
    Revision(String),
}

/// Returns the sources of the other files, each for the old and the new version. Most pairs give both versions the same
/// files. The others use the files before and after the change.
fn source_pairs(project: ProjectSpec<'_>, new: &FileVersion<'_>) -> Vec<[Source; 2]> {
    let both = |source: Source| [source.clone(), source];
    let head = Source::Revision("HEAD".to_owned());
    let mut pairs = vec![both(Source::WorkingTree), both(head.clone())];
    if !is_in_git(new) {
        pairs.push([head, Source::WorkingTree]);
    } else if let Some(commit) = last_commit(project, new) {
        let before = Source::Revision(format!("{commit}^"));
        let commit = Source::Revision(commit);
        pairs.push(both(commit.clone()));
        pairs.push(both(before.clone()));
        pairs.push([before, commit]);
    }
    pairs
}

fn is_in_git(file: &FileVersion<'_>) -> bool {
    file.object
        .chars()
        .any(|digit| digit != '0' && digit != '.')
}

/// Returns the last commit that gave the file its content.
fn last_commit(project: ProjectSpec<'_>, file: &FileVersion<'_>) -> Option<String> {
    let log = [
        "log",
        "--all",
        COMMITS,
        "--format=%H",
        "--raw",
        "--no-abbrev",
        "--no-renames",
        "--",
        &file.path,
    ];
    let log = git(project.root, &log).ok()?;
    let mut commit = None;
    for line in String::from_utf8_lossy(&log).lines() {
        match line.strip_prefix(':') {
            // Modes first, then the object of the old and of the new file.
            Some(facts) if facts.split(' ').nth(3) == Some(file.object) => return commit,
            None if !line.is_empty() => commit = Some(line.to_owned()),
            _ => {}
        }
    }
    None
}

/// The other files of the spec from several sources. Each source is read once.
struct OtherFiles<'p> {
    project: ProjectSpec<'p>,
    /// The paths of both versions of the file. The other files have different paths.
    paths: [&'p str; 2],
    read: Vec<(Source, Option<Sources>)>,
}

impl OtherFiles<'_> {
    /// Loads the version of the spec with this file and the others of a source. Returns `None` if it has errors.
    fn around(&mut self, file: &FileVersion<'_>, side: char, source: &Source) -> Option<Version> {
        let paths = self.paths;
        let files = self.get(source)?.iter();
        let files = files.map(|(_, file)| (file.path.as_str(), file.text.as_str()));
        let others = files.filter(|(path, _)| !paths.contains(path));
        let own = file.text.map(|text| (file.path.as_str(), text));
        let sources = Sources::from_texts(others.chain(own));
        Version::of(&format!("{side}/{}", file.path), sources, Faults::new()).ok()
    }

    fn get(&mut self, source: &Source) -> Option<&Sources> {
        if !self.read.iter().any(|(known, _)| known == source) {
            self.read.push((source.clone(), self.read(source)));
        }
        let (_, sources) = self.read.iter().find(|(known, _)| known == source)?;
        sources.as_ref()
    }

    fn read(&self, source: &Source) -> Option<Sources> {
        let ProjectSpec { root, spec, .. } = self.project;
        match source {
            Source::WorkingTree => {
                let mut faults = Faults::new();
                let sources = read_dir(root, spec, &mut faults);
                (!faults.has_errors()).then_some(sources)
            }
            Source::Revision(revision) => Version::sources_of(revision, root, spec).ok(),
        }
    }
}
