//! The command line.

use clap::builder::styling::{AnsiColor, Styles};
use clap::{Parser, Subcommand, ValueEnum};

use crate::help::{Help, PageOptions, Part, global};
use crate::lang::{Language, both};
use crate::place::Place;
use crate::{
    call, certify, changelog, check, codes, decode, diff, drift, encode, explain, fmt, generate,
    git, init, inspect, lint, lsp, mock, new, package, places, proxy, questions, release, retire,
    schema, settle, shell,
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
    pub place: Place,
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
    Where(places::Options),
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
    HelpPage(PageOptions),
}

pub fn help() -> Help {
    Help {
        summary: both(
            "检查机器人协议规范，并由它生成代码和文档",
            "Check a robot protocol spec and generate code from it",
        ),
        details: vec![
            Part::Text(both(
                "规范是 `spec/protocol.yaml` 和它旁边的文件。`fcproto generate` 由它生成 Rust、TypeScript、Python、Kotlin/Java 和 C++ 的包，\
                 中英文文档，标准帧，以及供编辑器使用的 JSON Schema。`fc.yaml` 列出生成的目标和目录。",
                "The spec is `spec/protocol.yaml` and the files next to it. `fcproto generate` makes packages for Rust, \
                 TypeScript, Python, Kotlin/Java and C++ from it, documentation in Chinese and English, golden frames, and a \
                 JSON Schema for editors. `fc.yaml` lists the targets and their directories.",
            )),
            Part::Text(both(
                "`fcproto` 从当前目录向上查找项目：最近的含有 `fc.yaml` 或 `spec/protocol.yaml` 的目录。`--root` 直接指定项目。",
                "`fcproto` looks for the project from the current directory upwards: the nearest directory with `fc.yaml` or \
                 `spec/protocol.yaml`. `--root` names it directly.",
            )),
            Part::Examples(vec![
                (
                    "fcproto init lamp",
                    both("创建一个项目", "Create a project"),
                ),
                ("fcproto check", both("检查规范", "Check the spec")),
                (
                    "fcproto explain FC0012",
                    both("解释一个错误", "Explain an error"),
                ),
                (
                    "fcproto fmt",
                    both("排版规范文件", "Format the files of the spec"),
                ),
                (
                    "fcproto new get_battery --group status",
                    both(
                        "新增一条指令，取下一个空闲的功能码",
                        "Add a command with the next free code",
                    ),
                ),
                (
                    "fcproto diff git:main",
                    both(
                        "显示与 main 分支的差异",
                        "Compare the working tree with a branch",
                    ),
                ),
                (
                    "fcproto generate",
                    both("重新生成全部文件", "Generate all files"),
                ),
                (
                    "fcproto generate --check",
                    both(
                        "有文件过期就报错，什么也不写",
                        "Fail if a file is stale, and write nothing",
                    ),
                ),
            ]),
        ],
        fails: both(
            "规范有错误、文件过期或未排版，或变更不被接受",
            "Errors in the spec, stale or unformatted files, or changes that are not accepted",
        ),
        speaks: "",
    }
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
