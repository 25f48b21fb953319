//! `fcproto help-page`: the command line as a page of the reference.

use std::fmt::Write as _;

use clap::Command;

use super::{ArgumentHelp, Help, Part, arguments, described, of, terminal, usage};
use crate::lang::{both, said};
use crate::outcome::{Failure, Status};
use crate::print;

pub fn run() -> Result<Status, Failure> {
    print::result(&page())?;
    Ok(Status::Fine)
}

/// Returns the page in the language of the run.
fn page() -> String {
    let mut root = described();
    root.build();
    let Some(help) = of(&[]) else {
        return String::new();
    };
    let mut page = head(&help);
    let mut sections = String::new();
    let mut commands = Table::new(&[
        both("命令", "Command"),
        both("用途", "Purpose"),
        both("退出码为 1 的情况", "Exit status 1"),
        both("随 `--lang` 变化的输出", "Output that follows `--lang`"),
    ]);
    each(&mut root, &[], &mut |command, path, help| {
        let name = path.join(" ");
        let link = format!("[`fcproto {name}`](#{})", path.join("-"));
        commands.row(&[link.as_str(), help.summary, help.fails, help.speaks]);
        sections += &section(command, path, &help);
    });
    page += &commands.0;
    page += &statuses(&help);
    page += &language();
    page += &global(&root);
    page + &sections
}

/// Visits every visible command below this one, in the order of the help.
fn each(command: &mut Command, path: &[&str], visit: &mut dyn FnMut(&mut Command, &[&str], Help)) {
    for below in command.get_subcommands_mut() {
        if below.is_hide_set() || below.get_name() == "help" {
            continue;
        }
        let name = below.get_name().to_owned();
        let path: Vec<&str> = path.iter().copied().chain([name.as_str()]).collect();
        if let Some(help) = of(&path) {
            visit(below, &path, help);
        }
        each(below, &path, visit);
    }
}

fn head(help: &Help) -> String {
    let title = both("命令行", "Command line");
    let generated = both(
        "由 `fcproto --help` 的内容生成，不要改本页；`BLESS=1 cargo test -p fc-cli --test it help` 会重写它。",
        "Generated from the texts of `fcproto --help`. Do not edit this page: `BLESS=1 cargo test -p fc-cli --test it help` \
         writes it.",
    );
    let about = both(
        "`fcproto` 的全部命令和选项。在终端里，`fcproto COMMAND --help` 显示同样的内容，`-h` 只显示概要、用法和选项。",
        "All commands and options of `fcproto`. In a terminal, `fcproto COMMAND --help` shows the same text. `-h` shows \
         only summary, usage and options.",
    );
    let mut page = format!(
        "---\ntitle: {title}\noutline: [2, 2]\neditLink: false\n---\n\n<!-- {generated} -->\n\n# {title}\n\n{about}\n"
    );
    // The page has a table of the commands, so it needs no examples.
    let details = help.details.iter();
    page.extend(
        details
            .filter(|it| !matches!(it, Part::Examples(_)))
            .map(self::details),
    );
    let commands = both("命令一览", "Commands");
    page + &format!("\n## {commands} {{#commands}}\n\n")
}

fn statuses(help: &Help) -> String {
    let title = both("退出码", "Exit status");
    let mut table = Table::new(&[title, both("含义", "Meaning")]);
    for (status, meaning) in terminal::statuses(help) {
        table.row(&[&status, &meaning]);
    }
    format!("\n## {title} {{#status}}\n\n{}", table.0)
}

