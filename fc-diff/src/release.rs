//! Releases: versions of a spec that are frozen as dumps beside it, and what the next one has to be called.

use crate::finding::Finding;
use crate::rule::About;
use fc_spec::model::Text;
use fc_spec::text;
use std::cmp::Ordering;
use std::fmt;
use std::path::{Path, PathBuf};
use std::str::FromStr;

/// Directory of the releases, below that of the spec.
pub const DIRECTORY: &str = "releases";
/// What the name of a frozen dump ends with.
const EXTENSION: &str = "json";
/// A first part from here on is a year.
const FIRST_YEAR: u64 = 1900;
/// Parts that a number may have.
const MOST_PARTS: usize = 4;

/// Number of a release: `2026.12` by the calendar, `2.1.0` by what has changed.
#[derive(Clone, Debug)]
pub struct Number {
    parts: Vec<u64>,
    text: String,
}

/// Parts that are not written are zero: `2.1` is `2.1.0`.
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

/// As it is written.
impl fmt::Display for Number {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

/// A text is no number of a release.
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

    /// Whether it is by the calendar, and so says nothing of what has changed.
    #[must_use]
    pub fn is_calendar(&self) -> bool {
        self.part(0) >= FIRST_YEAR
    }
}

/// The frozen versions of a spec, in the order of their numbers.
#[derive(Clone, Debug, Default)]
pub struct Releases(Vec<(Number, PathBuf)>);

impl Releases {
    /// Those beside the spec in this directory; none where there is no directory of releases.
    ///
    /// # Errors
    ///
    /// If that cannot be read.
    pub fn beside(spec: &Path) -> std::io::Result<Self> {
        let mut found = Vec::new();
        let directory = match std::fs::read_dir(spec.join(DIRECTORY)) {
            Ok(directory) => directory,
            // A link to nothing is an error.
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

    /// The last one, and the file with its dump.
    #[must_use]
    pub fn last(&self) -> Option<(&Number, &Path)> {
        let (number, path) = self.0.last()?;
        Some((number, path))
    }

    /// The file with the dump of the release that is written like this.
    #[must_use]
    pub fn named(&self, name: &str) -> Option<&Path> {
        let mut all = self.0.iter();
        let found = all.find(|(number, _)| number.text == name);
        found.map(|(_, path)| path.as_path())
    }

    /// That there is none which is written like this.
    #[must_use]
    pub fn without(&self, name: &str) -> NoRelease {
        NoRelease {
            name: name.to_owned(),
            known: self.numbers().map(ToString::to_string).collect(),
        }
    }

    /// The numbers, from the first to the last.
    pub fn numbers(&self) -> impl Iterator<Item = &Number> {
        self.0.iter().map(|(number, _)| number)
    }
}

/// There is no such release.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NoRelease {
    /// What was asked for.
    pub name: String,
    /// The numbers of those that there are, from the first to the last.
    pub known: Vec<String>,
}

impl NoRelease {
    /// The sentence for the user.
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

impl fmt::Display for NoRelease {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text().en)
    }
}

impl std::error::Error for NoRelease {}

/// The file of a release, from the spec's directory: `releases/2026.12.json`.
#[must_use]
pub fn file(number: &Number) -> String {
    format!("{DIRECTORY}/{number}.{EXTENSION}")
}

/// Why a version cannot be released under a number.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Objection {
    /// The number does not come after that of the last release.
    NotLater {
        /// That of the last release.
        last: String,
    },
    /// The spec calls itself by a later one already.
    GoesBack {
        /// Its version.
        version: String,
    },
    /// Nothing differs from the last release.
    Unchanged,
    /// Messages break, and the number says less than that.
    TooSmall {
        /// What must rise: the place of the part, from 0.
        part: usize,
        /// Number of changes that demand it.
        changes: usize,
    },
    /// Messages break, the number is by the calendar and so does not say it, and nobody has accepted it.
    NotWaived {
        /// Ids that waivers of these would have.
        ids: Vec<String>,
    },
    /// Something that no release may have: a code that is used again, a waiver that has expired.
    Fault {
        /// What was found.
        message: Text,
    },
}

impl Objection {
    /// What it is, in both languages.
    #[must_use]
    pub fn message(&self) -> Text {
        let [zh, en] = match self {
            Self::NotLater { last } => [
                format!("上一次发布是 {last}，请取更大的版本号"),
                format!("the last release is {last}; choose a later number"),
            ],
            Self::GoesBack { version } => [
                format!("规范的版本已是 {version}，请取这个版本号或更大的"),
                format!("the version of the spec is {version}; choose that or a later number"),
            ],
            Self::Unchanged => [
                "上一次发布以来没有变更".to_owned(),
                "there are no changes since the last release".to_owned(),
            ],
            Self::TooSmall { part, changes } => {
                let number = part + 1;
                let place = ["first", "second", "third", "fourth"];
                let place = place.get(*part).unwrap_or(&"next");
                [
                    format!("有 {changes} 处变更要求更大的步长：版本号的第 {number} 段要增加"),
                    format!(
                        "{changes} of the changes ask for a larger step: the {place} part of the number has to rise"
                    ),
                ]
            }
            Self::NotWaived { ids } => {
                let ids = ids.join(", ");
                [
                    format!("新旧 app 与机器人之间会出现误解：请撤销这些变更，或逐一豁免：{ids}"),
                    format!(
                        "old and new apps and robots would misunderstand each other: undo these changes, or waive each of them: {ids}"
                    ),
                ]
            }
            Self::Fault { message } => return message.clone(),
        };
        Text { zh, en }
    }
}

/// What a change asks of a number, the most first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Step {
    /// Messages break.
    Break,
    /// Programs have something new to know.
    Change,
    /// Texts and examples.
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

/// Everything that speaks against releasing what was found under a number.
///
/// By the calendar any later number does, but each break has to be accepted by a waiver. Other numbers say what has changed:
/// where messages break the first part rises, where programs have something new to know the second one, and for texts any.
/// Before 1.0 a break asks for the second part.
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
    // The number itself is a difference.
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

/// That a number comes before the version by which the spec calls itself, where that is a number.
#[must_use]
pub fn goes_back(next: &Number, version: &str) -> Option<Objection> {
    let written: Number = version.parse().ok()?;
    (*next < written).then(|| Objection::GoesBack {
        version: version.to_owned(),
    })
}

/// What findings call the number itself.
pub(crate) const VERSION: &str = "protocol.version";
