//! `fcproto settle`.

use std::path::PathBuf;

use fc_codegen::questions::{Remaining, read};
use fc_spec::load::{Said, settle};
use fc_spec::model::{Confirmation, Fact, Model, Text};

use crate::lang::{both, counted, in_lang, said};
use crate::outcome::{Failure, Status};
use crate::spec::Spec;
use crate::versions::today;
use crate::{input, print};

/// Options of `fcproto settle`.
#[derive(Debug, clap::Args)]
#[command(group(clap::ArgGroup::new("what").required(true).args(["id", "from"])))]
#[command(group(clap::ArgGroup::new("said").multiple(true)))]
pub struct Options {
    #[arg(
        value_name = "ID",
        help = both("问题的 ID，或含有问题的冲突的 ID", "ID of a question, or of a conflict that has one")
    )]
    id: Option<String>,
    #[arg(
        long,
        value_name = "CODE",
        group = "said",
        help = both("功能码，例如 `0x1234`", "Code, such as `0x1234`")
    )]
    code: Option<String>,
    #[arg(
        long,
        value_name = "EFFECT",
        group = "said",
        help = both("对机器人的影响：`read`、`config` 或 `motion`", "Effect on the robot: `read`, `config` or `motion`")
    )]
    effect: Option<String>,
    #[arg(
        long,
        value_name = "UNIT",
        group = "said",
        help = both("单位，例如 `s`", "Unit, such as `s`")
    )]
    unit: Option<String>,
    #[arg(
        long = "type",
        value_name = "TYPE",
        group = "said",
        help = both("类型，例如 `timestamp_ms`", "Type, such as `timestamp_ms`")
    )]
    ty: Option<String>,
    #[arg(
        long,
        value_name = "FILE",
        group = "said",
        help = both("含请求各键的 YAML 文件，`-` 为标准输入", "YAML file with the keys of the request, `-` for standard input")
    )]
    request: Option<PathBuf>,
    #[arg(
        long,
        value_name = "FILE",
        group = "said",
        help = both("含响应各键的 YAML 文件，`-` 为标准输入", "YAML file with the keys of the response, `-` for standard input")
    )]
    response: Option<PathBuf>,
    #[arg(
        long,
        value_name = "PATH=VALUE",
        value_parser = assignment,
        group = "said",
        help = both("问题涉及的其他值，写路径或路径的末尾", "Another value of the question, by its path or the end of it")
    )]
    set: Vec<(String, String)>,
    #[arg(
        long,
        group = "said",
        help = both("确认规范现有的内容", "Confirm the present contents of the spec")
    )]
    confirm: bool,
    #[arg(
        long,
        value_name = "NAME",
        required_unless_present = "from",
        help = both("答复的人", "Person who answered")
    )]
    by: Option<String>,
    #[arg(
        long,
        value_name = "YYYY-MM-DD",
        help = both("答复的日期 [默认：今天]", "Date of the answer [default: today]")
    )]
    date: Option<String>,
    #[arg(
        long,
        value_name = "TEXT",
        help = both("答复的出处，例如邮件或工单", "Source of the answer, such as a mail or a ticket")
    )]
    reference: Option<String>,
    #[arg(
        long,
        value_name = "TEXT",
        group = "said",
        help = both("负责人的原话", "Answer in the owner's words")
    )]
    reply: Option<String>,
    #[arg(
        long,
        value_name = "FILE",
        conflicts_with = "said",
        help = both("读取表格中的全部答复", "Read all answers of a sheet")
    )]
    from: Option<PathBuf>,
    #[arg(
        long,
        help = both("显示修改，什么也不写", "Show the changes and write nothing")
    )]
    dry_run: bool,
}

fn assignment(text: &str) -> Result<(String, String), String> {
    match text.split_once('=') {
        Some((path, value)) if !path.is_empty() && !value.is_empty() => {
            Ok((path.to_owned(), value.to_owned()))
        }
        _ => Err(said!(
            "应写作 PATH=VALUE，例如 `x.unit=m`",
            "write it as PATH=VALUE, such as `x.unit=m`"
        )),
    }
}

