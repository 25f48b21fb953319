//! `fc diff`.

use std::path::Path;

use clap::ValueEnum;
use fc_diff::{Finding, Version, VersionError, diff, render};
use fc_spec::diagnostic::{Format, render as show};

use crate::lang::Language;
use crate::outcome::{Failure, Status};
use crate::place::Place;
use crate::print;
use crate::project::{Project, in_repository};

/// Show what changed between two versions of the spec, and for whom it breaks.
///
/// A version is the directory of a project or of a spec, a file that `fc inspect` has printed, or git:REF for what git has
/// of this project's spec. Each change is judged by a rule: whether old apps and new robots, or new apps and old robots,
/// misunderstand each other, in which languages sources stop compiling, and whether programs behave differently. What no
/// rule judges is listed as well, so that no changes means that the two say the same. `fc explain FC0731` explains a rule.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  fc diff git:main            what this working tree changes
  fc diff git:v1 git:v2 --format markdown --lang zh
  fc diff git:main --fail-on wire,source
                              for continuous integration: fails if something breaks
  fc diff old.json new.json --format json | jq -r '.[] | select(.silent) | .message'")]
#[command(after_long_help = "\
Examples:
  fc diff git:main            what this working tree changes
  fc diff git:v1 git:v2 --format markdown --lang zh
  fc diff git:main --fail-on wire,source
                              for continuous integration: fails if something breaks
  fc diff old.json new.json --format json | jq -r '.[] | select(.silent) | .message'

JSON:
  A list of objects: rule (its name), number (of the rule), subject, wire (old_app_new_robot and new_app_old_robot,
  as a list), source (a list of languages), behaviour, silent (nothing fails, but a value is wrong),
  message, fingerprint (the same for the same change, wherever it stands).")]
pub struct Options {
    /// The old version.
    #[arg(value_name = "OLD")]
    old: String,
    /// The new version [default: this project]
    #[arg(value_name = "NEW")]
    new: Option<String>,
    /// How to print the changes.
    #[arg(long, value_name = "FORMAT", default_value = "text")]
    format: Shown,
    /// In which language.
    #[arg(long, value_name = "LANGUAGE", default_value = "en")]
    lang: Language,
    /// Exit with 1 if there is a change of this kind.
    #[arg(long, value_name = "KINDS", value_delimiter = ',')]
    fail_on: Vec<Kind>,
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
    /// Sources stop compiling
    Source,
    /// Programs behave differently
    Behaviour,
}

impl Kind {
    fn is_of(self, finding: &Finding) -> bool {
        match self {
            Self::Wire => !finding.wire.is_empty(),
            Self::Source => !finding.source.is_empty(),
            Self::Behaviour => finding.behaviour,
        }
    }
}

pub fn run(place: &Place, options: &Options) -> Result<Status, Failure> {
    // Two versions that are named need no project around them.
    let needs_project = options.new.is_none()
        || [&options.old]
            .into_iter()
            .chain(&options.new)
            .any(|it| it.starts_with("git:"));
    let (root, spec) = match Project::find(place) {
        Ok(project) => (project.root, project.spec),
        Err(error) if needs_project => return Err(error),
        Err(_) => (Path::new(".").to_owned(), Path::new("spec").to_owned()),
    };
    let here = root.display().to_string();
    let new = options.new.as_deref().unwrap_or(&here);
    let mut versions = Vec::new();
    for name in [&options.old, new] {
        match Version::read(name, &root, &spec) {
            Ok(version) => versions.push(version),
            Err(VersionError::Faulty {
                name,
                sources,
                faults,
            }) => {
                print::message(&show(&faults, &sources, Format::Colored))?;
                print::message(&print::leveled(&format!(
                    "error: the spec of `{name}` has errors\n"
                )))?;
                return Ok(Status::Faulty);
            }
            Err(error) => return Err(error.into()),
        }
    }
    let [old, new] = versions.as_mut_slice() else {
        return Ok(Status::Failed);
    };
    let format = match options.format {
        Shown::Text => fc_diff::Format::Text,
        Shown::Json => fc_diff::Format::Json,
        Shown::Markdown => fc_diff::Format::Markdown,
        Shown::Github => fc_diff::Format::Github,
        Shown::Sarif => fc_diff::Format::Sarif,
    };
    if matches!(options.format, Shown::Github | Shown::Sarif) {
        new.sources = new.sources.below(&in_repository(&root));
    }
    let findings = diff(&old.model, &new.model);
    let lang = options.lang.into();
    print::result(&render(&findings, [old, new], format, lang))?;
    let fails = |finding: &Finding| options.fail_on.iter().any(|kind| kind.is_of(finding));
    Ok(if findings.iter().any(fails) {
        Status::Faulty
    } else {
        Status::Fine
    })
}
