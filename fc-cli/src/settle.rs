//! `fcproto settle`.

use std::path::PathBuf;

use fc_codegen::output::replace_spec_file;
use fc_codegen::questions::read;
use fc_spec::load::{Said, settle};
use fc_spec::model::{AnswerKind, Confirmation, Fact, Model, Text};

use crate::lang::{counted, in_lang, said};
use crate::outcome::{Failure, Status};
use crate::place::Place;
use crate::print;
use crate::project::Project;
use crate::spec::Spec;

/// Write down what the owner of the protocol has answered.
///
/// Changes the facts that the question is about, says who confirmed them and when, and leaves everything else in the
/// files as it is, to the byte. The spec is only changed if it has no errors before and after.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  fcproto settle C012 --code 0x1234 --by 张伟
  fcproto settle C034 --unit s --by 张伟 --reference 'mail of 2026-11-20'
  fcproto settle C056.get_place --set unit=m --set yaw.unit=rad --by 张伟
  fcproto settle get_battery.response --response body.yaml --by 张伟
  fcproto settle battery_low.code --confirm --by 张伟
                              the inference is right as it is
  fcproto settle --from answers.csv
                              a sheet of `fcproto questions --format csv`, filled in")]
#[command(group(clap::ArgGroup::new("what").required(true).args(["id", "from"])))]
#[command(group(clap::ArgGroup::new("said").multiple(true)))]
pub struct Options {
    /// Id of the question, or of a conflict that has one.
    #[arg(value_name = "ID")]
    id: Option<String>,
    /// The code, such as 0x1234.
    #[arg(long, value_name = "CODE", group = "said")]
    code: Option<String>,
    /// What it does to the robot: read, config or motion.
    #[arg(long, value_name = "EFFECT", group = "said")]
    effect: Option<String>,
    /// The unit, such as `s`.
    #[arg(long, value_name = "UNIT", group = "said")]
    unit: Option<String>,
    /// The type, such as `timestamp_ms`.
    #[arg(long = "type", value_name = "TYPE", group = "said")]
    ty: Option<String>,
    /// A file with the keys of the request, as YAML; `-` for standard input.
    #[arg(long, value_name = "FILE", group = "said")]
    request: Option<PathBuf>,
    /// A file with the keys of the response, as YAML; `-` for standard input.
    #[arg(long, value_name = "FILE", group = "said")]
    response: Option<PathBuf>,
    /// Anything else that the question is about, by its path or the end of it.
    #[arg(long, value_name = "PATH=VALUE", value_parser = assignment, group = "said")]
    set: Vec<(String, String)>,
    /// It is right as it is: an inference, a decision, a behaviour.
    #[arg(long, group = "said")]
    confirm: bool,
    /// Who answered.
    #[arg(long, value_name = "NAME", required_unless_present = "from")]
    by: Option<String>,
    /// When [default: today]
    #[arg(long, value_name = "YYYY-MM-DD")]
    date: Option<String>,
    /// Where it can be looked up, such as a mail or a ticket.
    #[arg(long, value_name = "TEXT")]
    reference: Option<String>,
    /// The answer in the owner's own words.
    #[arg(long, value_name = "TEXT", group = "said")]
    reply: Option<String>,
    /// Settle all questions that are answered in this sheet; none if one of them cannot be.
    #[arg(long, value_name = "FILE", conflicts_with = "said")]
    from: Option<PathBuf>,
    /// Show what would change and write nothing.
    #[arg(long)]
    dry_run: bool,
}

fn assignment(text: &str) -> Result<(String, String), String> {
    match text.split_once('=') {
        Some((path, value)) if !path.is_empty() && !value.is_empty() => {
            Ok((path.to_owned(), value.to_owned()))
        }
        _ => Err("write it as PATH=VALUE, such as `x.unit=m`".to_owned()),
    }
}

pub fn run(place: &Place, options: &Options) -> Result<Status, Failure> {
    let project = Project::find(place)?;
    let mut spec = Spec::in_project(&project);
    let Some(model) = &spec.model else {
        spec.show_faults()?;
        return Ok(spec.status());
    };
    let before: Vec<_> = spec
        .sources
        .iter()
        .map(|(_, file)| file.text.clone())
        .collect();
    let said = options.said(model)?;
    let mut diffs = String::new();
    let mut ids = Vec::new();
    for said in said {
        let settled = settle(&spec.sources, &said)?;
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
        for ((_, file), before) in spec.sources.iter().zip(&before) {
            if file.text != *before {
                replace_spec_file(&project.root, &file.path, &file.text)?;
            }
        }
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

/// What is still to be said, of the same things first.
fn rest(model: &Model, ids: &[String]) -> String {
    let asked = model.questions.iter();
    let asked = asked.filter(|question| question.kind == AnswerKind::Question);
    let open: Vec<_> = asked
        .clone()
        .filter(|question| question.is_open())
        .collect();
    let settled = asked.filter(|question| ids.contains(&question.id));
    let subjects: Vec<_> = settled.map(|question| &question.subject).collect();
    let same = open
        .iter()
        .filter(|question| subjects.contains(&&question.subject));
    let same: Vec<_> = same.map(|question| question.id.as_str()).collect();
    let also = match same.as_slice() {
        [] => String::new(),
        same => said!(
            "，涉及相同内容的有：{same}",
            ", about the same: {same}",
            same = Text::listed(same)
        ),
    };
    let left = counted(open.len(), "待确认的问题", "open question");
    said!(
        "还有 {left}{also}\n运行 `fcproto generate`，并重读前后文字中与它有关的说明\n",
        "{left} left{also}\nrun `fcproto generate`, and read again what the texts around say of it\n"
    )
}

impl Options {
    /// What the command line or the sheet says.
    fn said(&self, model: &Model) -> Result<Vec<Said>, Failure> {
        let today = || jiff::Zoned::now().date().to_string();
        let date = self.date.clone().unwrap_or_else(today);
        if let Some(path) = &self.from {
            let sheet = std::fs::read(path).map_err(|error| {
                let path = path.display();
                said!(
                    "无法读取 `{path}`：{error}",
                    "cannot read `{path}`: {error}"
                )
            })?;
            let said = read(&sheet, model, self.by.as_deref(), &date).map_err(|errors| {
                let errors: Vec<_> = errors.iter().map(|error| in_lang(&error.text())).collect();
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
                values.push((fact.name().to_owned(), text(file)?));
            }
        }
        if values.is_empty() && !self.confirm && self.reply.is_none() {
            return Err(said!(
                "什么也没有答复：给出一个值，或用 `--confirm` 确认规范现有的写法",
                "nothing is said: give a value, or `--confirm` what the spec says already"
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

fn text(file: &PathBuf) -> Result<String, Failure> {
    let read = if file.as_os_str() == "-" {
        std::io::read_to_string(std::io::stdin())
    } else {
        std::fs::read_to_string(file)
    };
    read.map_err(|error| {
        let file = file.display();
        said!(
            "无法读取 `{file}`：{error}",
            "cannot read `{file}`: {error}"
        )
        .into()
    })
}