pub fn run(mut spec: Spec, options: &Options) -> Result<Status, Failure> {
    let model = spec.valid()?;
    let before = spec.sources.clone();
    let said = options.said(model)?;
    let mut diffs = String::new();
    let mut ids = Vec::new();
    for said in said {
        let settled = settle(&spec.sources, spec.texts(), &said)?;
        let after = spec.with(&settled.path, &settled.text);
        if after.model.is_none() {
            let (id, objection) = (&settled.id, after.objection());
            let diff = print::diff(&settled.diff);
            return Err(said!(
                "写下对 {id} 的这个答复之后{objection}\n{diff}",
                "with this answer to {id} {objection}\n{diff}"
            )
            .into());
        }
        diffs += &settled.path;
        diffs += "\n";
        diffs += &print::diff(&settled.diff);
        ids.push(settled.id);
        spec = after;
    }
    if !options.dry_run {
        spec.project.write_changes(&before, &spec.sources)?;
    }
    let what = if options.dry_run {
        said!("将写下答复", "would settle")
    } else {
        said!("已写下答复", "settled")
    };
    let mut text = format!("{diffs}{} {}\n", print::good(&what), ids.join(", "));
    if let Some(model) = &spec.model {
        text += &rest(model, &ids);
    }
    if options.dry_run {
        print::result(&text)?;
    } else {
        print::done(&text)?;
    }
    Ok(Status::Fine)
}

/// Returns a message about the open questions. It lists those with the same subject.
fn rest(model: &Model, ids: &[String]) -> String {
    let Remaining { open, related } = Remaining::after(model, ids);
    let also = match related.as_slice() {
        [] => String::new(),
        related => said!(
            "，涉及相同内容的有：{related}",
            "; also open about it: {related}",
            related = Text::listed(related)
        ),
    };
    let left = counted(open, "待确认的问题", "open question");
    said!(
        "还有 {left}{also}\n运行 `fcproto generate`，并重读前后文字中与它有关的说明\n",
        "{left} left{also}\nrun `fcproto generate`, and check the texts that mention it\n"
    )
}

impl Options {
    /// Returns the answers from the command line or the sheet.
    fn said(&self, model: &Model) -> Result<Vec<Said>, Failure> {
        let date = today(self.date.as_deref());
        if let Some(path) = &self.from {
            let sheet = input::text(path)?;
            let said =
                read(sheet.as_bytes(), model, self.by.as_deref(), &date).map_err(|errors| {
                    let errors: Vec<_> =
                        errors.iter().map(|error| in_lang(&error.text())).collect();
                    errors.join("\n       ")
                })?;
            if said.is_empty() {
                let path = path.display();
                return Err(said!(
                    "`{path}` 没有答复任何待确认的问题",
                    "`{path}` answers no open question"
                )
                .into());
            }
            return Ok(said);
        }
        let mut values = self.set.clone();
        let plain = [
            (Fact::Code.name(), &self.code),
            (Fact::Effect.name(), &self.effect),
            ("unit", &self.unit),
            (Fact::Type.name(), &self.ty),
        ];
        for (path, value) in plain {
            values.extend(value.as_ref().map(|value| (path.to_owned(), value.clone())));
        }
        for (fact, file) in [
            (Fact::Request, &self.request),
            (Fact::Response, &self.response),
        ] {
            if let Some(file) = file {
                values.push((fact.name().to_owned(), input::text(file)?));
            }
        }
        if values.is_empty() && !self.confirm && self.reply.is_none() {
            return Err(said!(
                "什么也没有答复：给出一个值，或用 `--confirm` 确认规范现有的写法",
                "there is no answer: give a value, or confirm the spec with `--confirm`"
            )
            .into());
        }
        Ok(vec![Said {
            id: self.id.clone().unwrap_or_default(),
            values,
            confirmation: Confirmation {
                by: self.by.clone().unwrap_or_default(),
                date,
                reference: self.reference.clone(),
                reply: self.reply.clone(),
            },
        }])
    }
}
