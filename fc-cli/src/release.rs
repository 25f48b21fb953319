//! `fcproto release`.

use std::fmt::Write as _;

use fc_codegen::inspect::release_dump;
use fc_codegen::output::replace_spec_file;
use fc_diff::release::{DIRECTORY, NoNumber, Number, Objection, file};
use fc_diff::{Finding, Lang, NextRelease, with_section};
use fc_spec::model::{Model, Text};

use crate::lang::{both, in_lang, said};
use crate::outcome::{Failure, Status};
use crate::project::slashed;
use crate::spec::Spec;
use crate::versions::{Shelf, day, today};
use crate::{input, print};

/// Options of `fcproto release`.
#[derive(Debug, clap::Args)]
pub struct Options {
    #[arg(
        value_name = "NUMBER",
        value_parser = number,
        help = both("版本号，例如 `2026.12` 或 `2.1.0`", "Release number, such as `2026.12` or `2.1.0`")
    )]
    number: Number,
    #[arg(
        long,
        help = both("显示修改，什么也不写", "Show the changes and write nothing")
    )]
    dry_run: bool,
    #[arg(
        long,
        value_name = "DAY",
        value_parser = day,
        help = both("发布日期 [默认：今天]", "Date of the release [default: today]")
    )]
    today: Option<String>,
}

/// Parses the number of a release on the command line.
fn number(text: &str) -> Result<Number, String> {
    text.parse().map_err(|error: NoNumber| {
        said!(
            "版本号应为几个用点隔开的数，例如 2026.12 或 2.1.0",
            "{error}"
        )
    })
}

/// A language and the file with its changelog.
const CHANGELOGS: [(Lang, &str); 2] = [(Lang::Zh, "CHANGELOG.md"), (Lang::En, "CHANGELOG.en.md")];

pub fn run(spec: &Spec, options: &Options) -> Result<Status, Failure> {
    let before = spec.valid()?;
    let number = &options.number;
    let shelf = Shelf::of(spec.project.clone())?;
    let today = today(options.today.as_deref());
    let next = next_release(number, spec)?;
    let findings = changes(&shelf, &next.agreed, &today)?;
    let findings = findings.as_deref();
    let objections = next.objections(&before.protocol.version, &shelf.releases, findings);
    if !objections.is_empty() {
        return refuse(number, &objections, &shelf);
    }

    let languages = CHANGELOGS.into_iter();
    let languages = languages.filter(|(lang, _)| spec.texts().include(*lang));
    let sections = languages.map(|(lang, file)| (lang, file, next.section(&today, findings, lang)));
    let sections: Vec<_> = sections.collect();
    if options.dry_run {
        let would = print::good(&said!("将会发布", "would release"));
        let mut text = format!("{would} {number}\n");
        for (path, diff) in &next.diffs {
            // Writing to a String cannot fail.
            let _ = writeln!(text, "\n{path}\n{}", print::diff(diff).trim_end());
        }
        for (.., section) in &sections {
            let _ = write!(text, "\n{section}");
        }
        print::result(&text)?;
        return Ok(Status::Fine);
    }
    let mut written = write(&shelf, &next.released, number, &sections)?;
    written.extend(spec.project.write_changes(&spec.sources, &next.sources)?);
    let released = print::good(&said!("已发布", "released"));
    let mut text = format!("{released} {number}\n");
    for path in written {
        let _ = writeln!(text, "  {path}");
    }
    if !next.left.is_empty() {
        text += &said!(
            "这些豁免已经用过，请删除：{left}\n",
            "remove these waivers, which are used up: {left}\n",
            left = Text::listed(&next.left)
        );
    }
    text += &said!(
        "运行 `fcproto generate`，提交，再给提交打上标签\n",
        "run `fcproto generate`, commit, and tag the commit\n"
    );
    print::done(&text)?;
    Ok(Status::Fine)
}

/// Edits the spec for the release, and checks it.
fn next_release(number: &Number, spec: &Spec) -> Result<NextRelease, Failure> {
    let next = NextRelease::prepare(number, &spec.sources, |sources| {
        let after = spec.instead(sources);
        let objection = after.objection();
        after.model.ok_or_else(|| {
            said!(
                "版本改为 {number} 后，{objection}",
                "as {number} {objection}"
            )
        })
    })?;
    Ok(next.ok_or_else(|| {
        said!(
            "规范的文件中都没有写版本",
            "no file of the spec has its version"
        )
    })?)
}

/// Returns the changes since the last release, or `None` if there is none.
fn changes(shelf: &Shelf, model: &Model, today: &str) -> Result<Option<Vec<Finding>>, Failure> {
    let Some((last, _)) = shelf.releases.last() else {
        return Ok(None);
    };
    let [old, mut new] = shelf.both(&last.to_string(), &shelf.here())?;
    new.model = model.clone();
    shelf.compare(&old, &new, today).map(Some)
}

/// Prints the reasons why there is no release.
fn refuse(number: &Number, objections: &[Objection], shelf: &Shelf) -> Result<Status, Failure> {
    for objection in objections {
        print::error(&in_lang(&objection.message()))?;
    }
    let mut text = said!("{number} 没有发布", "{number} is not released");
    if let Some((last, _)) = shelf.releases.last() {
        text += &said!(
            "；`fcproto diff` 会列出自 {last} 以来的变更",
            "; `fcproto diff` shows what has changed since {last}"
        );
    }
    print::message(&(text + "\n"))?;
    Ok(Status::Faulty)
}

/// Writes the dump and the changelogs, and returns their paths.
fn write(
    shelf: &Shelf,
    model: &Model,
    number: &Number,
    sections: &[(Lang, &str, String)],
) -> Result<Vec<String>, Failure> {
    let path = slashed(&shelf.file(&file(number)));
    replace_spec_file(&shelf.project.root, &path, &release_dump(model))?;
    let mut written = vec![path];
    for (lang, name, section) in sections {
        let path = slashed(&shelf.file(&format!("{DIRECTORY}/{name}")));
        let disk = shelf.project.root.join(&path);
        let before = input::file_if_there(&disk)?;
        let text = with_section(before.as_deref(), section, *lang);
        replace_spec_file(&shelf.project.root, &path, &text)?;
        written.push(path);
    }
    Ok(written)
}
