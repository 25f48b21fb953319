//! Help in the form for the terminal and the manual pages.

use std::fmt::Write as _;

use clap::Command;
use terminal_size::{Width, terminal_size};
use unicode_width::UnicodeWidthStr as _;

use super::wrap::wrap;
use super::{ArgumentHelp, Help, Part, arguments, default_label, global};
use crate::args::STYLES;
use crate::lang::{both, said};

/// The maximum length of a line. It is also the length without a terminal.
const WIDEST: usize = 100;

/// The columns before a term, and between a term and its text.
const GAP: usize = 2;

/// The maximum length of a term with its text on the same line.
const LONGEST_TERM: usize = 36;

/// The minimum width of a text. A narrower text starts on a new line.
const NARROWEST: usize = 30;

/// The columns before a text on a new line.
const INDENT: usize = 8;

/// Returns the number of columns for help.
pub fn width() -> usize {
    let columns = terminal_size().map(|(Width(columns), _)| usize::from(columns));
    let columns = columns.or_else(|| std::env::var("COLUMNS").ok()?.parse().ok());
    let columns = columns.filter(|columns| *columns > 0);
    columns.unwrap_or(WIDEST).min(WIDEST)
}

/// Returns the summary, the usage and the arguments as a template for clap. The details follow in `--help`.
pub fn body(command: &Command, summary: &str, usage: &str, width: usize) -> String {
    let title = heading(both("用法：", "Usage: "));
    let mut text = format!("{summary}\n\n{title}{}\n", literal(usage));
    let visible = command.get_subcommands().filter(|it| !it.is_hide_set());
    let commands: Vec<_> = visible
        .map(|below| {
            let about = below.get_about().map(ToString::to_string);
            (below.get_name().to_owned(), about.unwrap_or_default())
        })
        .collect();
    let (own, shared) = arguments(command);
    let (positional, options): (Vec<_>, Vec<_>) =
        own.iter().partition(|it| it.argument.is_positional());
    let rows = |shown: &[&ArgumentHelp<'_>]| shown.iter().map(|it| row(it)).collect::<Vec<_>>();
    for (title, rows) in [
        (both("命令", "Commands"), commands),
        (both("参数", "Arguments"), rows(&positional)),
        (both("选项", "Options"), rows(&options)),
        (global(), rows(&shared.iter().collect::<Vec<_>>())),
    ] {
        if !rows.is_empty() {
            text += &section(title, &table(&rows, width));
        }
    }
    text.trim_end().to_owned() + "{after-help}"
}

/// Returns an argument as a term and its text.
fn row(shown: &ArgumentHelp<'_>) -> (String, String) {
    let mut text = shown.text.clone();
    if let Some(default) = &shown.default {
        let _ = write!(text, " [{}{default}]", default_label());
    }
    if !shown.values.is_empty() {
        let names: Vec<_> = shown.values.iter().map(|(name, _)| name.as_str()).collect();
        let names = names.join(both("、", ", "));
        text += &said!(" [取值：{names}]", " [values: {names}]");
    }
    (shown.term.clone(), text)
}

/// Returns the values of arguments, the details, the exit status and the examples.
pub fn details(command: &Command, help: &Help, width: usize) -> String {
    let (own, shared) = arguments(command);
    // The values of global options are on their lines. Only the program's own help has room for more.
    let shared = shared.iter().filter(|_| command.get_version().is_some());
    let described = own
        .iter()
        .chain(shared)
        .filter_map(ArgumentHelp::described_values);
    let mut parts = Vec::new();
    for (name, values) in described {
        let title = said!("`{name}` 的取值", "Values of `{name}`");
        parts.push(section(&title, &table(values, width)));
    }
    parts.extend(sections(help, width));
    parts.concat().trim_matches('\n').to_owned()
}

/// Returns the details without colors and with each paragraph on one line.
pub fn plain(help: &Help) -> String {
    let text = sections(help, usize::MAX).concat();
    anstream::adapter::strip_str(text.trim_matches('\n')).to_string()
}

/// Returns the details, the exit status and the examples.
fn sections(help: &Help, width: usize) -> Vec<String> {
    let is_example = |part: &&Part| matches!(part, Part::Examples(_));
    let (examples, others): (Vec<_>, Vec<_>) = help.details.iter().partition(is_example);
    let mut sections: Vec<_> = others.into_iter().map(|it| shown(it, width)).collect();
    let title = both("退出码", "Exit status");
    sections.push(section(title, &table(&statuses(help), width)));
    sections.extend(examples.into_iter().map(|it| shown(it, width)));
    sections
}

/// Returns the exit statuses with their meaning.
pub fn statuses(help: &Help) -> Vec<(String, String)> {
    let mut statuses = vec![("0".to_owned(), both("成功", "Success").to_owned())];
    if !help.fails.is_empty() {
        statuses.push(("1".to_owned(), help.fails.to_owned()));
    }
    let wrong = both(
        "用法错误，或文件无法读写",
        "Wrong usage, or a file that cannot be read or written",
    );
    statuses.push(("2".to_owned(), wrong.to_owned()));
    statuses
}

fn shown(part: &Part, width: usize) -> String {
    match part {
        Part::Text(text) => format!("\n{}\n", wrap(text, width).join("\n")),
        Part::Terms(title, rows) => section(title, &table(&owned(rows), width)),
        Part::Code(title, lines) => {
            let lines = lines.lines().map(|line| format!("  {line}\n"));
            section(title, &lines.collect::<String>())
        }
        Part::Examples(rows) => section(both("示例", "Examples"), &table(&owned(rows), width)),
    }
}

fn owned(rows: &[(&str, &str)]) -> Vec<(String, String)> {
    let rows = rows.iter();
    rows.map(|(term, text)| ((*term).to_owned(), (*text).to_owned()))
        .collect()
}

fn section(title: &str, lines: &str) -> String {
    let title = said!("{title}：", "{title}:");
    format!("\n{}\n{lines}", heading(&title))
}

/// Returns terms in one column and their texts in another.
fn table(rows: &[(String, String)], width: usize) -> String {
    let terms = rows.iter().filter(|(_, text)| !text.is_empty());
    let terms = terms.map(|(term, _)| term.width());
    let longest = terms.filter(|it| *it <= LONGEST_TERM).max().unwrap_or(0);
    let column = GAP + longest + GAP;
    let is_narrow = width < column + NARROWEST;
    let column = if is_narrow { INDENT } else { column };
    let mut lines = String::new();
    for (term, text) in rows {
        let _ = write!(lines, "{:GAP$}{}", "", literal(term));
        let texts = wrap(text, width.saturating_sub(column));
        let mut at = GAP + term.width();
        for text in texts.iter().filter(|text| !text.is_empty()) {
            if at + GAP > column || is_narrow {
                lines.push('\n');
                at = 0;
            }
            let _ = write!(lines, "{:1$}{text}", "", column - at);
            at = usize::MAX - GAP;
        }
        lines.push('\n');
    }
    lines
}

fn heading(text: &str) -> String {
    let style = STYLES.get_header();
    format!("{style}{text}{style:#}")
}

fn literal(text: &str) -> String {
    let style = STYLES.get_literal();
    format!("{style}{text}{style:#}")
}
