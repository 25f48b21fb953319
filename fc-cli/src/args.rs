//! The command line.

use clap::builder::styling::{AnsiColor, Styles};
use clap::{Parser, Subcommand, ValueEnum};

use crate::lang::Language;
use crate::place::{GLOBAL, Place};
use crate::{
    changelog, check, codes, diff, explain, fmt, generate, git, init, inspect, lint, lsp, new,
    places, questions, release, retire, schema, settle, shell,
};

const STYLES: Styles = Styles::styled()
    .header(AnsiColor::Green.on_default().bold())
    .usage(AnsiColor::Green.on_default().bold())
    .literal(AnsiColor::Cyan.on_default().bold())
    .placeholder(AnsiColor::Cyan.on_default());

/// Checks a protocol spec written in YAML and generates code and documentation from it.
///
/// The spec is `spec/protocol.yaml` and the files next to it. It is the source of the Rust crate, the
/// documentation in Chinese and English, golden frames and a JSON Schema for editors. `fc.yaml` says which
/// of them are made, and where.
#[derive(Debug, Parser)]
#[command(name = "fcproto", version, styles = STYLES, max_term_width = 100)]
#[command(after_long_help = "\
Exit status:
  0  success
  1  the spec has errors, or generated files are stale, or the spec is not laid out as `fcproto fmt` does it
  2  wrong usage, or a file that cannot be read or written

Examples:
  fcproto init lamp           begin a project in a directory of its own
  fcproto check               find all errors in the spec
  fcproto explain FC0012      read what an error means
  fcproto fmt                 lay out the files of the spec
  fcproto lint                find what is not wrong but could be better
  fcproto new get_battery --group status
                              add a command with the next free code
  fcproto questions           list what the owner of the protocol has still to say
  fcproto diff git:main       show what this working tree changes, and for whom it breaks
  fcproto generate            write all generated files
  fcproto generate --check    fail if a generated file is stale, and write nothing")]
pub struct Args {
    /// Where the project is.
    #[command(flatten)]
    pub place: Place,
    /// When to use colors.
    #[arg(long, value_name = "WHEN", default_value = "auto", global = true, help_heading = GLOBAL)]
    pub color: Color,
    /// In which language [default: zh in a Chinese locale, else en]
    #[arg(long, value_name = "LANGUAGE", global = true, help_heading = GLOBAL)]
    pub lang: Option<Language>,
    /// Say nothing of what went well; results that were asked for, and what is wrong, are still printed.
    #[arg(short, long, global = true, help_heading = GLOBAL)]
    pub quiet: bool,
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

/// What to do. The options of each say what it does.
#[derive(Debug, Subcommand)]
pub enum Command {
    Init(init::Options),
    Check(check::Options),
    Explain(explain::Options),
    Fmt(fmt::Options),
    Lint(lint::Options),
    New(new::Options),
    Retire(retire::Options),
    Diff(diff::Options),
    Changelog(changelog::Options),
    Release(release::Options),
    Generate(generate::Options),
    Inspect(inspect::Options),
    Where(places::Options),
    Codes(codes::Options),
    Questions(questions::Options),
    Settle(Box<settle::Options>),
    Git(git::Options),
    #[command(hide = true)]
    GitDiff(git::diff::Options),
    Schema(schema::Options),
    Lsp(lsp::Options),
    Completions(shell::Completions),
    Man(shell::Man),
}

/// When to use colors.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum Color {
    /// On a terminal, unless disabled by the environment
    Auto,
    /// Everywhere
    Always,
    /// Nowhere
    Never,
}

impl Color {
    /// Makes both output streams follow the choice.
    pub fn apply(self) {
        match self {
            Self::Auto => anstream::ColorChoice::Auto,
            Self::Always => anstream::ColorChoice::Always,
            Self::Never => anstream::ColorChoice::Never,
        }
        .write_global();
    }
}
