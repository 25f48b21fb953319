//! Formats findings as a section of a changelog.

use crate::finding::Finding;
use crate::release::VERSION;
use crate::rule::{About, pick};
use fc_spec::model::Lang;
use fc_spec::model::Model;
use std::fmt::Write as _;

/// Returns the section of a version for authors of apps and robots. It lists breaks, new operations and other changes,
/// and only counts changes of texts and examples. `title` is its heading.
#[must_use]
pub fn section(title: &str, findings: &[Finding], new: &Model, lang: Lang) -> String {
    let is_change = |it: &&Finding| !it.is_fault() && it.subject != VERSION;
    let mut left: Vec<&Finding> = findings.iter().filter(is_change).collect();
    let mut take = |is: &dyn Fn(&Finding) -> bool| {
        let (taken, rest) = left.iter().copied().partition(|it| is(it));
        left = rest;
        taken
    };
    let added: Vec<&Finding> = take(&Finding::is_new_operation);
    let breaking: Vec<&Finding> = take(&|it| !it.wire.is_empty());
    let changed: Vec<&Finding> = take(&|it| it.rule.about != About::Text);
    let texts = left.len();

    let mut out = format!("## {title}\n");
    let mut part = |heading: [&str; 2], lines: Vec<String>| {
        if lines.is_empty() {
            return;
        }
        // Writing to a String cannot fail.
        let _ = write!(out, "\n### {}\n\n", pick(lang, heading));
        for line in lines {
            let _ = writeln!(out, "- {line}");
        }
    };
    let plain = |it: &&Finding| lang.text(&it.message).to_owned();
    part(
        ["Breaking", "不兼容"],
        breaking.iter().map(|it| broken(it, lang)).collect(),
    );
    part(
        ["New", "新增"],
        added.iter().map(|it| operation(it, new, lang)).collect(),
    );
    part(["Changed", "变更"], changed.iter().map(plain).collect());
    if texts > 0 {
        let line = match lang {
            Lang::En if texts == 1 => "1 text, example or note".to_owned(),
            Lang::En => format!("{texts} texts, examples and notes"),
            Lang::Zh => format!("{texts} 处文字、示例或备注"),
        };
        part(["Documentation", "文档"], vec![line]);
    }
    if !findings.iter().any(|it| is_change(&it)) {
        out += lang.pick("\n没有变更。\n", "\nNothing has changed.\n");
    }
    out
}

/// Returns the section of the first release, which has no version to compare with.
pub(crate) fn first_section(title: &str, model: &Model, lang: Lang) -> String {
    let count = model.operations.len();
    match lang {
        Lang::En if count == 1 => format!("## {title}\n\nFirst release, with one operation.\n"),
        Lang::En => format!("## {title}\n\nFirst release, with {count} operations.\n"),
        Lang::Zh => format!("## {title}\n\n首次发布，共 {count} 个接口。\n"),
    }
}

/// Returns a changelog with a new section above the others. Without a changelog, returns a new one.
#[must_use]
pub fn with_section(changelog: Option<&str>, section: &str, lang: Lang) -> String {
    let Some(changelog) = changelog else {
        let title = pick(lang, ["Changes of the protocol", "协议变更记录"]);
        return format!("# {title}\n\n{section}");
    };
    let newline = match changelog.split_once('\n') {
        Some((first, _)) if first.ends_with('\r') => "\r\n",
        _ => "\n",
    };
    let section = section.replace('\n', newline);
    let first = if changelog.starts_with("## ") {
        Some(0)
    } else {
        changelog.find("\n## ").map(|at| at + 1)
    };
    match first {
        Some(at) => {
            let (head, rest) = changelog.split_at(at);
            format!("{head}{section}{newline}{rest}")
        }
        None => format!("{}{newline}{newline}{section}", changelog.trim_end()),
    }
}

/// Returns the line of a break, with the deployments that it breaks.
fn broken(finding: &Finding, lang: Lang) -> String {
    let who: Vec<_> = finding.wire.iter().map(|it| it.words(lang)).collect();
    let mut line = match lang {
        Lang::En => format!("{} (breaks {})", finding.message.en, who.join(" and ")),
        Lang::Zh => format!("{}（影响：{}）", finding.message.zh, who.join("、")),
    };
    if let Some(waiver) = &finding.waived {
        line += pick(lang, [". ", "。"]);
        line += lang.text(&waiver.reason);
    }
    line
}

/// Returns the line of a new operation: its name, code and title.
fn operation(finding: &Finding, new: &Model, lang: Lang) -> String {
    let Some(operation) = new.operation(&finding.subject) else {
        return lang.text(&finding.message).to_owned();
    };
    let (name, code) = (&operation.name, &operation.code.spelling);
    let title = lang.text(&operation.title);
    match lang {
        Lang::En => format!("`{name}` ({code}): {title}"),
        Lang::Zh => format!("`{name}`（{code}）：{title}"),
    }
}
