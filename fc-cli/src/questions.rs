//! `fcproto questions`.

use clap::ValueEnum;
use fc_codegen::questions::{By, List};
use fc_spec::model::{AnswerKind, Model, Question, Text};

use crate::lang::{both, lang, said};
use crate::outcome::{Failure, Status};
use crate::output::Output;
use crate::print;

/// Options of `fcproto questions`.
#[derive(Debug, clap::Args)]
pub struct Options {
    #[arg(
        value_name = "ID",
        help = both("问题或冲突的 ID [默认：全部]", "IDs of questions or conflicts [default: all]")
    )]
    ids: Vec<String>,
    #[arg(
        long,
        value_name = "ORDER",
        default_value = "impact",
        help = both("排列方式", "Order")
    )]
    by: Order,
    #[arg(
        long,
        value_name = "STATE",
        value_enum,
        default_value_t = State::Open,
        help = both("只列这种状态的问题", "List questions in this state")
    )]
    state: State,
    #[arg(
        long,
        value_name = "GROUP",
        help = both("只列这个分组的问题，写 ID", "List questions of the group with this ID")
    )]
    group: Option<String>,
    #[arg(
        long,
        help = both("也列出规范已定、待负责人确认的内容", "Include decisions for the owner to confirm")
    )]
    decisions: bool,
    #[command(flatten)]
    output: Output<OutputFormat>,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Order {
    #[value(help = both("按受阻的内容", "By the work that waits for the answer"))]
    Impact,
    #[value(help = both("按接口的分组", "By group of operations"))]
    Group,
    #[value(help = both("未答复的在前", "Open ones first"))]
    State,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum State {
    #[value(help = both("等待负责人答复", "Waiting for the owner"))]
    Open,
    #[value(help = both("负责人已答复", "Settled by the owner"))]
    Confirmed,
    #[value(help = both("两者", "Both"))]
    All,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum OutputFormat {
    #[value(help = both("在终端上阅读", "For reading on a terminal"))]
    Text,
    #[value(help = both("一个 JSON 文档，含两种语言", "One JSON document in both languages"))]
    Json,
    #[value(help = both("发给负责人的页面", "A page to send to the owner"))]
    Markdown,
    #[value(help = both("给负责人填写的表格", "A sheet for the owner to fill in"))]
    Csv,
}

pub fn run(model: &Model, options: &Options) -> Result<Status, Failure> {
    if let Some(id) = &options.group
        && model.group(id).is_none()
    {
        let known: Vec<&str> = model.groups.iter().map(|group| group.id.as_str()).collect();
        let known = Text::listed(known);
        return Err(said!(
            "没有分组 `{id}`；分组有：{known}",
            "there is no group `{id}`; there are {known}",
            known = known
        )
        .into());
    }
    let lang = lang();
    let by = match options.by {
        Order::Impact => By::Impact,
        Order::Group => By::Group,
        Order::State => By::State,
    };
    let list = List::new(model, lang, by, |question| options.wants(question));
    if list.is_empty() && !options.ids.is_empty() {
        return Err(said!(
            "没有问题 {ids}；`fcproto questions --state all --decisions` 列出全部问题",
            "there is no question {ids}; `fcproto questions --state all --decisions` lists them",
            ids = Text::listed(&options.ids)
        )
        .into());
    }
    print::result(&match options.output.format {
        OutputFormat::Text if list.is_empty() => said!("没有问题\n", "no questions\n"),
        OutputFormat::Text if options.ids.is_empty() => list.text(),
        OutputFormat::Text => list.text() + &print::diff(&list.edits()),
        OutputFormat::Json => list.json(),
        OutputFormat::Markdown => list.markdown(),
        OutputFormat::Csv => list.csv(),
    })?;
    Ok(Status::Fine)
}

impl Options {
    /// Returns `true` if the list shows a question. A question that is named by its id is always shown.
    fn wants(&self, question: &Question) -> bool {
        if !self.ids.is_empty() {
            let named = |id: &String| *id == question.id || question.ids.contains(id);
            return self.ids.iter().any(named);
        }
        (match self.state {
            State::Open => question.is_open(),
            State::Confirmed => !question.is_open(),
            State::All => true,
        }) && (self.decisions || question.kind == AnswerKind::Question)
            && self
                .group
                .as_ref()
                .is_none_or(|id| question.group.as_ref() == Some(id))
    }
}