fn language() -> String {
    let title = both("语言", "Language");
    let text = both(
        "错误、提示、帮助和用法错误都有中文和英文。语言由 `--lang` 指定；没有时看 `LC_ALL`、`LC_MESSAGES`、`LANG` 中第一个不为空的变量，\
         以 `zh` 开头为中文，否则为英文。命令一览的最后一列是另外随之变化的输出。",
        "Errors, messages, help and usage errors are in Chinese or English. `--lang` chooses the language. Without it, the \
         first of `LC_ALL`, `LC_MESSAGES` and `LANG` that is set and not empty decides: Chinese if it starts with `zh`, \
         otherwise English. The last column of the command list shows other output that follows.",
    );
    format!("\n## {title} {{#language}}\n\n{text}\n")
}

fn global(root: &Command) -> String {
    let (_, shared) = arguments(root);
    let title = super::global();
    format!("\n## {title} {{#global}}\n{}", options(&shared))
}

/// Returns the section of a command.
fn section(command: &mut Command, path: &[&str], help: &Help) -> String {
    let usage = usage(command);
    let (name, id) = (path.join(" "), path.join("-"));
    let stop = both("。", ".");
    let summary = help.summary;
    let mut text =
        format!("\n## fcproto {name} {{#{id}}}\n\n{summary}{stop}\n\n```text\n{usage}\n```\n");
    let (own, _) = arguments(command);
    text += &options(&own);
    text.extend(help.details.iter().map(details));
    text
}

/// Returns a table of arguments, and a table for the values of each argument that has described values.
fn options(shown: &[ArgumentHelp<'_>]) -> String {
    if shown.is_empty() {
        return String::new();
    }
    let mut table = Table::new(&[
        both("参数", "Argument"),
        both("含义", "Meaning"),
        both("默认值", "Default"),
    ]);
    let mut values = String::new();
    for shown in shown {
        let mut text = shown.text.clone();
        if let Some((name, described)) = shown.described_values() {
            let mut table = Table::new(&[&format!("`{name}`"), both("含义", "Meaning")]);
            for (value, help) in described {
                table.row(&[&format!("`{value}`"), help]);
            }
            let _ = write!(values, "\n{}", table.0);
        } else if !shown.values.is_empty() {
            let names = shown.values.iter().map(|(name, _)| format!("`{name}`"));
            let names = names.collect::<Vec<_>>().join(both("、", ", "));
            text += &said!("：{names}", ": {names}");
        }
        let is_value = !shown.argument.get_default_values().is_empty();
        let default = match &shown.default {
            Some(default) if is_value => format!("`{default}`"),
            default => default.clone().unwrap_or_default(),
        };
        table.row(&[&format!("`{}`", shown.term.trim()), &text, &default]);
    }
    format!("\n{}{values}", table.0)
}

fn details(part: &Part) -> String {
    let titled = |title: &str, rest: String| said!("\n{title}：\n\n{rest}", "\n{title}:\n\n{rest}");
    match part {
        Part::Text(text) => format!("\n{text}\n"),
        Part::Terms(title, rows) => {
            let mut list = String::new();
            for (term, text) in rows {
                let _ = writeln!(list, "- `{term}`{}{text}", both("：", ": "));
            }
            titled(title, list)
        }
        Part::Code(title, lines) => titled(title, format!("```yaml\n{lines}\n```\n")),
        Part::Examples(rows) => {
            let mut lines = String::new();
            for (command, text) in rows {
                if !text.is_empty() {
                    let _ = writeln!(lines, "# {text}");
                }
                let _ = writeln!(lines, "{command}");
            }
            titled(both("示例", "Examples"), format!("```sh\n{lines}```\n"))
        }
    }
}

/// A Markdown table. Empty cells contain a dash.
struct Table(String);

impl Table {
    fn new(heads: &[&str]) -> Self {
        let mut table = Self(String::new());
        table.row(heads);
        let _ = writeln!(table.0, "|{}", "---|".repeat(heads.len()));
        table
    }

    fn row(&mut self, cells: &[&str]) {
        for cell in cells {
            let cell = if cell.is_empty() { "—" } else { cell };
            let _ = write!(self.0, "| {} ", cell.replace('|', "\\|"));
        }
        self.0 += "|\n";
    }
}
