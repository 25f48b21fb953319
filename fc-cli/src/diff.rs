//! `fcproto diff`.

use clap::ValueEnum;
use fc_diff::{Finding, render};

use crate::lang::lang;
use crate::outcome::{Failure, Status};
use crate::place::Place;
use crate::print;
use crate::project::in_repository;
use crate::versions::{Shelf, day, today};

/// Show what changed between two versions of the spec, and for whom it breaks.
///
/// A version is the directory of a project or of a spec, a file that `fcproto inspect` has printed, the number of a release, or
/// git:REF for what git has of this project's spec. Each change is judged by a rule: whether old apps and new robots, or new apps and old robots,
/// misunderstand each other, in which languages sources stop compiling, and whether programs behave differently. What no
/// rule judges is listed as well, so that no changes means that the two say the same. `fcproto explain FC0731` explains a rule.
///
/// A change that breaks something on purpose is accepted by an entry under `waivers` in the spec, with the number that stands
/// beside it here, a reason, who has accepted it, and until when. It is listed from then on, but does not count. A waiver that
/// has expired, or that accepts nothing although the comparison is with the last release, is an error.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  fcproto diff                     what has changed since the last release
  fcproto diff git:main            what this working tree changes
  fcproto diff git:v1 git:v2 --format markdown --lang zh
  fcproto diff --fail-on breaking  for continuous integration: fails if old and new apps and robots
                                   would misunderstand each other, and no waiver accepts it
  fcproto diff old.json new.json --format json | jq -r '.[] | select(.silent) | .message'")]
#[command(after_long_help = "\
Examples:
  fcproto diff                     what has changed since the last release
  fcproto diff git:main            what this working tree changes
  fcproto diff git:v1 git:v2 --format markdown --lang zh
  fcproto diff --fail-on breaking  for continuous integration: fails if old and new apps and robots
                                   would misunderstand each other, and no waiver accepts it
  fcproto diff old.json new.json --format json | jq -r '.[] | select(.silent) | .message'

JSON:
  A list of objects: rule (its name), number (of the rule), subject, wire (old_app_new_robot and new_app_old_robot,
  as a list), source (a list of languages), behaviour, silent (nothing fails, but a value is wrong),
  message, fingerprint (the same for the same change, wherever it stands); waived (the waiver) where one accepts it.")]
pub struct Options {
    /// The old version [default: the last release]
    #[arg(value_name = "OLD")]
    old: Option<String>,
    /// The new version [default: this project]
    #[arg(value_name = "NEW")]
    new: Option<String>,
    /// How to print the changes.
    #[arg(long, value_name = "FORMAT", default_value = "text")]
    format: Shown,
    /// Exit with 1 if there is a change of this kind.
    #[arg(long, value_name = "KINDS", value_delimiter = ',')]
    fail_on: Vec<Kind>,
    /// Judge waivers as on this day [default: today]
    #[arg(long, value_name = "DAY", value_parser = day)]
    today: Option<String>,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Shown {
    /// With the lines of both versions, for people
    Text,
    /// One JSON document
    Json,
    /// A table, for a pull request
    Markdown,
    /// Annotations of a GitHub pull request
    Github,
    /// A SARIF 2.1.0 log, for code hosts and editors
    Sarif,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Kind {
    /// Old and new apps and robots misunderstand each other
    Wire,
    /// The same, but for new commands, which old robots do not know and nobody has used yet
    Breaking,
    /// Sources stop compiling
    Source,
    /// Programs behave differently
    Behaviour,
}

impl Kind {
    fn is_of(self, finding: &Finding) -> bool {
        match self {
            Self::Wire => !finding.wire.is_empty(),
            Self::Breaking => finding.is_break(),
            Self::Source => !finding.source.is_empty(),
            Self::Behaviour => finding.behaviour,
        }
    }
}

pub fn run(place: &Place, options: &Options) -> Result<Status, Failure> {
    // Two versions that are named need no project around them.
    let named: Vec<_> = [&options.old, &options.new].into_iter().flatten().collect();
    let needs_project = named.len() < 2 || named.iter().any(|it| it.starts_with("git:"));
    let shelf = Shelf::find(place, needs_project)?;
    let old = match &options.old {
        Some(old) => old.clone(),
        None => shelf.last()?,
    };
    let new = options.new.clone().unwrap_or_else(|| shelf.here());
    let (Some(old), Some(mut new)) = (shelf.read(&old)?, shelf.read(&new)?) else {
        return Ok(Status::Faulty);
    };
    let format = match options.format {
        Shown::Text => fc_diff::Format::Text,
        Shown::Json => fc_diff::Format::Json,
        Shown::Markdown => fc_diff::Format::Markdown,
        Shown::Github => fc_diff::Format::Github,
        Shown::Sarif => fc_diff::Format::Sarif,
    };
    let findings = shelf.compare(&old, &new, &today(options.today.as_deref()));
    if matches!(options.format, Shown::Github | Shown::Sarif) {
        new.sources = new.sources.below(&in_repository(&shelf.root));
    }
    let lang = lang();
    print::result(&render(&findings, [&old, &new], format, lang))?;
    let fails = |finding: &Finding| {
        let counts = || finding.waived.is_none();
        let kinds = || options.fail_on.iter().any(|kind| kind.is_of(finding));
        finding.is_fault() || (counts() && kinds())
    };
    Ok(if findings.iter().any(fails) {
        Status::Faulty
    } else {
        Status::Fine
    })
}
