//! `fcproto diff`.

use clap::ValueEnum;
use fc_diff::{Finding, render};

use crate::lang::{both, lang};
use crate::outcome::{Failure, Status};
use crate::output::Output;
use crate::print;
use crate::project::in_repository;
use crate::project_dirs::ProjectDirs;
use crate::versions::{Named, Shelf, day, today};

/// Options of `fcproto diff`.
#[derive(Debug, clap::Args)]
pub struct Options {
    #[command(flatten)]
    versions: Named,
    #[command(flatten)]
    output: Output<OutputFormat>,
    #[arg(
        long,
        value_name = "KINDS",
        value_delimiter = ',',
        help = both("有这几类变更时以 1 退出", "Exit with 1 on changes of these kinds")
    )]
    fail_on: Vec<Kind>,
    #[arg(
        long,
        value_name = "DAY",
        value_parser = day,
        help = both("按这一天判断豁免 [默认：今天]", "Judge waivers as of this day [default: today]")
    )]
    today: Option<String>,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum OutputFormat {
    #[value(help = both("带两个版本的行，供人阅读", "With the lines of both versions, for people"))]
    Text,
    #[value(help = both("一个 JSON 文档", "One JSON document"))]
    Json,
    #[value(help = both("表格，供合并请求使用", "A table, for a pull request"))]
    Markdown,
    #[value(help = both("GitHub 合并请求的注释", "Annotations of a GitHub pull request"))]
    Github,
    #[value(help = both("SARIF 2.1.0 日志，供代码托管平台和编辑器使用", "A SARIF 2.1.0 log, for code hosts and editors"))]
    Sarif,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Kind {
    #[value(help = both("新旧 app 和机器人通信不兼容", "Old and new apps and robots misunderstand each other"))]
    Wire,
    #[value(help = both("同上，但不含新指令：旧机器人不认识，也还没有 app 使用", "The same without new commands, which no app uses yet"))]
    Breaking,
    #[value(help = both("源码无法编译", "Sources stop compiling"))]
    Source,
    #[value(help = both("程序行为改变", "Programs behave differently"))]
    Behaviour,
}

impl Kind {
    fn is_of(self, finding: &Finding) -> bool {
        match self {
            Self::Wire => !finding.wire.is_empty(),
            Self::Breaking => finding.is_break(),
            Self::Source => !finding.source.is_empty(),
            Self::Behaviour => finding.behaviour,
        }
    }
}

pub fn run(dirs: &ProjectDirs, options: &Options) -> Result<Status, Failure> {
    // Two named versions need no project, unless git has one of them.
    let Named { old, new } = &options.versions;
    let is_in_project =
        |name: &Option<String>| name.as_ref().is_none_or(|it| it.starts_with("git:"));
    let shelf = Shelf::find(dirs, is_in_project(old) || is_in_project(new))?;
    let [old, mut new] = shelf.named(&options.versions)?;
    let format = match options.output.format {
        OutputFormat::Text => fc_diff::Format::Text,
        OutputFormat::Json => fc_diff::Format::Json,
        OutputFormat::Markdown => fc_diff::Format::Markdown,
        OutputFormat::Github => fc_diff::Format::Github,
        OutputFormat::Sarif => fc_diff::Format::Sarif,
    };
    let findings = shelf.compare(&old, &new, &today(options.today.as_deref()))?;
    if matches!(
        options.output.format,
        OutputFormat::Github | OutputFormat::Sarif
    ) {
        new.sources = new.sources.below(&in_repository(&shelf.project.root));
    }
    let lang = lang();
    print::result(&render(&findings, [&old, &new], format, lang))?;
    let fails = |finding: &Finding| {
        let counts = || finding.waived.is_none();
        let kinds = || options.fail_on.iter().any(|kind| kind.is_of(finding));
        finding.is_fault() || (counts() && kinds())
    };
    Ok(Status::fine_if(!findings.iter().any(fails)))
}
