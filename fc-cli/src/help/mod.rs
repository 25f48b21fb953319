//! Help in the language of the run.
//!
//! The texts of each command are in `texts`; those of its options are next to them. The terminal, the manual pages and the
//! page of the reference show the same texts. They are wrapped once, here: clap has no `wrap_help`.

mod page;
mod terminal;
pub mod usage;
mod wrap;

use clap::{Arg, ArgAction, Command, CommandFactory as _};
use serde::Serialize;

use crate::args::Args;
use crate::lang::both;

pub use page::run as page;

/// The texts of a command without those of its arguments.
#[derive(Debug)]
pub struct Help {
    /// Verb and object, up to 60 columns, without a full stop.
    pub summary: &'static str,
    /// Follows the options in `--help`.
    pub details: Vec<Part>,
    /// The cases with exit status 1; empty if there are none.
    pub fails: &'static str,
    /// The output that follows `--lang`, apart from errors and messages; empty if there is none.
    pub speaks: &'static str,
}

/// A part of the details. In texts, code is between backticks.
#[derive(Debug, Serialize)]
pub enum Part {
    /// A paragraph.
    Text(&'static str),
    /// A heading, and terms with their meanings.
    Terms(&'static str, Vec<(&'static str, &'static str)>),
    /// A heading, and lines that are shown unchanged.
    Code(&'static str, &'static str),
    /// Command lines with their purpose.
    Examples(Vec<(&'static str, &'static str)>),
}

/// Lists the texts in `texts`, by the names of commands, in Chinese and in English.
macro_rules! texts {
    ($($name:literal)+) => {
        [$((
            $name,
            include_str!(concat!("texts/", $name, ".zh.md")),
            include_str!(concat!("texts/", $name, ".md")),
        )),+]
    };
}

static TEXTS: [(&str, &str, &str); 38] = texts! {
    "call" "certify" "changelog" "check" "codes" "completions" "decode" "diff" "drift" "encode" "explain" "fcproto" "fmt"
    "generate" "git" "git-check" "git-diff" "git-merge" "git-setup" "git-stage" "help" "help-page" "init" "inspect" "lint"
    "lsp" "man" "mock" "new" "package" "proxy" "questions" "record" "release" "retire" "schema" "settle" "where"
};

/// Returns the help of the command with this path.
fn of(path: &[&str]) -> Option<Help> {
    let name = match path {
        [] => "fcproto".to_owned(),
        [.., "help"] => "help".to_owned(),
        path => path.join("-"),
    };
    let (_, zh, en) = TEXTS.iter().find(|(known, ..)| *known == name)?;
    Some(Help::parse(both(zh, en)))
}

impl Help {
    /// Reads a text. Its blocks are the summary, `fails: ` and `speaks: ` if the command has them, and the details.
    fn parse(text: &'static str) -> Self {
        let mut blocks = text.trim_end().split("\n\n");
        let mut help = Self {
            summary: blocks.next().unwrap_or_default(),
            details: Vec::new(),
            fails: "",
            speaks: "",
        };
        for block in blocks {
            if let Some(cases) = block.strip_prefix("fails: ") {
                help.fails = cases;
            } else if let Some(output) = block.strip_prefix("speaks: ") {
                help.speaks = output;
            } else {
                help.details.push(Part::parse(block));
            }
        }
        help
    }
}

impl Part {
    /// Reads a block: a heading above terms or code, examples, or a paragraph. The purpose of an example follows ` # `.
    fn parse(block: &'static str) -> Self {
        if let Some((heading, content)) =
            block.strip_prefix("## ").and_then(|it| it.split_once('\n'))
        {
            let terms = content
                .lines()
                .filter_map(|line| line.strip_prefix("- ")?.split_once(" — "));
            return match fenced(content, "yaml") {
                Some(lines) => Self::Code(heading, lines),
                None => Self::Terms(heading, terms.collect()),
            };
        }
        match fenced(block, "sh") {
            Some(lines) => {
                let lines = lines.lines();
                let lines = lines.map(|line| line.split_once(" # ").unwrap_or((line, "")));
                Self::Examples(lines.collect())
            }
            None => Self::Text(block),
        }
    }
}

/// Returns the lines of a fenced block in a language.
fn fenced<'t>(block: &'t str, language: &str) -> Option<&'t str> {
    let lines = block.strip_prefix("```")?.strip_prefix(language)?;
    lines.strip_prefix('\n')?.strip_suffix("\n```")
}

/// The heading of the options that every command has.
pub fn global() -> &'static str {
    both("全局选项", "Global options")
}

/// Returns the command line with its texts, for completions and manual pages.
pub fn described() -> Command {
    let version = flag("version", 'V', ArgAction::Version);
    let version = version.help(both("显示版本", "Print version"));
    let mut command = Args::command().disable_version_flag(true).arg(version);
    each(&mut command, &[], &mut |command, path| {
        let help = flag("help", 'h', ArgAction::Help);
        let help = help.help(both(
            "显示帮助；`-h` 只列选项",
            "Print help; `-h` omits details",
        ));
        let command = command.disable_help_flag(true).arg(help);
        let Some(help) = of(path) else { return command };
        let details = terminal::plain(&help);
        command.about(help.summary).after_long_help(details)
    });
    command
}

