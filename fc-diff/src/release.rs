//! Releases: frozen dumps in the spec's directory, and the rules for the number of the next one.

use crate::finding::Finding;
use crate::rule::About;
use fc_spec::model::Text;
use fc_spec::{text, text_error};
use std::cmp::Ordering;
use std::fmt;
use std::path::{Path, PathBuf};
use std::str::FromStr;

/// The directory of the releases, inside that of the spec.
pub const DIRECTORY: &str = "releases";
/// The extension of a frozen dump.
const EXTENSION: &str = "json";
/// If the first part is at least this, it is a year.
const FIRST_YEAR: u64 = 1900;
/// The maximum number of parts of a number.
const MOST_PARTS: usize = 4;

/// The number of a release. `2026.12` is a calendar number, `2.1.0` reflects the changes.
#[derive(Clone, Debug)]
pub struct Number {
    parts: Vec<u64>,
    text: String,
}

/// Missing parts are zero: `2.1` equals `2.1.0`.
impl Ord for Number {
    fn cmp(&self, other: &Self) -> Ordering {
        let parts = (0..MOST_PARTS).map(|at| self.part(at).cmp(&other.part(at)));
        parts.fold(Ordering::Equal, Ordering::then)
    }
}

impl PartialOrd for Number {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Number {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Number {}

/// Writes the number as in the file name.
impl fmt::Display for Number {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

/// The error for a string that is not a release number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NoNumber;

impl fmt::Display for NoNumber {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "a release has a number of up to {MOST_PARTS} parts, such as 2026.12 or 2.1.0"
        )
    }
}

impl std::error::Error for NoNumber {}

impl FromStr for Number {
    type Err = NoNumber;

    fn from_str(text: &str) -> Result<Self, NoNumber> {
        let parts: Vec<_> = text.split('.').collect();
        if parts.len() > MOST_PARTS {
            return Err(NoNumber);
        }
        let number = |part: &&str| {
            let is_number = !part.is_empty() && part.bytes().all(|byte| byte.is_ascii_digit());
            part.parse().ok().filter(|_| is_number).ok_or(NoNumber)
        };
        Ok(Self {
            parts: parts.iter().map(number).collect::<Result<_, _>>()?,
            text: text.to_owned(),
        })
    }
}

impl Number {
    fn part(&self, at: usize) -> u64 {
        self.parts.get(at).copied().unwrap_or(0)
    }

    /// Returns `true` for a calendar number, which does not reflect the changes.
    #[must_use]
    pub fn is_calendar(&self) -> bool {
        self.part(0) >= FIRST_YEAR
    }
}

/// The releases of a spec, in the order of their numbers.
#[derive(Clone, Debug, Default)]
pub struct Releases(Vec<(Number, PathBuf)>);

impl Releases {
    /// Reads the releases of the spec in this directory. Returns none without a directory of releases.
    ///
    /// # Errors
    ///
    /// If the directory cannot be read.
    pub fn beside(spec: &Path) -> std::io::Result<Self> {
        let mut found = Vec::new();
        let directory = match std::fs::read_dir(spec.join(DIRECTORY)) {
            Ok(directory) => directory,
            // A dangling link is an error.
            Err(error)
                if error.kind() == std::io::ErrorKind::NotFound
                    && !spec.join(DIRECTORY).is_symlink() =>
            {
                return Ok(Self::default());
            }
            Err(error) => return Err(error),
        };
        for entry in directory {
            let path = entry?.path();
            let is_dump = path.extension().is_some_and(|it| it == EXTENSION);
            let name = path.file_stem().and_then(|name| name.to_str());
            if let Some(number) = name.filter(|_| is_dump).and_then(|it| it.parse().ok()) {
                found.push((number, path));
            }
        }
        found.sort();
        Ok(Self(found))
    }

    /// Returns the last release and the file with its dump.
    #[must_use]
    pub fn last(&self) -> Option<(&Number, &Path)> {
        let (number, path) = self.0.last()?;
        Some((number, path))
    }

    /// Returns the dump of the release with exactly this name.
    #[must_use]
    pub fn named(&self, name: &str) -> Option<&Path> {
        let mut all = self.0.iter();
        let found = all.find(|(number, _)| number.text == name);
        found.map(|(_, path)| path.as_path())
    }

    /// Returns the error for a release that does not exist.
    #[must_use]
    pub fn without(&self, name: &str) -> NoRelease {
        NoRelease {
            name: name.to_owned(),
            known: self.numbers().map(ToString::to_string).collect(),
        }
    }

    /// Returns the numbers, from the first to the last.
    #[must_use]
    pub fn numbers(&self) -> impl DoubleEndedIterator<Item = &Number> {
        self.0.iter().map(|(number, _)| number)
    }

    /// Returns the numbers of the releases before two versions, the last one first. A version that is not a release
    /// comes after all releases.
    pub(crate) fn before(&self, versions: [&str; 2]) -> impl Iterator<Item = &Number> {
        let bounds = versions.map(|name| self.numbers().find(|number| number.text == name));
        let is_before = move |it: &&Number| bounds.into_iter().flatten().all(|bound| *it < bound);
        self.numbers().rev().filter(is_before)
    }
}

/// The error for a release that does not exist.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NoRelease {
    /// The name that was looked up.
    pub name: String,
    /// The numbers of the existing releases, from the first to the last.
    pub known: Vec<String>,
}

