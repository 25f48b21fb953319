//! The command line.

use clap::builder::styling::{AnsiColor, Styles};
use clap::{Parser, Subcommand, ValueEnum};

use crate::help::global;
use crate::lang::{Language, both};
use crate::{
    call, certify, changelog, check, codes, decode, diff, drift, encode, explain, fmt, generate,
    git, init, inspect, lint, lsp, mock, new, package, project_dirs, proxy, questions, release,
    retire, schema, settle, shell, where_,
};

/// Styles of help and usage errors.
pub const STYLES: Styles = Styles::styled()
    .header(AnsiColor::Green.on_default().bold())
    .usage(AnsiColor::Green.on_default().bold())
    .literal(AnsiColor::Cyan.on_default().bold())
    .placeholder(AnsiColor::Cyan.on_default());

/// The whole command line.
#[derive(Debug, Parser)]
#[command(name = "fcproto", version, styles = STYLES)]
pub struct Args {
    #[command(flatten)]
    pub dirs: project_dirs::Options,
    #[arg(
        long,
        value_name = "WHEN",
        default_value = "auto",
        global = true,
        help_heading = global(),
        help = both("何时使用颜色", "Use colors")
    )]
    pub color: Color,
    #[arg(
        long,
        value_name = "LANG",
        global = true,
        help_heading = global(),
        help = both("输出的语言 [默认：随系统语言]", "Language of output [default: by locale]")
    )]
    // `lang::speak` reads it before the rest is parsed.
    pub lang: Option<Language>,
    #[arg(
        short,
        long,
        global = true,
        help_heading = global(),
        help = both("只输出错误和请求的结果", "Print errors and requested results only")
    )]
    pub quiet: bool,
    /// The command to run.
    #[command(subcommand)]
    pub command: Command,
}

/// A command with its options.
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
    Package(package::Options),
    Inspect(inspect::Options),
    Where(where_::Options),
    Codes(codes::Options),
    Questions(questions::Options),
    Settle(Box<settle::Options>),
    Call(call::Options),
    Mock(mock::Options),
    Proxy(proxy::Options),
    Certify(certify::Options),
    #[cfg(feature = "record")]
    Record(crate::record::Options),
    Decode(decode::Options),
    Encode(encode::Options),
    Drift(drift::Options),
    Git(git::Options),
    #[command(hide = true)]
    GitDiff(git::diff::Options),
    Schema(schema::Options),
    Lsp(lsp::Options),
    Completions(shell::Completions),
    Man(shell::Man),
    #[command(hide = true)]
    HelpPage,
}

/// When colors are used.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum Color {
    #[value(help = both("在终端上使用，除非环境变量禁用", "On a terminal, unless the environment disables them"))]
    Auto,
    #[value(help = both("总是使用", "Always"))]
    Always,
    #[value(help = both("从不使用", "Never"))]
    Never,
}

impl Color {
    /// Applies the choice to both output streams.
    pub fn apply(self) {
        match self {
            Self::Auto => anstream::ColorChoice::Auto,
            Self::Always => anstream::ColorChoice::Always,
            Self::Never => anstream::ColorChoice::Never,
        }
        .write_global();
    }
}