/// Returns a flag. Without it, clap would describe the flag in English.
fn flag(name: &'static str, short: char, action: ArgAction) -> Arg {
    Arg::new(name)
        .short(short)
        .long(name)
        .action(action)
        .help_heading(global())
}

/// Returns the command line with its texts, laid out for the terminal.
pub fn dressed() -> Command {
    let mut command = described();
    // The usage of a command begins with the names of its parent commands.
    command.build();
    let width = terminal::width();
    each(&mut command, &[], &mut |mut command, path| {
        let Some(help) = of(path) else { return command };
        let usage = usage(&mut command);
        let body = terminal::body(&command, help.summary, &usage, width);
        let details = terminal::details(&command, &help, width);
        command
            .about(help.summary)
            .override_usage(usage)
            .help_template(body)
            .after_long_help(details)
    });
    command
}

/// Changes every command, its subcommands first. Skips the copies of commands that clap has below `help`.
fn each(command: &mut Command, path: &[&str], change: &mut dyn FnMut(Command, &[&str]) -> Command) {
    if path.last() != Some(&"help") {
        for below in command.get_subcommands_mut() {
            let name = below.get_name().to_owned();
            let path: Vec<&str> = path.iter().copied().chain([name.as_str()]).collect();
            each(below, &path, change);
        }
    }
    *command = change(std::mem::take(command), path);
}

/// An argument in the form for help.
struct ArgumentHelp<'c> {
    /// The term, such as `-q, --quiet`, `    --root <DIR>` or `[NAME]`.
    term: String,
    /// The help without the default.
    text: String,
    /// The default, as a value or in words.
    default: Option<String>,
    /// The known values with their help.
    values: Vec<(String, String)>,
    argument: &'c Arg,
}

impl<'c> ArgumentHelp<'c> {
    fn new(argument: &'c Arg) -> Self {
        let name = argument.to_string();
        let term = match (argument.get_short(), argument.is_positional()) {
            (Some(short), _) => format!("-{short}, {name}"),
            (None, false) => format!("    {name}"),
            (None, true) => name,
        };
        let help = argument.get_help().map(ToString::to_string);
        let help = help.unwrap_or_default();
        // The help of an argument contains a default that depends on the project.
        let label = format!(" [{}", default_label());
        let (text, default) = match help.split_once(&label) {
            Some((text, default)) => (text, Some(default.trim_end_matches(']').to_owned())),
            None => (help.as_str(), None),
        };
        let takes = argument.get_action().takes_values();
        let defaults = argument.get_default_values().first();
        let defaults = defaults.filter(|_| takes);
        let default = default.or_else(|| Some(defaults?.to_string_lossy().into_owned()));
        let values = if takes {
            argument.get_possible_values()
        } else {
            Vec::new()
        };
        let values = values.iter().filter(|it| !it.is_hide_set());
        let values = values.map(|value| {
            let help = value.get_help().map(ToString::to_string);
            (value.get_name().to_owned(), help.unwrap_or_default())
        });
        Self {
            term,
            text: text.to_owned(),
            default,
            values: values.collect(),
            argument,
        }
    }

    /// Returns the values with their help, or `None` if they have no help.
    fn described_values(&self) -> Option<(String, &[(String, String)])> {
        let is_described = self.values.iter().any(|(_, help)| !help.is_empty());
        let name = match self.argument.get_long() {
            Some(long) => format!("--{long}"),
            None => self.term.trim_matches(['[', ']', '<', '>', '.']).to_owned(),
        };
        is_described.then_some((name, self.values.as_slice()))
    }
}

/// The start of a default in the help of an argument.
fn default_label() -> &'static str {
    both("默认：", "default: ")
}

/// Returns the arguments of a command: its own in their order, then the global ones.
fn arguments(command: &Command) -> (Vec<ArgumentHelp<'_>>, Vec<ArgumentHelp<'_>>) {
    let visible = command.get_arguments().filter(|it| !it.is_hide_set());
    let (own, mut shared): (Vec<_>, Vec<_>) = visible
        .map(ArgumentHelp::new)
        .partition(|shown| shown.argument.get_help_heading() != Some(global()));
    shared.sort_by_key(|shown| matches!(shown.argument.get_id().as_str(), "help" | "version"));
    (own, shared)
}

/// Returns the usage of a command, without a title.
fn usage(command: &mut Command) -> String {
    let usage = command.render_usage().to_string();
    let usage = usage.strip_prefix("Usage: ").unwrap_or(&usage);
    usage
        .replace("[OPTIONS]", both("[选项]", "[OPTIONS]"))
        .replace("<COMMAND>", both("<命令>", "<COMMAND>"))
        .replace("[COMMAND]", both("[命令]", "[COMMAND]"))
}
