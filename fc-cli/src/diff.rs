//! `fcproto diff`.

use clap::ValueEnum;
use fc_diff::{Finding, render};

use crate::help::{Help, Part};
use crate::lang::{both, lang};
use crate::outcome::{Failure, Status};
use crate::place::Place;
use crate::print;
use crate::project::in_repository;
use crate::versions::{Shelf, day, today};

/// Options of `fcproto diff`.
#[derive(Debug, clap::Args)]
pub struct Options {
    #[arg(
        value_name = "OLD",
        help = both("旧版本 [默认：上一次发布]", "Old version [default: the last release]")
    )]
    old: Option<String>,
    #[arg(
        value_name = "NEW",
        help = both("新版本 [默认：本项目]", "New version [default: this project]")
    )]
    new: Option<String>,
    #[arg(
        long,
        value_name = "FORMAT",
        default_value = "text",
        help = both("输出格式", "Output format")
    )]
    format: Shown,
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

pub fn help() -> Help {
    Help {
        summary: both(
            "显示两个版本之间的变更及其影响",
            "Show the changes between two versions and what they break",
        ),
        details: vec![
            Part::Terms(
                both("版本的写法", "How to name a version"),
                vec![
                    ("2026.12", both("发布的版本号", "Number of a release")),
                    (
                        "git:REF",
                        both("git 中某个提交的规范", "Spec of a commit in git"),
                    ),
                    (
                        "DIR",
                        both("项目目录或规范目录", "Directory of a project or of a spec"),
                    ),
                    (
                        "FILE",
                        both("`fcproto inspect` 的输出", "Output of `fcproto inspect`"),
                    ),
                ],
            ),
            Part::Text(both(
                "每个变更按一条规则判断：旧 app 与新机器人、新 app 与旧机器人能否正确通信，哪些语言的源码无法编译，程序行为是否改变。\
                 没有规则的变更也会列出，因此没有输出变更就表示两个版本相同。`fcproto explain FC0731` 解释一条规则。",
                "A rule judges each change. It states if old apps and new robots, or new apps and old robots, misunderstand each \
                 other. It names the languages in which sources stop compiling, and states if programs behave differently. Changes without a rule are \
                 listed, too, so an empty list means that the versions are equal. `fcproto explain FC0731` explains a rule.",
            )),
            Part::Text(both(
                "要接受一个不兼容的变更，在规范的 `waivers` 中写一项：这里显示的 ID、理由、接受的人和期限。之后它仍会列出，但不再算作失败。\
                 过期的豁免是错误。与上一次发布比较时，不再对应任何变更的豁免也是错误。",
                "To accept a change that breaks something, add an entry under `waivers` in the spec: the ID shown here, a reason, \
                 the person who accepts it, and a date. The change is still listed, but no longer counts. A waiver that has expired \
                 is an error. In a comparison with the last release, so is a waiver that accepts nothing.",
            )),
            keys(),
            Part::Examples(vec![
                (
                    "fcproto diff",
                    both("自上一次发布以来的变更", "Changes since the last release"),
                ),
                (
                    "fcproto diff git:main",
                    both("工作区的变更", "Changes of the working tree"),
                ),
                ("fcproto diff git:v1 git:v2 --format markdown --lang zh", ""),
                (
                    "fcproto diff --fail-on breaking",
                    both(
                        "用于 CI：有未豁免的通信不兼容就失败",
                        "For CI: fail if apps and robots misunderstand each other and no waiver accepts it",
                    ),
                ),
                (
                    "fcproto diff old.json new.json --format json | jq -r '.[] | select(.silent) | .message'",
                    "",
                ),
            ]),
        ],
        fails: both(
            "有 `--fail-on` 指定的未豁免变更，有无效的豁免，或某个版本的规范有错误",
            "Changes of `--fail-on` without a waiver, invalid waivers, or errors in the spec of a version",
        ),
        speaks: both("所有格式中的变更", "Changes in every format"),
    }
}

/// The keys of the format `json`.
fn keys() -> Part {
    Part::Terms(
        both("`json` 的键", "Keys of `json`"),
        vec![
            ("rule", both("规则的名称", "Name of the rule")),
            ("number", both("规则的编号", "Number of the rule")),
            ("subject", both("变更的内容", "Changed part")),
            (
                "wire",
                both(
                    "old_app_new_robot 和 new_app_old_robot 的列表",
                    "old_app_new_robot, new_app_old_robot or both",
                ),
            ),
            ("source", both("语言的列表", "List of languages")),
            (
                "behaviour",
                both("程序行为是否改变", "True if programs behave differently"),
            ),
            (
                "silent",
                both(
                    "是否不报错而值出错",
                    "True if nothing fails, but a value is wrong",
                ),
            ),
            ("message", both("变更的说明", "Message")),
            (
                "fingerprint",
                both(
                    "同一变更的值相同，与位置无关",
                    "The same for the same change, wherever it is",
                ),
            ),
            (
                "waived",
                both(
                    "接受它的豁免，没有则无此键",
                    "Waiver that accepts it, if there is one",
                ),
            ),
        ],
    )
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Shown {
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

pub fn run(place: &Place, options: &Options) -> Result<Status, Failure> {
    // Two named versions need no project, unless git has one of them.
    let named: Vec<_> = [&options.old, &options.new].into_iter().flatten().collect();
    let needs_project = named.len() < 2 || named.iter().any(|it| it.starts_with("git:"));
    let shelf = Shelf::find(place, needs_project)?;
    let old = match &options.old {
        Some(old) => old.clone(),
        None => shelf.last()?,
    };
    let new = options.new.clone().unwrap_or_else(|| shelf.here());
    let (Some(old), Some(mut new)) = (shelf.read(&old)?, shelf.read(&new)?) else {
        return Ok(Status::Faulty);
    };
    let format = match options.format {
        Shown::Text => fc_diff::Format::Text,
        Shown::Json => fc_diff::Format::Json,
        Shown::Markdown => fc_diff::Format::Markdown,
        Shown::Github => fc_diff::Format::Github,
        Shown::Sarif => fc_diff::Format::Sarif,
    };
    let findings = shelf.compare(&old, &new, &today(options.today.as_deref()))?;
    if matches!(options.format, Shown::Github | Shown::Sarif) {
        new.sources = new.sources.below(&in_repository(&shelf.root));
    }
    let lang = lang();
    print::result(&render(&findings, [&old, &new], format, lang))?;
    let fails = |finding: &Finding| {
        let counts = || finding.waived.is_none();
        let kinds = || options.fail_on.iter().any(|kind| kind.is_of(finding));
        finding.is_fault() || (counts() && kinds())
    };
    Ok(if findings.iter().any(fails) {
        Status::Faulty
    } else {
        Status::Fine
    })
}
