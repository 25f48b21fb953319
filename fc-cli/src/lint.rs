//! `fcproto lint`.

use fc_codegen::target::FILE;
use fc_spec::diagnostic::Faults;
use fc_spec::index::definitions;
use fc_spec::lint::{faults, lint, settings, waive};

use crate::check::{Denied, Shown};
use crate::help::{Help, Part};
use crate::lang::{both, counted, said};
use crate::outcome::{Failure, Status};
use crate::place::Place;
use crate::print;
use crate::project::Project;
use crate::spec::Spec;
use crate::versions::{day, today};

/// Options of `fcproto lint`.
#[derive(Debug, clap::Args)]
pub struct Options {
    #[arg(
        long,
        value_name = "FORMAT",
        default_value = "text",
        help = both("输出格式", "Output format")
    )]
    format: Shown,
    #[arg(
        long,
        value_name = "WHAT",
        help = both("有这些内容时也以 1 退出", "Also exit with 1 for these")
    )]
    deny: Option<Denied>,
    #[arg(
        long,
        value_name = "DAY",
        value_parser = day,
        help = both("按这一天判断日期 [默认：今天]", "Judge dates as of this day [default: today]")
    )]
    today: Option<String>,
}

pub fn help() -> Help {
    Help {
        summary: both("检查风格规则", "Check style rules"),
        details: vec![
            Part::Terms(
                both("规则的类别", "Categories of rules"),
                vec![
                    (
                        "MINIMAL",
                        both(
                            "协议都不该有的问题",
                            "Problems that no protocol should have",
                        ),
                    ),
                    (
                        "STANDARD",
                        both(
                            "让协议易用的写法；包含 MINIMAL",
                            "Habits that make a protocol easy to use; contains MINIMAL",
                        ),
                    ),
                    ("DOCS", both("文字", "Texts")),
                    (
                        "WIRE",
                        both(
                            "有的接收方存不下的值",
                            "Values that some receivers cannot keep",
                        ),
                    ),
                    (
                        "SUNSET",
                        both("弃用内容的日期", "Dates of deprecated parts"),
                    ),
                ],
            ),
            Part::Text(both(
                "`fc.yaml` 的 `lint` 设置规则的级别，也写项目自己的规则。`fcproto explain FC0802` 解释一条规则。",
                "`lint` in `fc.yaml` sets the levels of rules and adds rules of the project. `fcproto explain FC0802` explains a \
                 rule.",
            )),
            Part::Text(both(
                "要保留的问题写在规范的 `waivers` 中：问题下面显示的 ID、理由、接受的人和期限。过期的豁免，以及不再对应任何问题的豁免，都是错误。",
                "To accept a finding, add an entry under `waivers` in the spec: the ID below the finding, a reason, the person who \
                 accepts it, and a date. A waiver that has expired or that accepts nothing is an error.",
            )),
            Part::Text(both(
                "格式和路径与 `fcproto check` 相同。",
                "Formats and paths are those of `fcproto check`.",
            )),
            Part::Code(
                both(
                    "fc.yaml 中的级别和项目规则",
                    "Levels and rules of the project in fc.yaml",
                ),
                "\
lint:
  levels: { WIRE: warning, FC0814: error, full-stop: \"off\" }
  house:
    - id: motion-needs-precondition
      zh: 动作指令要写前置条件
      en: A motion says when it is accepted
      for: command
      where: { effect: motion }
      require: { accepted: present }",
            ),
            Part::Examples(vec![
                ("fcproto lint", ""),
                (
                    "fcproto lint --deny warnings",
                    both("用于 CI：有警告也失败", "For CI: fail on warnings, too"),
                ),
                (
                    "fcproto lint --today 2027-01-01",
                    both(
                        "显示到那天应已移除的内容",
                        "Show the parts to remove by then",
                    ),
                ),
                ("fcproto lint --format sarif > fc.sarif", ""),
            ]),
        ],
        fails: both(
            "规范有错误，或有级别为 `error` 的问题；有 `--deny warnings` 时也包括警告",
            "Errors in the spec or findings of level `error`; with `--deny warnings` also warnings",
        ),
        speaks: both("所有格式中的问题", "Findings in every format"),
    }
}

pub fn run(place: &Place, options: &Options) -> Result<Status, Failure> {
    let project = Project::find(place)?;
    let mut wrong = Faults::new();
    let (settings, files) = settings(&project.root, FILE, &mut wrong);
    if !wrong.is_empty() {
        wrong.sort();
        options.format.show(&project, &wrong, &files)?;
        return Ok(Status::Failed);
    }
    let spec = Spec::in_project(&project);
    let Some(model) = &spec.model else {
        options.format.show(&project, &spec.faults, &spec.sources)?;
        return Ok(spec.status());
    };
    let today = today(options.today.as_deref());
    let mut findings = lint(model, &settings, &today);
    waive(&mut findings, &model.waivers, &today);
    let shown = faults(&findings, &settings, || definitions(&spec.sources));
    options.format.show(&project, &shown, &spec.sources)?;
    if options.format == Shown::Text && shown.is_empty() {
        let waived = findings.iter().filter(|it| it.waived.is_some()).count();
        let waived = match waived {
            0 => String::new(),
            waived => said!("，{waived} 处已接受", ", {waived} waived"),
        };
        let linted = print::good(&said!("检查完毕", "linted"));
        let files = counted(spec.files(), "文件", "file");
        print::done(&said!(
            "{linted}：{files}，没有发现问题{waived}\n",
            "{linted} {files}: nothing found{waived}\n"
        ))?;
    }
    Ok(
        if shown.has_errors() || (options.deny.is_some() && !shown.is_empty()) {
            Status::Faulty
        } else {
            Status::Fine
        },
    )
}