impl NoRelease {
    /// Returns a sentence for the user.
    #[must_use]
    pub fn text(&self) -> Text {
        let known = match self.known.as_slice() {
            [] => text!("还没有发布版本", "there is no release yet"),
            known => text!(
                "已有：{known}",
                "there are {known}",
                known = Text::listed(known)
            ),
        };
        text!(
            "没有发布版本 `{name}`；{known}",
            "there is no release `{name}`; {known}",
            name = self.name,
            known = known
        )
    }
}

text_error!(NoRelease);

/// Returns the file of a release, relative to the spec's directory: `releases/2026.12.json`.
#[must_use]
pub fn file(number: &Number) -> String {
    format!("{DIRECTORY}/{number}.{EXTENSION}")
}

/// A reason against a release number.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Objection {
    /// The number does not come after that of the last release.
    NotLater {
        /// The number of the last release.
        last: String,
    },
    /// The spec already has a later version.
    GoesBack {
        /// The version of the spec.
        version: String,
    },
    /// The spec equals the last release.
    Unchanged,
    /// The number must rise further for these changes.
    TooSmall {
        /// The index of the part that must rise, from 0.
        part: usize,
        /// The number of changes that require it.
        changes: usize,
    },
    /// Messages break under a calendar number, and no waiver accepts it.
    NotWaived {
        /// The ids for waivers of these breaks.
        ids: Vec<String>,
    },
    /// A finding that no release may have, such as a reused code or an expired waiver.
    Fault {
        /// The message of the finding.
        message: Text,
    },
}

impl Objection {
    /// Returns a sentence for the user, in both languages.
    #[must_use]
    pub fn message(&self) -> Text {
        match self {
            Self::NotLater { last } => text!(
                "上一次发布是 {last}，请取更大的版本号",
                "the last release is {last}; choose a later number"
            ),
            Self::GoesBack { version } => text!(
                "规范的版本已是 {version}，请取这个版本号或更大的",
                "the version of the spec is {version}; choose that or a later number"
            ),
            Self::Unchanged => text!(
                "上一次发布以来没有变更",
                "there are no changes since the last release"
            ),
            Self::TooSmall { part, changes } => {
                let number = part + 1;
                let place = ["first", "second", "third", "fourth"];
                let place = place.get(*part).unwrap_or(&"next");
                text!(
                    "有 {changes} 处变更要求更大的步长：版本号的第 {number} 段要增加",
                    "{changes} of the changes ask for a larger step: the {place} part of the number has to rise"
                )
            }
            Self::NotWaived { ids } => {
                let ids = ids.join(", ");
                text!(
                    "新旧 app 与机器人之间会出现误解：请撤销这些变更，或逐一豁免：{ids}",
                    "old and new apps and robots would misunderstand each other: undo these changes, or waive each of them: {ids}"
                )
            }
            Self::Fault { message } => message.clone(),
        }
    }
}

/// The size of a change, the largest first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Step {
    /// Messages break.
    Break,
    /// Programs see a change.
    Change,
    /// Only texts and examples change.
    Text,
}

impl Step {
    fn of(finding: &Finding) -> Self {
        if finding.is_break() {
            Self::Break
        } else if finding.rule.about != About::Text {
            Self::Change
        } else {
            Self::Text
        }
    }
}

/// Returns all reasons against releasing these changes under a number.
///
/// A calendar number only has to be later, but each break needs a waiver. In other numbers, a break raises the first
/// part, a visible change the second, and a change of texts any. Before 1.0, a break raises the second part.
#[must_use]
pub fn objections(last: &Number, next: &Number, findings: &[Finding]) -> Vec<Objection> {
    let mut objections = Vec::new();
    if next <= last {
        objections.push(Objection::NotLater {
            last: last.to_string(),
        });
    }
    let (faults, changes): (Vec<_>, Vec<_>) = findings.iter().partition(|it| it.is_fault());
    let never = changes
        .iter()
        .filter(|it| it.rule.is_error && it.waived.is_none());
    objections.extend(faults.iter().chain(never).map(|finding| Objection::Fault {
        message: finding.message.clone(),
    }));
    // The version number itself always differs.
    let is_change = |it: &&&Finding| it.subject != VERSION;
    let Some(step) = changes
        .iter()
        .filter(is_change)
        .map(|it| Step::of(it))
        .min()
    else {
        objections.push(Objection::Unchanged);
        return objections;
    };
    let of_step = || changes.iter().filter(|it| Step::of(it) == step);
    if next.is_calendar() {
        if step == Step::Break {
            objections.push(Objection::NotWaived {
                ids: of_step().map(|it| it.waiver_id()).collect(),
            });
        }
        return objections;
    }
    let is_early = last.part(0) == 0 && next.part(0) == 0;
    let part = match step {
        Step::Break if is_early => 1,
        Step::Break => 0,
        Step::Change => 1,
        Step::Text => return objections,
    };
    let rises = (0..=part).any(|at| next.part(at) > last.part(at));
    if next > last && !rises {
        objections.push(Objection::TooSmall {
            part,
            changes: of_step().count(),
        });
    }
    objections
}

/// Returns an objection if a number is below the version of the spec. A version that is not a number is ignored.
#[must_use]
pub fn goes_back(next: &Number, version: &str) -> Option<Objection> {
    let written: Number = version.parse().ok()?;
    (*next < written).then(|| Objection::GoesBack {
        version: version.to_owned(),
    })
}

/// The subject of findings about the version number.
pub(crate) const VERSION: &str = "protocol.version";
