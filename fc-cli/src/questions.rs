//! `fcproto questions`.

use clap::ValueEnum;
use fc_codegen::questions::{self, By, List, Selection};
use fc_spec::model::Model;

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

#[derive(Clone, Copy, Debug, ValueEnum)]
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
    let by = match options.by {
        Order::Impact => By::Impact,
        Order::Group => By::Group,
        Order::State => By::State,
    };
    let selection = Selection {
        ids: &options.ids,
        state: match options.state {
            State::Open => questions::State::Open,
            State::Confirmed => questions::State::Confirmed,
            State::All => questions::State::All,
        },
        group: options.group.as_deref(),
        decisions: options.decisions,
    };
    let list = List::new(model, lang(), by, &selection)?;
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
