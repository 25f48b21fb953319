//! `fc release`.

use std::fmt::Write as _;
use std::path::Path;

use fc_codegen::inspect::json;
use fc_codegen::output::replace_spec_file;
use fc_diff::release::{DIRECTORY, Number, file, objections};
use fc_diff::{Finding, Lang, first_section, section, with_section};
use fc_spec::model::Model;
use fc_spec::revision::renumbered;

use crate::lang::said;
use crate::outcome::{Failure, Status};
use crate::place::Place;
use crate::print;
use crate::project::Project;
use crate::spec::Spec;
use crate::versions::{Shelf, day, today};

/// Freeze the spec under a number, and write the changelog.
///
/// The spec gets the number as its version. What it says is frozen under `releases/` beside it, as `fc inspect` prints it, and what has
/// changed since the last release becomes a section of the changelogs there, in Chinese and in English. `fc diff` compares with the last
/// release from then on, and `fc generate --as-of` makes the files of any.
///
/// The number has to move far enough for what has changed. By the calendar (2026.12) any later one does, but each change that
/// breaks messages has to be accepted by a waiver. Otherwise (2.1.0) the first part rises where messages break, the second one where
/// programs have something new to know, and the third one for texts.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  fc release 2026.12 --dry-run
                              whether that can be released, and what the changelogs will say
  fc release 2026.12 && fc generate")]
pub struct Options {
    /// Its number, such as 2026.12 or 2.1.0.
    #[arg(value_name = "NUMBER")]
    number: Number,
    /// Show what would be written and write nothing.
    #[arg(long)]
    dry_run: bool,
    /// Release as on this day [default: today]
    #[arg(long, value_name = "DAY", value_parser = day)]
    today: Option<String>,
}

/// A language and the file with its changelog.
const CHANGELOGS: [(Lang, &str); 2] = [(Lang::Zh, "CHANGELOG.md"), (Lang::En, "CHANGELOG.en.md")];

pub fn run(place: &Place, options: &Options) -> Result<Status, Failure> {
    let project = Project::find(place)?;
    let spec = Spec::in_project(&project);
    if spec.model.is_none() {
        spec.show_faults()?;
        return Ok(spec.status());
    }
    let number = &options.number;
    let Some(renumbered) = renumbered(&spec.sources, &number.to_string()) else {
        return Err(said!(
            "规范的文件中都没有写版本",
            "no file of the spec has its version"
        )
        .into());
    };
    let Some(model) = spec.instead(renumbered.sources.clone()).model else {
        return Err(said!(
            "把版本改为 {number} 后，规范有错误",
            "the spec has errors once its version is {number}"
        )
        .into());
    };
    let shelf = Shelf::of(&project)?;
    let today = today(options.today.as_deref());
    let Some(findings) = findings(&shelf, &project, &model, number, &today)? else {
        return Ok(Status::Faulty);
    };
    let title = format!("{number} ({today})");
    let sections = CHANGELOGS.map(|(lang, _)| match &findings {
        Some(findings) => section(&title, findings, &model, lang),
        None => first_section(&title, &model, lang),
    });
    if options.dry_run {
        let mut text = print::diff(&renumbered.diff);
        for section in sections {
            let _ = write!(text, "\n{section}");
        }
        print::result(&text)?;
        return Ok(Status::Fine);
    }
    let written = write(&project, &shelf, &model, number, sections)?;
    let protocol = renumbered.sources.iter();
    for (_, file) in protocol.filter(|(_, file)| file.path == renumbered.path) {
        replace_spec_file(&project.root, &file.path, &file.text)?;
    }
    let mut text = format!("{} {number}\n", print::good(&said!("已发布", "released")));
    for path in std::iter::once(renumbered.path).chain(written) {
        let _ = writeln!(text, "  {path}");
    }
    text += &said!(
        "运行 `fc generate`，提交，再给提交打上标签\n",
        "run `fc generate`, commit, and tag the commit\n"
    );
    print::done(&text)?;
    Ok(Status::Fine)
}

/// What has changed since the last release; an inner `None` where this is the first, an outer one where something
/// speaks against it, which is shown.
#[allow(
    clippy::option_option,
    reason = "two questions, each with an answer of its own"
)]
fn findings(
    shelf: &Shelf,
    project: &Project,
    model: &Model,
    number: &Number,
    today: &str,
) -> Result<Option<Option<Vec<Finding>>>, Failure> {
    let Some((last, _)) = shelf.releases.last() else {
        return Ok(Some(None));
    };
    let (Some(old), Some(mut new)) = (
        shelf.read(&last.to_string())?,
        shelf.read(&project.root.display().to_string())?,
    ) else {
        return Ok(None);
    };
    new.model = model.clone();
    let findings = shelf.compare(&old, &new, today);
    let objections = objections(last, number, &findings);
    if objections.is_empty() {
        return Ok(Some(Some(findings)));
    }
    for objection in objections {
        print::message(&print::leveled(&said!(
            "错误：{objection}\n",
            "error: {objection}\n"
        )))?;
    }
    print::message(&said!(
        "{number} 没有发布；`fc diff` 会列出自 {last} 以来的变更\n",
        "{number} is not released; `fc diff` shows what has changed since {last}\n"
    ))?;
    Ok(None)
}

/// Writes the dump and the changelogs, and tells their paths.
fn write(
    project: &Project,
    shelf: &Shelf,
    model: &Model,
    number: &Number,
    sections: [String; 2],
) -> Result<Vec<String>, Failure> {
    let path = slashed(&shelf.file(&file(number)));
    replace_spec_file(&project.root, &path, &json(model))?;
    let mut written = vec![path];
    for ((lang, name), section) in CHANGELOGS.into_iter().zip(sections) {
        let path = slashed(&shelf.file(&format!("{DIRECTORY}/{name}")));
        let disk = project.root.join(&path);
        let before = match std::fs::read_to_string(&disk) {
            Ok(text) => Some(text),
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => None,
            Err(error) => {
                return Err(said!(
                    "无法读取 `{path}`：{error}",
                    "cannot read `{path}`: {error}"
                )
                .into());
            }
        };
        let text = with_section(before.as_deref(), &section, lang);
        replace_spec_file(&project.root, &path, &text)?;
        written.push(path);
    }
    Ok(written)
}

/// With `/` between its parts.
fn slashed(path: &Path) -> String {
    let parts: Vec<_> = path.iter().map(|part| part.to_string_lossy()).collect();
    parts.join("/")
}
