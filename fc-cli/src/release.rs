//! `fcproto release`.

use std::fmt::Write as _;
use std::path::Path;

use fc_codegen::inspect::frozen;
use fc_codegen::output::replace_spec_file;
use fc_diff::release::{DIRECTORY, Number, Objection, file, goes_back, objections};
use fc_diff::{Finding, Lang, first_section, is_ours, section, with_section};
use fc_spec::model::{Model, Text};
use fc_spec::revision::{renumbered, without_waiver};
use fc_spec::syntax::Sources;

use crate::lang::said;
use crate::outcome::{Failure, Status};
use crate::place::Place;
use crate::print;
use crate::project::Project;
use crate::spec::Spec;
use crate::versions::{Shelf, day, today};

/// Freeze the spec under a number, and write the changelog.
///
/// The spec gets the number as its version. What it says is frozen under `releases/` beside it, as a dump like that of `fcproto inspect`, and what
/// has changed since the last release becomes a section of the changelogs there, in Chinese and in English. `fcproto diff` compares with the last
/// release from then on, and `fcproto generate --as-of` makes the files of any. Waivers have served by then, and are taken out: their reasons
/// are in the changelogs.
///
/// The number has to move far enough for what has changed. By the calendar (2026.12) any later one does, but each change that
/// breaks messages has to be accepted by a waiver. Otherwise (2.1.0) the first part rises where messages break, the second one where
/// programs have something new to know, and the third one for texts.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  fcproto release 2026.12 --dry-run
                              whether that can be released, and what the changelogs will say
  fcproto release 2026.12 && fcproto generate")]
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
    let Some(before) = &spec.model else {
        spec.show_faults()?;
        return Ok(spec.status());
    };
    let number = &options.number;
    let shelf = Shelf::of(&project)?;
    let today = today(options.today.as_deref());
    let change = Change::to(number, &spec)?;
    let findings = match changes(&shelf, &project, &change.agreed, &today)? {
        Since::Faulty => return Ok(Status::Faulty),
        Since::Nothing => None,
        Since::Release(findings) => Some(findings),
    };
    let mut objections = match (shelf.releases.last(), &findings) {
        (Some((last, _)), Some(findings)) => objections(last, number, findings),
        _ => Vec::new(),
    };
    let is_late = |it: &Objection| matches!(it, Objection::NotLater { .. });
    if !objections.iter().any(is_late) {
        objections.extend(goes_back(number, &before.protocol.version));
    }
    if !objections.is_empty() {
        return refuse(number, &objections, &shelf);
    }

    let title = format!("{number} ({today})");
    let sections = CHANGELOGS.map(|(lang, _)| match &findings {
        Some(findings) => section(&title, findings, &change.agreed, lang),
        None => first_section(&title, &change.agreed, lang),
    });
    let mut text = String::new();
    if options.dry_run {
        // Writing to a String cannot fail.
        let _ = writeln!(
            text,
            "{} {number}",
            print::good(&said!("将会发布", "would release"))
        );
        for (path, diff) in &change.diffs {
            let _ = writeln!(text, "\n{path}\n{}", print::diff(diff).trim_end());
        }
        for section in sections {
            let _ = write!(text, "\n{section}");
        }
        print::result(&text)?;
        return Ok(Status::Fine);
    }
    let mut written = write(&project, &shelf, &change.released, number, sections)?;
    for ((_, before), (_, file)) in spec.sources.iter().zip(change.sources.iter()) {
        if file.text != before.text {
            replace_spec_file(&project.root, &file.path, &file.text)?;
            written.push(file.path.clone());
        }
    }
    let _ = writeln!(
        text,
        "{} {number}",
        print::good(&said!("已发布", "released"))
    );
    for path in written {
        let _ = writeln!(text, "  {path}");
    }
    if !change.left.is_empty() {
        text += &said!(
            "这些豁免已经用过，请删除：{left}\n",
            "take these waivers out, they have served: {left}\n",
            left = Text::listed(&change.left)
        );
    }
    text += &said!(
        "运行 `fcproto generate`，提交，再给提交打上标签\n",
        "run `fcproto generate`, commit, and tag the commit\n"
    );
    print::done(&text)?;
    Ok(Status::Fine)
}

/// What a release makes of the spec.
struct Change {
    /// Under the new number, with its waivers: what is judged.
    agreed: Model,
    /// Without the waivers: what is frozen.
    released: Model,
    /// Its files.
    sources: Sources,
    /// Path and lines of each change, as diffs without line numbers.
    diffs: Vec<(String, String)>,
    /// Waivers that are not written on lines of their own, which people have to take out.
    left: Vec<String>,
}

impl Change {
    fn to(number: &Number, spec: &Spec) -> Result<Self, Failure> {
        let Some(renumbered) = renumbered(&spec.sources, &number.to_string()) else {
            return Err(said!(
                "规范的文件中都没有写版本",
                "no file of the spec has its version"
            )
            .into());
        };
        let sound = |sources: &Sources| {
            let after = spec.instead(sources.clone());
            let objection = after.objection();
            let model = after.model;
            model.ok_or_else(|| format!("as {number} {objection}"))
        };
        let agreed = sound(&renumbered.sources)?;
        let (mut sources, mut left) = (renumbered.sources, Vec::new());
        let mut diffs = vec![(renumbered.path, renumbered.diff)];
        for waiver in agreed.waivers.iter().filter(|it| is_ours(it)) {
            match without_waiver(&sources, &waiver.id) {
                Some(without) => {
                    sources = without.sources;
                    diffs.push((without.path, without.diff));
                }
                None => left.push(waiver.id.clone()),
            }
        }
        diffs.retain(|(_, diff)| !diff.is_empty());
        Ok(Self {
            released: sound(&sources)?,
            agreed,
            sources,
            diffs,
            left,
        })
    }
}

/// What has changed.
enum Since {
    /// Since the last release.
    Release(Vec<Finding>),
    /// There is none before this.
    Nothing,
    /// It cannot be said, for what has been shown.
    Faulty,
}

fn changes(shelf: &Shelf, project: &Project, model: &Model, today: &str) -> Result<Since, Failure> {
    let Some((last, _)) = shelf.releases.last() else {
        return Ok(Since::Nothing);
    };
    let here = project.root.display().to_string();
    let (Some(old), Some(mut new)) = (shelf.read(&last.to_string())?, shelf.read(&here)?) else {
        return Ok(Since::Faulty);
    };
    new.model = model.clone();
    Ok(Since::Release(shelf.compare(&old, &new, today)))
}

/// Says why there is no such release.
fn refuse(number: &Number, objections: &[Objection], shelf: &Shelf) -> Result<Status, Failure> {
    let mut text = String::new();
    for objection in objections {
        text += &print::leveled(&said!(
            "错误：{objection}\n",
            "error: {objection}\n",
            objection = objection.message()
        ));
    }
    text += &said!("{number} 没有发布", "{number} is not released");
    if let Some((last, _)) = shelf.releases.last() {
        text += &said!(
            "；`fcproto diff` 会列出自 {last} 以来的变更",
            "; `fcproto diff` shows what has changed since {last}"
        );
    }
    print::message(&(text + "\n"))?;
    Ok(Status::Faulty)
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
    replace_spec_file(&project.root, &path, &frozen(model))?;
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
